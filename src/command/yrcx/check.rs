//! The layers of a controller for `armctl robots check`. No connection for images is opened.

use super::connect::endpoint;
use super::link::Yrcx;
use super::overview::left_over;
use crate::command::face::layers::{Layer, Layers};
use crate::command::{Access, Family as _};
use crate::controller::yrcx::answer::Status;
use crate::controller::yrcx::image::Image;
use crate::controller::yrcx::signal::output;
use crate::failure::Failure;
use crate::output::Screen;
use crate::settings::Robot;

/// The layers behind those of the fieldbus.
const SIGNALS: [&str; 7] = ["CPU", "emergency stop", "alarm", "remote command", "mode", "servo", "origin"];

/// Looks at them; reads only.
pub async fn check(robot: &Robot, access: Access, screen: &Screen) -> Result<Vec<Layer>, Failure> {
    let of_bus = endpoint(robot)?.fieldbus().layers;
    let mut layers = Layers::new(robot.label(), [of_bus, &SIGNALS].concat());
    match Yrcx::connect(robot, access, screen).await {
        Err(failure) => layers.fail(of_bus.first().copied().unwrap_or("name"), &failure),
        Ok(mut link) => {
            if let Some(image) = link.any_board()?.check(&mut layers).await {
                signals(&image, &mut layers);
            }
            Yrcx::close(link, screen).await?;
        }
    }
    Ok(layers.finish())
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
        "`yrcx alarm list` names it, `yrcx alarm reset` resets it",
    );
    let status = Status::from_word(image.0[0]);
    layers.judge(
        "remote command",
        status == Status::Ready,
        ("ready", &format!("its status is: {status}")),
        "another command runs, or was left over",
    );
    layers.left_over(&left_over(image));
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
