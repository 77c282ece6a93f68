//! `armctl sim yerc`: two UDP ports, like a controller.

use std::io;
use std::net::{Ipv4Addr, SocketAddr};

use crate::file::twin;
use crate::prelude::*;
use crate::simulator_start::{self, Simulated};
use armctl_controller::simulator::run_options::{RunOptions, Speed};
use armctl_controller::yerc::simulator::Simulator;
use armctl_frame::backup::recording::ReplayArguments;
use armctl_frame::backup::twin::note;
use armctl_frame::serve::{self, Started, address, bind_failure};
use armctl_transport::fault::{FaultSpec, Faults};
use armctl_transport::server::Server;

/// Simulate an FS100, DX100, DX200 or YRC1000 on two UDP ports
#[derive(Debug, Args)]
pub struct Serve {
    /// Address to listen on, with the port of the robot server; port 0 lets the system choose a port
    #[arg(
        long,
        alias = "listen",
        value_name = "ADDRESS[:PORT]",
        default_value = "127.0.0.1:10040",
        value_parser = |text: &str| address(text, ROBOT_PORT)
    )]
    bind: SocketAddr,
    /// Port of the file server [default: port of the robot server + 1]
    #[arg(long, value_name = "PORT")]
    file_port: Option<u16>,
    /// Controller model: fs100, dx100, dx200 or yrc1000 [default: dx200]
    #[arg(long, value_name = "MODEL")]
    model: Option<Model>,
    /// File with the start state (TOML): modes, variables, jobs, files, alarms, timed events
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// Backup of a robot, whose data the simulator starts with
    #[arg(long, value_name = "FOLDER", conflicts_with = "state")]
    from: Option<PathBuf>,
    /// Faults, such as drop=5%,delay=0..50ms,seed=7. Other faults are dup, reorder, corrupt and busy
    #[arg(long, value_name = "FAULTS")]
    fault: Option<FaultSpec>,
    /// Speed of the simulated time, such as 10x
    #[arg(long, value_name = "FACTOR", default_value_t)]
    speed: Speed,
    #[command(flatten)]
    replay: ReplayArguments,
    /// Read console lines on stdin, for example `alarm 4315`, `mode teach`, `io 20010 on`, `help`
    #[arg(long)]
    console: bool,
}

/// Default port of the robot server.
const ROBOT_PORT: u16 = 10040;

impl Default for Serve {
    fn default() -> Self {
        let bind = SocketAddr::new(Ipv4Addr::LOCALHOST.into(), ROBOT_PORT);
        Self {
            bind,
            file_port: None,
            model: None,
            state: None,
            fault: None,
            from: None,
            speed: Speed::default(),
            replay: ReplayArguments::default(),
            console: false,
        }
    }
}

impl serve::Serve for Serve {
    const ID: &'static str = "sim.yerc";
    const TARGET: &'static str = "udp://127.0.0.1:10040";
    type Report = Serving;
    type Server = Yerc;

    async fn start(self) -> Result<Started<Self>> {
        let model = self.model.unwrap_or(Model::Dx200);
        let start = simulator_start::start(self.state.as_deref(), self.from.as_deref(), model, self.fault.as_ref())?;
        simulator_start::check_model(&start, self.model)?;
        let start = start.with_options(RunOptions { speed: self.speed, motions: None });
        let (start, replay) = self.replay.apply(start, Family::Yerc)?;
        let model = start.model();
        let robot = self.bind;
        let file_port = self.file_port.unwrap_or(if robot.port() == 0 { 0 } else { robot.port().saturating_add(1) });
        let file = SocketAddr::new(robot.ip(), file_port);
        let bound = Server::bind([robot, file], self.fault.map(Faults::pair)).await;
        let server = bound.map_err(|error| bind_failure(&format!("UDP {robot} and {}", file.port()), &error))?;
        let local = |channel| server.local(channel).context("socket");
        let (robot, file) = (local(0)?, local(1)?);
        let target = format!("udp://{robot}?file_port={}&model={model}", file.port());
        Ok(Started {
            reach: serve::connect_hint("yerc", &target),
            target: target.clone(),
            report: Serving { family: "yerc", model: model.name(), target },
            server: Yerc { server, simulated: Simulated(Simulator::new(start)) },
            address: Some(robot),
            with_console: self.console,
            replay,
            unknown: self.from.map(|folder| note(&folder, twin::UNKNOWN)).transpose()?,
        })
    }
}

/// A simulated controller with its sockets.
#[derive(Debug)]
pub struct Yerc {
    server: Server,
    simulated: Simulated,
}

impl serve::Server for Yerc {
    fn run_until_change(&mut self) -> LocalBoxFuture<'_, io::Result<()>> {
        self.server.turn(&mut self.simulated).boxed_local()
    }

    fn console(&mut self, line: &str) -> Result<String, String> {
        self.simulated.0.console(self.server.now(), line)
    }

    fn set_faults(&mut self, faults: Option<&str>) -> Result<(), String> {
        let faults: Option<FaultSpec> = faults.map(str::parse).transpose().map_err(|error| format!("{error}"))?;
        self.simulated.0.set_busy(faults.as_ref().map_or(0.0, |faults| faults.busy.fraction()));
        self.server.set_faults(faults.map(Faults::pair));
        Ok(())
    }
}

/// A simulator that is ready for connections.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Serving {
    family: &'static str,
    model: &'static str,
    /// URL of the simulator.
    target: String,
}

impl Report for Serving {
    fn view(&self) -> View {
        View::text(format!("{} {} at {}", self.family, self.model, self.target))
    }
}
