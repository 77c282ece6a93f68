//! What a session must know to hold the link to a controller, for many clients.

use armctl_controller::yrcx::answer::Status;
use armctl_controller::yrcx::image::{COMMAND_WORDS, Image};
use armctl_controller::yrcx::signal::{input, output, resting};
use armctl_transport::image::{Cause, ImageLink, LinkError};
use armctl_transport::session::host::held::{Held, Images, Rules};
use tokio::time::Instant;

use super::Error;

/// Has a session hold this link; `commands` says whether it commands the controller. The controller is to show something
/// until then.
///
/// # Errors
/// [`Error::Silent`] if it does not.
pub async fn hold(link: ImageLink, commands: bool, until: Instant) -> Result<Images, Error> {
    let size = link.output_size();
    let has_commands = Image::has_commands(size);
    let rules = Rules {
        is_owner: commands,
        exclusive: if has_commands { 2 * COMMAND_WORDS } else { 0 },
        command: if has_commands { 2 } else { 0 },
        resting: resting().to_link(size),
        rest: |before| after_loss(&image(before)).to_link(before.len()),
        under_way: |_, seen| {
            let seen = image(seen);
            Status::from_word(seen.0[0]) == Status::Running || output::PROGRAM_RUNNING.is_on(&seen)
        },
    };
    let mut images = Images::new(link, rules).map_err(|why| LinkError::Local(Cause::new(why)))?;
    if images.begin(until).await {
        return Ok(images);
    }
    // That the controller shows nothing is worth more than how the end of that went.
    let _ = Held::Images(images).close().await;
    Err(Error::Silent)
}

/// What is shown after a loss: nothing is asked for any more, but what was off to keep the robot still stays off.
pub(super) fn after_loss(before: &Image) -> Image {
    let mut after = resting();
    for signal in [input::EMERGENCY_STOP, input::STOP] {
        signal.set(&mut after, signal.is_on(before));
    }
    after
}

/// The image of what is shown.
fn image(bytes: &[u8]) -> Image {
    Image::from_link(bytes).unwrap_or_default()
}
