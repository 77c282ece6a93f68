//! The simulator of this project, tested on the same bad links as the minimal controller.

use std::cell::OnceCell;
use std::collections::BTreeSet;
use std::time::Duration;

use armctl_controller::Now;
use armctl_controller::yerc::Model::{self, Dx200, Fs100};
use armctl_controller::yerc::files::batch_backup;
use armctl_controller::yerc::group::Group;
use armctl_controller::yerc::payload::{CartesianMove, ExtendedForm, Form, MoveLayout, PositionKind, SpeedClass};
use armctl_controller::yerc::query::{
    Coordinates, MoveCartesian, MoveKind, Query, ReadPosition, ReadStatus, ReadVariable, StartJob, WriteVariable,
};
use armctl_controller::yerc::request::Request;
use armctl_controller::yerc::session::{Download, DownloadEnd, Ids, Policy};
use armctl_controller::yerc::simulator::{Simulator, Start};
use armctl_controller::yerc::variables::{Value, VariableKind};
use armctl_controller::yerc::wire::{AnswerFrame, Division, Status};
use armctl_transport::fault::FaultSpec;

use super::link::{Class, Controller, Link, TransferKind};
use super::{
    End, FAULTS, SIZES, TRANSFER_KINDS, check_exchanges, check_moderate_loss, content, exchange, exchanges,
    file_request, has_valid_answer, spec, successes, transfer,
};

const MODELS: [Model; 2] = [Dx200, Fs100];
const EXCHANGE_SEEDS: u64 = 150;
const TRANSFER_SEEDS: u64 = 25;

/// Numbers of the client under test and of an observer.
const CLIENT: u64 = 1;
const OBSERVER: u64 = 2;
/// Time that is longer than any work of a controller, including its wait for a lost client.
const REST: Duration = Duration::from_secs(30);
/// Time that is longer than the simulator needs for a backup.
const LONG: Duration = Duration::from_secs(600);
/// First of the D variables that the test writes. Each variable is written once.
const FIRST_WRITTEN: u16 = 10;
/// Distance of each move along X, in micrometers.
const STEP: i32 = 1000;
/// Seed for the content of the files that the client downloads.
const SEED: u64 = 0;
/// Refusals of damaged, unexpected or conflicting requests (DX chapter 4).
const REFUSALS: [u32; 9] = [0x2010, 0xE28B, 0xE49E, 0xE4A1, 0xE4A2, 0xE4A3, 0xE4A5, 0xE4A6, 0xE4A7];
/// The file does not exist. An FS100 also reports this for an empty file.
const NO_SUCH_FILE: u32 = 0xE2B3;

/// The simulator, with the requests that it received and the answers that it sent.
#[derive(Clone)]
struct Simulated {
    simulator: Simulator,
    model: Model,
    now: Now,
    written: u16,
    read: BTreeSet<Vec<u8>>,
}

fn start(model: Model) -> Start {
    let file = |size| format!("[[file]]\nname = '{}'\npath = '{size}'\n", String::from_utf8_lossy(name(size)));
    let files: String = SIZES.map(file).concat();
    let text = format!(
        "model = '{model}'\nstock = false\njob = 'TICK'\nbackup_size = 5000\n[[file]]\nname = 'TICK.JBI'\ntext = '''\n/JOB\n//NAME TICK\n\
         //INST\nNOP\nINC D000\nEND\n'''\n{files}"
    );
    Start::parse(&text, |size| Ok(content(size.parse().expect("a size"), SEED))).expect("a good start state")
}

/// Name of the file with this size in the start state.
fn name(size: usize) -> &'static [u8] {
    match size {
        0 => b"EMPTY.DAT",
        1 => b"ONE.DAT",
        478 => b"ALMOST.DAT",
        479 => b"BLOCK.DAT",
        480 => b"MORE.DAT",
        958 => b"BLOCKS.DAT",
        _ => b"LONG.DAT",
    }
}

impl Simulated {
    fn new(start: &Start, faults: &FaultSpec) -> Self {
        let busy = f64::from(faults.busy.per_10_000()) / 10_000.0;
        let start = start.clone().with_seed(faults.seed).with_busy(busy);
        let model = start.model();
        Self { simulator: Simulator::new(start), model, now: Now::ZERO, written: 0, read: BTreeSet::new() }
    }

