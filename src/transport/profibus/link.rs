//! PROFIBUS as a fieldbus of images. There are two kinds of link: one controls the slave, and the other only receives
//! the data exchange between a PLC and the slave.

use std::sync::Arc;
use std::time::Duration;

use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;

use super::driver::{Connection, Opener};
use super::error::ProfibusError;
use super::listener_driver::ListenerDriver;
use super::master::{Details, Statistics, View, Views};
use super::settings::Settings;
use crate::image::cyclic::{Bus, Cyclic};
use crate::image::tap::{Tap, TrafficRecord};
use crate::image::{Cause, Event, ImageConnection, LinkError, Outputs, ReportedState, Sizes, Traffic};

/// Byte order of an image. Some boards send the two bytes of a word in exchanged order, in a part of the image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ByteSwap {
    /// Number of bytes at the start of the image whose pairs are exchanged.
    pub bytes: usize,
}

impl ByteSwap {
    fn turn(self, image: &mut [u8]) {
        let (pairs, _) = image.split_at_mut(self.bytes.min(image.len()));
        for pair in pairs.chunks_exact_mut(2) {
            pair.swap(0, 1);
        }
    }

    fn native_order(self, image: &[u8]) -> Vec<u8> {
        let mut image = image.to_vec();
        self.turn(&mut image);
        image
    }
}

/// A link that controls the slave.
pub type Master = Cyclic<Slave>;

/// The slave of a [`Master`].
#[derive(Debug)]
pub struct Slave {
    connection: Connection,
    byte_swap: ByteSwap,
}

impl Master {
    /// Opens the port and the link. The resting image in the settings has the byte order of the controller.
    pub async fn open(
        mut settings: Settings,
        byte_swap: ByteSwap,
        opener: Opener,
        tap: Tap,
    ) -> Result<Self, ProfibusError> {
        byte_swap.turn(&mut settings.resting);
        let sizes = Sizes { output: settings.output_size, input: settings.input_size };
        let connection = Connection::open(settings, opener, record(tap)).await?;
        Ok(Self::over(Slave { connection, byte_swap }, sizes))
    }
}

impl Bus for Slave {
    type Error = ProfibusError;
    type Statistics = Statistics;
    type Details = Details;

    fn views(&mut self) -> &mut Views {
        &mut self.connection.views
    }

    fn set_image(&mut self, generation: u32, image: &[u8]) -> Result<u64, ProfibusError> {
        self.connection.set_image(generation, &self.byte_swap.native_order(image))
    }

    fn native_order(&self, image: Arc<[u8]>) -> Arc<[u8]> {
        self.byte_swap.native_order(&image).into()
    }

    fn loss(&self, view: View) -> (Cause, Outputs) {
        let error = view.last_error.unwrap_or(ProfibusError::Outdated);
        let outputs = match error {
            ProfibusError::Left { .. } => Outputs::Released,
            _ => Outputs::ReleasedWithin(view.details.watchdog),
        };
        (LinkError::from(error).cause().clone(), outputs)
    }

    fn watchdog(&self) -> Duration {
        self.connection.view().details.watchdog
    }

    fn traffic(&self) -> Traffic {
        let view = self.connection.view();
        let counters = view.statistics;
        let irregular = vec![
            (counters.repeated, "repeated"),
            (counters.noise, "bytes of noise"),
            (counters.unexpected, "unexpected"),
            (counters.skipped, "not sent in time"),
        ];
        let intervals = Some((view.details.cycle, view.details.cycle));
        Traffic { sent: counters.sent, received: counters.received, intervals, irregular }
    }

    fn close(self) -> LocalBoxFuture<'static, Result<(), ProfibusError>> {
        self.connection.close().boxed_local()
    }
}

/// Images that a slave exchanges with another master. This link only receives, and sends nothing.
#[derive(Debug)]
pub struct Listening {
    hearing: ListenerDriver,
    byte_swap: ByteSwap,
    size: usize,
    silence: Duration,
}

impl Listening {
    /// Waits for the first data exchange of this slave, at most for `silence`.
    pub async fn open(
        station: u8,
        size: usize,
        byte_swap: ByteSwap,
        opener: Opener,
        tap: Tap,
        silence: Duration,
    ) -> Result<Self, ProfibusError> {
        let mut hearing = ListenerDriver::start(station, opener, record(tap))?;
        let heard = hearing.until(silence, |heard| heard.input.is_some()).await?;
        let found = heard.input.map_or(0, |input| input.len());
        if found < size {
            return Err(ProfibusError::Length { station, found, expected: size });
        }
        Ok(Self { hearing, byte_swap, size, silence })
    }

