//! DeviceNet as one of the fieldbuses.

use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;

use super::board::Board;
pub use super::board::Node;
pub use super::discover::Search;
pub use super::serve::ServeArgs;
use super::{check, connect, decode, simulated};
use crate::command::yrcx::decode::images::BusDecoder;
use crate::command::yrcx::fieldbus::{self, At, Fieldbus, Purpose, Simulation, bus_of};
use crate::controller::yrcx::alarm::Alarm;
use crate::controller::yrcx::simulator::Start;
use crate::failure::Failure;
use crate::settings::target::Sim;
use crate::settings::target::devicenet::BUS;
use crate::transport::capture::LINKTYPE_CAN;
use crate::transport::image::{ImageLink, LinkError};

/// DeviceNet.
#[derive(Debug)]
pub struct DeviceNet;

impl Fieldbus for DeviceNet {
    fn name(&self) -> &'static str {
        BUS
    }

    fn link_alarm(&self) -> Alarm {
        Alarm::new(12, 541)
    }

    fn link_type(&self) -> u16 {
        LINKTYPE_CAN
    }

    fn open<'a>(&'a self, at: At<'a>, purpose: Purpose) -> LocalBoxFuture<'a, Result<ImageLink, LinkError>> {
        connect::open(at, purpose).boxed_local()
    }

    fn board<'a>(&'a self, at: At<'a>) -> LocalBoxFuture<'a, Result<Box<dyn fieldbus::Board>, LinkError>> {
        async move { Ok(Box::new(Board::new(&at)?) as Box<dyn fieldbus::Board>) }.boxed_local()
    }

    fn layers(&self) -> &'static [&'static str] {
        check::LAYERS
    }

    fn decoder(&self) -> Box<dyn BusDecoder> {
        Box::new(decode::Decoder::default())
    }

    fn simulate(&self, sim: &Sim, start: Start) -> Result<Simulation, Failure> {
        let hub = simulated::on_loopback(sim, start)?;
        let place = hub.places().first().map(String::as_str).unwrap_or_default();
        let bus = bus_of(&simulated::target(place))?;
        Ok(Simulation { bus, controller: Box::new(hub) })
    }
}
