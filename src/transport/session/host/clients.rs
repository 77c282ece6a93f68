//! Clients of a host, with the tasks that read and write their sockets.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tokio::sync::{Notify, mpsc};
use tokio::task::JoinHandle;
use tokio::time::{Instant, timeout_at};

use crate::session::direct::HostEnds;
use crate::session::milliseconds;
use crate::session::socket::{ReadHalf, WriteHalf};
use crate::session::wire::{Change, Control, Frame, Peer, Purpose, Reader, WireError};

/// Number of a client, and a frame from this client. The frame is `None` when the client has disconnected.
pub type ClientFrame = (u64, Option<Frame>);

/// Maximum number of frames that wait for a client. If more frames wait, the host removes the client.
const MAX_QUEUE: usize = 1024;
/// Time limit for the Hello frame of a new client.
const HELLO_TIMEOUT: Duration = Duration::from_secs(3);
/// Time limit for the last frame to a client.
const LAST_FRAME_TIMEOUT: Duration = Duration::from_millis(300);

/// A client of the session.
#[derive(Debug)]
pub struct Client {
    outbox: Arc<Outbox>,
    reading: JoinHandle<()>,
    /// Process id of the client, if the system reports it.
    pid: Option<u32>,
    /// Process id and command from the Hello of the client; `None` before the Hello.
    name: Option<(u32, String)>,
    /// Purpose of the client's connection.
    pub purpose: Purpose,
    /// Whether the client has sent Bye.
    pub has_left: bool,
    /// Last will: the change to send if the client is killed.
    pub will: Option<Change>,
    /// Time at which the client connected.
    pub since: Instant,
    /// Time at which the client got the line.
    pub line_since: Instant,
    /// Time at which the client was allowed to move the robot.
    pub motion_since: Instant,
}

impl Client {
    /// Creates a client of another process, and starts its tasks. Received frames are sent to `inbox_sender`.
    pub fn new(
        id: u64,
        (read, write, pid): (ReadHalf, WriteHalf, Option<u32>),
        inbox_sender: mpsc::Sender<ClientFrame>,
    ) -> Self {
        Self::over(id, (Source::Socket(Reader::new(read)), Target::Socket(write)), pid, inbox_sender)
    }

    /// Creates a client of this process.
    pub fn in_process(id: u64, ends: HostEnds, inbox_sender: mpsc::Sender<ClientFrame>) -> Self {
        let HostEnds { from_client, to_client } = ends;
        let ends = (Source::Channel(from_client), Target::Channel(to_client));
        Self::over(id, ends, Some(std::process::id()), inbox_sender)
    }

    fn over(
        id: u64,
        (source, target): (Source, Target),
        pid: Option<u32>,
        inbox_sender: mpsc::Sender<ClientFrame>,
    ) -> Self {
        let outbox = Arc::new(Outbox::default());
        let now = Instant::now();
        // This task ends when the outbox is closed.
        tokio::spawn(write_all(target, Arc::clone(&outbox)));
        Self {
            reading: tokio::spawn(read_all(id, source, inbox_sender)),
            outbox,
            pid,
            name: None,
            purpose: Purpose::Any,
            has_left: false,
            will: None,
            since: now,
            line_since: now,
            motion_since: now,
        }
    }

    /// Stores the data from the Hello of the client.
    pub fn set_name(&mut self, pid: u32, command: String) {
        self.name = Some((self.pid.unwrap_or(pid), command));
    }

    /// Whether the Hello of the client has arrived.
    pub fn is_named(&self) -> bool {
        self.name.is_some()
    }

    /// Describes the client for the other clients.
    pub fn peer(&self, since: Instant) -> Peer {
        let (pid, command) = self.name.clone().unwrap_or((self.pid.unwrap_or_default(), String::new()));
        Peer { pid, command, for_ms: milliseconds(since) }
    }

    pub fn send(&self, frame: Frame) {
        self.outbox.push(frame);
    }

    pub fn send_control(&self, control: Control) {
        self.send(Frame::Control(control));
    }

    /// Sends a last frame. The connection stays open until the client is dropped.
    pub async fn dismiss(&self, control: Control) {
        self.send_control(control);
        // The wait has a time limit, so that a client that does not read cannot delay the end of the session.
        let _ = timeout_at(Instant::now() + LAST_FRAME_TIMEOUT, self.outbox.wait_until_written()).await;
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        self.outbox.close();
        self.reading.abort();
    }
}

/// Where the frames of a client come from.
enum Source {
    Socket(Reader),
    Channel(mpsc::UnboundedReceiver<Frame>),
}

impl Source {
    async fn next(&mut self) -> Result<Option<Frame>, WireError> {
        match self {
            Self::Socket(reader) => reader.next().await,
            Self::Channel(frames) => Ok(frames.recv().await),
        }
    }
}

