//! `toyo mvm`: groups of the MVM table. A group has five sheets: corners, pieces, counters, approach and destination.

use super::eeprom::{Cells, parameter_cell, parameter_sketch};
use super::eeprom_tables::{Listed, WRITING, row_cell, texts, unlisted};
use super::field_values::{Changes, word};
use super::item_reads::read_each;
use super::number_arguments::Numbers;
use crate::prelude::*;
use armctl_controller::toyo::field;
use armctl_frame::store::Row;

table_commands! {
    /// Commands for groups of the MVM table.
    Mvm of Groups {}
}

/// The MVM table.
#[derive(Debug)]
pub struct Groups;

/// Sheets and their fields: column in a file, and heading.
const SHEETS: [(&str, &[Field]); 5] = [
    (
        "T4.S1",
        &[
            Field::number("origin", "origin"),
            Field::number("p1", "P1"),
            Field::number("p2", "P2"),
            Field::number("p3", "P3"),
        ],
    ),
    (
        "T4.S2",
        &[
            Field::number("pieces1", "pieces 1"),
            Field::number("pieces2", "pieces 2"),
            Field::number("pieces3", "pieces 3"),
        ],
    ),
    (
        "T4.S3",
        &[
            Field::number("counter1", "counter 1"),
            Field::number("counter2", "counter 2"),
            Field::number("counter3", "counter 3"),
        ],
    ),
    (
        "T4.S4",
        &[
            Field::text("approach", "approach"),
            Field::number("approach_z_mm", "z (mm)"),
            Field::number("approach_r_mm", "r (mm)"),
        ],
    ),
    ("T4.S5", &[Field::number("destination_r_mm", "dest r (mm)")]),
];

fn sheet(index: usize) -> &'static Parameter {
    Parameter::named(SHEETS[index].0).expect("every sheet is in the table of parameters")
}

/// Field of the group number, 1 to 32.
fn field() -> field::Field {
    sheet(0).key.fields[0].named("group")
}

/// Requests that read the sheets of a group.
fn reads(group: i32) -> Result<Vec<Request>> {
    let read = |index| Request::read_parameter(sheet(index), Some(group));
    (0..SHEETS.len()).map(read).collect::<Result<_, _>>().map_err(|error| wrong(&error))
}

/// A group of the MVM table.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Group {
    /// Row of the coordinate table for corner P0.
    origin_point: i32,
    /// Row of the coordinate table for corner P1; 0 if there is none.
    p1_point: i32,
    /// Row of the coordinate table for corner P2; 0 if there is none.
    p2_point: i32,
    /// Row of the coordinate table for corner P3; 0 if there is none.
    p3_point: i32,
    /// Number of pieces toward P1, P2 and P3.
    pieces: [i32; 3],
    /// Counters of the pieces.
    counters: [i32; 3],
    /// Approach as a word: `absolute` or `incremental`.
    approach: String,
    /// Approach in the protocol: `a` or `i`.
    approach_raw: &'static str,
    approach_z_mm: f64,
    approach_r_mm: f64,
    destination_r_mm: f64,
}

impl Group {
    fn of(sheets: &[Record]) -> Self {
        let number = |index: usize, name| sheets[index].number(name).unwrap_or_default();
        let mm = |index, name| f64::from(number(index, name)) / 100.0;
        let three = |index| ["p1", "p2", "p3"].map(|name| number(index, name));
        let aim = sheets[3].pairs().find(|(field, _)| field.name == "aim");
        let raw = |value: &Value| if let Value::Word(word) = value { *word } else { "" };
        Self {
            origin_point: number(0, "origin"),
            p1_point: number(0, "p1"),
            p2_point: number(0, "p2"),
            p3_point: number(0, "p3"),
            pieces: three(1),
            counters: three(2),
            approach: aim.map_or_else(String::new, |(field, value)| field.meaning(value).into_owned()),
            approach_raw: aim.map_or("", |(_, value)| raw(value)),
            approach_z_mm: mm(3, "z"),
            approach_r_mm: mm(3, "r"),
            destination_r_mm: mm(4, "r"),
        }
    }
}

impl Store for Groups {
    type Family = Toyo;
    type Key = i32;
    /// Records of the sheets, in order.
    type Wire = Vec<Record>;
    type Value = Group;
    type More = Listed;
    type Options = Single;

    const WORDS: TableWords = TableWords {
        nouns: ["group", "groups"],
        placeholder: "GROUP",
        range: "Groups of the MVM table (1 to 32), such as 5 or 1-3",
        reading: None,
        writing: Some(WRITING),
    };
    const IDS: Ids = ids!("toyo.mvm");

