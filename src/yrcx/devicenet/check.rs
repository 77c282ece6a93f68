//! Layers of `armctl robots check` for a DeviceNet node: from the adapter to the image of the controller.

use super::board::Board;
use crate::fieldbus::{Checked, InLayer as _, VENDOR_ID};
use crate::prelude::basics::*;
use armctl_transport::devicenet::can::BusState;

/// Layers in the order of the check.
pub(super) const LAYERS: &[&str] = &["name", "adapter", "bus", "MAC ID", "owner", "identity", "sizes", "inputs"];

/// Checks the layers. Returns the image of the controller, if it can be read.
pub(super) async fn check_layers(board: &mut Board, layers: &mut Layers) -> Checked<Option<Image>> {
    let node = board.node.clone();
    layers.ok("name", format!("MAC {} behind {}", node.mac, node.place));
    let network = board.network().await.in_layer("adapter")?;
    layers.ok("adapter", format!("{} at {}", node.place, node.bitrate));
    let nodes = board.nodes().await.in_layer("bus")?;
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
        return Err(("MAC ID", board.absent(&nodes)));
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
        identity => identity.in_layer("owner")?,
    };
    layers.ok("owner", "no master");
    let name = identity.name.as_deref().unwrap_or("without a name");
    let vendor = identity.vendor.map_or_else(|| "?".to_owned(), |vendor| vendor.to_string());
    let told = format!("{name}, vendor {vendor}");
    layers.judge(
        "identity",
        identity.vendor == Some(VENDOR_ID),
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
    let image = image.in_layer("inputs")?;
    match image {
        None => layers.warn(
            "inputs",
            "the controller sends its inputs only in answers to a poll",
            "use `armctl session open` to poll the controller",
        ),
        Some(_) => layers.ok("inputs", "readable"),
    }
    Ok(image)
}

const OWNED: &str = "stop the scan of that master to send commands; read-only commands work in parallel";

/// Listens to the polls of the other master: while the other master owns the node, armctl cannot read the image with
/// messages.
async fn overheard(board: &mut Board, layers: &mut Layers) -> Checked<Option<Image>> {
    let image = board.overheard().await.in_layer("inputs")?;
    match image {
        None => layers.warn("inputs", "the master does not poll the controller", "check the PLC"),
        Some(_) => layers.ok("inputs", "received from the answers of the controller to the master"),
    }
    Ok(image)
}

/// Returns the name of the setting that has these image sizes.
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
