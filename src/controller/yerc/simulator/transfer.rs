//! File server: block transfers (DX 3.2.3 to 3.2.6, 3.4).
//!
//! The manual does not cover lost frames. The simulator answers a repeated frame again. The answer to a repeated ACK or
//! request is the block that waits for its ACK; the answer to a repeated data block is the ACK of this block. A repeat
//! shortly after the last frame counts as a network echo and gets no answer, so that copies do not multiply. Only one
//! transfer is open at a time. The simulator drops the transfer after a timeout (E28B) and after a change of mode
//! (FFFE).
//!
//! The same request (service and path) creates the batch backup and fetches the backup file. The manuals do not specify
//! how a controller distinguishes the two cases. In this simulator, the first request creates a backup, and is answered
//! without data when the backup is complete. The next request fetches the file. After the file was fetched completely,
//! one more request creates a new backup.

use std::time::Duration;

use super::robot::has;
use super::storage::{Content, FileContent};
use super::world::{Refusal, World, code};
use crate::yerc::Model;
use crate::yerc::table::{BATCH_BACKUP_PATH, Row, service};
use crate::yerc::wire::{AnswerFrame, Division, LAST_BLOCK, MAX_DATA, RequestFrame, Status};
use crate::{Now, refuse_if};

/// A repeat within this time after the last frame is a network echo.
const ECHO: Duration = Duration::from_millis(20);
/// A request within this time after the last frame of a transfer is a copy of its first request.
const COPY: Duration = Duration::from_millis(500);

/// State of a transfer.
#[derive(Debug, Clone)]
enum Stage {
    /// The controller sends blocks. `block` is the number of the block that waits for its ACK.
    Sending { content: Content, block: u32, is_backup: bool },
    /// The controller receives blocks. `received` is the number of blocks so far.
    Receiving { name: Vec<u8>, bytes: Vec<u8>, received: u32 },
    /// The controller writes the backup until this time.
    BackingUp { done: Now },
    /// The transfer is complete. The last frame can still be repeated.
    Finished { block: u32 },
    /// The transfer was dropped. The next frame of the transfer is refused with this code.
    Dropped(u16),
}

/// Transfer with one peer.
#[derive(Debug, Clone)]
struct Transfer {
    peer: u64,
    service: u8,
    /// Id and data of the first request.
    request: (u8, Vec<u8>),
    /// Id of the previous transfer. A first frame with this id is a late copy.
    previous: Option<u8>,
    /// Id of the latest frame from the peer. The answers use this id.
    id: u8,
    stage: Stage,
    last_frame: Vec<u8>,
    sent: Now,
    /// Time at which the last frame of the peer arrived.
    heard: Now,
    mode_changes: u64,
}

impl Transfer {
    fn is_open(&self) -> bool {
        matches!(self.stage, Stage::Sending { .. } | Stage::Receiving { .. } | Stage::BackingUp { .. })
    }

    /// Whether a request is a late copy of the request that has just loaded a file. Such a copy must not start a new
    /// transfer: a client that did not receive the ACK of the last block could then not repeat this block.
    fn loaded_by(&self, peer: u64, request: &RequestFrame<'_>, now: Now) -> bool {
        matches!(self.stage, Stage::Finished { .. })
            && (self.peer, self.service, service::LOAD) == (peer, request.service, request.service)
            && (self.request.0, self.request.1.as_slice()) == (request.id, request.data)
            && AnswerFrame::parse(&self.last_frame).is_ok_and(|ack| ack.status.is_ok())
            && now < self.heard + COPY
    }

    /// Whether no block has been acknowledged yet.
    fn at_start(&self) -> bool {
        match self.stage {
            Stage::Sending { block, .. } => block == 1,
            Stage::Receiving { received, .. } => received == 0,
            _ => false,
        }
    }