    /// A copy of the controller, at a later time at which all work is done. The test reads the state from this copy.
    fn resting_state(&self) -> Self {
        let mut copy = self.clone();
        copy.now += REST;
        copy.transmit(copy.now);
        copy
    }

    /// Answer to a query of the observer. The query is repeated while the controller is busy.
    fn read_back<Q: Query>(&mut self, query: &Q) -> Q::Answer {
        loop {
            self.simulator.receive(self.now, Division::Robot, OBSERVER, &query.request().frame(1));
            let answer = self.simulator.transmit(self.now).expect("an answer").bytes;
            let answer = AnswerFrame::parse(&answer).expect("a frame");
            if answer.status.is_ok() {
                return query.decode(answer.data).expect("good data");
            }
        }
    }

    fn duplicate(&mut self, number: u16) -> i32 {
        match self.read_back(&ReadVariable::new(VariableKind::D, number)) {
            Value::Double(value) => value,
            other => panic!("{other:?}"),
        }
    }

    /// Content of a file that the observer fetches. The observer waits while the controller is busy.
    fn file(&mut self, name: &[u8]) -> Option<Vec<u8>> {
        let session = Download::new(&file_request(0x16, name), 1 << 20, Policy::default(), &Ids::default());
        let mut session = session.with_first_wait(LONG);
        let mut link = Link::new(Observer(self), FaultSpec::default());
        let run = link.run(&mut session, |_| unreachable!("a download asks for no content"));
        match run.outcome {
            DownloadEnd::Complete { .. } => Some(run.data),
            DownloadEnd::Nothing(_) | DownloadEnd::Finished => None,
            DownloadEnd::Refused { status, .. } if status.added == NO_SUCH_FILE => None,
            other => panic!("{other:?}"),
        }
    }

    fn exchange(&mut self, peer: u64, now: Now, datagram: &[u8]) -> Vec<Vec<u8>> {
        self.now = self.now.max(now);
        // A client socket sends to one port, so a damaged datagram still arrives at the right port.
        let division = if datagram.get(9) == Some(&2) { Division::File } else { Division::Robot };
        self.simulator.receive(self.now, division, peer, datagram);
        self.transmit(now)
    }
}

impl Controller for Simulated {
    fn receive(&mut self, now: Now, datagram: &[u8]) -> Vec<Vec<u8>> {
        let sent = self.exchange(CLIENT, now, datagram);
        let answers = sent.iter().filter_map(|bytes| AnswerFrame::parse(bytes).ok());
        self.read.extend(answers.filter(|answer| answer.service == 0x81).map(|answer| answer.data.to_vec()));
        sent
    }

    fn wake(&self) -> Option<Now> {
        self.simulator.wake()
    }

    fn transmit(&mut self, now: Now) -> Vec<Vec<u8>> {
        self.now = self.now.max(now);
        std::iter::from_fn(|| self.simulator.transmit(self.now)).map(|outgoing| outgoing.bytes).collect()
    }

    fn order(&mut self, class: Class) -> Request {
        match class {
            Class::Read => ReadStatus.request(),
            Class::Write => {
                let number = FIRST_WRITTEN + self.written;
                self.written += 1;
                WriteVariable::new(number, Value::Double(number.into())).expect("a variable there is").request()
            }
            Class::Start => StartJob.request(),
            Class::Move => {
                let target = CartesianMove {
                    layout: MoveLayout::Words26,
                    robot: 1,
                    station: 0,
                    class: SpeedClass::Linear,
                    speed: 15_000,
                    coordinate: PositionKind::Base,
                    target: [STEP, 0, 0, 0, 0, 0],
                    reserved: [0; 2],
                    form: Form(0),
                    extended: ExtendedForm(0),
                    tool: 0,
                    user: 0,
                    base: [0; 3],
                    station_axes: [0; 6],
                };
                MoveCartesian::new(self.model, MoveKind::Incremental, target).expect("a good move").request()
            }
        }
    }

    fn has_answered(&self, data: &[u8]) -> bool {
        self.read.contains(data)
    }

