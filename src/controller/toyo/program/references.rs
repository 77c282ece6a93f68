//! What the steps of a program refer to.

use super::{Program, Step};
use crate::references::{Reference, Role};
use crate::toyo::field::{Form, Value};
use crate::toyo::layout::Record;
use crate::toyo::names;
use crate::toyo::table::Op;

impl Program {
    /// Line of each step, with what the step refers to. Tags have the name of their label, or `TAG=005`. Ports have
    /// names such as `OUT1`, and their bits names such as `OUT1.3`. Table rows have names such as `T2.5`.
    pub fn references(&self) -> impl Iterator<Item = (usize, Vec<Reference>)> {
        self.steps.iter().map(|step| {
            let found = self.references_of(step).into_iter();
            (step.line, found.map(|(role, name)| Reference { role, name, column: 1 }).collect())
        })
    }

    fn references_of(&self, step: &Step) -> Vec<(Role, String)> {
        let (op, record) = (step.instruction.op, &step.record);
        let mut found = Vec::new();
        for name in ["tag", "then", "else"] {
            found.extend(record.number(name).map(|tag| (role_of_tag(op), self.tag_name(tag))));
        }
        if op == Op::Tstr {
            found.extend(record.number("task").map(|task| (Role::Start, format!("program-{task}"))));
        }
        for (field, value) in record.pairs() {
            let Value::Number(number) = value else { continue };
            let address = names::of_field(field.name).and_then(|(kind, _)| names::address_of(kind, *number));
            found.extend(address.filter(|_| *number > 0).map(|address| (role_of_value(op, field.name), address)));
        }
        let rows = super::uses(std::slice::from_ref(record)).into_iter();
        found.extend(rows.filter(|(_, row)| *row > 0).map(|(table, row)| (Role::Read, format!("{table}.{row}"))));
        found.extend(ports(op, record));
        found
    }

    /// Name of a tag: its label, or `TAG=005`.
    pub fn tag_name(&self, tag: i32) -> String {
        let label = self.labels.iter().find(|label| label.tag == tag);
        label.map_or_else(|| format!("TAG={tag:03}"), |label| label.name.clone())
    }
}

fn role_of_tag(op: Op) -> Role {
    match op {
        Op::Tag => Role::Label,
        Op::Cal | Op::Calc | Op::Cali | Op::Calt => Role::Call,
        _ => Role::Jump,
    }
}

fn role_of_value(op: Op, field: &str) -> Role {
    match (op, field) {
        (Op::Cnt | Op::Inpc, "counter") | (Op::Timp, _) => Role::Write,
        (Op::CntPlus | Op::CntMinus, _) => Role::Update,
        _ => Role::Read,
    }
}

/// Port of a step, and its bits.
fn ports(op: Op, record: &Record) -> Vec<(Role, String)> {
    let (role, word) = match op {
        Op::Out | Op::Outp | Op::Outs | Op::Outc => (Role::Write, "OUT"),
        Op::In | Op::Inpc | Op::Cali | Op::Jmpi => (Role::Read, "IN"),
        Op::Iout => (Role::Write, "INT"),
        Op::Insp => (Role::Read, "INT"),
        _ => return Vec::new(),
    };
    let Some(port) = record.number("port") else { return Vec::new() };
    let station = record.number("station").filter(|station| *station > 0);
    let name = station.map_or_else(|| format!("{word}{port}"), |station| format!("STN{station}.{word}{port}"));
    let mut found = vec![(role, name.clone())];
    let mask = record.pairs().find(|(field, _)| matches!(field.form, Form::Mask));
    let mask = mask.map(|(field, value)| field.written(value)).unwrap_or_default();
    let bits = (1..).zip(mask.chars().rev()).filter(|(_, bit)| *bit != '.');
    found.extend(bits.map(|(bit, _): (u8, char)| (role, format!("{name}.{bit}"))));
    found
}

/// Name under which the steps refer to an object that a user typed: an address (`CN5`, `PT12`, `OUT1.3`), a port
/// (`OUT1`), a table row (`T2.5`), a tag (`TAG=5`), or a label.
pub fn name_of(text: &str) -> String {
    let upper = text.trim().to_ascii_uppercase();
    if let Some((_, address)) = (names::GRAMMAR.address)(&upper) {
        return address;
    }
    let tag = upper.strip_prefix("TAG").map(|tag| tag.trim_start_matches('='));
    if let Some(tag) = tag.and_then(|tag| tag.parse::<u16>().ok()) {
        return format!("TAG={tag:03}");
    }
    if names::GRAMMAR.is_shaped(&upper) || upper.starts_with("STN") || is_row(&upper) { upper } else { text.to_owned() }
}

/// Whether a text has the form of a table row, such as `T2.5`.
fn is_row(text: &str) -> bool {
    text.strip_prefix('T').is_some_and(|rest| rest.contains('.') && rest.starts_with(|c: char| c.is_ascii_digit()))
}
