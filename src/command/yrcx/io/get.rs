//! `yrcx io get`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::{Family, State, readable, table};
use crate::command::ValueKind;
use crate::command::{Command, Context, Need, Report};
use crate::controller::yrcx::signal::{Side, Signal};
use crate::failure::Failure;
use crate::output::view::View;

/// Reads signals.
#[derive(Debug, Args)]
pub struct Get {
    /// Names or numbers, as in servo-on, 20 or SO(157); SI20 for what the controller is shown. All dedicated outputs, and
    /// the general-purpose ones that are on, unless given
    #[arg(value_name = "SIGNAL", value_parser = readable, add = ValueKind::YrcxOutput)]
    signals: Vec<Signal>,
}

impl Command for Get {
    type Family = Family;
    type Report = States;
    const ID: &'static str = "yrcx.io.get";

    fn need(&self) -> Need {
        Need::Sight
    }

    async fn run(&self, context: Context<'_, Family>) -> Result<States, Failure> {
        let given = context.link.shown().copied();
        if given.is_none()
            && let Some(signal) = self.signals.iter().find(|signal| signal.side() == Side::Input)
        {
            return Err(Failure::usage(format!(
                "{signal} is known to whoever commands the controller, and not seen here"
            ))
            .hint("ask in a session, which shows the inputs itself: `armctl session open`"));
        }
        let given = given.unwrap_or_default();
        let shown = context.link.look().await?;
        let of = |signal: Signal| State::of(signal, if signal.side() == Side::Input { &given } else { &shown });
        let signals = if self.signals.is_empty() {
            Signal::all(Side::Output).filter(|signal| !signal.is_general() || signal.is_on(&shown)).map(of).collect()
        } else {
            self.signals.iter().copied().map(of).collect()
        };
        Ok(States { signals })
    }
}

/// Signals.
#[derive(Debug, Serialize, JsonSchema)]
pub struct States {
    signals: Vec<State>,
}

impl Report for States {
    fn view(&self) -> View {
        View::table(table(&self.signals, "no signals"))
    }
}
