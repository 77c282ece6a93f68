//! Interface that each fieldbus implements. `buses.rs` lists the fieldbuses.

use std::any::Any;
use std::net::SocketAddr;

use serde_json::Map;

use super::decode::images::BusDecoder;
use crate::prelude::basics::*;
use armctl_controller::yrcx::simulator::Start;
use armctl_frame::failure::plain;
use armctl_frame::settings::target::{Address, Bus, Place, Sim, Target};
use armctl_transport::image::tap::Tap;
use armctl_transport::image::{Cause, ImageLink, LinkError};

/// A fieldbus: how to connect to it, diagnose it and simulate it.
#[derive(Debug)]
pub struct Fieldbus {
    /// Name, the same in commands and URL schemes.
    pub name: &'static str,
    /// Alarm that the controller raises when it loses the link. The next number is the alarm for a permanent loss.
    pub link_alarm: Alarm,
    /// Link type of recorded packets in a capture file; [`LINKTYPE_RAW`] means IP packets.
    ///
    /// [`LINKTYPE_RAW`]: armctl_transport::tap::LINKTYPE_RAW
    pub link_type: u16,
    /// Layers of `robots check` between the name layer and the signal layers, in order. There is at least one layer.
    pub layers: &'static [&'static str],
    /// Whether armctl can send other requests while a session on this computer is open. True for a network; false for
    /// an adapter that only one process can use.
    pub has_room: bool,
    /// Resolves all addresses of a controller; `None` if each controller has only one address.
    pub addresses: Option<Addresses>,
    /// Opens a link that sends commands, or a read-only link. A link that sends commands sends the resting image first.
    /// A read-only link does not affect the master.
    pub open: for<'a> fn(ConnectionParameters<'a>, Purpose) -> Opening<'a, ImageLink>,
    /// Opens the explicit messaging client of the device.
    pub board: for<'a> fn(ConnectionParameters<'a>) -> Opening<'a, Box<dyn Board>>,
    /// Explains an error code of the fieldbus's devices; returns `None` for any other code.
    pub explain: fn(code: &str) -> Option<ErrorMeaning>,
    /// Returns the decoder for images in captures.
    pub decoder: fn() -> Box<dyn BusDecoder>,
    /// Starts a simulated controller on this fieldbus, with the faults of the simulator's URL.
    pub simulate: fn(&Sim) -> Result<Simulation>,
}

/// Resolves all addresses of a controller.
pub type Addresses = fn(&Bus) -> Result<Vec<Address>, LinkError>;

/// Future of an operation that opens a connection.
pub type Opening<'a, T> = LocalBoxFuture<'a, Result<T, LinkError>>;

/// Meaning of an error code.
#[derive(Debug, Clone)]
pub struct ErrorMeaning {
    /// Code in normal form.
    pub code: String,
    /// Meaning of the code; `None` if unknown.
    pub meaning: Option<String>,
    /// Operation that the device refused.
    pub refused: &'static str,
    /// Remedies.
    pub remedies: &'static [&'static str],
}

/// Parameters for a connection to a controller on a fieldbus.
#[derive(Debug, Clone)]
pub struct ConnectionParameters<'a> {
    /// Robot, for its timeout and its name.
    pub robot: &'a Robot,
    /// Parsed URL of the robot or of a simulator.
    pub bus: &'a Bus,
    /// Tap that records the packets.
    pub tap: Tap,
}

impl<'a> ConnectionParameters<'a> {
    /// Options of the URL.
    pub fn options<O: 'static>(&self) -> Result<&'a O, LinkError> {
        options(self.bus)
    }
}

/// Options of the URL of a fieldbus.
pub fn options<O: 'static>(bus: &Bus) -> Result<&O, LinkError> {
    bus.options().ok_or_else(|| LinkError::Settings(Cause::new(format!("{bus:?} is a URL of another fieldbus"))))
}

/// Reads the file with which a manufacturer describes a device.
pub fn device_file<T, E: fmt::Display>(
    path: &Path,
    most: u64,
    advice: &'static str,
    parse: impl FnOnce(&[u8]) -> Result<T, E>,
) -> Result<T, LinkError> {
    let wrong = |why: String| Cause::new(format!("{}: {why}", path.display()));
    let bytes = files::read(path, most).map_err(|error| LinkError::Local(wrong(plain(&error)).advice(advice)))?;
    parse(&bytes).map_err(|error| LinkError::Settings(wrong(error.to_string())))
}

/// Purpose of a link.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// Use the link as the URL requests. Usually, the link then sends commands.
    Command,
    /// Only read.
    Look,
}

/// Explicit messaging client of a device, for the commands of its fieldbus and for `robots check`.
pub trait Board: fmt::Debug + Any {
    /// Checks the layers before the signals, and reads the image of the controller; returns `None` if no image was
    /// read.
    fn check<'a>(&'a mut self, layers: &'a mut Layers) -> LocalBoxFuture<'a, Option<Image>>;

    /// Closes the connection.
    fn close(self: Box<Self>) -> LocalBoxFuture<'static, ()>;
}

/// The explicit messaging client of one fieldbus.
#[expect(async_fn_in_trait, reason = "everything runs on one thread")]
pub trait BusBoard: fmt::Debug + Any + Sized {
    /// Name of the fieldbus.
    const BUS: &'static str;
    /// The device, in the reason why `--unit` is rejected.
    const DEVICE: &'static str;

