//! EtherNet/IP as one of the fieldbuses.

use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;

use super::board::Board;
pub use super::board::Identity;
pub use super::discover::Search;
pub use super::serve::ServeArgs;
use super::{check, connect, decode, simulated};
use crate::command::yrcx::decode::images::BusDecoder;
use crate::command::yrcx::fieldbus::{self, At, Fieldbus, Purpose, Simulation, bus_of};
use crate::controller::yrcx::alarm::Alarm;
use crate::controller::yrcx::simulator::Start;
use crate::failure::Failure;
use crate::settings::target::Sim;
use crate::settings::target::bus::Scheme;
use crate::settings::target::eip::SCHEME;
use crate::transport::image::{ImageLink, LinkError};

/// EtherNet/IP.
#[derive(Debug)]
pub struct EtherNetIp;

impl Fieldbus for EtherNetIp {
    fn name(&self) -> &'static str {
        let Scheme { bus, .. } = SCHEME;
        bus
    }

    fn link_alarm(&self) -> Alarm {
        Alarm::new(12, 551)
    }

    fn open<'a>(&'a self, at: At<'a>, purpose: Purpose) -> LocalBoxFuture<'a, Result<ImageLink, LinkError>> {
        connect::open(at, purpose).boxed_local()
    }

    fn board<'a>(&'a self, at: At<'a>) -> LocalBoxFuture<'a, Result<Box<dyn fieldbus::Board>, LinkError>> {
        async move {
            let (client, eip) = connect::client(&at).await?;
            Ok(Box::new(Board::new(client, eip, at.robot.label())) as Box<dyn fieldbus::Board>)
        }
        .boxed_local()
    }

    fn layers(&self) -> &'static [&'static str] {
        check::LAYERS
    }

    fn decoder(&self) -> Box<dyn BusDecoder> {
        Box::new(decode::Decoder::default())
    }

    fn simulate(&self, sim: &Sim, start: Start) -> Result<Simulation, Failure> {
        let server = simulated::on_loopback(sim, start)?;
        let bus = bus_of(&format!("{}://{}", SCHEME.name, server.address()))?;
        Ok(Simulation { bus, controller: Box::new(server) })
    }
}
