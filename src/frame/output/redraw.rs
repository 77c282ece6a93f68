//! Text on a terminal that replaces its previous version.

use std::cell::{Cell, RefCell};

use dialoguer::console::{Term, measure_text_width};

/// Number of lines of the last text on the screen.
#[derive(Debug, Default)]
pub struct Redraw {
    drawn: Cell<usize>,
    /// Number of lines that the next text replaces.
    old: Cell<usize>,
    is_on: Cell<bool>,
    /// Header of the CSV output that was printed last.
    pub header: RefCell<String>,
}

impl Redraw {
    /// Starts a new text, which replaces the last text.
    pub fn begin(&self) {
        self.is_on.set(true);
        self.old.set(self.drawn.take());
    }

    /// Forgets the last text, because other text was printed below it. The next text starts at the cursor.
    pub fn forget(&self) {
        self.drawn.take();
        self.old.take();
    }

    /// Whether a new text replaces the last text.
    pub fn is_on(&self) -> bool {
        self.is_on.get()
    }

    /// Returns the next part of the text. The codes that erase the old text come first.
    pub fn with_erase(&self, text: String) -> String {
        if !self.is_on() {
            return text;
        }
        let (height, width) = Term::stdout().size();
        let lines: usize = text.lines().map(|line| rows(measure_text_width(line), width.into())).sum();
        let old = self.old.take();
        self.drawn.set(self.drawn.get() + lines);
        match old {
            0 => text,
            // The start of the old text has scrolled off the screen. The cursor cannot reach it, so the whole screen is
            // erased.
            old if old >= usize::from(height) => format!("\x1b[H\x1b[2J{text}"),
            old => format!("\x1b[{old}A\r\x1b[J{text}"),
        }
    }
}

/// Returns the number of terminal lines that a text line occupies.
fn rows(columns: usize, width: usize) -> usize {
    columns.div_ceil(width.max(1)).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replaces_only_the_previous_text() {
        let redraw = Redraw::default();
        assert_eq!(redraw.with_erase("a\n".to_owned()), "a\n");
        redraw.begin();
        assert_eq!(redraw.with_erase("a\nb\n".to_owned()), "a\nb\n");
        assert_eq!(redraw.with_erase("c\n".to_owned()), "c\n");
        redraw.begin();
        assert!(redraw.with_erase("d\n".to_owned()).starts_with("\x1b["));
        redraw.begin();
        redraw.forget();
        assert_eq!(redraw.with_erase("e\n".to_owned()), "e\n");
    }

    #[test]
    fn counts_wrapped_lines() {
        assert_eq!([0, 1, 80, 81, 160].map(|columns| rows(columns, 80)), [1, 1, 1, 2, 2]);
    }
}
