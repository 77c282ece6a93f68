//! Connection to the controller of a target: serial port, device server, simulator, or a session.

use std::sync::Mutex;

use super::failure::failure;
use super::link::Toyo;
use super::overview::overview;
use super::simulated;
use crate::prelude::basics::*;
use armctl_client::toyo::{Client, Endpoint, Error, Line, Options};
use armctl_frame::Family as _;
use armctl_frame::backup::recording::with_replay;
use armctl_frame::face::HeldLink;
use armctl_frame::session_client::{LockResult, lock_or_attach};
use armctl_frame::settings::Sessions;
use armctl_frame::settings::target::{self, Place};
use armctl_frame::trace::lock_writer;
use armctl_transport::fault::LineFaultSpec;
use armctl_transport::serial;
use armctl_transport::session::host::shared_link::{self, SharedLink};
use armctl_transport::session::location::Claim;
use armctl_transport::stream::Stream;

/// Endpoint of a target.
fn endpoint(robot: &Robot) -> Result<Endpoint> {
    match &robot.target.value.place {
        Place::Serial(target::Serial { path, baud, data_bits, parity, stop_bits }) => {
            Ok(Endpoint::Serial(serial::Line {
                path: path.clone(),
                baud: *baud,
                data_bits: *data_bits,
                parity: *parity,
                stop_bits: *stop_bits,
            }))
        }
        Place::Tcp(target::Tcp { host, port, baud }) => {
            Ok(Endpoint::Tcp { host: host.clone(), port: *port, baud: *baud })
        }
        Place::Sim(sim) => {
            let faults = sim.fault.as_deref().map(str::parse::<LineFaultSpec>).transpose().map_err(|error| {
                Failure::usage(format!("{}: {error}", robot.target.value)).hint("write % as %25 in a URL")
            })?;
            let start = simulated::start(sim.state.as_deref(), sim.from.as_deref(), sim.axes, faults.as_ref())?;
            let start = with_replay(start, sim.replay.as_deref(), Family::Toyo)?;
            let start = start.with_options(robot.simulator_options());
            Ok(Endpoint::Simulator { start: Box::new(start), baud: sim.baud, faults })
        }
        Place::Udp(_) | Place::Bus(_) => {
            Err(Failure::usage(format!("a toyo controller cannot be reached over {}:", robot.target.value.scheme()))
                .hint("use serial://, tcp:// or sim:"))
        }
    }
}

/// Client options for a robot.
pub fn options(robot: &Robot, access: &Access) -> Options {
    Options { grant: access.grant.clone(), timeout: robot.timeout.value, retries: robot.retries.value }
}

/// Connects to the target of a robot.
pub async fn open(robot: &Robot, access: &Access, screen: &Screen) -> Result<Client> {
    let options = options(robot, access);
    if access.dry_run {
        return Ok(Client::dry_run(options));
    }
    let endpoint = endpoint(robot)?;
    let character = endpoint.character();
    let connector =
        Connector { endpoint, robot: robot.clone(), access: access.clone(), screen: *screen, claim: Mutex::default() };
    let line = Box::pin(connector.open()).await?;
    let mut client = Client::over(line, character, options);
    let connector = Arc::new(connector);
    client.reopen_by(move || {
        let connector = Arc::clone(&connector);
        Box::pin(async move { connector.open().await.map_err(|failure| Error::Opener(Arc::new(failure))) })
    });
    Ok(client)
}

/// Connector of one client. It can open the line again after a loss.
struct Connector {
    endpoint: Endpoint,
    robot: Robot,
    access: Access,
    screen: Screen,
    /// Prevents other processes on this computer from opening the line.
    claim: Mutex<Option<Claim>>,
}

impl Connector {
    /// Opens the line, or joins the session that has already opened it.
    async fn open(&self) -> Result<Line> {
        let Self { endpoint, robot, access, screen, claim } = self;
        if lock_writer(claim).is_none() {
            match lock_or_attach(robot, access, screen).await? {
                LockResult::Session(attached) => return Ok(Stream::Session(attached)),
                LockResult::Own(own) => *lock_writer(claim) = own,
            }
        }
        endpoint.open(robot.timeout.value).await.map_err(|error| failure(&robot.label(), error))
    }
}

/// Opens a line for a session. The session opens it again after a loss. An open line does not prove that there is a
/// controller, so a first request checks this.
pub async fn open_session_link(robot: &Robot, access: &Access, screen: &Screen) -> Result<HeldLink> {
    let robot = Robot { sessions: Sessions::None, ..robot.clone() };
    let mut link = Toyo::connect(&robot, access.clone(), screen).await?;
    overview(&mut link).await?;
    // The session uses the connection of the check, because a device server can need time before it accepts a new
    // connection.
    let open = link.into_line().ok_or_else(|| Failure::local("internal error: a dry run has no line"))?;
    let (endpoint, timeout, label) = (endpoint(&robot)?, robot.timeout.value, robot.label());
    let opened = shared_link::Line::new(open, move || {
        let (endpoint, label) = (endpoint.clone(), label.clone());
        Box::pin(async move { endpoint.open(timeout).await.map_err(|error| failure(&label, error).message) })
    });
    Ok(SharedLink::Stream(opened).into())
}
