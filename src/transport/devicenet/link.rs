//! DeviceNet as a fieldbus of images. There are three kinds of connection: a polled slave, the observed traffic between
//! another master and a slave, and a slave that is read with explicit messages.

use std::sync::Arc;
use std::time::Duration;

use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;
use tokio::time::{Instant, sleep_until};

use super::can::PortError;
use super::error::Error;
use super::network::{Connection, Network};
use super::scanner::{Details, State, Statistics, View, Views};
use super::settings::{Purpose, Settings};
use super::wire::{Answer, Mac, Request, class, connection};
use crate::image::cyclic::{Bus, Cyclic};
use crate::image::{Cause, Event, ImageConnection, LinkError, Outputs, ReportedState, Sizes, Traffic};

/// After this multiple of the packet rate without a poll, a slave clears its outputs.
const WATCHDOG: u32 = 4;

/// A polled slave.
pub type Polled = Cyclic<Connection>;

impl Polled {
    /// Opens the connection.
    ///
    /// # Errors
    /// The slave does not answer, refuses, or does not have the expected image sizes.
    pub async fn open(network: &Network, settings: Settings) -> Result<Self, Error> {
        let connection = network.connect(settings).await?;
        let size = connection.views.now().details.size;
        let size = size.ok_or_else(|| Error::Settings("the connection carries only messages, no images".to_owned()))?;
        Ok(Self::over(connection, Sizes { output: size, input: size }))
    }
}

impl Bus for Connection {
    type Error = Error;
    type Statistics = Statistics;
    type Details = Details;

    fn views(&mut self) -> &mut Views {
        &mut self.views
    }

    fn set_image(&mut self, generation: u32, image: &[u8]) -> Result<u64, Error> {
        Self::set_image(self, generation, image)
    }

    fn loss(&self, view: View) -> (Cause, Outputs) {
        let outputs = Outputs::ReleasedWithin(self.watchdog());
        let error = view.last_error.unwrap_or(Error::Outdated);
        (Cause { advice: advice(&error), ..Cause::new(error) }, outputs)
    }

    fn watchdog(&self) -> Duration {
        self.views.now().details.rate.unwrap_or_default() * WATCHDOG
    }

    fn traffic(&self) -> Traffic {
        let view = self.views.now();
        let counted = view.statistics;
        let (health, _) = self.network().health();
        let irregular = vec![
            (counted.missed, "not answered in time"),
            (counted.wrong, "spoilt"),
            (counted.late, "late"),
            (counted.skipped, "not sent in time"),
            (health.overruns, "lost in the adapter"),
            (health.rejected, "refused by the adapter"),
        ];
        let intervals = view.details.rate.map(|rate| (rate, rate));
        Traffic { sent: counted.sent, received: counted.received, intervals, irregular }
    }

    fn close(self) -> LocalBoxFuture<'static, Result<(), Error>> {
        Self::close(self).boxed_local()
    }
}

/// Images that another master and a slave exchange. This node only listens: it sends nothing, not even
/// acknowledgements.
#[derive(Debug)]
pub struct Listened {
    network: Network,
    slave: Mac,
    size: usize,
    /// Time without an image after which the last images are out of date.
    patience: Duration,
    received_generation: u64,
}

impl Listened {
    /// Listens for at most `longest`. Returns `None` if no image of the slave was received.
    pub async fn open(network: Network, slave: Mac, longest: Duration, patience: Duration) -> Option<Self> {
        let input = network.listen(slave, longest).await.input?;
        Some(Self { network, slave, size: input.image.len(), patience, received_generation: 0 })
    }

