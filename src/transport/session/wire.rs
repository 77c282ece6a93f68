//! Frames between a session host and its clients.
//!
//! A frame has a length of 4 bytes (little-endian), a type byte, and the content. The length is the number of bytes
//! after it. Control frames are JSON. Frequent frames are binary.

use crate::refuse_if;
use std::io;

use serde::{Deserialize, Serialize};
use thiserror::Error;
use tokio::io::AsyncReadExt as _;

use super::socket::ReadHalf;

/// Protocol version. Host and client must have the same version.
pub const VERSION: u32 = 3;

/// Maximum length of a frame in bytes. It is longer than any datagram or image.
const MAX_FRAME: usize = 1 << 17;
const HEAD: usize = 4;
/// Maximum length of a text about a client or host.
pub const MAX_TEXT: usize = 300;

/// One frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Frame {
    /// A control message. Control messages are rare.
    Control(Control),
    /// Image from the device.
    Image(Vec<u8>),
    /// Change of the image to the device. A client requests a change, or the host reports a change of another client.
    Show(Change),
    /// A datagram, or bytes of a stream.
    Data {
        /// Channel of the device.
        channel: u8,
        /// Content.
        bytes: Vec<u8>,
    },
}

/// Change of an image: the bits in `mask` get the values in `value`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Change {
    /// Generation of the link. The host drops a change of an older generation. So a change from before a loss is not
    /// applied after the loss.
    pub generation: u32,
    /// Bits to change.
    pub mask: Vec<u8>,
    /// New values of the bits. It has the same length as the mask.
    pub value: Vec<u8>,
}

impl Change {
    /// Applies the change to an image.
    pub fn apply(&self, image: &mut [u8]) {
        for ((byte, mask), value) in image.iter_mut().zip(&self.mask).zip(&self.value) {
            *byte = (*byte & !mask) | (value & mask);
        }
    }
}

/// A control message.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Control {
    /// Client: identification of the client and the device.
    Hello(Hello),
    /// Client: request for the status.
    Ask,
    /// Client: request to end the session.
    Close {
        /// Whether to end the session even during a motion.
        force: bool,
    },
    /// Client: request for the line.
    Take {
        /// Number of the request. If the client gets the line, the answer contains this number.
        number: u32,
        /// Channel of the device.
        channel: u8,
    },
    /// Client: releases the line, or leaves the queue for the line.
    Over,
    /// Client: request to move the robot.
    Motion,
    /// Client: request for a new socket for this channel.
    Renew(u8),
    /// Client: sets or removes the last will.
    Will(Option<Change>),
    /// Client: detaches normally.
    Bye,

    /// Host: state of the session for a new client.
    Welcome(Box<Welcome>),
    /// Host: status of the session.
    Status(Box<Status>),
    /// Host: refusal with the reason.
    Refused(String),
    /// Host: the session ends.
    Closing,
    /// Host: the client owns the line. Contains the number of the request.
    Taken(u32),
    /// Host: the client is in the queue, because another client owns the line. Contains that client.
    Queued(Peer),
    /// Host: the client may move the robot.
    Granted,
    /// Host: the client may not move the robot, because another client moves it. Contains that client.
    Held(Peer),
    /// Host: the last image of the client was sent.
    Sent,
    /// Host: the link was lost for this reason.
    Lost(String),
    /// Host: the link is open again.
    Reopened {
        /// Generation of the link.
        generation: u32,
        /// Current image to the device.
        shown: Vec<u8>,
    },
    /// Host: an exchange with the device failed while sending or receiving.
    Broken(Broken),
    /// Host: a frame was refused, because the robot is read-only.
    Denied {
        /// Image that the device really gets; `None` if the link has no images.
        shown: Option<Vec<u8>>,
    },
    /// Host: the session has ended for this reason.
    Ended(String),
}

/// Identification of a client.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Hello {
    /// Protocol version; see [`VERSION`].
    pub version: u32,
    /// Key of the session.
    pub key: String,
    /// Process id.
    pub pid: u32,
    /// Command line.
    pub command: String,
    /// Purpose of the connection.
    pub purpose: Purpose,
}

