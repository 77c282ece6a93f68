//! Registration of PROFIBUS DP as a fieldbus.

use futures_util::FutureExt as _;

use super::board::Board;
pub use super::board::Station as Identity;
pub use super::discover::Search;
pub use super::serve::ServeArgs;
use super::{check, connect, decode, simulated};
use crate::fieldbus::{Fieldbus, Simulation, into_board};
use armctl_controller::yrcx::alarm::Alarm;
use armctl_frame::settings::target::profibus::SCHEME;
use armctl_transport::tap::LINKTYPE_PROFIBUS_DL;

/// PROFIBUS DP as a fieldbus.
pub const BUS: Fieldbus = Fieldbus {
    name: SCHEME.bus,
    link_alarm: Alarm::new(12, 561),
    link_type: LINKTYPE_PROFIBUS_DL,
    layers: check::LAYERS,
    has_room: false,
    addresses: None,
    open: |at, purpose| connect::open(at, purpose).boxed_local(),
    board: |at| async move { into_board(Board::new(&at)) }.boxed_local(),
    explain: |_| None,
    decoder: || Box::<decode::Decoder>::default(),
    simulate: |sim| {
        let server = simulated::in_process(sim)?;
        Simulation::at(&server.url(None), server)
    },
};
