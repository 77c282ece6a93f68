//! Codec for the encapsulation header: 24 bytes before every message, except cyclic data (volume 2, 2-3).

use super::{Reader, WireError, len16};

/// Length of the header in bytes.
pub const HEADER_LEN: usize = 24;

/// Encapsulation command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Command(pub u16);

impl Command {
    /// NOP. The device does not answer it.
    pub const NOP: Self = Self(0x00);
    /// List the services of the device.
    pub const LIST_SERVICES: Self = Self(0x04);
    /// List the identity of the device.
    pub const LIST_IDENTITY: Self = Self(0x63);
    /// List other interfaces of the device.
    pub const LIST_INTERFACES: Self = Self(0x64);
    /// Open a session.
    pub const REGISTER_SESSION: Self = Self(0x65);
    /// Close a session. The device does not answer this command.
    pub const UNREGISTER_SESSION: Self = Self(0x66);
    /// An unconnected CIP message or its reply.
    pub const SEND_RR_DATA: Self = Self(0x6F);
    /// A connected CIP message.
    pub const SEND_UNIT_DATA: Self = Self(0x70);
}

/// A message with its header.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame<'a> {
    /// Encapsulation command.
    pub command: Command,
    /// Session handle; 0 means no session.
    pub session: u32,
    /// Status; 0 in requests and successful replies.
    pub status: u32,
    /// Sender context: any bytes that the sender of the request selects. The reply contains the same bytes.
    pub context: [u8; 8],
    /// Command data, at most 65,535 bytes.
    pub data: &'a [u8],
}

impl<'a> Frame<'a> {
    /// Creates a request without data, outside of a session.
    pub const fn new(command: Command) -> Self {
        Self { command, session: 0, status: 0, context: [0; 8], data: &[] }
    }

    /// Decodes a complete message. The bytes come from [`Frames`] or from a datagram.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, WireError> {
        let mut reader = Reader::little(bytes);
        let command = Command(reader.u16("command")?);
        let len = usize::from(reader.u16("length")?);
        let session = reader.u32("session")?;
        let status = reader.u32("status")?;
        let context = reader.array("sender context")?;
        reader.u32("options")?;
        let data = reader.take(len, "data")?;
        reader.end("end of the message")?;
        Ok(Self { command, session, status, context, data })
    }

    /// Encodes the message.
    pub fn emit(&self) -> Vec<u8> {
        let mut out = Vec::with_capacity(HEADER_LEN + self.data.len());
        out.extend(self.command.0.to_le_bytes());
        out.extend(len16(self.data.len()));
        out.extend(self.session.to_le_bytes());
        out.extend(self.status.to_le_bytes());
        out.extend(self.context);
        out.extend([0; 4]);
        out.extend(self.data);
        out
    }

    /// Returns a RegisterSession request: protocol version 1, no options.
    pub const fn register(context: [u8; 8]) -> Frame<'static> {
        Frame { command: Command::REGISTER_SESSION, session: 0, status: 0, context, data: &[1, 0, 0, 0] }
    }

    /// Returns an UnregisterSession request.
    pub const fn unregister(session: u32) -> Frame<'static> {
        Frame { command: Command::UNREGISTER_SESSION, session, status: 0, context: [0; 8], data: &[] }
    }
}

/// Splitter of a TCP stream into messages. The length field of 16 bits limits the memory that a message needs.
#[derive(Debug, Clone, Default)]
pub struct Frames {
    bytes: Vec<u8>,
    /// Number of bytes that were already returned.
    done: usize,
}

impl Frames {
    /// Adds received bytes.
    pub fn push(&mut self, bytes: &[u8]) {
        // The bytes that `pop` has returned are removed here and not in `pop`, so that each byte is moved only once.
        self.bytes.drain(..self.done);
        self.done = 0;
        self.bytes.extend_from_slice(bytes);
    }

    /// Returns the next complete message with its header.
    pub fn pop(&mut self) -> Option<Vec<u8>> {
        let rest = self.bytes.get(self.done..)?;
        let header = rest.get(..HEADER_LEN)?;
        let len = HEADER_LEN + usize::from(u16::from_le_bytes([header[2], header[3]]));
        let message = rest.get(..len)?.to_vec();
        self.done += len;
        Some(message)
    }

    /// Drops all bytes. The driver calls this function when a new TCP connection opens.
    pub fn clear(&mut self) {
        self.bytes.clear();
        self.done = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::super::Problem;
    use super::*;
    use crate::testing::hex;

    /// The expected bytes are printed in volume 2, 2-4.4. The captures of cpppo contain the same bytes.
    #[test]
    fn registers_a_session_with_the_printed_bytes() {
        let bytes = hex("6500 0400 00000000 00000000 0000000000000000 00000000 01000000");
        assert_eq!(Frame::register([0; 8]).emit(), bytes);
        assert_eq!(Frame::parse(&bytes), Ok(Frame::register([0; 8])));
    }

    #[test]
    fn splits_a_stream_by_message_lengths() {
        let one = Frame::register(*b"context1").emit();
        let two = Frame::unregister(7).emit();
        let all = [one.clone(), two.clone(), one[..30.min(one.len() - 1)].to_vec()].concat();
        for size in 1..all.len() {
            let mut frames = Frames::default();
            let mut found = Vec::new();
            for part in all.chunks(size) {
                frames.push(part);
                while let Some(frame) = frames.pop() {
                    found.push(frame);
                }
            }
            assert_eq!(found, [one.clone(), two.clone()], "in parts of {size}");
        }
    }

    #[test]
    fn memory_of_many_messages_is_limited() {
        let mut frames = Frames::default();
        frames.push(&vec![0; HEADER_LEN * 10_000]);
        let messages: Vec<_> = std::iter::from_fn(|| frames.pop()).collect();
        assert_eq!(messages.len(), 10_000);
        assert!(messages.iter().all(|message| message.len() == HEADER_LEN && message.capacity() < 2 * HEADER_LEN));
        frames.push(&[0; HEADER_LEN]);
        assert_eq!(frames.pop(), Some(vec![0; HEADER_LEN]));
        assert_eq!((frames.pop(), frames.bytes.len()), (None, HEADER_LEN), "what was handed out is forgotten");
    }

    #[test]
    fn reports_a_wrong_length() {
        let mut bytes = Frame::register([0; 8]).emit();
        bytes.pop();
        let error = Frame::parse(&bytes).unwrap_err();
        assert_eq!((error.field, error.offset), ("data", 24));
        assert_eq!(error.problem, Problem::Short { needed: 4, present: 3 });
    }
}
