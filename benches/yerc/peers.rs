//! Minimal servers for the contenders: threads that block in a UDP socket.

use std::io;
use std::net::{Ipv4Addr, SocketAddr, UdpSocket};
use std::thread;

use armctl_controller::yerc::wire::{AnswerFrame, Division, HEADER_LEN, LAST_BLOCK, MAX_DATA, Status};

/// Size of the largest frame.
const BUFFER: usize = 2048;
/// Offset of the request id. The answer contains the same id (FS and DX 3.1).
pub const ID: usize = 11;
/// Offset of the block number.
pub const BLOCK: usize = 12;
/// Offset of the flag that distinguishes an ACK from a request.
pub const ACK: usize = 10;

/// Sizes of the frames of a status exchange: a request without data, and an answer with two words.
pub const STATUS_REQUEST: usize = HEADER_LEN;
/// See [`STATUS_REQUEST`].
pub const STATUS_ANSWER: usize = HEADER_LEN + 8;

/// The two servers of a controller. They end with the process.
pub struct Controller {
    /// Robot server: answers every request like a status request.
    pub robot: SocketAddr,
    /// File server: has one file, and accepts every file name.
    pub file: SocketAddr,
}

impl Controller {
    /// Starts both servers, with a file of `size` bytes.
    pub fn start(size: u64) -> io::Result<Self> {
        Ok(Self { robot: serve(status())?, file: serve(file(size))? })
    }

    /// Returns the target for a command line.
    pub fn url(&self) -> String {
        format!("udp://{}?file_port={}", self.robot, self.file.port())
    }
}

/// Answers datagrams on a free port. `respond` writes the content of the answer into the buffer; an empty buffer means
/// no answer.
fn serve(mut respond: impl FnMut(&[u8], &mut Vec<u8>) + Send + 'static) -> io::Result<SocketAddr> {
    let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0))?;
    let address = socket.local_addr()?;
    thread::spawn(move || {
        let mut buffer = [0; BUFFER];
        let mut answer = Vec::with_capacity(BUFFER);
        while let Ok((len, client)) = socket.recv_from(&mut buffer) {
            respond(&buffer[..len], &mut answer);
            // An error is ignored: the client may have closed its socket.
            if !answer.is_empty() {
                let _gone = socket.send_to(&answer, client);
            }
        }
    });
    Ok(address)
}

/// Answers with play mode and servo on. All answers are equal except for the id.
fn status() -> impl FnMut(&[u8], &mut Vec<u8>) {
    let mut frame = answer(Division::Robot, 0x81, LAST_BLOCK, &[0x42, 0, 0, 0, 0x40, 0, 0, 0]);
    move |request, out| {
        frame[ID] = request[ID];
        out.clear();
        out.extend(&frame);
    }
}

/// Answers a request with block 1 and each ACK with the next block. The last ACK gets no answer.
fn file(size: u64) -> impl FnMut(&[u8], &mut Vec<u8>) {
    let content = [0xA5; MAX_DATA];
    let blocks = u32::try_from(size.div_ceil(MAX_DATA as u64)).expect("files of a benchmark are small");
    let rest = usize::try_from(size).map_or(0, |size| size - (blocks.saturating_sub(1) as usize) * MAX_DATA);
    let mut full = answer(Division::File, 0x96, 0, &content);
    let mut last = answer(Division::File, 0x96, 0, &content[..rest.min(MAX_DATA)]);
    move |request, out| {
        out.clear();
        let next = if request[ACK] == 0 { 1 } else { block(request).saturating_add(1) };
        let (frame, mark) = match next {
            next if next < blocks => (&mut full, 0),
            next if next == blocks => (&mut last, LAST_BLOCK),
            _ => return,
        };
        frame[ID] = request[ID];
        frame[BLOCK..BLOCK + 4].copy_from_slice(&(next | mark).to_le_bytes());
        out.extend(&*frame);
    }
}

/// Block number of a frame.
pub fn block(frame: &[u8]) -> u32 {
    u32::from_le_bytes(frame[BLOCK..BLOCK + 4].try_into().expect("four bytes"))
}

fn answer(division: Division, service: u8, block: u32, data: &[u8]) -> Vec<u8> {
    AnswerFrame { division, ack: true, id: 0, block, service, status: Status::OK, data }.emit()
}
