//! Deliberate faults of a simulated slave, for tests of masters.

use super::super::can::MOST_DATA;
use super::super::wire::Fragment;

/// A fault of the slave.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DeviceFault {
    /// The slave neither sends acknowledgements of explicit fragments nor accepts them.
    NoAcknowledge,
    /// Every image from the slave lacks its third fragment.
    LostFragment,
    /// Every image from the slave has wrong fragment counts.
    WrongCount,
    /// The slave reports another image size.
    OtherSize,
    /// Another master owns the connections of the slave.
    ForeignOwner,
    /// The slave answers every duplicate MAC check.
    DuplicateMac,
    /// The slave does not answer.
    Mute,
    /// All adapters on the bus are in the state bus-off.
    BusOff,
}

impl DeviceFault {
    /// All faults with their names.
    pub const ALL: [(&str, Self); 8] = [
        ("no-acknowledge", Self::NoAcknowledge),
        ("lost-fragment", Self::LostFragment),
        ("wrong-count", Self::WrongCount),
        ("other-size", Self::OtherSize),
        ("foreign-owner", Self::ForeignOwner),
        ("duplicate-mac", Self::DuplicateMac),
        ("mute", Self::Mute),
        ("bus-off", Self::BusOff),
    ];
}

/// Applies a fault to the frames of an image.
pub(super) fn spoil(fault: Option<DeviceFault>, mut frames: Vec<Vec<u8>>) -> Vec<Vec<u8>> {
    match fault {
        Some(DeviceFault::LostFragment) if frames.len() > 2 => drop(frames.remove(2)),
        // A single frame has no fragments. A missing byte has the same effect.
        Some(DeviceFault::LostFragment) => {
            for frame in &mut frames {
                frame.truncate(frame.len().saturating_sub(1));
            }
        }
        Some(DeviceFault::WrongCount) if frames.len() > 1 => {
            for frame in &mut frames {
                if let Some(first) = frame.first_mut() {
                    let Fragment { kind, count } = Fragment::parse(*first);
                    *first = Fragment { kind, count: count + 1 }.emit();
                }
            }
        }
        Some(DeviceFault::WrongCount) => {
            for frame in &mut frames {
                frame.resize(MOST_DATA, 0);
            }
        }
        _ => {}
    }
    frames
}
