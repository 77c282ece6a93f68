//! PROFINET as a fieldbus of images: a connection in which armctl is the IO controller of a device.

use std::time::Duration;

use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;

use super::controller::view::{Details, Statistics, View, Views};
use super::error::ProfinetError;
use super::layout::Direction;
use super::network::{Connection, Network};
use super::settings::Settings;
use crate::image::cyclic::{Bus, Cyclic};
use crate::image::tap::Tap;
use crate::image::{Cause, Outputs, Sizes, Traffic};

/// A connection in which armctl is the IO controller of a device.
pub type Link = Cyclic<Device>;

/// The device of a [`Link`].
#[derive(Debug)]
pub struct Device {
    connection: Connection,
    settings: Settings,
}

impl Link {
    /// Connects over an interface. All connections of a process share the sockets of the interface.
    pub async fn open(interface: &str, settings: Settings, tap: Tap) -> Result<Self, ProfinetError> {
        let size = |direction| settings.layout.size(direction);
        let sizes = Sizes { output: size(Direction::Output), input: size(Direction::Input) };
        let connection = Network::shared(interface)?.open(settings.clone(), tap).await?;
        Ok(Self::over(Device { connection, settings }, sizes))
    }
}

impl Bus for Device {
    type Error = ProfinetError;
    type Statistics = Statistics;
    type Details = Details;

    fn views(&mut self) -> &mut Views {
        &mut self.connection.views
    }

    fn set_image(&mut self, generation: u32, image: &[u8]) -> Result<u64, ProfinetError> {
        self.connection.set_image(generation, image)
    }

    fn loss(&self, view: View) -> (Cause, Outputs) {
        let outputs = match view.last_error {
            // In these cases, the device has already stopped using the last image.
            Some(ProfinetError::Unusable(_) | ProfinetError::Aborted(_)) => Outputs::Released,
            _ => Outputs::ReleasedWithin(self.settings.watchdog_time()),
        };
        (Cause::of_loss(view.last_error), outputs)
    }

    fn watchdog(&self) -> Duration {
        self.settings.watchdog_time()
    }

    fn traffic(&self) -> Traffic {
        let counted = self.connection.statistics();
        let irregular = vec![
            (counted.stale, "late or duplicate"),
            (counted.skipped, "not sent in time"),
            (counted.alarms, "alarms"),
            (counted.losses, "losses"),
        ];
        let intervals = Some((self.settings.cycle, self.settings.cycle));
        Traffic { sent: counted.sent, received: counted.received, intervals, irregular }
    }

    fn close(self) -> LocalBoxFuture<'static, Result<(), ProfinetError>> {
        self.connection.close().boxed_local()
    }
}
