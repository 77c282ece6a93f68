//! `yrcx io watch`: signal changes as they occur.

use super::row;
use crate::prelude::*;
use armctl_controller::names::Kind;
use armctl_frame::robot::io::{IoValue, Signals, WATCHED};

/// Arguments: the outputs of the controller to watch.
#[derive(Debug, Args)]
pub struct Outputs {
    /// Names or numbers of outputs of the controller, for example servo-on or 20 [default: all outputs]
    #[arg(value_name = "SIGNAL", value_parser = output, add = complete::OUTPUT)]
    signals: Vec<Signal>,
}

fn output(text: &str) -> Result<Signal, String> {
    names::parse_or_name(&[Kind::Signal], "SO(20)", text, output_by_address)
}

fn output_by_address(text: &str) -> Result<Signal, String> {
    Signal::parse(Side::Output, text).map_err(|error| error.to_string())
}

impl Command for Outputs {
    type Family = Yrcx;
    type Report = Signals;
    const ID: &'static str = "yrcx.io.outputs";
    const CONNECT_MODE: ConnectMode = ConnectMode::Monitor;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Signals> {
        let names = names::of_robot(context.robot, context.screen);
        let link = context.link;
        // Report the image that the wait received, so that even a very short change is reported.
        let image = match link.last_received.take() {
            Some(image) => image,
            None => link.read_signals().await?,
        };
        link.last_reported = Some(image);
        let signals = if self.signals.is_empty() { Signal::all(Side::Output).collect() } else { self.signals.clone() };
        Signals::new(signals.into_iter().map(|signal| row(signal, &image, names)).collect())
    }
}

impl Watchable for Outputs {
    type Value = IoValue;

    const WATCH: &'static str = "yrcx.io.watch";
    const WATCHED: Watched = WATCHED;

    async fn changed(&self, link: &mut Link) -> Result<()> {
        let last_reported = link.last_reported;
        link.last_received = Some(link.wait_for_image(|image| Some(*image) != last_reported).await?);
        Ok(())
    }
}