    /// Whether requests for other transfers are refused. After the last block they are accepted, because only the ACK
    /// of this block is missing, and the ACK may be lost.
    fn is_busy(&self) -> bool {
        match &self.stage {
            Stage::Sending { content, block, .. } => !is_last(content, *block),
            _ => self.is_open(),
        }
    }
}

#[derive(Debug, Clone)]
pub(super) struct FileServer {
    transfer: Option<Transfer>,
    pub(super) backup_time: Duration,
    pub(super) backup_size: u64,
    pub(super) idle_limit: Duration,
    backups: u64,
}

/// The peer, and the frame for this peer.
pub(super) type Reply = Option<(u64, Vec<u8>)>;

impl FileServer {
    pub(super) fn new(backup_time: Duration, backup_size: u64, idle_limit: Duration) -> Self {
        Self { transfer: None, backup_time, backup_size, idle_limit, backups: 0 }
    }

    /// Time of the next timeout or of the end of a backup.
    pub(super) fn wake(&self) -> Option<Now> {
        let transfer = self.transfer.as_ref()?;
        match transfer.stage {
            Stage::BackingUp { done } => Some(done),
            Stage::Sending { .. } | Stage::Receiving { .. } => Some(transfer.heard.saturating_add(self.idle_limit)),
            Stage::Finished { .. } | Stage::Dropped(_) => None,
        }
    }

    /// Drops a transfer after its timeout, and completes a backup.
    pub(super) fn advance(&mut self, world: &mut World, now: Now) -> Reply {
        let due = self.wake().is_some_and(|at| at <= now);
        let transfer = self.transfer.as_mut()?;
        if transfer.is_open() && transfer.mode_changes != world.mode_changes {
            transfer.stage = Stage::Dropped(code::MODE_CHANGED);
        }
        if !due {
            return None;
        }
        match transfer.stage {
            Stage::BackingUp { .. } => {
                self.backups += 1;
                world.files.backup = Some(Content::Generated { seed: self.backups, size: self.backup_size });
                transfer.stage = Stage::Finished { block: LAST_BLOCK };
                transfer.sent = now;
                transfer.last_frame = frame(transfer.service, transfer.id, LAST_BLOCK, Status::OK, &[]);
                Some((transfer.peer, transfer.last_frame.clone()))
            }
            Stage::Sending { .. } | Stage::Receiving { .. } => {
                transfer.stage = Stage::Dropped(code::TIMED_OUT);
                None
            }
            Stage::Finished { .. } | Stage::Dropped(_) => None,
        }
    }

    pub(super) fn receive(&mut self, world: &mut World, now: Now, peer: u64, request: &RequestFrame<'_>) -> Reply {
        let reply = if request.ack {
            self.continues(world, now, peer, request)
        } else {
            self.begins(world, now, peer, request)
        };
        reply.map(|bytes| (peer, bytes))
    }

    fn begins(&mut self, world: &mut World, now: Now, peer: u64, request: &RequestFrame<'_>) -> Option<Vec<u8>> {
        if let Some(transfer) = self.transfer.as_mut().filter(|transfer| transfer.is_open()) {
            if transfer.peer != peer && transfer.is_busy() {
                let busy = match world.model {
                    Model::Fs100 => code::FILE_IN_USE,
                    _ => code::FILE_BUSY,
                };
                return Some(refusal(world, request, Refusal::Added(busy)));
            }
            let same =
                transfer.peer == peer && transfer.service == request.service && transfer.request.1 == request.data;
            if same && matches!(transfer.stage, Stage::BackingUp { .. }) {
                // The client repeats its request while the backup is written.
                transfer.id = request.id;
                return None;
            }
            if same && (transfer.at_start() || transfer.request.0 == request.id && now < transfer.heard + COPY) {
                return repeat(transfer, now, request.id);
            }
        }
        if self.transfer.as_ref().is_some_and(|transfer| transfer.loaded_by(peer, request, now)) {
            return None;
        }
        let result = self.open(world, now, peer, request);
        Some(result.unwrap_or_else(|refused| refusal(world, request, refused))).filter(|bytes| !bytes.is_empty())
    }

