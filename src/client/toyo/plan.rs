//! Dry run of a Toyo client.

use armctl_controller::Risk;
use armctl_controller::toyo::describe::{Sender, describe};
use armctl_controller::toyo::request::Request;
use armctl_controller::toyo::table::commands::Row;
use serde_json::{Value, json};

use super::{Client, Error, Transport};
use crate::plan::with_fields;
use crate::{Plan, Reason};

impl Client {
    /// Whether this is a dry run.
    pub fn is_dry_run(&self) -> bool {
        matches!(self.transport, Transport::DryRun(_))
    }

    /// Returns the plan so far, and clears it. The plan includes the frames that the client would send when it closes.
    pub fn take_plan(&mut self) -> Plan {
        self.plan_end();
        self.transport.notes().map(std::mem::take).unwrap_or_default()
    }

    /// Dry run: plans reads. In a dry run, their answers stay unknown.
    pub fn plan_all(&mut self, requests: &[Request]) -> Result<(), Error> {
        if !self.is_dry_run() || requests.is_empty() {
            return Ok(());
        }
        for request in requests {
            self.note(request, Reason::default());
        }
        Err(Error::DryRun)
    }

    /// Dry run: plans a request with its purpose.
    pub fn plan(&mut self, request: &Request, about: &str) {
        self.note(request, Reason::about(about));
    }

    /// Dry run: plans a request that is sent only after a certain answer.
    pub fn plan_if(&mut self, request: &Request, on: &str) {
        self.note(request, Reason::default().depending_on(on));
    }

    /// Dry run: plans a block that depends on an earlier answer. Either a part of the block depends on the answer and
    /// is written as `?`, or the answer decides whether the block is sent.
    pub fn plan_depending(&mut self, text: &str, reason: Reason<'_>) {
        if !self.is_dry_run() {
            return;
        }
        self.note_text(text, reason);
        let word = text.trim_start_matches('@').split(' ').next().unwrap_or_default();
        self.is_fenced = Row::named(word).is_some_and(|row| row.risk == Risk::Read);
        self.plan_condition = reason.depends_on.map(ToOwned::to_owned);
    }

    /// Dry run: plans an order that depends on an earlier answer, with the host switch and the fence before it.
    pub async fn plan_order(&mut self, text: &str, on: &str) -> Result<(), Error> {
        self.take_host().await?;
        self.fence().await?;
        self.plan_depending(text, Reason::default().depending_on(on));
        Ok(())
    }

    /// Dry run: adds the planned action for a file or a part of a long task.
    pub fn plan_item(&mut self, item: Value) {
        if let Some(plan) = self.transport.notes() {
            plan.items.push(item);
        }
    }

    /// Dry run: describes later steps whose frames are not known yet.
    pub fn then(&mut self, what: &str) {
        if let Some(plan) = self.transport.notes() {
            plan.then(what);
        }
    }

    pub(super) fn note(&mut self, request: &Request, reason: Reason<'_>) {
        self.plan_depending(&request.text(), reason);
    }

    pub(super) fn note_text(&mut self, text: &str, reason: Reason<'_>) {
        if let Some(plan) = self.transport.notes() {
            let word = text.trim_start_matches('@').split(' ').next().unwrap_or_default();
            let moves = Row::named(word).is_some_and(|row| row.risk == Risk::Motion) && !text.contains('?');
            let notes = if moves { describe(text, Sender::Host, None).fields } else { Vec::new() };
            let fields: Vec<_> = notes
                .into_iter()
                .filter(|note| note.name != "command")
                .map(|note| (note.name.to_owned(), note.meaning))
                .collect();
            plan.note(with_fields(json!({ "text": text }), &fields), reason);
        }
    }
}
