//! Sessions with a controller on a bad link, in virtual time.
//!
//! Every combination of fault, controller, command class, transfer and file size runs with many seeds. The guarantees
//! are absolute. No wrong data is reported as success, and a change is sent once unless it was refused as busy. No
//! session lasts longer than its deadline, and every outcome is a typed value.

mod link;
mod model;
mod simulator;

use std::collections::BTreeSet;
use std::time::Duration;

use armctl_controller::yerc::session::{
    Download, DownloadEnd, Ended, Exchange, Ids, Policy, Upload, UploadEnd, is_busy,
};
use armctl_controller::yerc::wire::{Division, RequestFrame};
use armctl_transport::fault::{FaultSpec, Share};

use link::{Class, Controller, Link, Run, TransferKind};
use model::{ControllerKind, Model};

/// Each fault alone, all faults at a moderate level, and all faults at the maximum.
const FAULTS: [&str; 8] = [
    "drop=10%",
    "dup=20%",
    "delay=0..50ms",
    "reorder=15%",
    "corrupt=10%",
    "busy=15%",
    MODERATE,
    "drop=25%,dup=20%,delay=0..250ms,reorder=20%,corrupt=10%,busy=20%",
];
const MODERATE: &str = "drop=5%,dup=2%,delay=0..50ms,reorder=3%,corrupt=1%,busy=4%";

/// Sizes near one and two blocks of 479 bytes, and a file of many blocks.
const SIZES: [usize; 7] = [0, 1, 478, 479, 480, 958, 10_000];
const MANNERS: [ControllerKind; 2] = [ControllerKind::Resends, ControllerKind::NoResend];

const EXCHANGE_SEEDS: u64 = 3000;
const TRANSFER_SEEDS: u64 = 200;

fn spec(text: &str, seed: u64) -> FaultSpec {
    FaultSpec { seed, ..text.parse().expect("the tests write their faults correctly") }
}

fn file_request(service: u8, data: &[u8]) -> RequestFrame<'_> {
    let division = Division::File;
    RequestFrame { division, ack: false, id: 0, block: 0, command: 0, instance: 0, attribute: 0, service, data }
}

/// Content that is different in each block.
fn content(size: usize, seed: u64) -> Vec<u8> {
    let mut bytes = vec![0; size];
    fastrand::Rng::with_seed(seed ^ 0xC0_FFEE).fill(&mut bytes);
    bytes
}

fn link_to(manners: ControllerKind, faults: FaultSpec) -> Link<Model> {
    let model = Model::new(manners, faults.busy.per_10_000(), faults.seed);
    Link::new(model, faults)
}

// ---- one request, one answer

const CLASSES: [Class; 4] = [Class::Read, Class::Write, Class::Start, Class::Move];

/// Result of one exchange.
struct Exchanged {
    class: Class,
    outcome: Ended,
    sends: usize,
}

fn exchange(link: &mut Link<impl Controller>, class: Class, ids: &Ids) -> Exchanged {
    let order = link.controller.order(class).frame(0);
    let request = RequestFrame::parse(&order).expect("orders are frames");
    let policy = Policy::default();
    let mut session = Exchange::new(&request, class == Class::Read, policy, ids);
    let run = link.run(&mut session, |_| unreachable!("an exchange asks for no content"));
    let what = format!("{class:?}: {:?} after {:?}, {:?}", run.outcome, run.duration, session.counters());

    // If a change is refused as busy shortly before the deadline, it still gets one more try.
    let last_try = if class == Class::Read { Duration::ZERO } else { policy.timeout };
    assert!(run.duration <= policy.patience() + last_try, "{what}");
    assert!(run.data.is_empty(), "{what}");
    match (&run.outcome, class) {
        (Ended::Answered(reply), _) if !reply.status.is_ok() => {
            assert!(is_busy(reply.status) || link.controller.may_refuse(reply.status), "{what}");
        }
        (Ended::Answered(reply), Class::Read) => assert!(link.controller.has_answered(&reply.data), "{what}"),
        (Ended::Answered(reply), _) => assert!(reply.data.is_empty(), "{what}"),
        (Ended::NoAnswer(_), Class::Read) | (Ended::OutcomeUnknown(_), Class::Write | Class::Start | Class::Move) => {}
        (Ended::NoAnswer(_) | Ended::OutcomeUnknown(_), _) => panic!("{what}"),
    }
    if class != Class::Read {
        // Refusals are counted at the controller, because a duplicate of a refusal must not count as a second refusal.
        assert!((1..=1 + run.busy).contains(&run.sent.len()), "{} left, {} busy; {what}", run.sent.len(), run.busy);
    }
    Exchanged { class, outcome: run.outcome, sends: run.sent.len() }
}

