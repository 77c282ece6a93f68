//! `yrcx devicenet scan`.

use super::board::{Board, Node};
use crate::board_report::BoardReport;
use crate::prelude::*;

/// Nodes that answered a duplicate MAC ID check. No node is allocated.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ScanReport {
    /// Nodes in the order of their MAC IDs.
    nodes: Vec<Node>,
}

impl BoardReport for ScanReport {
    type Board = Board;
    const ID: &'static str = "yrcx.devicenet.scan";
    const MESSAGES: &'static str = "a duplicate MAC ID check for every MAC ID";

    async fn read(board: &mut Board) -> Result<Self> {
        Ok(Self { nodes: board.nodes().await? })
    }
}

impl Report for ScanReport {
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
