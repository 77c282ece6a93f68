//! Allocation of the connections of the predefined master/slave connection set.

use std::time::Duration;

use super::super::Now;
use super::super::wire::{Mac, connection, general, owner};
use crate::refuse_if;

/// Timeout of the explicit connection: four times its packet rate of 2500 ms.
const EXPLICIT_TIMEOUT: Duration = Duration::from_secs(10);

/// The allocated connections, and the master that owns them.
#[derive(Debug, Default)]
pub(super) struct Allocation {
    allocation_owner: Option<(u8, Mac)>,
    explicit_until: Now,
}

/// Refusal of an allocation or release, as general error code and additional error code.
pub(super) type Refusal = (u8, u8);

const KNOWN: u8 = connection::EXPLICIT | connection::POLL;

impl Allocation {
    pub(super) const fn master(&self) -> Option<Mac> {
        match self.allocation_owner {
            Some((_, master)) => Some(master),
            None => None,
        }
    }

    pub(super) fn choice(&self) -> u8 {
        self.allocation_owner.map_or(0, |(choice, _)| choice)
    }

    /// Whether this master owns the explicit connection.
    pub(super) fn is_explicit_of(&self, mac: Mac) -> bool {
        self.allocation_owner.is_some_and(|(choice, master)| master == mac && choice & connection::EXPLICIT != 0)
    }

    pub(super) fn explicit_until(&self) -> Option<Now> {
        self.allocation_owner.map(|_| self.explicit_until)
    }

    /// Restarts the timeout of the explicit connection.
    pub(super) fn refresh(&mut self, now: Now) {
        self.explicit_until = now + EXPLICIT_TIMEOUT;
    }

    pub(super) fn clear(&mut self) {
        self.allocation_owner = None;
    }

    pub(super) fn allocate(&mut self, now: Now, choice: u8, by: Mac, data_mac: u8) -> Result<(), Refusal> {
        refuse_if(data_mac != by.number(), (general::INVALID_PARAMETER, owner::NONE))?;
        refuse_if(self.master().is_some_and(|master| master != by), (general::CONFLICT, owner::ANOTHER_MASTER))?;
        refuse_if(choice == 0 || choice & !KNOWN != 0, (general::NO_RESOURCE, owner::INVALID_CHOICE))?;
        refuse_if(choice & self.choice() != 0, (general::ALREADY, owner::INVALID_CHOICE))?;
        refuse_if((choice | self.choice()) & connection::EXPLICIT == 0, (general::CONFLICT, owner::INVALID_CHOICE))?;
        self.allocation_owner = Some((choice | self.choice(), by));
        self.refresh(now);
        Ok(())
    }

    pub(super) fn release(&mut self, choice: u8, by: Mac) -> Result<(), Refusal> {
        refuse_if(self.master().is_some_and(|master| master != by), (general::CONFLICT, owner::ANOTHER_MASTER))?;
        refuse_if(choice == 0 || choice & !KNOWN != 0, (general::NO_RESOURCE, owner::INVALID_CHOICE))?;
        refuse_if(choice & !self.choice() != 0, (general::ALREADY, owner::INVALID_CHOICE))?;
        let left = self.choice() & !choice;
        self.allocation_owner = self.allocation_owner.filter(|_| left != 0).map(|(_, master)| (left, master));
        Ok(())
    }
}
