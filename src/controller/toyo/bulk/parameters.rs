//! Parameters and tables in TOML: names instead of ids, numbers in their units, words as in the protocol.
//!
//! ```toml
//! [parameters]
//! # P01: soft limit in plus direction, mm
//! soft-limit-plus = { ax1 = 500.00, ax2 = 300.00, ax3 = 200.00, ax4 = 0.00 }
//! # M09: language of the teach pendant (J Japanese, E English)
//! pendant-language = "E"
//!
//! # T2: speed table, mm/s
//! [speed-table]
//! 5 = 250.0
//! ```
//!
//! Ids are accepted instead of names. Each entry needs all its values, because a write sends them all.

use std::collections::HashMap;
use std::fmt::Write as _;

use toml_edit::{Item, TableLike};

use super::reading::{self, Reading};
use super::{Placed, Setting};
use crate::findings::{Finding, SourceLocation};
use crate::toyo::field::Value;
use crate::toyo::program::MOST_STEPS;
use crate::toyo::table::Parameter;
use crate::toyo::table::parameters::PARAMETERS;

/// TOML table of the parameters without rows.
const SINGLE: &str = "parameters";

/// Formats settings as TOML in the order of the manual; a comment gives id, purpose and unit.
pub fn write(settings: &[Setting]) -> String {
    let mut text = String::new();
    let of = |parameter: &'static Parameter| settings.iter().filter(move |setting| setting.parameter == parameter);
    for parameter in PARAMETERS.iter().filter(|parameter| parameter.row().is_none()) {
        for setting in of(parameter) {
            if text.is_empty() {
                let _ = writeln!(text, "[{SINGLE}]");
            }
            let _ = writeln!(text, "{}\n{} = {}", comment(parameter), parameter.name, toml(setting));
        }
    }
    for parameter in PARAMETERS.iter().filter(|parameter| parameter.row().is_some()) {
        for (index, setting) in of(parameter).enumerate() {
            if index == 0 {
                let gap = if text.is_empty() { "" } else { "\n" };
                let _ = writeln!(text, "{gap}{}\n[{}]", comment(parameter), parameter.name);
            }
            let _ = writeln!(text, "{} = {}", setting.row().unwrap_or_default(), toml(setting));
        }
    }
    text
}

/// Parses settings from TOML. Each must be known, unique, complete and in range.
pub fn read(bytes: &[u8]) -> Result<Vec<Placed>, Vec<Finding>> {
    reading::read(bytes, |reading, document| {
        let mut reader = Reader { reading, settings: Vec::new(), line_of_setting: HashMap::new() };
        reader.document(document);
        reader.settings
    })
}

fn comment(parameter: &Parameter) -> String {
    format!("# {}: {}{}", parameter.id, parameter.about, reading::comment(parameter.fields()))
}

fn toml(setting: &Setting) -> String {
    let Setting { parameter, values } = setting;
    reading::toml(parameter.fields(), values.get(parameter.key.fields.len()..).unwrap_or_default())
}

struct Reader<'r, 't> {
    reading: &'r mut Reading<'t>,
    settings: Vec<Placed>,
    /// Line of each parameter and row.
    line_of_setting: HashMap<(&'static str, Option<i32>), usize>,
}

impl Reader<'_, '_> {
    fn document(&mut self, document: &toml_edit::Table) {
        for (name, item) in document {
            let at = self.reading.key(document, name);
            match (Parameter::named(name), item.as_table_like()) {
                (None, Some(table)) if name == SINGLE => self.parameters(table),
                // TOML reads an id with a point as a table within a table.
                (None, Some(table)) if name.eq_ignore_ascii_case("T4") => self.sheets(table),
                (Some(parameter), Some(table)) if parameter.row().is_some() => self.rows(parameter, table),
                (Some(parameter), None) if parameter.row().is_some() => {
                    let message = format!("{name} is a table");
                    self.reading.findings.error(
                        at,
                        message,
                        Some(format!("write [{}], and one row per line", parameter.name)),
                    );
                }
                (Some(_), _) => {
                    let hint = format!("write [{SINGLE}] before it");
                    self.reading.findings.error(at, format!("{name} belongs into [{SINGLE}]"), Some(hint));
                }
                (None, None) if name == SINGLE => {
                    self.reading.findings.error(at, format!("{name} is a table"), Some(format!("write [{SINGLE}]")));
                }
                (None, _) => {
                    let tables = PARAMETERS.iter().filter(|row| row.row().is_some()).map(|row| row.name);
                    self.reading.unknown(at, "table", name, tables.chain([SINGLE]));
                }
            }
        }
        self.steps_fit();
    }

    fn sheets(&mut self, tables: &dyn TableLike) {
        for (name, item) in tables.iter() {
            let at = self.reading.key(tables, name);
            match (Parameter::named(&format!("T4.{name}")), item.as_table_like()) {
                (Some(parameter), Some(table)) => self.rows(parameter, table),
                (Some(parameter), None) => {
                    let hint = format!("write [{}], and one row per line", parameter.name);
                    self.reading.findings.error(at, format!("T4.{name} is a table"), Some(hint));
                }
                (None, _) => self.reading.unknown(at, "table", name, ["S1", "S2", "S3", "S4", "S5"]),
            }
        }
    }

