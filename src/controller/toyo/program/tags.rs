//! Resolution of labels to tags. Each tag must be defined exactly once.

use std::collections::hash_map::Entry;
use std::collections::{BTreeSet, HashMap};

use super::instruction::{Draft, Target};
use super::reader::{LabelDefinition, ParsedLines};
use super::{Label, Part, Program, Step};
use crate::findings::{Findings, Rule, SourceLocation};
use crate::similar_word::nearest;
use crate::toyo::field::Value;
use crate::toyo::table::Op;

/// A program with the positions of its steps.
pub(super) struct Resolved {
    pub program: Program,
    pub places: Vec<SourceLocation>,
}

const MAX_TAG: usize = 999;

/// Assigns tags to labels, and to the steps that use the labels. The result is a valid program only if there are no
/// errors.
pub(super) fn resolve(read: ParsedLines, part: Option<&Part>, findings: &mut Findings) -> Resolved {
    let mut tags = Tags { part, ..Tags::default() };
    tags.collect_labels(&read.labels, findings);
    tags.assign_tags(&read, findings);
    tags.collect_positions(&read.steps, findings);
    let places = read.steps.iter().map(|draft| draft.at).collect();
    let steps = read.steps.into_iter().filter_map(|draft| tags.resolve_step(draft, findings)).collect();
    if findings.errors() == 0 {
        tags.report_unused(findings);
    }
    let first = part.map_or(1, |part| part.first);
    let labels = tags.list.into_iter().map(|label| label.label(first)).collect();
    Resolved { program: Program { steps, labels }, places }
}

#[derive(Default)]
struct Tags<'p> {
    /// Labels in text order.
    list: Vec<LabelState>,
    /// Index by lower-case name.
    by_name: HashMap<String, usize>,
    /// Position of each tag definition; tag 0 does not exist.
    defined: Vec<Option<SourceLocation>>,
    /// The part that the text belongs to.
    part: Option<&'p Part>,
}

struct LabelState {
    name: String,
    at: SourceLocation,
    step: usize,
    tag: i32,
    has_explicit_tag: bool,
    used: bool,
}

impl LabelState {
    fn label(self, first: usize) -> Label {
        Label { name: self.name, tag: self.tag, step: self.step + first, line: self.at.line }
    }
}

