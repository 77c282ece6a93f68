//! Journal of the images that masters sent, for tests and diagnosis.

use crate::yrcx::image::{COMMAND_WORDS, Image};

/// Maximum number of entries.
const MAX_ENTRIES: usize = 10_000;

/// Entries that were recorded after the journal was last read.
#[derive(Debug, Clone, Default)]
pub(super) struct Journal {
    entries: Vec<String>,
    omitted: usize,
}

impl Journal {
    /// Records a changed image, or the loss of the link.
    pub(super) fn note(&mut self, image: Option<&Image>) {
        if self.entries.len() >= MAX_ENTRIES {
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

    /// Removes and returns all entries. The first line is the number of entries. Each other line is an entry.
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

/// Words up to the last word that is not 0, but at least one word.
fn words(words: &[u16]) -> String {
    let used = words.iter().rposition(|word| *word != 0).unwrap_or_default();
    words.iter().take(used + 1).map(|word| format!("{word:04X}")).collect::<Vec<_>>().join(",")
}
