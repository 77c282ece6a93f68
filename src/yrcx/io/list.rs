//! `yrcx io list`.

use super::row;
use crate::prelude::*;
use armctl_frame::robot::io::{Filter, Signals};

/// Reads all signals. Inputs are listed only in a session, because only the client that sets the inputs can read them.
#[derive(Debug, Args)]
pub struct List {
    #[command(flatten)]
    filter: Filter,
}

impl Command for List {
    type Family = Yrcx;
    type Report = Signals;
    const ID: &'static str = "yrcx.io.list";
    const CONNECT_MODE: ConnectMode = ConnectMode::Monitor;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Signals> {
        let names = names::of_robot(context.robot, context.screen);
        let inputs = context.link.output_image().copied();
        let outputs = context.link.read_signals().await?;
        let inputs = inputs.iter().flat_map(|image| Signal::all(Side::Input).map(move |signal| (signal, image)));
        let all = inputs.chain(Signal::all(Side::Output).map(|signal| (signal, &outputs)));
        let rows = all.map(|(signal, image)| row(signal, image, names)).filter(|row| self.filter.lists(row));
        Signals::new(rows.collect())
    }
}
