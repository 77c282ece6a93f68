//! The fieldbuses that a controller may be reached over. A new one is a folder whose `bus.rs` says what `fieldbus.rs` asks,
//! and a line here; its URLs are registered in `settings/target/bus.rs`.

use clap::{Arg, Args, Command};
use schemars::{JsonSchema as _, Schema, SchemaGenerator};

// Not its folder as a whole, whose commands know the link, which knows this list.
use super::devicenet::bus as devicenet;
use super::eip::bus as eip;
use super::fieldbus::{Fieldbus, Search, Serve};
use super::profibus::bus as profibus;
#[cfg(target_os = "linux")]
use super::profinet::bus as profinet;

/// Makes the lists that the house goes by.
macro_rules! fieldbuses {
    ($($(#[$cfg:meta])* $bus:ident,)*) => {
        /// All of them. The first is the one that a simulator is on unless its URL says otherwise.
        pub const BUSES: &[&Fieldbus] = &[$($(#[$cfg])* &$bus::BUS,)*];

        /// How each is searched by `robots discover`: arguments of the command line.
        #[derive(Debug, Args)]
        #[group(skip)]
        pub struct Searches {
            $($(#[$cfg])* #[command(flatten)] $bus: $bus::Search,)*
        }

        impl Searches {
            /// Each with its fieldbus.
            pub fn each(&self) -> Vec<(&'static Fieldbus, &dyn Search)> {
                vec![$($(#[$cfg])* (&$bus::BUS, &self.$bus),)*]
            }
        }

        /// How each serves a simulated controller to others: arguments of `armctl sim yrcx`.
        #[derive(Debug, Args)]
        #[group(skip)]
        pub struct Servers {
            $($(#[$cfg])* #[command(flatten)] $bus: $bus::ServeArgs,)*
        }

        impl Servers {
            /// Each with its fieldbus.
            pub fn each(&self) -> Vec<(&'static Fieldbus, &dyn Serve)> {
                vec![$($(#[$cfg])* (&$bus::BUS, &self.$bus),)*]
            }

            /// Each fieldbus with the arguments that are for it alone.
            pub fn arguments() -> Vec<(&'static Fieldbus, Vec<Arg>)> {
                let of = |command: Command| command.get_arguments().cloned().collect();
                vec![$($(#[$cfg])* (&$bus::BUS, of($bus::ServeArgs::augment_args(Command::new("sim")))),)*]
            }
        }

        /// What devices of each say of themselves.
        pub fn identities(generator: &mut SchemaGenerator) -> Vec<Schema> {
            vec![$($(#[$cfg])* $bus::Identity::json_schema(generator),)*]
        }
    };
}

fieldbuses! {
    eip,
    devicenet,
    profibus,
    #[cfg(target_os = "linux")]
    profinet,
}

/// The fieldbus of this name.
pub fn by_name(name: &str) -> Option<&'static Fieldbus> {
    BUSES.iter().copied().find(|bus| bus.name == name)
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
            assert!(target::BUSES.iter().any(|scheme| scheme.bus == bus.name), "{bus:?}");
            assert!(target::bus::simulators().any(|(_, name)| name == bus.name), "{bus:?}");
            assert!(bus.link_alarm.known().is_some() && !alarms.contains(&bus.link_alarm), "{bus:?}");
            alarms.push(bus.link_alarm);
            assert_eq!(bus.layers.first(), Some(&"name"), "{bus:?}");
        }
    }
}
