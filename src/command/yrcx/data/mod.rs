//! Numbered data of the controller: points and their comments, pallets, shifts, hands (4.3).

mod comment;
mod hand;
mod pallet;
mod point;
mod shift;

pub use comment::Comment;
pub use hand::HandData;
pub use pallet::PalletData;
pub use point::Point;
pub use shift::ShiftData;

use crate::controller::yrcx::order::Draft;
use crate::controller::yrcx::value::Key;

/// A number for each of the four axes, as typed.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Four([String; 4]);

fn four(text: &str) -> Result<Four, String> {
    let numbers: Vec<String> = text.split(',').map(|number| number.trim().to_owned()).collect();
    let count = numbers.len();
    let wrong = |_| format!("expected four numbers, one per axis, as in 10,-20,5,-18; {count} given");
    numbers.try_into().map(Four).map_err(wrong)
}

impl Four {
    fn put(&self, draft: Draft) -> Draft {
        Key::AXES.into_iter().zip(&self.0).fold(draft, |draft, (key, text)| draft.with(key, text.as_str()))
    }

    fn describe(&self) -> String {
        self.0.join(", ")
    }
}
