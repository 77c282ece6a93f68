//! What an adapter can be made to do wrong, for tests of the other end.

use super::super::wire::Cyclic;

/// A thing to do wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum AdapterFault {
    /// Sends every other image only.
    Drop,
    /// Sends no images.
    Stall,
    /// Sends every image with the numbers of the one before.
    Stale,
    /// Sends every image twice.
    Double,
    /// Counts backwards.
    WrongSequence,
    /// Sends images under an id that nobody has.
    WrongId,
    /// Sends images that are a byte short.
    WrongSize,
    /// Sends what it showed at first, whatever it is shown: what is behind it has stopped.
    Frozen,
    /// Lets nobody read its assemblies by messages.
    Unreadable,
    /// Ends the TCP connection at every request.
    Reset,
    /// Answers no request.
    Mute,
    /// Ends the TCP connection instead of answering what sets an attribute.
    ResetSet,
    /// Answers noise.
    Garbage,
    /// Puts a socket address behind the items that it counts when it answers ForwardOpen, as OpENer boards do.
    Trailing,
    /// Does not say of itself that it has an owner, and names it before it looks at sizes, as OpENer boards do.
    Unowned,
}

/// An item of a socket address, 0.0.0.0:2222.
pub(super) const TRAILING: [u8; 20] = [0x01, 0x80, 16, 0, 0, 2, 0x08, 0xAE, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];

impl AdapterFault {
    /// All there are, with the names they are asked for by.
    pub const ALL: [(&'static str, Self); 15] = [
        ("drop", Self::Drop),
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

/// What is sent in place of an image, which is the `number`th.
pub(super) fn images(mischief: Option<AdapterFault>, number: u64, bytes: Vec<u8>) -> Vec<Vec<u8>> {
    let Some(mischief) = mischief else { return vec![bytes] };
    let changed = |change: fn(&mut Cyclic<'_>)| {
        let Ok(mut datagram) = Cyclic::parse(&bytes) else { return Vec::new() };
        change(&mut datagram);
        vec![datagram.emit(None)]
    };
    match mischief {
        AdapterFault::Drop if number.is_multiple_of(2) => Vec::new(),
        AdapterFault::Stall => Vec::new(),
        AdapterFault::Stale => changed(|datagram| {
            // The first is as it should be: there is none before.
            datagram.sequence = datagram.sequence.min(1);
            datagram.count = datagram.count.min(1);
        }),
        AdapterFault::Double => vec![bytes.clone(), bytes],
        AdapterFault::WrongSequence => changed(|datagram| datagram.sequence = u32::MAX - datagram.sequence),
        AdapterFault::WrongId => changed(|datagram| datagram.id = !datagram.id),
        AdapterFault::WrongSize => {
            changed(|datagram| datagram.body = &datagram.body[..datagram.body.len().saturating_sub(1)])
        }
        AdapterFault::Drop
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
