//! Codec for Set_Prm (part 8, section 8.3.4) and Global_Control (8.3.9).

use std::fmt;
use std::time::Duration;

use super::{MAX_DATA, WireError};

/// Number of bytes before the user parameters.
const FIXED: usize = 7;
/// Time base of the watchdog times.
const STEP: Duration = Duration::from_millis(10);

/// Request to lock or unlock a slave.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Lock {
    /// Do not change the lock. Only the shortest delay of an answer is set.
    Unchanged,
    /// Lock the slave for this master.
    Lock,
    /// Unlock the slave.
    Unlock,
}

/// Watchdog time of a slave: 10 ms multiplied by two factors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Watchdog {
    factors: [u8; 2],
}

impl Watchdog {
    /// Returns the shortest watchdog time that is at least `time`; `None` if `time` is above 650 s.
    pub fn at_least(time: Duration) -> Option<Self> {
        let steps = time.as_nanos().div_ceil(STEP.as_nanos()).max(1);
        // A small second factor gives small steps, so the smallest possible second factor is used.
        let second = u8::try_from(steps.div_ceil(255)).ok()?;
        let first = u8::try_from(steps.div_ceil(u128::from(second))).ok()?;
        Some(Self { factors: [first, second] })
    }

    /// Creates a watchdog time from the two factors. Returns `None` if a factor is 0, which means no watchdog.
    pub const fn from_factors(factors: [u8; 2]) -> Option<Self> {
        if factors[0] == 0 || factors[1] == 0 { None } else { Some(Self { factors }) }
    }

    /// Watchdog time with the time base of 10 ms.
    pub fn time(self) -> Duration {
        STEP * u32::from(self.factors[0]) * u32::from(self.factors[1])
    }
}

/// Data of Set_Prm.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Parameters {
    /// Request to lock or unlock a slave.
    pub lock: Lock,
    /// Whether the slave must support Sync.
    pub sync: bool,
    /// Whether the slave must support Freeze.
    pub freeze: bool,
    /// Watchdog time; `None` switches the watchdog off.
    pub watchdog: Option<Watchdog>,
    /// Shortest delay of an answer in bits; 0 means no change.
    pub min_tsdr: u8,
    /// Expected ident number.
    pub ident: u16,
    /// Group membership, one bit per group.
    pub groups: u8,
    /// User parameters, defined by the manufacturer.
    pub user: Vec<u8>,
}

impl Parameters {
    /// Maximum number of bytes of user parameters.
    pub const MAX_USER: usize = MAX_DATA - FIXED;

    /// Returns the parameters that release the slave.
    pub const fn unlock(ident: u16) -> Self {
        Self {
            lock: Lock::Unlock,
            sync: false,
            freeze: false,
            watchdog: None,
            min_tsdr: 0,
            ident,
            groups: 0,
            user: Vec::new(),
        }
    }

    /// Decodes the parameters.
    pub fn parse(data: &[u8]) -> Result<Self, WireError> {
        let Some((&[station, first, second, min_tsdr, high, low, groups], user)) = data.split_first_chunk() else {
            return Err(WireError::short("parameters", 0, FIXED, data.len()));
        };
        // If both bits are set, unlock has priority over lock.
        let lock = match station & 0xC0 {
            0 => Lock::Unchanged,
            0x80 => Lock::Lock,
            _ => Lock::Unlock,
        };
        let watchdog = if station & 0x08 == 0 {
            None
        } else {
            let zero = WireError::value("watchdog factor", 1, 0_u8);
            Some(Watchdog::from_factors([first, second]).ok_or(zero)?)
        };
        Ok(Self {
            lock,
            sync: station & 0x20 != 0,
            freeze: station & 0x10 != 0,
            watchdog,
            min_tsdr,
            ident: u16::from_be_bytes([high, low]),
            groups,
            user: user.to_vec(),
        })
    }

    /// Encodes the parameters.
    pub fn emit(&self) -> Vec<u8> {
        let lock = match self.lock {
            Lock::Unchanged => 0,
            Lock::Lock => 0x80,
            Lock::Unlock => 0x40,
        };
        let flag = |is_set: bool, bit: u8| if is_set { bit } else { 0 };
        let station = lock | flag(self.sync, 0x20) | flag(self.freeze, 0x10) | flag(self.watchdog.is_some(), 0x08);
        let [first, second] = self.watchdog.map_or([0, 0], |watchdog| watchdog.factors);
        let [high, low] = self.ident.to_be_bytes();
        let mut data = vec![station, first, second, self.min_tsdr, high, low, self.groups];
        data.extend(&self.user);
        data
    }
}

/// Command to all slaves of one or more groups.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct GlobalControl {
    bits: u8,
    /// Groups to which the command applies, one bit per group; 0 means all slaves.
    pub groups: u8,
}

/// Names of the command bits.
const CONTROLS: [(u8, &str); 5] =
    [(0x02, "clear"), (0x04, "unfreeze"), (0x08, "freeze"), (0x10, "unsync"), (0x20, "sync")];

impl GlobalControl {
    /// Operate: the outputs are valid.
    pub const OPERATE: Self = Self { bits: 0, groups: 0 };
    /// Clear: the outputs are 0.
    pub const CLEAR: Self = Self { bits: 0x02, groups: 0 };

    /// Decodes a command.
    pub fn parse(data: &[u8]) -> Result<Self, WireError> {
        match *data {
            [bits, groups] => Ok(Self { bits, groups }),
            _ => Err(WireError::short("control command", 0, 2, data.len())),
        }
    }

    /// Encodes the command.
    pub const fn emit(self) -> [u8; 2] {
        [self.bits, self.groups]
    }

    /// Whether the command clears the outputs.
    pub const fn is_clear(self) -> bool {
        self.bits & 0x02 != 0
    }
}

impl fmt::Display for GlobalControl {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = CONTROLS.iter().filter(|row| self.bits & row.0 != 0).map(|row| row.1).collect();
        let clear = if self.is_clear() { None } else { Some("operate") };
        let names: Vec<&str> = clear.into_iter().chain(names).collect();
        write!(f, "{}", names.join(", "))?;
        if self.groups != 0 {
            write!(f, " for groups {:#04x}", self.groups)?;
        }
        Ok(())
    }
}
