//! What host and clients say to each other: frames of a length, a kind and a content.
//!
//! Four bytes of length, low byte first, count all that follows: a byte that tells the kind, and the content. Control
//! frames are JSON; what passes often is bytes.

use std::io;

use serde::{Deserialize, Serialize};
use thiserror::Error;
use tokio::io::AsyncReadExt as _;

use super::socket::ReadHalf;

/// What both sides must speak alike.
pub const VERSION: u32 = 3;

/// Longest frame: more than a datagram or an image can have.
const LONGEST: usize = 1 << 17;
const HEAD: usize = 4;
/// Longest text that one side says about itself.
pub const LONGEST_TEXT: usize = 300;

/// One frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Frame {
    /// Everything that is rare.
    Control(Control),
    /// The image that the device shows.
    Image(Vec<u8>),
    /// A change of what the device is shown: to the host, what a client wants; from it, what another one has done.
    Show(Change),
    /// A datagram, or a piece of a stream.
    Data {
        /// Which port of the device.
        channel: u8,
        /// Content.
        bytes: Vec<u8>,
    },
}

/// A change of an image: bits under the mask become those of the value.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Change {
    /// The opening of the link that it is meant for: what was meant for the time before a loss is not done after it.
    pub generation: u32,
    /// Which bits.
    pub mask: Vec<u8>,
    /// What they become; as long as the mask.
    pub value: Vec<u8>,
}

impl Change {
    /// Changes an image, as far as the change reaches.
    pub fn apply(&self, image: &mut [u8]) {
        for ((byte, mask), value) in image.iter_mut().zip(&self.mask).zip(&self.value) {
            *byte = (*byte & !mask) | (value & mask);
        }
    }
}

/// A frame that is rare.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Control {
    /// Client: who I am, and which device I mean.
    Hello(Hello),
    /// Client: how do you stand?
    Ask,
    /// Client: end, even if something moves.
    Close {
        /// Although a motion is under way.
        force: bool,
    },
    /// Client: I want the line.
    Take {
        /// Comes back with the line.
        number: u32,
        /// Which port of the device it is for.
        channel: u8,
    },
    /// Client: I do not want the line any more.
    Over,
    /// Client: I am going to move the robot.
    Motion,
    /// Client: a new socket for this channel, please.
    Renew(u8),
    /// Client: have the device shown this if I die; or no more.
    Will(Option<Change>),
    /// Client: I leave as I should.
    Bye,

    /// Host: who I am, and how things are.
    Welcome(Box<Welcome>),
    /// Host: how I stand.
    Status(Box<Status>),
    /// Host: no, and why.
    Refused(String),
    /// Host: I end.
    Closing,
    /// Host: the line is yours.
    Taken(u32),
    /// Host: the line is somebody else's; you are in the queue.
    Queued(Peer),
    /// Host: move the robot.
    Granted,
    /// Host: somebody else moves the robot.
    Held(Peer),
    /// Host: what you showed last has left.
    Sent,
    /// Host: the link is down, and why.
    Lost(String),
    /// Host: the link is up again.
    Reopened {
        /// The opening.
        generation: u32,
        /// What the device is shown since then.
        shown: Vec<u8>,
    },
    /// Host: sending or receiving failed.
    Broken(Broken),
    /// Host: the robot is read-only, and what the client sent is not passed on.
    Denied {
        /// What the device is shown, where the link carries images.
        shown: Option<Vec<u8>>,
    },
    /// Host: the session ends, and why.
    Ended(String),
}

/// What a client says of itself.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Hello {
    /// See [`VERSION`].
    pub version: u32,
    /// What the session is named by.
    pub key: String,
    /// Process.
    pub pid: u32,
    /// Its command line.
    pub command: String,
    /// What it comes for.
    pub purpose: Purpose,
}

/// What a client comes for, as far as the host must know.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Purpose {
    /// Anything; what it moves is stopped if it dies.
    #[default]
    Any,
    /// What it moves moves on if it dies.
    LeavesMotion,
    /// To stop the robot, which waits behind nobody.
    Stop,
}

/// A client, to others.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Peer {
    /// Process.
    pub pid: u32,
    /// Its command line.
    pub command: String,
    /// How long it has had what this is about.
    pub for_ms: u64,
}

/// What a host says of itself to a client.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Welcome {
    /// See [`VERSION`].
    pub version: u32,
    /// Process.
    pub pid: u32,
    /// How long it has been there.
    pub for_ms: u64,
    /// Why the link is down; `None` while it is up.
    pub down: Option<String>,
    /// What the last one left under way.
    pub leftover: Option<Leftover>,
    /// For images: what the device is shown, and shows.
    pub images: Option<Images>,
}

/// An image link as a client finds it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Images {
    /// The opening of the link.
    pub generation: u32,
    /// How many bytes of the output, from the first, the holder of the line alone changes.
    pub exclusive: usize,
    /// What the device is shown.
    pub shown: Vec<u8>,
    /// What it shows.
    pub seen: Option<Vec<u8>>,
}

