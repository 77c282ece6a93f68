//! `yrcx io set` and `yrcx io pulse`.

use clap::Args;

use super::{Family, input, named};
use crate::command::ValueKind;
use crate::command::orders::Done;
use crate::command::{Command, Context};
use crate::controller::Risk;
use crate::controller::yrcx::procedure::Procedure;
use crate::controller::yrcx::signal::Signal;
use crate::failure::Failure;

/// Switches inputs of the controller, one after the other.
#[derive(Debug, Args)]
#[command(after_help = "Inputs go back to rest when the connection ends. Two edges have 100 ms and more between them.")]
pub struct Set {
    /// Name or number and state, as in servo-on=on or 20=off
    #[arg(value_name = "SIGNAL=STATE", required = true, value_parser = change, add = ValueKind::YrcxInputState)]
    changes: Vec<Change>,
}

/// An input and what to switch it to.
#[derive(Debug, Clone, Copy)]
struct Change {
    signal: Signal,
    on: bool,
}

fn change(text: &str) -> Result<Change, String> {
    let (signal, state) = text.split_once('=').ok_or("say what to switch it to, as in servo-on=on")?;
    let on = match state {
        "on" | "1" => true,
        "off" | "0" => false,
        _ => return Err(format!("a signal is on or off, not '{state}'")),
    };
    Ok(Change { signal: input(signal)?, on })
}

impl Change {
    fn told(self) -> String {
        format!("{} {}", named(self.signal), if self.on { "on" } else { "off" })
    }
}

impl Command for Set {
    type Family = Family;
    type Report = Done;
    const ID: &'static str = "yrcx.io.set";

    fn risk(&self) -> Risk {
        self.changes.iter().map(|change| change.signal.risk(change.on)).max().unwrap_or(Risk::Write)
    }

    fn intent(&self) -> String {
        format!("switch {}", told(&self.changes))
    }

    async fn run(&self, context: Context<'_, Family>) -> Result<Done, Failure> {
        for change in &self.changes {
            context.link.carry_out(switching(Procedure::set(change.signal, change.on))?).await?;
        }
        Ok(Done::new(format!("switched {}", told(&self.changes))))
    }
}

fn told(changes: &[Change]) -> String {
    changes.iter().map(|change| change.told()).collect::<Vec<_>>().join(", ")
}

/// Switches an input of the controller on and off again.
#[derive(Debug, Args)]
pub struct Pulse {
    /// Name or number, as in alarm-reset or 20
    #[arg(value_name = "SIGNAL", value_parser = input, add = ValueKind::YrcxInput)]
    signal: Signal,
}

impl Command for Pulse {
    type Family = Family;
    type Report = Done;
    const ID: &'static str = "yrcx.io.pulse";

    fn risk(&self) -> Risk {
        self.signal.risk(true).max(Risk::Write)
    }

    fn intent(&self) -> String {
        format!("switch {} on and off again", named(self.signal))
    }

    async fn run(&self, context: Context<'_, Family>) -> Result<Done, Failure> {
        context.link.carry_out(switching(Procedure::pulse(self.signal))?).await?;
        Ok(Done::new(format!("switched {} on and off again", named(self.signal))))
    }
}

/// What was parsed as an input can be switched.
fn switching(procedure: Option<Procedure>) -> Result<Procedure, Failure> {
    procedure.ok_or_else(|| {
        Failure::usage("outputs are the controller's to switch")
            .hint("`yrcx io get` reads them; `yrcx port set` switches DO, MO and SO")
    })
}

#[cfg(test)]
mod tests {
    use crate::command::yrcx::testing::{frames, intent, objection, risk};
    use crate::controller::Risk;

    #[test]
    fn each_edge_is_an_image() {
        let noted = frames(&["io", "set", "20=on", "stop=off", "157=1", "20=off"]).unwrap();
        let bits: Vec<Vec<&str>> = noted
            .iter()
            .map(|note| note["bits"].as_array().unwrap().iter().map(|word| word.as_str().unwrap()).collect())
            .collect();
        assert_eq!(bits[0], ["0x0041", "0x0001", "0x0000", "0x0000", "0x0000", "0x0000", "0x0000", "0x0000"]);
        assert_eq!(bits[1][..2], ["0x0001", "0x0001"]);
        assert_eq!((bits[2][6], bits[3][1]), ("0x8000", "0x0000"));
        assert_eq!(frames(&["io", "pulse", "alarm-reset"]).unwrap().len(), 2);
    }

    #[test]
    fn what_moves_the_robot_asks_first() {
        assert_eq!(risk(&["io", "set", "20=on"]), Risk::Write);
        assert_eq!(risk(&["io", "set", "20=on", "auto-start=on"]), Risk::Motion);
        assert_eq!(risk(&["io", "set", "auto-start=off"]), Risk::Write);
        assert_eq!(risk(&["io", "pulse", "origin"]), Risk::Motion);
        assert_eq!(intent(&["io", "pulse", "origin"]), "switch origin (SI(14)) on and off again");
        assert_eq!(intent(&["io", "set", "20=on", "stop=off"]), "switch SI(20) on, stop (SI(06)) off");
    }

    #[test]
    fn mistakes_are_named() {
        for (line, part) in [
            (&["io", "set"][..], "SIGNAL=STATE"),
            (&["io", "set", "20"], "servo-on=on"),
            (&["io", "set", "20=maybe"], "on or off"),
            (&["io", "set", "SI(02)=on"], "reserved"),
            (&["io", "pulse", "cpu-ok"], "is no signal"),
        ] {
            let objection = objection(line);
            assert!(objection.contains(part), "{line:?}: {objection}");
        }
    }
}
