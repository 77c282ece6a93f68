//! Dry run of a Yaskawa client.

use armctl_controller::Risk;
use armctl_controller::text::hex;
use armctl_controller::yerc::describe::{Sender, describe};
use armctl_controller::yerc::files::{ack_frame, data_frame};
use armctl_controller::yerc::query::Query;
use armctl_controller::yerc::request::Request;
use armctl_controller::yerc::wire::{HEADER_LEN, LAST_BLOCK, MAX_DATA};
use serde_json::{Value, json};

use super::{Client, Error, Transport};
use crate::plan::{ReadableField, merge_fields, with_fields};
use crate::{NotAuthorized, Plan, Reason};

impl Client {
    /// Whether this is a dry run.
    pub fn is_dry_run(&self) -> bool {
        matches!(self.transport, Transport::DryRun(_))
    }

    /// Returns the plan so far and clears it.
    pub fn take_plan(&mut self) -> Plan {
        self.transport.notes().map(std::mem::take).unwrap_or_default()
    }

    /// Dry run: sets the purpose of the next request.
    pub fn for_purpose(&mut self, purpose: &'static str) -> &mut Self {
        self.purpose = self.is_dry_run().then_some(purpose);
        self
    }

    /// Dry run: returns the purpose of the next request and clears it.
    pub fn take_purpose(&mut self) -> Option<&'static str> {
        self.purpose.take()
    }

    /// Dry run: plans reads. In a dry run, their answers stay unknown.
    pub fn plan_all<Q: Query>(&mut self, queries: &[Q]) -> Result<(), Error> {
        if !self.is_dry_run() || queries.is_empty() {
            return Ok(());
        }
        queries.iter().try_for_each(|query| self.plan_next(&query.request()))?;
        Err(Error::DryRun)
    }

    /// Dry run: plans a request that does not depend on earlier answers.
    pub fn plan_next(&mut self, request: &Request) -> Result<(), NotAuthorized> {
        self.authorize(request)?;
        self.plan_request(request, Reason::default());
        Ok(())
    }

    /// Dry run: plans a request that is sent after an answer, with its purpose.
    pub fn plan(&mut self, request: &Request, about: &str) {
        self.plan_request(request, Reason::about(about));
    }

    /// Dry run: plans a request that is sent only after a certain answer.
    pub fn plan_if(&mut self, request: &Request, reason: Reason<'_>) {
        self.plan_request(request, reason);
    }

    /// Dry run: plans a request that depends on an earlier answer. `other` is the request after a different answer. The
    /// plan shows `??` for bytes that differ.
    pub fn plan_depending(&mut self, request: &Request, other: &Request, reason: Reason<'_>) {
        let id = self.ids.next_id();
        let (frame, other_frame) = (request.frame(id), other.frame(id));
        let fields = merge_fields(fields(request, &frame), &fields(other, &other_frame));
        let depends_on = self.depends_on(reason);
        let reason = Reason { depends_on: depends_on.as_deref(), ..reason };
        if let Some(plan) = self.transport.notes() {
            plan.note(with_fields(json!({ "hex": mask_differences(&frame, &other_frame) }), &fields), reason);
        }
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

    /// Dry run: plans [`Client::download`] as the request and one ACK. The ACK is only an example: the number of blocks
    /// is unknown, and the first block may also be the last block or have number 0.
    pub fn plan_download(&mut self, request: &Request, reason: Reason<'_>) -> Result<(), NotAuthorized> {
        self.authorize(request)?;
        let id = self.plan_request(request, reason);
        let blocks = "the received blocks";
        let depends_on = reason.depends_on.map_or(blocks.to_owned(), |before| format!("{before}, and {blocks}"));
        let reason = Reason::about("acknowledges block 1; likewise for each block until the last one");
        let [first, last] = [1, LAST_BLOCK].map(|block| ack_frame(id, request.service, block));
        self.plan_masked(&first, &last, reason.depending_on(&depends_on));
        Ok(())
    }

    /// Dry run: plans [`Client::upload`]: the request and all blocks.
    pub fn plan_upload<E: From<NotAuthorized>>(
        &mut self,
        request: &Request,
        reason: Reason<'_>,
        mut give: impl FnMut() -> Result<Vec<u8>, E>,
    ) -> Result<(), E> {
        self.authorize(request)?;
        let id = self.plan_request(request, reason);
        let mut content = Vec::new();
        loop {
            let piece = give()?;
            if piece.is_empty() {
                break;
            }
            content.extend(piece);
        }
        self.plan_blocks(id, reason.depends_on, &content);
        Ok(())
    }

    fn plan_request(&mut self, request: &Request, reason: Reason<'_>) -> u8 {
        let id = self.ids.next_id();
        let depends_on = self.depends_on(reason);
        let reason = Reason { about: reason.about.or(self.purpose.take()), depends_on: depends_on.as_deref() };
        if let Some(plan) = self.transport.notes() {
            let frame = request.frame(id);
            plan.note(with_fields(json!({ "hex": hex(&frame) }), &fields(request, &frame)), reason);
        }
        id
    }

    /// Returns the dependency of a frame. If the model is unknown, the dependency includes the model.
    fn depends_on(&self, reason: Reason<'_>) -> Option<String> {
        let model = self.plan_model.map(|model| format!("the model of the controller; shown for a {model}"));
        match (reason.depends_on, model) {
            (Some(before), Some(model)) => Some(format!("{before}, and {model}")),
            (before, model) => model.or(before.map(ToOwned::to_owned)),
        }
    }

    /// Plans a frame that depends on an earlier answer, from two variants of the frame. The plan shows `??` for bytes
    /// that differ.
    fn plan_masked(&mut self, frame: &[u8], other: &[u8], reason: Reason<'_>) {
        if let Some(plan) = self.transport.notes() {
            plan.note(json!({ "hex": mask_differences(frame, other) }), reason);
        }
    }

    fn plan_blocks(&mut self, id: u8, depends_on: Option<&str>, content: &[u8]) {
        let Some(plan) = self.transport.notes() else { return };
        let blocks: Vec<&[u8]> = content.chunks(MAX_DATA).collect();
        for (number, block) in (1u32..).zip(&blocks) {
            let is_last = number as usize == blocks.len();
            let (mark, words) = if is_last { (LAST_BLOCK, ", the last one") } else { (0, "") };
            let about = format!("block {number}{words}");
            let frame = data_frame(id, number | mark, block);
            plan.note(json!({ "hex": hex(&frame) }), Reason { about: Some(&about), depends_on });
        }
    }
}

/// Returns the readable instance and data fields of a motion request, without reserved fields.
fn fields(request: &Request, frame: &[u8]) -> Vec<ReadableField> {
    const INSTANCE: usize = 26;
    if request.risk() < Risk::Motion {
        return Vec::new();
    }
    let notes = describe(frame, Sender::Client, None).fields.into_iter();
    let fields = notes.filter(|note| note.offset == INSTANCE || note.offset >= HEADER_LEN);
    fields
        .filter(|note| !note.meaning.starts_with("reserved"))
        .map(|note| (note.name.into(), note.meaning.into()))
        .collect()
}

/// Returns a frame as hexadecimal digits, with `??` for bytes where the two frames differ.
fn mask_differences(one: &[u8], other: &[u8]) -> String {
    let differs = |index: usize| other.get(index) != one.get(index);
    let digits = one.iter().enumerate().map(|(index, byte)| if differs(index) { "??".into() } else { hex(&[*byte]) });
    digits.collect::<Vec<String>>().concat()
}
