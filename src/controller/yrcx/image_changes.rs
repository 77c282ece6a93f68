//! Differences between consecutive images, for traces and captures. Masters and controllers send images cyclically, but
//! the images rarely change.

use super::describe::{answer_summary, command_summary};
use super::image::{COMMAND_WORDS, Image, Words};
use super::signal::{Side, Signal};
use super::table::STATUS_RESET;

/// A difference between an image and the image before it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Change {
    /// The words of a command or an answer have changed.
    Words {
        /// Command or answer.
        side: Side,
        /// New words.
        words: Words,
        /// One-line summary.
        summary: String,
    },
    /// A bit has changed.
    Signal {
        /// The signal.
        signal: Signal,
        /// New state.
        on: bool,
    },
}

impl Change {
    /// Formats the difference as one line. With `all`, the line contains all words; otherwise it ends with the last
    /// word that is not 0.
    pub fn line(&self, all: bool) -> String {
        match self {
            Self::Words { side, words, summary } => {
                let used = words.iter().rposition(|word| *word != 0).map_or(1, |last| last + 1);
                let shown = if all { COMMAND_WORDS } else { used };
                let words: Vec<String> = words[..shown].iter().map(|word| format!("{word:04X}")).collect();
                let name = if *side == Side::Input { "WI" } else { "WO" };
                format!("{name} {}  # {summary}", words.join(" "))
            }
            Self::Signal { signal, on } => {
                let name = signal.dedicated().map(|dedicated| format!("  # {}", dedicated.text)).unwrap_or_default();
                format!("{signal} {}{name}", if *on { "on" } else { "off" })
            }
        }
    }
}

/// Differences from the previous image of the same direction. In a first image, all values that are not 0 and the words
/// of an answer count as differences.
pub fn changes(side: Side, before: Option<&Image>, image: &Image) -> Vec<Change> {
    let mut changes = Vec::new();
    let words = image.command();
    let is_new = match (side, before) {
        (_, Some(before)) => words != before.command(),
        (Side::Input, None) => words != Words::default(),
        (Side::Output, None) => true,
    };
    if is_new {
        let summary = match side {
            Side::Input if words[0] == STATUS_RESET && words != Words::default() => {
                "data of the next command".to_owned()
            }
            Side::Input => command_summary(&words),
            Side::Output => answer_summary(&words),
        };
        changes.push(Change::Words { side, words, summary });
    }
    for signal in Signal::all(side) {
        let on = signal.is_on(image);
        if before.map_or(on, |before| signal.is_on(before) != on) {
            changes.push(Change::Signal { signal, on });
        }
    }
    changes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::yrcx::signal::output;

    #[test]
    fn reports_only_differences() {
        let lines = |side, before: Option<&Image>, image: &Image| -> Vec<String> {
            changes(side, before, image).iter().map(|change| change.line(false)).collect()
        };
        let empty = Image::default();
        assert_eq!(lines(Side::Input, None, &empty), [""; 0]);
        assert_eq!(lines(Side::Output, None, &empty), ["WO 0000  # ready"]);
        let mut early = empty;
        early.0[4] = 19;
        assert_eq!(
            lines(Side::Input, Some(&empty), &early),
            ["WI 0000 0000 0000 0000 0013  # data of the next command"]
        );
        let mut next = early;
        next.0[0] = 0x4000;
        output::SERVO_ON.set(&mut next, true);
        assert_eq!(lines(Side::Output, Some(&early), &next).len(), 2);
        assert_eq!(lines(Side::Output, Some(&next), &next), [""; 0]);
    }
}
