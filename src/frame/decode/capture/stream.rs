//! Streamed report with more messages than fit into memory: the file is read a second time while it is printed, with
//! constant memory. The first pass collects the summary and the column widths.

use std::cell::RefCell;
use std::io::{self, Read};

use serde::ser::{Serialize, SerializeSeq as _, Serializer};

use super::report::{COLUMNS, Capture, Extremes, Link, Links, MESSAGE, Problems, Row, message_cell};
use super::{CaptureDecoder, DecodedCapture, DecodedMessage, Detail, ReportEnvelope, Source};
use crate::output::busy_work::register;
use crate::output::csv::Sheet;
use crate::output::render::{self, Layout};
use crate::prelude::basics::*;
use crate::run::{Run, RunError};
use crate::schema_of;
use armctl_transport::capture::Summary;

/// Number of rows per layout batch.
const ROWS_PER_BATCH: usize = 1000;
/// Number of bytes of CSV per write.
const CSV_LIMIT: usize = 64 << 10;

/// Prints a file while it is read.
pub fn print<R: Read, O: Fn() -> io::Result<R> + Sync, D: CaptureDecoder>(
    run: &Run,
    id: &str,
    source: &Source<'_, O>,
    mut decoder: D,
) -> Result<(), RunError> {
    let mut links = Links::default();
    let mut problems = Problems::default();
    let mut layout = Layout::new(&COLUMNS);
    let mut extremes = Extremes::default();
    let is_table = run.is_for_people();
    let (first_detail, detail) =
        if is_table { (Detail::Text, Detail::Text) } else { (Detail::Problem, Detail::Fields) };
    let summary = {
        let _busy = register();
        source.decode(&mut decoder, first_detail, |message| {
            links.count(&message.link);
            problems.add(message.number, message.problem.as_ref());
            if is_table {
                extremes.add(&message);
                layout.measure_cell(MESSAGE, &message_cell(&message.text, message.problem.as_deref()));
            }
            true
        })?
    };
    extremes.rows(summary.first, links.list.len()).for_each(|row| layout.measure(&row));
    let DecodedCapture { packets, notes, .. } = std::mem::take(decoder.decoded());
    let mut about: Capture<D::Field> = source.about(&summary, packets, notes);
    (about.links, about.problems) = (links.list, problems);
    let failure = about.failure();
    let second_pass = SecondPass { source, detail, summary: &summary, all: about.problems.all };
    let _busy = register();
    if !run.is_for_people() {
        let Capture { file, packets, other_packets, links, notes, damage, .. } = &about;
        let messages = Messages(RefCell::new(Some((second_pass, decoder.restart()))));
        let (packets, other_packets) = (*packets, *other_packets);
        let data = Written { file, packets, other_packets, links, messages, notes, damage };
        run.screen.json_as_it_comes(&ReportEnvelope::new(run, id, data, failure.as_ref()))?;
        return failure.map_or(Ok(()), |failure| Err(RunError { failure, envelope: None, is_reported: true }));
    }
    second_pass.rows_for_people(run, &about, layout, decoder.restart())?;
    failure.map_or(Ok(()), |failure| Err(failure.into()))
}

/// Prints the messages as CSV, without their lists of fields, in one pass.
pub fn csv<R: Read, O: Fn() -> io::Result<R> + Sync, D: CaptureDecoder>(
    run: &Run,
    source: &Source<'_, O>,
    mut decoder: D,
) -> Result<(), RunError> {
    let _busy = register();
    let first = source.first_time()?;
    let sheet = Sheet::from_schema(&schema_of::<Capture<D::Field>>().to_value(), RowsOf::List("messages"));
    let mut text = sheet.header(&[]);
    let (mut links, mut problems, mut written) = (Links::default(), Problems::default(), Ok(()));
    let summary = source.decode(&mut decoder, Detail::Raw, |message| {
        problems.add(message.number, message.problem.as_ref());
        links.row(message, first).push_csv(&mut text);
        if text.len() >= CSV_LIMIT {
            written = run.screen.data(&text);
            text.clear();
        }
        written.is_ok()
    })?;
    written?;
    run.screen.data(&text)?;
    let DecodedCapture { packets, notes, .. } = std::mem::take(decoder.decoded());
    let about = Capture { problems, ..source.about::<D::Field>(&summary, packets, notes) };
    about.notes.iter().for_each(|note| run.screen.note(note));
    about.failure().map_or(Ok(()), |failure| Err(failure.into()))
}

/// Second pass through the file, up to the number of messages of the first pass.
struct SecondPass<'a, 'b, O> {
    source: &'a Source<'b, O>,
    detail: Detail,
    summary: &'a Summary,
    all: u64,
}

impl<R: Read, O: Fn() -> io::Result<R> + Sync> SecondPass<'_, '_, O> {
    /// Passes on every message until the callback ends.
    fn rows<D: CaptureDecoder>(&self, mut decoder: D, mut each: impl FnMut(Row<D::Field>) -> bool) -> Result<()> {
        let mut links = Links::default();
        let mut left = self.all;
        let row = |message: DecodedMessage<D::Field>| {
            let Some(fewer) = left.checked_sub(1) else { return false };
            left = fewer;
            each(links.row(message, self.summary.first))
        };
        self.source.decode(&mut decoder, self.detail, row).map(|_| ())
    }

    fn rows_for_people<D: CaptureDecoder>(
        &self,
        run: &Run,
        about: &Capture<D::Field>,
        layout: Layout,
        decoder: D,
    ) -> Result<()> {
        let screen = &run.screen;
        let (width, color) = (screen.width(), screen.stdout_color());
        let text = |text: String| render::text(&View::text(text), width, color);
        screen.data(&text(about.head()))?;
        screen.data("\n")?;
        let mut layout = layout.fit_width(width);
        let mut table = Table::new(&COLUMNS, "");
        let mut write = |table: &mut Table| {
            let piece = layout.piece(&table.rows, color);
            table.rows.clear();
            screen.data(&piece)
        };
        let mut written = Ok(());
        self.rows(decoder, |row| {
            table.row(row.cells());
            if table.rows.len() >= ROWS_PER_BATCH {
                written = write(&mut table);
            }
            written.is_ok()
        })?;
        written?;
        if !table.rows.is_empty() {
            write(&mut table)?;
        }
        if about.notes.is_empty() {
            return Ok(());
        }
        screen.data(&format!("\n{}", text(about.notes.join("\n"))))
    }
}

/// Fields of a [`Capture`].
#[derive(serde::Serialize)]
struct Written<'a, M> {
    file: &'a str,
    packets: u64,
    other_packets: u64,
    links: &'a [Link],
    messages: M,
    notes: &'a [String],
    damage: &'a Option<String>,
}

/// Messages that are read during serialization.
struct Messages<'a, 'b, O, D>(RefCell<Option<(SecondPass<'a, 'b, O>, D)>>);

impl<R: Read, O: Fn() -> io::Result<R> + Sync, D: CaptureDecoder> Serialize for Messages<'_, '_, O, D> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut list = serializer.serialize_seq(None)?;
        let Some((second_pass, decoder)) = self.0.borrow_mut().take() else { return list.end() };
        let mut written = Ok(());
        let read = second_pass.rows(decoder, |row| {
            written = list.serialize_element(&row);
            written.is_ok()
        });
        written?;
        read.map_err(|failure| serde::ser::Error::custom(failure.message))?;
        list.end()
    }
}
