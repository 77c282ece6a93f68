//! Deliberate faults of a simulated slave, for tests of masters.

use super::super::can::MAX_DATA;
use super::super::wire::Fragment;
use crate::fault::device_faults;

device_faults! {
    /// A fault of the slave.
    DeviceFault {
        NoAcknowledge "no-acknowledge" "Neither sends acknowledgements of explicit fragments nor accepts them.",
        LostFragment "lost-fragment" "Every image from the slave lacks its third fragment.",
        WrongCount "wrong-count" "Every image from the slave has wrong fragment counts.",
        OtherSize "other-size" "Reports another image size.",
        ForeignOwner "foreign-owner" "Another master owns the connections of the slave.",
        DuplicateMac "duplicate-mac" "Answers every duplicate MAC check.",
        Mute "mute" "Does not answer.",
        BusOff "bus-off" "All adapters on the bus are in the state bus-off.",
    }
}

/// Applies a fault to the frames of an image.
pub(super) fn inject_fault(fault: Option<DeviceFault>, mut frames: Vec<Vec<u8>>) -> Vec<Vec<u8>> {
    match fault {
        Some(DeviceFault::LostFragment) if frames.len() > 2 => drop(frames.remove(2)),
        // A single frame has no fragments. Instead, one byte is removed, which also makes the image incomplete.
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
                frame.resize(MAX_DATA, 0);
            }
        }
        _ => {}
    }
    frames
}
