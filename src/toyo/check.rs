//! Checks of `armctl robots check` that are specific to the controller.

use super::info;
use super::overview::left_over;
use crate::prelude::*;
use armctl_controller::toyo::errors;
use armctl_controller::toyo::status::RunMode;
use armctl_frame::Family as _;
use armctl_frame::face::layers::{Layer, Layers};
use armctl_frame::session_client::is_held;

const LAYERS: &[&str] =
    &["line", "answer", "version", "teach pendant", "mode", "slaves", "power cycle", "error", "servo", "origin"];

/// Checks the layers. It sends only read requests.
pub async fn check(robot: &Robot, access: Access, screen: &Screen) -> Result<Vec<Layer>> {
    let mut layers = Layers::new(robot.label(), LAYERS);
    match Toyo::connect(robot, access, screen).await {
        Err(failure) => layers.fail("line", &failure),
        Ok(mut link) => {
            layers.ok("line", format!("{} is open", robot.target.value));
            check_state(robot, &mut link, &mut layers).await;
            Toyo::close(link, screen).await?;
        }
    }
    Ok(layers.finish())
}

async fn check_state(robot: &Robot, link: &mut Link, layers: &mut Layers) {
    let status = match link.status().await {
        Ok(status) => status,
        Err(failure) => return layers.fail("answer", &failure),
    };
    layers.ok("answer", "all pages of the status were received");
    match info::version(link).await {
        Ok(version) => layers.ok("version", version),
        Err(failure) => layers.warn("version", failure.message, "use `toyo info` to see details"),
    }
    layers.judge(
        "teach pendant",
        !status.pendant_on(),
        ("off", "on"),
        "switch the teach pendant OFF to allow commands of the host",
    );
    let mode = status.run_mode().map_or("unknown", RunMode::name);
    layers.ok("mode", mode);
    if status.slave_not_ready() {
        layers.fail_with("slaves", "a slave does not answer", "check power and cables of the slave stations");
    } else {
        layers.ok("slaves", "ready");
    }
    if status.needs_power_cycle() {
        layers.fail_with(
            "power cycle",
            "a machine parameter (parameter 2) was changed, and the controller executes no command until a restart",
            "switch the controller's power off and on",
        );
    } else {
        layers.ok("power cycle", "not due");
    }
    if status.has_error() || status.error != errors::NONE {
        let error = errors::explain(status.error);
        layers.fail_with("error", format!("{:02X}, {}: {}", error.code, error.name, error.cause), error.remedy);
    } else {
        layers.ok("error", "none");
    }
    layers.leftover_drafts(&left_over(status));
    // Servo power without motion is only a remark, and not a failure.
    let is_idle = !status.executing() && !status.homing() && !is_held(robot);
    let on = if is_idle {
        "on, but no program runs and no session is open; use `toyo servo off` to switch servo power off"
    } else {
        "on"
    };
    layers.judge("servo", status.servo_on(), (on, "off"), "use `toyo servo on`: a motion needs servo power");
    layers.judge("origin", status.homed(), ("done", "not done"), "use `toyo home`: a motion needs the origin");
}
