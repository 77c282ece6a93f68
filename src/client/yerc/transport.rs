//! Where a controller is, and how the bytes travel there.

use std::io;
use std::net::SocketAddr;

use armctl_controller::yerc::Model;
use armctl_controller::yerc::simulator::{Simulator, Start};
use armctl_transport::fault::{FaultSpec, Faults};
use armctl_transport::session::client::Attached;
use armctl_transport::session::host::held::Datagrams;
use armctl_transport::sim::{InProcess, Peer};
use armctl_transport::udp::Udp;
use tokio::time::{Instant, timeout_at};

use super::error::Error;
use super::simulated::Simulated;
use crate::{Ends, Plan};

/// Where a controller is.
#[derive(Debug, Clone)]
pub enum Endpoint {
    /// On the network.
    Udp {
        /// Name or address.
        host: String,
        /// UDP ports of its robot server and its file server.
        ports: [u16; 2],
    },
    /// In this process: a simulator, which starts when it is connected to.
    Simulator {
        /// How it starts.
        start: Box<Start>,
        /// What is wrong with the line to it.
        faults: Option<FaultSpec>,
    },
}

/// UDP ports of a controller's robot server and file server.
pub const PORTS: [u16; 2] = [10040, 10041];

impl Endpoint {
    /// A controller on the network, at the usual ports.
    pub fn udp(host: impl Into<String>) -> Self {
        Self::Udp { host: host.into(), ports: PORTS }
    }

    /// A fresh simulator of this model, behind a line without faults.
    pub fn simulator(model: Model) -> Self {
        Self::Simulator { start: Box::new(Start::for_model(model)), faults: None }
    }

    /// The model, where that is known beforehand.
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

    /// Opens it for a session to hold, for many clients.
    pub async fn hold(self) -> Result<Datagrams, Error> {
        Ok(match self {
            Self::Udp { host, ports } => Datagrams::udp(connect(host, ports).await?),
            Self::Simulator { start, faults } => {
                let controller: Box<dyn Peer> = Box::new(Simulated(Simulator::new(*start)));
                Datagrams::in_process(InProcess::new(controller, faults.map(Faults::pair)))
            }
        })
    }
}

async fn connect(host: String, ports: [u16; 2]) -> Result<Udp, Error> {
    Udp::open(&host, &ports).await.map_err(|_| Error::HostNotFound { host })
}

/// How the bytes travel.
#[derive(Debug)]
pub(super) enum Transport {
    /// To a controller on the network.
    Udp(Udp),
    /// To the simulator in this process.
    Sim(Box<InProcess<Simulated>>),
    /// Through a session.
    Session(Box<Attached>),
    /// A dry run: what would be sent is noted.
    Notes(Plan),
}

impl Transport {
    /// Own and other address of a channel; those of the loopback where this process has none.
    pub(super) fn ends(&self, channel: usize) -> Ends {
        let loopback = |port| SocketAddr::from(([127, 0, 0, 1], port));
        match self {
            Self::Udp(udp) => (udp.local(channel).unwrap_or(loopback(0)), udp.peer(channel)),
            Self::Sim(_) | Self::Session(_) | Self::Notes(_) => (loopback(40000), loopback(PORTS[channel.min(1)])),
        }
    }

    /// The controller's port of a channel, where this process has the socket.
    pub(super) fn port(&self, channel: usize) -> Option<u16> {
        match self {
            Self::Udp(udp) => Some(udp.peer(channel).port()),
            Self::Sim(_) | Self::Session(_) | Self::Notes(_) => None,
        }
    }

    /// The session, if it goes through one.
    pub(super) fn session(&mut self) -> Option<&mut Attached> {
        match self {
            Self::Session(session) => Some(session),
            Self::Udp(_) | Self::Sim(_) | Self::Notes(_) => None,
        }
    }

    /// Why the session has ended, if it goes through one that has.
    pub(super) fn ended(&self) -> Option<&str> {
        match self {
            Self::Session(session) => session.ended(),
            Self::Udp(_) | Self::Sim(_) | Self::Notes(_) => None,
        }
    }

    /// The notes of a dry run.
    pub(super) fn notes(&mut self) -> Option<&mut Plan> {
        match self {
            Self::Notes(plan) => Some(plan),
            Self::Udp(_) | Self::Sim(_) | Self::Session(_) => None,
        }
    }

    /// Gives a channel a new socket, so that nothing late on the old one is heard or mistaken.
    pub(super) fn renew(&mut self, channel: usize) {
        match self {
            Self::Udp(udp) => udp.renew(channel),
            Self::Session(session) => session.renew(number(channel)),
            Self::Sim(_) | Self::Notes(_) => {}
        }
    }

    /// Sends one datagram.
    pub(super) async fn send(&mut self, channel: usize, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::Udp(udp) => udp.send(channel, bytes).await,
            Self::Session(session) => session.send(number(channel), bytes).await,
            Self::Sim(sim) => {
                sim.send(channel, bytes);
                Ok(())
            }
            Self::Notes(_) => Ok(()),
        }
    }

    /// Waits for one datagram, but not longer than `until`; what does not fit the buffer is cut.
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
            Self::Notes(_) => Ok(None),
        }
    }
}

/// A channel as sessions count it.
pub(super) fn number(channel: usize) -> u8 {
    u8::try_from(channel).unwrap_or(u8::MAX)
}