/// What a client left on the exclusive part of an image.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Leftover {
    /// Who; since then it is gone.
    pub by: Peer,
    /// Whether it went without a word: killed, or broken down.
    pub died: bool,
}

/// How a session stands.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Status {
    /// See [`VERSION`]; 0 from a host that does not tell.
    #[serde(default)]
    pub version: u32,
    /// Whom it is for.
    pub info: Info,
    /// How long it has been there.
    pub for_ms: u64,
    /// Why the link is down; `None` while it is up.
    pub down: Option<String>,
    /// How often the link was opened again.
    pub reopenings: u32,
    /// Who uses it now.
    pub clients: Vec<Peer>,
    /// Who moves the robot.
    pub motion: Option<Peer>,
    /// What the last one left under way.
    pub leftover: Option<Leftover>,
    /// Whether the device shows that something moves.
    pub under_way: bool,
}

/// Whom a session, or a command that has the link to itself, is for; also what its lock file says.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Info {
    /// Process.
    pub pid: u32,
    /// Name of the robot.
    pub robot: String,
    /// Family of its controller.
    pub family: String,
    /// Target URL.
    pub target: String,
    /// Command line of the process; empty where an older one does not tell.
    #[serde(default)]
    pub command: String,
}

impl Info {
    /// That of this process, which runs this command.
    pub fn own(robot: &str, family: &str, target: &str, command: &str) -> Self {
        let (robot, family, target) = (robot.to_owned(), family.to_owned(), target.to_owned());
        Self { pid: super::process(), robot, family, target, command: short(command) }
    }
}

/// A failed operation of the host's, in a form that can be passed on.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Broken {
    /// Which kind, as far as clients tell them apart.
    pub kind: BrokenKind,
    /// In words.
    pub text: String,
}

/// Kinds of errors that clients tell apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BrokenKind {
    /// The other end is gone.
    NotConnected,
    /// Nobody listens on the port.
    ConnectionRefused,
    /// No way to the host.
    HostUnreachable,
    /// No way to its network.
    NetworkUnreachable,
    /// It took no bytes.
    TimedOut,
    /// Anything else.
    Other,
}

const KINDS: [(BrokenKind, io::ErrorKind); 5] = [
    (BrokenKind::NotConnected, io::ErrorKind::NotConnected),
    (BrokenKind::ConnectionRefused, io::ErrorKind::ConnectionRefused),
    (BrokenKind::HostUnreachable, io::ErrorKind::HostUnreachable),
    (BrokenKind::NetworkUnreachable, io::ErrorKind::NetworkUnreachable),
    (BrokenKind::TimedOut, io::ErrorKind::TimedOut),
];

impl From<&io::Error> for Broken {
    fn from(error: &io::Error) -> Self {
        let kind = KINDS.iter().find(|(_, kind)| *kind == error.kind());
        Self { kind: kind.map_or(BrokenKind::Other, |(kind, _)| *kind), text: error.to_string() }
    }
}

impl From<Broken> for io::Error {
    fn from(broken: Broken) -> Self {
        let kind = KINDS.iter().find(|(kind, _)| *kind == broken.kind);
        Self::new(kind.map_or(io::ErrorKind::Other, |(_, kind)| *kind), broken.text)
    }
}

/// What came is no frame.
#[derive(Debug, Error)]
pub enum WireError {
    /// Longer than any.
    #[error("a frame of {0} bytes")]
    TooLong(usize),
    /// A kind that is not known, or a content that does not fit it.
    #[error("a frame that makes no sense")]
    Senseless,
    /// The socket has failed.
    #[error("{0}")]
    Io(#[from] io::Error),
}

const CONTROL: u8 = b'c';
const IMAGE: u8 = b'i';
const SHOW: u8 = b's';
const DATA: u8 = b'd';

impl Frame {
    /// Appends the frame as it goes over the socket. Nobody sends a frame that is too long: images and datagrams have
    /// 65535 bytes at most, texts are cut.
    pub fn emit(&self, out: &mut Vec<u8>) {
        let start = out.len();
        out.extend([0; HEAD]);
        match self {
            Self::Control(control) => {
                out.push(CONTROL);
                out.extend(serde_json::to_vec(control).unwrap_or_default());
            }
            Self::Image(bytes) => {
                out.push(IMAGE);
                out.extend(bytes);
            }
            Self::Show(Change { generation, mask, value }) => {
                out.push(SHOW);
                out.extend(generation.to_le_bytes());
                out.extend(mask);
                out.extend(value);
            }
            Self::Data { channel, bytes } => {
                out.extend([DATA, *channel]);
                out.extend(bytes);
            }
        }
        let length = u32::try_from(out.len() - start - HEAD).unwrap_or(u32::MAX);
        out[start..start + HEAD].copy_from_slice(&length.to_le_bytes());
    }

