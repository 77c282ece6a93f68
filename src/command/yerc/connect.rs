//! How a controller is connected to: UDP, the simulator, a session that holds one of both.

use std::io;
use std::net::SocketAddr;

use tokio::time::{Instant, timeout_at};

use super::link::Yerc;
use super::overview::overview;
use super::simulated::{self, Simulated};
use crate::command::frame::attach::attach;
use crate::command::frame::dry_run::Plan;
use crate::command::{Access, Family as _};
use crate::controller::yerc::Model;
use crate::controller::yerc::simulator::{Simulator, Start};
use crate::failure::{Failure, Kind};
use crate::output::Screen;
use crate::settings::target::{self, Place};
use crate::settings::{Robot, Sessions};
use crate::transport::fault::{FaultSpec, Faults};
use crate::transport::session::client::Attached;
use crate::transport::session::host::held::Datagrams;
use crate::transport::sim::{InProcess, Peer};
use crate::transport::udp::Udp;

/// How the bytes travel.
#[derive(Debug)]
pub enum Transport {
    /// To a controller on the network.
    Udp(Udp),
    /// To the simulator in this process.
    Sim(Box<InProcess<Simulated>>),
    /// Through a session.
    Session(Box<Attached>),
    /// A dry run: what would be sent is noted.
    Notes(Plan),
}

/// How a robot is reached.
enum Endpoint<'a> {
    Udp(&'a target::Udp),
    Sim(Box<Start>, Option<FaultSpec>),
}

fn endpoint(robot: &Robot) -> Result<Endpoint<'_>, Failure> {
    match &robot.target.value.place {
        Place::Udp(udp) => Ok(Endpoint::Udp(udp)),
        Place::Sim(sim) => {
            let faults = sim.fault.as_deref().map(str::parse::<FaultSpec>).transpose().map_err(|error| {
                Failure::usage(format!("{}: {error}", robot.target.value)).hint("write % as %25 in a URL")
            })?;
            let start = simulated::start(sim.state.as_deref(), robot.model.value, faults.as_ref())?;
            Ok(Endpoint::Sim(Box::new(start), faults))
        }
        Place::Serial(_) | Place::Tcp(_) | Place::Bus(_) => {
            let message = format!("yerc is not reached over {}:", robot.target.value.scheme());
            Err(Failure::usage(message).hint("use udp:// or sim:"))
        }
    }
}

/// Opens what a robot's target names, and says which model is there.
pub async fn open(robot: &Robot, access: &Access, screen: &Screen) -> Result<(Transport, Model), Failure> {
    if access.dry_run {
        return Ok((Transport::Notes(Plan::default()), robot.model.value));
    }
    let endpoint = endpoint(robot)?;
    let model = if let Endpoint::Sim(start, _) = &endpoint { start.model() } else { robot.model.value };
    let transport = match (Box::pin(attach(robot, access, screen)).await?, endpoint) {
        (Some(attached), _) => Transport::Session(attached),
        (None, Endpoint::Udp(udp)) => Transport::Udp(connect(robot, udp).await?),
        (None, Endpoint::Sim(start, faults)) => {
            let controller = Simulated(Simulator::new(*start));
            Transport::Sim(Box::new(InProcess::new(controller, faults.map(Faults::pair))))
        }
    };
    Ok((transport, model))
}

/// Opens it for a session to hold. The controller is asked something first: datagrams go out to nobody, too.
pub async fn hold(robot: &Robot, access: &Access, screen: &Screen) -> Result<Datagrams, Failure> {
    let robot = &Robot { sessions: Sessions::None, ..robot.clone() };
    let mut link = Yerc::connect(robot, access.clone(), screen).await?;
    overview(&mut link).await?;
    Yerc::close(link, screen).await?;
    match endpoint(robot)? {
        Endpoint::Udp(udp) => Ok(Datagrams::udp(connect(robot, udp).await?)),
        Endpoint::Sim(start, faults) => {
            let controller: Box<dyn Peer> = Box::new(Simulated(Simulator::new(*start)));
            Ok(Datagrams::in_process(InProcess::new(controller, faults.map(Faults::pair))))
        }
    }
}

async fn connect(robot: &Robot, udp: &target::Udp) -> Result<Udp, Failure> {
    Udp::open(&udp.host, &[udp.port, udp.file_port]).await.map_err(|_| {
        Failure::new(Kind::NoAnswer, format!("{}: cannot find host '{}'", robot.label(), udp.host))
            .hint("check the name, or use the address of the controller")
    })
}

impl Transport {
    /// Own and other address of a channel; those of the loopback where this process has none.
    pub fn ends(&self, channel: usize) -> (SocketAddr, SocketAddr) {
        let loopback = |port| SocketAddr::from(([127, 0, 0, 1], port));
        match self {
            Self::Udp(udp) => (udp.local(channel).unwrap_or(loopback(0)), udp.peer(channel)),
            Self::Sim(_) | Self::Session(_) | Self::Notes(_) => {
                (loopback(40000), loopback(if channel == 0 { 10040 } else { 10041 }))
            }
        }
    }

    /// Gives a channel a new socket, so that nothing late on the old one is heard or mistaken.
    pub fn renew(&mut self, channel: usize) {
        match self {
            Self::Udp(udp) => udp.renew(channel),
            Self::Session(attached) => attached.renew(number(channel)),
            Self::Sim(_) | Self::Notes(_) => {}
        }
    }

    /// Sends one datagram.
    pub async fn send(&mut self, channel: usize, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::Udp(udp) => udp.send(channel, bytes).await,
            Self::Session(attached) => attached.send(number(channel), bytes).await,
            Self::Sim(sim) => {
                sim.send(channel, bytes);
                Ok(())
            }
            Self::Notes(_) => Ok(()),
        }
    }

    /// Waits for one datagram, but not longer than `until`; what does not fit the buffer is cut.
    pub async fn receive(&mut self, channel: usize, buffer: &mut [u8], until: Instant) -> io::Result<Option<usize>> {
        match self {
            Self::Udp(udp) => udp.receive(channel, buffer, until).await,
            Self::Session(attached) => attached.receive(number(channel), buffer, until).await,
            Self::Sim(sim) => Ok(timeout_at(until, sim.receive(channel, buffer)).await.ok()),
            Self::Notes(_) => Ok(None),
        }
    }
}

/// A channel as sessions count it.
pub fn number(channel: usize) -> u8 {
    u8::try_from(channel).unwrap_or(u8::MAX)
}