/// Where the frames to a client go.
enum Target {
    Socket(WriteHalf),
    Channel(mpsc::Sender<Frame>),
}

impl Target {
    /// Writes the frames. Returns `false` if the client has disconnected.
    async fn write(&mut self, frames: VecDeque<Frame>) -> bool {
        match self {
            Self::Socket(socket) => {
                let mut bytes = Vec::new();
                for frame in &frames {
                    frame.emit(&mut bytes);
                }
                write_bytes(socket, &bytes).await
            }
            Self::Channel(channel) => {
                for frame in frames {
                    if channel.send(frame).await.is_err() {
                        return false;
                    }
                }
                true
            }
        }
    }
}

async fn write_bytes(socket: &WriteHalf, mut bytes: &[u8]) -> bool {
    while !bytes.is_empty() {
        if socket.writable().await.is_err() {
            return false;
        }
        match socket.try_write(bytes) {
            Ok(sent) => bytes = &bytes[sent..],
            Err(error) if error.kind() == std::io::ErrorKind::WouldBlock => {}
            Err(_) => return false,
        }
    }
    true
}

async fn read_all(id: u64, mut source: Source, inbox_sender: mpsc::Sender<ClientFrame>) {
    let mut is_named = false;
    loop {
        // A client has a time limit for its Hello, because it occupies one of the places for clients. After its Hello,
        // it may be silent.
        let deadline = Instant::now() + HELLO_TIMEOUT;
        let frame =
            if is_named { source.next().await } else { timeout_at(deadline, source.next()).await.unwrap_or(Ok(None)) };
        // An invalid frame also ends the connection.
        let frame = frame.unwrap_or(None);
        let is_end = frame.is_none();
        is_named = is_named || matches!(frame, Some(Frame::Control(Control::Hello(_))));
        if inbox_sender.send((id, frame)).await.is_err() || is_end {
            return;
        }
    }
}

async fn write_all(mut target: Target, outbox: Arc<Outbox>) {
    loop {
        let (frames, is_closed) = outbox.take();
        let is_empty = frames.is_empty();
        // If the client has disconnected, the reading task reports it.
        if !target.write(frames).await || is_closed {
            return;
        }
        if is_empty {
            outbox.changed.notified().await;
        }
    }
}

/// Queue of frames to a client. Of several images in a row, only the newest is sent.
#[derive(Debug, Default)]
struct Outbox {
    queue: Mutex<Queue>,
    changed: Notify,
    /// Notified when all frames are written.
    drained: Notify,
}

#[derive(Debug, Default)]
struct Queue {
    frames: VecDeque<Frame>,
    is_closed: bool,
    /// Whether frames that were taken from the queue are being written.
    is_writing: bool,
}

impl Outbox {
    fn queue(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn push(&self, frame: Frame) {
        let mut queue = self.queue();
        if queue.frames.len() >= MAX_QUEUE {
            queue.frames.clear();
            queue.is_closed = true;
        }
        if !queue.is_closed {
            if matches!((queue.frames.back(), &frame), (Some(Frame::Image(_)), Frame::Image(_))) {
                queue.frames.pop_back();
            }
            queue.frames.push_back(frame);
        }
        self.changed.notify_one();
    }

    fn close(&self) {
        self.queue().is_closed = true;
        self.changed.notify_one();
    }

    fn take(&self) -> (VecDeque<Frame>, bool) {
        let mut queue = self.queue();
        queue.is_writing = !queue.frames.is_empty();
        if !queue.is_writing {
            self.drained.notify_waiters();
        }
        (std::mem::take(&mut queue.frames), queue.is_closed)
    }

    async fn wait_until_written(&self) {
        loop {
            let drained = self.drained.notified();
            {
                let queue = self.queue();
                if queue.frames.is_empty() && !queue.is_writing {
                    return;
                }
            }
            drained.await;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sends_only_the_last_of_several_images() {
        let outbox = Outbox::default();
        for frame in
            [Frame::Image(vec![1]), Frame::Image(vec![2]), Frame::Control(Control::Sent), Frame::Image(vec![3])]
        {
            outbox.push(frame);
        }
        let (frames, is_closed) = outbox.take();
        assert_eq!(frames, [Frame::Image(vec![2]), Frame::Control(Control::Sent), Frame::Image(vec![3])]);
        assert!(!is_closed);
    }

    #[test]
    fn disconnects_a_client_that_never_reads() {
        let outbox = Outbox::default();
        for _ in 0..=MAX_QUEUE {
            outbox.push(Frame::Control(Control::Sent));
        }
        assert!(outbox.take().1);
    }
}
