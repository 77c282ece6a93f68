//! PROFINET IO as one of the fieldbuses.

use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;

use super::board::Board;
pub use super::serve::ServeArgs;
use super::{check, connect, decode, simulated};
use crate::command::yrcx::decode::images::BusDecoder;
use crate::command::yrcx::fieldbus::{self, At, Explained, Fieldbus, Purpose, Simulation, bus_of};
use crate::controller::yrcx::alarm::Alarm;
use crate::failure::Failure;
use crate::settings::target::Sim;
use crate::settings::target::profinet::SCHEME;
use crate::transport::capture::LINKTYPE_ETHERNET;
use crate::transport::image::{ImageLink, LinkError};
use crate::transport::profinet::wire::status::Status;

/// PROFINET IO.
#[derive(Debug)]
pub struct ProfinetIo;

impl Fieldbus for ProfinetIo {
    #[expect(clippy::misnamed_getters, reason = "the scheme names the fieldbus, not itself")]
    fn name(&self) -> &'static str {
        SCHEME.bus
    }

    fn link_alarm(&self) -> Alarm {
        Alarm::new(12, 571)
    }

    fn link_type(&self) -> u16 {
        LINKTYPE_ETHERNET
    }

    fn open<'a>(&'a self, at: At<'a>, purpose: Purpose) -> LocalBoxFuture<'a, Result<ImageLink, LinkError>> {
        connect::open(at, purpose).boxed_local()
    }

    fn board<'a>(&'a self, at: At<'a>) -> LocalBoxFuture<'a, Result<Box<dyn fieldbus::Board>, LinkError>> {
        async move { Ok(Box::new(Board::new(&at)?) as Box<dyn fieldbus::Board>) }.boxed_local()
    }

    fn explain(&self, code: &str) -> Option<Explained> {
        let digits: String = code.chars().filter(|c| !matches!(c, ' ' | '-' | ':')).collect();
        let digits = digits.strip_prefix("0x").or_else(|| digits.strip_prefix("0X")).unwrap_or(&digits);
        let is_four_bytes = digits.len() == 8 && digits.bytes().all(|byte| byte.is_ascii_hexdigit());
        let status = is_four_bytes.then(|| u32::from_str_radix(digits, 16).ok()).flatten().map(Status)?;
        let (meaning, refused, remedies) = (status.meaning(), status.call(), status.remedies());
        Some(Explained { code: format!("{:#010x}", status.0), meaning, refused, remedies })
    }

    fn layers(&self) -> &'static [&'static str] {
        check::LAYERS
    }

    fn decoder(&self) -> Box<dyn BusDecoder> {
        Box::new(decode::Decoder::default())
    }

    fn simulate(&self, sim: &Sim) -> Result<Simulation, Failure> {
        let network = simulated::in_process(sim)?;
        let bus = bus_of(&simulated::target(&network.interface().name))?;
        Ok(Simulation { bus, controller: Box::new(network) })
    }
}
