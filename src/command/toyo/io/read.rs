//! `toyo io in|out|internal`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::super::items;
use super::super::numbers::small;
use super::{Bits, INPUT_BITS, OUTPUT_BITS, Port, listed, name};
use crate::command::frame::names;
use crate::command::frame::watch::{Watchable, Watched};
use crate::command::toyo::link::Toyo;
use crate::command::{Command, Context, Report};
use crate::controller::toyo::field::Value;
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table;
use crate::failure::{Failure, Kind};
use crate::output::csv::RowsOf;
use crate::output::view::{Cell, Section, Table, View};

/// Which ports.
#[derive(Debug, Args)]
struct Which {
    /// I/O station: 0 the controller itself, 1 to 4 its slaves
    #[arg(long, value_name = "N", default_value = "0", value_parser = clap::value_parser!(u8).range(0..=4))]
    station: u8,
    /// Only this port
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=23))]
    port: Option<u8>,
}

/// Reads all input ports of a station, or one.
#[derive(Debug, Args)]
#[command(after_help = BITS)]
pub struct In {
    #[command(flatten)]
    which: Which,
}

/// Reads all output ports of a station, or one.
#[derive(Debug, Args)]
#[command(after_help = BITS)]
pub struct Out {
    #[command(flatten)]
    which: Which,
}

/// Reads the internal ports, or one.
#[derive(Debug, Args)]
#[command(after_help = BITS)]
pub struct Internal {
    /// Only this port
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=4))]
    port: Option<u8>,
}

/// What the manual leaves open (ambiguities C8 and C9).
const BITS: &str = "A port has the bits 8 to 1, in this order: the rightmost one is bit 1. The manual shows that in an \
                    example only (3-1). The ports of station 0 come in screens, 3 on the first and 4 on each of the \
                    others; what the controller refuses of them is named.";

/// A kind of ports.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Bank {
    command: table::Command,
    /// `input`.
    word: &'static str,
    /// The last port of the controller itself.
    own: u8,
    /// The last port of a slave station.
    slave: u8,
    /// Which names its bits can have.
    bits: Option<Bits>,
}

/// The numbers are those of TO 2-8. Screen 7 of the inputs, which it allows, would be beyond the last port (C8).
pub(in super::super) const INPUTS: Bank =
    Bank { command: table::Command::Minp, word: "input", own: 23, slave: 3, bits: Some(INPUT_BITS) };
pub(in super::super) const OUTPUTS: Bank =
    Bank { command: table::Command::Mout, word: "output", own: 18, slave: 2, bits: Some(OUTPUT_BITS) };
const INTERNAL: Bank = Bank { command: table::Command::Mnin, word: "internal", own: 4, slave: 0, bits: None };

impl Bank {
    /// The last port of a station.
    const fn last(self, station: u8) -> u8 {
        if station == 0 { self.own } else { self.slave }
    }

    /// The screen that a port is on: 1 to 3, 4 to 7, 8 to 11, and so on. Others than the controller have only one.
    fn screen(self, station: u8, port: u8) -> u8 {
        if station == 0 && self.command != table::Command::Mnin && port > 3 { port / 4 + 1 } else { 1 }
    }

    /// The screen that tells of a port, if there is one.
    pub(super) fn screen_of(self, station: u8, port: u8) -> Option<u8> {
        (port <= self.last(station)).then(|| self.screen(station, port))
    }

    /// The ports of a screen that there should be.
    fn ports(self, station: u8, screen: u8) -> impl Iterator<Item = u8> {
        (1..=self.last(station)).filter(move |port| self.screen(station, *port) == screen)
    }

    /// Asks for a screen of them.
    pub(in super::super) fn request(self, station: u8, screen: u8) -> Request {
        Request::of(self.command, [Value::Number(station.into()), Value::Number(screen.into())])
    }

