//! What a dry run notes instead of sending it.

use armctl_controller::Risk;
use armctl_controller::yrcx::describe;
use armctl_controller::yrcx::image::COMMAND_WORDS;
use armctl_controller::yrcx::order::Order;
use armctl_controller::yrcx::procedure::{Procedure, Step};
use serde_json::{Value, json};

use super::{Client, Error, Transport};
use crate::plan::{FieldInWords, in_common, with_fields};
use crate::{Plan, Reason};

impl Client {
    /// Whether nothing is sent, only noted.
    pub fn is_dry(&self) -> bool {
        matches!(self.transport, Transport::Notes(_))
    }

    /// What was noted in a dry run so far.
    pub fn take_plan(&mut self) -> Plan {
        self.notes().map(std::mem::take).unwrap_or_default()
    }

    /// In a dry run, notes all the questions, whose answers are not known then.
    ///
    /// # Errors
    /// [`Error::NotKnown`], in a dry run.
    pub fn plan_all(&mut self, orders: &[Order]) -> Result<(), Error> {
        if !self.is_dry() || orders.is_empty() {
            return Ok(());
        }
        for order in orders {
            self.note(order, Reason::default());
        }
        Err(Error::NotKnown)
    }

    /// Notes in a dry run an order that depends on answers.
    pub fn plan(&mut self, order: &Order, about: &str) {
        self.note(order, Reason::about(about));
    }

    /// Notes in a dry run an order whose words, or whose sending, an answer before it decides. `other` is the same order
    /// with other answers: where both differ nothing is known.
    pub fn plan_depending(&mut self, order: &Order, other: &Order, reason: Reason<'_>) {
        let word = |(one, other): (&u16, &u16)| if one == other { format!("0x{one:04X}") } else { "?".to_owned() };
        let words: Vec<String> = order.words().iter().zip(other.words()).map(word).collect();
        let fields = in_common(fields(order), &fields(other));
        self.plan_frame(with_fields(json!({ "wi": words }), &fields), reason);
    }

    /// Notes in a dry run what goes to the device on the fieldbus and not to the controller.
    pub fn plan_frame(&mut self, frame: Value, reason: Reason<'_>) {
        if let Some(plan) = self.notes() {
            plan.note(frame, reason);
        }
    }

    /// Says in a dry run what would be done with a file or a part.
    pub fn plan_item(&mut self, item: Value) {
        if let Some(plan) = self.notes() {
            plan.items.push(item);
        }
    }

    /// Says in a dry run what follows that cannot be shown.
    pub fn then(&mut self, what: &str) {
        if let Some(plan) = self.notes() {
            plan.then(what);
        }
    }

    pub(super) fn notes(&mut self) -> Option<&mut Plan> {
        match &mut self.transport {
            Transport::Notes(plan) => Some(plan),
            Transport::Image(_) | Transport::Nothing => None,
        }
    }

    pub(super) fn note(&mut self, order: &Order, reason: Reason<'_>) {
        self.plan_frame(with_fields(json!({ "wi": hex(order.words()) }), &fields(order)), reason);
    }

    /// Notes what each edge of a procedure shows.
    pub(super) fn note_steps(&mut self, procedure: &Procedure) {
        let Transport::Notes(plan) = &mut self.transport else { return };
        let image = &mut self.output.next;
        for step in &procedure.steps {
            let (signal, on) = match *step {
                Step::Set { signal, on } => (signal, on),
                Step::Rise(signal) => (signal, true),
                Step::Require { .. } | Step::Await { .. } => continue,
            };
            let is_there = signal.is_on(image) == on;
            signal.set(image, on);
            let [now, before] = if on { ["on", "off"] } else { ["off", "on"] };
            let about = format!("{} {now}", signal.named());
            let depends_on = format!("what is shown before it: it is sent if {} is {before}", signal.name());
            let reason = Reason::about(&about);
            let reason = if is_there { reason.depending_on(&depends_on) } else { reason };
            plan.note(json!({ "bits": hex(&image.0[COMMAND_WORDS..]) }), reason);
        }
    }
}

/// What an order that moves something says, in words. What is not said is left out.
fn fields(order: &Order) -> Vec<FieldInWords> {
    if order.risk() < Risk::Motion {
        return Vec::new();
    }
    let notes = describe::command(order.words()).fields.into_iter();
    notes.filter(|note| !note.meaning.starts_with("none")).map(|note| (note.name, note.meaning)).collect()
}

/// Words as they are written: `0x0604`.
pub fn hex(words: &[u16]) -> Vec<String> {
    words.iter().map(|word| format!("0x{word:04X}")).collect()
}
