//! Numbered data of the controller: points and their comments, pallets, shifts, hands (4.3).

mod comment;
mod hand;
mod pallet;
mod path;
mod point;
mod sheet;
mod shift;

pub use comment::{Comment, Comments};
pub use hand::{HandData, Hands};
pub use pallet::{PalletData, Pallets};
pub use point::{Point, Points};
pub use sheet::PointSheet;
pub use shift::{ShiftData, Shifts};
