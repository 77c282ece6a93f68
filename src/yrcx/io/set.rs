//! `yrcx io set` and `yrcx io pulse`.

use super::{ANY_INPUT, called, input, item, named_input, word_item};
use crate::prelude::*;
use armctl_controller::names::{Kind, Names};
use armctl_controller::yrcx::procedure::Procedure;
use armctl_controller::yrcx::register::Register;
use armctl_frame::robot::io::{IoValue, WrittenSignal, WrittenSignals};

/// Switches inputs of the controller one after the other, and sets general-purpose words.
#[derive(Debug, Args)]
#[command(
    after_help = "When the connection ends, inputs return to their resting state and words to 0. `armctl session \
                  open` keeps the connection open. armctl waits at least 100 ms between two changes of a signal; \
                  consecutive words change together. A remote command uses the words while it runs, then restores \
                  them."
)]
pub struct Set {
    /// Signal and state, for example servo-on=on or 20=off; or word and value, for example SIW2=5 or SID4=0x1F
    #[arg(value_name = "SIGNAL=STATE", required = true, value_parser = change, add = complete::INPUT_STATE)]
    changes: Vec<Change>,
}

/// A change of an input or a word.
#[derive(Debug, Clone)]
enum Change {
    /// A signal; `name` is the name that the user assigned and typed, if any.
    Signal {
        signal: Signal,
        name: Option<String>,
        on: bool,
    },
    Word {
        register: Register,
        value: u32,
    },
}

/// Target of a change: an input or a word.
enum Settable {
    Signal(Signal),
    Word(Register),
}

fn settable(text: &str) -> Result<Settable, String> {
    match Register::parse(text) {
        Some(register) => register.map(Settable::Word),
        None => input(text).map(Settable::Signal),
    }
}

fn change(text: &str) -> Result<Change, String> {
    let (signal, state) = user_input::split_setting(text, "a signal", "a state", "servo-on=on")?;
    let (found, is_open) = names::parse_or_name_marked(&[Kind::Signal], ANY_INPUT, signal, settable)?;
    let name = settable(signal).is_err().then(|| signal.to_owned());
    match found {
        Settable::Word(register) if register.side() == Side::Output => {
            Err(format!("only the controller sets {register}; armctl can set SIW and SID"))
        }
        Settable::Word(register) => Ok(Change::Word { register, value: register.value(state)? }),
        // The name is not resolved yet, so armctl cannot yet check the state.
        Settable::Signal(signal) if is_open => Ok(Change::Signal { signal, name, on: false }),
        Settable::Signal(signal) => Ok(Change::Signal { signal, name, on: user_input::state(state)? }),
    }
}

impl Change {
    /// Returns the result of the change; `shown` is the image before the change.
    fn written(&self, shown: Option<&Image>, names: &Names) -> WrittenSignal {
        match self {
            Self::Signal { signal, on, .. } => {
                let old = shown.map(|image| IoValue::State(signal.is_on(image)));
                WrittenSignal::new(item(*signal, names), old, IoValue::State(*on))
            }
            Self::Word { register, value } => {
                let old = shown.map(|image| IoValue::Number(register.read(&image.command())));
                WrittenSignal::new(word_item(*register, None, names), old, IoValue::Number(*value))
            }
        }
    }

    fn describe(&self) -> String {
        match self {
            Self::Signal { signal, name, on } => {
                format!("{} {}", called(*signal, name.as_ref()), if *on { "on" } else { "off" })
            }
            Self::Word { register, value } => format!("{register} = {value}"),
        }
    }

    fn risk(&self) -> Risk {
        match self {
            Self::Signal { signal, on, .. } => signal.risk(*on),
            Self::Word { .. } => Risk::Write,
        }
    }

    /// Returns word and value, if this is a change of a word.
    fn word(&self) -> Option<(Register, u32)> {
        match self {
            Self::Signal { .. } => None,
            Self::Word { register, value } => Some((*register, *value)),
        }
    }

    /// Carries out one change, or several word changes together.
    async fn execute(together: &[Self], link: &mut Link) -> Result<()> {
        if let [Self::Signal { signal, on, .. }] = together {
            return link.execute(switching(Procedure::set(*signal, *on))?).await.map(|_| ());
        }
        link.set_words(&together.iter().filter_map(Self::word).collect::<Vec<_>>()).await
    }
}

