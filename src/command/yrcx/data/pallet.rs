//! `yrcx pallet-data` (4.3.3).

use schemars::JsonSchema;
use serde::Serialize;

use crate::command::commands;
use crate::command::yrcx::numbers::single;
use crate::command::yrcx::overwrite::Stored;
use crate::command::yrcx::several::by_number;
use crate::command::yrcx::single::one_row;
use crate::controller::yrcx::table;
use crate::controller::yrcx::value::{Key, Values};
use crate::output::view::Cell;

commands! {
    /// What can be done with pallets.
    pub enum PalletData {
        /// Read pallets: 10, 0..39
        Get(Get),
        /// Define a pallet: 10 --nx 10 --ny 15 --first-point 100
        Set(Set),
    }
}

by_number! {
    /// Reads pallets, one after the other.
    Get "yrcx.pallet-data.get" {
        /// Pallets, 0 to 39: 10, 0..39 or 1,5
        pallets "PALLET"
    }
    gives PalletGet Pallet ["pallet", "pallets"],
    /// Pallets.
    Pallets,
    /// Which pallet.
    pallet of Places: Places::of,
    columns ["nx", "ny", "nz", "first point"],
    cells |places| [places.nx, places.ny, places.nz, places.first_point].map(Cell::from);
}

/// A pallet.
#[derive(Debug, Serialize, JsonSchema)]
struct Places {
    /// Places in X.
    nx: i32,
    /// Places in Y.
    ny: i32,
    /// Places in Z.
    nz: i32,
    /// The first of the five points that define it.
    first_point: i32,
}

impl Places {
    fn of(values: &Values) -> Self {
        let [nx, ny, nz, first_point] =
            [Key::CountX, Key::CountY, Key::CountZ, Key::FirstPoint].map(|key| values.int(key).unwrap_or_default());
        Self { nx, ny, nz, first_point }
    }
}

one_row! {
    /// Defines a pallet.
    #[command(
        after_help = "The controller keeps the corners of a pallet in five points, from the first one on; `yrcx point \
        set` or `yrcx teach` defines those."
    )]
    Set(self) "yrcx.pallet-data.set" -> Stored {
        /// Pallet, 0 to 39
        #[arg(value_name = "PALLET", value_parser = |text: &str| single(table::Command::PalletSet, Key::Pallet, text))]
        pallet: i32,
        /// Places in X; at most 32767 places in all
        #[arg(long, value_name = "COUNT")]
        nx: String,
        /// Places in Y
        #[arg(long, value_name = "COUNT")]
        ny: String,
        /// Places in Z
        #[arg(long, value_name = "COUNT", default_value = "1")]
        nz: String,
        /// First of its five points, 0 to 29995
        #[arg(long, value_name = "POINT")]
        first_point: String,
    }
    gives table::Command::PalletSet,
    with draft => {
        let draft = draft.with(Key::Pallet, self.pallet).with(Key::FirstPoint, self.first_point.as_str());
        let counts = [(Key::CountX, &self.nx), (Key::CountY, &self.ny), (Key::CountZ, &self.nz)];
        counts.into_iter().fold(draft, |draft, (key, count)| draft.with(key, count.as_str()))
    },
    done {
        let Self { pallet, nx, ny, nz, first_point } = self;
        format!("defined pallet {pallet}: {nx} x {ny} x {nz}, first point {first_point}")
    };
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::command::yrcx::testing::{example, objection, read_example, words, written};

    #[test]
    fn the_examples_of_the_manual() {
        let set = ["pallet-data", "set", "10", "--nx", "10", "--ny", "15", "--first-point", "100"];
        assert_eq!(written(&set).unwrap(), [example("4.3.3-define")]);
        assert_eq!(read_example("4.3.3-define", &set)["new"], json!({"nx": 10, "ny": 15, "nz": 1, "first_point": 100}));
        let read = read_example("4.3.3-reference", &["pallet-data", "get", "10"]);
        assert_eq!(
            read["pallets"],
            json!([{"pallet": 10, "ok": true, "nx": 10, "ny": 15, "nz": 1, "first_point": 100}])
        );
    }

    #[test]
    fn a_pallet_has_so_many_places_and_no_more() {
        for (line, part) in [
            ("1 --nx 256 --ny 128 --first-point 1", "X times Y times Z is 32768; 1 to 32767"),
            ("1 --nx 0 --ny 1 --first-point 1", "X times Y times Z is 0"),
            ("1 --nx 1 --ny 1 --first-point 29996", "allowed: 0 to 29995"),
        ] {
            let line: Vec<&str> = ["pallet-data", "set"].into_iter().chain(line.split(' ')).collect();
            let failure = words(&line).unwrap_err();
            assert!(failure.message.contains(part), "{failure}");
        }
        assert!(objection(&["pallet-data", "get", "40"]).contains("allowed: 0 to 39"));
    }
}
