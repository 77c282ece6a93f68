//! Comparison of the tables of the Toyo protocol with `data/toyo-tables.json`. This file has the words, forms, ranges,
//! units and marks of the manual. Intended differences are listed with their reasons.

use std::collections::BTreeSet;

use armctl_controller::toyo::errors;
use armctl_controller::toyo::field::{Field, Form, Number};
use armctl_controller::toyo::layout::Layout;
use armctl_controller::toyo::request::Request;
use armctl_controller::toyo::status;
use armctl_controller::toyo::table::commands::{ROWS, Row};
use armctl_controller::toyo::table::instructions::INSTRUCTIONS;
use armctl_controller::toyo::table::palletizing::RECORDS;
use armctl_controller::toyo::table::parameters::PARAMETERS;
use serde::Deserialize;

/// Intended differences, each with the ambiguity of the manual or another reason. `any` means that the manual has no
/// value. A difference is listed once for all axes or tasks.
const ON_PURPOSE: [(&str, &str); 15] = [
    ("SYSP answer TAIL: form enum, ours text", "C11: nobody says what the last word is"),
    ("RPLD answer PR: range 1 to 8, ours 1 to 16", "C15: there are 16 programs"),
    ("RPLD answer STP: range 0 to 1000, ours 0 to 5000", "C15: there are 5000 steps"),
    ("MBUS answer ER: form d2, ours hex2", "C20: the digits may be hexadecimal"),
    ("MBUS answer MS: form d2, ours hex2", "C20: the digits may be hexadecimal"),
    ("MINT request PR: words 0 1 2 3 4 5 6, ours 0 1 2 3 4 6", "5 is reserved, so it is not sent"),
    ("M14 TA_STN: range any to any, ours 0 to 4", "R12: as everywhere else"),
    ("M15 TA_STN: range any to any, ours 0 to 4", "R12: as everywhere else"),
    ("M17 STN: range 0 to 99, ours 1 to 61", "R11: the rest is called invalid"),
    ("M18 STN: range 0 to 99, ours 1 to 63", "R11: the rest is called invalid"),
    ("P05 AX: range any to any, ours 0 to 9999", "R13: what fits"),
    ("P17 AX: range -99.999 to 99.999, ours -99.99 to 99.99", "R8: what fits the template"),
    ("T4.S4 GRP: range any to any, ours 1 to 32", "R17: as in the other sheets"),
    ("T4.S5 GRP: range any to any, ours 1 to 32", "R17: as in the other sheets"),
    ("RSMV POST: words PASS, ours POST PASS", "R4: read either way; programs are written with PASS"),
];

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Tables {
    commands: Vec<CommandRow>,
    parameters: Vec<ParameterRow>,
    instructions: Vec<InstructionRow>,
    records: Vec<RecordRow>,
    errors: Vec<ErrorRow>,
    status_pages: Vec<PageRow>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct CommandRow {
    word: String,
    host_on: bool,
    eeprom: bool,
    only_on: Vec<String>,
    forms: Vec<FormRow>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct FormRow {
    request: String,
    request_sample: String,
    request_fields: Vec<FieldRow>,
    answer: String,
    answer_sample: String,
    answer_fields: Vec<FieldRow>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ParameterRow {
    id: String,
    write: String,
    fields: Vec<FieldRow>,
    read: String,
    read_fields: Vec<FieldRow>,
    sample: String,
    only_on: Vec<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct InstructionRow {
    word: String,
    text: String,
    sample: String,
    fields: Vec<FieldRow>,
    only_on: Vec<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct RecordRow {
    number: u8,
    text: String,
    sample: String,
    fields: Vec<FieldRow>,
}

/// `form` is `d3.1` for digits, `sd4.2` for digits with a sign, `cmp2` and `cmple` for comparisons. `|*` is added if
/// asterisks are possible.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct FieldRow {
    name: String,
    form: String,
    min: Option<String>,
    max: Option<String>,
    /// Valid range, if the legend in the manual accepts more values.
    valid_min: Option<String>,
    valid_max: Option<String>,
    words: Option<Vec<String>>,
    unit: Option<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ErrorRow {
    code: String,
    axis: Option<u8>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct PageRow {
    page: u8,
    kind: String,
    bits: Vec<u8>,
    active_low: Vec<u8>,
    groups: Vec<Vec<u8>>,
}

fn tables() -> Tables {
    serde_json::from_str(include_str!("data/toyo-tables.json")).expect("the tables are well-formed")
}

/// Differences that the test found.
#[derive(Default)]
struct Differences(BTreeSet<String>);

impl Differences {
    #[expect(clippy::needless_pass_by_value, reason = "the many calls read better")]
    fn assert_same<T: PartialEq + std::fmt::Display>(&mut self, place: &str, what: &str, theirs: T, ours: T) {
        if theirs != ours {
            // If a difference is equal for several axes or tasks, it is listed once.
            let place = place.split(' ').map(|word| {
                let bare = word.replace(|c: char| c.is_ascii_digit(), "");
                if matches!(&bare[..], "AX" | "TA_STN" | "ER" | "MS") { bare } else { word.to_owned() }
            });
            let place = place.collect::<Vec<_>>().join(" ");
            self.0.insert(format!("{place}: {what} {theirs}, ours {ours}"));
        }
    }

    fn fields(&mut self, place: &str, theirs: &[FieldRow], ours: &[Field]) {
        self.assert_same(place, "fields", theirs.len(), ours.len());
        for (theirs, ours) in theirs.iter().zip(ours) {
            self.field(&format!("{place} {}", theirs.name), theirs, ours);
        }
    }

    fn field(&mut self, place: &str, theirs: &FieldRow, ours: &Field) {
        let form = match &theirs.form[..] {
            "cmp2" | "cmple" => "enum",
            form => form,
        };
        self.assert_same(place, "form", form, &form_of(ours));
        let comparisons = match &theirs.form[..] {
            "cmp2" => Some(vec!["= ", "< ", "> ", "<=", ">="]),
            "cmple" => Some(vec!["<=", ">="]),
            _ => None,
        };
        let words = comparisons.map(|words| words.join(" ")).or(theirs.words.as_ref().map(|words| words.join(" ")));
        match ours.form {
            Form::Number(number) => {
                let range = |min: &Option<String>, max: &Option<String>| {
                    format!("{} to {}", min.as_deref().unwrap_or("any"), max.as_deref().unwrap_or("any"))
                };
                let own = format!("{} to {}", number.plain(number.least), number.plain(number.most));
                if theirs.valid_min.is_some() {
                    self.assert_same(place, "valid", range(&theirs.valid_min, &theirs.valid_max), own.clone());
                }
                self.assert_same(place, "range", range(&theirs.min, &theirs.max), own);
            }
            Form::Word(own) => {
                let own: Vec<&str> = own.iter().map(|word| word.text).collect();
                self.assert_same(place, "words", words.unwrap_or_default(), own.join(" "));
            }
            _ => {}
        }
        self.assert_same(place, "unit", theirs.unit.as_deref().unwrap_or_default(), ours.unit);
    }

    /// Checks that a sample is parsed and formatted unchanged.
    fn sample(&mut self, place: &str, layout: &Layout, sample: &str) {
        let made = layout.parse(sample).map_err(|error| error.to_string());
        let made = made.and_then(|record| record.emit().map_err(|error| error.to_string()));
        self.assert_same(place, "sample", sample, &made.unwrap_or_else(|error| error));
    }
}

fn form_of(field: &Field) -> String {
    let form = match field.form {
        Form::Number(Number { signed, whole, decimals, .. }) => {
            let sign = if signed { "s" } else { "" };
            match (whole, decimals) {
                (1, 0) => format!("{sign}d"),
                (whole, 0) => format!("{sign}d{whole}"),
                (whole, decimals) => format!("{sign}d{whole}.{decimals}"),
            }
        }
        Form::Hex => "hex2".to_owned(),
        Form::Word(_) => "enum".to_owned(),
        Form::Bits => "bits8".to_owned(),
        Form::Mask => "mask8".to_owned(),
        Form::Token | Form::Text => "text".to_owned(),
    };
    if field.starred { format!("{form}|*") } else { form }
}

/// Commands whose block contains a row of another table, and commands that have one form for all screens.
const BY_SAMPLE: [&str; 9] = ["WPAR", "RPAR", "WSTX", "RSTX", "WPLT", "RPLT", "MINP", "MOUT", "MNIN"];

fn command(differences: &mut Differences, theirs: &CommandRow, ours: &Row) {
    let place = theirs.word.as_str();
    differences.assert_same(place, "word", place, ours.word);
    differences.assert_same(place, "host ON", theirs.host_on, ours.needs_host);
    differences.assert_same(place, "EEPROM", theirs.eeprom, ours.writes_eeprom);
    differences.assert_same(place, "models", theirs.only_on.join(" "), ours.only_on.join(" "));
    for form in &theirs.forms {
        let request = Request::parse(&form.request_sample).unwrap_or_else(|error| panic!("{place}: {error}"));
        differences.assert_same(place, "sample", form.request_sample.clone(), request.text());
        let answer = request.answer(&form.answer_sample);
        let answer = answer.map_or_else(|error| error.to_string(), |answer| answer.text());
        differences.assert_same(place, "sample", form.answer_sample.trim_end(), answer.trim_end());
        if BY_SAMPLE.contains(&place) {
            continue;
        }
        let fits =
            |text: &str, forms: &'static [Layout]| forms.iter().find(|layout| format!("@{}", layout.text) == text);
        match fits(&form.request, ours.requests) {
            Some(layout) => differences.fields(&format!("{place} request"), &form.request_fields, layout.fields),
            None => differences.assert_same(place, "request", &form.request[..], "another"),
        }
        match fits(&form.answer, ours.answers) {
            Some(layout) => differences.fields(&format!("{place} answer"), &form.answer_fields, layout.fields),
            None if ours.is_order() => differences.assert_same(place, "answer", &form.answer[..], "@OK"),
            None => differences.assert_same(place, "answer", &form.answer[..], "another"),
        }
    }
}

fn differences() -> BTreeSet<String> {
    let tables = tables();
    let mut differences = Differences::default();
    for (theirs, ours) in tables.commands.iter().zip(&ROWS) {
        command(&mut differences, theirs, ours);
    }
    for (theirs, ours) in tables.parameters.iter().zip(&PARAMETERS) {
        let place = theirs.id.as_str();
        differences.assert_same(place, "id", place, ours.id);
        differences.assert_same(place, "form", &theirs.write[..], ours.layout.text);
        differences.assert_same(place, "key", &theirs.read[..], ours.key.text);
        differences.assert_same(place, "models", theirs.only_on.join(" "), ours.only_on.join(" "));
        differences.fields(place, &theirs.fields, ours.layout.fields);
        differences.fields(place, &theirs.read_fields, ours.key.fields);
        differences.sample(place, &ours.layout, &theirs.sample);
    }
    for (theirs, ours) in tables.instructions.iter().zip(&INSTRUCTIONS) {
        let place = theirs.word.as_str();
        differences.assert_same(place, "word", place, ours.word);
        differences.assert_same(place, "form", &theirs.text[..], ours.layout.text);
        differences.assert_same(place, "models", theirs.only_on.join(" "), ours.only_on.join(" "));
        differences.fields(place, &theirs.fields, ours.layout.fields);
        differences.sample(place, &ours.layout, &theirs.sample);
    }
    for (theirs, ours) in tables.records.iter().zip(&RECORDS) {
        let place = format!("record {}", theirs.number);
        differences.assert_same(&place, "number", theirs.number, ours.number);
        differences.assert_same(&place, "form", &theirs.text[..], ours.layout.text);
        differences.fields(&place, &theirs.fields, ours.layout.fields);
        differences.sample(&place, &ours.layout, &theirs.sample);
    }
    differences.0
}

#[test]
fn every_row_matches_the_manual() {
    let expected: BTreeSet<String> = ON_PURPOSE.iter().map(|(difference, _)| (*difference).to_owned()).collect();
    let differences_found = differences();
    let unexpected: Vec<_> = differences_found.difference(&expected).collect();
    let missing: Vec<_> = expected.difference(&differences_found).collect();
    assert!(unexpected.is_empty() && missing.is_empty(), "not on purpose: {unexpected:#?}\nno longer so: {missing:#?}");
}

#[test]
fn the_tables_are_complete() {
    let tables = tables();
    let counts = [
        (tables.commands.len(), ROWS.len(), 62),
        (tables.parameters.len(), PARAMETERS.len(), 83),
        (tables.instructions.len(), INSTRUCTIONS.len(), 55),
        (tables.records.len(), RECORDS.len(), 16),
        (tables.errors.len(), errors::all().count(), 104),
        (tables.status_pages.len(), 5, 5),
    ];
    for (theirs, ours, expected) in counts {
        assert_eq!((theirs, ours), (expected, expected));
    }
}

#[test]
fn every_error_code_matches_the_manual() {
    let theirs: Vec<(String, Option<u8>)> = tables().errors.into_iter().map(|row| (row.code, row.axis)).collect();
    let ours: Vec<_> = errors::all().map(|error| (format!("{:02X}", error.code), error.axis)).collect();
    assert_eq!(theirs, ours);
}

#[test]
fn every_status_bit_matches_the_manual() {
    for theirs in tables().status_pages {
        let own = || status::BITS.iter().filter(|bit| bit.page == theirs.page);
        assert_eq!(own().map(|bit| bit.bit).collect::<Vec<_>>(), theirs.bits, "page {}", theirs.page);
        let low: Vec<u8> = own().filter(|bit| bit.is_low).map(|bit| bit.bit).collect();
        assert_eq!(low, theirs.active_low, "page {}", theirs.page);
        assert_eq!(theirs.kind == "code", theirs.page == 1);
        // The program kind and the run mode use two bits each.
        assert_eq!(theirs.groups.len(), if theirs.page == 2 { 2 } else { 0 });
    }
}
