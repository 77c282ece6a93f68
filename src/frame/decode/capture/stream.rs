//! Long reports: the file is printed while it is read, with constant memory. Links and totals are printed after the
//! messages.

use std::cell::{OnceCell, RefCell};
use std::io::{self, Read};

use jiff::Timestamp;
use serde::ser::{Error as _, Serialize, SerializeMap as _, SerializeSeq as _, Serializer};

use super::report::{COLUMNS, Capture, Links, Problems, Row, row_of_the_longest};
use super::{CaptureDecoder, DecodedCapture, DecodedMessage, Detail, MessageBuffer, STREAM_ABOVE, Source};
use crate::decode::Field;
use crate::output::Format;
use crate::output::busy_work::register;
use crate::output::csv::Sheet;
use crate::output::envelope::ErrorBody;
use crate::output::render::{self, Layout};
use crate::prelude::basics::*;
use crate::run::{Run, RunError};
use crate::schema_of;

/// Number of rows per layout batch.
const ROWS_PER_BATCH: usize = 1000;
/// Number of bytes of CSV per write.
const CSV_LIMIT: usize = 64 << 10;

/// Prints the messages as JSON.
pub fn json<R: Read, O: Fn() -> io::Result<R> + Sync, D: CaptureDecoder>(
    run: &Run,
    id: &str,
    source: &Source<'_, O>,
    decoder: D,
) -> Result<(), RunError> {
    let _busy = register();
    let first = source.first_time()?;
    let messages = Messages { source, first, decoder: RefCell::new(Some(decoder)), about: OnceCell::new() };
    run.screen.json_as_it_comes(&Envelope { run, id, messages: &messages })?;
    let failure = messages.about.into_inner().and_then(|about| about.failure());
    failure.map_or(Ok(()), |failure| Err(RunError { failure, envelope: None, is_reported: true }))
}

/// Prints the messages as a table. A long table is printed while the file is read. Its columns then fit to the first
/// messages, and the summary is below it.
pub fn table<R: Read, O: Fn() -> io::Result<R> + Sync, D: CaptureDecoder>(
    run: &Run,
    id: &str,
    source: &Source<'_, O>,
    mut decoder: D,
) -> Result<(), RunError> {
    let busy = register();
    let mut kept = MessageBuffer::new(STREAM_ABOVE, None, Detail::Text);
    let mut long_table: Option<LongTable<'_>> = None;
    let mut written = Ok(());
    let summary = source.decode(&mut decoder, Detail::Text, |message| {
        written = match &mut long_table {
            Some(table) => table.push(message),
            None => match kept.push(message) {
                None => Ok(()),
                Some(message) => source
                    .first_time()
                    .and_then(|first| LongTable::start(run, first, std::mem::take(&mut kept.list)))
                    .and_then(|table| long_table.insert(table).push(message)),
            },
        };
        written.is_ok()
    })?;
    written?;
    let content = std::mem::take(decoder.decoded());
    let Some(table) = long_table else {
        let capture = source.content(kept, Links::default(), &summary, content)?;
        drop(busy);
        return run.local(id, &capture);
    };
    table.finish(source.about::<D::Field>(&summary, content.packets, content.notes))
}

/// A table that is printed while the file is read.
struct LongTable<'a> {
    run: &'a Run,
    /// Time of the first packet.
    first: Duration,
    links: Links,
    problems: Problems,
    layout: Layout,
    table: Table,
}

impl<'a> LongTable<'a> {
    /// Fits the columns to the first messages, and writes these.
    fn start<F>(run: &'a Run, first: Duration, messages: Vec<DecodedMessage<F>>) -> Result<Self> {
        run.screen.note("a large capture: its links are below the messages");
        let (mut links, mut layout) = (Links::default(), Layout::new(&COLUMNS));
        let rows: Vec<_> = messages.into_iter().map(|message| links.row(message, first)).collect();
        for row in &rows {
            layout.measure(&row.cells());
        }
        // Later numbers and times are longer, and the text gets the width that is left.
        let width = run.screen.width();
        layout.measure(&row_of_the_longest(usize::from(width)));
        let (layout, table) = (layout.fit_width(width), Table::new(&COLUMNS, ""));
        let mut started = Self { run, first, links, problems: Problems::default(), layout, table };
        rows.into_iter().try_for_each(|row| started.write(&row))?;
        Ok(started)
    }

