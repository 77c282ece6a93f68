//! Registration of DeviceNet as a fieldbus.

use futures_util::FutureExt as _;

use super::board::Board;
pub use super::board::Node as Identity;
pub use super::discover::Search;
pub use super::serve::ServeArgs;
use super::{check, connect, decode, simulated};
use crate::fieldbus::{Fieldbus, Simulation, into_board};
use armctl_controller::yrcx::alarm::Alarm;
use armctl_frame::settings::target::devicenet;
use armctl_transport::capture::LINKTYPE_CAN;

/// DeviceNet as a fieldbus.
pub const BUS: Fieldbus = Fieldbus {
    name: devicenet::BUS,
    link_alarm: Alarm::new(12, 541),
    link_type: LINKTYPE_CAN,
    layers: check::LAYERS,
    has_room: false,
    addresses: None,
    open: |at, purpose| connect::open(at, purpose).boxed_local(),
    board: |at| async move { into_board(Board::new(&at)) }.boxed_local(),
    explain: |_| None,
    decoder: || Box::<decode::Decoder>::default(),
    simulate: |sim| {
        let hub = simulated::on_loopback(sim)?;
        let place = hub.endpoint_addresses.first().map(String::as_str).unwrap_or_default();
        Simulation::at(&simulated::target(place), hub)
    },
};