/// Runs several exchanges of every class on one link, so that late datagrams arrive during later exchanges.
fn exchanges(mut link: Link<impl Controller>) -> (Vec<Exchanged>, u32) {
    let ids = Ids::default();
    let done = CLASSES.iter().cycle().take(12).map(|&class| exchange(&mut link, class, &ids)).collect();
    link.settle();
    (done, link.controller.executed())
}

fn has_valid_answer(exchanged: &Exchanged) -> bool {
    matches!(&exchanged.outcome, Ended::Answered(reply) if reply.status.is_ok())
}

/// Checks the guarantees of exchanges with these faults.
fn check_exchanges(faults: &FaultSpec, link: Link<impl Controller>) {
    let (all, executed) = exchanges(link);
    let changes = || all.iter().filter(|exchanged| exchanged.class != Class::Read);
    let done = changes().filter(|exchanged| has_valid_answer(exchanged)).count();
    let executed = usize::try_from(executed).expect("few executions");
    // If the link duplicates nothing, only the client could cause a second execution of a change. It must not do this.
    assert!(executed >= done, "{faults}: {done} reported as done, {executed} executed");
    let max_executions =
        if faults.dup == Share::NONE { changes().count() } else { 2 * changes().map(|it| it.sends).sum::<usize>() };
    assert!(executed <= max_executions, "{faults}: {executed} executed of {max_executions}");
}

#[test]
fn exchanges_keep_their_guarantees_under_every_fault() {
    for text in FAULTS {
        for seed in 0..EXCHANGE_SEEDS {
            let faults = spec(text, seed);
            check_exchanges(&faults, link_to(ControllerKind::Resends, faults.clone()));
        }
    }
}

#[test]
fn answers_every_exchange_without_loss() {
    for text in ["seed=0", "delay=0..50ms", "dup=20%"] {
        for seed in 0..EXCHANGE_SEEDS {
            let (all, _) = exchanges(link_to(ControllerKind::Resends, spec(text, seed)));
            assert!(all.iter().all(|it| has_valid_answer(it) && it.sends == 1), "{text},seed={seed}");
        }
    }
}

#[test]
fn reads_survive_moderate_loss() {
    let (mut reads, mut good) = (0, 0);
    for seed in 0..EXCHANGE_SEEDS {
        let (all, _) = exchanges(link_to(ControllerKind::Resends, spec(MODERATE, seed)));
        reads += all.iter().filter(|it| it.class == Class::Read).count();
        good += all.iter().filter(|it| it.class == Class::Read && has_valid_answer(it)).count();
    }
    assert!(good * 1000 >= reads * 998, "{good} of {reads} reads");
}

// ---- transfers

const TRANSFER_KINDS: [TransferKind; 3] = [TransferKind::Save, TransferKind::List, TransferKind::Load];

/// How a transfer can end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum End {
    Success,
    Refused,
    Violated,
    NoAnswer,
    Unknown,
    /// The request for an upload was not answered. This request is sent only once.
    Unopened,
}

/// Runs a transfer and checks all guarantees. Returns how the transfer ended.
fn transfer(link: &mut Link<impl Controller>, way: TransferKind, content: &[u8], ids: &Ids) -> End {
    match way {
        TransferKind::Save | TransferKind::List => download(link, way, content, ids),
        TransferKind::Load => upload(link, content, ids),
    }
}