/// Purpose of a connection. It decides which client gets the line first, and what the host does if the client is
/// killed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Purpose {
    /// Any command. If the client is killed, the host stops the motion of the client.
    #[default]
    Any,
    /// A command whose motion continues if the client is killed.
    LeavesMotion,
    /// A stop of the robot. This client gets the line before all other clients.
    Stop,
}

/// Description of a client, which other clients receive.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Peer {
    /// Process id.
    pub pid: u32,
    /// Command line.
    pub command: String,
    /// Time in ms after the client got the line or started to move the robot.
    pub for_ms: u64,
}

/// State of the session for a new client.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Welcome {
    /// Protocol version; see [`VERSION`].
    pub version: u32,
    /// Process id of the host.
    pub pid: u32,
    /// Age of the session in ms.
    pub for_ms: u64,
    /// Reason why the link is down; `None` while it is up.
    pub down: Option<String>,
    /// Active command of an earlier client that did not wait for the end of the command.
    pub leftover: Option<Leftover>,
    /// State of the images, if the link has images.
    pub images: Option<Images>,
}

/// State of an image link for a new client.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Images {
    /// Generation of the link.
    pub generation: u32,
    /// Size of the exclusive part in bytes. This part is at the start of the image, and only the owner of the line can
    /// change it.
    pub exclusive: usize,
    /// Image to the device.
    pub shown: Vec<u8>,
    /// Image from the device.
    pub seen: Option<Vec<u8>>,
    /// Time without an image after which either end gives the link up.
    #[serde(default)]
    pub watchdog_ms: u64,
}

/// Command that is still active in the exclusive part of the image. Its client has ended or crashed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Leftover {
    /// The client that sent the command.
    pub by: Peer,
    /// Whether the client ended without detaching, because it was killed or crashed.
    pub died: bool,
}

/// Status of a session.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Status {
    /// Protocol version; see [`VERSION`]. It is 0 if the host is so old that it does not send this field.
    #[serde(default)]
    pub version: u32,
    /// Device and host process.
    pub info: Info,
    /// Age of the session in ms.
    pub for_ms: u64,
    /// Reason why the link is down; `None` while it is up.
    pub down: Option<String>,
    /// Number of times that the link was reopened.
    pub reopenings: u32,
    /// Current clients.
    pub clients: Vec<Peer>,
    /// Client that moves the robot; `None` if no client does.
    pub motion: Option<Peer>,
    /// Active command of an earlier client that did not wait for the end of the command.
    pub leftover: Option<Leftover>,
    /// Whether the robot is moving.
    pub under_way: bool,
}

/// Device and process of a session, or of a command that has its own link. The lock file contains this information.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Info {
    /// Process id.
    pub pid: u32,
    /// Name of the robot.
    pub robot: String,
    /// Family of the robot's controller.
    pub family: String,
    /// Target URL.
    pub target: String,
    /// Command line of the process. It is empty if an old version wrote the information without this field.
    #[serde(default)]
    pub command: String,
}

impl Info {
    /// Creates the information about this process and this command.
    pub fn own(robot: &str, family: &str, target: &str, command: &str) -> Self {
        let (robot, family, target) = (robot.to_owned(), family.to_owned(), target.to_owned());
        Self { pid: super::process(), robot, family, target, command: shorten(command) }
    }
}

/// Error of an operation of the host on the link.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Broken {
    /// Kind of the error.
    pub kind: BrokenKind,
    /// Text of the error.
    pub text: String,
}

/// Error kinds that clients must be able to distinguish.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BrokenKind {
    /// The connection is closed.
    NotConnected,
    /// No program listens on the port.
    ConnectionRefused,
    /// The host is unreachable.
    HostUnreachable,
    /// The network is unreachable.
    NetworkUnreachable,
    /// A send did not complete in time.
    TimedOut,
    /// Any other error.
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

/// Error of a received frame.
#[derive(Debug, Error)]
pub enum WireError {
    /// The frame is too long.
    #[error("a frame of {0} bytes")]
    TooLong(usize),
    /// The frame type is unknown, or the content is invalid.
    #[error("an invalid frame")]
    Invalid,
    /// The socket failed.
    #[error("{0}")]
    Io(#[from] io::Error),
}

const CONTROL: u8 = b'c';
const IMAGE: u8 = b'i';
const SHOW: u8 = b's';
const DATA: u8 = b'd';

impl Frame {
    /// Appends the encoded frame to `out`. The frame always fits: images and datagrams have at most 65535 bytes, and
    /// texts are shortened.
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

