//! `yrcx pallet-data` (4.3.3).

use schemars::JsonSchema;
use serde::Serialize;

use crate::command::commands;
use crate::command::frame::store::{Copy, Dump, Get, Ids, List, Restore, TableWords, ids};
use crate::command::yrcx::backup::{PALLETS, Records};
use crate::command::yrcx::numbers::single;
use crate::command::yrcx::overwrite::Stored;
use crate::command::yrcx::single::one_row;
use crate::command::yrcx::stores::{Kind, Numbered, all_zero, int};
use crate::controller::yrcx::table;
use crate::controller::yrcx::value::{Key, Values};

commands! {
    /// Commands for pallets.
    pub enum PalletData {
        /// Read pallets: 10, 0..39
        Get(Get<Numbered<Pallets>>),
        /// List the defined pallets
        List(List<Numbered<Pallets>>),
        /// Define a pallet: 10 --nx 10 --ny 15 --first-point 100
        Set(Set),
        /// Copy a pallet to other pallets
        Copy(Copy<Numbered<Pallets>>),
        /// Save to a CSV file
        Dump(Dump<Numbered<Pallets>>),
        /// Write from a CSV file
        Restore(Restore<Numbered<Pallets>>),
    }
}

/// The pallets of the controller.
#[derive(Debug)]
pub struct Pallets;

impl Kind for Pallets {
    type Value = Places;
    const WORDS: TableWords = TableWords {
        nouns: ["pallet", "pallets"],
        placeholder: "PALLET",
        range: "Pallets, 0 to 39: 10, 0..39 or 1,5",
        reading: None,
        writing: None,
    };
    const IDS: Ids = ids!("yrcx.pallet-data");
    const RECORDS: &'static Records = &PALLETS;
    const HEADINGS: &'static [&'static str] = &["nx", "ny", "nz", "first point"];

    fn value(values: &Values) -> Option<Places> {
        let [nx, ny, nz, first_point] =
            [Key::CountX, Key::CountY, Key::CountZ, Key::FirstPoint].map(|key| int(values, key));
        Some(Places { nx, ny, nz, first_point })
    }

    fn is_blank(values: &Values) -> bool {
        all_zero(values, &[Key::CountX, Key::CountY, Key::CountZ])
    }
}

/// A pallet.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Places {
    /// Positions in X.
    nx: i32,
    /// Positions in Y.
    ny: i32,
    /// Positions in Z.
    nz: i32,
    /// The first of the five points that define it.
    first_point: i32,
}

one_row! {
    /// Defines a pallet.
    #[command(
after_help = "The controller stores the corners of a pallet in five points, starting with the first point. Set them \
              with `yrcx point set` or `yrcx teach`."
    )]
    Set(self) "yrcx.pallet-data.set" -> Stored {
        /// Pallet, 0 to 39
        #[arg(value_name = "PALLET", value_parser = |text: &str| single(table::Command::PalletSet, Key::Pallet, text))]
        pallet: i32,
        /// Positions in X; at most 32767 positions in total
        #[arg(long, value_name = "COUNT")]
        nx: String,
        /// Positions in Y
        #[arg(long, value_name = "COUNT")]
        ny: String,
        /// Positions in Z
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
        assert_eq!(
            read_example("4.3.3-define", &set)["items"][0]["new"],
            json!({"nx": 10, "ny": 15, "nz": 1, "first_point": 100})
        );
        let read = read_example("4.3.3-reference", &["pallet-data", "get", "10"]);
        assert_eq!(read["items"][0]["value"], json!({"nx": 10, "ny": 15, "nz": 1, "first_point": 100}));
    }

    #[test]
    fn a_pallet_has_so_many_places_and_no_more() {
        for (line, part) in [
            ("1 --nx 256 --ny 128 --first-point 1", "X times Y times Z is 32768; a pallet has 1 to 32767"),
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
