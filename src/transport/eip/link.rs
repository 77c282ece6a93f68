//! EtherNet/IP as a fieldbus of images. There are two kinds of connection: a class 1 connection, and an assembly that
//! is read with messages.

use std::net::{SocketAddr, SocketAddrV4};
use std::sync::Arc;
use std::time::Duration;

use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;

use super::client::Client;
use super::error::EipError;
use super::image_reader::{Assembly, Reader};
use super::originator::{Details, Statistics, View, Views};
use super::scanner::{Connection, Scanner};
use super::settings::{Role, Settings};
use super::tap::Tap;
use crate::image::cyclic::{Bus, Cyclic};
use crate::image::{Cause, Event, ImageConnection, LinkError, Outputs, ReportedState, Sizes, Traffic};

/// A class 1 connection.
pub type Class1 = Cyclic<Device>;

/// The device of a class 1 connection.
#[derive(Debug)]
pub struct Device {
    connection: Connection,
    /// What the device does with its outputs after a loss of the connection.
    outputs: Outputs,
    watchdog: Duration,
}

impl Class1 {
    /// Connects to the first IPv4 address of the host. All connections of a process share one UDP socket.
    pub async fn open(host: &str, port: u16, settings: Settings, tap: Tap) -> Result<Self, EipError> {
        let target = resolve(host, port).await?;
        let sizes = Sizes { output: settings.output_size.into(), input: settings.input_size.into() };
        let watchdog = settings.rpi.saturating_mul(settings.multiplier.intervals());
        let outputs = match settings.role {
            Role::ExclusiveOwner => Outputs::ReleasedWithin(watchdog),
            Role::InputOnly | Role::ListenOnly => Outputs::Never,
        };
        let connection = Scanner::shared()?.open(target, settings, tap).await?;
        Ok(Self::over(Device { connection, outputs, watchdog }, sizes))
    }
}

impl Bus for Device {
    type Error = EipError;
    type Statistics = Statistics;
    type Details = Details;

    fn views(&mut self) -> &mut Views {
        &mut self.connection.views
    }

    fn set_image(&mut self, generation: u32, image: &[u8]) -> Result<u64, EipError> {
        let change = self.connection.set_image(generation, image)?;
        // The device starts in idle mode after every opening. The first image then also sets the run bit.
        let runs = self.connection.views.now().details.run;
        if runs { Ok(change) } else { self.connection.set_run(generation, true) }
    }

    fn loss(&self, view: View) -> (Cause, Outputs) {
        (Cause::of_loss(view.last_error), self.outputs)
    }

    fn watchdog(&self) -> Duration {
        self.watchdog
    }

    fn traffic(&self) -> Traffic {
        let view = self.connection.views.now();
        let counted = view.statistics;
        let irregular = vec![
            (counted.lost, "lost"),
            (counted.late, "late"),
            (counted.stale, "stale"),
            (counted.size_error, "with a wrong size"),
            (counted.skipped, "not sent in time"),
        ];
        Traffic { sent: counted.sent, received: counted.received, intervals: view.details.intervals, irregular }
    }

    fn close(self) -> LocalBoxFuture<'static, Result<(), EipError>> {
        self.connection.close().boxed_local()
    }
}

/// An assembly that is read with messages at an interval. It has no outputs.
#[derive(Debug)]
pub struct Reading {
    reader: Reader,
    size: usize,
}

impl Reading {
    /// Reads the assembly for the first time.
    pub async fn open(client: Client, assembly: Assembly, pause: Duration) -> Result<Self, EipError> {
        let reader = Reader::open(client, assembly, pause).await?;
        Ok(Self { reader, size: assembly.size.into() })
    }

    async fn wait(&mut self, reported: ReportedState<'_>) -> Event {
        loop {
            match self.reader.reading() {
                Ok(_) if !reported.is_up => return Event::Reopened,
                Ok(image) if reported.is_new(&image) => return Event::Image(Arc::clone(&image)),
                Err(error) if reported.is_up => {
                    return Event::Lost(LinkError::Lost { cause: Cause::new(error), outputs: Outputs::Never });
                }
                Ok(_) | Err(_) => {}
            }
            self.reader.changed().await;
        }
    }
}

impl ImageConnection for Reading {
    fn sizes(&self) -> Sizes {
        Sizes { output: 0, input: self.size }
    }

    fn next<'a>(&'a mut self, reported: ReportedState<'a>) -> LocalBoxFuture<'a, Event> {
        self.wait(reported).boxed_local()
    }

    fn close(self: Box<Self>) -> LocalBoxFuture<'static, Result<(), LinkError>> {
        async move {
            self.reader.close().await;
            Ok(())
        }
        .boxed_local()
    }
}

/// First IPv4 address of a host.
pub async fn resolve(host: &str, port: u16) -> Result<SocketAddrV4, EipError> {
    let found = tokio::net::lookup_host((host, port)).await;
    let mut addresses = found.map_err(|_| EipError::NotFound(host.to_owned()))?;
    let first = addresses.find_map(|address| match address {
        SocketAddr::V4(address) => Some(address),
        SocketAddr::V6(_) => None,
    });
    first.ok_or_else(|| EipError::NotIpv4(host.to_owned()))
}

/// Extended status that means: another originator owns the outputs.
const OWNED: u32 = 0x0106;
/// URL options that can cause a refusal of the connection.
const CONNECTION: &[&str] = &["in", "out", "config", "in_size", "out_size"];

impl From<EipError> for LinkError {
    fn from(error: EipError) -> Self {
        use EipError as E;
        let reported = error.code();
        let cause = Cause { code: reported.map(|code| format!("{:#06x}", code.code)), ..Cause::new(&error) };
        match error {
            E::NotFound(_) => Self::Silent(cause.advice("check the name, or use the address of the controller")),
            E::NotIpv4(_) => Self::Settings(cause.advice("use the IPv4 address of the controller")),
            E::Unreachable { .. } | E::NoAnswer { .. } | E::Hangup(_) | E::Silent(_) => Self::Silent(cause.advice(
                "check the address; check that the controller is on, and that its EtherNet/IP board is enabled",
            )),
            E::Encapsulation { .. } | E::Refused { .. } => match reported {
                Some(code) if code.code == OWNED => Self::Owned(cause),
                Some(code) => Self::Refused(cause.advice(with_advice(code.remedy))),
                None => Self::Refused(cause.options(CONNECTION)),
            },
            E::Malformed { .. } | E::Senseless { .. } => {
                Self::Malformed(cause.advice("check that this is the address of an EtherNet/IP device"))
            }
            E::WrongSize { .. } => Self::Size(cause.options(&["in", "in_size"])),
            E::Impossible(_) => Self::Settings(cause),
            E::Local(_) | E::Outdated | E::Ended => {
                Self::Local(cause.advice("check the network settings and the firewall of this computer"))
            }
        }
    }
}

/// Converts a remedy to the format of an advice, which starts with a lower-case letter and has no period at its end.
pub fn with_advice(remedy: &str) -> String {
    let mut chars = remedy.trim_end_matches('.').chars();
    chars.next().map(|first| first.to_lowercase().chain(chars).collect()).unwrap_or_default()
}
