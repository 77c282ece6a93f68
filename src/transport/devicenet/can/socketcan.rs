//! Linux SocketCAN interface, for example `can0`. The system administrator sets the bit rate and brings the interface
//! up.

use std::borrow::Cow;
use std::collections::VecDeque;
use std::io;

use socketcan::errors::{ControllerProblems as Problems, ErrorCause};
use socketcan::tokio::CanSocket;
use socketcan::{CanError, CanFrame, EmbeddedFrame as _, Id, SocketOptions as _, StandardId};

use super::{BoxedFuture, BusState, CanPort, Frame, Health, PortError, PortEvent};

/// Maximum number of frames that wait to be sent. With more frames, the interface counts as blocked.
const MAX_QUEUED_FRAMES: usize = 256;
fn advice(interface: &str) -> Cow<'static, str> {
    format!(
        "set up the interface as root, with the bit rate of the bus: `ip link set {interface} up type can bitrate \
         500000 restart-ms 100`. List the interfaces: `ip -br link show type can`"
    )
    .into()
}
/// Linux error numbers that have no `io::ErrorKind`.
const NO_DEVICE: i32 = 19;
const NO_FAMILY: i32 = 97;
const IS_DOWN: i32 = 100;
const NO_BUFFER: i32 = 105;

/// A SocketCAN interface.
pub struct SocketCan {
    interface: String,
    socket: CanSocket,
    outgoing: VecDeque<CanFrame>,
    health: Health,
}

impl std::fmt::Debug for SocketCan {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "SocketCan {}", self.interface)
    }
}

impl SocketCan {
    /// Opens an interface.
    pub fn open(interface: &str) -> Result<Self, PortError> {
        let failed = |error: &io::Error| {
            let (why, advice) = match error.raw_os_error() {
                Some(NO_DEVICE) => ("no such interface".to_owned(), advice(interface)),
                Some(NO_FAMILY) => (
                    "this system does not support CAN".to_owned(),
                    "load the kernel module can_raw, or use an SLCAN adapter: slcan://".into(),
                ),
                _ => (error.to_string(), advice(interface)),
            };
            PortError::Open { path: interface.to_owned(), why, advice }
        };
        let socket = CanSocket::open(interface).map_err(|error| failed(&error))?;
        socket.set_error_filter_accept_all().map_err(|error| failed(&error))?;
        Ok(Self { interface: interface.to_owned(), socket, outgoing: VecDeque::new(), health: Health::default() })
    }

    fn gone(&self, error: &io::Error) -> PortError {
        let why = match error.raw_os_error() {
            Some(IS_DOWN) => format!("the interface is down; run as root: `ip link set {} up`", self.interface),
            _ => error.to_string(),
        };
        PortError::Gone { path: self.interface.clone(), why }
    }

    async fn wait(&mut self) -> Result<PortEvent, PortError> {
        loop {
            let first = self.outgoing.front().copied();
            let read = tokio::select! {
                written = async {
                    match first {
                        Some(frame) => self.socket.write_frame(frame).await,
                        None => std::future::pending().await,
                    }
                } => {
                    match written {
                        // The queue of the interface is full. The frame counts as rejected, as with other adapters.
                        Err(error) if error.raw_os_error() == Some(NO_BUFFER) => self.health.rejected += 1,
                        written => written.map_err(|error| self.gone(&error))?,
                    }
                    self.outgoing.pop_front();
                    continue;
                }
                read = self.socket.read_frame() => read,
            };
            match read.map_err(|error| self.gone(&error))? {
                CanFrame::Data(data) => {
                    if let Id::Standard(id) = data.id()
                        && let Some(frame) = Frame::new(id.as_raw(), data.data())
                    {
                        return Ok(PortEvent::Frame(frame));
                    }
                }
                CanFrame::Remote(_) => {}
                CanFrame::Error(error) => {
                    let before = self.health;
                    learn(&mut self.health, &CanError::from(error));
                    if self.health != before {
                        return Ok(PortEvent::Health(self.health));
                    }
                }
            }
        }
    }
}

impl CanPort for SocketCan {
    fn send(&mut self, frame: &Frame) -> Result<(), PortError> {
        if self.outgoing.len() >= MAX_QUEUED_FRAMES {
            return Err(PortError::Stuck(self.interface.clone()));
        }
        let id = StandardId::new(frame.id());
        self.outgoing.extend(id.and_then(|id| CanFrame::new(id, frame.data())));
        Ok(())
    }

    fn next(&mut self) -> BoxedFuture<'_, Result<PortEvent, PortError>> {
        Box::pin(self.wait())
    }

    fn health(&self) -> Health {
        self.health
    }
}

/// Notes the state of the bus. One error frame can have several causes.
fn learn(health: &mut Health, error: &CanError) {
    for cause in error {
        match cause {
            ErrorCause::BusOff => health.state = BusState::Off,
            ErrorCause::Restarted => health.state = BusState::Active,
            ErrorCause::Controller(problems) => learn_problems(health, *problems),
            ErrorCause::NoAck if health.state == BusState::Active => health.state = BusState::Warning,
            _ => {}
        }
    }
}

fn learn_problems(health: &mut Health, problems: Problems) {
    let states = [
        (Problems::ACTIVE, BusState::Active),
        (Problems::RX_WARNING.union(Problems::TX_WARNING), BusState::Warning),
        (Problems::RX_PASSIVE.union(Problems::TX_PASSIVE), BusState::Passive),
    ];
    for (_, state) in states.into_iter().filter(|(flags, _)| problems.intersects(*flags)) {
        health.state = state;
    }
    health.overruns += u64::from(problems.contains(Problems::RX_OVERFLOW));
    health.rejected += u64::from(problems.contains(Problems::TX_OVERFLOW));
}

#[cfg(test)]
mod tests {
    use super::*;

    use socketcan::CanErrorFrame;

    #[test]
    fn learns_all_causes_of_an_error_frame() {
        // Bits of the identifier and bytes as in linux/can/error.h: 0x04 controller (byte 1), 0x20 no acknowledgement,
        // 0x40 bus off, 0x100 restarted.
        let after = |bits: u32, problems: u8| {
            let frame = CanErrorFrame::new_error(bits, &[0, problems, 0, 0, 0, 0, 0, 0]).unwrap();
            let mut health = Health::default();
            learn(&mut health, &CanError::from(frame));
            (health.state, health.overruns, health.rejected)
        };
        assert_eq!(after(0x04, 0x04), (BusState::Warning, 0, 0));
        assert_eq!(after(0x04, 0x08 | 0x20), (BusState::Passive, 0, 0));
        assert_eq!(after(0x04, 0x40), (BusState::Active, 0, 0));
        assert_eq!(after(0x04, 0x01 | 0x02), (BusState::Active, 1, 1));
        assert_eq!(after(0x20, 0), (BusState::Warning, 0, 0));
        assert_eq!(after(0x04 | 0x40, 0x20), (BusState::Off, 0, 0));
        assert_eq!(after(0x100, 0), (BusState::Active, 0, 0));
    }

    #[tokio::test]
    async fn missing_interface_has_an_advice() {
        let error = SocketCan::open("there-is-none0").unwrap_err();
        let PortError::Open { path, why, advice } = error else { panic!("{error:?}") };
        assert_eq!(path, "there-is-none0");
        assert!(why == "no such interface" || why == "this system does not support CAN", "{why}");
        assert!(advice.contains("ip link") || advice.contains("slcan"), "{advice}");
    }
}