    fn keys(text: &str) -> Result<Vec<i32>, String> {
        Ok(Numbers::of(&[Numbers::parse(&field(), text)?], &field()))
    }

    fn all() -> Vec<i32> {
        Numbers::of(&[], &field())
    }

    fn name(group: i32) -> String {
        group.to_string()
    }

    async fn open(_link: &mut Link, _options: &Single) -> Result<Self> {
        Ok(Self)
    }

    fn fields(&self) -> Vec<Field> {
        SHEETS.iter().flat_map(|(_, fields)| fields.iter().cloned()).collect()
    }

    fn texts(&self, sheets: &Vec<Record>) -> Vec<String> {
        sheets.iter().zip(&SHEETS).flat_map(|(record, (_, fields))| texts(record, fields.len())).collect()
    }

    fn headings(&self) -> Vec<&'static str> {
        vec!["P0 P1 P2 P3", "pieces", "counters", "approach", "z (mm)", "r (mm)", "dest r (mm)"]
    }

    fn cells(&self, _group: i32, sheets: &Vec<Record>) -> Vec<Cell> {
        if sheets.iter().any(|sheet| !sheet.is_listed()) {
            return vec![self.texts(sheets).join(" ").into()];
        }
        let texts = self.texts(sheets);
        let joined = [&texts[..4], &texts[4..7], &texts[7..10]].map(|part| Cell::from(part.join(" ")));
        let numbers = texts[11..].iter().map(Cell::number);
        let approach = Cell::from(Group::of(sheets).approach);
        joined.into_iter().chain([approach]).chain(numbers).collect()
    }

    fn value(&self, sheets: &Vec<Record>) -> Option<Group> {
        sheets.iter().all(Record::is_listed).then(|| Group::of(sheets))
    }

    fn more(&self, _group: i32, sheets: Option<&Vec<Record>>) -> Listed {
        Listed::of(sheets.and_then(|sheets| sheets.iter().find(|sheet| !sheet.is_listed()).or(sheets.first())))
    }

    fn is_blank(&self, sheets: &Vec<Record>) -> bool {
        sheets.iter().zip(&SHEETS).all(|(sheet, (_, fields))| super::eeprom_tables::is_zero(sheet, fields.len()))
    }

    fn unsaved(&self, _group: i32, sheets: Option<&Vec<Record>>) -> Option<String> {
        sheets.and_then(|sheets| sheets.iter().find_map(|sheet| unlisted(Some(sheet))))
    }

    async fn read(&self, link: &mut Link, screen: &Screen, groups: &[i32]) -> Result<Answers<Vec<Record>>> {
        let requests = groups.iter().copied().map(reads).collect::<Result<Vec<Vec<Request>>>>()?.concat();
        let sheets = read_each(link, screen, "reading sheets", &requests).await?;
        // If a sheet is refused, the whole group fails with the first refusal.
        let whole = |sheets: &[Result<Record>]| sheets.iter().cloned().collect::<Result<Vec<Record>>>();
        Ok(Answers::of(sheets.chunks(SHEETS.len()).map(whole).collect()))
    }
}

impl Writable for Groups {
    /// Changes of each sheet.
    type Draft = Vec<Changes>;

    const RISK: Risk = Risk::Destroy;

    fn draft(&self, _group: i32, texts: &[Option<&str>]) -> Result<Vec<Changes>, String> {
        let (mut sheets, mut texts) = (Vec::new(), texts.iter());
        for (index, (_, columns)) in SHEETS.iter().enumerate() {
            let values = sheet(index).body().fields.iter().zip(*columns).zip(texts.by_ref().copied());
            let read = |((field, column), text): ((&field::Field, &Field), Option<&str>)| {
                text.map(|text| word(&named(field, column), text)).transpose()
            };
            sheets.push(Changes::of(values.map(read).collect::<Result<_, _>>()?));
        }
        Ok(sheets)
    }

    fn complete_draft(&self, group: i32, draft: &Vec<Changes>, old: Option<&Vec<Record>>) -> Result<Vec<Record>> {
        let record = |(index, changes): (usize, &Changes)| {
            let values = match (changes.whole(), old) {
                (Some(values), _) => values,
                (None, Some(old)) if changes.values().iter().all(Option::is_none) => return Ok(old[index].clone()),
                (None, Some(old)) => changes.merged_with(&old[index])?,
                (None, None) => {
                    let message =
                        format!("group {group} could not be read, so the values that are not typed are unknown");
                    return Err(Failure::usage(message).hint("type all values; nothing was written"));
                }
            };
            Ok(row_cell(sheet(index), group, values)?.wanted)
        };
        draft.iter().enumerate().map(record).collect()
    }