    async fn wait(&mut self, reported: ReportedState<'_>) -> Event {
        loop {
            let input = self.network.last_traffic(self.slave).input.filter(|input| input.image.len() == self.size);
            let left = input.as_ref().map(|input| (input.at + self.patience).saturating_sub(self.network.now()));
            match (input, left) {
                (Some(input), Some(left)) if !left.is_zero() => {
                    if !reported.is_up {
                        return Event::Reopened;
                    }
                    if reported.is_new(&input.image) {
                        return Event::Image(input.image.into());
                    }
                    tokio::select! {
                        () = self.network.changed(&mut self.received_generation) => {}
                        () = sleep_until(Instant::now() + left) => {}
                    }
                }
                _ if reported.is_up => {
                    let mac = self.slave;
                    let text = self.network.last_error().map_or_else(
                        || format!("no answer from MAC {mac} to its master for {} ms", self.patience.as_millis()),
                        |last_error| last_error.to_string(),
                    );
                    return Event::Lost(LinkError::Lost { cause: Cause::new(text), outputs: Outputs::Never });
                }
                _ => self.network.changed(&mut self.received_generation).await,
            }
        }
    }
}

impl ImageConnection for Listened {
    fn sizes(&self) -> Sizes {
        Sizes { output: 0, input: self.size }
    }

    fn next<'a>(&'a mut self, reported: ReportedState<'a>) -> LocalBoxFuture<'a, Event> {
        self.wait(reported).boxed_local()
    }
}

/// Image of a slave, read with explicit messages at an interval. This reader does not establish the poll connection.
/// Therefore the end of the reader cannot stop a robot.
#[derive(Debug)]
pub struct Reading {
    connection: Connection,
    slave: Mac,
    request: Request,
    image: Arc<[u8]>,
    pause: Duration,
    due: Instant,
}

impl Reading {
    /// Connects and reads the image for the first time.
    pub async fn open(network: &Network, slave: Mac, timeout: Duration, pause: Duration) -> Result<Self, Error> {
        let purpose = Purpose::Messages { with_poll: true };
        let connection = network.connect(Settings { slave, purpose, timeout }).await?;
        let request = produced_size(&connection, slave).await?;
        let image = read(&connection, slave, &request).await?.into();
        Ok(Self { connection, slave, request, image, pause, due: Instant::now() + pause })
    }

    /// The last image.
    pub fn image(&self) -> &[u8] {
        &self.image
    }

    async fn wait(&mut self, reported: ReportedState<'_>) -> Event {
        loop {
            let view = self.connection.views.now();
            if reported.is_up && view.state != State::Open {
                let error = view.last_error.unwrap_or(Error::Outdated);
                return Event::Lost(LinkError::Lost { cause: Cause::new(error), outputs: Outputs::Never });
            }
            if !reported.is_up {
                if view.state == State::Open {
                    return Event::Reopened;
                }
                self.connection.views.changed().await;
                continue;
            }
            if reported.is_new(&self.image) {
                return Event::Image(Arc::clone(&self.image));
            }
            sleep_until(self.due).await;
            // If this future is dropped before the answer arrives, the next call sends the request again.
            match read(&self.connection, self.slave, &self.request).await {
                Ok(image) if *image != *self.image => self.image = image.into(),
                Ok(_) => {}
                Err(error) => {
                    return Event::Lost(LinkError::Lost { cause: Cause::new(error), outputs: Outputs::Never });
                }
            }
            self.due = Instant::now() + self.pause;
        }
    }
}

impl ImageConnection for Reading {
    fn sizes(&self) -> Sizes {
        Sizes { output: 0, input: self.image.len() }
    }

    fn next<'a>(&'a mut self, reported: ReportedState<'a>) -> LocalBoxFuture<'a, Event> {
        self.wait(reported).boxed_local()
    }

    fn close(self: Box<Self>) -> LocalBoxFuture<'static, Result<(), LinkError>> {
        async move { self.connection.close().await.map_err(LinkError::from) }.boxed_local()
    }
}

const IMAGE: &str = "the read of its signals";
/// Attribute 14 of a connection object: path of the produced data.
const PRODUCED_PATH: u8 = 14;

