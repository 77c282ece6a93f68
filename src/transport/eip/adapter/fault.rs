//! Deliberate faults of a simulated adapter, for tests of originators.

use super::super::wire::Cyclic;

/// A fault of the adapter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum AdapterFault {
    /// Sends only every other image.
    HalfRate,
    /// Sends no images.
    Stall,
    /// Sends every image with the sequence numbers of the previous one.
    Stale,
    /// Sends every image twice.
    Double,
    /// Counts backwards.
    WrongSequence,
    /// Sends images with an unknown connection id.
    WrongId,
    /// Sends images that are one byte short.
    WrongSize,
    /// Repeats its first image: the application behind it has stopped.
    Frozen,
    /// Refuses to read assemblies with messages.
    Unreadable,
    /// Closes the TCP connection at every request.
    Reset,
    /// Answers no request.
    Mute,
    /// Closes the TCP connection at every Set_Attribute.
    ResetSet,
    /// Sends garbage.
    Garbage,
    /// Appends a socket address after the counted items of a ForwardOpen reply, as OpENer boards do.
    Trailing,
    /// Does not report an owner in its status, and checks the owner before the sizes, as OpENer boards do.
    Unowned,
}

/// Socket address item 0.0.0.0:2222.
pub(super) const TRAILING: [u8; 20] = [0x01, 0x80, 16, 0, 0, 2, 0x08, 0xAE, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];

impl AdapterFault {
    /// All faults with their names.
    pub const ALL: [(&'static str, Self); 15] = [
        ("half-rate", Self::HalfRate),
        ("stall", Self::Stall),
        ("stale", Self::Stale),
        ("double", Self::Double),
        ("wrong-sequence", Self::WrongSequence),
        ("wrong-id", Self::WrongId),
        ("wrong-size", Self::WrongSize),
        ("frozen", Self::Frozen),
        ("unreadable", Self::Unreadable),
        ("reset", Self::Reset),
        ("reset-set", Self::ResetSet),
        ("mute", Self::Mute),
        ("garbage", Self::Garbage),
        ("trailing", Self::Trailing),
        ("unowned", Self::Unowned),
    ];
}

/// Applies a fault to image number `number`.
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
            // The first image is correct, because there is no previous one.
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
