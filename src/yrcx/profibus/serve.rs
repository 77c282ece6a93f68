//! Server for a simulated controller as a PROFIBUS slave behind a pseudo-terminal.

use super::simulated::{self, FAULTS, Options, Server};
use crate::fieldbus::{Operator, RunningSimulation, Serve, ServeOptions};
use crate::prelude::basics::*;
use crate::simulated::{faults, faults_of_option};
use armctl_frame::serve::terminal_link::TerminalLink;
use armctl_transport::profibus::rates::{RATES, Rate};

/// Options of the simulated slave.
#[derive(Debug, Args)]
#[group(skip)]
pub struct ServeArgs {
    /// PROFIBUS: address of the station
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u8).range(0..=125))]
    station: u8,
    /// PROFIBUS: ident number of the station
    #[arg(long, value_name = "0xNNNN", default_value = "0x1234", value_parser = ident)]
    ident: u16,
    /// PROFIBUS: bit rate, which sets the character time: 9.6k, 19.2k, 45.45k, 93.75k, 187.5k, 500k, 1.5M
    #[arg(long, value_name = "RATE", default_value = "500k", value_parser = rate)]
    baud: Rate,
}

fn ident(text: &str) -> Result<u16, String> {
    let digits = text.strip_prefix("0x").unwrap_or(text);
    u16::from_str_radix(digits, 16).map_err(|_| format!("'{text}' is not a valid ident number, such as 0x1234"))
}

fn rate(text: &str) -> Result<Rate, String> {
    Rate::from_name(text).ok_or_else(|| format!("there are {}", RATES.map(|rate| rate.name).join(", ")))
}

impl Serve for ServeArgs {
    fn has_terminal(&self) -> bool {
        true
    }

    fn serve(&self, ServeOptions { start, link, faults, .. }: ServeOptions<'_>) -> Result<RunningSimulation> {
        let options = Options {
            station: self.station,
            ident: self.ident,
            rate: self.baud,
            faults: faults_of_option(faults, &FAULTS)?,
        };
        let server = simulated::serve(start, options)?;
        // From here on, Ctrl-C must not end the process before the symbolic link is removed.
        armctl_frame::interrupt::catch_interrupts();
        let link = link.map(|link| TerminalLink::create(link, server.port())).transpose()?;
        let name = link.as_ref().map(|link| link.name().display().to_string());
        Ok(RunningSimulation {
            target: server.url(name.as_deref()),
            address: None,
            operator: Box::new(Terminal { server, _link: link }),
        })
    }
}

/// A slave on a pseudo-terminal. When the server is dropped, the symbolic link is removed too.
#[derive(Debug)]
struct Terminal {
    server: Server,
    _link: Option<TerminalLink>,
}

impl Operator for Terminal {
    fn console(&self, line: &str) -> Result<String, String> {
        self.server.with(|slave, now| match line.trim() {
            "restart" => {
                slave.restart(now);
                Ok("the slave was switched off and on".to_owned())
            }
            line => slave.peer.0.console(now, line),
        })
    }

    fn set_faults(&self, text: Option<&str>) -> Result<(), String> {
        self.server.set_faults(faults(text, &FAULTS)?);
        Ok(())
    }
}
