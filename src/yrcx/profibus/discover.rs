//! Discovery of PROFIBUS stations on a line.

use super::board::{Board, Station};
use crate::fieldbus::{self, Device, Scope, bus_of, fields};
use crate::prelude::basics::*;
use armctl_frame::settings::target::profibus::SCHEME;
use armctl_transport::image::tap::Tap;

/// Line to search.
#[derive(Debug, Args)]
#[group(skip)]
pub struct Search {
    /// Find PROFIBUS stations on this adapter, for example /dev/ttyUSB0 or /dev/ttyUSB0?baud=1.5M
    #[arg(long, value_name = "PORT[?baud=RATE]", value_parser = port)]
    profibus: Option<String>,
}

/// Parses a port. A URL is also accepted.
#[expect(clippy::unnecessary_wraps, reason = "it parses a value for clap")]
fn port(text: &str) -> Result<String, String> {
    let of_url = text.strip_prefix(SCHEME.name).and_then(|rest| rest.strip_prefix("://"));
    Ok(of_url.unwrap_or(text).to_owned())
}

impl fieldbus::Search for Search {
    fn scope(&self) -> Scope {
        if self.profibus.is_some() { Scope::Devices } else { Scope::Nothing }
    }

    fn search(&self, _wait: Duration, tap: Tap) -> LocalBoxFuture<'_, Result<Vec<Device>>> {
        async move {
            let Some(line) = &self.profibus else { return Ok(Vec::new()) };
            let url = |station: u8| {
                let joint = if line.contains('?') { '&' } else { '?' };
                format!("{}://{line}{joint}station={station}", SCHEME.name)
            };
            let bus = bus_of(&url(0))?;
            let stations = Board::of_line(&bus, line, tap)?.scan().await?;
            stations.into_iter().map(|station| found(&station, line, url(station.station))).collect()
        }
        .boxed_local()
    }
}

fn found(station: &Station, line: &str, target: String) -> Result<Device> {
    let ident = station.ident.as_deref().unwrap_or("-");
    let device = format!("{}, ident {ident}, {}", station.kind, station.diagnosis);
    Ok(Device {
        address: format!("station {} on {line}", station.station),
        target,
        // A station does not report its vendor, so armctl recognizes a YRCX by the image size.
        is_yrcx: station.kind == "slave" && station.fits(),
        device,
        identity: fields(station)?,
    })
}
