//! TCP connection of a slot.

use std::io;
use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpSocket, TcpStream};
use tokio::sync::mpsc::UnboundedReceiver;

use super::{EipError, SharedState, Slot, Tap, mpsc};

/// Bytes per read.
const BUFFER: usize = 4096;

/// Handle of a TCP connection. When the handle is dropped, the connection closes after all bytes were written.
#[derive(Debug)]
pub(super) struct Line {
    /// Number of the TCP connection. With it, events of an older connection of the slot are recognized.
    pub(super) number: u64,
    orders: mpsc::UnboundedSender<Vec<u8>>,
}

impl Line {
    pub(super) fn new() -> (Self, UnboundedReceiver<Vec<u8>>) {
        static LAST: AtomicU64 = AtomicU64::new(0);
        let (orders, far) = mpsc::unbounded_channel();
        (Self { number: LAST.fetch_add(1, Ordering::Relaxed), orders }, far)
    }

    pub(super) fn send(&self, bytes: Vec<u8>) {
        // An error means that the connection is closed. The task of the connection reports this.
        let _ = self.orders.send(bytes);
    }
}

/// Task of a TCP connection: connects, writes queued bytes, and delivers received bytes.
pub(super) async fn run(
    inner: Arc<SharedState>,
    id: u64,
    number: u64,
    target: SocketAddrV4,
    tap: Tap,
    mut orders: UnboundedReceiver<Vec<u8>>,
) {
    // If the slot already has another TCP connection, the events of this connection are ignored.
    let tell = |event: &mut dyn FnMut(&mut Slot, super::Now)| {
        inner.with(id, |slot, now| {
            if slot.line.as_ref().is_some_and(|line| line.number == number) {
                event(slot, now);
            }
        });
    };
    // No bytes are queued before the connection is open. If the queue ends first, the slot has dropped its handle, and
    // the attempt is canceled.
    let connected = tokio::select! {
        connected = connect(*inner.local.ip(), target) => connected,
        _ = orders.recv() => return,
    };
    let mut stream = match connected {
        Ok(stream) => stream,
        Err(error) => return tell(&mut |slot, _| slot.core.disconnected(&EipError::unreachable(&error))),
    };
    // An error is ignored: the option only saves time. Without it, a request may wait for the acknowledgement of the
    // previous request.
    let _ = stream.set_nodelay(true);
    let Ok(SocketAddr::V4(local_address)) = stream.local_addr() else { return };
    tell(&mut |slot, now| {
        slot.local_address = *local_address.ip();
        slot.core.connected(now);
    });
    let (mut from, mut to) = stream.split();
    let mut buffer = [0; BUFFER];
    loop {
        tokio::select! {
            biased;
            order = orders.recv() => {
                let Some(bytes) = order else { return };
                tap.pass(true, local_address, target, &bytes);
                if to.write_all(&bytes).await.is_err() {
                    break;
                }
            }
            read = from.read(&mut buffer) => match read {
                Ok(len @ 1..) => {
                    let bytes = &buffer[..len];
                    tap.pass(true, target, local_address, bytes);
                    tell(&mut |slot, now| slot.core.received(now, bytes));
                }
                Ok(0) | Err(_) => break,
            },
        }
    }
    // This error is for requests that wait until the session is registered. After the registration, each pending
    // request gets its own error.
    tell(&mut |slot, _| slot.core.disconnected(&EipError::Hangup("RegisterSession")));
}

/// Connects from the local address of the image socket, because the device sends its images to the address that sent
/// the request.
async fn connect(local_address: Ipv4Addr, target: SocketAddrV4) -> io::Result<TcpStream> {
    let socket = TcpSocket::new_v4()?;
    if !local_address.is_unspecified() {
        socket.bind(SocketAddr::from((local_address, 0)))?;
    }
    socket.connect(target.into()).await
}
