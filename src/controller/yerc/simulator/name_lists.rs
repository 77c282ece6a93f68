//! `IONAME.LST` and `VARNAME.LST`, the lists of names. The simulator generates them from the files with names when a
//! client reads them.
//!
//! No known source shows these files. Their rows, such as `OT#(1) GRIPPER` and `B050 PARTS_DONE`, use the notation of
//! jobs.

use super::alarms::sjis;
use super::storage::Storage;
use crate::names::Name;
use crate::text::Encoding;
use crate::yerc::names;

/// List files, the files with names from which they are generated, and their first lines.
const LISTS: [(&[u8], &str, &str); 2] =
    [(b"IONAME.LST", "IONAME.DAT", "//IONAME"), (b"VARNAME.LST", "VARNAME.DAT", "//VARNAME")];
/// Notation of signals in jobs, by the first signal number in the protocol.
const SIGNALS: [(u32, &str); 2] = [(10, "IN"), (10_010, "OT")];
/// Size of the range of signal numbers that begins at each first number.
const EACH: u32 = 10_000;

/// Generates a list from its file. Returns `None` for other files, and if the file with names is missing or invalid.
pub(super) fn written(files: &Storage, list: &[u8]) -> Option<Vec<u8>> {
    let (_, file, head) = LISTS.into_iter().find(|(name, ..)| *name == list)?;
    let content = files.get(file.as_bytes())?;
    let bytes = content.piece(0, usize::try_from(content.size()).ok()?);
    let found = names::read(file, &bytes, Encoding::ShiftJis).ok()?;
    let rows =
        found.names.iter().filter_map(|Name { address, name, .. }| Some(format!("{} {name}", of_jobs(address)?)));
    let lines: Vec<String> = std::iter::once(head.to_owned()).chain(rows).collect();
    Some(lines.iter().flat_map(|line| [sjis(line), b"\r\n".to_vec()].concat()).collect())
}

/// Converts an address to the notation of jobs, for example #10010 to `OT#(1)`, and B50 to `B050`.
fn of_jobs(address: &str) -> Option<String> {
    if let Some(number) = address.strip_prefix('#') {
        let number: u32 = number.parse().ok()?;
        let (first, word) = SIGNALS.into_iter().find(|(first, _)| (*first..first + EACH).contains(&number))?;
        let (group, bit) = ((number - first) / 10, number % 10);
        return Some(format!("{word}#({})", group * 8 + bit + 1));
    }
    let digits = address.find(|one: char| one.is_ascii_digit())?;
    let number: u32 = address[digits..].parse().ok()?;
    Some(format!("{}{number:03}", &address[..digits]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn list_contains_the_addresses_of_jobs() {
        let of = |address: &str| of_jobs(address).unwrap();
        assert_eq!([of("#00010"), of("#00020"), of("#10017")], ["IN#(1)", "IN#(9)", "OT#(8)"]);
        assert_eq!([of("B50"), of("BP5"), of("P120")], ["B050", "BP005", "P120"]);
    }
}