    /// Starts a transfer. Returns an empty frame if the answer is sent later.
    fn open(&mut self, world: &mut World, now: Now, peer: u64, request: &RequestFrame<'_>) -> Result<Vec<u8>, Refusal> {
        let row =
            Row::of_file(request.service, request.data).filter(|_| request.command == 0).ok_or(Refusal::Command)?;
        refuse_if(request.instance != 0, Refusal::Instance)?;
        refuse_if(request.attribute != 0, Refusal::Attribute)?;
        refuse_if(request.block != 0, Refusal::Added(code::BLOCK))?;
        let stage = match request.service {
            service::DELETE => {
                world.delete_file(request.data)?;
                return Ok(frame(request.service, request.id, LAST_BLOCK, Status::OK, &[]));
            }
            service::LOAD => {
                world.may_load(request.data)?;
                Stage::Receiving { name: request.data.to_vec(), bytes: Vec::new(), received: 0 }
            }
            _ if request.data == BATCH_BACKUP_PATH => {
                refuse_if(!has(world, row.availability), Refusal::Added(code::PATH))?;
                if let Some(content) = world.files.backup.clone() {
                    Stage::Sending { content, block: 1, is_backup: true }
                } else {
                    world.may_back_up()?;
                    Stage::BackingUp { done: now.saturating_add(self.backup_time) }
                }
            }
            number => {
                let found = if number == service::LIST {
                    world.list_files(request.data)?
                } else {
                    world.read_file(request.data)?
                };
                match found {
                    FileContent::Content(content) => Stage::Sending { content, block: 1, is_backup: false },
                    FileContent::Nothing(added) => {
                        let status = Status { code: 0, added_size: 1, added: added.into() };
                        return Ok(frame(number, request.id, LAST_BLOCK, status, &[]));
                    }
                }
            }
        };
        let last_frame = match &stage {
            Stage::Sending { content, .. } => data_frame(request.service, request.id, content, 1),
            Stage::Receiving { .. } => frame(request.service, request.id, 0, Status::OK, &[]),
            _ => Vec::new(),
        };
        self.transfer = Some(Transfer {
            peer,
            service: request.service,
            request: (request.id, request.data.to_vec()),
            previous: self.transfer.as_ref().filter(|transfer| transfer.peer == peer).map(|transfer| transfer.id),
            id: request.id,
            stage,
            last_frame: last_frame.clone(),
            sent: now,
            heard: now,
            mode_changes: world.mode_changes,
        });
        Ok(last_frame)
    }

    /// Handles a data block or an ACK.
    fn continues(&mut self, world: &mut World, now: Now, peer: u64, request: &RequestFrame<'_>) -> Option<Vec<u8>> {
        let known = |transfer: &&mut Transfer| transfer.peer == peer && transfer.service == request.service;
        let Some(transfer) = self.transfer.as_mut().filter(known) else {
            // An unexpected ACK is a late copy. An unexpected data block is an error of the client.
            let stray = request.service == service::LOAD;
            return stray.then(|| refusal(world, request, Refusal::Added(code::ACK)));
        };
        if transfer.at_start() && request.id != transfer.request.0 && transfer.previous == Some(request.id) {
            return None;
        }
        transfer.id = request.id;
        transfer.heard = now;
        match &mut transfer.stage {
            Stage::Dropped(reason) => {
                let reason = *reason;
                self.transfer = None;
                Some(refusal(world, request, Refusal::Added(reason)))
            }
            Stage::BackingUp { .. } => None,
            Stage::Finished { block } => {
                let repeats = request.service == service::LOAD && request.block == *block;
                if repeats { repeat(transfer, now, request.id) } else { None }
            }
            Stage::Sending { content, block, is_backup } => {
                let current = if is_last(content, *block) { *block | LAST_BLOCK } else { *block };
                // One known client omits the last-block bit in its last ACK.
                if request.block == current || request.block == *block {
                    if current & LAST_BLOCK != 0 {
                        if *is_backup {
                            world.files.backup = None;
                        }
                        transfer.stage = Stage::Finished { block: current };
                        return None;
                    }
                    *block += 1;
                    transfer.last_frame = data_frame(transfer.service, request.id, content, *block);
                    transfer.sent = now;
                    Some(transfer.last_frame.clone())
                } else if request.block < *block {
                    repeat(transfer, now, request.id)
                } else {
                    self.transfer = None;
                    Some(refusal(world, request, Refusal::Added(code::ACK)))
                }
            }
            Stage::Receiving { .. } => {
                let (reply, goes_on) = take_block(transfer, world, now, request);
                if !goes_on {
                    self.transfer = None;
                }
                reply
            }
        }
    }
}

