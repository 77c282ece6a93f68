//! Registration of EtherNet/IP as a fieldbus.

use futures_util::FutureExt as _;

use super::board::Board;
pub use super::board::Identity;
pub use super::discover::Search;
pub use super::serve::ServeArgs;
use super::{check, connect, decode, simulated};
use crate::fieldbus::{Fieldbus, Simulation, into_board};
use armctl_controller::yrcx::alarm::Alarm;
use armctl_frame::settings::target::eip::SCHEME;
use armctl_transport::tap::LINKTYPE_RAW;

/// EtherNet/IP as a fieldbus.
pub const BUS: Fieldbus = Fieldbus {
    name: SCHEME.bus,
    link_alarm: Alarm::new(12, 551),
    link_type: LINKTYPE_RAW,
    layers: check::LAYERS,
    has_room: true,
    addresses: None,
    open: |at, purpose| connect::open(at, purpose).boxed_local(),
    board: |at| async move { into_board(Board::open(&at).await) }.boxed_local(),
    explain: |_| None,
    decoder: || Box::<decode::Decoder>::default(),
    simulate: |sim| {
        let server = simulated::on_loopback(sim)?;
        Simulation::at(&format!("{}://{}", SCHEME.name, server.address()), server)
    },
};
