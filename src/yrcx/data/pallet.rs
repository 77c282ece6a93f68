//! `yrcx pallet-data` (4.3.3).

use crate::numbered_tables::{Kind, Numbered, all_zero, int};
use crate::prelude::*;
use armctl_controller::yrcx::table::Command;

table_commands! {
    /// Commands for pallets.
    PalletData of Numbered<Pallets> {}
}

/// The pallets of the controller.
#[derive(Debug)]
pub struct Pallets;

impl Kind for Pallets {
    type Value = Places;
    const WORDS: TableWords = TableWords {
        nouns: ["pallet", "pallets"],
        placeholder: "PALLET",
        range: "Pallets (0 to 39), such as 10, 0..39 or 1,5",
        reading: None,
        writing: Some(
            "The controller stores the corners of a pallet in five points, starting with the first point. Set these \
             points with `yrcx point set` or `yrcx teach`.",
        ),
    };
    const IDS: Ids = ids!("yrcx.pallet-data");
    const READ: (Command, Key) = (Command::PalletGet, Key::Pallet);
    const WRITE: Command = Command::PalletSet;
    const NUMBERS: &'static [&'static str] = &["0..39"];
    const FIELDS: &'static [(&'static str, Key, &'static str)] = &[
        ("nx", Key::CountX, "nx"),
        ("ny", Key::CountY, "ny"),
        ("nz", Key::CountZ, "nz"),
        ("first_point", Key::FirstPoint, "first point"),
    ];

    fn value(values: &Values) -> Option<Places> {
        let [nx, ny, nz, first_point] =
            [Key::CountX, Key::CountY, Key::CountZ, Key::FirstPoint].map(|key| int(values, key));
        Some(Places { nx, ny, nz, first_point })
    }

    fn is_blank(values: &Values) -> bool {
        all_zero(values, &[Key::CountX, Key::CountY, Key::CountZ])
    }
}

/// Data of a pallet.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Places {
    /// Number of positions in X.
    nx: i32,
    /// Number of positions in Y.
    ny: i32,
    /// Number of positions in Z.
    nz: i32,
    /// First of the five points that define the pallet.
    first_point: i32,
}
