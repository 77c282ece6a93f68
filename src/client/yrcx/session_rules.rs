//! Rules of a session that shares the link to a controller between clients.

use armctl_controller::yrcx::answer::Status;
use armctl_controller::yrcx::image::{COMMAND_WORDS, Image};
use armctl_controller::yrcx::signal::{input, output, resting};
use armctl_transport::image::{Cause, ImageLink, LinkError};
use armctl_transport::session::host::shared_link::{Images, Rules, SharedLink};
use tokio::time::Instant;

use super::Error;

/// Starts a session on this link; `commands` if it commands the controller. Waits for the first image of the
/// controller until the deadline.
///
/// # Errors
/// [`Error::Silent`] without an image.
pub async fn hold(link: ImageLink, commands: bool, until: Instant) -> Result<Images, Error> {
    let size = link.output_size();
    let has_commands = Image::has_commands(size);
    let rules = Rules {
        is_owner: commands,
        exclusive: if has_commands { 2 * COMMAND_WORDS } else { 0 },
        command: if has_commands { 2 } else { 0 },
        resting: resting().to_link(size),
        after_loss: |before| after_loss(&image(before)).to_link(before.len()),
        is_moving: |_, seen| {
            let seen = image(seen);
            Status::from_word(seen.0[0]) == Status::Running || output::PROGRAM_RUNNING.is_on(&seen)
        },
    };
    let mut images = Images::new(link, rules).map_err(|why| LinkError::Local(Cause::new(why)))?;
    if images.begin(until).await {
        return Ok(images);
    }
    // The missing image is the useful error, not a failed close.
    let _ = SharedLink::Images(images).close().await;
    Err(Error::Silent)
}

/// The image after a loss of the link: the resting one, except that an emergency-stop or stop input that was off
/// stays off.
pub(super) fn after_loss(before: &Image) -> Image {
    let mut after = resting();
    for signal in [input::EMERGENCY_STOP, input::STOP] {
        signal.set(&mut after, signal.is_on(before));
    }
    after
}

fn image(bytes: &[u8]) -> Image {
    Image::from_link(bytes).unwrap_or_default()
}
