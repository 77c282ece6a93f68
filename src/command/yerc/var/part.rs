//! Single words of a position variable (P): the manuals list no request that writes one alone, so the position is read,
//! changed and written back as a whole (3.3.16, service 0x02).

use std::collections::BTreeMap;

use crate::command::frame::dry_run::Reason;
use crate::command::yerc::each::Denied;
use crate::command::yerc::link::Link;
use crate::command::yerc::orders::usage;
use crate::command::yerc::var::entry::is_undefined;
use crate::controller::yerc::payload::{Axes, ExtendedForm, Form, MAX_AXES, Position, PositionKind};
use crate::controller::yerc::query::{Query as _, ReadVariable, WriteVariable};
use crate::controller::yerc::variables::{Reference, Value};
use crate::failure::{Failure, Kind};

/// A word of a position that can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Word {
    /// Tool number.
    Tool(u32),
    /// User coordinate number.
    User(u32),
    /// An axis, counted from 0, in steps of the wire.
    Axis(usize, i32),
}

impl Word {
    /// Its place, counted from 1, the type.
    pub fn attribute(self) -> u8 {
        match self {
            Self::Tool(_) => 3,
            Self::User(_) => 4,
            Self::Axis(axis, _) => u8::try_from(axis).map_or(u8::MAX, |axis| axis.saturating_add(6)),
        }
    }

    /// As it is typed.
    pub fn name(self) -> String {
        match self {
            Self::Tool(_) => "tool".to_owned(),
            Self::User(_) => "user".to_owned(),
            Self::Axis(axis, _) => format!("axis{}", axis + 1),
        }
    }

    /// The value to write.
    pub fn value(self) -> i64 {
        match self {
            Self::Tool(value) | Self::User(value) => value.into(),
            Self::Axis(_, value) => value.into(),
        }
    }

    /// The value that a position has there.
    pub fn old(self, position: &Position) -> i64 {
        match self {
            Self::Tool(_) => position.tool.into(),
            Self::User(_) => position.user.into(),
            Self::Axis(axis, _) => position.axes.padded().get(axis).copied().unwrap_or_default().into(),
        }
    }

    /// Writes it into a position.
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

/// The words to write of each position.
pub type Words = BTreeMap<Reference, Vec<Word>>;

/// Reads the positions, and says how each is before and after; nothing is written yet.
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
            let is_undefined = is_undefined(&Denied::Refused(refusal));
            let failure = wrong(refusal.into());
            Err(if is_undefined {
                failure.hint(format!("there is nothing yet to change a word of: write it whole, {reference}=pulse:…"))
            } else {
                failure
            })
        }
    }
}

/// Notes in a dry run what is read, and `then` what is written.
pub fn plan_reads(link: &mut Link, words: &Words) {
    for reference in words.keys() {
        let question = ReadVariable::new(reference.kind, reference.number);
        link.plan(&question.request(), &format!("reads {reference}"));
    }
}

/// Notes in a dry run the positions that are written back; words that were not named are not known.
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
            format!("writes {reference} with {}; words that are not named keep what was read", named.join(", "));
        let reason = Reason::about(&about).depending_on("what was read");
        link.plan_depending(&write(one)?.request(), &write(other)?.request(), reason);
    }
    Ok(())
}

/// Two positions of which no byte is the same: to show in a dry run what is known of one.
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
