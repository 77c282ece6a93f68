//! Connections to the controller of a target: by UDP, to the simulator, or through a session.

use super::failure::failure;
use super::link::Yerc;
use super::overview::overview;
use super::simulator_start;
use crate::prelude::basics::*;
use armctl_client::yerc::{Client, Endpoint, Options};
use armctl_frame::Family as _;
use armctl_frame::backup::recording::with_replay;
use armctl_frame::face::HeldLink;
use armctl_frame::session_client::attach;
use armctl_frame::settings::Sessions;
use armctl_frame::settings::target::Place;
use armctl_transport::fault::FaultSpec;
use armctl_transport::session::host::shared_link::SharedLink;

fn endpoint(robot: &Robot) -> Result<Endpoint> {
    match &robot.target.value.place {
        Place::Udp(udp) => Ok(Endpoint::Udp { host: udp.host.clone(), ports: [udp.port, udp.file_port] }),
        Place::Sim(sim) => {
            let faults = sim.fault.as_deref().map(str::parse::<FaultSpec>).transpose().map_err(|error| {
                Failure::usage(format!("{}: {error}", robot.target.value)).hint("write % as %25 in a URL")
            })?;
            let start = simulator_start::start(
                sim.state.as_deref(),
                sim.from.as_deref(),
                robot.model.value.named().unwrap_or(Model::Dx200),
                faults.as_ref(),
            )?;
            let start = with_replay(start, sim.replay.as_deref(), Family::Yerc)?;
            let start = start.with_options(robot.simulator_options());
            if sim.from.is_some() {
                simulator_start::check_model(&start, robot.model.value.named())?;
            }
            Ok(Endpoint::Simulator { start: Box::new(start), faults })
        }
        Place::Serial(_) | Place::Tcp(_) | Place::Bus(_) => {
            let message = format!("a yerc controller cannot be reached over {}:", robot.target.value.scheme());
            Err(Failure::usage(message).hint("use udp:// or sim:"))
        }
    }
}

/// Connects to the controller of a target.
pub async fn open(robot: &Robot, access: &Access, screen: &Screen) -> Result<Client> {
    let options = Options {
        model: robot.model.value.named(),
        grant: access.grant.clone(),
        timeout: robot.timeout.value,
        retries: robot.retries.value,
    };
    if access.dry_run {
        // In a dry run, the model of a simulator is known from its start state. No controller is asked.
        let simulated = if robot.target.value.is_simulated() { endpoint(robot)?.model() } else { None };
        return Ok(Client::dry_run(Options { model: simulated.or(options.model), ..options }));
    }
    let endpoint = endpoint(robot)?;
    match Box::pin(attach(robot, access, screen)).await? {
        Some(session) => {
            let model = endpoint.model().or(options.model);
            Ok(Client::in_session(session, Options { model, ..options }))
        }
        None => Client::connect(endpoint, options).await.map_err(|error| failure(&robot.label(), error)),
    }
}

/// Opens a connection for a session. UDP sends even if there is no receiver, so a first request checks that a
/// controller answers.
pub async fn open_session_link(robot: &Robot, access: &Access, screen: &Screen) -> Result<HeldLink> {
    let robot = &Robot { sessions: Sessions::None, ..robot.clone() };
    let mut link = Yerc::connect(robot, access.clone(), screen).await?;
    overview(&mut link).await?;
    Yerc::close(link, screen).await?;
    let held = endpoint(robot)?.open_session_link().await.map_err(|error| failure(&robot.label(), error))?;
    Ok(SharedLink::Datagrams(held).into())
}
