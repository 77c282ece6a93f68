//! `yerc var`: variables, one or many.

mod dump;
mod entry;
mod get;
#[cfg(test)]
mod lines;
mod overwrite;
mod part;
mod position;
mod read;
mod restore;
mod set;
mod sheet;

use std::convert::Infallible;

pub use self::entry::is_undefined;
pub use self::overwrite::confirm_raw;
pub use self::part::unlike;
pub use self::position::{PositionData, as_position, held};
use super::link::Link;
use crate::command::commands;
use crate::command::frame::watch::Watch;
use crate::controller::names::{Kind, Names};
use crate::controller::yerc::Model;
use crate::controller::yerc::variables::{Reference, VariableKind};
use crate::failure::Failure;

commands! {
    /// Commands for variables.
    pub enum Var {
        /// Read variables: B0 I1..I20 D5 R3 S2 P10 BP1 EX1
        Get(get::Get),
        /// Write variables: B0=255 R3=1.5 S7=HELLO P1=base:x=…
        Set(set::Set),
        /// List the variables that hold something
        List(get::List),
        /// Print each change of variables
        Watch(Watch<get::Get>),
        /// Save variables to a JSON or CSV file
        Dump(dump::Dump),
        /// Write variables from a dump
        Restore(restore::Restore),
    }
}

/// Selection of variables, or of all standard numbers of some kinds.
#[derive(Debug, Clone, clap::Args)]
pub struct Choice {
    /// Variables, such as B0..B199,P0..P9, or names; default: all standard numbers
    #[arg(value_name = "REF", value_delimiter = ',', value_parser = get::Named::parse)]
    variables: Vec<get::Named>,
    /// Only these kinds: B,I,D,R,S,P,BP,EX
    #[arg(long, value_name = "KINDS", value_delimiter = ',', value_parser = parse_kind, conflicts_with = "variables")]
    kinds: Vec<VariableKind>,
}

impl Choice {
    /// The variables, in their order.
    fn references(&self) -> impl Iterator<Item = Reference> {
        let is_chosen = |kind: &VariableKind| {
            *kind != VariableKind::S16
                && self.variables.is_empty()
                && (self.kinds.is_empty() || self.kinds.contains(kind))
        };
        let numbers = |kind: VariableKind| (0..=kind.last_standard()).map(move |number| Reference::new(kind, number));
        let standard = VariableKind::all().filter(is_chosen).flat_map(numbers);
        self.variables.iter().flat_map(|named| named.0.clone()).chain(standard)
    }
}

/// Variable in a confirmation: `P5`, or `P5 (HOME)` with its name.
pub fn called(names: &Names, variable: Reference) -> String {
    let address = variable.to_string();
    match names.label(Kind::Variable, &address) {
        Some(label) => format!("{address} ({label})"),
        None => address,
    }
}

/// Variable with the string form for the model and `--s16`.
fn in_form(reference: Reference, model: Model, short: bool) -> Reference {
    Reference::new(reference.kind.string_form(model, short), reference.number)
}

/// Model for the variables; the controller is asked only if there are strings.
async fn model_of(
    link: &mut Link,
    references: impl Iterator<Item = &Reference> + Clone,
    short: bool,
) -> Result<Model, Failure> {
    let form = |model| references.clone().map(|reference| in_form(*reference, model, short)).collect::<Vec<_>>();
    link.model_for(|model| Ok::<_, Infallible>(form(model))).await
}

/// Parses a kind by its letters, for `--kinds` and `--only`; strings have the 32-byte form.
fn parse_kind(letters: &str) -> Result<VariableKind, String> {
    let kinds: Vec<VariableKind> = VariableKind::all().filter(|kind| *kind != VariableKind::S16).collect();
    kinds.iter().copied().find(|kind| kind.letters().eq_ignore_ascii_case(letters)).ok_or_else(|| {
        let all: Vec<&str> = kinds.iter().map(|kind| kind.letters()).collect();
        format!("there are {}", all.join(", "))
    })
}

/// Names in the order given, with runs of a kind as `B0..B9`.
fn listed(references: impl IntoIterator<Item = Reference>) -> String {
    let mut runs: Vec<(Reference, Reference)> = Vec::new();
    for reference in references {
        match runs.last_mut() {
            Some((_, last)) if last.kind == reference.kind && last.number.checked_add(1) == Some(reference.number) => {
                *last = reference;
            }
            _ => runs.push((reference, reference)),
        }
    }
    let run = |(first, last): &(Reference, Reference)| {
        if first == last { first.to_string() } else { format!("{first}..{last}") }
    };
    runs.iter().map(run).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_named_by_their_ends() {
        let references = ["B0", "B1", "B2", "I5", "D7", "D9"].map(|text| text.parse().unwrap());
        assert_eq!(listed(references), "B0..B2, I5, D7, D9");
    }

    #[test]
    fn kinds_by_letters() {
        assert_eq!(parse_kind("s"), Ok(VariableKind::S32));
        assert_eq!(parse_kind("x"), Err("there are B, I, D, R, S, P, BP, EX".to_owned()));
    }
}
