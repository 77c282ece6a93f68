//! Memory card with timed transfers.

use std::time::Duration;

use super::errors::code;
use super::memory::Content;
use super::settings::Settings;
use super::world::World;
use crate::Now;
use crate::toyo::table::Group;

/// Card slot.
#[derive(Debug, Clone)]
pub(super) struct Card {
    pub(super) inserted: bool,
    content: Option<Box<Content>>,
    transfer: Option<(Transfer, Now)>,
    /// Duration of one transfer.
    time: Duration,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Transfer {
    Read,
    Write,
}

impl Card {
    pub(super) const fn new(inserted: bool, time: Duration) -> Self {
        Self { inserted, content: None, transfer: None, time }
    }

    pub(super) const fn is_busy(&self) -> bool {
        self.transfer.is_some()
    }

    pub(super) const fn is_reading(&self) -> bool {
        matches!(self.transfer, Some((Transfer::Read, _)))
    }

    pub(super) const fn is_writing(&self) -> bool {
        matches!(self.transfer, Some((Transfer::Write, _)))
    }

    pub(super) fn due(&self) -> Option<Now> {
        self.transfer.map(|(_, at)| at)
    }

    /// Copies the content of the controller to the card, as if the controller had written it earlier.
    pub(super) fn fill(&mut self, content: &Content) {
        self.content = Some(Box::new(content.clone()));
    }

    /// Starts a write. Returns `false` without a card.
    pub(super) fn write(&mut self, now: Now) -> bool {
        if self.inserted {
            self.transfer = Some((Transfer::Write, now.saturating_add(self.time)));
        }
        self.inserted
    }

    /// Starts a read. Returns `false` without a card with content.
    pub(super) fn read(&mut self, now: Now) -> bool {
        let is_readable = self.inserted && self.content.is_some();
        if is_readable {
            self.transfer = Some((Transfer::Read, now.saturating_add(self.time)));
        }
        is_readable
    }

    /// Aborts a transfer.
    pub(super) fn abort(&mut self) {
        if self.is_writing() {
            self.content = None;
        }
        self.transfer = None;
    }
}

impl World {
    /// Inserts or removes the card. Removal during a transfer is an error.
    pub(super) fn insert_card(&mut self, inserted: bool) {
        if !inserted && self.card.is_busy() {
            self.card.abort();
            self.fail(code::CARD);
        }
        self.card.inserted = inserted;
    }

    /// Completes the transfer when its time has passed.
    pub(super) fn card_done(&mut self) {
        let Some((transfer, _)) = self.card.transfer.take_if(|(_, at)| *at <= self.now) else { return };
        match transfer {
            Transfer::Write => self.card.fill(&self.memory.content),
            Transfer::Read => {
                let Some(content) = self.card.content.as_deref() else { return };
                self.switches.machine_changed |= self.memory.content.differs(content, Group::Machine);
                self.memory.content = content.clone();
                self.settings = Settings::from_content(&self.memory.content);
                self.reset_program();
            }
        }
    }
}
