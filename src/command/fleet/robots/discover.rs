//! `armctl robots discover`: boards of EtherNet/IP that answer on a network, and the serial ports of this machine.

use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4};
use std::time::Duration;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use crate::command::frame::run::{Run, RunError};
use crate::command::toyo::ports::{self, Port};
use crate::command::yrcx::eip::board::{Identity, MAKER};
use crate::command::yrcx::trace::Recorder;
use crate::command::{Access, ConnectMode, Report};
use crate::failure::{Failure, Kind, plain};
use crate::output::view::{Cell, Table, View};
use crate::settings::duration;
use crate::transport::eip::PORT;
use crate::transport::eip::discovery::{Found, list_identity};

/// Asks who is there (ListIdentity), and lists serial ports without opening them.
#[derive(Debug, Args)]
#[command(
    after_help = "A broadcast stays in the network of the card that it leaves by: --bind chooses the card by its \
                        address, --broadcast the network, as in 192.168.0.255. yerc controllers answer no such question: \
                        `armctl robots check udp://ADDRESS` asks one."
)]
pub struct Discover {
    /// Ask only these, each by its address
    #[arg(value_name = "ADDRESS[:PORT]", value_parser = address)]
    targets: Vec<SocketAddrV4>,
    /// Ask everybody at this broadcast address, 255.255.255.255 unless given (repeatable)
    #[arg(long, value_name = "ADDRESS[:PORT]", value_parser = address)]
    broadcast: Vec<SocketAddrV4>,
    /// Ask from this address of this machine
    #[arg(long, value_name = "ADDRESS", default_value_t = Ipv4Addr::UNSPECIFIED, hide_default_value = true)]
    bind: Ipv4Addr,
    /// How long to wait for answers
    #[arg(long, value_name = "TIME", default_value = "2500ms", value_parser = wait)]
    wait: Duration,
}

/// Longest wait.
const LONGEST: Duration = Duration::from_secs(60);

fn address(text: &str) -> Result<SocketAddrV4, String> {
    let parsed = text.parse().or_else(|_| text.parse::<Ipv4Addr>().map(|address| SocketAddrV4::new(address, PORT)));
    parsed.map_err(|_| format!("'{text}' is no IPv4 address such as 192.168.0.2 or 192.168.0.2:{PORT}"))
}

fn wait(text: &str) -> Result<Duration, String> {
    match duration::parse_some(text)? {
        wait if wait <= LONGEST => Ok(wait),
        _ => Err(format!("{} at most", duration::display(LONGEST))),
    }
}

impl Discover {
    pub(super) async fn run(self, run: &Run) -> Result<(), RunError> {
        if run.gate.dry_run {
            return Err(Failure::usage("nothing is found without asking").hint("it only asks who is there").into());
        }
        let mut targets = self.targets.clone();
        targets.extend(&self.broadcast);
        let is_everybody = targets.is_empty();
        if is_everybody {
            targets.push(SocketAddrV4::new(Ipv4Addr::BROADCAST, PORT));
        }
        let access = Access { trace: run.trace.clone(), ..Access::reading(ConnectMode::Explicit) };
        run.begin_trace()?;
        let (recorder, tap) = Recorder::start(&access, &run.screen)?.unzip();
        let asked = list_identity(self.bind, &targets, self.wait, &tap.unwrap_or_default()).await;
        recorder.map_or(Ok(()), Recorder::finish)?;
        let boards = match asked {
            Ok(found) => found.into_iter().map(Board::from).collect(),
            Err(error) => {
                let failure = Failure::new(Kind::NoAnswer, format!("the network cannot be asked: {}", plain(&error)))
                    .hint("choose the card with --bind, or the network with --broadcast, as in 192.168.0.255");
                if !is_everybody {
                    return Err(failure.into());
                }
                // A machine without a network still has ports.
                run.screen.note(&format!("warning: {failure}"));
                Vec::new()
            }
        };
        let serial_ports = if self.targets.is_empty() { serial_ports(run) } else { Vec::new() };
        let nothing = if self.targets.is_empty() { NOTHING } else { "nobody answered" };
        run.local("robots.discover", &Discovered { boards, serial_ports, nothing })
    }
}

fn serial_ports(run: &Run) -> Vec<Port> {
    ports::all().unwrap_or_else(|failure| {
        run.screen.note(&format!("warning: {failure}"));
        Vec::new()
    })
}

/// What was found.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Discovered {
    /// Boards of EtherNet/IP that answered.
    boards: Vec<Board>,
    /// Serial ports of this machine, where broadcasts were asked for.
    serial_ports: Vec<Port>,
    #[serde(skip)]
    nothing: &'static str,
}

/// Said of an empty report.
const NOTHING: &str = "nobody answered, and no serial port was found; is this machine in the robots' network? \
                       --broadcast 192.168.0.255 asks a certain one";

/// A board that answered. What it says of itself is untrusted.
#[derive(Debug, Serialize, JsonSchema)]
struct Board {
    /// Where the answer came from.
    address: String,
    /// The URL for `-t`.
    target: String,
    /// The family that it may be of, by the number of its maker; null for makers of other things.
    family: Option<&'static str>,
    #[serde(flatten)]
    identity: Identity,
}

impl From<Found> for Board {
    fn from(found: Found) -> Self {
        let (host, port) = (found.address.ip(), found.address.port());
        let target = if port == PORT { format!("eip://{host}") } else { format!("eip://{host}:{port}") };
        Self {
            address: SocketAddr::from(found.address).to_string(),
            target,
            family: (found.identity.vendor == MAKER).then_some("yrcx"),
            identity: found.identity.into(),
        }
    }
}

impl Report for Discovered {
    fn view(&self) -> View {
        let mut table = Table::new(&["family", "target", "device"], self.nothing);
        for Board { target, family, identity, .. } in &self.boards {
            let Identity { name, vendor, product, revision, serial, owned, .. } = identity;
            let owned = if *owned { ", owned by a master" } else { "" };
            let device = format!("{name}, vendor {vendor}, product {product}, revision {revision}, {serial}{owned}");
            table.row([Cell::maybe(*family), Cell::from(target.as_str()).whole(), device.into()]);
        }
        for port in &self.serial_ports {
            let device = format!("serial port: {}", port.device());
            table.row(["toyo?".into(), Cell::from(port.target()).whole(), device.into()]);
        }
        View::table(table)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_have_the_usual_port() {
        assert_eq!(address("10.0.0.2").unwrap().to_string(), "10.0.0.2:44818");
        assert_eq!(address("10.0.0.2:1").unwrap().to_string(), "10.0.0.2:1");
        for wrong in ["robot", "::1", "10.0.0", "10.0.0.2:"] {
            assert!(address(wrong).is_err(), "{wrong}");
        }
        assert!(wait("2m").unwrap_err().contains("at most"));
        assert!(wait("0s").is_err());
    }
}