    async fn wait(&mut self, reported: ReportedState<'_>) -> Event {
        loop {
            let before = self.hearing.last.exchanges;
            if let Some(input) = self.hearing.last.input.clone().filter(|_| reported.is_up) {
                let image: Arc<[u8]> = self.byte_swap.native_order(&input).into();
                if reported.is_new(&image) {
                    return Event::Image(image);
                }
            }
            match self.hearing.until(self.silence, |heard| heard.exchanges != before).await {
                Ok(_) if !reported.is_up => return Event::Reopened,
                Err(error) if reported.is_up => {
                    let cause = LinkError::from(error).cause().clone();
                    return Event::Lost(LinkError::Lost { cause, outputs: Outputs::Never });
                }
                // Without a port, no more data can arrive, so this wait never ends.
                Err(ProfibusError::Gone(_)) => std::future::pending().await,
                Ok(_) | Err(_) => {}
            }
        }
    }
}

impl ImageConnection for Listening {
    fn sizes(&self) -> Sizes {
        Sizes { output: 0, input: self.size }
    }

    fn next<'a>(&'a mut self, reported: ReportedState<'a>) -> LocalBoxFuture<'a, Event> {
        self.wait(reported).boxed_local()
    }
}

/// Converts a fieldbus tap to a tap for telegrams.
pub fn record(tap: Tap) -> Option<super::driver::Tap> {
    let record = move |bytes: &[u8]| tap.pass(|| TrafficRecord::Frame(bytes.to_vec()));
    Some(Box::new(record) as super::driver::Tap)
}

impl From<ProfibusError> for LinkError {
    fn from(error: ProfibusError) -> Self {
        use ProfibusError as E;
        let cause = Cause::new(&error);
        match error {
            E::Settings(_) => Self::Settings(cause),
            E::Port { .. } => Self::Silent(cause.advice(
                "check the name of the port (`armctl robots discover` lists the ports); check that the adapter \
                 supports the settings; close every session and program that uses the port",
            )),
            E::Gone(_) => {
                Self::Silent(cause.advice("check the plug and the power supply of the adapter"))
            }
            E::OtherMaster { .. } => Self::Owned(cause.advice(
                "disconnect the other master, because armctl must be the only master; or add `role=listen` to the URL \
                 to only read",
            )),
            E::Unreadable(_) => Self::Owned(cause.advice(
                "set `baud=` in the URL to the bit rate of the bus; check for another master, missing terminators, and \
                 crossed A and B wires",
            )),
            E::NoAnswer { .. } => Self::Silent(cause.advice(
                "check `station=` and `baud=` in the URL, the A and B wires, and both terminators with their supply; check \
                 that the controller is on. With a slow adapter, set `slot=50ms`",
            )),
            E::IsMaster(_) => {
                Self::Malformed(cause.advice("check `station=` in the URL; `yrcx profibus scan` lists the stations"))
            }
            E::Refused { .. } => Self::Refused(
                cause
                    .options(&["station", "cfg", "prm"])
                    .advice("the slave does not support this request; for Get_Cfg, set `cfg=` or `gsd=` in the URL"),
            ),
            E::Malformed { .. } => {
                Self::Malformed(cause.advice("check that this is the address of a PROFIBUS slave"))
            }
            E::Ident { found, .. } => Self::Refused(
                cause.advice(format!("if this is the controller, set `ident={found:#06x}` in the URL, or remove `ident=`")),
            ),
            E::Size { .. } | E::Length { .. } => {
                Self::Size(cause.options(&["station", "cfg"]).advice(
                    "the image must have 48 bytes each way: check `station=` and `cfg=` in the URL, and the unit of the \
                     controller",
                ))
            }
            E::ParameterFault { .. } => Self::Refused(
                cause
                    .options(&["prm", "gsd"])
                    .advice("set `prm=` in the URL to the bytes in the GSD file of the unit, or `gsd=` to the file"),
            ),
            E::ConfigurationFault { .. } => Self::Refused(
                cause
                    .options(&["cfg", "gsd"])
                    .advice("remove `cfg=` to use the configuration of the slave, or set `gsd=` to the file of the unit"),
            ),
            E::Locked { .. } => Self::Owned(cause.advice(
                "disconnect that master, or close the session of the controller; with `role=listen` in the URL, armctl \
                 only reads",
            )),
            E::NotReady { .. } | E::Left { .. } => Self::Silent(cause.advice(
                "check the lamps of the unit and the display of the controller; `yrcx profibus probe` shows the \
                 diagnosis",
            )),
            E::NotHeard { .. } => Self::Silent(cause.advice(
                "open a session, which takes control (`armctl session open`), or listen on the bus of the PLC (set \
                 `station=` and `baud=` to the values of that bus). A controller sends its images only to its master",
            )),
            E::Outdated | E::Ended => Self::Local(cause),
        }
    }
}