    fn may_refuse(&self, status: Status) -> bool {
        REFUSALS.contains(&status.added) || self.model == Fs100 && status.added == NO_SUCH_FILE
    }

    fn executed(&self) -> u32 {
        let mut rested = self.resting_state();
        let position = ReadPosition::new(self.model, Group::R1, Coordinates::Base).expect("a robot");
        let x = |simulated: &mut Self| simulated.read_back(&position).axes.as_slice()[0];
        let distance = x(&mut rested) - x(&mut Self::new(&start_of(self.model), &FaultSpec::default()));
        assert_eq!(distance % STEP, 0, "a move was cut short or changed");
        let mut writes = 0;
        for number in FIRST_WRITTEN..FIRST_WRITTEN + self.written {
            let value = rested.duplicate(number);
            assert!([0, number.into()].contains(&value), "D{number} is {value}");
            writes += u32::from(value != 0);
        }
        (distance / STEP + rested.duplicate(0)).unsigned_abs() + writes
    }

    fn offer(&mut self, way: TransferKind, bytes: &[u8]) -> (&'static [u8], Vec<u8>) {
        match way {
            TransferKind::Load => (b"NEW.DAT", Vec::new()),
            TransferKind::Save => (name(bytes.len()), content(bytes.len(), SEED)),
            TransferKind::List => {
                let mut names = SIZES.map(name).to_vec();
                names.extend(self.stored().map(|_| &b"NEW.DAT"[..]));
                names.sort_unstable();
                (b"*.DAT", names.into_iter().flat_map(|name| [name, b"\r\n"].concat()).collect())
            }
        }
    }

    fn forget(&mut self) {}

    fn stored(&self) -> Option<Vec<u8>> {
        self.resting_state().file(b"NEW.DAT")
    }

    fn skips(&self) -> bool {
        false
    }
}

/// The simulator for the observer, whose link has no faults.
struct Observer<'a>(&'a mut Simulated);

impl Controller for Observer<'_> {
    fn receive(&mut self, now: Now, datagram: &[u8]) -> Vec<Vec<u8>> {
        self.0.exchange(OBSERVER, now, datagram)
    }

    fn wake(&self) -> Option<Now> {
        self.0.wake()
    }

    fn transmit(&mut self, now: Now) -> Vec<Vec<u8>> {
        self.0.transmit(now)
    }

    fn order(&mut self, class: Class) -> Request {
        self.0.order(class)
    }

    fn has_answered(&self, data: &[u8]) -> bool {
        self.0.has_answered(data)
    }

    fn may_refuse(&self, status: Status) -> bool {
        self.0.may_refuse(status)
    }

    fn executed(&self) -> u32 {
        self.0.executed()
    }

    fn offer(&mut self, way: TransferKind, content: &[u8]) -> (&'static [u8], Vec<u8>) {
        self.0.offer(way, content)
    }

    fn forget(&mut self) {}

    fn stored(&self) -> Option<Vec<u8>> {
        self.0.stored()
    }

    fn skips(&self) -> bool {
        false
    }
}

thread_local! {
    static STARTS: [OnceCell<Start>; 2] = const { [OnceCell::new(), OnceCell::new()] };
}

/// Start state of a model. It is cached, because parsing it takes longer than copying it.
fn start_of(model: Model) -> Start {
    STARTS.with(|starts| starts[usize::from(model == Fs100)].get_or_init(|| start(model)).clone())
}

fn link_to(model: Model, faults: FaultSpec) -> Link<Simulated> {
    Link::new(Simulated::new(&start_of(model), &faults), faults)
}

#[test]
fn exchanges_keep_their_guarantees_under_every_fault() {
    for model in MODELS {
        for text in FAULTS {
            for seed in 0..EXCHANGE_SEEDS {
                let faults = spec(text, seed);
                check_exchanges(&faults, link_to(model, faults.clone()));
            }
        }
    }
}

#[test]
fn executes_everything_once_without_faults() {
    for model in MODELS {
        for text in ["seed=0", "delay=0..50ms"] {
            let (all, executed) = exchanges(link_to(model, spec(text, 3)));
            assert!(all.iter().all(has_valid_answer), "{text}");
            assert_eq!((all.len(), executed), (12, 9), "{text}");
        }
    }
}

