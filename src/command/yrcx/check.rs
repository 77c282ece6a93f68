//! The layers of a controller for `armctl robots check`. No connection for images is opened.

use super::eip::board::{Board, MAKER, Probed};
use super::link::Link;
use super::link::Yrcx;
use crate::command::face::layers::{Layer, Layers};
use crate::command::{Access, Family as _};
use crate::controller::yrcx::answer::Status;
use crate::controller::yrcx::image::Image;
use crate::controller::yrcx::signal::output;
use crate::failure::Failure;
use crate::output::Screen;
use crate::settings::Robot;

const LAYERS: &[&str] = &[
    "name",
    "board",
    "identity",
    "connection",
    "owner",
    "inputs",
    "CPU",
    "emergency stop",
    "alarm",
    "remote command",
    "mode",
    "servo",
    "origin",
];

/// Looks at them; reads only.
pub async fn check(robot: &Robot, access: Access, screen: &Screen) -> Result<Vec<Layer>, Failure> {
    let mut layers = Layers::new(robot.label(), LAYERS);
    match Yrcx::connect(robot, access, screen).await {
        Err(failure) => layers.fail("name", &failure),
        Ok(mut link) => {
            look(&mut link, &mut layers).await?;
            Yrcx::close(link, screen).await?;
        }
    }
    Ok(layers.finish())
}

async fn look(link: &mut Link, layers: &mut Layers) -> Result<(), Failure> {
    let board = link.board()?;
    layers.ok("name", format!("{} is {}", board.settings().host, board.address()));
    match board.services().await {
        Err(failure) => {
            layers.fail("board", &failure);
            return Ok(());
        }
        Ok(None) => layers.warn("board", "it takes sessions, but tells no services", "it may be no board of a robot"),
        Ok(Some(services)) if services.len() == 2 => layers.ok("board", services.join(", ")),
        Ok(Some(_)) => layers.warn("board", "it says that it has no images", "it may be no board of a robot"),
    }
    let identity = match board.identity().await {
        Err(failure) => {
            layers.fail("identity", &failure);
            return Ok(());
        }
        Ok(identity) => identity,
    };
    match &identity {
        Some(identity) => {
            let told = format!("{}, vendor {}, revision {}", identity.name, identity.vendor, identity.revision);
            layers.judge("identity", identity.vendor == MAKER, (&told, &told), "not the maker's number, which is 636");
        }
        None => layers.warn("identity", "it does not say who it is", "check the address"),
    }
    let owned = match board.rehearse(identity.as_ref()).await {
        Err(failure) => {
            layers.fail("connection", &failure);
            identity.is_some_and(|identity| identity.owned)
        }
        Ok(probed) => {
            connection(board, &probed, layers);
            probed.owned
        }
    };
    layers.judge(
        "owner",
        !owned,
        ("no master commands it", "another master, such as a PLC or a session, commands it"),
        "commands want that connection stopped first; what only looks works beside it",
    );
    match board.image().await {
        Err(failure) => layers.fail("inputs", &failure),
        Ok(image) => {
            layers.ok("inputs", format!("assembly {} can be read", board.settings().input));
            signals(&image, layers);
        }
    }
    Ok(())
}

/// Whether the URL fits the board.
fn connection(board: &Board, probed: &Probed, layers: &mut Layers) {
    let layer = "connection";
    let settings = board.settings();
    let Some(found) = &probed.connectable else {
        let last = probed.attempts.last();
        let found = last.map_or_else(|| "it was not asked for".to_owned(), |last| last.answer.clone());
        return layers.wrong(layer, found, "`yrcx eip probe` finds in, out and config of the board");
    };
    let differs = |size: Option<u16>, said: u16| size.is_some_and(|size| size != said);
    if differs(found.in_size, settings.input_size) || differs(found.out_size, settings.output_size) {
        let size = |size: Option<u16>| size.map_or_else(|| "?".to_owned(), |size| size.to_string());
        let (from, to) = (size(found.in_size), size(found.out_size));
        let what = format!("the board has {from} bytes from it and {to} to it, the URL others");
        return layers.wrong(layer, what, format!("set in_size={from} and out_size={to} in the URL"));
    }
    let instances = format!("in {}, out {}", found.input, found.output);
    layers.ok(layer, format!("{instances}, {} and {} bytes fit", settings.input_size, settings.output_size));
}

fn signals(image: &Image, layers: &mut Layers) {
    let mut must = |layer, is_well: bool, (well, ill): (&str, &str), advice: &str| {
        if is_well { layers.ok(layer, well) } else { layers.wrong(layer, ill, advice) }
    };
    let is_stopped = output::EMERGENCY_STOP.is_on(image);
    must("CPU", output::CPU_OK.is_on(image), ("it works", "SO(01) is off"), "look at the controller's display");
    must(
        "emergency stop",
        !is_stopped,
        ("released", "pressed, or no master shows SI(00)"),
        "release it, then `yrcx recover`",
    );
    must(
        "alarm",
        !output::ALARM.is_on(image),
        ("none", "SO(03) is on"),
        "`yrcx info alarm` names it, `yrcx alarm reset` resets it",
    );
    let status = Status::of(image.0[0]);
    layers.judge(
        "remote command",
        status == Status::Ready,
        ("ready", &format!("its status is: {status}")),
        "another command runs, or was left over",
    );
    layers.judge(
        "mode",
        output::AUTO_MODE.is_on(image),
        ("auto", "manual"),
        "programs want AUTO mode: select it at the SAFETY connector and the programming box",
    );
    layers.judge(
        "servo",
        output::SERVO_ON.is_on(image),
        ("motor power on", "motor power off"),
        "motion wants it: `yrcx power-on`, or `yrcx motor on`",
    );
    layers.judge(
        "origin",
        output::ORIGIN_COMPLETE.is_on(image),
        ("complete", "incomplete"),
        "motion to positions wants it: `yrcx origin`",
    );
}
