//! Views: the content of a report as fields, tables and lines, independent of the output format.

/// Meaning of a cell, which is shown as a color.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Tone {
    /// No special meaning.
    #[default]
    Plain,
    /// A good state.
    Good,
    /// A warning.
    Warning,
    /// An error.
    Bad,
}

/// One value in a table, in a field or in a line.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Cell {
    /// Text of the cell. It is not escaped.
    pub text: String,
    /// Whether the cell is a number. Numbers are right-aligned.
    pub is_number: bool,
    /// Meaning of the cell.
    pub tone: Tone,
    /// Whether the column must not be broken into lines, for example for times.
    pub is_whole: bool,
}

impl Cell {
    /// Creates a cell with a formatted number, for example `100.000`.
    pub fn number(text: impl Into<String>) -> Self {
        Self { text: text.into(), is_number: true, ..Self::default() }
    }

    /// Returns the cell with the property that it is not broken into lines.
    #[must_use]
    pub fn whole(mut self) -> Self {
        self.is_whole = true;
        self
    }

    /// Returns the cell with another tone.
    #[must_use]
    pub fn tone(mut self, tone: Tone) -> Self {
        self.tone = tone;
        self
    }

    /// Creates a cell for a switch: `on` or `off`.
    pub fn switch(on: bool) -> Self {
        Self::from(if on { "on" } else { "off" })
    }

    /// Creates a cell for a value that may be missing.
    pub fn optional<T: Into<Self>>(value: Option<T>) -> Self {
        value.map_or_else(|| Self::from("-"), Into::into)
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self { text: text.to_owned(), ..Self::default() }
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self { text, ..Self::default() }
    }
}

macro_rules! cell_from_number {
    ($($number:ty),*) => {
        $(impl From<$number> for Cell {
            fn from(value: $number) -> Self {
                Self::number(value.to_string())
            }
        })*
    };
}
cell_from_number!(u8, u16, u32, u64, usize, i16, i32, i64);

/// A table.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Table {
    /// Column names. For CSV, they are converted to identifiers.
    pub columns: Vec<&'static str>,
    /// Rows, each with one cell for each column.
    pub rows: Vec<Vec<Cell>>,
    /// Text that is shown if the table has no rows.
    pub empty: &'static str,
}

impl Table {
    /// Creates a table without rows. `empty` is the text that is shown if no row is added.
    pub fn new(columns: &[&'static str], empty: &'static str) -> Self {
        Self { columns: columns.to_vec(), rows: Vec::new(), empty }
    }

    /// Adds a row.
    pub fn row<const N: usize>(&mut self, cells: [Cell; N]) {
        debug_assert_eq!(N, self.columns.len(), "a row has one cell per column");
        self.rows.push(cells.into());
    }
}

impl Table {
    /// Removes a column that is empty in all rows.
    #[must_use]
    pub fn without_blank(mut self, column: &str) -> Self {
        let Some(at) = self.columns.iter().position(|name| *name == column) else { return self };
        let is_blank = |row: &Vec<Cell>| row.get(at).is_none_or(|cell| matches!(cell.text.as_str(), "" | "-"));
        if self.rows.iter().all(is_blank) {
            self.columns.remove(at);
            self.rows.iter_mut().filter(|row| row.len() > at).for_each(|row| drop(row.remove(at)));
        }
        self
    }
}

impl Table {
    /// Joins tables. The first column contains the names of the tables. The other columns are the columns of the widest
    /// table; the other tables may have fewer columns. `None` if a table has a column that the widest table does not
    /// have.
    pub fn joined(name: &'static str, tables: &[(&str, &Self)]) -> Option<Self> {
        let (_, widest) = tables.iter().rev().max_by_key(|(_, table)| table.columns.len())?;
        let place = |table: &Self, column: &&str| table.columns.iter().position(|own| own == column);
        let fits = |table: &Self| {
            let places: Option<Vec<usize>> = table.columns.iter().map(|column| place(widest, column)).collect();
            places.is_some_and(|places| places.is_sorted())
        };
        if !tables.iter().all(|(_, table)| fits(table)) {
            return None;
        }
        let columns = std::iter::once(name).chain(widest.columns.iter().copied()).collect();
        let rows = tables.iter().flat_map(|(of, table)| {
            let places: Vec<Option<usize>> = widest.columns.iter().map(|column| place(table, column)).collect();
            table.rows.iter().map(move |row| {
                let cells =
                    places.iter().map(|at| at.and_then(|at| row.get(at)).map_or_else(|| "-".into(), Cell::clone));
                std::iter::once(Cell::from(*of)).chain(cells).collect()
            })
        });
        Some(Self { columns, rows: rows.collect(), empty: widest.empty })
    }
}

/// A part of a view.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Section {
    /// Names and values, one pair on each line.
    Fields(Vec<(&'static str, Cell)>),
    /// Rows and columns.
    Table(Table),
    /// Text with several lines.
    Text(String),
    /// Lines with their own colors, for example a diff.
    Lines(Vec<Cell>),
    /// Lines whose parts have their own colors, for example a picture of dots.
    Picture(Vec<Vec<Cell>>),
}

/// Content of a report, for people.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct View {
    /// Parts of the view. They are separated by an empty line.
    pub sections: Vec<Section>,
}

impl View {
    /// Creates a view with fields.
    pub fn fields<const N: usize>(fields: [(&'static str, Cell); N]) -> Self {
        Self { sections: vec![Section::Fields(fields.into())] }
    }

    /// Creates a view with one table.
    pub fn table(table: Table) -> Self {
        Self { sections: vec![Section::Table(table)] }
    }

    /// Creates a view with one text.
    pub fn text(text: impl Into<String>) -> Self {
        Self { sections: vec![Section::Text(text.into())] }
    }

    /// The table, if the view contains only one table.
    pub fn as_table(&self) -> Option<&Table> {
        match &self.sections[..] {
            [Section::Table(table)] => Some(table),
            _ => None,
        }
    }

    /// Adds a part.
    #[must_use]
    pub fn append(mut self, section: Section) -> Self {
        self.sections.push(section);
        self
    }
}
