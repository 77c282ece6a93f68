//! Discovery of PROFINET stations on an interface.

use super::station::Station;
use crate::fieldbus::{self, Device, Scope, fields};
use crate::prelude::basics::*;
use armctl_frame::settings::target::profinet::SCHEME;
use armctl_transport::image::LinkError;
use armctl_transport::image::tap::Tap;
use armctl_transport::profinet::commission;
use armctl_transport::profinet::interface::Interface;

/// Arguments: the interfaces to search.
#[derive(Debug, Args)]
#[group(skip)]
pub struct Search {
    /// Find all PROFINET stations on this Ethernet interface, for example eth0 (repeatable)
    #[arg(long = "interface", value_name = "IFACE")]
    interfaces: Vec<String>,
}

impl fieldbus::Search for Search {
    fn scope(&self) -> Scope {
        if self.interfaces.is_empty() { Scope::Nothing } else { Scope::Network }
    }

    fn search(&self, wait: Duration, tap: Tap) -> LocalBoxFuture<'_, Result<Vec<Device>>> {
        async move {
            let mut all = Vec::new();
            for name in &self.interfaces {
                let (name, tap) = (name.clone(), tap.clone());
                let asked = tokio::task::spawn_blocking(move || {
                    let mut interface = Interface::find(&name)?;
                    interface.tap = tap;
                    commission::stations(&interface, wait).map(|found| (name, found))
                });
                let asked = asked.await.map_err(|error| Failure::local(error.to_string()))?;
                let (name, found) = asked.map_err(|error| not_open("discover", &SCHEME, &LinkError::from(error)))?;
                for station in Station::all(&found) {
                    all.push(found_station(&station, &name)?);
                }
            }
            Ok(all)
        }
        .boxed_local()
    }
}

fn found_station(station: &Station, interface: &str) -> Result<Device> {
    // A name that two stations have does not identify a station, so use the MAC address.
    let is_twice = station.remarks.iter().any(|remark| remark.ends_with("has the same name"));
    let place = if station.station.is_empty() || is_twice { &station.mac } else { &station.station };
    let name = if station.station.is_empty() { "no name" } else { &station.station };
    Ok(Device {
        address: station.ip.clone().unwrap_or_else(|| station.mac.clone()),
        target: format!("{}://{place}@{interface}", SCHEME.name),
        // The vendor id of the manufacturer is not known, so armctl recognizes a YRCX by the station type.
        is_yrcx: ["RCX", "YAMAHA"].iter().any(|word| station.kind.to_uppercase().contains(word)),
        device: format!("{name}, {}", station.in_a_line()),
        identity: fields(station)?,
    })
}
