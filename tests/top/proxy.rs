//! A relay between a client and a controller. It records everything that the client sends.

use std::io::{Read as _, Write as _};
use std::net::{Ipv4Addr, Shutdown, SocketAddr, TcpListener, TcpStream, UdpSocket};
use std::sync::{Arc, Mutex};
use std::thread;

/// All data from clients, in the pieces in which it was received.
#[derive(Clone, Default)]
pub struct Sent(Arc<Mutex<Vec<Vec<u8>>>>);

impl Sent {
    fn add(&self, bytes: &[u8]) {
        self.0.lock().expect("no panic").push(bytes.to_vec());
    }

    pub fn pieces(&self) -> Vec<Vec<u8>> {
        self.0.lock().expect("no panic").clone()
    }
}

/// Relays datagrams to `controller`, and its answers back to the client. The relay ends with the process.
pub fn udp(controller: SocketAddr) -> (SocketAddr, Sent) {
    let (front, sent) = (UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port"), Sent::default());
    let back = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port");
    back.connect(controller).expect("an address");
    let address = front.local_addr().expect("an address");
    let client = Arc::new(Mutex::new(None));
    let (answers, questions) = (back.try_clone().expect("a socket"), front.try_clone().expect("a socket"));
    let last = Arc::clone(&client);
    thread::spawn(move || {
        let mut buffer = [0; 2048];
        while let Ok(len) = answers.recv(&mut buffer) {
            let to: Option<SocketAddr> = *last.lock().expect("no panic");
            if let Some(to) = to {
                // The client may have closed its socket.
                let _gone = front.send_to(&buffer[..len], to);
            }
        }
    });
    let log = sent.clone();
    thread::spawn(move || {
        let mut buffer = [0; 2048];
        while let Ok((len, from)) = questions.recv_from(&mut buffer) {
            *client.lock().expect("no panic") = Some(from);
            log.add(&buffer[..len]);
            back.send(&buffer[..len]).expect("the controller is there");
        }
    });
    (address, sent)
}

/// Connections that a controller accepts.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Connections {
    /// Any number at a time.
    Parallel,
    /// One at a time. The relay closes a connection before it opens the next, as the client did. Otherwise, the
    /// controller may refuse the next client, because it does not know yet that the last one is gone.
    InTurn,
}

/// Relays TCP connections.
pub fn tcp(controller: SocketAddr, connections: Connections) -> (SocketAddr, Sent) {
    let (listener, sent) = (TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port"), Sent::default());
    let address = listener.local_addr().expect("an address");
    let log = sent.clone();
    thread::spawn(move || {
        while let Ok((client, _)) = listener.accept() {
            let server = TcpStream::connect(controller).expect("the controller is there");
            let (from_client, to_client) = (client.try_clone().expect("a socket"), client);
            let (from_server, to_server) = (server.try_clone().expect("a socket"), server);
            let log = log.clone();
            let relays = [
                thread::spawn(move || pass(from_client, to_server, |bytes| log.add(bytes))),
                thread::spawn(move || pass(from_server, to_client, |_| {})),
            ];
            if connections == Connections::InTurn {
                for relay in relays {
                    relay.join().expect("no panic");
                }
            }
        }
    });
    (address, sent)
}

fn pass(mut from: TcpStream, mut to: TcpStream, note: impl Fn(&[u8])) {
    let mut buffer = [0; 2048];
    while let Ok(len @ 1..) = from.read(&mut buffer) {
        note(&buffer[..len]);
        if to.write_all(&buffer[..len]).is_err() {
            break;
        }
    }
    // The other side may have closed already.
    let _closed = to.shutdown(Shutdown::Both);
}
