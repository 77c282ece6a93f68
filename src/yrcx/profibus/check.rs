//! Layers of `armctl robots check` for a PROFIBUS line: from the adapter to the image of the controller. The check does
//! not lock the station.

use super::board::Board;
use crate::fieldbus::{Checked, InLayer as _};
use crate::prelude::basics::*;
use armctl_transport::profibus::port::latency_timer;

/// Layers in the order of the check.
pub(super) const LAYERS: &[&str] = &["name", "station", "ident", "configuration", "owner", "inputs"];

/// Checks the layers. Returns the image of the controller, if it can be read.
pub(super) async fn check_layers(board: &mut Board, layers: &mut Layers) -> Checked<Option<Image>> {
    let settings = board.profibus.clone();
    if !settings.is_owner {
        return overheard(board, layers).await;
    }
    // A failure here comes from the adapter, or from another master on the line.
    let answered = board.station().await.in_layer("name")?;
    match latency_timer(&settings.port) {
        None => layers.ok("name", format!("{} opens, and no other master is active", settings.port)),
        Some(time) => layers.warn(
            "name",
            format!("{} opens, but its driver delays characters by {time} ms", settings.port),
            "write 1 to latency_timer of the port in /sys/bus/usb-serial/devices, or set `slot=50ms` in the URL",
        ),
    }
    let Some((station, image)) = answered else {
        layers.fail_with(
            "station",
            format!("station {} does not answer", settings.station),
            "check `station=` and `baud=` in the URL, wires A and B, the terminators, and that the controller is on. Use \
             `yrcx profibus scan` to list the stations that answer",
        );
        return Ok(None);
    };
    if station.kind == "slave" {
        layers.ok("station", format!("station {} answers: {}", station.station, station.diagnosis));
    } else {
        layers.fail_with(
            "station",
            station.kind,
            "check `station=` in the URL; use `yrcx profibus scan` to list the slaves",
        );
        return Ok(None);
    }
    let wanted = settings.ident.map(|ident| format!("{ident:#06x}"));
    match &station.ident {
        None => layers.fail_with("ident", station.diagnosis.clone(), "check that the station is a PROFIBUS DP slave"),
        Some(ident) if wanted.as_ref().is_some_and(|wanted| wanted != ident) => {
            layers.fail_with(
                "ident",
                ident.clone(),
                format!("set `ident={ident}` in the URL, if the station is the controller"),
            );
        }
        Some(ident) => layers.ok("ident", ident.clone()),
    }
    match (&station.configuration, settings.configuration.is_some() || settings.gsd.is_some()) {
        (Some(bytes), _) if station.fits() => layers.ok("configuration", format!("{bytes}, 48 bytes each way")),
        (_, true) => layers.ok("configuration", "configuration as in the URL"),
        (Some(bytes), false) => {
            let sizes =
                [station.in_size, station.out_size].map(|size| size.map_or("?".to_owned(), |size| size.to_string()));
            let found =
                format!("{bytes}: {} bytes from the station and {} bytes to the station, not 48", sizes[0], sizes[1]);
            layers.fail_with("configuration", found, "check `station=` in the URL, and the unit of the controller");
        }
        (None, false) => {
            layers.fail_with(
                "configuration",
                "the station does not report its configuration",
                "set `cfg=` or `gsd=` in the URL",
            );
        }
    }
    let found = station.master.map(|master| format!("master {master} owns the station"));
    layers.judge(
        "owner",
        found.is_none(),
        ("no master", found.as_deref().unwrap_or_default()),
        "disconnect that master to send commands",
    );
    match image {
        Some(_) => layers.ok("inputs", "readable"),
        None => layers.warn(
            "inputs",
            "a slave without a master sends no data",
            "start a master with `armctl session open`, then use `yrcx status` to see the signals",
        ),
    }
    Ok(image)
}

/// With role=listen, armctl sends nothing, so this check only listens.
async fn overheard(board: &Board, layers: &mut Layers) -> Checked<Option<Image>> {
    let opens = format!("{} opens; armctl sends nothing, because of role=listen", board.profibus.port);
    let heard = board.overheard().await;
    if let Err(failure) = &heard
        && failure.kind != Kind::NoAnswer
    {
        return heard.in_layer("name");
    }
    layers.ok("name", opens);
    let image = heard.in_layer("inputs")?;
    layers.ok("inputs", "received from the answers of the slave to the master");
    Ok(image)
}
