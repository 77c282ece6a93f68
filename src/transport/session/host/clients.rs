//! The clients of a host: what comes from each, and what goes to it.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tokio::sync::{Notify, mpsc};
use tokio::task::JoinHandle;
use tokio::time::{Instant, timeout_at};

use crate::session::socket::{ReadHalf, WriteHalf};
use crate::session::wire::{Change, Control, Frame, Peer, Purpose, Reader};

/// What came from whom; `None` when he has gone.
pub type Letter = (u64, Option<Frame>);

/// Frames that may wait for a client that does not read. More, and it is given up.
const MOST_WAITING: usize = 1024;
/// How long a client may be silent before it has said who it is.
const FIRST_WORDS: Duration = Duration::from_secs(3);
/// How long the last words to a client may take.
const LAST_WORDS: Duration = Duration::from_millis(300);

/// A client.
#[derive(Debug)]
pub struct Client {
    outbox: Arc<Outbox>,
    reading: JoinHandle<()>,
    /// Its process, where the system tells.
    pid: Option<u32>,
    /// What it says it is; `None` before its hello.
    name: Option<(u32, String)>,
    /// What it comes for.
    pub purpose: Purpose,
    /// Whether it said that it leaves.
    pub has_left: bool,
    /// What the device is shown if it dies.
    pub will: Option<Change>,
    /// Since when it is there, has the line, may move.
    pub since: Instant,
    /// Since when it has the line.
    pub line_since: Instant,
    /// Since when it may move the robot.
    pub motion_since: Instant,
}

impl Client {
    /// Serves a connection; what comes goes into the letterbox.
    pub fn new(
        id: u64,
        (read, write, pid): (ReadHalf, WriteHalf, Option<u32>),
        letterbox: mpsc::Sender<Letter>,
    ) -> Self {
        let outbox = Arc::new(Outbox::default());
        let now = Instant::now();
        // It ends when the outbox is closed.
        tokio::spawn(write_all(write, Arc::clone(&outbox)));
        Self {
            reading: tokio::spawn(read_all(id, Reader::new(read), letterbox)),
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

    /// It has said who it is.
    pub fn named(&mut self, pid: u32, command: String) {
        self.name = Some((self.pid.unwrap_or(pid), command));
    }

    /// Whether it has said who it is.
    pub fn is_named(&self) -> bool {
        self.name.is_some()
    }

    /// To others.
    pub fn peer(&self, since: Instant) -> Peer {
        let (pid, command) = self.name.clone().unwrap_or((self.pid.unwrap_or_default(), String::new()));
        Peer { pid, command, for_ms: milliseconds(since) }
    }

    /// Sends it something.
    pub fn send(&self, frame: Frame) {
        self.outbox.push(frame);
    }

    /// Sends it something rare.
    pub fn tell(&self, control: Control) {
        self.send(Frame::Control(control));
    }

    /// Tells it the last thing; the connection stays until the client is dropped.
    pub async fn dismiss(&self, control: Control) {
        self.tell(control);
        // One that does not read must not hold up the end.
        let _ = timeout_at(Instant::now() + LAST_WORDS, self.outbox.emptied()).await;
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        self.outbox.close();
        self.reading.abort();
    }
}

/// How long ago that was.
pub fn milliseconds(since: Instant) -> u64 {
    u64::try_from(since.elapsed().as_millis()).unwrap_or(u64::MAX)
}

async fn read_all(id: u64, mut reader: Reader, letterbox: mpsc::Sender<Letter>) {
    let mut is_named = false;
    loop {
        // Who has said who he is may be silent; anybody else only takes up a place.
        let deadline = Instant::now() + FIRST_WORDS;
        let frame =
            if is_named { reader.next().await } else { timeout_at(deadline, reader.next()).await.unwrap_or(Ok(None)) };
        // What is no frame is the end, too.
        let frame = frame.unwrap_or(None);
        let is_end = frame.is_none();
        is_named = is_named || matches!(frame, Some(Frame::Control(Control::Hello(_))));
        if letterbox.send((id, frame)).await.is_err() || is_end {
            return;
        }
    }
}

async fn write_all(socket: WriteHalf, outbox: Arc<Outbox>) {
    let mut bytes = Vec::new();
    loop {
        let (frames, is_closed) = outbox.take();
        for frame in &frames {
            frame.emit(&mut bytes);
        }
        while !bytes.is_empty() {
            // A client that is gone is noticed by its reader.
            if socket.writable().await.is_err() {
                return;
            }
            match socket.try_write(&bytes) {
                Ok(sent) => drop(bytes.drain(..sent)),
                Err(error) if error.kind() == std::io::ErrorKind::WouldBlock => {}
                Err(_) => return,
            }
        }
        if is_closed {
            return;
        }
        if frames.is_empty() {
            outbox.news.notified().await;
        }
    }
}

/// Frames on their way to a client. Of images that wait behind each other only the last one is worth sending.
#[derive(Debug, Default)]
struct Outbox {
    waiting: Mutex<Waiting>,
    news: Notify,
    /// All was written.
    empty: Notify,
}

#[derive(Debug, Default)]
struct Waiting {
    frames: VecDeque<Frame>,
    is_closed: bool,
    /// Whether some that were taken are being written.
    is_writing: bool,
}

impl Outbox {
    fn waiting(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn push(&self, frame: Frame) {
        let mut waiting = self.waiting();
        if waiting.frames.len() >= MOST_WAITING {
            waiting.frames.clear();
            waiting.is_closed = true;
        }
        if !waiting.is_closed {
            if matches!((waiting.frames.back(), &frame), (Some(Frame::Image(_)), Frame::Image(_))) {
                waiting.frames.pop_back();
            }
            waiting.frames.push_back(frame);
        }
        self.news.notify_one();
    }

    fn close(&self) {
        self.waiting().is_closed = true;
        self.news.notify_one();
    }

    fn take(&self) -> (VecDeque<Frame>, bool) {
        let mut waiting = self.waiting();
        waiting.is_writing = !waiting.frames.is_empty();
        if !waiting.is_writing {
            self.empty.notify_waiters();
        }
        (std::mem::take(&mut waiting.frames), waiting.is_closed)
    }

    async fn emptied(&self) {
        loop {
            let empty = self.empty.notified();
            {
                let waiting = self.waiting();
                if waiting.frames.is_empty() && !waiting.is_writing {
                    return;
                }
            }
            empty.await;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_images_in_a_row_the_last_one_goes() {
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
    fn a_client_that_never_reads_is_given_up() {
        let outbox = Outbox::default();
        for _ in 0..=MOST_WAITING {
            outbox.push(Frame::Control(Control::Sent));
        }
        assert!(outbox.take().1);
    }
}