/// Runs transfers of every kind and size with these faults.
fn transfers(model: Model, text: &str, seeds: u64) -> Vec<End> {
    let mut ends = Vec::new();
    for way in TRANSFER_KINDS {
        for size in SIZES {
            for seed in 0..seeds {
                let mut link = link_to(model, spec(text, seed));
                ends.push(transfer(&mut link, way, &content(size, seed + 1), &Ids::default()));
            }
        }
    }
    ends
}

#[test]
fn transfers_keep_their_guarantees_under_every_fault() {
    let mut seen = BTreeSet::new();
    for model in MODELS {
        for text in FAULTS {
            seen.extend(transfers(model, text, TRANSFER_SEEDS));
        }
    }
    // Every kind of end must occur. If one is missing, the checks above did not test it.
    assert!(seen.into_iter().eq([End::Success, End::Refused, End::NoAnswer, End::Unknown, End::Unopened]));
}

#[test]
fn every_transfer_succeeds_without_loss() {
    for text in ["seed=0", "delay=0..50ms", "dup=20%", "dup=100%", "reorder=15%"] {
        let ends = transfers(Dx200, text, 10);
        assert_eq!(successes(&ends), ends.len(), "{text}");
    }
}

#[test]
fn transfers_survive_moderate_loss() {
    check_moderate_loss(&transfers(Dx200, "drop=5%,dup=2%,delay=0..50ms,reorder=3%", TRANSFER_SEEDS));
}

/// Late datagrams of one transfer can arrive during the next transfer on the same link.
#[test]
fn consecutive_transfers_do_not_mix() {
    for text in FAULTS {
        for seed in 0..TRANSFER_SEEDS {
            let mut link = link_to(Dx200, spec(text, seed));
            let ids = Ids::starting_at(250);
            for round in 0..4 {
                for way in TRANSFER_KINDS {
                    transfer(&mut link, way, &content(958, seed << 8 | round | 128), &ids);
                }
                exchange(&mut link, Class::Move, &ids);
            }
        }
    }
}

/// The first request creates the backup, so its answer comes much later. The second request fetches the backup.
#[test]
fn batch_backup_is_complete_or_fails() {
    let mut seen = BTreeSet::new();
    for model in MODELS {
        for text in FAULTS {
            for seed in 0..TRANSFER_SEEDS {
                let mut link = link_to(model, spec(text, seed));
                let ids = Ids::default();
                seen.insert((backup(&mut link, &ids, Some(LONG)), backup(&mut link, &ids, None)));
            }
        }
    }
    let both_ids = |first, second| seen.contains(&(first, second));
    assert!(both_ids(End::Success, End::Success) && both_ids(End::NoAnswer, End::Success), "{seen:?}");
    assert!(seen.iter().all(|(_, second)| *second != End::Unknown));
}

/// Sends one of the two requests of a batch backup. Only the first request has a `first_wait`.
fn backup(link: &mut Link<Simulated>, ids: &Ids, first_wait: Option<Duration>) -> End {
    let order = batch_backup();
    let request = file_request(order.service, &order.data);
    let mut session = Download::new(&request, 1 << 20, Policy::default(), ids);
    if let Some(wait) = first_wait {
        session = session.with_first_wait(wait);
    }
    let expected = link.controller.resting_state().file(&order.data);
    let run = link.run(&mut session, |_| unreachable!("a download asks for no content"));
    let what = format!("{:?} idle for {:?}, {:?}", run.outcome, run.idle, session.counters());
    assert!(run.idle <= first_wait.unwrap_or(Policy::default().patience()), "{what}");
    match run.outcome {
        DownloadEnd::Finished => End::Success,
        DownloadEnd::Complete { bytes, .. } => {
            assert_eq!((Some(&run.data), bytes), (expected.as_ref(), 5000), "{what}");
            End::Success
        }
        DownloadEnd::Refused { status, .. } => {
            assert!(link.controller.may_refuse(status), "{what}");
            End::Refused
        }
        DownloadEnd::NoAnswer { .. } => End::NoAnswer,
        _ => panic!("{what}"),
    }
}
