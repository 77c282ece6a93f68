//! Controllers on PROFINET IO, with this computer as the IO controller. Also the commands `yrcx profinet`: stations,
//! their names and addresses, GSDML files.

mod board;
pub mod bus;
mod check;
mod connect;
mod decode;
mod discover;
mod gsdml;
mod identify;
mod probe;
mod serve;
mod set;
pub mod simulated;
mod station;

use super::connect::{Endpoint, endpoint};
use crate::prelude::*;
use armctl_controller::text;
use armctl_frame::Offline;
use armctl_frame::settings::target::profinet::SCHEME;
use armctl_transport::profinet::commission;
use armctl_transport::profinet::settings::Station;
use armctl_transport::profinet::wire::Mac;
use armctl_transport::profinet::wire::dcp::Block;

/// Returns the station that a robot's URL names.
fn station_of(robot: &Robot) -> Result<Station> {
    let other = || {
        Failure::usage(format!("{} is not on {}", robot.label(), SCHEME.bus))
            .hint("select a station: -t profinet://NAME@INTERFACE")
    };
    match endpoint(robot)? {
        Endpoint::Bus(bus, _) => {
            bus.options().map(|options: &armctl_frame::settings::target::profinet::Profinet| options.station.clone())
        }
        Endpoint::Sim(_) => Some(Station::Name(simulated::NAME.to_owned())),
    }
    .ok_or_else(other)
}

/// In a dry run, notes the DCP request for the station.
fn plan_search(link: &mut Link, robot: &Robot) -> Result<()> {
    let question = commission::search_filter(&station_of(robot)?, 0);
    let hex = text::hex(&commission::identify(Mac::default(), &question));
    link.plan_frame(json!({ "hex": unknown(&hex, true), "about": "DCP Identify: MAC address of the station" }))
}

/// Returns the frame of a DCP Set, with the digits that are known before the station is found.
fn frame_for(station: &Station, block: &Block) -> String {
    let (destination, is_known) = match station {
        Station::Name(_) => (Mac::default(), false),
        Station::Mac(mac) => (*mac, true),
    };
    unknown(&text::hex(&commission::set(Mac::default(), destination, 0, block)), is_known)
}

/// Replaces the unknown digits of a frame by `?`. The MAC address of this computer (from byte 6) and the Xid (from byte
/// 18) are unknown. The MAC address of the station (from byte 0) is unknown if only the name of the station is known.
fn unknown(hex: &str, is_destination_known: bool) -> String {
    let is_unknown =
        |digit| (!is_destination_known && digit < 12) || (12..24).contains(&digit) || (36..44).contains(&digit);
    hex.chars().enumerate().map(|(digit, c)| if is_unknown(digit) { '?' } else { c }).collect()
}

commands! {
    /// Commands for a station.
    pub enum Profinet {
        /// Show name, MAC address, vendor and IP address of the station
        Identify(identify::Identify),
        /// Show records and modules of the station and find the layout for a target
        Probe(probe::Probe),
        /// Make the light of the station blink
        Blink(set::Blink),
        /// Set the station name
        SetName(set::SetName),
        /// Set the IP address of the station
        SetIp(set::SetIp),
        /// Delete the name and the IP address of the station
        Reset(set::Reset),
        /// Read a GSDML file: modules and the layout for a target
        Gsdml(Offline<gsdml::ReadFile>),
    }
}