fn download(link: &mut Link<impl Controller>, way: TransferKind, content: &[u8], ids: &Ids) -> End {
    let (name, content) = link.controller.offer(way, content);
    let policy = Policy::default();
    let request = file_request(if way == TransferKind::Save { 0x16 } else { 0x32 }, name);
    let mut session = Download::new(&request, 1 << 20, policy, ids);
    let Run { outcome, data, idle, .. } = link.run(&mut session, |_| unreachable!("a download asks for no content"));
    let what = format!("{} bytes: {outcome:?} idle for {idle:?}, {:?}", content.len(), session.counters());

    assert!(idle <= policy.patience(), "{what}");
    assert!(content.starts_with(&data), "what came is no beginning of the file; {what}");
    let received = data.len() as u64;
    match outcome {
        DownloadEnd::Complete { bytes, blocks } => {
            assert_eq!(data, content, "{what}");
            assert_eq!((bytes, blocks as usize), (received, content.len().div_ceil(479)), "{what}");
            End::Success
        }
        DownloadEnd::Nothing(status) => {
            assert!(content.is_empty() && [0xE29C, 0xE2A7].contains(&status.added), "{what}");
            End::Success
        }
        DownloadEnd::Refused { status, bytes } => {
            assert_eq!(bytes, received, "{what}");
            assert!(is_busy(status) || link.controller.may_refuse(status), "{what}");
            End::Refused
        }
        DownloadEnd::Violated { bytes, .. } => {
            assert_eq!(bytes, received, "{what}");
            assert!(link.controller.skips(), "{what}");
            End::Violated
        }
        DownloadEnd::NoAnswer { bytes, .. } => {
            assert_eq!(bytes, received, "{what}");
            End::NoAnswer
        }
        DownloadEnd::Finished | DownloadEnd::TooLarge { .. } => panic!("{what}"),
    }
}

fn upload(link: &mut Link<impl Controller>, content: &[u8], ids: &Ids) -> End {
    link.controller.forget();
    let before = link.controller.stored();
    let (name, _) = link.controller.offer(TransferKind::Load, content);
    let policy = Policy::default();
    let request = file_request(0x15, name);
    let mut session = Upload::new(&request, policy, ids);
    let mut pieces = content.chunks(1000);
    let Run { outcome, idle, sent, .. } = link.run(&mut session, |session| match pieces.next() {
        // Depending on the size, the end is reported with the last piece or after it.
        Some(piece) => session.feed(piece, pieces.len() == 0 && content.len().is_multiple_of(2)),
        None => session.feed(&[], true),
    });
    let what = format!("{} bytes: {outcome:?} idle for {idle:?}, {:?}", content.len(), session.counters());

    assert!(idle <= policy.patience(), "{what}");
    let requests = sent.iter().filter(|frame| frame[10] == 0).count();
    assert!(requests <= 1 + usize::try_from(session.counters().busy).expect("few"), "{requests} requests; {what}");
    let size = content.len() as u64;
    let stored = link.controller.stored();
    assert!(stored.as_deref() == Some(content) || stored == before, "a file that nobody sent; {what}");
    match outcome {
        UploadEnd::Complete { bytes, blocks } => {
            assert_eq!(stored.as_deref(), Some(content), "{what}");
            assert_eq!((bytes, blocks as usize), (size, content.len().div_ceil(479)), "{what}");
            End::Success
        }
        UploadEnd::Empty => {
            assert!(content.is_empty() && sent.is_empty(), "{what}");
            End::Success
        }
        UploadEnd::Refused { status, sent, taken, .. } => {
            assert!(taken <= sent && sent <= size, "{what}");
            assert!(is_busy(status) || link.controller.may_refuse(status), "{what}");
            End::Refused
        }
        UploadEnd::OutcomeUnknown { sent: 0, .. } => {
            assert!(sent.iter().all(|frame| frame[10] == 0), "data left; {what}");
            End::Unopened
        }
        UploadEnd::OutcomeUnknown { sent, taken, .. } => {
            assert!(taken < sent && sent <= size, "{what}");
            End::Unknown
        }
        UploadEnd::TooLong { .. } | UploadEnd::Unnumbered { .. } => panic!("{what}"),
    }
}

