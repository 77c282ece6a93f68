//! What each fieldbus must do that a controller may be reached over. `buses.rs` lists them.

use std::any::Any;
use std::fmt;
use std::net::SocketAddr;
use std::path::Path;
use std::time::Duration;

use futures_util::future::LocalBoxFuture;
use serde::Serialize;
use serde_json::{Map, Value};

use super::decode::images::BusDecoder;
use crate::command::face::layers::Layers;
use crate::controller::yrcx::alarm::Alarm;
use crate::controller::yrcx::image::Image;
use crate::controller::yrcx::simulator::Start;
use crate::failure::Failure;
use crate::settings::Robot;
use crate::settings::target::{Address, Bus, Place, Sim, Target};
use crate::transport::image::tap::Tap;
use crate::transport::image::{ImageLink, LinkError};

/// A fieldbus: how controllers on it are reached, asked and simulated.
#[derive(Debug)]
pub struct Fieldbus {
    /// The name of it: the word of its commands, and what its schemes say that they lead to.
    pub name: &'static str,
    /// The alarm of a controller whose link over it is lost; the next number is the one of a loss that lasts.
    pub link_alarm: Alarm,
    /// The kind of packets that records have, as in a capture file: [`LINKTYPE_RAW`] is packets of IP.
    ///
    /// [`LINKTYPE_RAW`]: crate::transport::tap::LINKTYPE_RAW
    pub link_type: u16,
    /// The layers of `robots check` between the name and the signals, in order; the first is there whatever fails.
    pub layers: &'static [&'static str],
    /// Whether there is room for questions beside a session of this machine: a network, not an adapter of its own.
    pub has_room: bool,
    /// All addresses of a controller, asked of its network; `None` where each has but one.
    pub addresses: Option<Addresses>,
    /// Opens a link: one that commands the controller, which then is shown the resting image, or one that only looks and
    /// changes nothing for whoever commands it.
    pub open: for<'a> fn(At<'a>, Purpose) -> Opening<'a, ImageLink>,
    /// Opens what can be asked of the device without a link for images.
    pub board: for<'a> fn(At<'a>) -> Opening<'a, Box<dyn Board>>,
    /// What a code means that its devices say no with; `None` for what is no such code.
    pub explain: fn(code: &str) -> Option<Explained>,
    /// What finds its images in captures.
    pub decoder: fn() -> Box<dyn BusDecoder>,
    /// Starts a simulated controller on it, with what the URL of a simulator wants to go wrong.
    pub simulate: fn(&Sim) -> Result<Simulation, Failure>,
}

/// Asks a network for all addresses of a controller.
pub type Addresses = fn(&Bus) -> Result<Vec<Address>, LinkError>;

/// What comes when it is open.
pub type Opening<'a, T> = LocalBoxFuture<'a, Result<T, LinkError>>;

/// What a device says no with, in words.
#[derive(Debug, Clone)]
pub struct Explained {
    /// The code, however it was written.
    pub code: String,
    /// What it means; `None` for one without words.
    pub meaning: Option<String>,
    /// What was refused.
    pub refused: &'static str,
    /// What to do.
    pub remedies: &'static [&'static str],
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

/// What was opened to ask a device, whatever its fieldbus.
pub fn boxed(board: Result<impl Board, LinkError>) -> Result<Box<dyn Board>, LinkError> {
    Ok(Box::new(board?))
}

/// A simulated controller on a fieldbus in this process.
#[derive(Debug)]
pub struct Simulation {
    /// Where it is.
    pub bus: Bus,
    /// The controller.
    pub controller: Box<dyn fmt::Debug>,
}

impl Simulation {
    /// A controller that a URL leads to.
    pub fn at(url: &str, controller: impl fmt::Debug + 'static) -> Result<Self, Failure> {
        Ok(Self { bus: bus_of(url)?, controller: Box::new(controller) })
    }
}

/// How one fieldbus is searched, as the command line wants it.
pub trait Search {
    /// What is to be searched.
    fn scope(&self) -> Scope;

    /// Asks who is there until `wait` is over.
    fn search(&self, wait: Duration, tap: Tap) -> LocalBoxFuture<'_, Result<Vec<Device>, Failure>>;
}

/// What is to be searched of a fieldbus.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Scope {
    /// Nothing, as it has to be told where.
    Nothing,
    /// What is usual. That it cannot be asked is only a warning.
    Usual,
    /// A network or an adapter that was named.
    Network,
    /// Certain devices, and nothing else.
    Devices,
}

/// A device that answered. What it says of itself is untrusted.
#[derive(Debug)]
pub struct Device {
    /// Where the answer came from.
    pub address: String,
    /// The URL for `-t`.
    pub target: String,
    /// Whether it may be a yrcx, by the number of its maker.
    pub is_yrcx: bool,
    /// What it says of itself, in a line.
    pub device: String,
    /// The same as data, in the words of its fieldbus.
    pub identity: Map<String, Value>,
}

/// What a device says of itself, as data.
pub fn fields(identity: &impl Serialize) -> Result<Map<String, Value>, Failure> {
    match serde_json::to_value(identity) {
        Ok(Value::Object(fields)) => Ok(fields),
        Ok(_) => Err(Failure::local("an identity has no fields")),
        Err(error) => Err(Failure::local(error.to_string())),
    }
}

/// How one fieldbus serves a controller, as the command line wants it.
pub trait Serve {
    /// Whether it has a pseudo-terminal, which can be given a name.
    fn has_terminal(&self) -> bool {
        false
    }

    /// Begins to serve, with threads or tasks of its own. Where the fieldbus has several simulators, `simulator` is the
    /// name of one. `link` is what its pseudo-terminal is to be named, where it has one.
    fn serve(&self, simulator: Option<&str>, start: Start, link: Option<&Path>) -> Result<Served, Failure>;
}

/// What lines of a console do.
pub type Console = dyn FnMut(&str) -> Result<String, String>;

/// A controller that is served as long as this lives.
pub struct Served {
    /// The URL to reach it by.
    pub target: String,
    /// Where others may come from, where it is a network.
    pub address: Option<SocketAddr>,
    /// Does what a line of the console says, and tells what was done, or why not.
    pub console: Box<Console>,
}

impl fmt::Debug for Served {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.target)
    }
}

/// A URL that leads to a fieldbus, taken apart.
pub fn bus_of(url: &str) -> Result<Bus, Failure> {
    match url.parse::<Target>()?.place {
        Place::Bus(bus) => Ok(bus),
        _ => Err(Failure::local(format!("{url} leads to no fieldbus"))),
    }
}
