//! A report of more messages than there is room for: written as the file is read again, in a memory that does not depend
//! on its size. The first time it is read for what stands before the messages, and for the widths of columns.

use std::cell::RefCell;
use std::io::{self, Read};

use serde::ser::{Serialize, SerializeSeq as _, Serializer};

use super::{Capture, Field, Heard, Link, Links, Listener, Problems, Row, Source, Whole};
use crate::command::Report as _;
use crate::command::frame::run::{Run, RunError};
use crate::failure::Failure;
use crate::output::Format;
use crate::output::busy::busy;
use crate::output::render::{self, Layout};
use crate::output::view::{Table, View};
use crate::transport::capture::Summary;

/// Rows that are laid out at a time.
const PIECE: usize = 1000;

/// Reports a file as it is read.
pub fn tell<R: Read, O: Fn() -> io::Result<R>, L: Listener>(
    run: &Run,
    id: &str,
    source: &Source<'_, O>,
    mut listener: L,
) -> Result<(), RunError> {
    let mut links = Links::default();
    let mut problems = Problems::default();
    let mut layout = Layout::new(&Row::<L::Field>::COLUMNS);
    let summary = {
        let _busy = busy();
        source.pass(&mut listener, |heard| {
            let row = links.row(heard, std::time::Duration::ZERO);
            problems.add(&row);
            layout.measure(&row.cells());
            true
        })?
    };
    let told = std::mem::take(listener.told());
    let mut about: Capture<L::Field> = source.about(&summary, told.packets, told.notes);
    (about.links, about.problems) = (links.list, problems);
    let failure = about.failure();
    let again = Again { source, summary: &summary, all: about.problems.all };
    let _busy = busy();
    if !run.is_for_people() {
        let Capture { file, packets, other_packets, links, notes, damage, .. } = &about;
        let messages = Messages(RefCell::new(Some((again, listener.again()))));
        let (packets, other_packets) = (*packets, *other_packets);
        let data = Written { file, packets, other_packets, links, messages, notes, damage };
        run.screen.json_as_it_comes(&Whole::new(run, id, data, failure.as_ref()))?;
        return failure.map_or(Ok(()), |failure| Err(RunError { failure, envelope: None, told: true }));
    }
    again.rows_for_people(run, &about, layout, listener.again())?;
    failure.map_or(Ok(()), |failure| Err(failure.into()))
}

/// The file once more, up to as many messages as were seen before.
struct Again<'a, 'b, O> {
    source: &'a Source<'b, O>,
    summary: &'a Summary,
    all: u64,
}

impl<R: Read, O: Fn() -> io::Result<R>> Again<'_, '_, O> {
    /// Hands over every message until nobody wants more.
    fn rows<L: Listener>(&self, mut listener: L, mut each: impl FnMut(Row<L::Field>) -> bool) -> Result<(), Failure> {
        let mut links = Links::default();
        let mut left = self.all;
        let row = |heard: Heard<L::Field>| {
            let Some(fewer) = left.checked_sub(1) else { return false };
            left = fewer;
            each(links.row(heard, self.summary.first))
        };
        self.source.pass(&mut listener, row).map(|_| ())
    }

    fn rows_for_people<L: Listener>(
        &self,
        run: &Run,
        about: &Capture<L::Field>,
        layout: Layout,
        listener: L,
    ) -> Result<(), Failure> {
        let screen = &run.screen;
        let is_csv = screen.format == Format::Csv;
        let (width, color) = (screen.width(), screen.stdout_color());
        let text = |text: String| if is_csv { text } else { render::text(&View::text(text), width, color) };
        screen.data(&text(about.head()))?;
        if !is_csv {
            screen.data("\n")?;
        }
        let mut layout = layout.fit(width);
        let mut table = Table::new(&Row::<L::Field>::COLUMNS, "");
        let mut is_first = true;
        let mut write = |table: &mut Table| {
            let piece = if is_csv {
                let csv = render::csv(&View::table(std::mem::replace(table, Table::new(&table.columns, ""))), None);
                if is_first { csv } else { csv.split_once('\n').map_or(String::new(), |(_, rows)| rows.to_owned()) }
            } else {
                layout.piece(&table.rows, color)
            };
            is_first = false;
            table.rows.clear();
            screen.data(&piece)
        };
        let mut written = Ok(());
        self.rows(listener, |row| {
            table.row(row.cells());
            if table.rows.len() >= PIECE {
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
        let notes = text(about.notes.join("\n"));
        screen.data(&if is_csv { notes } else { format!("\n{notes}") })
    }
}

/// The same fields as those of a [`Capture`].
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

/// Messages that are read when they are written.
struct Messages<'a, 'b, O, L>(RefCell<Option<(Again<'a, 'b, O>, L)>>);

impl<R: Read, O: Fn() -> io::Result<R>, L: Listener> Serialize for Messages<'_, '_, O, L>
where
    L::Field: Field,
{
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut list = serializer.serialize_seq(None)?;
        let Some((again, listener)) = self.0.borrow_mut().take() else { return list.end() };
        let mut written = Ok(());
        let read = again.rows(listener, |row| {
            written = list.serialize_element(&row);
            written.is_ok()
        });
        written?;
        read.map_err(|failure| serde::ser::Error::custom(failure.message))?;
        list.end()
    }
}
