//! Controllers of all families behind recording relays, and checks of the recorded data.

use super::proxy::{self, Connections, Sent};
use crate::support::simulator::Simulator;

/// One controller of each family, on the loopback interface.
pub struct Recorded {
    /// Family and target of each controller.
    pub targets: [String; 3],
    sent: [Sent; 3],
    _simulators: [Simulator; 3],
}

impl Recorded {
    pub fn start() -> Self {
        let simulators = ["yerc", "toyo", "yrcx"].map(Simulator::start);
        let [yerc, toyo, yrcx] = &simulators;
        let (yerc_at, to_yerc) = proxy::udp(yerc.place().0);
        let (toyo_at, to_toyo) = proxy::tcp(toyo.place().0, Connections::InTurn);
        let (yrcx_at, to_yrcx) = proxy::tcp(yrcx.place().0, Connections::Parallel);
        let targets = [
            format!("yerc udp://{yerc_at}?{}", yerc.place().1),
            format!("toyo tcp://{toyo_at}"),
            format!("yrcx eip://{yrcx_at}"),
        ];
        Self { targets, sent: [to_yerc, to_toyo, to_yrcx], _simulators: simulators }
    }

    /// Number of recorded pieces of the controller that has the fewest.
    pub fn fewest_requests(&self) -> usize {
        self.sent.iter().map(|sent| sent.pieces().len()).min().unwrap_or_default()
    }

    pub fn assert_only_reads(&self) {
        let [to_yerc, to_toyo, to_yrcx] = &self.sent;
        reads_of_yerc(to_yerc);
        reads_of_toyo(to_toyo);
        reads_of_yrcx(to_yrcx);
    }
}

/// Asserts that the requests only read: status, alarm, axes, positions, position errors, torque, I/O and versions. The
/// numbers and services are from FS and DX 3.3.
fn reads_of_yerc(sent: &Sent) {
    let frames = sent.pieces();
    assert!(frames.len() > 10);
    for frame in frames {
        let command = u16::from_le_bytes([frame[24], frame[25]]);
        assert!(
            matches!(command, 0x70 | 0x72 | 0x73 | 0x74 | 0x75 | 0x76 | 0x77 | 0x89 | 0x300 | 0x30A),
            "{command:#x}"
        );
        assert!(matches!(frame[29], 0x01 | 0x0E | 0x33), "service {:#x} of {command:#x}", frame[29]);
    }
}

/// Asserts that the requests only read (TO 2-2, 2-4, 2-8).
fn reads_of_toyo(sent: &Sent) {
    let text = String::from_utf8(sent.pieces().concat()).expect("the protocol is text");
    let words: Vec<&str> = text.split("\r\n").filter_map(|block| block.strip_prefix('@')?.get(..4)).collect();
    assert!(words.len() > 20);
    for word in words {
        assert!(["STAS", "MPST", "SYSP", "RPAR", "MINP", "MOUT"].contains(&word), "{word}");
    }
}

/// Asserts that only encapsulation commands and CIP services without an effect were sent. No connection may be opened,
/// because the controller would report its loss (volume 2, 2-3; volume 1, appendix A).
fn reads_of_yrcx(sent: &Sent) {
    const LIST_SERVICES: u16 = 0x04;
    const LIST_IDENTITY: u16 = 0x63;
    const REGISTER: u16 = 0x65;
    const UNREGISTER: u16 = 0x66;
    const SEND: u16 = 0x6F;
    let mut bytes = &sent.pieces().concat()[..];
    let mut asked = 0;
    while let [low, high, short, long, ..] = *bytes {
        let (command, length) = (u16::from_le_bytes([low, high]), usize::from(u16::from_le_bytes([short, long])));
        let (frame, rest) = bytes.split_at(24 + length);
        bytes = rest;
        match command {
            LIST_SERVICES | LIST_IDENTITY | REGISTER | UNREGISTER => {}
            // After the header come the interface, the timeout and two items. The second item is the request.
            SEND => {
                assert_eq!(frame[40], 0x0E, "only Get_Attribute_Single");
                asked += 1;
            }
            other => panic!("encapsulation command {other:#x}"),
        }
    }
    assert!(asked > 3);
}
