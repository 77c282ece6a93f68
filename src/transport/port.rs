//! Serial port whose reads and writes run on a blocking thread of tokio, one at a time.
//!
//! tokio's reactor could wait for a serial port only on Unix, and only with unsafe code. A read takes at most
//! [`READ_TIMEOUT`], so a write waits at most this long for the port. All futures are cancel safe: received bytes are kept for
//! the next [`Threaded::receive`], and a started write is completed.

use std::collections::VecDeque;
use std::io;
use std::time::Duration;

use serialport::{ClearBuffer, SerialPort};
use tokio::task::JoinHandle;
use tokio::time::{Instant, timeout_at};

use super::closed_error;

/// Maximum duration of a read. The timeout of the port must be set to this value.
pub(super) const READ_TIMEOUT: Duration = Duration::from_millis(10);
/// Maximum number of bytes per read.
const READ_SIZE: usize = 1024;

pub(super) type Port = Box<dyn SerialPort>;

/// A serial port with an async interface.
#[derive(Debug)]
pub(super) struct Threaded {
    state: State,
    /// Bytes that were read from the port, but not yet returned to the caller.
    arrived: VecDeque<u8>,
}

#[derive(Debug)]
enum State {
    Idle(Port),
    /// A thread uses the port. When the thread ends, it returns the port and the bytes that it read.
    Busy {
        reader_task: JoinHandle<(Port, io::Result<Vec<u8>>)>,
        /// Whether the bytes of this read must be dropped.
        is_stale: bool,
    },
    /// The thread ended without returning the port.
    Lost,
}

impl Threaded {
    /// Wraps a port whose timeout is [`READ_TIMEOUT`].
    pub(super) fn new(port: Port) -> Self {
        Self { state: State::Idle(port), arrived: VecDeque::new() }
    }

    /// Writes bytes to the port.
    ///
    /// # Errors
    /// [`NotConnected`](io::ErrorKind::NotConnected) if the port is gone, [`TimedOut`](io::ErrorKind::TimedOut) if the
    /// port does not accept the bytes within `longest`.
    pub(super) async fn send(&mut self, bytes: &[u8], longest: Duration) -> io::Result<()> {
        self.settle().await?;
        let bytes = bytes.to_vec();
        self.begin(move |port| write(port, &bytes, longest).map(|()| Vec::new()));
        self.settle().await
    }

    /// Waits until `until` for bytes. Returns `None` after a timeout.
    ///
    /// # Errors
    /// [`NotConnected`](io::ErrorKind::NotConnected) if the port is gone.
    pub(super) async fn receive(&mut self, buffer: &mut [u8], until: Instant) -> io::Result<Option<usize>> {
        while self.arrived.is_empty() {
            if matches!(self.state, State::Idle(_)) {
                self.begin(read);
            }
            match timeout_at(until, self.settle()).await {
                Ok(settled) => settled?,
                Err(_) => return Ok(None),
            }
        }
        io::Read::read(&mut self.arrived, buffer).map(Some)
    }

    /// Drops all received bytes.
    pub(super) fn discard(&mut self) {
        self.arrived.clear();
        match &mut self.state {
            State::Idle(port) => clear(port.as_ref()),
            State::Busy { is_stale, .. } => *is_stale = true,
            State::Lost => {}
        }
    }

    /// Runs `work` with the port on a thread.
    fn begin(&mut self, work: impl FnOnce(&mut Port) -> io::Result<Vec<u8>> + Send + 'static) {
        self.state = match std::mem::replace(&mut self.state, State::Lost) {
            State::Idle(mut port) => {
                let reader_task = tokio::task::spawn_blocking(move || {
                    let done = work(&mut port);
                    (port, done)
                });
                State::Busy { reader_task, is_stale: false }
            }
            state => state,
        };
    }

    /// Waits until the thread returns the port.
    async fn settle(&mut self) -> io::Result<()> {
        match &mut self.state {
            State::Idle(_) => Ok(()),
            State::Lost => Err(closed_error("the thread of the port has ended")),
            State::Busy { reader_task, is_stale } => {
                let done = reader_task.await;
                let is_stale = *is_stale;
                let (port, bytes) = done.map_err(|error| {
                    self.state = State::Lost;
                    closed_error(error)
                })?;
                if is_stale {
                    clear(port.as_ref());
                }
                self.state = State::Idle(port);
                let bytes = bytes?;
                if !is_stale {
                    self.arrived.extend(bytes);
                }
                Ok(())
            }
        }
    }
}

/// Reads once from the port. The result is empty if no byte arrives within [`READ_TIMEOUT`].
fn read(port: &mut Port) -> io::Result<Vec<u8>> {
    let mut bytes = vec![0; READ_SIZE];
    match port.read(&mut bytes) {
        Ok(0) => Err(closed_error("the port was closed")),
        Ok(len) => {
            bytes.truncate(len);
            Ok(bytes)
        }
        Err(error) if is_pause(&error) => Ok(Vec::new()),
        Err(error) => Err(closed_error(error)),
    }
}

