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

use crate::closed_error;

/// Maximum number of bytes per read. The constant below is the maximum number of pieces that wait for the reader.
const READ_SIZE: usize = 4096;
const MAX_PIECES: usize = 64;
/// Timeout of a read. After each timeout, the thread checks whether the pipe still exists.
const READ_TIMEOUT: Duration = Duration::from_millis(20);
/// Write timeout of a port.
const WRITE_TIMEOUT: Duration = Duration::from_secs(2);

/// A byte stream.
#[derive(Debug)]
pub struct Pipe {
    /// Write half of the pipe.
    pub writer: Writer,
    incoming: Receiver<io::Result<Vec<u8>>>,
}

/// Write half of a [`Pipe`].
#[derive(Debug, Clone)]
pub struct Writer {
    out: UnboundedSender<Vec<u8>>,
    waiting: Arc<AtomicUsize>,
}

/// The ends of the queues that the port or connection uses.
struct End {
    outgoing: UnboundedReceiver<Vec<u8>>,
    waiting: Arc<AtomicUsize>,
    read_bytes: Sender<io::Result<Vec<u8>>>,
}

fn pair() -> (Pipe, End) {
    let (out, outgoing) = unbounded_channel();
    let (read_bytes, incoming) = channel(MAX_PIECES);
    let waiting = Arc::new(AtomicUsize::new(0));
    let writer = Writer { out, waiting: Arc::clone(&waiting) };
    (Pipe { writer, incoming }, End { outgoing, waiting, read_bytes })
}

impl Pipe {
    /// Opens a pipe over a TCP connection, with two tasks on the current runtime.
    pub fn tcp(stream: TcpStream) -> io::Result<Self> {
        stream.set_nodelay(true)?;
        let (pipe, mut end) = pair();
        let (mut reader, mut writer) = stream.into_split();
        let read_bytes = end.read_bytes.clone();
        tokio::spawn(async move {
            loop {
                let mut bytes = vec![0; READ_SIZE];
                let read = tokio::select! {
                    read = reader.read(&mut bytes) => read,
                    () = read_bytes.closed() => return,
                };
                let read = match read {
                    Ok(0) => Err(closed_error("the other end closed the connection")),
                    Ok(len) => {
                        bytes.truncate(len);
                        Ok(bytes)
                    }
                    Err(error) => Err(closed_error(error)),
                };
                let is_end = read.is_err();
                if read_bytes.send(read).await.is_err() || is_end {
                    return;
                }
            }
        });
        tokio::spawn(async move {
            while let Some(bytes) = end.outgoing.recv().await {
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
        reader.set_timeout(READ_TIMEOUT)?;
        writer.set_timeout(WRITE_TIMEOUT)?;
        let (pipe, mut end) = pair();
        let read_bytes = end.read_bytes.clone();
        thread::Builder::new().name("slcan-read".to_owned()).spawn(move || {
            while !read_bytes.is_closed() {
                let mut bytes = vec![0; READ_SIZE];
                let read = match reader.read(&mut bytes) {
                    Ok(0) => Err(closed_error("the port was closed")),
                    Ok(len) => {
                        bytes.truncate(len);
                        Ok(bytes)
                    }
                    Err(error) if matches!(error.kind(), io::ErrorKind::TimedOut | io::ErrorKind::Interrupted) => {
                        continue;
                    }
                    Err(error) => Err(closed_error(error)),
                };
                let is_end = read.is_err();
                if read_bytes.blocking_send(read).is_err() || is_end {
                    return;
                }
            }
        })?;
        thread::Builder::new().name("slcan-write".to_owned()).spawn(move || {
            while let Some(bytes) = end.outgoing.blocking_recv() {
                if let Err(error) = writer.write_all(&bytes) {
                    // An error means that the receiver was dropped.
                    let _ = end.read_bytes.blocking_send(Err(closed_error(error)));
                    return;
                }
                end.waiting.fetch_sub(bytes.len(), Ordering::Relaxed);
            }
        })?;
        Ok(pipe)
    }

    /// Waits for bytes. The future is cancel safe.
    ///
    /// # Errors
    /// The other end has closed the stream.
    pub async fn read(&mut self) -> io::Result<Vec<u8>> {
        self.incoming.recv().await.unwrap_or_else(|| Err(closed_error("the connection was closed")))
    }
}

impl Writer {
    /// Creates a writer with a queue. The caller must empty the queue and report its progress with
    /// [`written`](Self::written).
    pub fn queue() -> (Self, UnboundedReceiver<Vec<u8>>) {
        let (out, outgoing) = unbounded_channel();
        (Self { out, waiting: Arc::default() }, outgoing)
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