    fn parameters(&mut self, table: &dyn TableLike) {
        for (name, item) in table.iter() {
            let at = self.reading.key(table, name);
            match Parameter::named(name) {
                Some(parameter) if parameter.row().is_some() => {
                    let hint = format!("write [{}], and one row per line", parameter.name);
                    self.reading.findings.error(at, format!("{name} is a separate table"), Some(hint));
                }
                Some(parameter) => self.setting(parameter, None, item, at),
                None => self.reading.unknown(at, "parameter", name, PARAMETERS.iter().map(|row| row.name)),
            }
        }
    }

    fn rows(&mut self, parameter: &'static Parameter, table: &dyn TableLike) {
        let Some(field) = parameter.row() else { return };
        for (name, item) in table.iter() {
            let at = self.reading.key(table, name);
            match field.read(name) {
                Ok(row) => self.setting(parameter, Some(row), item, at),
                Err(error) => self.reading.findings.error(at, error.to_string(), None),
            }
        }
    }

    fn setting(&mut self, parameter: &'static Parameter, row: Option<Value>, item: &Item, at: SourceLocation) {
        let before = self.reading.findings.errors();
        let mut values: Vec<Value> = row.into_iter().collect();
        values.extend(self.reading.values(parameter.name, parameter.fields(), item, at));
        let setting = Setting { parameter, values };
        if let Some(other) = self.line_of_setting.insert((parameter.id, setting.row()), at.line) {
            let what = setting.row().map_or_else(|| parameter.name.to_owned(), |row| format!("row {row}"));
            self.reading.findings.error(at, format!("{what} already exists in line {other}"), None);
        }
        if self.reading.findings.errors() == before {
            self.settings.push((setting, at.line));
        }
    }

