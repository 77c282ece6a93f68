//! Dry run of a YRCX client.

use armctl_controller::Risk;
use armctl_controller::yrcx::describe;
use armctl_controller::yrcx::image::COMMAND_WORDS;
use armctl_controller::yrcx::order::Order;
use armctl_controller::yrcx::procedure::{Procedure, Step};
use serde_json::{Value, json};

use super::{Client, Transport};
use crate::plan::{ReadableField, merge_fields, with_fields};
use crate::{Plan, Reason};

impl Client {
    /// Whether this is a dry run.
    pub fn is_dry_run(&self) -> bool {
        matches!(self.transport, Transport::DryRun(_))
    }

    /// Returns the plan so far and clears it.
    pub fn take_plan(&mut self) -> Plan {
        self.plan_mut().map(std::mem::take).unwrap_or_default()
    }

    /// Dry run: plans an order that depends on earlier answers.
    pub fn plan(&mut self, order: &Order, about: &str) {
        self.plan_order(order, Reason::about(about));
    }

    /// Dry run: plans an order that depends on an earlier answer. `other` is the order after a different answer. Words
    /// that differ are shown as unknown.
    pub fn plan_depending(&mut self, order: &Order, other: &Order, reason: Reason<'_>) {
        let word = |(one, other): (&u16, &u16)| if one == other { format!("0x{one:04X}") } else { "?".to_owned() };
        let words: Vec<String> = order.words().iter().zip(other.words()).map(word).collect();
        let fields = merge_fields(fields(order), &fields(other));
        self.plan_frame(with_fields(json!({ "wi": words }), &fields), reason);
    }

    /// Dry run: plans a frame to the fieldbus device instead of the controller.
    pub fn plan_frame(&mut self, frame: Value, reason: Reason<'_>) {
        if let Some(plan) = self.plan_mut() {
            plan.note(frame, reason);
        }
    }

    /// Dry run: adds the planned action for a file or a part of a long task.
    pub fn plan_item(&mut self, item: Value) {
        if let Some(plan) = self.plan_mut() {
            plan.items.push(item);
        }
    }

    /// Dry run: describes later steps whose frames are not known yet.
    pub fn then(&mut self, what: &str) {
        if let Some(plan) = self.plan_mut() {
            plan.then(what);
        }
    }

    pub(super) fn plan_mut(&mut self) -> Option<&mut Plan> {
        match &mut self.transport {
            Transport::DryRun(plan) => Some(plan),
            Transport::Image(_) | Transport::Nothing => None,
        }
    }

    pub(super) fn plan_order(&mut self, order: &Order, reason: Reason<'_>) {
        self.plan_frame(with_fields(json!({ "wi": hex(order.words()) }), &fields(order)), reason);
    }

    /// Plans the image of each step of a procedure.
    pub(super) fn plan_steps(&mut self, procedure: &Procedure) {
        let Transport::DryRun(plan) = &mut self.transport else { return };
        let image = &mut self.output.next;
        for step in &procedure.steps {
            let (signal, on) = match *step {
                Step::Set { signal, on } => (signal, on),
                Step::Rise(signal) => (signal, true),
                Step::Require { .. } | Step::Await { .. } => continue,
            };
            let is_already_set = signal.is_on(image) == on;
            signal.set(image, on);
            let [now, before] = if on { ["on", "off"] } else { ["off", "on"] };
            let about = format!("{} {now}", signal.named());
            let depends_on = format!("the earlier signals: sent only if {} is {before}", signal.name());
            let reason = Reason::about(&about);
            let reason = if is_already_set { reason.depending_on(&depends_on) } else { reason };
            plan.note(json!({ "bits": hex(&image.0[COMMAND_WORDS..]) }), reason);
        }
    }
}

/// Returns the readable fields of a motion order, without absent fields.
fn fields(order: &Order) -> Vec<ReadableField> {
    if order.risk() < Risk::Motion {
        return Vec::new();
    }
    let notes = describe::command(order.words()).fields.into_iter();
    notes.filter(|note| !note.meaning.starts_with("none")).map(|note| (note.name, note.meaning)).collect()
}

/// Formats words as text, for example `0x0604`.
#[doc(hidden)]
pub fn hex(words: &[u16]) -> Vec<String> {
    words.iter().map(|word| format!("0x{word:04X}")).collect()
}
