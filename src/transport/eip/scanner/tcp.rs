//! TCP connection of a slot.

use std::io;
use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpSocket, TcpStream};
use tokio::sync::mpsc::UnboundedReceiver;

use super::{EipError, Inner, Slot, Tap, mpsc};

/// Bytes per read.
const BUFFER: usize = 4096;

/// Local end. Dropping it closes the connection after all bytes were written.
#[derive(Debug)]
pub(super) struct Line {
    /// Sequence number, to identify events of an older connection.
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
        // If the connection is closed, its own task reports it.
        let _ = self.orders.send(bytes);
    }
}

/// Task: connects, writes queued bytes, delivers received bytes.
pub(super) async fn run(
    inner: Arc<Inner>,
    id: u64,
    number: u64,
    target: SocketAddrV4,
    tap: Tap,
    mut orders: UnboundedReceiver<Vec<u8>>,
) {
    // Ignore events if the slot already has another connection.
    let tell = |event: &mut dyn FnMut(&mut Slot, super::Now)| {
        inner.with(id, |slot, now| {
            if slot.line.as_ref().is_some_and(|line| line.number == number) {
                event(slot, now);
            }
        });
    };
    // Nothing is queued before the connection is open. The end of the queue cancels the attempt.
    let connected = tokio::select! {
        connected = connect(*inner.local.ip(), target) => connected,
        _ = orders.recv() => return,
    };
    let mut stream = match connected {
        Ok(stream) => stream,
        Err(error) => return tell(&mut |slot, _| slot.core.hung_up(&EipError::unreachable(&error))),
    };
    // Optional: without it, a request can wait for the acknowledgement of the previous one.
    let _ = stream.set_nodelay(true);
    let Ok(SocketAddr::V4(here)) = stream.local_addr() else { return };
    tell(&mut |slot, now| {
        slot.here = *here.ip();
        slot.core.connected(now);
    });
    let (mut from, mut to) = stream.split();
    let mut buffer = [0; BUFFER];
    loop {
        tokio::select! {
            biased;
            order = orders.recv() => {
                let Some(bytes) = order else { return };
                tap.pass(true, here, target, &bytes);
                if to.write_all(&bytes).await.is_err() {
                    break;
                }
            }
            read = from.read(&mut buffer) => match read {
                Ok(len @ 1..) => {
                    let bytes = &buffer[..len];
                    tap.pass(true, target, here, bytes);
                    tell(&mut |slot, now| slot.core.received(now, bytes));
                }
                Ok(0) | Err(_) => break,
            },
        }
    }
    // Reported to a caller that waits for the session. After registration, each pending request reports its own error.
    tell(&mut |slot, _| slot.core.hung_up(&EipError::Hangup { what: "RegisterSession" }));
}

/// Connects from the local address of the image socket, because the device sends images to the sender of the request.
async fn connect(here: Ipv4Addr, target: SocketAddrV4) -> io::Result<TcpStream> {
    let socket = TcpSocket::new_v4()?;
    if !here.is_unspecified() {
        socket.bind(SocketAddr::from((here, 0)))?;
    }
    socket.connect(target.into()).await
}
