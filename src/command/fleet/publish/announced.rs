//! Retained topics of this node at one broker, also on disk. The next process clears those that it no longer publishes:
//! of robots that left the inventory or the selection, and of another prefix or template.
//!
//! A topic is on disk before its first message is sent. Before a topic is cleared, the broker is asked for its retained
//! message, because another node may publish the same robot now.

use std::io::ErrorKind;

use armctl_frame::failure::plain;
use armctl_frame::prelude::*;

/// Limit of the topics. Further topics are published, but not retained.
const MAX_TOPICS: usize = 20_000;
/// Size limit of the file in bytes.
const MAX_BYTES: u64 = 16 << 20;
/// Number of topics in a question. The answers must stay far below the flood limit of a connection.
const QUESTION: usize = 32;
/// Number of connections that may be lost during a question. Some brokers close the connection of a client that may not
/// read a topic. They are not asked again.
const MAX_LOSSES: u32 = 3;
/// Interval of the attempts to write the file after a disk error.
const RETRY_MS: u64 = 60_000;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    /// This process publishes the topic.
    Current,
    /// No longer published, but perhaps still retained.
    Stale,
    /// Stale, and the broker was asked for the retained message.
    Asked,
    /// Stale, and the empty message that clears it is in the queue.
    Clearing,
}

/// The topics, with or without a file.
#[derive(Debug, Default)]
pub struct AnnouncedTopics {
    file: Option<PathBuf>,
    topics: BTreeMap<String, State>,
    /// Whether the file has other topics than this value, and the time of the last attempt to write it.
    is_unsaved: bool,
    tried_ms: u64,
    losses: u32,
    is_full: bool,
    note: Option<String>,
}

impl AnnouncedTopics {
    /// Reads the topics of the previous process. All of them are stale at first. One topic per line.
    pub fn open(file: Option<PathBuf>) -> Self {
        let mut announced = Self { file, ..Self::default() };
        let Some(file) = &announced.file else { return announced };
        match files::text(file, MAX_BYTES) {
            Ok(text) => {
                let is_topic = |line: &&str| !line.is_empty() && !line.contains(['+', '#']);
                let stale = |line: &str| (line.to_owned(), State::Stale);
                announced.topics = text.lines().filter(is_topic).take(MAX_TOPICS).map(stale).collect();
            }
            Err(error) if error.kind() == ErrorKind::NotFound => {}
            Err(error) => {
                let why = plain(&error);
                announced.note = Some(format!(
                    "{}: {why}; armctl cannot clear topics of its previous runs at the broker",
                    file.display()
                ));
            }
        }
        announced
    }

    /// Records that these topics are published from now on, before their messages are sent.
    pub fn announce(&mut self, topics: impl IntoIterator<Item = String>) {
        let mut has_new = false;
        for topic in topics {
            if let Some(state) = self.topics.get_mut(&topic) {
                *state = State::Current;
            } else if self.topics.len() < MAX_TOPICS {
                self.topics.insert(topic, State::Current);
                has_new = true;
            } else if !std::mem::replace(&mut self.is_full, true) {
                self.note =
                    Some(format!("armctl retains at most {MAX_TOPICS} topics; it publishes more without retain"));
            }
        }
        if has_new {
            self.save();
        }
    }

    /// Records that a topic is no longer published.
    pub fn withdraw(&mut self, topic: &str) {
        if let Some(state) = self.topics.get_mut(topic) {
            *state = State::Stale;
        }
    }

    /// Topics that this process publishes.
    pub fn current(&self) -> Vec<String> {
        let current = self.topics.iter().filter(|(_, state)| **state == State::Current);
        current.map(|(topic, _)| topic.clone()).collect()
    }

    /// Whether this process publishes the topic.
    pub fn is_current(&self, topic: &str) -> bool {
        self.topics.get(topic) == Some(&State::Current)
    }

    /// Whether the topic is to be cleared now.
    pub fn is_clearing(&self, topic: &str) -> bool {
        self.topics.get(topic) == Some(&State::Clearing)
    }

    /// Stale topics whose retained messages are needed next; empty if there are none, or if the broker cannot be asked.
    pub fn next_question(&mut self) -> Vec<String> {
        let stale = self.topics.iter_mut().filter(|(_, state)| **state == State::Stale).take(QUESTION);
        let asked: Vec<String> = stale
            .map(|(topic, state)| {
                *state = State::Asked;
                topic.clone()
            })
            .collect();
        if self.losses < MAX_LOSSES { asked } else { Vec::new() }
    }

    /// Ends the question. Returns the topics to clear.
    pub fn end_question(&mut self) -> Vec<String> {
        let asked = self.topics.iter_mut().filter(|(_, state)| **state == State::Asked);
        asked
            .map(|(topic, state)| {
                *state = State::Clearing;
                topic.clone()
            })
            .collect()
    }

    /// Whether the broker was asked for this topic.
    pub fn is_asked(&self, topic: &str) -> bool {
        self.topics.get(topic) == Some(&State::Asked)
    }

