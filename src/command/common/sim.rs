//! `armctl sim`: the simulators as servers on real sockets.

use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::path::PathBuf;

use clap::{Args, Subcommand};
use schemars::JsonSchema;
use serde::Serialize;
use tokio::io::{AsyncBufReadExt as _, BufReader, Lines, Stdin};

use crate::command::Report;
use crate::command::interrupt::interruptible;
use crate::command::run::{Run, Stopped};
use crate::command::yerc::simulated::{self, Simulated};
use crate::controller::yerc::Model;
use crate::controller::yerc::simulator::Simulator;
use crate::failure::{Failure, Kind};
use crate::output::view::View;
use crate::transport::fault::{FaultSpec, Faults};
use crate::transport::server::Server;

/// Which simulator to serve.
#[derive(Debug, Args)]
pub struct Sim {
    #[command(subcommand)]
    family: Option<SimFamily>,
}

/// Families with a simulator.
#[derive(Debug, Subcommand)]
enum SimFamily {
    /// An FS100 or DX200 on two UDP ports
    Yerc(SimYerc),
}

/// Arguments of `sim yerc`.
#[derive(Debug, Args)]
struct SimYerc {
    /// Address to listen on, with the port of the robot server; port 0 lets the system choose
    #[arg(long, value_name = "ADDRESS[:PORT]", default_value = "127.0.0.1:10040", value_parser = address)]
    bind: SocketAddr,
    /// Port of the file server; one above the robot server's unless given
    #[arg(long, value_name = "PORT")]
    file_port: Option<u16>,
    /// Controller model, fs100 or dx200
    #[arg(long, value_name = "MODEL")]
    model: Option<Model>,
    /// Start state (TOML): modes, variables, jobs, files, alarms, timed events
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// Faults on the line, such as drop=5%,dup=2%,delay=0..50ms,reorder=3%,corrupt=1%,busy=4%,seed=7
    #[arg(long, value_name = "FAULTS")]
    fault: Option<FaultSpec>,
    /// Take lines on stdin: `alarm 4315`, `mode teach`, `io 20010 on`, `help`
    #[arg(long)]
    console: bool,
}

/// Port of the robot server where the address names none.
const ROBOT_PORT: u16 = 10040;

fn address(text: &str) -> Result<SocketAddr, String> {
    let address = text.parse().or_else(|_| text.parse::<IpAddr>().map(|ip| SocketAddr::new(ip, ROBOT_PORT)));
    address.map_err(|_| format!("'{text}' is no address such as 127.0.0.1:10040"))
}

impl Sim {
    pub(super) async fn run(self, run: &Run) -> Result<(), Stopped> {
        match self.family {
            Some(SimFamily::Yerc(yerc)) => yerc.run(run).await,
            None => {
                let bind = SocketAddr::new(Ipv4Addr::LOCALHOST.into(), ROBOT_PORT);
                let yerc = SimYerc { bind, file_port: None, model: None, state: None, fault: None, console: false };
                yerc.run(run).await
            }
        }
    }
}

impl SimYerc {
    async fn run(self, run: &Run) -> Result<(), Stopped> {
        let model = self.model.unwrap_or(Model::Dx200);
        let start = simulated::start(self.state.as_deref(), model, self.fault.as_ref())?;
        if let Some(model) = self.model.filter(|model| *model != start.model()) {
            let message = format!("the start state is for model {}, not {model}", start.model());
            return Err(Failure::usage(message).hint("leave --model away, or change the file").into());
        }
        let model = start.model();
        let robot = self.bind;
        let file_port = self.file_port.unwrap_or(if robot.port() == 0 { 0 } else { robot.port().saturating_add(1) });
        let file = SocketAddr::new(robot.ip(), file_port);
        let bound = Server::bind([robot, file], self.fault.map(Faults::pair)).await;
        let mut server = bound.map_err(|error| cannot_listen(robot, file, &error))?;
        let local = |channel| server.local(channel).map_err(|error| Failure::io("socket", &error));
        let (robot, file) = (local(0)?, local(1)?);
        run.local(
            "sim.yerc",
            &Serving {
                family: "yerc",
                model: model.name(),
                target: format!("udp://{robot}?file_port={}&model={model}", file.port()),
            },
        )?;
        if !robot.ip().is_loopback() {
            run.screen.note("warning: others on the network can reach this simulator");
        }
        let mut service = Simulated(Simulator::new(start));
        let mut console = self.console.then(|| BufReader::new(tokio::io::stdin()).lines());
        loop {
            let turn = interruptible(async {
                tokio::select! {
                    turned = server.turn(&mut service) => {
                        turned.map(|()| None).map_err(|error| Failure::io("socket", &error))
                    }
                    line = next_line(&mut console) => Ok(Some(line)),
                }
            });
            let line = match turn.await {
                Ok(turned) => turned?,
                // This is how one ends a server.
                Err(_) => return Ok(()),
            };
            match line {
                None => {}
                Some(None) => console = None,
                Some(Some(line)) if line.trim().is_empty() => {}
                Some(Some(line)) => match service.0.console(server.now(), &line) {
                    Ok(text) => run.screen.note(&text),
                    Err(why) => run.screen.failure(&Failure::usage(why).hint("`help` lists what the console takes")),
                },
            }
        }
    }
}

/// The next line of the console; `None` at its end.
async fn next_line(console: &mut Option<Lines<BufReader<Stdin>>>) -> Option<String> {
    match console {
        Some(lines) => lines.next_line().await.unwrap_or(None),
        None => std::future::pending().await,
    }
}

fn cannot_listen(robot: SocketAddr, file: SocketAddr, error: &std::io::Error) -> Failure {
    let message = format!("cannot listen on UDP {robot} and {}: {error}", file.port());
    let hint = match error.kind() {
        std::io::ErrorKind::AddrInUse => "another simulator may run; choose a port with --bind 127.0.0.1:0",
        std::io::ErrorKind::PermissionDenied => "ports below 1024 need rights; choose a higher one",
        _ => "choose an address of this machine with --bind",
    };
    Failure::new(Kind::NoAnswer, message).hint(hint)
}

/// A simulator that listens.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Serving {
    family: &'static str,
    model: &'static str,
    /// The URL to reach it by.
    target: String,
}

impl Report for Serving {
    fn view(&self) -> View {
        View::text(format!("{} {} at {}", self.family, self.model, self.target))
    }
}