    async fn plan(&self, link: &mut Link, rows: &[Row<Self>]) -> Result<()> {
        for (group, draft) in rows {
            let reads = reads(*group)?;
            // A copy does not keep old values.
            let is_copy = draft.iter().all(|changes| changes.values().iter().all(Option::is_none));
            for (index, changes) in draft.iter().enumerate() {
                if is_copy || changes.values().iter().any(Option::is_some) {
                    let sketch = parameter_sketch(sheet(index), Some(*group), changes.values());
                    link.plan_overwriting(&reads[index], &sketch).await?;
                }
            }
        }
        Ok(())
    }

    async fn write(&self, link: &mut Link, screen: &Screen, rows: &[RowDifference<'_, Self>]) -> Result<()> {
        for (_, old, new) in rows {
            let differs = |(index, new): &(usize, &Record)| old.is_none_or(|old| old[*index] != **new);
            for (index, record) in new.iter().enumerate().filter(differs) {
                let cell = parameter_cell(sheet(index), record.values().to_vec()).map_err(|error| wrong(&error))?;
                link.overwrite(screen, &cell, &mut Cells::default()).await?;
            }
        }
        Ok(())
    }
}

/// Field of the protocol, with the name of its column in a file.
fn named(field: &field::Field, column: &Field) -> field::Field {
    match &column.name {
        std::borrow::Cow::Borrowed(name) => field.named(name),
        std::borrow::Cow::Owned(_) => *field,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Bench, blocks};

    #[test]
    fn every_value_of_the_sheets_has_a_name() {
        for (index, (_, fields)) in SHEETS.iter().enumerate() {
            assert_eq!(sheet(index).body().fields.len(), fields.len());
        }
    }

    #[test]
    fn only_sheets_with_changes_are_written() {
        let written = |words: &[&str]| {
            let blocks = blocks(&[&["mvm", "set", "1"], words].concat()).unwrap();
            assert_eq!(blocks[..5], reads(1).unwrap().iter().map(Request::text).collect::<Vec<_>>());
            blocks[5..].to_vec()
        };
        assert_eq!(
            written(&["pieces1=10", "destination-r=-5.5"]),
            [
                "@WPAR T4 S2 GRP=01 P1=0010 P2=? P3=?",
                "@RPAR T4 S2 GRP=01",
                "@WPAR T4 S5 GRP=01 R=-0005.50",
                "@RPAR T4 S5 GRP=01"
            ]
        );
        assert_eq!(
            written(&["counter1=1", "counter2=2", "counter3=3"]),
            ["@WPAR T4 S3 GRP=01 P1=01 P2=02 P3=03", "@RPAR T4 S3 GRP=01"]
        );
    }

    #[test]
    fn set_values_are_read_back() {
        let mut bench = Bench::new("sim:");
        let words = ["origin=5", "p1=6", "pieces1=10", "counter3=7", "approach=incremental", "approach-z=2.5"];
        let stored = bench.data(&[&["mvm", "set", "2"], &words[..]].concat());
        assert_eq!(stored["items"][0]["written"], true, "{stored}");
        let read = bench.data(&["mvm", "get", "2"]);
        let group = &read["items"][0]["value"];
        assert_eq!(
            (&group["origin_point"], &group["p1_point"], &group["pieces"][0]),
            (&5.into(), &6.into(), &10.into())
        );
        assert_eq!((&group["approach"], &group["approach_z_mm"]), (&"incremental".into(), &2.5.into()));
        let again = bench.data(&[&["mvm", "set", "2"], &words[..]].concat());
        assert_eq!((&again["items"][0]["written"], &again["items"][0]["old"]), (&false.into(), group));
    }

    #[test]
    fn groups_are_dumped_restored_and_copied() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("mvm.csv");
        let file = file.to_str().unwrap();
        let mut bench = Bench::new("sim:");
        bench.data(&["mvm", "set", "2", "origin=5", "pieces2=3", "approach=absolute", "destination-r=1.5"]);
        bench.data(&["mvm", "copy", "2", "4"]);
        bench.data(&["mvm", "dump", file, "2,4"]);
        let mut other = Bench::new("sim:");
        let restored = other.data(&["mvm", "restore", file]);
        assert_eq!(restored["items"].as_array().unwrap().len(), 2, "{restored}");
        for group in ["2", "4"] {
            assert_eq!(bench.data(&["mvm", "get", group]), other.data(&["mvm", "get", group]));
        }
    }
}