/// Writes all bytes. Fails if this takes longer than `longest`.
fn write(port: &mut Port, mut bytes: &[u8], longest: Duration) -> io::Result<()> {
    let start = std::time::Instant::now();
    while !bytes.is_empty() {
        match port.write(bytes) {
            Ok(len) => bytes = bytes.get(len..).unwrap_or_default(),
            Err(error) if is_pause(&error) => {}
            Err(error) => return Err(closed_error(error)),
        }
        if !bytes.is_empty() && start.elapsed() > longest {
            return Err(io::Error::new(io::ErrorKind::TimedOut, "the port accepts no bytes"));
        }
    }
    Ok(())
}

fn is_pause(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::TimedOut | io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted)
}

fn clear(port: &dyn SerialPort) {
    // This call fails only if the port is gone. The next read or write reports this error.
    let _ = port.clear(ClearBuffer::Input);
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use std::io::{Read as _, Write as _};

    use futures_util::FutureExt as _;
    use serialport::TTYPort;

    use super::super::testing::soon;
    use super::*;

    const WRITE_TIMEOUT: Duration = Duration::from_secs(60);

    /// A pseudo-terminal and the port at its other end.
    fn pair() -> (TTYPort, Threaded) {
        let (mut master, mut port) = TTYPort::pair().unwrap();
        master.set_timeout(Duration::from_secs(60)).unwrap();
        port.set_timeout(READ_TIMEOUT).unwrap();
        (master, Threaded::new(Box::new(port)))
    }

    async fn receive(port: &mut Threaded, count: usize) -> Vec<u8> {
        let (mut bytes, mut buffer) = (Vec::new(), [0; 64]);
        while bytes.len() < count {
            let len = port.receive(&mut buffer, soon()).await.unwrap().expect("bytes come");
            bytes.extend(&buffer[..len]);
        }
        bytes
    }

    #[tokio::test]
    async fn late_bytes_are_available_for_the_next_read() {
        let (mut master, mut port) = pair();
        // After the timeout of this call, the thread continues its read.
        assert_eq!(port.receive(&mut [0; 8], Instant::now()).await.unwrap(), None);
        assert!(matches!(port.state, State::Busy { .. }));
        master.write_all(b"@OK\r\n").unwrap();
        assert_eq!(receive(&mut port, 5).await, b"@OK\r\n");
    }

    #[tokio::test]
    async fn discards_received_bytes_in_every_buffer() {
        let (mut master, mut port) = pair();
        // Half of these bytes are still in the driver. A read has taken the other half from the driver, but the test
        // has not received them.
        master.write_all(&[b'x'; 64]).unwrap();
        assert_eq!(port.receive(&mut [0; 8], soon()).await.unwrap(), Some(8));
        master.write_all(&[b'x'; 64]).unwrap();
        wait_for(&mut port, 64).await;
        port.discard();
        assert_eq!(port.receive(&mut [0; 8], Instant::now() + READ_TIMEOUT).await.unwrap(), None);
    }

    #[tokio::test]
    async fn discards_bytes_that_a_thread_reads() {
        let (mut master, mut port) = pair();
        port.begin(read);
        master.write_all(b"late").unwrap();
        while matches!(&port.state, State::Busy { reader_task, .. } if !reader_task.is_finished()) {
            tokio::task::yield_now().await;
        }
        port.discard();
        port.send(b"?", WRITE_TIMEOUT).await.unwrap();
        assert!(port.arrived.is_empty(), "{:?}", port.arrived);
    }

    #[tokio::test]
    async fn dropped_send_still_writes_all_bytes() {
        let (mut master, mut port) = pair();
        // The future is polled once and then dropped, as after Ctrl-C.
        assert!(port.send(b"@STOP\r\n", WRITE_TIMEOUT).now_or_never().is_none());
        let mut got = [0; 7];
        master.read_exact(&mut got).unwrap();
        assert_eq!(&got, b"@STOP\r\n");
    }

    #[tokio::test]
    async fn a_port_that_vanishes_is_not_connected() {
        let (master, mut port) = pair();
        drop(master);
        let error = port.receive(&mut [0; 8], soon()).await.unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::NotConnected, "{error}");
        assert_eq!(port.send(b"x", WRITE_TIMEOUT).await.unwrap_err().kind(), io::ErrorKind::NotConnected);
        port.discard();
    }

    #[tokio::test]
    async fn a_port_that_vanishes_ends_a_wait() {
        let (master, mut port) = pair();
        let unplug = async {
            tokio::task::yield_now().await;
            drop(master);
        };
        let mut buffer = [0; 8];
        let (received, ()) = tokio::join!(port.receive(&mut buffer, soon()), unplug);
        assert_eq!(received.unwrap_err().kind(), io::ErrorKind::NotConnected);
    }

    /// Waits until the driver has `count` bytes.
    async fn wait_for(port: &mut Threaded, count: u32) {
        port.settle().await.unwrap();
        let State::Idle(port) = &port.state else { panic!("not idle") };
        while port.bytes_to_read().unwrap() < count {
            tokio::task::yield_now().await;
        }
    }
}
