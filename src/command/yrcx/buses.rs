//! The fieldbuses that a controller may be reached over, and what each must do. A new one is a folder beside `eip/` and a
//! line in each list at the top; its URLs are registered in `settings/target/bus.rs`.

use std::any::Any;
use std::fmt;

use clap::Args;
use futures_util::future::LocalBoxFuture;
use schemars::{JsonSchema as _, Schema, SchemaGenerator};

use super::decode::capture::BusDecoder;
use super::discover::Search;
use super::eip;
use super::serve::Serve;
use crate::command::checks::Layers;
use crate::controller::yrcx::alarm::Alarm;
use crate::controller::yrcx::image::Image;
use crate::failure::Failure;
use crate::settings::Robot;
use crate::settings::target::{Bus, Place, Sim, Target};
use crate::transport::image::tap::Tap;
use crate::transport::image::{ImageLink, LinkError};
use crate::transport::tap::LINKTYPE_RAW;

/// All of them. The first is the one that a simulator is on unless its URL says otherwise.
pub const BUSES: [&dyn Fieldbus; 1] = [&eip::EtherNetIp];

/// How each is searched by `robots discover`: arguments of the command line.
#[derive(Debug, Args)]
#[group(skip)]
pub struct Searches {
    #[command(flatten)]
    eip: eip::Search,
}

impl Searches {
    /// Each with its fieldbus.
    pub fn each(&self) -> [(&'static dyn Fieldbus, &dyn Search); 1] {
        [(&eip::EtherNetIp, &self.eip)]
    }
}

/// How each serves a simulated controller to others: arguments of `armctl sim yrcx`.
#[derive(Debug, Args)]
#[group(skip)]
pub struct Servers {
    #[command(flatten)]
    eip: eip::ServeArgs,
}

impl Servers {
    /// Each with its fieldbus.
    pub fn each(&self) -> [(&'static dyn Fieldbus, &dyn Serve); 1] {
        [(&eip::EtherNetIp, &self.eip)]
    }
}

/// What devices of each say of themselves.
pub fn identities(generator: &mut SchemaGenerator) -> Vec<Schema> {
    vec![eip::Identity::json_schema(generator)]
}

/// A fieldbus: how controllers on it are reached, asked, looked for and simulated.
pub trait Fieldbus: fmt::Debug + Sync {
    /// The name of it: the word of its commands, and what its schemes say that they lead to.
    fn name(&self) -> &'static str;

    /// The alarm of a controller whose link over it is lost; the next number is the one of a loss that lasts.
    fn link_alarm(&self) -> Alarm;

    /// The kind of packets that records have, as in a capture file: packets of IP unless it has frames of its own.
    fn link_type(&self) -> u16 {
        LINKTYPE_RAW
    }

    /// Opens a link: one that commands the controller, which then is shown the resting image, or one that only looks and
    /// changes nothing for whoever commands it.
    fn open<'a>(&'a self, at: At<'a>, purpose: Purpose) -> LocalBoxFuture<'a, Result<ImageLink, LinkError>>;

    /// Opens what can be asked of the device without a link for images.
    fn board<'a>(&'a self, at: At<'a>) -> LocalBoxFuture<'a, Result<Box<dyn Board>, LinkError>>;

    /// The layers of `robots check` between the name and the signals, in order; the first is there whatever fails.
    fn layers(&self) -> &'static [&'static str];

    /// What finds its images in captures.
    fn decoder(&self) -> Box<dyn BusDecoder>;

    /// Starts a simulated controller on it, as the URL of a simulator says.
    fn simulate(&self, sim: &Sim) -> Result<Simulation, Failure>;
}

/// Where a controller is on a fieldbus.
#[derive(Debug, Clone)]
pub struct At<'a> {
    /// The robot, for its time-out and its name.
    pub robot: &'a Robot,
    /// What its URL says, or what was made up for a simulator.
    pub bus: &'a Bus,
    /// Who records what passes.
    pub tap: Tap,
}

/// What a link is opened for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// To do what the URL says: mostly to command.
    Command,
    /// To see what the controller shows by itself.
    Look,
}

/// What can be asked of a device without a link for images, by the commands of its fieldbus and by `robots check`.
pub trait Board: fmt::Debug + Any {
    /// Looks at the layers up to the signals, and at what the controller shows; `None` where something failed before.
    fn check<'a>(&'a mut self, layers: &'a mut Layers) -> LocalBoxFuture<'a, Option<Image>>;

    /// Takes leave of it.
    fn close(self: Box<Self>) -> LocalBoxFuture<'static, ()>;
}

/// A simulated controller on a fieldbus in this process.
#[derive(Debug)]
pub struct Simulation {
    /// Where it is.
    pub bus: Bus,
    /// The controller.
    pub controller: Box<dyn fmt::Debug>,
}

/// The fieldbus of this name.
pub fn by_name(name: &str) -> Option<&'static dyn Fieldbus> {
    BUSES.into_iter().find(|bus| bus.name() == name)
}

/// A URL that leads to a fieldbus, taken apart.
pub fn bus_of(url: &str) -> Result<Bus, Failure> {
    match url.parse::<Target>()?.place {
        Place::Bus(bus) => Ok(bus),
        _ => Err(Failure::local(format!("{url} leads to no fieldbus"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::target;

    #[test]
    fn every_scheme_has_a_fieldbus_and_an_alarm_of_its_own() {
        for scheme in &target::BUSES {
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
