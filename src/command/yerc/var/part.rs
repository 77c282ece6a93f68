//! Single words of a position variable (P). The manuals list no request that writes one word, so the position is
//! read, changed and written back completely (3.3.16, service 0x02).

use std::collections::BTreeMap;

use crate::command::frame::dry_run::Reason;
use crate::command::yerc::each::ReadError;
use crate::command::yerc::link::Link;
use crate::command::yerc::orders::usage;
use crate::command::yerc::var::entry::is_undefined;
use crate::controller::yerc::payload::{Axes, ExtendedForm, Form, MAX_AXES, Position, PositionKind};
use crate::controller::yerc::query::{Query as _, ReadVariable, WriteVariable};
use crate::controller::yerc::variables::{Reference, Value};
use crate::failure::{Failure, Kind};

/// A writable word of a position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Word {
    /// Tool number.
    Tool(u32),
    /// User coordinate number.
    User(u32),
    /// Axis (starting with 0) and value in protocol steps.
    Axis(usize, i32),
}

impl Word {
    /// Attribute: its index starting with 1, the type.
    pub fn attribute(self) -> u8 {
        match self {
            Self::Tool(_) => 3,
            Self::User(_) => 4,
            Self::Axis(axis, _) => u8::try_from(axis).map_or(u8::MAX, |axis| axis.saturating_add(6)),
        }
    }

    /// Name as typed.
    pub fn name(self) -> String {
        match self {
            Self::Tool(_) => "tool".to_owned(),
            Self::User(_) => "user".to_owned(),
            Self::Axis(axis, _) => format!("axis{}", axis + 1),
        }
    }

    /// Value to write.
    pub fn value(self) -> i64 {
        match self {
            Self::Tool(value) | Self::User(value) => value.into(),
            Self::Axis(_, value) => value.into(),
        }
    }

    /// Current value in a position.
    pub fn old(self, position: &Position) -> i64 {
        match self {
            Self::Tool(_) => position.tool.into(),
            Self::User(_) => position.user.into(),
            Self::Axis(axis, _) => position.axes.padded().get(axis).copied().unwrap_or_default().into(),
        }
    }

    /// Sets the word in a position.
    pub fn set(self, position: &mut Position) {
        match self {
            Self::Tool(tool) => position.tool = tool,
            Self::User(user) => position.user = user,
            Self::Axis(axis, value) => {
                let mut values: [i32; MAX_AXES] = position.axes.padded();
                if let Some(word) = values.get_mut(axis) {
                    *word = value;
                }
                position.axes = Axes::full(values);
            }
        }
    }
}

/// Words to write for each position.
pub type Words = BTreeMap<Reference, Vec<Word>>;

/// Reads the positions. Returns each before and after the change; nothing is written yet.
pub async fn changed(link: &mut Link, words: &Words) -> Result<Vec<(Reference, Position, Position)>, Failure> {
    let mut changed = Vec::with_capacity(words.len());
    for (reference, words) in words {
        let old = read(link, *reference).await?;
        let mut position = old;
        for word in words {
            word.set(&mut position);
        }
        changed.push((*reference, old, position));
    }
    Ok(changed)
}

async fn read(link: &mut Link, reference: Reference) -> Result<Position, Failure> {
    let wrong = |failure: Failure| {
        let message = format!("{reference}: {}; nothing was written", failure.message.trim_end_matches('.'));
        Failure { message, ..failure }
    };
    match link.try_ask(&ReadVariable::new(reference.kind, reference.number)).await.map_err(wrong)? {
        Ok(Value::Position(position)) => Ok(position),
        Ok(_) => Err(wrong(Failure::new(Kind::Malformed, "the answer is not a position"))),
        Err(refusal) => {
            let is_undefined = is_undefined(&ReadError::Refused(refusal));
            let failure = wrong(refusal.into());
            Err(if is_undefined {
                failure.hint(format!("the position is undefined: write all of it, {reference}=pulse:…"))
            } else {
                failure
            })
        }
    }
}

/// Notes in a dry run the reads of the positions.
pub fn plan_reads(link: &mut Link, words: &Words) {
    for reference in words.keys() {
        let question = ReadVariable::new(reference.kind, reference.number);
        link.plan(&question.request(), &format!("reads {reference}"));
    }
}

/// Notes in a dry run the positions that are written back; unnamed words are unknown.
pub fn plan_writes(link: &mut Link, words: &Words) -> Result<(), Failure> {
    for (reference, words) in words {
        let write = |mut position: Position| {
            for word in words {
                word.set(&mut position);
            }
            WriteVariable::new(reference.number, Value::Position(position)).map_err(usage)
        };
        let [one, other] = unlike();
        let named: Vec<String> = words.iter().map(|word| format!("{}={}", word.name(), word.value())).collect();
        let about =
            format!("writes {reference} with {}; the other words keep the values that were read", named.join(", "));
        let reason = Reason::about(&about).depending_on("the values that were read");
        link.plan_depending(&write(one)?.request(), &write(other)?.request(), reason);
    }
    Ok(())
}

/// Two positions that differ in every byte, to show in a dry run the known part of one.
pub fn unlike() -> [Position; 2] {
    let position = |kind, word: u32, axis| Position {
        kind,
        form: Form(word),
        tool: word,
        user: word,
        extended: ExtendedForm(word),
        axes: Axes::full([axis; MAX_AXES]),
    };
    [position(PositionKind::Pulse, 0, 0), position(PositionKind::Base, u32::MAX, -1)]
}