/// Runs transfers of every kind and size with these faults.
fn transfers(text: &str, manners: ControllerKind, seeds: u64) -> Vec<End> {
    let mut ends = Vec::new();
    for way in TRANSFER_KINDS {
        for size in SIZES {
            for seed in 0..seeds {
                let mut link = link_to(manners, spec(text, seed));
                ends.push(transfer(&mut link, way, &content(size, seed), &Ids::default()));
            }
        }
    }
    ends
}

fn successes(ends: &[End]) -> usize {
    ends.iter().filter(|end| **end == End::Success).count()
}

/// With moderate loss, some requests for an upload get no answer. Very few other transfers fail.
fn check_moderate_loss(ends: &[End]) {
    let unopened = ends.iter().filter(|end| **end == End::Unopened).count();
    assert!(
        (1..ends.len() / 15).contains(&unopened),
        "{unopened} of {} transfers, one third of them uploads",
        ends.len()
    );
    let others = ends.len() - unopened;
    let successful = successes(ends);
    assert!(successful * 1000 >= others * 995, "{successful} of {others} transfers");
}

#[test]
fn transfers_keep_their_guarantees_under_every_fault() {
    let mut seen = BTreeSet::new();
    for text in FAULTS {
        for manners in MANNERS {
            seen.extend(transfers(text, manners, TRANSFER_SEEDS));
        }
    }
    // Every kind of end must occur. If one is missing, the checks above did not test it.
    assert!(seen.into_iter().eq([
        End::Success,
        End::Refused,
        End::Violated,
        End::NoAnswer,
        End::Unknown,
        End::Unopened
    ]));
}

#[test]
fn every_transfer_succeeds_without_faults() {
    for manners in MANNERS {
        for text in ["seed=0", "delay=0..50ms"] {
            let ends = transfers(text, manners, 3);
            assert_eq!(successes(&ends), ends.len(), "{manners:?}, {text}");
        }
    }
}

#[test]
fn transfers_survive_duplication_and_reordering_if_the_controller_resends() {
    for text in ["dup=20%", "reorder=15%", "dup=100%"] {
        let ends = transfers(text, ControllerKind::Resends, 10);
        assert_eq!(successes(&ends), ends.len(), "{text}");
    }
}

#[test]
fn transfers_survive_moderate_loss_if_the_controller_resends() {
    check_moderate_loss(&transfers(MODERATE, ControllerKind::Resends, TRANSFER_SEEDS));
}

/// Late datagrams of one transfer can arrive during the next transfer on the same link.
#[test]
fn consecutive_transfers_do_not_mix() {
    for text in FAULTS {
        for seed in 0..TRANSFER_SEEDS {
            let mut link = link_to(ControllerKind::Resends, spec(text, seed));
            let ids = Ids::starting_at(250);
            for round in 0..4 {
                for way in TRANSFER_KINDS {
                    transfer(&mut link, way, &content(1000, seed << 8 | round), &ids);
                }
                exchange(&mut link, Class::Move, &ids);
            }
        }
    }
}

/// If the last ACK is lost, the controller sends its last block again. The session acknowledges this block even after
/// its end.
#[test]
fn lingering_repairs_a_lost_last_ack() {
    let mut link = link_to(ControllerKind::Resends, FaultSpec::default());
    let (name, _) = link.controller.offer(TransferKind::Save, &[7; 600]);
    let request = file_request(0x16, name);
    let mut session = Download::new(&request, 1 << 20, Policy::default(), &Ids::default());
    link.lose_client_frame(2);
    let run = link.run(&mut session, |_| unreachable!("a download asks for no content"));
    assert_eq!(run.outcome, DownloadEnd::Complete { bytes: 600, blocks: 2 });
    assert!(link.controller.with_transfer());
    let again = link.controller.resend().expect("the last block is not acknowledged");
    let ack = session.linger(&again).expect("the last block once more");
    link.controller.receive(Duration::ZERO, &ack);
    assert!(!link.controller.with_transfer());
}
