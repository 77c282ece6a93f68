//! `armctl sim yrcx`: simulated controller as a fieldbus server.

use std::io;

use super::backup::twin;
use super::buses::Servers;
use super::fieldbus::{Fieldbus, RunningSimulation, ServeOptions};
use super::simulated::start_with;
use super::typed_arguments::TypedArguments;
use crate::prelude::*;
use armctl_controller::simulator::console::help_line;
use armctl_controller::simulator::run_options::{RunOptions, Speed};
use armctl_frame::backup::recording::ReplayArguments;
use armctl_frame::backup::twin::note;
use armctl_frame::serve::{self, Serving, Started};
use armctl_frame::settings::target::bus::simulators;

/// Simulate a YRCX on a fieldbus
#[derive(Debug, Args)]
#[command(
    after_help = "One connection owns the outputs. Other connections can only listen (role=input_only with out=238, or \
                  role=listen_only with out=237)."
)]
pub struct ServeArgs {
    /// Fieldbus of the controller
    #[arg(long, value_name = "BUS", value_parser = simulators().map(|(name, _)| name).collect::<Vec<_>>())]
    bus: Option<String>,
    #[command(flatten)]
    servers: TypedArguments<Servers>,
    /// Faults, for example drop=5%,delay=0..50ms,seed=7 or stall; `armctl help simulator` lists them
    #[arg(long, value_name = "FAULTS")]
    fault: Option<String>,
    /// For DeviceNet and PROFIBUS: create a symbolic link to the pseudo-terminal, and remove the link at the end
    #[arg(long, value_name = "PATH", alias = "slcan-link")]
    link: Option<PathBuf>,
    /// File with the start state (TOML): robots, memory, programs, alarms, timed events
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// Speed of the simulated time, such as 10x
    #[arg(long, value_name = "FACTOR", default_value_t)]
    speed: Speed,
    /// Backup of a robot, whose data the simulator starts with
    #[arg(long, value_name = "FOLDER", conflicts_with = "state")]
    from: Option<PathBuf>,
    #[command(flatten)]
    replay: ReplayArguments,
    /// Read console lines on stdin; `help` lists them
    #[arg(long)]
    console: bool,
}

impl ServeArgs {
    /// Rejects options of another fieldbus.
    fn fits(&self, chosen: &Fieldbus) -> Result<()> {
        for (fieldbus, arguments) in Servers::arguments() {
            let strange = arguments.iter().find(|argument| self.servers.has(argument.get_id()));
            if let Some(strange) = strange.filter(|_| fieldbus.name != chosen.name) {
                let flag = strange.get_long().unwrap_or_default();
                return Err(misplaced(flag, chosen.name, &format!("--bus {}", fieldbus.name)));
            }
        }
        Ok(())
    }
}

fn misplaced(flag: &str, chosen: &str, right: &str) -> Failure {
    Failure::usage(format!("--{flag} has no effect with --bus {chosen}; use it with {right}"))
        .hint("use `armctl sim yrcx -h` to list the options of each fieldbus")
}

/// Console command that restarts a simulated slave or device.
const RESTART: (&str, &str) = ("restart", "switch the slave or device off and on (PROFIBUS, PROFINET)");

impl serve::Serve for ServeArgs {
    const ID: &'static str = "sim.yrcx";
    const TARGET: &'static str = "eip://127.0.0.1:44818";
    type Report = Serving;
    type Server = RunningSimulation;

    async fn start(self) -> Result<Started<Self>> {
        let wanted = self.bus.as_deref();
        let bus = simulators().find(|(name, _)| wanted.is_none_or(|wanted| wanted == *name)).map(|(_, bus)| bus);
        let all = self.servers.arguments.each();
        let serve = all.into_iter().find(|(fieldbus, _)| bus == Some(fieldbus.name));
        let (fieldbus, serve) =
            serve.ok_or_else(|| Failure::local("internal error: no fieldbus serves this simulator"))?;
        self.fits(fieldbus)?;
        if self.link.is_some() && !serve.has_terminal() {
            return Err(misplaced("link", fieldbus.name, "a simulator with a pseudo-terminal"));
        }
        let (start, link, faults) =
            (start_with(self.state.as_deref(), self.from.as_deref())?, self.link.as_deref(), self.fault.as_deref());
        let start = start.with_options(RunOptions { speed: self.speed, motions: None });
        let (start, replay) = self.replay.apply(start, Family::Yrcx)?;
        let server = serve.serve(ServeOptions { simulator: wanted, start, link, faults })?;
        Ok(Started {
            reach: serve::connect_hint("yrcx", &server.target),
            target: server.target.clone(),
            report: Serving { family: "yrcx", target: server.target.clone() },
            address: server.address,
            server,
            with_console: self.console,
            replay,
            unknown: self.from.map(|folder| note(&folder, twin::UNKNOWN)).transpose()?,
        })
    }
}

impl serve::Server for RunningSimulation {
    fn run_until_change(&mut self) -> LocalBoxFuture<'_, io::Result<()>> {
        std::future::pending().boxed_local()
    }

    fn console(&mut self, line: &str) -> Result<String, String> {
        let result = self.operator.console(line)?;
        Ok(if line == "help" { format!("{result}\n{}", help_line(RESTART.0, RESTART.1)) } else { result })
    }

    fn set_faults(&mut self, faults: Option<&str>) -> Result<(), String> {
        self.operator.set_faults(faults)
    }
}
