//! The record of what masters showed, for tests and for whoever asks who commands the controller.

use crate::yrcx::image::{COMMAND_WORDS, Image};

/// Entries that are kept.
const MOST: usize = 10_000;

/// What masters showed since the record was read last.
#[derive(Debug, Clone, Default)]
pub(super) struct Journal {
    entries: Vec<String>,
    omitted: usize,
}

impl Journal {
    /// Notes that a master shows a new image, or that the link is gone.
    pub(super) fn note(&mut self, image: Option<&Image>) {
        if self.entries.len() >= MOST {
            self.omitted += 1;
            return;
        }
        self.entries.push(image.map_or_else(
            || "link lost".to_owned(),
            |image| {
                let (command, signals) = image.0.split_at(COMMAND_WORDS);
                format!("WI {} SI {}", words(command), words(signals))
            },
        ));
    }

    /// The entries, a line each, below their number; they are forgotten.
    pub(super) fn take(&mut self) -> String {
        let Self { entries, omitted } = std::mem::take(self);
        let more = if omitted == 0 { String::new() } else { format!(", {omitted} more omitted") };
        let mut text = format!("{} images{more}", entries.len());
        for entry in entries {
            text.push('\n');
            text.push_str(&entry);
        }
        text
    }
}

/// Words up to the last one that is not 0, at least one.
fn words(words: &[u16]) -> String {
    let used = words.iter().rposition(|word| *word != 0).unwrap_or_default();
    words.iter().take(used + 1).map(|word| format!("{word:04X}")).collect::<Vec<_>>().join(",")
}
