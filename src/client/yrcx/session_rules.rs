//! Rules of a session that shares the link to one controller between several clients.

use armctl_controller::yrcx::answer::Status;
use armctl_controller::yrcx::image::{COMMAND_WORDS, Image};
use armctl_controller::yrcx::signal::{output, resting};
use armctl_transport::image::{Cause, ImageLink, LinkError};
use armctl_transport::session::host::shared_link::{Images, Rules, SharedLink};
use tokio::time::Instant;

use super::Error;

/// Starts a session on this link. `commands` is `true` if the session commands the controller. Waits until the deadline
/// for the first image of the controller.
///
/// # Errors
/// [`Error::Silent`] without an image.
#[doc(hidden)]
pub async fn open_session_link(link: ImageLink, commands: bool, until: Instant) -> Result<Images, Error> {
    let size = link.output_size();
    let has_commands = Image::has_commands(size);
    let rules = Rules {
        is_owner: commands,
        exclusive: if has_commands { 2 * COMMAND_WORDS } else { 0 },
        command: if has_commands { 2 } else { 0 },
        resting: resting().to_link(size),
        is_moving: |_, seen| {
            let seen = image(seen);
            Status::from_word(seen.0[0]) == Status::Running || output::PROGRAM_RUNNING.is_on(&seen)
        },
    };
    let mut images = Images::new(link, rules).map_err(|why| LinkError::Local(Cause::new(why)))?;
    if images.begin(until).await {
        return Ok(images);
    }
    // An error of the close is ignored: the missing image is the more useful error.
    let _ = SharedLink::Images(images).close().await;
    Err(Error::Silent)
}

fn image(bytes: &[u8]) -> Image {
    Image::from_link(bytes).unwrap_or_default()
}