    /// The tasks share a fixed total number of steps (TO 2-4, E22).
    fn steps_fit(&mut self) {
        for (setting, line) in self.settings.iter().filter(|(setting, _)| setting.parameter.id == "E22") {
            let steps = setting.values.iter().map(|value| if let Value::Number(steps) = value { *steps } else { 0 });
            let steps = steps.fold(0_usize, |sum, steps| sum + usize::try_from(steps).unwrap_or_default());
            if steps > MOST_STEPS {
                let message = format!("the tasks have {steps} steps in total; at most {MOST_STEPS} are possible");
                self.reading.findings.error(SourceLocation { line: *line, column: 1 }, message, None);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn setting(id: &str, text: &str) -> Setting {
        let parameter = Parameter::named(id).unwrap();
        Setting { parameter, values: parameter.layout.parse(text).unwrap().values().to_vec() }
    }

    fn errors(text: &str) -> Vec<String> {
        read(text.as_bytes()).unwrap_err().iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_written_file_is_readable_and_reads_back_unchanged() {
        let settings = [
            setting("M09", "M09 E"),
            setting("P01", "P01 AX1=+0500.00 AX2=+0300.00 AX3=+0200.00 AX4=-0000.05"),
            setting("P13", "P13 AX1<=+0010.00 0/01/3"),
            setting("T2", "T2 V05=0250.0"),
            setting("T4.S4", "T4 S4 GRP=01 a Z=+0001.00 R=+0000.00"),
        ];
        let text = write(&settings);
        assert_eq!(
            text,
            "\
[parameters]
# M09: language of the teach pendant; J Japanese, E English
pendant-language = \"E\"
# P01: soft limit in plus direction, mm
soft-limit-plus = { ax1 = 500.00, ax2 = 300.00, ax3 = 200.00, ax4 = -0.05 }
# P13: output bit by the place of axis 1; <= at most, >= at least, mm
area-output-1 = { compare = \"<=\", place = 10.00, station = 0, port = 1, bit = 3 }

# T2: speed table, mm/s
[speed-table]
5 = 250.0

# T4.S4: MVM table: approach point; a absolute, i incremental, mm
[mvm-approach]
1 = { aim = \"a\", z = 1.00, r = 0.00 }
"
        );
        let back = read(text.as_bytes()).unwrap();
        assert_eq!(back.iter().map(|(setting, _)| setting.clone()).collect::<Vec<_>>(), settings);
        assert_eq!(back.iter().map(|(_, line)| *line).collect::<Vec<_>>(), [3, 5, 7, 11, 15]);
        assert_eq!(back[3].0.write().unwrap().text(), "@WPAR T2 V05=0250.0");
        assert_eq!(write(&[]), "");
        assert_eq!(read(b"").unwrap(), []);
    }

    #[test]
    fn ids_and_other_spellings_are_accepted() {
        let text = "[parameters]\nm09 = 'J'\nE05.ax1 = 0\nE05.ax2 = 1\nE05.ax3 = \"0\"\nE05.ax4 = 0\n\
                    [T4.S1.7]\norigin = 1\np1 = 2\np2 = 3\np3 = 0\n[\"T4.S5\"]\n01 = 5\n[t2]\n\"5\" = 1\n";
        let back = read(text.as_bytes()).unwrap();
        let lines: Vec<String> = back.iter().map(|(setting, _)| setting.write().unwrap().text()).collect();
        assert_eq!(
            lines,
            [
                "@WPAR M09 J",
                "@WPAR E05 AX1=0 AX2=1 AX3=0 AX4=0",
                "@WPAR T4 S1 GRP=07 ORG=001 P1=002 P2=003 P3=000",
                "@WPAR T4 S5 GRP=01 R=+0005.00",
                "@WPAR T2 V05=0001.0",
            ]
        );
    }

    #[test]
    fn errors_have_line_and_column() {
        for (text, expected) in [
            (
                "[parameters]\nsoft-limit-plsu = 1",
                "line 2, column 1: error: unknown parameter 'soft-limit-plsu' (did you mean soft-limit-plus?)",
            ),
            (
                "[speed-tabel]\n1 = 1.0",
                "line 1, column 2: error: unknown table 'speed-tabel' (did you mean speed-table?)",
            ),
            (
                "pendant-language = \"J\"",
                "line 1, column 1: error: pendant-language belongs into [parameters] (write [parameters] before it)",
            ),
            (
                "[parameters]\nspeed-table = 1",
                "line 2, column 1: error: speed-table is a separate table (write [speed-table], and one row per line)",
            ),
            ("T2 = 5", "line 1, column 1: error: T2 is a table (write [speed-table], and one row per line)"),
            ("parameters = 5", "line 1, column 1: error: parameters is a table (write [parameters])"),
            ("[T4.S6]", "line 1, column 5: error: unknown table 'S6'"),
            ("[speed-table]\n21 = 1.0", "line 2, column 1: error: row: 21 is out of range (a number, 1 to 20)"),
            (
                "[speed-table]\n1 = 0.9",
                "line 2, column 5: error: speed: 0.9 is out of range (a number, 1.0 to 9999.9 mm/s)",
            ),
            (
                "[speed-table]\n1 = 1.05",
                "line 2, column 5: error: speed: 1.05 has too many decimals: at most 1 decimal (a number, 1.0 to 9999.9 mm/s)",
            ),
            ("[speed-table]\n1 = \"1.0\"", "line 2, column 5: error: speed: a number, 1.0 to 9999.9 mm/s is expected"),
            ("[speed-table]\n1 = inf", "line 2, column 5: error: speed: 'inf' is not a number, 1.0 to 9999.9 mm/s"),
            ("[speed-table]\n1 = 1.0\n01 = 2.0", "line 3, column 1: error: row 1 already exists in line 2"),
            (
                "[parameters]\nM09 = 'J'\npendant-language = 'E'",
                "line 3, column 1: error: pendant-language already exists in line 2",
            ),
            ("[parameters]\nM09 = 'X'", "line 2, column 7: error: language: 'X' is not J or E"),
            ("[parameters]\nM09 = { language = 'J' }", "line 2, column 7: error: language: J or E is expected"),
            (
                "[parameters]\nP08 = 5.0",
                "line 2, column 1: error: jog-speed-1 has 2 values (write { low = …, high = … })",
            ),
            (
                "[parameters]\nP08 = { low = 5.0 }",
                "line 2, column 1: error: high is missing: a number, 0.1 to 999.9 mm/s",
            ),
            (
                "[parameters]\nP08 = { low = 5.0, high = 9.0, hihg = 1.0 }",
                "line 2, column 32: error: unknown value 'hihg' (did you mean high?)",
            ),
            (
                "[parameters]\nE22 = { task1 = 5000, task2 = 1, task3 = 0, task4 = 0 }",
                "line 2, column 1: error: the tasks have 5001 steps in total; at most 5000 are possible",
            ),
        ] {
            assert_eq!(errors(text), [expected]);
        }
        assert_eq!(errors("[parameters]\nM09 = \nM10 = 'Q'\n").len(), 1, "what is no TOML is read no further");
        assert_eq!(errors("[parameters]\nM09 = 1\nM10 = 'Q'\n[x]\n").len(), 3);
        assert!(errors("[parameters]\nM09 = 'J'\nM09 = 'E'")[0].starts_with("line 3, column 1: error: duplicate key"));
        assert_eq!(read(b"# \xFF").unwrap_err()[0].message, "byte FF is not UTF-8");
    }

    #[test]
    fn the_fields_of_each_parameter_have_unique_names() {
        for row in &PARAMETERS {
            let names: std::collections::BTreeSet<_> = row.layout.fields.iter().map(|field| field.name).collect();
            assert_eq!(names.len(), row.layout.fields.len(), "{}", row.id);
        }
    }
}
