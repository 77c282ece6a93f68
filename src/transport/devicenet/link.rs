//! The seam for fieldbuses over DeviceNet: polls, what passes between a slave and another master, or what a slave answers
//! to messages.

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
use crate::image::{Cause, Event, ImageConnection, Known, LinkError, Outputs, Sizes, Traffic};

/// Packet rates after which a slave lets go of its outputs.
const WATCHDOG: u32 = 4;

/// A slave that is polled.
pub type Polled = Cyclic<Connection>;

impl Polled {
    /// Opens it.
    ///
    /// # Errors
    /// When the slave does not answer, refuses, or has images of other sizes.
    pub async fn open(network: &Network, settings: Settings) -> Result<Self, Error> {
        let connection = network.connect(settings).await?;
        let size = connection.view().details.size;
        let size = size.ok_or_else(|| Error::Settings("the connection is for messages".to_owned()))?;
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
        let outputs = Outputs::ReleasedWithin(view.details.rate.unwrap_or_default() * WATCHDOG);
        let error = view.trouble.unwrap_or(Error::Outdated);
        (Cause { advice: advice(&error), ..Cause::new(error) }, outputs)
    }

    fn traffic(&self) -> Traffic {
        let view = self.view();
        let counted = view.statistics;
        let (health, _) = self.network().health();
        let odd = vec![
            (counted.missed, "not answered in time"),
            (counted.wrong, "spoilt"),
            (counted.late, "late"),
            (counted.skipped, "not sent in time"),
            (health.overruns, "lost in the adapter"),
            (health.rejected, "not taken by the adapter"),
        ];
        let intervals = view.details.rate.map(|rate| (rate, rate));
        Traffic { sent: counted.sent, received: counted.received, intervals, odd }
    }

    fn close(self) -> LocalBoxFuture<'static, Result<(), Error>> {
        Self::close(self).boxed_local()
    }
}

/// What another master and a slave show each other, without a bit sent from here.
#[derive(Debug)]
pub struct Listened {
    network: Network,
    slave: Mac,
    size: usize,
    /// Silence after which what was seen counts no more.
    patience: Duration,
    seen: u64,
}

impl Listened {
    /// Listens for at most `longest`; `None` if nothing passes.
    pub async fn open(network: Network, slave: Mac, longest: Duration, patience: Duration) -> Option<Self> {
        let input = network.listen(slave, longest).await.input?;
        Some(Self { network, slave, size: input.image.len(), patience, seen: 0 })
    }

    async fn wait(&mut self, known: Known<'_>) -> Event {
        loop {
            let input = self.network.sight(self.slave).input.filter(|input| input.image.len() == self.size);
            let left = input.as_ref().map(|input| (input.at + self.patience).saturating_sub(self.network.now()));
            match (input, left) {
                (Some(input), Some(left)) if !left.is_zero() => {
                    if !known.is_up {
                        return Event::Reopened;
                    }
                    if known.is_news(&input.image) {
                        return Event::Image(input.image.into());
                    }
                    tokio::select! {
                        () = self.network.changed(&mut self.seen) => {}
                        () = sleep_until(Instant::now() + left) => {}
                    }
                }
                _ if known.is_up => {
                    let mac = self.slave;
                    let text = self.network.trouble().map_or_else(
                        || {
                            format!(
                                "no answer of MAC {mac} to its master was heard for {} ms",
                                self.patience.as_millis()
                            )
                        },
                        |trouble| trouble.to_string(),
                    );
                    return Event::Lost(LinkError::Lost { cause: Cause::new(text), outputs: Outputs::Never });
                }
                _ => self.network.changed(&mut self.seen).await,
            }
        }
    }
}

impl ImageConnection for Listened {
    fn sizes(&self) -> Sizes {
        Sizes { output: 0, input: self.size }
    }

    fn next<'a>(&'a mut self, known: Known<'a>) -> LocalBoxFuture<'a, Event> {
        self.wait(known).boxed_local()
    }
}

/// What a slave shows, by messages with a pause between them: no poll begins, so none is missed when it ends.
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
    /// Reads it for the first time.
    ///
    /// # Errors
    /// When the slave does not answer, or cannot be read.
    pub async fn open(network: &Network, slave: Mac, timeout: Duration, pause: Duration) -> Result<Self, Error> {
        let purpose = Purpose::Messages { with_poll: true };
        let connection = network.connect(Settings { slave, purpose, timeout }).await?;
        let request = produced(&connection, slave).await?;
        let image = read(&connection, slave, &request).await?.into();
        Ok(Self { connection, slave, request, image, pause, due: Instant::now() + pause })
    }

    /// What it showed last.
    pub fn image(&self) -> &[u8] {
        &self.image
    }

    async fn wait(&mut self, known: Known<'_>) -> Event {
        loop {
            let view = self.connection.view();
            if known.is_up && view.state != State::Open {
                let error = view.trouble.unwrap_or(Error::Outdated);
                return Event::Lost(LinkError::Lost { cause: Cause::new(error), outputs: Outputs::Never });
            }
            if !known.is_up {
                if view.state == State::Open {
                    return Event::Reopened;
                }
                self.connection.views.changed().await;
                continue;
            }
            if known.is_news(&self.image) {
                return Event::Image(Arc::clone(&self.image));
            }
            sleep_until(self.due).await;
            // An answer that is not waited for to its end is asked for anew.
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

    fn next<'a>(&'a mut self, known: Known<'a>) -> LocalBoxFuture<'a, Event> {
        self.wait(known).boxed_local()
    }

    fn close(self: Box<Self>) -> LocalBoxFuture<'static, Result<(), LinkError>> {
        async move { self.connection.close().await.map_err(LinkError::from) }.boxed_local()
    }
}

