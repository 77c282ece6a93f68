//! A command line for each family: `io get clamp`. Names are different on each robot, so the line is parsed for each
//! robot.

use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;
use std::slice;

use super::PER_ROBOT;
use crate::command::families;
use armctl_frame::command::AnyContext;
use armctl_frame::face::family_command::{FamilyLine, ParsedCommand};
use armctl_frame::gate::Intent;
use armctl_frame::items::ItemError;
use armctl_frame::output::csv::Sheet;
use armctl_frame::prelude::*;
use armctl_frame::report::sheet_of;
use armctl_frame::{AnyCommand, AnyReport, Driver, Outcome};

/// A parsed command, or the error.
type Parsed = Result<Box<dyn AnyCommand>>;

/// A read command that all families have. Of several commands, each family uses the first command that it has.
pub struct SharedLine {
    id: &'static str,
    lines: Vec<Vec<String>>,
    /// Whether reports are reduced to the common fields of the families.
    is_reduced: bool,
    /// Commands by family, with placeholder addresses for names.
    usual: Vec<(Family, Parsed)>,
    /// Commands by robot name.
    own: RefCell<HashMap<String, Rc<Parsed>>>,
}

impl SharedLine {
    /// Parses a line; `id` is its command id in envelopes and schemas.
    pub fn new(id: &'static str, words: Vec<String>) -> Result<Self> {
        Self::parse_first_family(id, vec![words], false)
    }

    /// Reads a value of any kind by its name or label: `NOUN get NAME` with the first noun that has the name.
    pub fn reading(id: &'static str, nouns: &[&str], name: &str) -> Result<Self> {
        let lines = nouns.iter().map(|noun| [*noun, "get", name].map(ToOwned::to_owned).into());
        Self::parse_first_family(id, lines.collect(), true)
    }

    fn parse_first_family(id: &'static str, lines: Vec<Vec<String>>, is_reduced: bool) -> Result<Self> {
        let default_line: Vec<(Family, Parsed)> = Family::ALL
            .into_iter()
            .map(|family| (family, names::detect_names(|| parse_first(family, &lines)).0))
            .collect();
        match default_line.iter().find(|_| default_line.iter().all(|(_, parsed)| parsed.is_err())) {
            Some((_, Err(failure))) => Err(failure.clone()),
            _ => Ok(Self { id, lines, is_reduced, usual: default_line, own: RefCell::default() }),
        }
    }

    fn default_arguments(&self, family: Option<Family>) -> Option<&dyn AnyCommand> {
        let of = |other: Family| family.is_none_or(|family| family == other);
        self.usual.iter().find_map(|(family, parsed)| parsed.as_deref().ok().filter(|_| of(*family)))
    }

    fn of(&self, robot: &Robot) -> Rc<Parsed> {
        let parsed = || {
            let known = slice::from_ref(robot);
            Rc::new(names::with_names(robot.family, known, || parse_first(robot.family, &self.lines)))
        };
        Rc::clone(self.own.borrow_mut().entry(robot.name.clone()).or_insert_with(parsed))
    }
}

impl AnyCommand for SharedLine {
    fn id(&self) -> &'static str {
        self.id
    }

    fn intent(&self, _robot: Option<&Robot>) -> Intent {
        Intent { risk: Risk::Read, text: String::new(), confirmation: Confirmation::Question, is_stop: false }
    }

    fn is_endless(&self) -> bool {
        self.default_arguments(None).is_some_and(AnyCommand::is_endless)
    }

    fn driver(&self) -> Option<&'static Driver> {
        Some(&PER_ROBOT)
    }

    fn connect_mode(&self, robot: &Robot) -> ConnectMode {
        match &*self.of(robot) {
            Ok(command) => command.connect_mode(robot),
            // The command is refused before anything is sent.
            Err(_) => ConnectMode::Monitor,
        }
    }

    fn sheet(&self) -> Option<Sheet> {
        if self.is_reduced { Some(sheet_of::<Reading>()) } else { self.default_arguments(None)?.sheet() }
    }

    fn run_unsettled<'a>(&'a self, context: AnyContext<'a>) -> LocalBoxFuture<'a, Outcome> {
        async move {
            let parsed = self.of(context.robot);
            let command = (*parsed).as_ref().map_err(Failure::clone)?;
            let AnyContext { robot, connection, screen, several, confirmer } = context;
            let context = AnyContext { robot, connection: &mut *connection, screen, several, confirmer };
            let report = command.run_unsettled(context).await?;
            if self.is_reduced { Ok(Box::new(Reading::new(&*report)?) as Box<_>) } else { Ok(report) }
        }
        .boxed_local()
    }
}

