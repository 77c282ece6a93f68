//! Layers of `armctl robots check` for a PROFINET device: from the interface to the image of the controller. The check
//! opens a connection only to a simulator, because a real controller stops the robot when a connection ends.

use super::board::Board;
use super::connect;
use crate::fieldbus::{Checked, InLayer as _};
use crate::prelude::basics::*;
use armctl_transport::image::{Event, ImageLink};
use armctl_transport::profinet::commission::StationInfo;
use armctl_transport::profinet::error::{ModuleMismatch, ProfinetError};
use armctl_transport::profinet::layout::Layout;
use armctl_transport::profinet::simulated::Network;
use armctl_transport::profinet::wire::connect::ExpectedSubmodule;
use armctl_transport::profinet::wire::frame::ETHER_TYPE;
use armctl_transport::profinet::wire::record::RealModule;

/// Layers in the order of the check.
pub(super) const LAYERS: &[&str] = &["name", "interface", "privilege", "station", "IP", "RPC", "modules", "data"];

/// Checks the layers. Returns the image of the controller, if it can be read.
pub(super) async fn check_layers(board: &Board, layers: &mut Layers) -> Checked<Option<Image>> {
    let profinet = board.profinet.clone();
    layers.ok("name", format!("{} through {}", profinet.station, profinet.interface));
    let interface = board.interface().in_layer("interface")?;
    let usable = interface.check().and_then(|()| interface.address());
    let local_address = usable.map_err(|error| board.failure(error)).in_layer("interface")?;
    layers.ok(
        "interface",
        format!("{} is up with a carrier, {} at {}", interface.name, local_address.address, interface.mac),
    );
    if interface.network().is_none() {
        interface.raw_socket(ETHER_TYPE).map_err(|error| board.failure(error)).in_layer("privilege")?;
    }
    layers.ok("privilege", "raw Ethernet is allowed");
    let found = board.station().await.in_layer("station")?;
    let kind = &found.station.kind;
    layers.ok("station", format!("'{}' at {}, {kind}, found once", found.station.name, found.mac));
    let address = match (found.station.address(), profinet.ip) {
        (None, None) => {
            let station = profinet.station.to_string();
            return Err(("IP", board.failure(ProfinetError::NoAddress(station))));
        }
        (has, Some(wanted)) if has != Some(wanted.address) => {
            let has = has.map_or_else(|| "none".to_owned(), |address| address.to_string());
            let found = format!("the device has {has}, the target has {}", wanted.address);
            layers.warn(
                "IP",
                found,
                "check ip= of the target: a connection sets this address until the device is switched off",
            );
            return Ok(None);
        }
        (None, Some(wanted)) => wanted.address,
        (Some(address), _) => address,
    };
    if !local_address.is_same_network(address) {
        let (station, local_address) = (profinet.station.to_string(), local_address.address);
        return Err(("IP", board.failure(ProfinetError::OtherNetwork { station, device: address, local_address })));
    }
    layers.ok("IP", format!("{address}, in the network of {}", local_address.address));
    records(board, &found, layers).await?;
    if let Some(network) = Network::find(&profinet.interface) {
        return data(board, &network, layers).await.in_layer("data");
    }
    layers.warn(
        "data",
        "a device sends its data only to the controller that owns the connection",
        "connect with `armctl session open`, then use `yrcx status` to see the signals",
    );
    Ok(None)
}

