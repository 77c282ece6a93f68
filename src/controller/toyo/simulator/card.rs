//! The memory card, whose transfers take their time.

use std::time::Duration;

use super::errors::code;
use super::memory::Content;
use super::settings::Settings;
use super::world::World;
use crate::Now;
use crate::toyo::table::Group;

/// The slot.
#[derive(Debug, Clone)]
pub(super) struct Card {
    inserted: bool,
    content: Option<Box<Content>>,
    transfer: Option<(Transfer, Now)>,
    /// How long a transfer takes.
    time: Duration,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Transfer {
    Read,
    Write,
}

impl Card {
    /// A slot, with an empty card in it or none.
    pub(super) const fn new(inserted: bool, time: Duration) -> Self {
        Self { inserted, content: None, transfer: None, time }
    }

    pub(super) const fn is_in(&self) -> bool {
        self.inserted
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

    /// Puts what the controller holds on the card, as if it had been written before.
    pub(super) fn fill(&mut self, content: &Content) {
        self.content = Some(Box::new(content.clone()));
    }

    /// Starts to write; whether there is a card.
    pub(super) fn write(&mut self, now: Now) -> bool {
        if self.inserted {
            self.transfer = Some((Transfer::Write, now.saturating_add(self.time)));
        }
        self.inserted
    }

    /// Starts to read; whether there is a card with something on it.
    pub(super) fn read(&mut self, now: Now) -> bool {
        let is_readable = self.inserted && self.content.is_some();
        if is_readable {
            self.transfer = Some((Transfer::Read, now.saturating_add(self.time)));
        }
        is_readable
    }

    /// Leaves a transfer off.
    pub(super) fn forget(&mut self) {
        if self.is_writing() {
            self.content = None;
        }
        self.transfer = None;
    }
}

impl World {
    /// Puts a card in, or takes it out: in mid-transfer that is an error.
    pub(super) fn insert_card(&mut self, inserted: bool) {
        if !inserted && self.card.is_busy() {
            self.card.forget();
            self.fail(code::CARD);
        }
        self.card.inserted = inserted;
    }

    /// Ends a transfer that is due.
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
