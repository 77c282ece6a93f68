//! Endpoint of a controller, and the transport to it.

use std::io;
use std::net::SocketAddr;

use armctl_controller::yerc::Model;
use armctl_controller::yerc::simulator::{Simulator, Start};
use armctl_transport::fault::{FaultSpec, Faults};
use armctl_transport::session::client::Attached;
use armctl_transport::session::host::shared_link::Datagrams;
use armctl_transport::sim::{InProcess, Peer};
use armctl_transport::udp::Udp;
use tokio::time::{Instant, timeout_at};

use super::error::Error;
use super::simulated::Simulated;
use crate::{AddressPair, Plan};

/// Address of a controller.
///
/// ```
/// use armctl_client::yerc::{Client, Endpoint, Options, ReadVariable, Start, Value, VariableKind};
///
/// # #[tokio::main(flavor = "current_thread", start_paused = true)]
/// # async fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let start = Start::parse("model = \"yrc1000\"\nvariables = { I7 = -2 }", |_| Err("no files".to_owned()))?;
/// let endpoint = Endpoint::Simulator { start: Box::new(start), faults: Some("drop=10%".parse()?) };
/// let mut robot = Client::connect(endpoint, Options::auto()).await?;
/// assert_eq!(robot.ask(&ReadVariable::new(VariableKind::I, 7)).await?, Value::Integer(-2));
/// let Endpoint::Udp { host, ports } = Endpoint::udp("192.0.2.10") else { unreachable!() };
/// assert_eq!((host.as_str(), ports), ("192.0.2.10", [10040, 10041]));
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub enum Endpoint {
    /// A controller on the network.
    Udp {
        /// Host name or address.
        host: String,
        /// UDP ports of the robot server and the file server.
        ports: [u16; 2],
    },
    /// A simulator in this process; it starts when a client connects.
    Simulator {
        /// Start state of the simulator.
        start: Box<Start>,
        /// Line faults to simulate.
        faults: Option<FaultSpec>,
    },
}

/// Default UDP ports of the robot server and the file server.
pub const PORTS: [u16; 2] = [10040, 10041];

impl Endpoint {
    /// A controller on the network, at the default ports.
    pub fn udp(host: impl Into<String>) -> Self {
        Self::Udp { host: host.into(), ports: PORTS }
    }

    /// A new simulator of this model, without line faults.
    pub fn simulator(model: Model) -> Self {
        Self::Simulator { start: Box::new(Start::for_model(model)), faults: None }
    }

    /// The model, if it is known before a connection.
    pub fn model(&self) -> Option<Model> {
        match self {
            Self::Udp { .. } => None,
            Self::Simulator { start, .. } => Some(start.model()),
        }
    }

    pub(super) async fn open(self) -> Result<Transport, Error> {
        Ok(match self {
            Self::Udp { host, ports } => Transport::Udp(connect(host, ports).await?),
            Self::Simulator { start, faults } => {
                Transport::Sim(Box::new(InProcess::new(Simulated(Simulator::new(*start)), faults.map(Faults::pair))))
            }
        })
    }

    /// Opens the transport for a session. The session shares the transport between clients.
    #[doc(hidden)]
    pub async fn open_session_link(self) -> Result<Datagrams, Error> {
        Ok(match self {
            Self::Udp { host, ports } => Datagrams::udp(connect(host, ports).await?),
            Self::Simulator { start, faults } => {
                let controller: Box<dyn Peer + Send> = Box::new(Simulated(Simulator::new(*start)));
                Datagrams::in_process(InProcess::new(controller, faults.map(Faults::pair)))
            }
        })
    }
}

async fn connect(host: String, ports: [u16; 2]) -> Result<Udp, Error> {
    Udp::open(&host, &ports).await.map_err(|_| Error::HostNotFound { host })
}

#[derive(Debug)]
pub(super) enum Transport {
    /// A controller on the network.
    Udp(Udp),
    /// A simulator in this process.
    Sim(Box<InProcess<Simulated>>),
    /// A session that owns the link.
    Session(Box<Attached>),
    /// A dry run: requests are only planned.
    DryRun(Plan),
}

impl Transport {
    /// Local and remote address of a channel. Loopback addresses if this process has no socket.
    pub(super) fn address_pair(&self, channel: usize) -> AddressPair {
        let loopback = |port| SocketAddr::from(([127, 0, 0, 1], port));
        match self {
            Self::Udp(udp) => (udp.local(channel).unwrap_or(loopback(0)), udp.peer(channel)),
            Self::Sim(_) | Self::Session(_) | Self::DryRun(_) => {
                (loopback(40000), loopback(if channel == 0 { PORTS[0] } else { PORTS[1] }))
            }
        }
    }

    /// Port of the controller for a channel, if this process has the socket.
    pub(super) fn port(&self, channel: usize) -> Option<u16> {
        match self {
            Self::Udp(udp) => Some(udp.peer(channel).port()),
            Self::Sim(_) | Self::Session(_) | Self::DryRun(_) => None,
        }
    }

    pub(super) fn session(&mut self) -> Option<&mut Attached> {
        match self {
            Self::Session(session) => Some(session),
            Self::Udp(_) | Self::Sim(_) | Self::DryRun(_) => None,
        }
    }

    pub(super) fn ended(&self) -> Option<&str> {
        match self {
            Self::Session(session) => session.ended(),
            Self::Udp(_) | Self::Sim(_) | Self::DryRun(_) => None,
        }
    }

    pub(super) fn notes(&mut self) -> Option<&mut Plan> {
        match self {
            Self::DryRun(plan) => Some(plan),
            Self::Udp(_) | Self::Sim(_) | Self::Session(_) => None,
        }
    }

    /// Opens a new socket for a channel. The client then cannot receive a late datagram that is addressed to the old
    /// socket.
    pub(super) fn renew(&mut self, channel: usize) {
        match self {
            Self::Udp(udp) => udp.renew(channel),
            Self::Session(session) => session.renew(number(channel)),
            Self::Sim(_) | Self::DryRun(_) => {}
        }
    }

    pub(super) async fn send(&mut self, channel: usize, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::Udp(udp) => udp.send(channel, bytes).await,
            Self::Session(session) => session.send(number(channel), bytes).await,
            Self::Sim(sim) => {
                sim.send(channel, bytes);
                Ok(())
            }
            Self::DryRun(_) => Ok(()),
        }
    }

    /// Receives one datagram; `None` at the deadline. A datagram larger than the buffer is truncated.
    pub(super) async fn receive(
        &mut self,
        channel: usize,
        buffer: &mut [u8],
        until: Instant,
    ) -> io::Result<Option<usize>> {
        match self {
            Self::Udp(udp) => udp.receive(channel, buffer, until).await,
            Self::Session(session) => session.receive(number(channel), buffer, until).await,
            Self::Sim(sim) => Ok(timeout_at(until, sim.receive(channel, buffer)).await.ok()),
            Self::DryRun(_) => Ok(None),
        }
    }
}

/// The channel number in the session protocol.
pub(super) fn number(channel: usize) -> u8 {
    u8::try_from(channel).unwrap_or(u8::MAX)
}
