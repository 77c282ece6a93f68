//! What a dry run of a command notes instead of sending it.

use serde_json::json;

use super::{Link, Transport};
use crate::command::frame::dry_run::{Reason, unknown};
use crate::controller::text::hex;
use crate::controller::yerc::files::{ack_frame, data_frame};
use crate::controller::yerc::query::Query;
use crate::controller::yerc::request::Request;
use crate::controller::yerc::wire::{LAST_BLOCK, MAX_DATA};
use crate::failure::Failure;

impl Link {
    /// Whether nothing is sent, only noted.
    pub fn is_dry(&self) -> bool {
        matches!(self.transport, Transport::Notes(_))
    }

    /// Says what the next request is for, where a dry run notes it.
    pub fn is_for(&mut self, purpose: &'static str) -> &mut Self {
        self.purpose = self.is_dry().then_some(purpose);
        self
    }

    /// In a dry run, notes all the questions, whose answers are not known then.
    pub fn dry_run<Q: Query>(&mut self, queries: &[Q]) -> Result<(), Failure> {
        if !self.is_dry() || queries.is_empty() {
            return Ok(());
        }
        for query in queries {
            let request = query.request();
            self.authorize(&request)?;
            self.note(&request, Reason::default());
        }
        Err(unknown())
    }

    /// Notes in a dry run what is sent after an answer, and what it is about.
    pub fn plan(&mut self, request: &Request, about: &str) {
        self.note(request, Reason::about(about));
    }

    /// Notes in a dry run a request whose bytes, or whose sending, an answer before it decides. `other` is the same
    /// request with other answers: where both differ nothing is known.
    pub fn plan_depending(&mut self, request: &Request, other: &Request, reason: Reason<'_>) {
        let id = self.ids.next_id();
        self.note_masked(&request.frame(id), &other.frame(id), reason);
    }

    /// Says in a dry run what follows that cannot be shown.
    pub fn then(&mut self, what: &str) {
        if let Transport::Notes(plan) = &mut self.transport {
            plan.then(what);
        }
    }

    /// Notes in a dry run a request that an answer before it decides whether it is sent.
    pub fn plan_if(&mut self, request: &Request, reason: Reason<'_>) {
        self.note(request, reason);
    }

    /// Notes in a dry run a request that follows whatever the answers before it are.
    pub fn plan_next(&mut self, request: &Request) {
        self.note(request, Reason::default());
    }

    /// Notes in a dry run what [`Link::download`] would send: the request, and the ACK of the first block, which stands
    /// for those of all. Nobody knows how many there are, and the first may be the last or have the number 0.
    pub fn plan_download(&mut self, request: &Request, reason: Reason<'_>) -> Result<(), Failure> {
        self.authorize(request)?;
        let id = self.note(request, reason);
        let answered = "which blocks come";
        let depends_on = reason.depends_on.map_or(answered.to_owned(), |before| format!("{before}, and {answered}"));
        let reason = Reason::about("acknowledges block 1; likewise for each block until the last one");
        let [first, last] = [1, LAST_BLOCK].map(|block| ack_frame(id, request.service, block));
        self.note_masked(&first, &last, reason.depending_on(&depends_on));
        Ok(())
    }

    /// Notes in a dry run what [`Link::upload`] would send.
    pub fn plan_upload(
        &mut self,
        request: &Request,
        reason: Reason<'_>,
        mut give: impl FnMut() -> Result<Vec<u8>, Failure>,
    ) -> Result<(), Failure> {
        self.authorize(request)?;
        let id = self.note(request, reason);
        self.note_blocks(id, reason.depends_on, &mut give)
    }

    pub(super) fn note(&mut self, request: &Request, reason: Reason<'_>) -> u8 {
        let id = self.ids.next_id();
        let reason = Reason { about: reason.about.or(self.purpose.take()), ..reason };
        if let Transport::Notes(plan) = &mut self.transport {
            plan.note(json!({ "hex": hex(&request.frame(id)) }), reason);
        }
        id
    }

    /// Notes a frame that is either of two: where they differ nothing is known.
    fn note_masked(&mut self, frame: &[u8], other: &[u8], reason: Reason<'_>) {
        if let Transport::Notes(plan) = &mut self.transport {
            plan.note(json!({ "hex": masked(frame, other) }), reason);
        }
    }

    /// The data blocks of an upload, which are known beforehand.
    fn note_blocks(
        &mut self,
        id: u8,
        depends_on: Option<&str>,
        give: &mut dyn FnMut() -> Result<Vec<u8>, Failure>,
    ) -> Result<(), Failure> {
        let Transport::Notes(plan) = &mut self.transport else { return Ok(()) };
        let mut content = Vec::new();
        loop {
            let piece = give()?;
            if piece.is_empty() {
                break;
            }
            content.extend(piece);
        }
        let blocks: Vec<&[u8]> = content.chunks(MAX_DATA).collect();
        for (number, block) in (1u32..).zip(&blocks) {
            let is_last = number as usize == blocks.len();
            let (mark, words) = if is_last { (LAST_BLOCK, ", the last one") } else { (0, "") };
            let about = format!("block {number}{words}");
            let frame = data_frame(id, number | mark, block);
            plan.note(json!({ "hex": hex(&frame) }), Reason { about: Some(&about), depends_on });
        }
        Ok(())
    }
}

/// Bytes as digits, with `??` where two frames differ.
fn masked(one: &[u8], other: &[u8]) -> String {
    let differs = |index: usize| other.get(index) != one.get(index);
    let digits = one.iter().enumerate().map(|(index, byte)| if differs(index) { "??".into() } else { hex(&[*byte]) });
    digits.collect::<Vec<String>>().concat()
}