    /// Decodes the first frame of a buffer. Returns the frame and its length. Returns `None` if the frame is not
    /// complete yet.
    ///
    /// # Errors
    /// The frame is too long or invalid. The stream has no valid frame after it.
    pub fn parse(bytes: &[u8]) -> Result<Option<(Self, usize)>, WireError> {
        let Some((head, rest)) = bytes.split_first_chunk::<HEAD>() else { return Ok(None) };
        let length = usize::try_from(u32::from_le_bytes(*head)).unwrap_or(usize::MAX);
        refuse_if(length > MAX_FRAME, WireError::TooLong(length))?;
        let Some(content) = rest.get(..length) else { return Ok(None) };
        let frame = match content {
            [CONTROL, json @ ..] => Self::Control(serde_json::from_slice(json).map_err(|_| WireError::Invalid)?),
            [IMAGE, bytes @ ..] => Self::Image(bytes.to_vec()),
            [SHOW, rest @ ..] => {
                let (generation, bits) = rest.split_first_chunk().ok_or(WireError::Invalid)?;
                refuse_if(bits.len() % 2 != 0, WireError::Invalid)?;
                let (mask, value) = bits.split_at(bits.len() / 2);
                let (mask, value) = (mask.to_vec(), value.to_vec());
                Self::Show(Change { generation: u32::from_le_bytes(*generation), mask, value })
            }
            [DATA, channel, bytes @ ..] => Self::Data { channel: *channel, bytes: bytes.to_vec() },
            _ => return Err(WireError::Invalid),
        };
        Ok(Some((frame, HEAD + length)))
    }
}

/// Reader of frames from a socket.
#[derive(Debug)]
pub struct Reader {
    socket: ReadHalf,
    buffer: Vec<u8>,
}

impl Reader {
    /// Creates a reader.
    pub fn new(socket: ReadHalf) -> Self {
        Self { socket, buffer: Vec::new() }
    }

    /// Waits for the next frame. Returns `None` after the other side has closed the connection. The future is cancel
    /// safe.
    pub async fn next(&mut self) -> Result<Option<Frame>, WireError> {
        loop {
            if let Some((frame, length)) = Frame::parse(&self.buffer)? {
                self.buffer.drain(..length);
                return Ok(Some(frame));
            }
            if self.socket.read_buf(&mut self.buffer).await? == 0 {
                return Ok(None);
            }
        }
    }
}

/// Replaces control characters in a text, and limits its length.
pub fn shorten(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).take(MAX_TEXT).collect()
}

#[cfg(test)]
mod tests {
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
    fn control_frames_round_trip() {
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
    fn rejects_too_long_and_invalid_frames() {
        assert!(matches!(Frame::parse(&[0, 0, 2, 1]), Err(WireError::TooLong(_))));
        assert!(matches!(Frame::parse(&[0, 0, 0, 0]), Err(WireError::Invalid)));
        assert!(matches!(Frame::parse(&[2, 0, 0, 0, b'c', b'{']), Err(WireError::Invalid)));
        assert!(matches!(Frame::parse(&[6, 0, 0, 0, b's', 0, 0, 0, 0, 1]), Err(WireError::Invalid)));
    }

    #[test]
    fn a_change_is_of_the_bits_under_its_mask() {
        let mut image = [0b1100, 0xAA, 7];
        Change { generation: 0, mask: vec![0b0110, 0], value: vec![0b1010, 0xFF] }.apply(&mut image);
        assert_eq!(image, [0b1010, 0xAA, 7]);
    }

    #[test]
    fn errors_round_trip_with_their_kind() {
        let error = io::Error::new(io::ErrorKind::ConnectionRefused, "no");
        let passed = io::Error::from(Broken::from(&error));
        assert_eq!((passed.kind(), passed.to_string()), (io::ErrorKind::ConnectionRefused, "no".to_owned()));
    }
}
