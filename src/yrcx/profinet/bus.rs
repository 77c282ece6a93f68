//! Registration of PROFINET IO as a fieldbus.

use futures_util::FutureExt as _;

use super::board::Board;
pub use super::discover::Search;
pub use super::serve::ServeArgs;
pub use super::station::Station as Identity;
use super::{check, connect, decode, simulated};
use crate::fieldbus::{ErrorMeaning, Fieldbus, Simulation, into_board};
use armctl_controller::yrcx::alarm::Alarm;
use armctl_frame::settings::target::profinet::SCHEME;
use armctl_transport::capture::LINKTYPE_ETHERNET;
use armctl_transport::profinet::wire::status::Status;

/// PROFINET IO as a fieldbus.
pub const BUS: Fieldbus = Fieldbus {
    name: SCHEME.bus,
    link_alarm: Alarm::new(12, 571),
    link_type: LINKTYPE_ETHERNET,
    layers: check::LAYERS,
    has_room: true,
    addresses: Some(connect::addresses),
    open: |at, purpose| connect::open(at, purpose).boxed_local(),
    board: |at| async move { into_board(Board::new(&at)) }.boxed_local(),
    explain,
    decoder: || Box::<decode::Decoder>::default(),
    simulate: |sim| {
        let network = simulated::in_process(sim)?;
        Simulation::at(&simulated::target(&network.interface().name), network)
    },
};

/// Explains a PNIOStatus: four bytes with any separators.
fn explain(code: &str) -> Option<ErrorMeaning> {
    let digits: String = code.chars().filter(|c| !matches!(c, ' ' | '-' | ':')).collect();
    let digits = digits.strip_prefix("0x").or_else(|| digits.strip_prefix("0X")).unwrap_or(&digits);
    let is_four_bytes = digits.len() == 8 && digits.bytes().all(|byte| byte.is_ascii_hexdigit());
    let status = is_four_bytes.then(|| u32::from_str_radix(digits, 16).ok()).flatten().map(Status)?;
    let (meaning, refused, remedies) = (status.meaning(), status.call(), status.remedies());
    Some(ErrorMeaning { code: format!("{:#010x}", status.0), meaning, refused, remedies })
}
