//! What a slave can do wrong, for tests of masters.

use super::super::can::MOST_DATA;
use super::super::wire::Fragment;

/// Something that a slave does wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DeviceFault {
    /// It acknowledges no fragments of explicit requests, and takes no acknowledgements.
    NoAcknowledge,
    /// The third fragment of every image from it is missing.
    LostFragment,
    /// The fragments of every image from it are counted wrong.
    WrongCount,
    /// It says that its images have another size.
    OtherSize,
    /// Another master has its connections.
    ForeignOwner,
    /// It answers that every MAC is taken.
    DuplicateMac,
    /// It says nothing.
    Silence,
    /// The adapters of its bus are bus-off.
    BusOff,
}

impl DeviceFault {
    /// All, by their names.
    pub const ALL: [(&str, Self); 8] = [
        ("no-acknowledge", Self::NoAcknowledge),
        ("lost-fragment", Self::LostFragment),
        ("wrong-count", Self::WrongCount),
        ("other-size", Self::OtherSize),
        ("foreign-owner", Self::ForeignOwner),
        ("duplicate-mac", Self::DuplicateMac),
        ("silence", Self::Silence),
        ("bus-off", Self::BusOff),
    ];
}

/// Does it to the frames of an image.
pub(super) fn spoil(fault: Option<DeviceFault>, mut frames: Vec<Vec<u8>>) -> Vec<Vec<u8>> {
    match fault {
        Some(DeviceFault::LostFragment) if frames.len() > 2 => drop(frames.remove(2)),
        // A bare image has no fragments; one that is a byte short comes to the same.
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
