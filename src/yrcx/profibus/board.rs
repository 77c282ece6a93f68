//! Requests to PROFIBUS stations. They do not lock a station.

use super::{check, connect};
use crate::fieldbus::{BusBoard, Checked, ConnectionParameters};
use crate::prelude::basics::*;
use armctl_controller::text::hex;
use armctl_controller::yrcx::image::COMMAND_WORDS;
use armctl_frame::settings::target::Bus;
use armctl_frame::settings::target::profibus::{Profibus, SCHEME};
use armctl_transport::image::tap::Tap;
use armctl_transport::image::{Event, LinkError};
use armctl_transport::profibus::driver::survey;
use armctl_transport::profibus::error::ProfibusError;
use armctl_transport::profibus::link::record;
use armctl_transport::profibus::request::Requester;
use armctl_transport::profibus::survey::{NoValueReason, StationResult, Survey};
use armctl_transport::profibus::wire::{Configuration, Diagnosis, Flag, MAX_STATION, Station as StationKind};

/// PROFIBUS line of a URL. Each request opens the port.
#[derive(Debug)]
pub struct Board {
    /// Options of the URL.
    pub profibus: Profibus,
    label: String,
    timeout: Duration,
    tap: Tap,
}

/// Number of retries in a scan. It is low, because most addresses have no station.
const RETRIES: u8 = 1;

impl Board {
    /// Creates the client for the line of a URL.
    pub fn new(at: &ConnectionParameters<'_>) -> Result<Self, LinkError> {
        let (label, timeout) = (at.robot.label(), at.robot.timeout.value);
        Ok(Self { profibus: at.options::<Profibus>()?.clone(), label, timeout, tap: at.tap.clone() })
    }

    /// Creates the client for a line without a robot.
    pub fn of_line(bus: &Bus, line: &str, tap: Tap) -> Result<Self> {
        let profibus: &Profibus =
            bus.options().ok_or_else(|| Failure::local(format!("{bus:?} is not a URL of PROFIBUS")))?;
        Ok(Self { profibus: profibus.clone(), label: line.to_owned(), timeout: Duration::ZERO, tap })
    }

    /// Finds all stations.
    pub async fn scan(&self) -> Result<Vec<Station>> {
        let all = (0..=MAX_STATION).filter(|station| *station != self.profibus.master).collect();
        let found = self.ask(all, RETRIES).await?;
        Ok(found.iter().map(Station::from).collect())
    }

    /// Reads the station of the URL and its image; `None` if the station does not answer.
    pub async fn station(&self) -> Result<Option<(Station, Option<Image>)>> {
        Ok(self.found().await?.map(|found| (Station::from(&found), self.image(&found))))
    }

    /// Listens to the data exchange between the station and another master. armctl sends nothing.
    pub async fn overheard(&self) -> Result<Option<Image>> {
        let failed = |error: &LinkError| not_open(&self.label, &SCHEME, error);
        let listening = connect::listen(&self.profibus, self.tap.clone(), self.timeout).await;
        let mut link = listening.map_err(|error| failed(&error))?;
        match link.next(tokio::time::Instant::now() + self.timeout).await {
            Event::Image(image) => Ok(Image::from_link(&image)),
            Event::Lost(error) => Err(failed(&error)),
            _ => Ok(None),
        }
    }

    /// Reads the diagnosis of the URL's station.
    pub async fn diagnosis(&self) -> Result<Diagnosis> {
        let found = self.found().await?.ok_or_else(|| self.silent())?;
        found.diagnosis.map_err(|why| match why {
            NoValueReason::NoAnswer => self.silent(),
            NoValueReason::NotAsked => {
                Failure::new(Kind::Malformed, format!("{}: it is a {}", self.name(), kind(found.kind)))
                    .hint("check `station=` in the URL; use `yrcx profibus scan` to list the slaves")
            }
            why => Failure::new(Kind::Malformed, format!("{}: Slave_Diag: {}", self.name(), unknown(&why)))
                .hint("check that the station is a PROFIBUS DP slave"),
        })
    }

    /// Failure: the station of the URL does not answer.
    pub fn silent(&self) -> Failure {
        Failure::new(Kind::NoAnswer, format!("{} does not answer", self.name()))
            .hint("use `yrcx profibus scan` to list the stations that answer")
    }

    fn name(&self) -> String {
        format!("{}: station {}", self.label, self.profibus.station)
    }

    async fn found(&self) -> Result<Option<StationResult>> {
        let retries = self.profibus.retries.unwrap_or(3);
        Ok(self.ask(vec![self.profibus.station], retries).await?.into_iter().next())
    }

    /// Returns the image of the controller, if the station exchanges data.
    fn image(&self, found: &StationResult) -> Option<Image> {
        let mut bytes = found.inputs.as_ref().ok().cloned()?;
        if self.profibus.is_big_endian {
            for pair in bytes.chunks_exact_mut(2).take(COMMAND_WORDS) {
                pair.swap(0, 1);
            }
        }
        Image::from_link(&bytes)
    }