const IMAGE: &str = "what it shows";
/// The path of what a poll connection sends: attribute 14 of it.
const PRODUCED_PATH: u8 = 14;

/// What reads the image that the slave would answer polls with, as its poll connection says.
///
/// # Errors
/// When it does not say.
pub async fn produced(connection: &Connection, mac: Mac) -> Result<Request, Error> {
    let instance = u16::from(connection::POLL_INSTANCE);
    let path = read(connection, mac, &Request::get(class::CONNECTION, instance, PRODUCED_PATH)).await?;
    match path.as_slice() {
        // Class, instance and attribute in a byte each.
        [0x20, class, 0x24, instance, 0x30, attribute] => Ok(Request::get(*class, (*instance).into(), *attribute)),
        [0x20, class, 0x24, instance] => Ok(Request::get(*class, (*instance).into(), 3)),
        _ => Err(Error::Senseless { mac, what: IMAGE, why: "the path to it is not one of an attribute" }),
    }
}

/// Reads an attribute.
///
/// # Errors
/// When it is refused, or nothing comes.
pub async fn read(connection: &Connection, mac: Mac, request: &Request) -> Result<Vec<u8>, Error> {
    match connection.ask(request.clone()).await? {
        Answer::Done { data, .. } => Ok(data),
        Answer::Refused { general, additional } => Err(Error::Refused { what: IMAGE, mac, general, additional }),
    }
}

/// What to do about an error, where that is more than its kind tells.
fn advice(error: &Error) -> Option<std::borrow::Cow<'static, str>> {
    Some(match error {
        Error::Duplicate { .. } => {
            "close the session that has it (`armctl session list`), or choose another number for this master: master= of the \
             URL (0 to 63)"
                .into()
        }
        Error::Owned { .. } => {
            "stop the other master's scan of this node, or look beside it: `yrcx status` and `yrcx io get` \
             listen to what passes"
                .into()
        }
        Error::Size { .. } => {
            "set the I/O size of the controller's unit to Normal (48 bytes) or Compact (4); check mac of the \
             URL: `yrcx devicenet scan` lists the nodes"
                .into()
        }
        Error::Silent { is_bus_alive: true, .. } => {
            "check mac of the URL: `yrcx devicenet scan` lists the nodes that answer".into()
        }
        Error::Silent { .. } | Error::Lost { .. } => {
            "check the bit rate, the 24 V of the bus, its plugs and both terminators \
             (121 ohm), and that the controller is on"
                .into()
        }
        Error::BusOff => "check the bit rate and the wiring (CAN_H and CAN_L, both terminators)".into(),
        Error::Port(PortError::Open { advice, .. }) => advice.clone(),
        Error::Port(PortError::Setup { .. } | PortError::Mute { .. } | PortError::Flooded { .. }) => {
            "check that it is an SLCAN (Lawicel) adapter, and baud of the URL".into()
        }
        Error::Port(PortError::Gone { .. }) => "plug the adapter in again".into(),
        Error::Port(PortError::Stuck { .. }) => "poll more slowly (cycle of the URL), or check the bus".into(),
        Error::Refused { .. } | Error::Senseless { .. } => {
            "check mac of the URL: `yrcx devicenet identity` tells who it is".into()
        }
        Error::Settings(_) | Error::Outdated | Error::Ended => return None,
    })
}

impl From<Error> for LinkError {
    fn from(error: Error) -> Self {
        let code = match &error {
            Error::Refused { general, .. } => Some(format!("{general:#04x}")),
            _ => None,
        };
        let cause = Cause { code, advice: advice(&error), ..Cause::new(&error) };
        match error {
            Error::Owned { .. } => Self::Owned(cause),
            Error::Size { .. } => Self::Size(cause),
            Error::Refused { .. } => Self::Refused(cause),
            Error::Silent { .. } | Error::Lost { .. } | Error::BusOff => Self::Silent(cause),
            Error::Port(PortError::Open { .. } | PortError::Mute { .. } | PortError::Gone { .. }) => {
                Self::Silent(cause)
            }
            Error::Senseless { .. } | Error::Port(PortError::Setup { .. } | PortError::Flooded { .. }) => {
                Self::Malformed(cause)
            }
            Error::Settings(_) => Self::Settings(cause),
            Error::Duplicate { .. } | Error::Port(_) | Error::Outdated | Error::Ended => Self::Local(cause),
        }
    }
}
