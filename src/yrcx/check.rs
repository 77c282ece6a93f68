//! Checks of the controller for `armctl robots check`. They open no connection for images.

use super::connect::endpoint;
use super::overview::left_over;
use crate::prelude::*;
use armctl_controller::yrcx::answer::Status;
use armctl_frame::Family as _;
use armctl_frame::face::layers::Layer;
use armctl_frame::session_client::is_held;
use armctl_frame::settings::Sessions;

/// Layers that follow the layers of the fieldbus.
const SIGNALS: [&str; 8] = ["CPU", "emergency stop", "alarm", "remote command", "program", "mode", "servo", "origin"];

/// Checks the layers. It only reads. If a session is open, the check reads the image through the session and opens no
/// second connection for images.
pub async fn check(robot: &Robot, access: Access, screen: &Screen) -> Result<Vec<Layer>> {
    let fieldbus = endpoint(robot)?.fieldbus();
    let [first, .., last] = fieldbus.layers else {
        return Err(Failure::local("internal error: a fieldbus without layers"));
    };
    let mut layers = Layers::new(robot.label(), [fieldbus.layers, &SIGNALS].concat());
    let held = is_held(robot);
    let mut image = None;
    if held && !fieldbus.has_room {
        layers.ok(first, "an open session uses the connection, so other clients cannot read");
    } else {
        match Box::pin(Yrcx::connect(robot, access.clone(), screen)).await {
            Err(failure) => layers.fail(first, &failure),
            Ok(mut link) => {
                image = link.any_board()?.check(&mut layers).await;
                Yrcx::close(link, screen).await?;
            }
        }
    }
    if held && image.is_none() && layers.is_passed() {
        match Box::pin(through_session(robot, access, screen)).await {
            Err(failure) => layers.fail(last, &failure),
            Ok(seen) => {
                layers.ok(last, "read through the session");
                image = Some(seen);
            }
        }
    }
    if let Some(image) = image {
        signals(&image, held, &mut layers);
    }
    Ok(layers.finish())
}

/// Reads the image of the controller through the session that keeps the connection open.
async fn through_session(robot: &Robot, access: Access, screen: &Screen) -> Result<Image> {
    let robot = Robot { sessions: Sessions::Only, ..robot.clone() };
    let access = Access { mode: ConnectMode::Monitor, trace: None, ..access };
    let mut link = Yrcx::connect(&robot, access, screen).await?;
    let image = link.look().await;
    Yrcx::close(link, screen).await?;
    image
}

fn signals(image: &Image, held: bool, layers: &mut Layers) {
    let mut must = |layer, is_well: bool, (well, ill): (&str, &str), advice: &str| {
        if is_well { layers.ok(layer, well) } else { layers.fail_with(layer, ill, advice) }
    };
    let is_stopped = output::EMERGENCY_STOP.is_on(image);
    must("CPU", output::CPU_OK.is_on(image), ("ready", "SO(01) is off"), "read the controller's display");
    must(
        "emergency stop",
        !is_stopped,
        ("released", "pressed, or no master sets SI(00)"),
        "release the emergency stop, then use `yrcx recover`",
    );
    must(
        "alarm",
        !output::ALARM.is_on(image),
        ("none", "SO(03) is on"),
        "see `yrcx alarm list`, then reset with `yrcx alarm reset`",
    );
    let status = Status::from_word(image.0[0]);
    layers.judge(
        "remote command",
        status == Status::Ready,
        ("ready", &format!("the status is: {status}")),
        "wait until the command ends: another command is running, or an earlier command did not finish",
    );
    layers.leftover_drafts(&left_over(image));
    let runs = output::PROGRAM_RUNNING.is_on(image);
    let is_idle = !runs && !held;
    // The signals do not identify the program. A running program is not a fault.
    layers.ok(
        "program",
        if runs {
            "running; use `yrcx info tasks` to see the program, and `yrcx stop` to stop it"
        } else {
            "not running"
        },
    );
    layers.judge(
        "mode",
        output::AUTO_MODE.is_on(image),
        ("auto", "manual"),
        "select AUTO mode at the SAFETY connector and the programming box: programs need AUTO mode",
    );
    layers.judge(
        "servo",
        output::SERVO_ON.is_on(image),
        (
            if is_idle {
                "motor power on, but no program is running and no session is open; use `yrcx motor off` to switch \
                 motor power off"
            } else {
                "motor power on"
            },
            "motor power off",
        ),
        "use `yrcx power-on` or `yrcx motor on`: a motion needs motor power",
    );
    layers.judge(
        "origin",
        output::ORIGIN_COMPLETE.is_on(image),
        ("complete", "incomplete"),
        "use `yrcx origin`: a move to a position needs a complete return to origin",
    );
}
