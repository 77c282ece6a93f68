//! Controllers on EtherNet/IP, and `yrcx eip`: the network board itself, by messages. For diagnosis: no connection for
//! images is opened, so nothing that the controller would miss when it ends.

mod board;
mod check;
mod cip;
mod connect;
mod decode;
mod discover;
mod identity;
mod message;
mod probe;
mod serve;
pub mod simulated;

use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;

use self::board::Board;
pub use self::board::Identity;
pub use self::discover::Search;
pub use self::serve::ServeArgs;
use super::Family;
use super::buses::{self, At, Fieldbus, Purpose, Simulation, bus_of};
use super::decode::capture::BusDecoder;
use super::link::Link;
use crate::command::commands;
use crate::controller::yrcx::alarm::Alarm;
use crate::failure::Failure;
use crate::settings::target::Sim;
use crate::settings::target::eip::SCHEME;
use crate::transport::image::{ImageLink, LinkError};

/// EtherNet/IP.
#[derive(Debug)]
pub struct EtherNetIp;

impl Fieldbus for EtherNetIp {
    fn name(&self) -> &'static str {
        SCHEME.bus
    }

    fn link_alarm(&self) -> Alarm {
        Alarm::new(12, 551)
    }

    fn open<'a>(&'a self, at: At<'a>, purpose: Purpose) -> LocalBoxFuture<'a, Result<ImageLink, LinkError>> {
        connect::open(at, purpose).boxed_local()
    }

    fn board<'a>(&'a self, at: At<'a>) -> LocalBoxFuture<'a, Result<Box<dyn buses::Board>, LinkError>> {
        async move {
            let (client, eip) = connect::client(&at).await?;
            Ok(Box::new(Board::new(client, eip, at.robot.label())) as Box<dyn buses::Board>)
        }
        .boxed_local()
    }

    fn layers(&self) -> &'static [&'static str] {
        check::LAYERS
    }

    fn decoder(&self) -> Box<dyn BusDecoder> {
        Box::new(decode::Decoder::default())
    }

    fn simulate(&self, sim: &Sim) -> Result<Simulation, Failure> {
        let server = simulated::on_loopback(sim)?;
        let bus = bus_of(&format!("{}://{}", SCHEME.name, server.address()))?;
        Ok(Simulation { bus, controller: Box::new(server) })
    }
}

/// The board of a link that is for it alone.
fn board_of(link: &mut Link) -> Result<&mut Board, Failure> {
    link.board(SCHEME.bus)
}

/// Why `--unit` means nothing here.
const NO_UNIT: &str = "the board is that of the whole controller";

commands! {
    /// What the network board can be asked.
    pub enum Eip of Family {
        /// Who the board is
        Identity(identity::Identify),
        /// Find the assemblies of the board, their sizes, and what makes a connection
        Probe(probe::Probe),
        /// Read an attribute of an object of the board (raw)
        Get(message::Get),
        /// Change an attribute of an object of the board (raw)
        Set(message::Set),
    }
}
