//! Layers of `armctl robots check` for a network board: from the host name to the image of the controller.

use super::board::Board;
use crate::fieldbus::{Checked, InLayer as _, VENDOR_ID};
use armctl_controller::yrcx::image::Image;
use armctl_frame::face::layers::Layers;
use armctl_frame::settings::target::eip::Eip;
use armctl_transport::eip::probe::AssemblyPresence;

/// Layers in the order of the check.
pub(super) const LAYERS: &[&str] = &["name", "board", "identity", "connection", "owner", "inputs"];

/// Checks the layers. Returns the image of the controller, if it can be read.
pub(super) async fn check_layers(board: &mut Board, layers: &mut Layers) -> Checked<Option<Image>> {
    layers.ok("name", format!("{} is {}", board.eip.host, board.address()));
    match board.services().await.in_layer("board")? {
        None => layers.warn(
            "board",
            "the board accepts sessions, but lists no services",
            "check that the address belongs to a robot's network board",
        ),
        Some(services) if services.len() == 2 => layers.ok("board", services.join(", ")),
        Some(_) => layers.warn(
            "board",
            "the board does not support cyclic images",
            "check that the address belongs to a robot's network board",
        ),
    }
    let identity = board.identity().await.in_layer("identity")?;
    match &identity {
        Some(identity) => {
            let told = format!("{}, vendor {}, revision {}", identity.name, identity.vendor, identity.revision);
            layers.judge(
                "identity",
                identity.vendor == VENDOR_ID,
                (&told, &told),
                "check the address: the vendor id of a YRCX is 636",
            );
        }
        None => layers.warn("identity", "the board has no identity", "check the address"),
    }
    match board.assemblies().await {
        Err(failure) => layers.fail("connection", &failure),
        Ok(found) => connection(&board.eip, found, layers),
    }
    let owned = identity.is_some_and(|identity| identity.owned);
    layers.judge(
        "owner",
        !owned,
        ("no master", "another master, such as a PLC or a session, commands the controller"),
        "stop that connection to send commands; read-only commands work in parallel",
    );
    let image = board.image().await.in_layer("inputs")?;
    layers.ok("inputs", format!("assembly {} is readable", board.eip.input));
    Ok(Some(image))
}

/// Compares the URL with the assemblies of the board. armctl requests no connection, because a connection could take
/// control.
fn connection(settings: &Eip, found: [(u32, AssemblyPresence); 2], layers: &mut Layers) {
    let layer = "connection";
    if let Some((instance, _)) = found.iter().find(|(_, presence)| *presence == AssemblyPresence::Absent) {
        let what = format!("the board has no assembly {instance}");
        return layers.fail_with(layer, what, "find `in=` and `out=` with `yrcx eip probe`");
    }
    let [(input, from), (output, to)] = found.map(|(instance, presence)| match presence {
        AssemblyPresence::Readable(assembly) => (instance, assembly.size),
        AssemblyPresence::Absent | AssemblyPresence::Unknown => (instance, None),
    });
    let differs = |size: Option<u16>, said: u16| size.is_some_and(|size| size != said);
    if differs(from, settings.input_size) || differs(to, settings.output_size) {
        let size = |size: Option<u16>| size.map_or_else(|| "?".to_owned(), |size| size.to_string());
        let (from, to) = (size(from), size(to));
        let what = format!(
            "the board has {from} bytes from the controller and {to} bytes to the controller; the URL has other sizes"
        );
        return layers.fail_with(layer, what, format!("set `in_size={from}` and `out_size={to}` in the URL"));
    }
    let instances = format!("in {input}, out {output}");
    if from.is_none() || to.is_none() {
        let advice = "use `yrcx eip probe --try` to request a connection, which may take control";
        return layers.warn(layer, format!("{instances}: the board does not report the sizes"), advice);
    }
    layers.ok(layer, format!("{instances}: the sizes {} and {} bytes fit", settings.input_size, settings.output_size));
}