    async fn read(self, context: Context<'_, Toyo>, station: u8, port: Option<u8>) -> Result<Ports, Failure> {
        let names = names::of(context.robot, context.screen);
        let link = context.link;
        let last = self.last(station);
        let screens = match port {
            Some(port) if port > last => {
                let message = format!("station {station} has {} ports 1 to {last}, not {port}", self.word);
                return Err(Failure::usage(message).hint("without --port, all are shown"));
            }
            Some(port) => self.screen(station, port)..=self.screen(station, port),
            None => 1..=self.screen(station, last),
        };
        let request = |screen: u8| self.request(station, screen);
        link.plan_all(&screens.clone().map(request).collect::<Vec<_>>())?;
        let (mut ports, mut refused, mut failed) = (Vec::new(), Vec::new(), Vec::new());
        for screen in screens {
            // That there is nothing at all is a refusal like others; a controller with fewer ports is none.
            if ports.is_empty() {
                ports.extend(ports_of(&link.ask(&request(screen)).await?));
            } else {
                match link.try_ask(&request(screen)).await {
                    Ok(Ok(record)) => ports.extend(ports_of(&record)),
                    Ok(Err(_)) => refused.extend(self.ports(station, screen).map(name)),
                    Err(error) if matches!(error.kind, Kind::NoAnswer | Kind::Malformed) => {
                        let is_silent = error.kind == Kind::NoAnswer;
                        failed.push(Unread { ports: self.ports(station, screen).map(name).collect(), error });
                        if is_silent {
                            break;
                        }
                    }
                    Err(failure) => return Err(failure),
                }
            }
        }
        ports.retain(|found| port.is_none() || found.port == port);
        if let Some(bits) = self.bits {
            ports = ports.into_iter().map(|port| port.labelled(names, bits, station)).collect();
        }
        Ok(Ports { station, ports, refused, failed })
    }
}

/// The ports in an answer. A number that is there twice is that of the next port, as where the manual prints PN02
/// twice (ambiguity C7).
pub(in super::super) fn ports_of(record: &Record) -> Vec<Port> {
    let mut ports: Vec<Port> = record.bits("sy01").map(|byte| Port::new(None, byte)).into_iter().collect();
    for (number, bits) in [("port1", "bits1"), ("port2", "bits2"), ("port3", "bits3"), ("port4", "bits4")] {
        let Some(byte) = record.bits(bits) else { break };
        let before = ports.last().and_then(|port| port.port);
        let number = match small(record, number) {
            number if Some(number) == before => number.saturating_add(1),
            number => number,
        };
        ports.push(Port::new(Some(number), byte));
    }
    ports
}

impl Command for In {
    type Family = Toyo;
    type Report = Ports;
    const ID: &'static str = "toyo.io.in";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Ports, Failure> {
        INPUTS.read(context, self.which.station, self.which.port).await
    }
}

impl Command for Out {
    type Family = Toyo;
    type Report = Ports;
    const ID: &'static str = "toyo.io.out";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Ports, Failure> {
        OUTPUTS.read(context, self.which.station, self.which.port).await
    }
}

impl Command for Internal {
    type Family = Toyo;
    type Report = Ports;
    const ID: &'static str = "toyo.io.internal";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Ports, Failure> {
        INTERNAL.read(context, 0, self.port).await
    }
}

/// Input and output ports of a station, for a watch.
#[derive(Debug, Args)]
pub struct Both {
    #[command(flatten)]
    which: Which,
    /// Only inputs
    #[arg(long, conflicts_with = "out")]
    r#in: bool,
    /// Only outputs
    #[arg(long)]
    out: bool,
}

impl Command for Both {
    type Family = Toyo;
    type Report = Named;
    const ID: &'static str = "toyo.io.both";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Named, Failure> {
        let Context { robot, link, screen, several, authority } = context;
        let (mut ports, mut not_known) = (Vec::new(), None);
        for (bank, is_wanted) in [(INPUTS, !self.out), (OUTPUTS, !self.r#in)] {
            if !is_wanted {
                continue;
            }
            let context = Context { robot, link: &mut *link, screen, several, authority: authority.clone() };
            match bank.read(context, self.which.station, self.which.port).await {
                Ok(read) => {
                    let watched = |port: &Port| format!("{} {}", bank.word, port.name);
                    let named = |port: Port| NamedPort { bank: bank.word, watched: watched(&port), port };
                    ports.extend(read.ports.into_iter().map(named));
                }
                // A dry run shows what both ask.
                Err(failure) if failure.kind == Kind::NotKnown => not_known = Some(failure),
                Err(failure) => return Err(failure),
            }
        }
        not_known.map_or(Ok(Named { ports }), Err)
    }
}

impl Watchable for Both {
    const WATCH: &'static str = "toyo.io.watch";
    const WATCHED: Watched =
        Watched { list: "ports", name: "watched", prefix: "", label: "", value: Some("bits"), empty: "no ports" };
}

/// Ports of both kinds.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Named {
    ports: Vec<NamedPort>,
}

/// A port of one of two kinds.
#[derive(Debug, Serialize, JsonSchema)]
struct NamedPort {
    /// `input` or `output`.
    bank: &'static str,
    /// `input PN01`.
    watched: String,
    #[serde(flatten)]
    port: Port,
}

impl Report for Named {
    fn view(&self) -> View {
        let mut table = Table::new(&["port", "8 to 1", "label"], "no ports");
        for NamedPort { watched, port, .. } in &self.ports {
            table.row([watched.as_str().into(), port.raw.as_str().into(), Cell::maybe(port.label())]);
        }
        View::table(table.without_blank("label"))
    }
}

