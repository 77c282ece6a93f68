//! `yrcx devicenet scan`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::board::Node;
use super::{NO_UNIT, board_of};
use crate::link::Yrcx;
use armctl_frame::failure::{Failure, Kind};
use armctl_frame::output::view::{Section, Table, View};
use armctl_frame::{Command, ConnectMode, Context, Report};

/// Lists the nodes of the bus with a duplicate MAC ID check for each MAC ID. No node is allocated.
#[derive(Debug, Args)]
pub struct Scan {}

impl Command for Scan {
    type Family = Yrcx;
    type Report = Scanned;
    const ID: &'static str = "yrcx.devicenet.scan";
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Scanned, Failure> {
        context.link.no_unit(NO_UNIT)?;
        context.link.then("a duplicate MAC ID check for every MAC ID");
        Ok(Scanned { nodes: board_of(context.link)?.nodes().await? })
    }
}

/// Nodes that answered.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Scanned {
    /// Nodes in the order of their MAC IDs.
    nodes: Vec<Node>,
}

impl Report for Scanned {
    fn view(&self) -> View {
        let mut table = Table::new(&["MAC ID", "vendor", "serial", "state"], "no node answered");
        for node in &self.nodes {
            let state = if node.on_line { "on line" } else { "going on line" };
            table.row([u32::from(node.mac).into(), node.vendor.into(), node.serial.as_str().into(), state.into()]);
        }
        View::default().append(Section::Table(table))
    }

    fn failure(&self) -> Option<Failure> {
        self.nodes.is_empty().then(|| {
            Failure::new(Kind::NoAnswer, "no node answered on the bus")
                .hint("check the bit rate, the 24 V of the bus, its plugs and both terminators (121 ohm)")
        })
    }
}
