//! `yrcx io get`.

use super::{SignalOrWord, readables, row, word_item};
use crate::number_arguments::Series;
use crate::prelude::*;
use armctl_frame::robot::io::{IoRow, IoValue, Signals};

/// Reads signals and general-purpose words.
#[derive(Debug, Args)]
#[command(after_help = "While a remote command runs, the words contain the command and its answer.")]
pub struct Get {
    /// Names or numbers, for example servo-on, 20 or SO(157). SI20 is an input of the controller. SOW2, SOD4, SIW2 and
    /// SID4 are words. SO20..SO37 is a range. Names from robots.toml are also valid [default: all dedicated outputs,
    /// and the general-purpose outputs that are on]
    #[arg(value_name = "SIGNAL", value_delimiter = ',', value_parser = readables, add = complete::OUTPUT)]
    signals: Vec<Series<SignalOrWord>>,
}

impl Command for Get {
    type Family = Yrcx;
    type Report = Signals;
    const ID: &'static str = "yrcx.io.get";
    const CONNECT_MODE: ConnectMode = ConnectMode::Monitor;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Signals> {
        let names = names::of_robot(context.robot, context.screen);
        let given = context.link.output_image().copied();
        if given.is_none()
            && let Some(signal) = Series::all(&self.signals).find(|signal| signal.side() == Side::Input)
        {
            return Err(Failure::usage(format!(
                "{signal} can be read only by the client that commands the controller"
            ))
            .hint("open a session (`armctl session open`) and repeat the command"));
        }
        let given = given.unwrap_or_default();
        let shown = context.link.read_signals().await?;
        let image = |side| if side == Side::Input { &given } else { &shown };
        if self.signals.is_empty() {
            let told = Signal::all(Side::Output).filter(|signal| !signal.is_general() || signal.is_on(&shown));
            return Signals::new(told.map(|signal| row(signal, &shown, names)).collect());
        }
        let rows = Series::all(&self.signals).map(|readable| match *readable {
            SignalOrWord::Signal(signal) => row(signal, image(signal.side()), names),
            SignalOrWord::Word(register) => {
                let image = image(register.side());
                let value = IoValue::Number(register.read(&image.command()));
                IoRow::new(word_item(register, Some(image), names), Ok(value))
            }
        });
        Signals::new(rows.collect())
    }
}
