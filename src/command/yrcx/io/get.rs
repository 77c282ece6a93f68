//! `yrcx io get`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::{Readable, State, WordState, readables, table, word_table};
use crate::command::frame::names;
use crate::command::yrcx::complete;
use crate::command::yrcx::link::Yrcx;
use crate::command::yrcx::numbers::Series;
use crate::command::{Command, ConnectMode, Context, Report};
use crate::controller::yrcx::signal::{Side, Signal};
use crate::failure::Failure;
use crate::output::view::{Section, View};

/// Reads signals and general-purpose words.
#[derive(Debug, Args)]
#[command(after_help = "Words are those of remote commands and their answers, too, as long as those last.")]
pub struct Get {
    /// Names or numbers, as in servo-on, 20 or SO(157); SI20 for what the controller is shown; SOW2, SOD4, SIW2, SID4 for
    /// words; SO20..SO37 is a range;
    /// names of robots.toml. All dedicated outputs, and the general-purpose ones that are on, unless given
    #[arg(value_name = "SIGNAL", value_delimiter = ',', value_parser = readables, add = complete::OUTPUT)]
    signals: Vec<Series<Readable>>,
}

impl Command for Get {
    type Family = Yrcx;
    type Report = States;
    const ID: &'static str = "yrcx.io.get";
    const CONNECT_MODE: ConnectMode = ConnectMode::Monitor;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<States, Failure> {
        let names = names::of(context.robot, context.screen);
        let given = context.link.shown().copied();
        if given.is_none()
            && let Some(signal) = Series::all(&self.signals).find(|signal| signal.side() == Side::Input)
        {
            return Err(Failure::usage(format!(
                "{signal} is known to whoever commands the controller, and not seen here"
            ))
            .hint("ask in a session, which shows the inputs itself: `armctl session open`"));
        }
        let given = given.unwrap_or_default();
        let shown = context.link.look().await?;
        let image = |side| if side == Side::Input { &given } else { &shown };
        let mut states = States { signals: Vec::new(), words: Vec::new() };
        if self.signals.is_empty() {
            let told = Signal::all(Side::Output).filter(|signal| !signal.is_general() || signal.is_on(&shown));
            states.signals = told.map(|signal| State::of(signal, &shown, names)).collect();
        }
        for readable in Series::all(&self.signals) {
            match *readable {
                Readable::Signal(signal) => states.signals.push(State::of(signal, image(signal.side()), names)),
                Readable::Word(register) => states.words.push(WordState::of(register, image(register.side()), names)),
            }
        }
        Ok(states)
    }
}

/// Signals and words.
#[derive(Debug, Serialize, JsonSchema)]
pub struct States {
    signals: Vec<State>,
    words: Vec<WordState>,
}

impl Report for States {
    fn view(&self) -> View {
        let signals = (!self.signals.is_empty() || self.words.is_empty()).then(|| table(&self.signals, "no signals"));
        let words = (!self.words.is_empty()).then(|| word_table(&self.words));
        View { sections: signals.into_iter().chain(words).map(Section::Table).collect() }
    }
}
