//! List of the fieldbuses of a controller. To add a fieldbus, add a folder whose `bus.rs` supplies what `fieldbus.rs`
//! requires. Then add a line to the list in this file, and register the URLs in `settings/target/bus.rs`.

use clap::{Arg, Args, Command};
use schemars::{JsonSchema as _, Schema, SchemaGenerator};

// Only the `bus` module is imported, because the commands of the folder depend on the link, and the link depends on
// this list.
use super::devicenet::bus as devicenet;
use super::eip::bus as eip;
use super::fieldbus::{Fieldbus, Search, Serve};
use super::profibus::bus as profibus;
use super::profinet::bus as profinet;

/// Generates the lists of fieldbuses.
macro_rules! fieldbuses {
    ($($bus:ident,)*) => {
        /// All fieldbuses. The first is the default of a simulator URL.
        pub const BUSES: &[&Fieldbus] = &[$(&$bus::BUS,)*];

        /// Command-line arguments of `robots discover`, per fieldbus.
        #[derive(Debug, Args)]
        #[group(skip)]
        pub struct Searches {
            $(#[command(flatten)] $bus: $bus::Search,)*
        }

        impl Searches {
            /// Returns the search of each fieldbus.
            pub fn each(&self) -> Vec<(&'static Fieldbus, &dyn Search)> {
                vec![$((&$bus::BUS, &self.$bus),)*]
            }
        }

        /// Command-line arguments of `armctl sim yrcx`, per fieldbus.
        #[derive(Debug, Args)]
        #[group(skip)]
        pub struct Servers {
            $(#[command(flatten)] $bus: $bus::ServeArgs,)*
        }

        impl Servers {
            /// Returns the server of each fieldbus.
            pub fn each(&self) -> Vec<(&'static Fieldbus, &dyn Serve)> {
                vec![$((&$bus::BUS, &self.$bus),)*]
            }

            /// Returns each fieldbus with the arguments that only this fieldbus has.
            pub fn arguments() -> Vec<(&'static Fieldbus, Vec<Arg>)> {
                let of = |command: Command| command.get_arguments().cloned().collect();
                vec![$((&$bus::BUS, of($bus::ServeArgs::augment_args(Command::new("sim")))),)*]
            }
        }

        /// Returns the schemas of the device identities, one per fieldbus.
        pub fn identities(generator: &mut SchemaGenerator) -> Vec<Schema> {
            vec![$($bus::Identity::json_schema(generator),)*]
        }
    };
}

fieldbuses! {
    eip,
    devicenet,
    profibus,
    profinet,
}

/// Finds a fieldbus by name.
pub fn by_name(name: &str) -> Option<&'static Fieldbus> {
    BUSES.iter().copied().find(|bus| bus.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_frame::settings::target;

    #[test]
    fn every_scheme_has_a_fieldbus_and_an_alarm_of_its_own() {
        for scheme in target::BUSES {
            assert!(by_name(scheme.bus).is_some(), "{scheme:?}");
        }
        let mut alarms = Vec::new();
        for bus in BUSES {
            assert!(target::BUSES.iter().any(|scheme| scheme.bus == bus.name), "{bus:?}");
            assert!(target::bus::simulators().any(|(_, name)| name == bus.name), "{bus:?}");
            assert!(bus.link_alarm.known().is_some() && !alarms.contains(&bus.link_alarm), "{bus:?}");
            alarms.push(bus.link_alarm);
            assert_eq!(bus.layers.first(), Some(&"name"), "{bus:?}");
        }
    }
}
