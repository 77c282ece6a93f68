//! DeviceNet links with the options of a URL.

use std::time::Duration;

use crate::command::yrcx::fieldbus::{At, Purpose};
use crate::controller::yrcx::image::Image;
use crate::controller::yrcx::signal::resting;
use crate::settings::target::devicenet::DeviceNet;
use crate::transport::devicenet::link::{Listened, Polled, Reading};
use crate::transport::devicenet::network::{Adapter, Network};
use crate::transport::devicenet::scanner::Identity;
use crate::transport::devicenet::settings::{Images, Profile, Purpose as For, Settings};
use crate::transport::image::{Cause, ImageLink, LinkError};

/// Time to wait for images of another master, whose polls can be slow.
const LISTEN: Duration = Duration::from_secs(1);
/// Silence after which the polls of another master have ended.
const PATIENCE: Duration = Duration::from_secs(2);
/// Minimum interval of reads with messages.
const PAUSE: Duration = Duration::from_millis(100);
/// Vendor id of this program. ODVA has not assigned one.
const UNREGISTERED_VENDOR: u16 = 0xFFFF;

/// Image sizes that a controller can be set to.
pub(super) fn profiles() -> Vec<Profile> {
    [("Normal", Image::BYTES), ("Compact", Image::SIGNAL_BYTES)]
        .map(|(name, size)| Profile { name, resting: resting().to_link(size) })
        .to_vec()
}

pub(super) async fn open(at: At<'_>, purpose: Purpose) -> Result<ImageLink, LinkError> {
    let node = options(&at)?;
    if purpose == Purpose::Look {
        return look(&at, node).await;
    }
    let network = Network::open(&adapter(node), at.tap.clone()).await?;
    let images = Images { profiles: profiles(), cycle: node.cycle.max(at.bus.listen_before), rate: node.rate };
    let rate = images.rate.max(images.cycle);
    let settings =
        Settings { slave: node.mac, purpose: For::Images(Images { rate, ..images }), timeout: request_timeout(&at) };
    Ok(ImageLink::over(Polled::open(&network, settings).await?))
}

/// Opens a link that only reads: it listens to the exchange with another master. Without one, it reads with messages,
/// which start no polls.
async fn look(at: &At<'_>, node: &DeviceNet) -> Result<ImageLink, LinkError> {
    let silent = Network::open(&Adapter { identity: None, ..adapter(node) }, at.tap.clone()).await?;
    if let Some(listened) = Listened::open(silent.clone(), node.mac, LISTEN, PATIENCE).await {
        return Ok(ImageLink::over(listened));
    }
    drop(silent);
    let network = Network::open(&adapter(node), at.tap.clone()).await?;
    let reading = Reading::open(&network, node.mac, request_timeout(at), PAUSE.max(at.bus.listen_before)).await;
    match reading {
        Ok(reading) => Ok(ImageLink::over(reading)),
        Err(error) => Err(match LinkError::from(error) {
            LinkError::Refused(cause) => LinkError::Refused(cause.advice(NOT_SHOWN)),
            error => error,
        }),
    }
}

const NOT_SHOWN: &str = "open a session with `armctl session open`, then read through that session: no master polls \
                         the controller, and the controller sends its signals only to its master";

/// The adapter, with this program as master.
pub(super) fn adapter(node: &DeviceNet) -> Adapter {
    let serial = 0x4152_0000 | crate::transport::session::process() & 0xFFFF;
    let identity = Identity { mac: node.master, vendor: UNREGISTERED_VENDOR, serial };
    Adapter { place: node.place.clone(), bitrate: node.bitrate, identity: Some(identity) }
}

pub(super) fn options<'a>(at: &At<'a>) -> Result<&'a DeviceNet, LinkError> {
    at.bus.options().ok_or_else(|| LinkError::Settings(Cause::new(format!("{:?} is not a URL of DeviceNet", at.bus))))
}

/// Half of the robot's timeout, because a request is sent twice before it fails.
pub(super) fn request_timeout(at: &At<'_>) -> Duration {
    (at.robot.timeout.value / 2).clamp(Duration::from_millis(100), Duration::from_secs(1))
}