/// The ports of a station.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Ports {
    /// 0 is the controller itself.
    station: u8,
    ports: Vec<Port>,
    /// Names of the ports that the controller refused to tell (`@NG`) after it had told others.
    refused: Vec<String>,
    /// Ports that could not be read for another reason.
    failed: Vec<Unread>,
}

/// Ports that could not be read.
#[derive(Debug, Serialize, JsonSchema)]
struct Unread {
    /// Their names.
    ports: Vec<String>,
    /// Why.
    error: Failure,
}

impl Report for Ports {
    fn rows(&self) -> RowsOf {
        RowsOf::List("ports")
    }

    fn view(&self) -> View {
        let mut table = Table::new(&["port", "8 to 1", "on", "label"], "no ports");
        for port in &self.ports {
            let label = Cell::maybe(port.label());
            table.row([port.name.as_str().into(), port.raw.as_str().into(), listed(&port.on).into(), label]);
        }
        let view = View::table(table.without_blank("label"));
        if self.refused.is_empty() {
            return view;
        }
        view.and(Section::Text(format!("refused by the controller (@NG): {}", self.refused.join(", "))))
    }

    fn failure(&self) -> Option<Failure> {
        items::failure(self.ports.len() + self.failed.len(), self.failed.iter().map(|unread| Some(&unread.error)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::toyo::testing::{all_blocks, blocks, objection};
    use crate::controller::toyo::request::Answer;

    #[test]
    fn all_screens_of_a_station_are_asked_for() {
        let screens = |command: &str, count: i32| -> Vec<String> {
            (1..=count).map(|screen| format!("@{command} SNO=0 GN={screen}")).collect()
        };
        assert_eq!(all_blocks(&["io", "in"]).unwrap(), screens("MINP", 6));
        assert_eq!(all_blocks(&["io", "out"]).unwrap(), screens("MOUT", 5));
        assert_eq!(all_blocks(&["io", "internal"]).unwrap(), screens("MNIN", 1));
        assert_eq!(all_blocks(&["io", "in", "--station", "4"]).unwrap(), ["@MINP SNO=4 GN=1"]);
        assert_eq!(all_blocks(&["io", "out", "--station", "1"]).unwrap(), ["@MOUT SNO=1 GN=1"]);
    }

    #[test]
    fn a_single_port_is_on_its_screen() {
        let screens: Vec<(u8, u8)> =
            [1, 3, 4, 7, 8, 11, 12, 19, 20, 23].map(|port| (port, INPUTS.screen(0, port))).into();
        assert_eq!(screens, [(1, 1), (3, 1), (4, 2), (7, 2), (8, 3), (11, 3), (12, 4), (19, 5), (20, 6), (23, 6)]);
        assert_eq!(OUTPUTS.ports(0, 5).collect::<Vec<_>>(), [16, 17, 18]);
        assert_eq!(INTERNAL.ports(0, 1).collect::<Vec<_>>(), [1, 2, 3, 4]);
        assert_eq!(blocks(&["io", "out", "--port", "16"]).unwrap(), ["@MOUT SNO=0 GN=5"]);
    }

    #[test]
    fn ports_that_there_are_not_are_rejected() {
        assert!(objection(&["io", "in", "--port", "24"]).contains("1..=23"));
        assert!(objection(&["io", "in", "--station", "5"]).contains("0..=4"));
        let message = |words: &[&str]| blocks(words).unwrap_err().message;
        assert_eq!(message(&["io", "out", "--port", "19"]), "station 0 has output ports 1 to 18, not 19");
        assert_eq!(message(&["io", "in", "--station", "1", "--port", "4"]), "station 1 has input ports 1 to 3, not 4");
    }

    #[test]
    fn a_number_that_is_there_twice_is_that_of_the_next_port() {
        let request = Request::parse("@MOUT SNO=0 GN=1").unwrap();
        // As TO 2-8 prints it.
        let printed = "@MOUT SNO=0 GN=1 SY01=00000001 PN01=00000010 PN02=00000100 PN02=00001000";
        let Answer::Data(record) = request.answer(printed).unwrap() else { panic!("it is data") };
        let ports: Vec<(String, String)> = ports_of(&record).into_iter().map(|port| (port.name, port.raw)).collect();
        let expected = [("SY01", "00000001"), ("PN01", "00000010"), ("PN02", "00000100"), ("PN03", "00001000")];
        assert_eq!(ports, expected.map(|(name, raw)| (name.to_owned(), raw.to_owned())));
    }
}
