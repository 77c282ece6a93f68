//! Layers of `armctl robots check` for a DeviceNet node: from the adapter to the image of the controller.

use super::board::{Board, MAKER};
use crate::command::face::layers::Layers;
use crate::controller::yrcx::image::Image;
use crate::failure::Kind;
use crate::transport::devicenet::can::BusState;

/// Layers in the order of the check.
pub(super) const LAYERS: &[&str] = &["name", "adapter", "bus", "MAC ID", "owner", "identity", "sizes", "inputs"];

/// Checks the layers. Returns the image of the controller, if it can be read.
pub(super) async fn look(board: &mut Board, layers: &mut Layers) -> Option<Image> {
    let node = board.node().clone();
    layers.ok("name", format!("MAC {} behind {}", node.mac, node.place));
    let network = match board.network().await {
        Err(failure) => {
            layers.fail("adapter", &failure);
            return None;
        }
        Ok(network) => network,
    };
    layers.ok("adapter", format!("{} at {}", node.place, node.bitrate));
    let nodes = match board.nodes().await {
        Err(failure) => {
            layers.fail("bus", &failure);
            return None;
        }
        Ok(nodes) => nodes,
    };
    let (health, frames) = network.health();
    let advice = "check the bit rate, the 24 V of the bus, its plugs and both terminators (121 ohm)";
    match health.state {
        BusState::Off => layers.fail_with("bus", "the adapter is bus-off", advice),
        BusState::Passive => {
            layers.fail_with("bus", "no other node acknowledges frames (adapter error passive)", advice);
        }
        _ if nodes.is_empty() && frames == 0 => layers.fail_with("bus", "no traffic", advice),
        _ => layers.ok("bus", count(nodes.len())),
    }
    if !nodes.iter().any(|found| found.mac == node.mac.number()) {
        layers.fail("MAC ID", &board.absent(&nodes));
        return None;
    }
    layers.ok("MAC ID", format!("MAC {} is on line", node.mac));
    let identity = match board.identity().await {
        Err(failure) if failure.kind == Kind::Refused => {
            layers.warn(
                "owner",
                "another master, such as a PLC or a session, uses the connections of the controller",
                OWNED,
            );
            return overheard(board, layers).await;
        }
        Err(failure) => {
            layers.fail("owner", &failure);
            return None;
        }
        Ok(identity) => identity,
    };
    layers.ok("owner", "no master");
    let name = identity.name.as_deref().unwrap_or("without a name");
    let vendor = identity.vendor.map_or_else(|| "?".to_owned(), |vendor| vendor.to_string());
    let told = format!("{name}, vendor {vendor}");
    layers.judge(
        "identity",
        identity.vendor == Some(MAKER),
        (&told, &told),
        "check the node: the vendor id of a YRCX is 636",
    );
    match board.sizes().await {
        Err(failure) => layers.fail("sizes", &failure),
        Ok(sizes) => match profile(sizes) {
            Some(name) => layers.ok("sizes", name),
            None => {
                layers.fail_with("sizes", format!("{sizes:?} bytes"), "set the unit's I/O size to Normal or Compact");
            }
        },
    }
    let image = board.image().await;
    board.release().await;
    match image {
        Err(failure) => layers.fail("inputs", &failure),
        Ok(None) => layers.warn(
            "inputs",
            "the controller sends its inputs only in answers to a poll",
            "use `armctl session open` to poll the controller",
        ),
        Ok(Some(image)) => {
            layers.ok("inputs", "readable");
            return Some(image);
        }
    }
    None
}

const OWNED: &str = "stop the scan of that master to send commands; read-only commands work in parallel";

/// With another master on the bus, only listening is possible.
async fn overheard(board: &mut Board, layers: &mut Layers) -> Option<Image> {
    match board.overheard().await {
        Err(failure) => layers.fail("inputs", &failure),
        Ok(None) => layers.warn("inputs", "the master does not poll the controller", "check the PLC"),
        Ok(Some(image)) => {
            layers.ok("inputs", "received from the answers of the controller to the master");
            return Some(image);
        }
    }
    None
}

/// Name of an image size.
pub(super) fn profile(sizes: (Option<u16>, Option<u16>)) -> Option<&'static str> {
    match sizes {
        (Some(48), Some(48)) => Some("Normal: 48 bytes each way"),
        (Some(4), Some(4)) => Some("Compact: 4 bytes each way, without remote commands"),
        _ => None,
    }
}

fn count(nodes: usize) -> String {
    if nodes == 1 { "1 node answers".to_owned() } else { format!("{nodes} nodes answer") }
}