    /// The first frame of what came, and how many bytes it has; `None` while it is not whole.
    fn parse(bytes: &[u8]) -> Result<Option<(Self, usize)>, WireError> {
        let Some((head, rest)) = bytes.split_first_chunk::<HEAD>() else { return Ok(None) };
        let length = usize::try_from(u32::from_le_bytes(*head)).unwrap_or(usize::MAX);
        if length > LONGEST {
            return Err(WireError::TooLong(length));
        }
        let Some(content) = rest.get(..length) else { return Ok(None) };
        let frame = match content {
            [CONTROL, json @ ..] => Self::Control(serde_json::from_slice(json).map_err(|_| WireError::Senseless)?),
            [IMAGE, bytes @ ..] => Self::Image(bytes.to_vec()),
            [SHOW, rest @ ..] => {
                let (generation, bits) = rest.split_first_chunk().ok_or(WireError::Senseless)?;
                if bits.len() % 2 != 0 {
                    return Err(WireError::Senseless);
                }
                let (mask, value) = bits.split_at(bits.len() / 2);
                let (mask, value) = (mask.to_vec(), value.to_vec());
                Self::Show(Change { generation: u32::from_le_bytes(*generation), mask, value })
            }
            [DATA, channel, bytes @ ..] => Self::Data { channel: *channel, bytes: bytes.to_vec() },
            _ => return Err(WireError::Senseless),
        };
        Ok(Some((frame, HEAD + length)))
    }
}

/// Frames from a socket.
#[derive(Debug)]
pub struct Reader {
    socket: ReadHalf,
    arrived: Vec<u8>,
}

impl Reader {
    /// Reads from this half.
    pub fn new(socket: ReadHalf) -> Self {
        Self { socket, arrived: Vec::new() }
    }

    /// The next frame; `None` once the other side is gone. The future may be dropped.
    pub async fn next(&mut self) -> Result<Option<Frame>, WireError> {
        loop {
            if let Some((frame, length)) = Frame::parse(&self.arrived)? {
                self.arrived.drain(..length);
                return Ok(Some(frame));
            }
            if self.socket.read_buf(&mut self.arrived).await? == 0 {
                return Ok(None);
            }
        }
    }
}

/// A text without control characters, and not too long.
pub fn short(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).take(LONGEST_TEXT).collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn frames() -> Vec<Frame> {
        let peer = || Peer { pid: 7, command: "armctl yrcx status".to_owned(), for_ms: 3 };
        vec![
            Frame::Control(Control::Take { number: 3, channel: 1 }),
            Frame::Control(Control::Close { force: true }),
            Frame::Control(Control::Held(peer())),
            Frame::Control(Control::Reopened { generation: 2, shown: vec![0x41, 0] }),
            Frame::Image(vec![1, 2, 3]),
            Frame::Show(Change { generation: 9, mask: vec![0xFF, 0x40], value: vec![1, 0] }),
            Frame::Data { channel: 1, bytes: b"YERC".to_vec() },
        ]
    }

    #[test]
    fn frames_lead_back() {
        let mut bytes = Vec::new();
        for frame in frames() {
            frame.emit(&mut bytes);
        }
        let mut rest = &bytes[..];
        for frame in frames() {
            assert!(Frame::parse(&rest[..rest.len().min(4)]).unwrap().is_none(), "a head alone");
            let (found, length) = Frame::parse(rest).unwrap().unwrap();
            assert_eq!(found, frame);
            rest = &rest[length..];
        }
        assert!(rest.is_empty());
    }

    #[test]
    fn what_is_too_long_or_senseless_is_refused() {
        assert!(matches!(Frame::parse(&[0, 0, 2, 1]), Err(WireError::TooLong(_))));
        assert!(matches!(Frame::parse(&[0, 0, 0, 0]), Err(WireError::Senseless)));
        assert!(matches!(Frame::parse(&[2, 0, 0, 0, b'c', b'{']), Err(WireError::Senseless)));
        assert!(matches!(Frame::parse(&[6, 0, 0, 0, b's', 0, 0, 0, 0, 1]), Err(WireError::Senseless)));
    }

    #[test]
    fn a_change_is_of_the_bits_under_its_mask() {
        let mut image = [0b1100, 0xAA, 7];
        Change { generation: 0, mask: vec![0b0110, 0], value: vec![0b1010, 0xFF] }.apply(&mut image);
        assert_eq!(image, [0b1010, 0xAA, 7]);
    }

    #[test]
    fn errors_keep_their_kind() {
        let error = io::Error::new(io::ErrorKind::ConnectionRefused, "no");
        let passed = io::Error::from(Broken::from(&error));
        assert_eq!((passed.kind(), passed.to_string()), (io::ErrorKind::ConnectionRefused, "no".to_owned()));
    }

    proptest! {
        #[test]
        fn no_bytes_make_it_panic(bytes in prop::collection::vec(any::<u8>(), 0..64)) {
            let _ = Frame::parse(&bytes);
        }
    }
}
