//! Deliberate faults of a simulated adapter, for tests of originators.

use super::super::wire::Cyclic;
use crate::fault::device_faults;

device_faults! {
    /// A fault of the adapter.
    AdapterFault {
        HalfRate "half-rate" "Sends only every other image.",
        Stall "stall" "Sends no images.",
        Stale "stale" "Sends every image with the sequence numbers of the previous image.",
        Double "double" "Sends every image twice.",
        WrongSequence "wrong-sequence" "The sequence numbers decrease.",
        WrongId "wrong-id" "Sends images with an unknown connection id.",
        WrongSize "wrong-size" "Sends images that are one byte too short.",
        Frozen "frozen" "Repeats its first image, as if the application behind it had stopped.",
        Unreadable "unreadable" "Refuses reads of assemblies with messages.",
        Reset "reset" "Closes the TCP connection at every request.",
        ResetSet "reset-set" "Closes the TCP connection at every Set_Attribute.",
        Mute "mute" "Answers no request.",
        Garbage "garbage" "Sends random bytes.",
        Trailing "trailing" "Appends a socket address after the items of a ForwardOpen reply, as OpENer boards do.",
        Unowned "unowned" "Hides its owner in the status, and checks the owner before the sizes, as OpENer boards do.",
    }
}

/// Socket address item for 0.0.0.0:2222.
pub(super) const TRAILING: [u8; 20] = [0x01, 0x80, 16, 0, 0, 2, 0x08, 0xAE, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];

/// Applies a fault to the image with this number. Returns the datagrams to send.
pub(super) fn images(fault: Option<AdapterFault>, number: u64, bytes: Vec<u8>) -> Vec<Vec<u8>> {
    let Some(fault) = fault else { return vec![bytes] };
    let changed = |change: fn(&mut Cyclic<'_>)| {
        let Ok(mut datagram) = Cyclic::parse(&bytes) else { return Vec::new() };
        change(&mut datagram);
        vec![datagram.emit(None)]
    };
    match fault {
        AdapterFault::HalfRate if number.is_multiple_of(2) => Vec::new(),
        AdapterFault::Stall => Vec::new(),
        AdapterFault::Stale => changed(|datagram| {
            // The first image is correct, because there is no previous image.
            datagram.sequence = datagram.sequence.min(1);
            datagram.count = datagram.count.min(1);
        }),
        AdapterFault::Double => vec![bytes.clone(), bytes],
        AdapterFault::WrongSequence => changed(|datagram| datagram.sequence = u32::MAX - datagram.sequence),
        AdapterFault::WrongId => changed(|datagram| datagram.id = !datagram.id),
        AdapterFault::WrongSize => {
            changed(|datagram| datagram.body = &datagram.body[..datagram.body.len().saturating_sub(1)])
        }
        AdapterFault::HalfRate
        | AdapterFault::Frozen
        | AdapterFault::Unreadable
        | AdapterFault::Reset
        | AdapterFault::ResetSet
        | AdapterFault::Mute
        | AdapterFault::Garbage
        | AdapterFault::Trailing
        | AdapterFault::Unowned => vec![bytes],
    }
}