/// Checks the records of the device.
async fn records(board: &Board, found: &StationInfo, layers: &mut Layers) -> Checked<()> {
    let identity = board.identity(found.clone()).await.in_layer("RPC")?;
    match identity.im0 {
        Ok(im0) => layers.ok("RPC", format!("answers: order id '{}', vendor {:#06x}", im0.order_id, im0.vendor)),
        Err(ProfinetError::Refused { status, .. }) => {
            layers.ok("RPC", format!("answers, but refuses to report its identity: {status}"));
        }
        Err(error) => return Err(("RPC", board.failure(error))),
    }
    let settings = match connect::settings(&board.profinet, Duration::ZERO) {
        Ok(settings) => Some(settings),
        Err(error) => {
            let advice = error.cause().advice.clone().unwrap_or_default();
            let has = identity.modules.as_ref().map_or_else(|_| String::new(), |modules| listed(modules));
            layers.fail_with("modules", format!("{error}{has}"), advice);
            None
        }
    };
    let Some(settings) = settings else { return Ok(()) };
    match identity.modules {
        Ok(real) => {
            let mismatches = mismatches(&settings.layout, &real);
            if !mismatches.is_empty() {
                return Err(("modules", board.failure(ProfinetError::Modules(mismatches))));
            }
            let layout = &settings.layout;
            match left_out(layout, &real) {
                None => layers.ok("modules", format!("modules as in the target: {layout}")),
                Some(left_out) => layers.warn(
                    "modules",
                    format!(
                        "modules as in the target, except {left_out} of the access point, which only the device has: \
                         {layout}"
                    ),
                    "use `yrcx profinet probe` to list the submodules of the access point; a device can require all \
                     of them",
                ),
            }
        }
        Err(error) => {
            layers.warn(
                "modules",
                format!("the device does not report its modules: {error}"),
                "open a connection to see whether the modules fit",
            );
        }
    }
    Ok(())
}

/// Lists the modules of the device, for example `; it has 0:0x1,1:0x101`.
fn listed(modules: &[RealModule]) -> String {
    let all: Vec<String> = modules.iter().map(|module| format!("{}:{:#x}", module.slot, module.ident)).collect();
    format!("; it has {}", all.join(","))
}

/// Compares the layout with the real modules of the device, and returns the differences.
fn mismatches(layout: &Layout, real: &[RealModule]) -> Vec<ModuleMismatch> {
    let mut mismatches = Vec::new();
    for module in layout.expected() {
        let (slot, there) = (module.slot, real.iter().find(|real| real.slot == module.slot));
        let (found, expected) = (there.map(|real| real.ident), Some(module.ident));
        if found != expected {
            mismatches.push(ModuleMismatch { slot, subslot: None, found, expected });
            continue;
        }
        for ExpectedSubmodule { subslot, ident, .. } in module.submodules {
            let submodules = there.into_iter().flat_map(|real| &real.submodules);
            let found = submodules.filter(|(real, _)| *real == subslot).map(|(_, ident)| *ident).next();
            if found != Some(ident) {
                mismatches.push(ModuleMismatch { slot, subslot: Some(subslot), found, expected: Some(ident) });
            }
        }
    }
    mismatches
}

/// Lists the submodules of the access point that the layout does not contain.
fn left_out(layout: &Layout, real: &[RealModule]) -> Option<String> {
    let head = real.iter().find(|module| module.slot == 0)?;
    let left_out = head.submodules.iter().filter(|(subslot, _)| layout.find(0, *subslot).is_none());
    let left_out: Vec<String> =
        left_out.map(|(subslot, ident)| format!("0.{subslot:#x}:{:#x}/{ident:#x}", head.ident)).collect();
    (!left_out.is_empty()).then(|| left_out.join(","))
}

/// Connects to a simulator and reads the first image.
async fn data(board: &Board, network: &Network, layers: &mut Layers) -> Result<Option<Image>> {
    let settings = connect::settings(&board.profinet, Duration::ZERO);
    let Ok(settings) = settings else { return Ok(None) };
    let link = network.open(settings).map_err(|error| board.failure(error))?;
    let mut link = ImageLink::in_process(Box::new(link));
    let until = tokio::time::Instant::now() + Duration::from_secs(3);
    let event = link.next(until).await;
    let _ = link.close().await;
    match event {
        Event::Image(image) => {
            layers.ok("data", "flows both ways");
            Ok(Image::from_link(&image))
        }
        Event::Lost(error) => Err(board.failure_of(&error)),
        _ => Err(board.failure(ProfinetError::Ended)),
    }
}
