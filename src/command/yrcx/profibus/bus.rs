//! PROFIBUS DP as one of the fieldbuses.

use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;

use super::board::Board;
pub use super::board::Station;
pub use super::discover::Search;
pub use super::serve::ServeArgs;
use super::{check, connect, decode, simulated};
use crate::command::yrcx::decode::images::BusDecoder;
use crate::command::yrcx::fieldbus::{self, At, Fieldbus, Purpose, Simulation, bus_of};
use crate::controller::yrcx::alarm::Alarm;
use crate::controller::yrcx::simulator::Start;
use crate::failure::Failure;
use crate::settings::target::Sim;
use crate::settings::target::profibus::SCHEME;
use crate::transport::image::{ImageLink, LinkError};
use crate::transport::tap::LINKTYPE_PROFIBUS_DL;

/// PROFIBUS DP.
#[derive(Debug)]
pub struct ProfibusDp;

impl Fieldbus for ProfibusDp {
    #[expect(clippy::misnamed_getters, reason = "the scheme names the fieldbus, not itself")]
    fn name(&self) -> &'static str {
        SCHEME.bus
    }

    fn link_alarm(&self) -> Alarm {
        Alarm::new(12, 561)
    }

    fn link_type(&self) -> u16 {
        LINKTYPE_PROFIBUS_DL
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
        let server = simulated::in_process(sim, start)?;
        Ok(Simulation { bus: bus_of(&server.url(None))?, controller: Box::new(server) })
    }
}
