//! What a session must know to hold the link to a controller.

use tokio::time::Instant;

use super::connect::endpoint;
use super::trace::Recorder;
use crate::command::Access;
use crate::controller::yrcx::answer::Status;
use crate::controller::yrcx::image::{COMMAND_WORDS, Image};
use crate::controller::yrcx::signal::{input, output, resting};
use crate::failure::{Failure, Kind};
use crate::output::Screen;
use crate::settings::Robot;
use crate::transport::session::host::held::{Held, Images, Rules};

/// Opens it for a session to hold.
pub async fn hold(robot: &Robot, access: &Access, screen: &Screen) -> Result<(Images, Option<Recorder>), Failure> {
    let endpoint = endpoint(robot)?;
    let (link, recorder) = endpoint.open(robot, access, screen).await?;
    let size = link.output_size();
    let has_commands = Image::has_commands(size);
    let rules = Rules {
        is_owner: endpoint.is_owner(),
        exclusive: if has_commands { 2 * COMMAND_WORDS } else { 0 },
        command: if has_commands { 2 } else { 0 },
        resting: resting().to_link(size),
        rest: |before| after_loss(&image(before)).to_link(before.len()),
        under_way: |_, seen| {
            let seen = image(seen);
            Status::from_word(seen.0[0]) == Status::Running || output::PROGRAM_RUNNING.is_on(&seen)
        },
    };
    let mut images = Images::new(link, rules).map_err(Failure::local)?;
    if images.begin(Instant::now() + robot.timeout.value).await {
        return Ok((images, recorder));
    }
    // That the controller shows nothing is worth more than how the end of that went.
    let _ = Held::Images(images).close().await;
    Err(silent(&robot.label()))
}

/// What is shown after a loss: nothing is asked for any more, but what was off to keep the robot still stays off.
pub fn after_loss(before: &Image) -> Image {
    let mut after = resting();
    for signal in [input::EMERGENCY_STOP, input::STOP] {
        signal.set(&mut after, signal.is_on(before));
    }
    after
}

/// A controller that shows nothing although the link is up.
pub fn silent(label: &str) -> Failure {
    Failure::new(Kind::NoAnswer, format!("{label}: the controller shows nothing"))
        .hint("check the link: `-v` counts what came")
}

/// The image of what is shown.
fn image(bytes: &[u8]) -> Image {
    Image::from_link(bytes).unwrap_or_default()
}
