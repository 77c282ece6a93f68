//! `yrcx io watch`: each change, as it comes.

use std::time::Duration;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::{State, table};
use crate::command::ValueKind;
use crate::command::yrcx::link::Yrcx;
use crate::command::{Command, ConnectMode, Context, Report};
use crate::controller::yrcx::image::Image;
use crate::controller::yrcx::signal::{Side, Signal};
use crate::failure::Failure;
use crate::output::view::View;
use crate::settings::duration;

/// Tells how signals stand, and then each change, until Ctrl-C, --for, or so many reports as --count says.
#[derive(Debug, Args)]
pub struct Watch {
    /// Names or numbers of outputs of the controller, as in servo-on or 20; all unless given
    #[arg(value_name = "SIGNAL", value_parser = output, add = ValueKind::YrcxOutput)]
    signals: Vec<Signal>,
    /// How long to go on
    #[arg(long = "for", value_name = "TIME", value_parser = duration::parse_some)]
    within: Option<Duration>,
}

fn output(text: &str) -> Result<Signal, String> {
    Signal::parse(Side::Output, text).map_err(|error| error.to_string())
}

impl Watch {
    fn signals(&self) -> Vec<Signal> {
        if self.signals.is_empty() { Signal::all(Side::Output).collect() } else { self.signals.clone() }
    }
}

impl Command for Watch {
    type Family = Yrcx;
    type Report = Changes;
    const ID: &'static str = "yrcx.io.watch";
    const CONNECT_MODE: ConnectMode = ConnectMode::Monitor;

    fn is_endless(&self) -> bool {
        true
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Changes, Failure> {
        let signals = self.signals();
        let Some(before) = context.link.told else {
            let image = context.link.look().await?;
            context.link.told = Some(image);
            let is_told = |signal: &Signal| !self.signals.is_empty() || !signal.is_general() || signal.is_on(&image);
            let states = signals.into_iter().filter(is_told).map(|signal| State::of(signal, &image));
            return Ok(Changes { signals: states.collect() });
        };
        let differs = |signal: &Signal, image: &Image| signal.is_on(image) != signal.is_on(&before);
        let image = context.link.look_until(|image| signals.iter().any(|signal| differs(signal, image))).await?;
        context.link.told = Some(image);
        let changed = signals.into_iter().filter(|signal| differs(signal, &image));
        Ok(Changes { signals: changed.map(|signal| State::of(signal, &image)).collect() })
    }
}

/// What changed at one moment; at first, how signals stand.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Changes {
    signals: Vec<State>,
}

impl Report for Changes {
    fn view(&self) -> View {
        View::table(table(&self.signals, "no signal is on"))
    }
}