    fn push<F>(&mut self, message: DecodedMessage<F>) -> Result<()> {
        let row = self.links.row(message, self.first);
        self.write(&row)
    }

    fn write<F>(&mut self, row: &Row<F>) -> Result<()> {
        self.problems.add(row.number(), row.problem());
        self.table.row(row.cells());
        if self.table.rows.len() < ROWS_PER_BATCH { Ok(()) } else { self.flush() }
    }

    fn flush(&mut self) -> Result<()> {
        let piece = self.layout.piece(&self.table.rows, self.run.screen.stdout_color());
        self.table.rows.clear();
        self.run.screen.data(&piece)
    }

    /// Writes the last messages, and the summary.
    fn finish<F: Field>(mut self, about: Capture<F>) -> Result<(), RunError> {
        self.flush()?;
        let about = Capture { links: self.links.list, problems: self.problems, ..about };
        let screen = &self.run.screen;
        for text in [about.head(), about.notes.join("\n")].into_iter().filter(|text| !text.is_empty()) {
            let text = render::text(&View::text(text), screen.width(), screen.stdout_color());
            screen.data(&format!("\n{text}"))?;
        }
        about.failure().map_or(Ok(()), |failure| Err(failure.into()))
    }
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

/// Messages that are decoded while they are written.
struct Messages<'a, 'b, O, D: CaptureDecoder> {
    source: &'a Source<'b, O>,
    /// Time of the first packet.
    first: Duration,
    decoder: RefCell<Option<D>>,
    /// The report without the messages, once these are written.
    about: OnceCell<Capture<D::Field>>,
}

impl<R: Read, O: Fn() -> io::Result<R> + Sync, D: CaptureDecoder> Serialize for Messages<'_, '_, O, D> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut list = serializer.serialize_seq(None)?;
        let Some(mut decoder) = self.decoder.take() else { return list.end() };
        let (mut links, mut problems, mut written) = (Links::default(), Problems::default(), Ok(()));
        let read = self.source.decode(&mut decoder, Detail::Fields, |message| {
            problems.add(message.number, message.problem.as_ref());
            written = list.serialize_element(&links.row(message, self.first));
            written.is_ok()
        });
        written?;
        let summary = read.map_err(|failure| S::Error::custom(failure.message))?;
        let DecodedCapture { packets, notes, .. } = std::mem::take(decoder.decoded());
        self.about.get_or_init(|| Capture {
            links: links.list,
            problems,
            ..self.source.about(&summary, packets, notes)
        });
        list.end()
    }
}

/// Envelope around the messages.
struct Envelope<'a, M> {
    run: &'a Run,
    id: &'a str,
    messages: &'a M,
}

impl<R: Read, O: Fn() -> io::Result<R> + Sync, D: CaptureDecoder> Serialize for Envelope<'_, Messages<'_, '_, O, D>> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        if self.run.screen.format == Format::Jsonl {
            map.serialize_entry("time", &Timestamp::now())?;
        }
        map.serialize_entry("robot", &())?;
        map.serialize_entry("command", self.id)?;
        map.serialize_entry("data", &Data(self.messages))?;
        let error = self.messages.about.get().and_then(Report::failure).map(ErrorBody::from);
        map.serialize_entry("ok", &error.is_none())?;
        if let Some(error) = error {
            map.serialize_entry("error", &error)?;
        }
        map.end()
    }
}

/// Data of the envelope: the keys of a [`Capture`].
struct Data<'a, M>(&'a M);

impl<R: Read, O: Fn() -> io::Result<R> + Sync, D: CaptureDecoder> Serialize for Data<'_, Messages<'_, '_, O, D>> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("messages", self.0)?;
        if let Some(about) = self.0.about.get() {
            // The pattern is complete, so that a new key is not forgotten here.
            let Capture {
                file,
                packets,
                other_packets,
                links,
                notes,
                damage,
                messages: _,
                problems: _,
                is_detailed: _,
                is_filtered: _,
            } = about;
            map.serialize_entry("file", file)?;
            map.serialize_entry("packets", packets)?;
            map.serialize_entry("other_packets", other_packets)?;
            map.serialize_entry("links", links)?;
            map.serialize_entry("notes", notes)?;
            map.serialize_entry("damage", damage)?;
        }
        map.end()
    }
}