    /// Checks the layers: [`Board::check`].
    async fn check_layers(&mut self, layers: &mut Layers) -> Checked<Option<Image>>;

    /// Closes the connection, if there is one.
    async fn end(self) {}
}

impl<B: BusBoard> Board for B {
    fn check<'a>(&'a mut self, layers: &'a mut Layers) -> LocalBoxFuture<'a, Option<Image>> {
        async move {
            match self.check_layers(layers).await {
                Ok(image) => image,
                Err((layer, failure)) => {
                    layers.fail(layer, &failure);
                    None
                }
            }
        }
        .boxed_local()
    }

    fn close(self: Box<Self>) -> LocalBoxFuture<'static, ()> {
        self.end().boxed_local()
    }
}

/// Result of a check, or the layer that failed.
pub type Checked<T> = Result<T, (&'static str, Failure)>;

/// Failures of a layer.
pub trait InLayer<T> {
    /// Names the layer.
    fn in_layer(self, layer: &'static str) -> Checked<T>;
}

impl<T> InLayer<T> for Result<T> {
    fn in_layer(self, layer: &'static str) -> Checked<T> {
        self.map_err(|failure| (layer, failure))
    }
}

/// Vendor id of the manufacturer of YRCX at the ODVA: EtherNet/IP and DeviceNet.
pub const VENDOR_ID: u16 = 636;

/// Converts the client of a fieldbus to a trait object.
pub fn into_board(board: Result<impl Board, LinkError>) -> Result<Box<dyn Board>, LinkError> {
    Ok(Box::new(board?))
}

/// Simulated controller on a fieldbus in this process.
#[derive(Debug)]
pub struct Simulation {
    /// Address of the simulated controller.
    pub bus: Bus,
    /// The simulated controller; it stops when this value is dropped.
    pub controller: Box<dyn fmt::Debug>,
}

impl Simulation {
    /// Creates a simulation that a client reaches at `url`.
    pub fn at(url: &str, controller: impl fmt::Debug + 'static) -> Result<Self> {
        Ok(Self { bus: bus_of(url)?, controller: Box::new(controller) })
    }
}

/// Search of one fieldbus, with its command-line arguments.
pub trait Search {
    /// Scope of the search.
    fn scope(&self) -> Scope;

    /// Searches for devices, and collects answers for the time `wait`.
    fn search(&self, wait: Duration, tap: Tap) -> LocalBoxFuture<'_, Result<Vec<Device>>>;
}

/// Scope of a search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Scope {
    /// No search, because this fieldbus needs an address from the user.
    Nothing,
    /// The default scope. If this search fails, armctl prints a warning and continues.
    Usual,
    /// A network or an adapter that the user named.
    Network,
    /// Only the devices that the user named.
    Devices,
}

/// A device that answered. Do not trust its identity.
#[derive(Debug)]
pub struct Device {
    /// Address of the device.
    pub address: String,
    /// URL for `-t`.
    pub target: String,
    /// Whether the vendor id is one of the yrcx family.
    pub is_yrcx: bool,
    /// Identity of the device in one line.
    pub device: String,
    /// Identity of the device as data, in the form that its fieldbus defines.
    pub identity: Map<String, Value>,
}

/// Converts the identity of a device to JSON fields.
pub fn fields(identity: &impl Serialize) -> Result<Map<String, Value>> {
    match serde_json::to_value(identity) {
        Ok(Value::Object(fields)) => Ok(fields),
        Ok(_) => Err(Failure::local("internal error: an identity has no fields")),
        Err(error) => Err(Failure::local(error.to_string())),
    }
}

/// Simulator server of one fieldbus, with its command-line arguments.
pub trait Serve {
    /// Whether the server opens a pseudo-terminal. The user can give a pseudo-terminal a name.
    fn has_terminal(&self) -> bool {
        false
    }

    /// Starts the server in its own threads or tasks.
    fn serve(&self, work: ServeOptions<'_>) -> Result<RunningSimulation>;
}

/// A controller to serve.
#[derive(Debug)]
pub struct ServeOptions<'a> {
    /// Name of the simulator, if the fieldbus has several.
    pub simulator: Option<&'a str>,
    /// Start state of the controller.
    pub start: Start,
    /// Name of the pseudo-terminal.
    pub link: Option<&'a Path>,
    /// Text of `--fault`.
    pub faults: Option<&'a str>,
}

/// Console operations of a simulator on its fieldbus.
pub trait Operator {
    /// Executes a console line and returns the result or the reason for a failure.
    fn console(&self, line: &str) -> Result<String, String>;

    /// Sets the simulated faults of the link and the device; `None` removes all faults.
    fn set_faults(&self, faults: Option<&str>) -> Result<(), String>;
}

/// A controller that a simulator serves; it stops when this value is dropped.
pub struct RunningSimulation {
    /// URL of the controller.
    pub target: String,
    /// Address that the server listens on, if the server uses a network.
    pub address: Option<SocketAddr>,
    /// Console of the server.
    pub operator: Box<dyn Operator>,
}

impl fmt::Debug for RunningSimulation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.target)
    }
}

/// Parses the URL of a fieldbus.
pub fn bus_of(url: &str) -> Result<Bus> {
    match url.parse::<Target>()?.place {
        Place::Bus(bus) => Ok(bus),
        _ => Err(Failure::local(format!("internal error: {url} is not a fieldbus URL"))),
    }
}