    /// Removes a topic that is cleared, or that another node publishes.
    pub fn forget(&mut self, topic: &str) {
        self.topics.remove(topic);
        self.is_unsaved = true;
        // Otherwise the next process would clear the topic again, perhaps after another node has taken it over.
        if self.topics.values().all(|state| *state == State::Current) {
            self.save();
        }
    }

    /// Handles the loss of the connection: the next connection asks again.
    pub fn connection_lost(&mut self) {
        let is_open = self.topics.values().any(|state| *state == State::Asked);
        self.losses += u32::from(is_open && self.losses < MAX_LOSSES);
        let open = self.topics.values_mut().filter(|state| matches!(state, State::Asked | State::Clearing));
        open.for_each(|state| *state = State::Stale);
    }

    /// Writes the file again if the last attempt failed some time ago.
    pub fn retry(&mut self, now_ms: u64) {
        if self.is_unsaved && now_ms.saturating_sub(self.tried_ms) >= RETRY_MS {
            self.tried_ms = now_ms;
            self.save();
        }
    }

    /// Text for the log.
    pub fn take_note(&mut self) -> Option<String> {
        self.note.take()
    }

    fn save(&mut self) {
        let Some(file) = &self.file else { return };
        let content: String = self.topics.keys().map(|topic| format!("{topic}\n")).collect();
        let was_unsaved = self.is_unsaved;
        let folder = files::folder_of(file);
        match files::replace(file, content.as_bytes()).and_then(|()| files::sync_folder(&folder)) {
            Ok(()) => self.is_unsaved = false,
            Err(error) => {
                self.is_unsaved = true;
                if !was_unsaved {
                    let why = plain(&error);
                    self.note = Some(format!(
                        "{}: {why}; the next start of armctl cannot clear new topics at the broker",
                        file.display()
                    ));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use tempfile::TempDir;

    use super::*;

    fn names(names: &[&str]) -> Vec<String> {
        names.iter().map(|name| (*name).to_owned()).collect()
    }

    #[test]
    fn next_process_clears_what_it_no_longer_publishes() {
        let folder = TempDir::new().unwrap();
        let file = folder.path().join("topics");
        let mut first = AnnouncedTopics::open(Some(file.clone()));
        first.announce(names(&["a/press/status", "a/loader/status", "a/picker/status"]));
        assert!(first.next_question().is_empty());
        // A kill at any time after `announce` keeps the topics.
        drop(first);
        let mut second = AnnouncedTopics::open(Some(file.clone()));
        second.announce(names(&["a/press/status"]));
        assert_eq!(second.next_question(), ["a/loader/status", "a/picker/status"]);
        assert!(second.next_question().is_empty());
        // Another node publishes the picker now.
        second.forget("a/picker/status");
        assert_eq!(second.end_question(), ["a/loader/status"]);
        assert!(second.is_clearing("a/loader/status") && second.is_current("a/press/status"));
        // A kill before the acknowledgement keeps the topic.
        drop(second);
        let mut third = AnnouncedTopics::open(Some(file.clone()));
        third.announce(names(&["a/press/status"]));
        assert_eq!(third.next_question(), ["a/loader/status", "a/picker/status"]);
        third.end_question();
        third.forget("a/loader/status");
        third.forget("a/picker/status");
        assert_eq!(files::text(&file, 1000).unwrap(), "a/press/status\n");
        assert_eq!(third.take_note(), None);
    }

    #[test]
    fn a_topic_that_returns_is_not_cleared() {
        let mut announced = AnnouncedTopics::open(None);
        announced.announce(names(&["a"]));
        announced.withdraw("a");
        announced.withdraw("unknown");
        assert_eq!(announced.next_question(), ["a"]);
        announced.announce(names(&["a"]));
        assert!(announced.end_question().is_empty());
    }

    #[test]
    fn clears_without_a_question_after_several_losses() {
        let mut announced = AnnouncedTopics::open(None);
        announced.announce(names(&["a"]));
        announced.withdraw("a");
        for _ in 0..MAX_LOSSES {
            assert_eq!(announced.next_question(), ["a"]);
            announced.connection_lost();
        }
        assert!(announced.next_question().is_empty());
        assert_eq!(announced.end_question(), ["a"]);
        assert!(announced.end_question().is_empty());
    }

    #[test]
    fn is_bounded_and_reports_disk_errors() {
        let mut announced = AnnouncedTopics::open(None);
        announced.announce((0..=MAX_TOPICS).map(|number| format!("{number:06}")));
        assert!(announced.take_note().unwrap().contains("at most 20000 topics"));
        assert!(!announced.is_current(&format!("{MAX_TOPICS:06}")) && announced.is_current("000000"));

        let folder = TempDir::new().unwrap();
        std::fs::create_dir(folder.path().join("topics")).unwrap();
        let mut announced = AnnouncedTopics::open(Some(folder.path().join("topics")));
        assert!(announced.take_note().unwrap().contains("cannot clear topics of its previous runs"));
        announced.announce(names(&["a"]));
        assert!(announced.take_note().unwrap().contains("cannot clear new topics"));
        assert!(announced.is_current("a"));
        std::fs::remove_dir(folder.path().join("topics")).unwrap();
        announced.retry(RETRY_MS);
        assert_eq!(files::text(&folder.path().join("topics"), 10).unwrap(), "a\n");
    }
}