impl Tags<'_> {
    /// Collects the labels; each must be unique.
    fn collect_labels(&mut self, labels: &[LabelDefinition], findings: &mut Findings) {
        for label in labels {
            match self.by_name.entry(label.name.to_lowercase()) {
                Entry::Occupied(other) => {
                    let line = self.list[*other.get()].at.line;
                    findings.error(label.at, format!("label {} already exists in line {line}", label.name), None);
                    continue;
                }
                Entry::Vacant(free) => free.insert(self.list.len()),
            };
            self.list.push(LabelState {
                name: label.name.clone(),
                at: label.at,
                step: label.step,
                tag: label.tag.unwrap_or_default(),
                has_explicit_tag: label.tag.is_some(),
                used: false,
            });
        }
    }

    /// Assigns a tag number to each label that has no number. The assigned numbers begin at 1, without the numbers that
    /// occur in the file.
    fn assign_tags(&mut self, read: &ParsedLines, findings: &mut Findings) {
        let mut taken = vec![false; MAX_TAG + 1];
        let uses = read.steps.iter().flat_map(|draft| &draft.tags);
        let named = uses.filter_map(|used| if let Target::Number(tag) = used.target { Some(tag) } else { None });
        let explicit_tags = self.list.iter().filter(|label| label.has_explicit_tag).map(|label| label.tag);
        for tag in named.chain(explicit_tags).chain(self.outside_tags().iter().flat_map(|tags| tags.iter().copied())) {
            if let Some(taken) = usize::try_from(tag).ok().and_then(|tag| taken.get_mut(tag)) {
                *taken = true;
            }
        }
        let mut free = (1_i32..).zip(&taken[1..]).filter(|(_, taken)| !**taken).map(|(tag, _)| tag);
        for label in self.list.iter_mut().filter(|label| !label.has_explicit_tag) {
            if let Some(tag) = free.next() {
                label.tag = tag;
            } else {
                let message = format!("no free tag for label {}; all {MAX_TAG} are in use", label.name);
                findings.error(label.at, message, None);
                return;
            }
        }
    }

    /// Collects the positions of the tags. Each tag must be unique.
    fn collect_positions(&mut self, steps: &[Draft], findings: &mut Findings) {
        self.defined = vec![None; MAX_TAG + 1];
        for draft in steps.iter().filter(|draft| draft.instruction.op == Op::Tag) {
            let Some(used) = draft.tags.first() else { continue };
            let Some(tag) = self.tag_of(&used.target) else { continue };
            // A duplicate label was already reported.
            if self.label_of(&used.target).is_some_and(|label| label.at != draft.at) {
                continue;
            }
            if self.outside_tags().is_some_and(|tags| tags.contains(&tag)) {
                let message = format!("tag {tag:03} already exists in a step before or after the steps of this file");
                findings.error(used.at, message, Some("a controller stops with error A2".to_owned()));
            }
            let Some(place) = usize::try_from(tag).ok().and_then(|tag| self.defined.get_mut(tag)) else { continue };
            match place {
                Some(first) => {
                    let message = format!("tag {tag:03} already exists in line {}", first.line);
                    findings.error(used.at, message, Some("a controller stops with error A2".to_owned()));
                }
                None => *place = Some(draft.at),
            }
        }
    }

    /// Inserts the tags of a step. Reports an undefined label.
    fn resolve_step(&mut self, draft: Draft, findings: &mut Findings) -> Option<Step> {
        let Draft { instruction, mut values, tags, at } = draft;
        for used in tags {
            let Some(tag) = self.tag_of(&used.target) else {
                if let Target::Label(name) = &used.target {
                    let names = self.list.iter().map(|label| label.name.as_str());
                    let near = if findings.is_full() { None } else { nearest(name, names) };
                    let hint = near.map(|near| format!("did you mean {near}?"));
                    findings.error_of(Rule::MissingLabel, used.at, format!("unknown label '{name}'"), hint);
                }
                continue;
            };
            if instruction.op != Op::Tag {
                self.check_jump(tag, &used.target, used.at, findings);
            }
            if let Some(value) = values.get_mut(used.index) {
                *value = Value::Number(tag);
            }
        }
        Some(Step { instruction, record: instruction.layout.record(values).ok()?, line: at.line })
    }

    /// Marks the label of a jump as used. For a jump to a number, checks that the tag exists.
    fn check_jump(&mut self, tag: i32, target: &Target, at: SourceLocation, findings: &mut Findings) {
        match target {
            Target::Label(name) => {
                if let Some(index) = self.by_name.get(&name.to_lowercase()) {
                    self.list[*index].used = true;
                }
            }
            Target::Number(_) => {
                let place = usize::try_from(tag).ok().and_then(|tag| self.defined.get(tag));
                let is_outside =
                    self.part.is_some_and(|part| part.tags.as_ref().is_none_or(|tags| tags.contains(&tag)));
                if !place.is_some_and(Option::is_some) && !is_outside {
                    let hint = Some("a controller stops with error A1".to_owned());
                    findings.error_of(Rule::MissingLabel, at, format!("the program has no tag {tag:03}"), hint);
                }
            }
        }
    }

    /// The tags outside the part, if they are known.
    fn outside_tags(&self) -> Option<&BTreeSet<i32>> {
        self.part.and_then(|part| part.tags.as_ref())
    }

    fn tag_of(&self, target: &Target) -> Option<i32> {
        match target {
            Target::Number(tag) => Some(*tag),
            Target::Label(_) => self.label_of(target).map(|label| label.tag),
        }
    }

    fn label_of(&self, target: &Target) -> Option<&LabelState> {
        let Target::Label(name) = target else { return None };
        self.by_name.get(&name.to_lowercase()).map(|index| &self.list[*index])
    }

    /// Reports unused labels. A label with an explicit number is not reported, because another program may use this
    /// number.
    fn report_unused(&self, findings: &mut Findings) {
        for label in self.list.iter().filter(|label| !label.used && !label.has_explicit_tag) {
            let hint = format!(
                "if another program uses the tag of this label, write the tag after the label, such as {}=10:",
                label.name
            );
            findings.warning(Rule::UnusedLabel, label.at, format!("no step jumps to label {}", label.name), Some(hint));
        }
    }
}