/// Returns the request that reads the image that the slave produces. The poll connection object of the slave contains
/// the path of this image.
pub async fn produced_size(connection: &Connection, mac: Mac) -> Result<Request, Error> {
    let instance = u16::from(connection::POLL_INSTANCE);
    let path = read(connection, mac, &Request::get(class::CONNECTION, instance, PRODUCED_PATH)).await?;
    match path.as_slice() {
        // The path consists of a class, an instance and an attribute. Each of them has one byte.
        [0x20, class, 0x24, instance, 0x30, attribute] => Ok(Request::get(*class, (*instance).into(), *attribute)),
        [0x20, class, 0x24, instance] => Ok(Request::get(*class, (*instance).into(), 3)),
        _ => Err(Error::Senseless { mac, what: IMAGE, why: "the path does not lead to an attribute" }),
    }
}

/// Reads an attribute.
pub async fn read(connection: &Connection, mac: Mac, request: &Request) -> Result<Vec<u8>, Error> {
    match connection.ask(request.clone()).await? {
        Answer::Done { data, .. } => Ok(data),
        Answer::Refused { general, additional } => Err(Error::Refused { what: IMAGE, mac, general, additional }),
    }
}

/// Returns the advice for an error. `None` if the general advice for its kind is enough.
fn advice(error: &Error) -> Option<std::borrow::Cow<'static, str>> {
    let advice = match error {
        Error::Duplicate { .. } => {
            "close the session that uses it (`armctl session list`), or set another number for this master with \
             `master=` in the URL (0 to 63)"
        }
        Error::Owned(_) => {
            "remove this node from the scan list of the other master, or only read: `yrcx status` and `yrcx io get` \
             listen to its traffic"
        }
        Error::Size { .. } => {
            "set the I/O size of the controller's unit to Normal (48 bytes) or Compact (4); check `mac=` in the URL: \
             `yrcx devicenet scan` lists the nodes"
        }
        Error::Silent { is_bus_alive: true, .. } => {
            "check `mac=` in the URL: `yrcx devicenet scan` lists the nodes that answer"
        }
        Error::Silent { .. } | Error::Lost { .. } => {
            "check the bit rate, the 24 V of the bus, its plugs and both terminators (121 ohm); check that the \
             controller is on"
        }
        Error::BusOff => "check the bit rate and the wiring (CAN_H and CAN_L, both terminators)",
        Error::Port(PortError::Open { advice, .. }) => return Some(advice.clone()),
        Error::Port(PortError::Setup { .. } | PortError::Mute(_) | PortError::Flooded(_)) => {
            "check that it is an SLCAN (Lawicel) adapter; check `baud=` in the URL"
        }
        Error::Port(PortError::Gone { .. }) => "plug the adapter in again",
        Error::Port(PortError::Stuck(_)) => "set a longer `cycle=` in the URL, or check the bus",
        Error::Refused { .. } | Error::Senseless { .. } => {
            "check `mac=` in the URL: `yrcx devicenet identity` shows the device"
        }
        Error::Settings(_) | Error::Outdated | Error::Ended => return None,
    };
    Some(advice.into())
}

impl From<Error> for LinkError {
    fn from(error: Error) -> Self {
        let code = match &error {
            Error::Refused { general, .. } => Some(format!("{general:#04x}")),
            _ => None,
        };
        let cause = Cause { code, advice: advice(&error), ..Cause::new(&error) };
        match error {
            Error::Owned(_) => Self::Owned(cause),
            Error::Size { .. } => Self::Size(cause),
            Error::Refused { .. } => Self::Refused(cause),
            Error::Silent { .. }
            | Error::Lost { .. }
            | Error::BusOff
            | Error::Port(PortError::Open { .. } | PortError::Mute(_) | PortError::Gone { .. }) => Self::Silent(cause),
            Error::Senseless { .. } | Error::Port(PortError::Setup { .. } | PortError::Flooded(_)) => {
                Self::Malformed(cause)
            }
            Error::Settings(_) => Self::Settings(cause),
            Error::Duplicate { .. } | Error::Port(_) | Error::Outdated | Error::Ended => Self::Local(cause),
        }
    }
}
