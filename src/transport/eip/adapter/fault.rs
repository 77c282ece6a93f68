//! Deliberate faults of a simulated adapter, for tests of originators.

use super::super::wire::Cyclic;

/// A fault of the adapter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum AdapterFault {
    /// The adapter sends only every other image.
    HalfRate,
    /// The adapter sends no images.
    Stall,
    /// The adapter sends every image with the sequence numbers of the previous image.
    Stale,
    /// The adapter sends every image twice.
    Double,
    /// The sequence numbers decrease.
    WrongSequence,
    /// The adapter sends images with an unknown connection id.
    WrongId,
    /// The adapter sends images that are one byte too short.
    WrongSize,
    /// The adapter repeats its first image, as if the application behind it had stopped.
    Frozen,
    /// The adapter refuses reads of assemblies with messages.
    Unreadable,
    /// The adapter closes the TCP connection at every request.
    Reset,
    /// The adapter answers no request.
    Mute,
    /// The adapter closes the TCP connection at every Set_Attribute.
    ResetSet,
    /// The adapter sends random bytes.
    Garbage,
    /// The adapter appends a socket address after the counted items of a ForwardOpen reply, as OpENer boards do.
    Trailing,
    /// The adapter does not report an owner in its status, and checks the owner before the sizes, as OpENer boards do.
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