/// Handles a data block of a load. Returns the answer, and whether the transfer continues.
fn take_block(
    transfer: &mut Transfer,
    world: &mut World,
    now: Now,
    request: &RequestFrame<'_>,
) -> (Option<Vec<u8>>, bool) {
    let Stage::Receiving { name, bytes, received } = &mut transfer.stage else { return (None, true) };
    let last = request.block & LAST_BLOCK != 0;
    let number = request.block & !LAST_BLOCK;
    // Some clients number a single block 0x80000000 instead of 0x80000001.
    let next = number == *received + 1 || last && number == 0 && *received == 0;
    if !next && number == *received {
        return (repeat(transfer, now, request.id), true);
    }
    if !next && number < *received {
        return (None, true);
    }
    let refused = [
        (!next, code::BLOCK),
        (request.data.is_empty(), code::DATA_SIZE_ZERO),
        ((bytes.len() + request.data.len()) as u64 > world.files.free(), code::MEMORY_FULL),
    ]
    .into_iter()
    .find_map(|(refused, code)| refused.then_some(code));
    if let Some(code) = refused {
        return (Some(refusal(world, request, Refusal::Added(code))), false);
    }
    bytes.extend_from_slice(request.data);
    *received += 1;
    let status = if last {
        let (name, bytes) = (std::mem::take(name), std::mem::take(bytes));
        transfer.stage = Stage::Finished { block: request.block };
        world.load_file(&name, bytes).map_or_else(|refused| refused.status(world.model), |()| Status::OK)
    } else {
        Status::OK
    };
    let block = if last && world.files.plain_last_ack { LAST_BLOCK } else { request.block };
    transfer.last_frame = frame(transfer.service, request.id, block, status, &[]);
    transfer.sent = now;
    (Some(transfer.last_frame.clone()), true)
}

/// Repeats the last frame with the id of the request. Returns `None` if the request is an echo.
fn repeat(transfer: &mut Transfer, now: Now, id: u8) -> Option<Vec<u8>> {
    if now < transfer.sent + ECHO {
        return None;
    }
    transfer.sent = now;
    transfer.id = id;
    let last = AnswerFrame::parse(&transfer.last_frame).ok()?;
    Some(AnswerFrame { id, ..last }.emit())
}

fn is_last(content: &Content, block: u32) -> bool {
    u64::from(block) * MAX_DATA as u64 >= content.size()
}

fn data_frame(service: u8, id: u8, content: &Content, block: u32) -> Vec<u8> {
    let data = content.piece(u64::from(block - 1) * MAX_DATA as u64, MAX_DATA);
    let number = if is_last(content, block) { block | LAST_BLOCK } else { block };
    frame(service, id, number, Status::OK, &data)
}

fn refusal(world: &World, request: &RequestFrame<'_>, refused: Refusal) -> Vec<u8> {
    frame(request.service, request.id, LAST_BLOCK, refused.status(world.model), &[])
}

fn frame(service: u8, id: u8, block: u32, status: Status, data: &[u8]) -> Vec<u8> {
    super::answer_frame(Division::File, service, id, block, status, data)
}
