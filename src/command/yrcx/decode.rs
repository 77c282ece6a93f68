//! `armctl decode yrcx`: words of a remote command and its answer, in words.

pub mod capture;
mod cip;

use std::path::PathBuf;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use crate::command::Report;
use crate::command::common::decode::capture::{Selection, tell, without_file};
use crate::command::run::{Run, Stopped};
use crate::command::yrcx::words;
use crate::controller::yrcx::describe::{Description, FieldNote, answer, command};
use crate::controller::yrcx::image::Words;
use crate::failure::{Failure, Kind};
use crate::output::view::{Section, Table, View};

/// Words to explain.
#[derive(Debug, Args)]
#[command(
    after_help = "Words that are left away are 0. An answer is explained by its command, where that is given. Words that \
    must not be sent are explained as far as they go, and the exit code is 5.\n\nOf a capture file, what the images \
    say is listed in the words of --trace when it is new, with the EtherNet/IP messages around it; NUMBER and TIME are \
    those of Wireshark. Nothing found is no failure. A file that is damaged is told up to there, and the exit code is 1."
)]
pub struct Yrcx {
    /// WI0 to WI15, as in 0x0001,0x0004,0,0x0032,0x0013
    #[arg(long, value_name = "WORDS", required_unless_present_any = ["wo", "file"], value_parser = words)]
    wi: Option<Words>,
    /// WO0 to WO15, as in 0x4000,0x0002,0x014E
    #[arg(long, value_name = "WORDS", value_parser = words)]
    wo: Option<Words>,
    /// A capture: FILE.pcap or FILE.pcapng
    #[arg(conflicts_with_all = ["wi", "wo"])]
    file: Option<PathBuf>,
    #[command(flatten)]
    selection: Selection,
    /// Images that say nothing new, too
    #[arg(long, help_heading = "Capture files")]
    every_image: bool,
}

impl Yrcx {
    pub fn run(self, run: &Run) -> Result<(), Stopped> {
        if let Some(path) = &self.file {
            let images = capture::Images::new(self.every_image);
            return tell(run, "decode.yrcx.capture", path, &self.selection, images);
        }
        if self.every_image || self.selection.is_given() {
            return Err(without_file().into());
        }
        run.local("decode.yrcx", &self.explained())
    }

    fn explained(&self) -> Explained {
        let part = |side, description| Part::of(side, description);
        let wi = self.wi.map(|wi| part("command", command(&wi)));
        let wo = self.wo.map(|wo| part("answer", answer(&wo, self.wi.as_ref())));
        Explained { parts: wi.into_iter().chain(wo).collect() }
    }
}

/// Words in words.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Explained {
    parts: Vec<Part>,
}

/// A command or an answer.
#[derive(Debug, Serialize, JsonSchema)]
struct Part {
    /// `command` or `answer`.
    kind: &'static str,
    /// What it is.
    title: String,
    /// Section of the manual, in chapter 2, where the command is known.
    section: Option<&'static str>,
    fields: Vec<FieldRow>,
    /// What is wrong with it.
    problems: Vec<String>,
}

impl Part {
    fn of(kind: &'static str, description: Description) -> Self {
        let Description { title, section, fields, problems } = description;
        Self { kind, title, section, fields: fields.into_iter().map(FieldRow::from).collect(), problems }
    }
}

/// A field of words.
#[derive(Debug, Serialize, JsonSchema)]
pub struct FieldRow {
    /// Word and bits, as in `WI1 bits 2-1`; `-` outside words.
    place: String,
    /// Its name for programs; null for the code, the status and what is not used.
    key: Option<&'static str>,
    /// What it is called.
    name: String,
    /// As it travels.
    raw: String,
    /// What it says.
    meaning: String,
}

impl FieldRow {
    /// A part of a message that is no field of a command.
    pub fn of_message(place: &str, name: &str, raw: String, meaning: &str) -> Self {
        Self { place: place.to_owned(), key: None, name: name.to_owned(), raw, meaning: meaning.to_owned() }
    }
}

impl From<FieldNote> for FieldRow {
    fn from(note: FieldNote) -> Self {
        let FieldNote { place, key, name, raw, meaning } = note;
        Self { place, key: key.map(crate::controller::yrcx::value::Key::name), name, raw, meaning }
    }
}

/// Fields as a table.
pub fn field_table(fields: &[FieldRow]) -> Table {
    let mut table = Table::new(&["word", "field", "raw", "meaning"], "no fields");
    for field in fields {
        let FieldRow { place, name, raw, meaning, .. } = field;
        table.row([place.as_str().into(), name.as_str().into(), raw.as_str().into(), meaning.as_str().into()]);
    }
    table
}

impl Report for Explained {
    fn view(&self) -> View {
        let mut sections = Vec::new();
        for part in &self.parts {
            let section = part.section.map(|section| format!(" ({section})")).unwrap_or_default();
            let problems: String = part.problems.iter().map(|problem| format!("\nproblem: {problem}")).collect();
            sections.push(Section::Text(format!("{}: {}{section}{problems}", part.kind, part.title)));
            sections.push(Section::Table(field_table(&part.fields)));
        }
        View { sections }
    }

    fn failure(&self) -> Option<Failure> {
        let problem = self.parts.iter().flat_map(|part| &part.problems).next()?;
        let failure = Failure::new(Kind::Malformed, format!("the words are not as the manual has them: {problem}"));
        Some(failure.hint("they are explained as far as they go; the section of the manual is named"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn explained(wi: Option<&str>, wo: Option<&str>) -> Explained {
        let read = |text: &str| words(text).unwrap();
        let (selection, file) = (Selection::default(), None);
        Yrcx { wi: wi.map(read), wo: wo.map(read), file, selection, every_image: false }.explained()
    }

    #[test]
    fn a_command_explains_its_answer() {
        let both = explained(Some("0x0001,0x8004,0,0x0032,0x0013"), Some("0x0200,0,0,0,0x3039"));
        assert_eq!(both.parts[1].section, Some("4.2.1"));
        let axis = both.parts[1].fields.iter().find(|field| field.key == Some("axis_1")).unwrap();
        assert_eq!(axis.meaning, "12.345 mm");
        assert!(both.failure().is_none());
    }

    #[test]
    fn words_that_must_not_be_sent_are_a_failure_with_their_fields() {
        let wrong = explained(Some("1,0xC000"), None);
        assert!(!wrong.parts[0].fields.is_empty());
        assert_eq!(wrong.failure().unwrap().kind, Kind::Malformed);
    }
}
