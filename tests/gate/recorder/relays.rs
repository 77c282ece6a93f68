//! Yaskawa and Toyo controllers: a relay before a simulated controller records the requests.

use std::io::{Read as _, Write as _};
use std::net::{SocketAddr, TcpListener, TcpStream, UdpSocket};
use std::sync::{Arc, Mutex};
use std::thread;

use armctl_controller::{toyo, yerc};

use super::{Bench, Effect, Recorder, in_parts};
use crate::support::simulator::Simulator;

type Sent = Arc<Mutex<Vec<Vec<u8>>>>;

struct Relay {
    family: &'static str,
    url: String,
    sent: Sent,
    is_harmless: fn(&[u8]) -> bool,
    is_stop: fn(&[u8]) -> bool,
    _controller: Simulator,
}

impl Recorder for Relay {
    fn family(&self) -> &'static str {
        self.family
    }

    fn url(&self) -> &str {
        &self.url
    }

    fn take_effect(&mut self) -> Vec<(Effect, String)> {
        let sent = std::mem::take(&mut *self.sent.lock().expect("no relay panics"));
        let effect = |bytes: &[u8]| match ((self.is_harmless)(bytes), (self.is_stop)(bytes)) {
            (_, true) => Effect::Stop,
            (true, false) => Effect::Read,
            // Here, a write and a dangerous request are not distinguished. The tests of each family do this.
            (false, false) => Effect::Write,
        };
        sent.iter().map(|bytes| (effect(bytes), String::from_utf8_lossy(bytes).into_owned())).collect()
    }
}

/// Relays datagrams to a port. Sends the answers to the last sender.
fn datagrams(to: SocketAddr, sent: &Sent) -> SocketAddr {
    let bind = || UdpSocket::bind("127.0.0.1:0").expect("a port");
    let (front, back) = (bind(), bind());
    back.connect(to).expect("a peer");
    let address = front.local_addr().expect("an address");
    let client: Arc<Mutex<Option<SocketAddr>>> = Arc::default();
    let (reply_to, replies) =
        (Arc::clone(&client), [&front, &back].map(|socket| socket.try_clone().expect("a socket")));
    let sent = Arc::clone(sent);
    thread::spawn(move || {
        let mut buffer = vec![0; 65535];
        while let Ok((len, from)) = front.recv_from(&mut buffer) {
            *client.lock().expect("no relay panics") = Some(from);
            sent.lock().expect("no relay panics").push(buffer[..len].to_vec());
            // The controller may have ended already.
            let _ = back.send(&buffer[..len]);
        }
    });
    thread::spawn(move || {
        let [front, back] = replies;
        let mut buffer = vec![0; 65535];
        while let Ok(len) = back.recv(&mut buffer) {
            let to = *reply_to.lock().expect("no relay panics");
            let _ = to.map(|to| front.send_to(&buffer[..len], to));
        }
    });
    address
}

/// Relays TCP connections, and records complete lines.
fn lines(to: SocketAddr, sent: &Sent) -> SocketAddr {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = listener.local_addr().expect("an address");
    let sent = Arc::clone(sent);
    thread::spawn(move || {
        for client in listener.incoming().map_while(Result::ok) {
            let Ok(controller) = TcpStream::connect(to) else { return };
            let (mut from, mut back) =
                (client.try_clone().expect("a socket"), controller.try_clone().expect("a socket"));
            thread::spawn(move || {
                let _ = std::io::copy(&mut back, &mut from);
                let _ = from.shutdown(std::net::Shutdown::Both);
            });
            let sent = Arc::clone(&sent);
            let (mut from, mut to) = (client, controller);
            thread::spawn(move || {
                let (mut buffer, mut line) = ([0; 4096], Vec::new());
                while let Ok(len) = from.read(&mut buffer) {
                    line.extend(&buffer[..len]);
                    while let Some(end) = line.iter().position(|byte| *byte == b'\n') {
                        sent.lock().expect("no relay panics").push(line.drain(..=end).collect());
                    }
                    if len == 0 || to.write_all(&buffer[..len]).is_err() {
                        break;
                    }
                }
                let _ = to.shutdown(std::net::Shutdown::Both);
            });
        }
    });
    address
}

const JOB: &str = "/JOB\r\n//NAME WELD\r\n//POS\r\n///NPOS 0,0,0,0,0,0\r\n//INST\r\nNOP\r\nEND\r\n";

#[test]
fn yerc_commands_send_only_authorized_frames() {
    let controller = Simulator::start("yerc");
    let (address, settings) = controller.place();
    let (port, rest) = settings.strip_prefix("file_port=").and_then(|rest| rest.split_once('&')).expect("two ports");
    let sent = Sent::default();
    let front = datagrams(address, &sent);
    let files = datagrams(SocketAddr::new(address.ip(), port.parse().expect("a port")), &sent);
    let url = format!("udp://{front}?file_port={}&{rest}", files.port());
    let mut relay = Relay {
        family: "yerc",
        url,
        sent,
        is_harmless: yerc::read_only_filter::only_reads_or_stops,
        is_stop: |bytes| bytes.get(24..28) == Some(&[0x83, 0, 1, 0]) || bytes.get(24..26) == Some(&[0x86, 0]),
        _controller: controller,
    };
    let mut bench = Bench::new(&mut relay, (0, 1));
    bench.write("WELD.JBI", JOB);
    bench.write("new.jbi", &JOB.replace("NOP", "NOP\r\nNOP"));
    bench.write("OTHER.JBI", &JOB.replace("WELD", "OTHER"));
    bench.prepare("yerc file put WELD.JBI");
    bench.prepare("yerc var dump vars.csv");
    bench.prepare("backup press");
    bench.prepare("yerc file put new.jbi --as WELD.JBI --replace --yes");
    bench.prepare("yerc var set B1=77 --yes");
    bench.hold_all();
}

#[test]
fn toyo_commands_send_only_authorized_lines() {
    in_parts(3, hold_toyo);
}

fn hold_toyo(part: (usize, usize)) {
    let controller = Simulator::start("toyo");
    let (address, _) = controller.place();
    let sent = Sent::default();
    let url = format!("tcp://{}", lines(address, &sent));
    let mut relay = Relay {
        family: "toyo",
        url,
        sent,
        is_harmless: toyo::read_only_filter::only_reads_or_stops,
        // A stop of a jog needs host control, so switching the host is allowed.
        is_stop: |bytes| {
            [&b"@STOP"[..], b"@HSON", b"@HSOF", b"@JGST X=SP Y=SP Z=SP R=SP"].iter().any(|stop| bytes.starts_with(stop))
        },
        _controller: controller,
    };
    let mut bench = Bench::new(&mut relay, part);
    bench.prepare("toyo point set 7 1 2 3 4 --yes");
    bench.prepare("backup press --yes");
    bench.prepare("toyo point set 7 9 9 9 9 --yes");
    bench.hold_all();
}