/// A value of any kind that was read.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Reading {
    items: Vec<ReadItem>,
    /// View of the family.
    #[serde(skip)]
    view: View,
    #[serde(skip)]
    failure: Option<Failure>,
}

/// Common fields of signals, variables, counters and the like.
#[derive(Debug, Serialize, JsonSchema)]
struct ReadItem {
    /// Name that can be typed.
    name: String,
    /// User name; null if there is none.
    label: Option<String>,
    /// Kind: `variable`, `input`, `counter`.
    kind: String,
    /// Whether the value was read.
    ok: bool,
    /// Value; null if the value was not read.
    value: Value,
    /// Reason why the value was not read.
    #[serde(skip_serializing_if = "Value::is_null")]
    #[schemars(with = "ItemError")]
    error: Value,
}

impl Reading {
    fn new(report: &dyn AnyReport) -> Result<Self> {
        let data = report.data()?;
        let text = |value: &Value| value.as_str().map(ToOwned::to_owned);
        let item = |item: &Value| ReadItem {
            name: text(&item["name"]).unwrap_or_default(),
            label: text(&item["label"]),
            kind: text(&item["kind"]).unwrap_or_default(),
            ok: item["ok"] == true,
            value: item["value"].clone(),
            error: item["error"].clone(),
        };
        let items = data["items"].as_array().into_iter().flatten().map(item).collect();
        Ok(Self { items, view: report.view(), failure: report.failure() })
    }
}

impl Report for Reading {
    fn view(&self) -> View {
        self.view.clone()
    }

    fn failure(&self) -> Option<Failure> {
        self.failure.clone()
    }
}

/// Parses the first line that is a command of a family.
fn parse_first(family: Family, lines: &[Vec<String>]) -> Parsed {
    let mut failures = Vec::new();
    for words in lines {
        match parse(family, words) {
            Ok(command) => return Ok(command),
            Err(failure) => failures.push(failure),
        }
    }
    if let [failure] = &failures[..] {
        return Err(failure.clone());
    }
    let suggestion = failures.iter().find(|failure| failure.message.contains("did you mean"));
    Err(suggestion.cloned().unwrap_or_else(|| {
        let name = lines.first().and_then(|words| words.last()).map_or("", String::as_str);
        let message = format!("'{name}' is not a signal, variable, counter or other value of {family}");
        Failure::usage(message)
            .hint("use `armctl names list` to list your names, and `armctl status --json` to see the keys of a status")
    }))
}

/// Parses words into a command of a family.
fn parse(family: Family, words: &[String]) -> Parsed {
    let face = families::of(family);
    let parser = (face.augment)(clap::Command::new(family.name())).no_binary_name(true).disable_help_flag(true);
    match parser.try_get_matches_from(words).and_then(|mut matches| (face.read)(&mut matches)) {
        Ok(FamilyLine { command: ParsedCommand::Command(command), .. }) => Ok(command),
        Ok(_) => Err(Failure::local("internal error: a shared line is a command of each family")),
        Err(error) => {
            let message = error.render().to_string();
            let first_line = message.lines().next().unwrap_or_default().trim_start_matches("error: ");
            let message = first_line
                .split_once("': ")
                .filter(|_| first_line.starts_with("invalid value"))
                .map_or(first_line, |(_, why)| why);
            Err(Failure::usage(message).hint(format!("see `armctl {family} {} -h`", words[..2].join(" "))))
        }
    }
}
