//! What a session must know to hold the link to a controller.

use tokio::time::Instant;

use super::reach::{Way, way};
use super::trace::Recorder;
use crate::command::Access;
use crate::controller::yrcx::answer::Status;
use crate::controller::yrcx::image::{COMMAND_WORDS, Image};
use crate::controller::yrcx::signal::{input, output, resting};
use crate::failure::{Failure, Kind};
use crate::output::Screen;
use crate::settings::Robot;
use crate::settings::target::EipRole;
use crate::transport::session::host::held::{Held, Images, Rules};

/// Opens it for a session to hold.
pub async fn hold(robot: &Robot, access: &Access, screen: &Screen) -> Result<(Images, Option<Recorder>), Failure> {
    let way = way(robot)?;
    let (link, recorder) = way.open(robot, access, screen).await?;
    let mut first = resting().to_bytes().to_vec();
    first.resize(way.output_size(), 0);
    let rules = Rules {
        is_owner: !matches!(&way, Way::Eip(eip) if eip.role != EipRole::Owner),
        exclusive: 2 * COMMAND_WORDS,
        command: 2,
        resting: first,
        rest: |before| {
            let mut after = after_loss(&image(before)).to_bytes().to_vec();
            after.resize(before.len(), 0);
            after
        },
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

/// The image at the beginning of what is shown.
fn image(bytes: &[u8]) -> Image {
    bytes.get(..Image::BYTES).and_then(Image::from_bytes).unwrap_or_default()
}
