//! `toyo io get` and `toyo io watch`.

use super::port::{Signal, SignalRange};
use super::read::{read, row};
use super::{BITS, Station, list};
use crate::prelude::*;
use armctl_frame::robot::io::{IoValue, Signals, WATCHED};
use armctl_frame::watch;

/// Read signals, or all signals of a port.
#[derive(Debug, Args)]
#[command(after_help = BITS)]
pub struct Get {
    /// Signals, for example IN1.3, OUT1.1..OUT1.8, INT2 or IN1..3, or names of signals
    #[arg(required = true, value_name = "SIGNAL", value_delimiter = ',', add = complete::SIGNAL)]
    signals: Vec<SignalRange>,
    #[command(flatten)]
    station: Station,
}

impl Command for Get {
    type Family = Toyo;
    type Report = Signals;
    const ID: &'static str = "toyo.io.get";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Signals> {
        get(&self.signals, self.station, context).await
    }
}

async fn get(arguments: &[SignalRange], Station { station }: Station, context: Context<'_, Toyo>) -> Result<Signals> {
    if station != 0 && arguments.iter().any(|signals| signals.is_named) {
        return Err(Failure::usage("names belong to ports of station 0, the controller itself")
            .hint("type the port and the bit, such as IN1.3"));
    }
    let signals: Vec<Signal> =
        user_input::without_duplicates(arguments.iter().flat_map(|signals| signals.signals.iter().copied()));
    let names = names::of_robot(context.robot, context.screen);
    let bytes = read(context.link, station, &signals).await?;
    Signals::new(signals.into_iter().filter_map(|signal| row(signal, station, &bytes, names)).collect())
}

/// Arguments: the signals to watch. Default: inputs and outputs.
#[derive(Debug, Args)]
#[command(after_help = BITS)]
pub struct Watched {
    /// Signals, for example IN1.3, OUT1.1..OUT1.8, INT2 or IN1..3, or names of signals [default: all inputs and
    /// outputs]
    #[arg(value_name = "SIGNAL", value_delimiter = ',', add = complete::SIGNAL)]
    signals: Vec<SignalRange>,
    #[command(flatten)]
    station: Station,
}

impl Command for Watched {
    type Family = Toyo;
    type Report = Signals;
    const ID: &'static str = "toyo.io.watched";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Signals> {
        if self.signals.is_empty() {
            return list::all(self.station, context).await;
        }
        get(&self.signals, self.station, context).await
    }
}

impl Watchable for Watched {
    type Value = IoValue;

    const WATCH: &'static str = "toyo.io.watch";
    const WATCHED: watch::Watched = WATCHED;
}

#[cfg(test)]
mod tests {
    use crate::testing::{Bench, Fault, all_blocks, blocks, objection};
    use armctl_frame::failure::Kind;

    #[test]
    fn only_the_screens_of_the_signals_are_read() {
        assert_eq!(
            all_blocks(&["io", "get", "OUT16.1", "IN1.3,IN2"]).unwrap(),
            ["@MINP SNO=0 GN=1", "@MOUT SNO=0 GN=5"]
        );
        assert_eq!(all_blocks(&["io", "get", "INT4.1"]).unwrap(), ["@MNIN SNO=0 GN=1"]);
        assert_eq!(all_blocks(&["io", "get", "IN3.1", "--station", "4"]).unwrap(), ["@MINP SNO=4 GN=1"]);
    }

    #[test]
    fn ports_that_do_not_exist_are_rejected() {
        assert!(objection(&["io", "get", "IN1.1", "--station", "5"]).contains("0..=4"));
        let message = |words: &[&str]| blocks(words).unwrap_err().message;
        assert_eq!(message(&["io", "get", "OUT19"]), "station 0 has output ports 0 to 18, not 19");
        assert_eq!(message(&["io", "get", "IN4.1", "--station", "1"]), "station 1 has input ports 1 to 3, not 4");
        assert!(message(&["io", "get", "INT1", "--station", "1"]).contains("internal ports"));
    }

    #[test]
    fn one_refusal_does_not_hide_other_answers() {
        let fate = |block: &str, _| if block.contains("GN=2") { Fault::Answered("@NG") } else { Fault::None };
        let (read, failure) = Bench::with_faults("", fate).0.run(&["io", "get", "IN1.1", "IN4.1"]).unwrap();
        assert_eq!((&read["items"][0]["ok"], &read["items"][1]["value"]), (&true.into(), &serde_json::Value::Null));
        assert_eq!(failure.unwrap().kind, Kind::Mixed);
    }
}
