//! The TCP connection of a slot.

use std::io;
use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpSocket, TcpStream};
use tokio::sync::mpsc::UnboundedReceiver;

use super::{EipError, Inner, Slot, Tap, mpsc};

/// Room for what is read at once.
const BUFFER: usize = 4096;

/// The near end: dropping it closes the connection, once all has been written.
#[derive(Debug)]
pub(super) struct Line {
    /// Tells a connection from the one before it.
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
        // A line that has ended says so by itself.
        let _ = self.orders.send(bytes);
    }
}

/// Connects, writes what is ordered, hands over what comes.
pub(super) async fn run(
    inner: Arc<Inner>,
    id: u64,
    number: u64,
    target: SocketAddrV4,
    tap: Tap,
    mut orders: UnboundedReceiver<Vec<u8>>,
) {
    // A slot that has another line by now does not want to hear of this one.
    let tell = |event: &mut dyn FnMut(&mut Slot, super::Now)| {
        inner.with(id, |slot, now| {
            if slot.line.as_ref().is_some_and(|line| line.number == number) {
                event(slot, now);
            }
        });
    };
    // Nothing is ordered before there is a connection; an end of the orders is an end of the wait.
    let connected = tokio::select! {
        connected = connect(*inner.local.ip(), target) => connected,
        _ = orders.recv() => return,
    };
    let mut stream = match connected {
        Ok(stream) => stream,
        Err(error) => return tell(&mut |slot, _| slot.core.hung_up(&EipError::unreachable(&error))),
    };
    // Without it a request may wait for the acknowledgement of the one before; it works all the same.
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
    // Whoever waits for the session hears what became of it; once it is up, each request tells for itself.
    tell(&mut |slot, _| slot.core.hung_up(&EipError::Hangup { what: "RegisterSession" }));
}

/// From the address that images are heard on: the device sends them to where the request came from.
async fn connect(here: Ipv4Addr, target: SocketAddrV4) -> io::Result<TcpStream> {
    let socket = TcpSocket::new_v4()?;
    if !here.is_unspecified() {
        socket.bind(SocketAddr::from((here, 0)))?;
    }
    socket.connect(target.into()).await
}