    async fn ask(&self, stations: Vec<u8>, retries: u8) -> Result<Vec<StationResult>> {
        let asked = self.survey(stations, retries).await;
        asked.map_err(|error| not_open(&self.label, &SCHEME, &error))
    }

    async fn survey(&self, stations: Vec<u8>, retries: u8) -> Result<Vec<StationResult>, LinkError> {
        let settings = connect::settings(&self.profibus, Duration::ZERO)?;
        let timing = settings.timing()?;
        let requester = Requester::new(settings.master, settings.rate, timing.slot, retries);
        let mut opener = connect::opener(&self.profibus)?;
        let tap = record(self.tap.clone());
        let asked = tokio::task::spawn_blocking(move || {
            let mut port = opener()?;
            let mut asking = Survey::new(Duration::ZERO, stations, requester, timing);
            survey(&mut asking, port.as_mut(), tap)
        });
        match asked.await {
            Ok(found) => Ok(found?),
            Err(error) => Err(ProfibusError::Gone(error.to_string()).into()),
        }
    }
}

impl BusBoard for Board {
    const BUS: &'static str = SCHEME.bus;
    const DEVICE: &'static str = "station";

    async fn check_layers(&mut self, layers: &mut Layers) -> Checked<Option<Image>> {
        check::check_layers(self, layers).await
    }
}

/// State and configuration of a station.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Station {
    /// Address of the station.
    pub station: u8,
    /// Kind of station: `slave`, or the type of master.
    pub kind: &'static str,
    /// Ident number, for example 0x1234; null if the station does not report it.
    pub ident: Option<String>,
    /// Address of the slave's master; null if the slave has no master.
    pub master: Option<u8>,
    /// Diagnosis in words, or the reason why there is none.
    pub diagnosis: String,
    /// Identifier bytes of the configuration; null if the station does not report them.
    pub configuration: Option<String>,
    /// Number of bytes from the station, calculated from the configuration.
    pub in_size: Option<usize>,
    /// Number of bytes to the station, calculated from the configuration.
    pub out_size: Option<usize>,
    /// Whether the station exchanges data with its master.
    pub exchanging: bool,
}

impl From<&StationResult> for Station {
    fn from(found: &StationResult) -> Self {
        let diagnosis = found.diagnosis.as_ref().ok();
        let configuration = found.configuration.as_ref().ok();
        let sizes = configuration.and_then(|bytes| Configuration::parse(bytes).ok());
        Self {
            station: found.station,
            kind: kind(found.kind),
            ident: diagnosis.map(|diagnosis| format!("{:#06x}", diagnosis.ident)),
            master: diagnosis.and_then(|diagnosis| diagnosis.master),
            diagnosis: match &found.diagnosis {
                Ok(diagnosis) => diagnosis.to_string(),
                Err(why) => unknown(why),
            },
            configuration: configuration.map(|bytes| hex(bytes)),
            in_size: sizes.as_ref().map(Configuration::input),
            out_size: sizes.as_ref().map(Configuration::output),
            exchanging: diagnosis.is_some_and(|diagnosis| diagnosis.master.is_some() && !diagnosis.has(Flag::NotReady)),
        }
    }
}

impl Station {
    /// Whether the images of the station have the size of a YRCX.
    pub fn fits(&self) -> bool {
        self.in_size == Some(Image::BYTES) && self.out_size == Some(Image::BYTES)
    }

    /// Fields of a view.
    pub fn fields(&self) -> Vec<(&'static str, Cell)> {
        let bytes = |size: Option<usize>| Cell::optional(size.map(|size| format!("{size} bytes")));
        vec![
            ("station", self.station.into()),
            ("kind", self.kind.into()),
            ("ident", Cell::optional(self.ident.clone())),
            ("master", Cell::optional(self.master)),
            ("diagnosis", self.diagnosis.as_str().into()),
            ("configuration", Cell::optional(self.configuration.clone())),
            ("from the controller", bytes(self.in_size)),
            ("to the controller", bytes(self.out_size)),
        ]
    }
}

const fn kind(station: StationKind) -> &'static str {
    match station {
        StationKind::Slave => "slave",
        StationKind::MasterNotReady => "master, not ready",
        StationKind::MasterReady => "master, ready",
        StationKind::MasterInRing => "master, in the ring",
    }
}

fn unknown(why: &NoValueReason) -> String {
    match why {
        NoValueReason::NotAsked => "not read".to_owned(),
        NoValueReason::NoAnswer => "no answer".to_owned(),
        NoValueReason::Refused(status) => format!("refused: {}", status.text()),
        NoValueReason::Malformed(why) => format!("cannot be read: {why}"),
    }
}
