//! The fieldbuses that a controller may be reached over. A new one is a folder that implements `fieldbus.rs`, and a line in
//! each list here; its URLs are registered in `settings/target/bus.rs`.

use clap::Args;
use schemars::{JsonSchema as _, Schema, SchemaGenerator};

// Not its folder as a whole, whose commands know the link, which knows this list.
use super::devicenet::bus as devicenet;
use super::eip::bus as eip;
use super::fieldbus::{Fieldbus, Search, Serve};
use super::profibus::bus as profibus;
#[cfg(target_os = "linux")]
use super::profinet::bus as profinet;

/// All of them. The first is the one that a simulator is on unless its URL says otherwise.
pub const BUSES: &[&dyn Fieldbus] = &[
    &eip::EtherNetIp,
    &devicenet::DeviceNet,
    &profibus::ProfibusDp,
    #[cfg(target_os = "linux")]
    &profinet::ProfinetIo,
];

/// How each is searched by `robots discover`: arguments of the command line.
#[derive(Debug, Args)]
#[group(skip)]
pub struct Searches {
    #[command(flatten)]
    eip: eip::Search,
    #[command(flatten)]
    devicenet: devicenet::Search,
    #[command(flatten)]
    profibus: profibus::Search,
    #[cfg(target_os = "linux")]
    #[command(flatten)]
    profinet: profinet::Search,
}

impl Searches {
    /// Each with its fieldbus.
    pub fn each(&self) -> Vec<(&'static dyn Fieldbus, &dyn Search)> {
        vec![
            (&eip::EtherNetIp, &self.eip),
            (&devicenet::DeviceNet, &self.devicenet),
            (&profibus::ProfibusDp, &self.profibus),
            #[cfg(target_os = "linux")]
            (&profinet::ProfinetIo, &self.profinet),
        ]
    }
}

/// How each serves a simulated controller to others: arguments of `armctl sim yrcx`.
#[derive(Debug, Args)]
#[group(skip)]
pub struct Servers {
    #[command(flatten)]
    eip: eip::ServeArgs,
    #[command(flatten)]
    devicenet: devicenet::ServeArgs,
    #[command(flatten)]
    profibus: profibus::ServeArgs,
    #[cfg(target_os = "linux")]
    #[command(flatten)]
    profinet: profinet::ServeArgs,
}

impl Servers {
    /// Each with its fieldbus.
    pub fn each(&self) -> Vec<(&'static dyn Fieldbus, &dyn Serve)> {
        vec![
            (&eip::EtherNetIp, &self.eip),
            (&devicenet::DeviceNet, &self.devicenet),
            (&profibus::ProfibusDp, &self.profibus),
            #[cfg(target_os = "linux")]
            (&profinet::ProfinetIo, &self.profinet),
        ]
    }
}

/// What devices of each say of themselves.
pub fn identities(generator: &mut SchemaGenerator) -> Vec<Schema> {
    vec![
        eip::Identity::json_schema(generator),
        devicenet::Node::json_schema(generator),
        profibus::Station::json_schema(generator),
        #[cfg(target_os = "linux")]
        profinet::Station::json_schema(generator),
    ]
}

/// The fieldbus of this name.
pub fn by_name(name: &str) -> Option<&'static dyn Fieldbus> {
    BUSES.iter().copied().find(|bus| bus.name() == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::target;

    #[test]
    fn every_scheme_has_a_fieldbus_and_an_alarm_of_its_own() {
        for scheme in target::BUSES {
            assert!(by_name(scheme.bus).is_some(), "{scheme:?}");
        }
        let mut alarms = Vec::new();
        for bus in BUSES {
            assert!(target::BUSES.iter().any(|scheme| scheme.bus == bus.name()), "{bus:?}");
            assert!(target::bus::simulators().any(|(_, name)| name == bus.name()), "{bus:?}");
            assert!(bus.link_alarm().known().is_some() && !alarms.contains(&bus.link_alarm()), "{bus:?}");
            alarms.push(bus.link_alarm());
            assert_eq!(bus.layers().first(), Some(&"name"), "{bus:?}");
        }
    }
}