impl Command for Set {
    type Family = Yrcx;
    type Report = WrittenSignals;
    const ID: &'static str = "yrcx.io.set";

    fn risk(&self) -> Risk {
        self.changes.iter().map(Change::risk).max().unwrap_or(Risk::Write)
    }

    fn intent(&self) -> String {
        format!("switch {}", describe(&self.changes))
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<WrittenSignals> {
        let names = names::of_robot(context.robot, context.screen);
        let shown = context.link.output_image().copied();
        let mut done = 0;
        for together in self.changes.chunk_by(|one, next| one.word().is_some() && next.word().is_some()) {
            let before = &self.changes[..done];
            Change::execute(together, context.link).await.map_err(|failure| match before {
                [] => failure,
                _ => Failure {
                    message: format!("{}; switched before: {}", failure.message, describe(before)),
                    ..failure
                },
            })?;
            done += together.len();
        }
        let items = self.changes.iter().map(|change| change.written(shown.as_ref(), names)).collect();
        Ok(WrittenSignals::new(items))
    }
}

fn describe(changes: &[Change]) -> String {
    changes.iter().map(Change::describe).collect::<Vec<_>>().join(", ")
}

/// Switches an input of the controller on and off again.
#[derive(Debug, Args)]
pub struct Pulse {
    /// Name or number, for example alarm-reset or 20
    #[arg(value_name = "SIGNAL", value_parser = named_input, add = complete::INPUT)]
    signal: (Signal, Option<String>),
}

impl Pulse {
    fn called(&self) -> String {
        called(self.signal.0, self.signal.1.as_ref())
    }
}

impl Command for Pulse {
    type Family = Yrcx;
    type Report = SetReport;
    const ID: &'static str = "yrcx.io.pulse";

    fn risk(&self) -> Risk {
        self.signal.0.risk(true).max(Risk::Write)
    }

    fn intent(&self) -> String {
        format!("switch {} on and off again", self.called())
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<SetReport> {
        let old = context.link.output_image().map(|image| self.signal.0.is_on(image));
        context.link.execute(switching(Procedure::pulse(self.signal.0))?).await?;
        let words = format!("switched {} on and off again", self.called());
        Ok(NewValue::of(self.signal.0.to_string(), false, words).with("pulsed", true).replaces(Old::read(old)))
    }
}

/// Returns the procedure that switches a signal; an error if the signal is an output.
fn switching(procedure: Option<Procedure>) -> Result<Procedure> {
    procedure.ok_or_else(|| {
        Failure::usage("only the controller switches its outputs")
            .hint("use `yrcx io get` to read the outputs; use `yrcx port set` to switch DO, MO and SO")
    })
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use crate::testing::{Bench, Reply, Scripted, frames, intent, risk};
    use armctl_controller::Risk;

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
    fn words_that_follow_each_other_change_at_once() {
        let noted = frames(&["io", "set", "SIW2=5", "SID4=-2", "20=on", "siw(2)=0x10"]).unwrap();
        assert_eq!(noted.len(), 3);
        assert_eq!(
            noted[0]["wi"].as_array().unwrap()[..6],
            ["0x0000", "0x0000", "0x0005", "0x0000", "0xFFFE", "0xFFFF"]
        );
        assert_eq!(
            (&noted[0]["about"], &noted[2]["wi"][2]),
            (&"SIW(2) = 5, SID(4) = 4294967294".into(), &"0x0010".into())
        );
        assert_eq!(risk(&["io", "set", "SIW2=5"]), Risk::Write);
        assert_eq!(intent(&["io", "set", "SIW2=5", "20=on"]), "switch SIW(2) = 5, SI(20) on");
    }

    #[test]
    fn words_stay_beside_remote_commands() {
        let mut place = [0; 16];
        place[0] = 0x0200;
        let mut bench = Bench::new(Scripted::new([Reply::AddressPair(1, place)]));
        bench.run(&["io", "set", "SIW2=5"]).unwrap();
        let shown = |bench: &mut Bench| bench.run(&["io", "get", "SIW2"]).unwrap()["items"][0].clone();
        assert_eq!(shown(&mut bench)["value"], 5);
        bench.run(&["position"]).unwrap();
        let word = shown(&mut bench);
        assert_eq!((&word["name"], &word["value"], &word["meaning"]), (&"SIW(2)".into(), &5.into(), &Value::Null));
        assert_eq!(bench.into_peer().taken[0][2], 0, "the command used the words");
    }
}
