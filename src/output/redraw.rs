//! A text on a terminal that is written over the one before.

use std::cell::{Cell, RefCell};

use dialoguer::console::{Term, measure_text_width};

/// What of the text before is still on the screen, in lines of the terminal.
#[derive(Debug, Default)]
pub struct Redraw {
    drawn: Cell<usize>,
    /// Lines that the next text replaces.
    old: Cell<usize>,
    is_on: Cell<bool>,
    /// The header of the CSV that was begun.
    pub header: RefCell<String>,
}

impl Redraw {
    /// From here on the text is a new one, in the place of that before.
    pub fn begin(&self) {
        self.is_on.set(true);
        self.old.set(self.drawn.take());
    }

    /// Something else was written below: the next text stands below that.
    pub fn forget(&self) {
        self.drawn.take();
        self.old.take();
    }

    /// Whether texts replace each other.
    pub fn is_on(&self) -> bool {
        self.is_on.get()
    }

    /// The next part of the text, with what removes the text before.
    pub fn over(&self, text: String) -> String {
        if !self.is_on() {
            return text;
        }
        let (height, width) = Term::stdout().size();
        let lines: usize = text.lines().map(|line| rows(measure_text_width(line), width.into())).sum();
        let old = self.old.take();
        self.drawn.set(self.drawn.get() + lines);
        match old {
            0 => text,
            // The beginning has left the screen, where no cursor can go.
            old if old >= usize::from(height) => format!("\x1b[H\x1b[2J{text}"),
            old => format!("\x1b[{old}A\r\x1b[J{text}"),
        }
    }
}

/// Lines of a terminal that a line of text takes.
fn rows(columns: usize, width: usize) -> usize {
    columns.div_ceil(width.max(1)).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_replaces_the_one_before_and_nothing_else() {
        let redraw = Redraw::default();
        assert_eq!(redraw.over("a\n".to_owned()), "a\n");
        redraw.begin();
        assert_eq!(redraw.over("a\nb\n".to_owned()), "a\nb\n");
        assert_eq!(redraw.over("c\n".to_owned()), "c\n");
        redraw.begin();
        assert!(redraw.over("d\n".to_owned()).starts_with("\x1b["));
        redraw.begin();
        redraw.forget();
        assert_eq!(redraw.over("e\n".to_owned()), "e\n");
    }

    #[test]
    fn long_lines_take_several_of_the_terminal() {
        assert_eq!([0, 1, 80, 81, 160].map(|columns| rows(columns, 80)), [1, 1, 1, 2, 2]);
    }
}
