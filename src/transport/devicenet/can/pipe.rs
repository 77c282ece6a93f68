//! Byte stream with a queue in each direction, so that a write never waits for a read. The stream is either a serial
//! port with two threads, or a TCP connection with two tasks.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

use serialport::SerialPort;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio::sync::mpsc::{Receiver, Sender, UnboundedReceiver, UnboundedSender, channel, unbounded_channel};

use crate::vanished;

/// Maximum number of bytes per read. The constant below is the maximum number of pieces that wait for the reader.
const PIECE: usize = 4096;
const PIECES: usize = 64;
/// Timeout of a read. After each timeout, the thread checks whether the pipe still exists.
const SLICE: Duration = Duration::from_millis(20);
/// Write timeout of a port.
const STUCK: Duration = Duration::from_secs(2);

/// A byte stream.
#[derive(Debug)]
pub struct Pipe {
    writer: Writer,
    arriving: Receiver<io::Result<Vec<u8>>>,
}

/// Write half of a [`Pipe`].
#[derive(Debug, Clone)]
pub struct Writer {
    out: UnboundedSender<Vec<u8>>,
    waiting: Arc<AtomicUsize>,
}

/// The ends of the queues that the port or connection uses.
struct End {
    leaving: UnboundedReceiver<Vec<u8>>,
    waiting: Arc<AtomicUsize>,
    arrived: Sender<io::Result<Vec<u8>>>,
}

fn pair() -> (Pipe, End) {
    let (out, leaving) = unbounded_channel();
    let (arrived, arriving) = channel(PIECES);
    let waiting = Arc::new(AtomicUsize::new(0));
    let writer = Writer { out, waiting: Arc::clone(&waiting) };
    (Pipe { writer, arriving }, End { leaving, waiting, arrived })
}

impl Pipe {
    /// Opens a pipe over a TCP connection, with two tasks on the current runtime.
    pub fn tcp(stream: TcpStream) -> io::Result<Self> {
        stream.set_nodelay(true)?;
        let (pipe, mut end) = pair();
        let (mut reader, mut writer) = stream.into_split();
        let arrived = end.arrived.clone();
        tokio::spawn(async move {
            loop {
                let mut bytes = vec![0; PIECE];
                let read = tokio::select! {
                    read = reader.read(&mut bytes) => read,
                    () = arrived.closed() => return,
                };
                let read = match read {
                    Ok(0) => Err(vanished("the other end closed the connection")),
                    Ok(len) => {
                        bytes.truncate(len);
                        Ok(bytes)
                    }
                    Err(error) => Err(vanished(error)),
                };
                let is_end = read.is_err();
                if arrived.send(read).await.is_err() || is_end {
                    return;
                }
            }
        });
        tokio::spawn(async move {
            while let Some(bytes) = end.leaving.recv().await {
                // After an error, this task ends. The reader reports that the connection is closed.
                if writer.write_all(&bytes).await.is_err() {
                    return;
                }
                end.waiting.fetch_sub(bytes.len(), Ordering::Relaxed);
            }
        });
        Ok(pipe)
    }

    /// Opens a pipe over a serial port.
    pub fn serial(mut writer: Box<dyn SerialPort>) -> io::Result<Self> {
        let mut reader = writer.try_clone()?;
        reader.set_timeout(SLICE)?;
        writer.set_timeout(STUCK)?;
        let (pipe, mut end) = pair();
        let arrived = end.arrived.clone();
        thread::Builder::new().name("slcan-read".to_owned()).spawn(move || {
            while !arrived.is_closed() {
                let mut bytes = vec![0; PIECE];
                let read = match reader.read(&mut bytes) {
                    Ok(0) => Err(vanished("the port was closed")),
                    Ok(len) => {
                        bytes.truncate(len);
                        Ok(bytes)
                    }
                    Err(error) if matches!(error.kind(), io::ErrorKind::TimedOut | io::ErrorKind::Interrupted) => {
                        continue;
                    }
                    Err(error) => Err(vanished(error)),
                };
                let is_end = read.is_err();
                if arrived.blocking_send(read).is_err() || is_end {
                    return;
                }
            }
        })?;
        thread::Builder::new().name("slcan-write".to_owned()).spawn(move || {
            while let Some(bytes) = end.leaving.blocking_recv() {
                if let Err(error) = writer.write_all(&bytes) {
                    // An error means that the receiver was dropped.
                    let _ = end.arrived.blocking_send(Err(vanished(error)));
                    return;
                }
                end.waiting.fetch_sub(bytes.len(), Ordering::Relaxed);
            }
        })?;
        Ok(pipe)
    }

    /// Write half of the pipe.
    pub const fn writer(&self) -> &Writer {
        &self.writer
    }

    /// Waits for bytes. The future is cancel safe.
    ///
    /// # Errors
    /// The other end has closed the stream.
    pub async fn read(&mut self) -> io::Result<Vec<u8>> {
        self.arriving.recv().await.unwrap_or_else(|| Err(vanished("the connection was closed")))
    }
}

impl Writer {
    /// Creates a writer with a queue. The caller must empty the queue and report its progress with
    /// [`written`](Self::written).
    pub fn queue() -> (Self, UnboundedReceiver<Vec<u8>>) {
        let (out, leaving) = unbounded_channel();
        (Self { out, waiting: Arc::default() }, leaving)
    }

    /// Reports that `len` bytes were written.
    pub fn written(&self, len: usize) {
        self.waiting.fetch_sub(len, Ordering::Relaxed);
    }

    /// Queues bytes. If the stream is closed, [`Pipe::read`] reports the error.
    pub fn write(&self, bytes: &[u8]) {
        self.waiting.fetch_add(bytes.len(), Ordering::Relaxed);
        let _ = self.out.send(bytes.to_vec());
    }

    /// Number of bytes that are not written yet.
    pub fn waiting(&self) -> usize {
        self.waiting.load(Ordering::Relaxed)
    }
}
