//! DeviceNet links with the options of a URL.

use std::time::Duration;

use crate::fieldbus::{ConnectionParameters, Purpose};
use armctl_controller::yrcx::image::Image;
use armctl_controller::yrcx::signal::resting;
use armctl_frame::settings::target::devicenet::DeviceNet;
use armctl_transport::devicenet::link::{Listened, Polled, Reading};
use armctl_transport::devicenet::network::{Adapter, Network};
use armctl_transport::devicenet::scanner::Identity;
use armctl_transport::devicenet::settings::{Images, Profile, Purpose as For, Settings};
use armctl_transport::image::{ImageLink, LinkError};

/// Time to wait for images of another master, whose polls can be slow.
const LISTEN: Duration = Duration::from_secs(1);
/// Silence after which armctl assumes that another master has stopped its polls.
const POLL_TIMEOUT: Duration = Duration::from_secs(2);
/// Minimum interval of reads by explicit messages.
const PAUSE: Duration = Duration::from_millis(100);
/// Vendor id of armctl. ODVA has not assigned a vendor id to armctl.
const UNREGISTERED_VENDOR: u16 = 0xFFFF;

/// Image sizes that can be set at the controller.
pub(super) fn profiles() -> Vec<Profile> {
    [("Normal", Image::BYTES), ("Compact", Image::SIGNAL_BYTES)]
        .map(|(name, size)| Profile { name, resting: resting().to_link(size) })
        .to_vec()
}

pub(super) async fn open(at: ConnectionParameters<'_>, purpose: Purpose) -> Result<ImageLink, LinkError> {
    let node: &DeviceNet = at.options()?;
    if purpose == Purpose::Look {
        return check_layers(&at, node).await;
    }
    let network = Network::open(&adapter(node), at.tap.clone()).await?;
    let images = Images { profiles: profiles(), cycle: node.cycle.max(at.bus.listen_before), rate: node.rate };
    let rate = images.rate.max(images.cycle);
    let settings =
        Settings { slave: node.mac, purpose: For::Images(Images { rate, ..images }), timeout: request_timeout(&at) };
    Ok(ImageLink::over(Polled::open(&network, settings).await?))
}

/// Opens a read-only link. If another master polls the node, the link listens to these polls. Otherwise, the link reads
/// with explicit messages, which start no polls.
async fn check_layers(at: &ConnectionParameters<'_>, node: &DeviceNet) -> Result<ImageLink, LinkError> {
    let silent = Network::open(&Adapter { identity: None, ..adapter(node) }, at.tap.clone()).await?;
    if let Some(listened) = Listened::open(silent.clone(), node.mac, LISTEN, POLL_TIMEOUT).await {
        return Ok(ImageLink::over(listened));
    }
    drop(silent);
    let network = Network::open(&adapter(node), at.tap.clone()).await?;
    let reading = Reading::open(&network, node.mac, request_timeout(at), PAUSE.max(at.bus.listen_before)).await;
    match reading {
        Ok(reading) => Ok(ImageLink::over(reading)),
        Err(error) => Err(match LinkError::from(error) {
            LinkError::Refused(cause) => LinkError::Refused(cause.advice(NO_POLLS_ADVICE)),
            error => error,
        }),
    }
}

const NO_POLLS_ADVICE: &str = "open a session with `armctl session open`, then read through that session: no master polls \
                         the controller, and the controller sends its signals only to its master";

/// Returns the adapter of the URL, with armctl as the master.
pub(super) fn adapter(node: &DeviceNet) -> Adapter {
    let serial = 0x4152_0000 | armctl_transport::session::process() & 0xFFFF;
    let identity = Identity { mac: node.master, vendor: UNREGISTERED_VENDOR, serial };
    Adapter { place: node.place.clone(), bitrate: node.bitrate, identity: Some(identity) }
}

/// Returns the timeout of a request: half of the robot's timeout, because a request fails only after two transmissions.
pub(super) fn request_timeout(at: &ConnectionParameters<'_>) -> Duration {
    (at.robot.timeout.value / 2).clamp(Duration::from_millis(100), Duration::from_secs(1))
}
