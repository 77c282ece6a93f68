//! Sessions that get random answers: noise or nearly valid frames. Each session must end, and send few frames.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use std::time::Duration;

use armctl_controller::yerc::files;
use armctl_controller::yerc::query::{Query, ReadStatus};
use armctl_controller::yerc::session::{Download, Exchange, Ids, Policy, Upload};
use armctl_controller::yerc::simulator::{Outgoing, Simulator, Start};
use armctl_controller::yerc::wire::{ANSWER_BIT, AnswerFrame, Division, LAST_BLOCK, MAX_DATA, RequestFrame, Status};
use armctl_controller::{Now, Session, Step};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{Index, select};

/// Maximum length of a frame: the header and the maximum data.
const MAX_DATAGRAM: usize = 32 + MAX_DATA;
/// Longest pause between two datagrams, in milliseconds. It is longer than the timer of an idle transfer in the
/// simulator and than the timeout of a session.
const MAX_STEPS: u64 = 6000;

/// Damage to a frame during its transmission.
#[derive(Debug, Clone)]
enum Damage {
    None,
    Bytes(Vec<(Index, u8)>),
    Cut(Index),
    Longer(Vec<u8>),
    Replaced(Vec<u8>),
}

impl Damage {
    fn of(&self, frame: &[u8]) -> Vec<u8> {
        let mut frame = frame.to_vec();
        match self {
            Self::None => {}
            Self::Bytes(changes) => {
                for (at, byte) in changes {
                    let at = at.index(frame.len());
                    frame[at] = *byte;
                }
            }
            Self::Cut(at) => frame.truncate(at.index(frame.len())),
            Self::Longer(tail) => frame.extend(tail),
            Self::Replaced(noise) => frame.clone_from(noise),
        }
        frame
    }
}

fn damage() -> impl Strategy<Value = Damage> {
    prop_oneof![
        6 => Just(Damage::None),
        2 => vec((any::<Index>(), any::<u8>()), 1..6).prop_map(Damage::Bytes),
        1 => any::<Index>().prop_map(Damage::Cut),
        1 => noise(1..=40).prop_map(Damage::Longer),
        1 => noise(0..=600).prop_map(Damage::Replaced),
    ]
}

/// Random bytes of this length. This is faster than one strategy per byte.
fn noise(len: std::ops::RangeInclusive<usize>) -> impl Strategy<Value = Vec<u8>> {
    (len, any::<u64>()).prop_map(|(len, seed)| {
        let mut bytes = vec![0; len];
        fastrand::Rng::with_seed(seed).fill(&mut bytes);
        bytes
    })
}

/// Block numbers near every limit.
fn block() -> impl Strategy<Value = u32> {
    prop_oneof![0_u32..5, (0_u32..5).prop_map(|block| block | LAST_BLOCK), any::<u32>()]
}

/// All datagrams that the simulator sends at `now`.
fn drain(simulator: &mut Simulator, now: Now) -> Vec<Outgoing> {
    std::iter::from_fn(|| simulator.transmit(now)).collect()
}

/// The simulator limits the number of answers that no client has fetched.
#[test]
fn simulator_limits_its_cached_answers() {
    let mut simulator = Simulator::new(Start::default());
    for _ in 0..6000 {
        simulator.receive(Now::ZERO, Division::Robot, 0, &ReadStatus.request().frame(1));
    }
    assert_eq!(drain(&mut simulator, Now::ZERO).len(), 4096);
}

/// An answer to a session. By default, it has the id of the last request. The rest is random.
type Answer = (u64, Option<u8>, u32, Status, Vec<u8>, Damage);

fn answer() -> impl Strategy<Value = Answer> {
    let status = prop_oneof![
        6 => Just(Status::OK),
        1 => select(vec![0xD8FA, 0xFFF6, 0xE444, 0xE29C, 0xE4A1, 0x2010]).prop_map(Status::refused),
        1 => (any::<u8>(), 0_u8..3, any::<u32>()).prop_map(|(code, size, added)| {
            // The added status is limited to the size that its field has.
            let added = if size == 0 { 0 } else if size == 1 { added & 0xFFFF } else { added };
            Status { code, added_size: size, added }
        }),
    ];
    let wait = prop_oneof![Just(0_u64), 0_u64..50, 0_u64..=MAX_STEPS];
    let id = prop_oneof![8 => Just(None), 1 => any::<u8>().prop_map(Some)];
    let data = prop_oneof![Just(Vec::new()), noise(0..=MAX_DATA), noise(MAX_DATA..=MAX_DATA)];
    (wait, id, block(), status, data, damage())
}

/// Runs a session to its end. The session gets the answers of a script, and after them no answers.
fn run<S: Session>(session: &mut S, script: Vec<Answer>, feed: impl Fn(&mut S)) -> Result<(), TestCaseError> {
    let deadline = Policy::default().patience();
    let (mut now, mut last, mut script) = (Now::ZERO, Vec::<u8>::new(), script.into_iter());
    let (mut sends, mut answers, mut calls) = (0_usize, 0, 0);
    for _ in 0..10_000 {
        match session.poll(now) {
            Step::Send(bytes) => {
                prop_assert!(bytes.len() <= MAX_DATAGRAM);
                RequestFrame::parse(&bytes).unwrap();
                last = bytes;
                sends += 1;
            }
            Step::Data(piece) => prop_assert!((1..=MAX_DATA).contains(&piece.len())),
            Step::Feed => {
                feed(session);
                calls += 1;
                prop_assert!(calls <= sends + 2, "asked for more than was taken");
            }
            Step::Wait(until) => {
                prop_assert!(until > now && until <= now + deadline, "{until:?} at {now:?}");
                let Some((wait, id, block, status, data, damage)) = script.next() else {
                    now = until;
                    continue;
                };
                now = until.min(now + Duration::from_millis(wait));
                let frame = AnswerFrame {
                    division: if last[9] == 2 { Division::File } else { Division::Robot },
                    ack: true,
                    id: id.unwrap_or(last[11]),
                    block,
                    service: last[29] | ANSWER_BIT,
                    status,
                    data: &data,
                };
                session.handle(now, &damage.of(&frame.emit()));
                answers += 1;
            }
            Step::Done(_) => {
                // A session sends at most one frame per answer, and repetitions of the last frame.
                let most = answers + 2 + usize::try_from(Policy::default().retries).unwrap() * (answers + 1);
                prop_assert!(sends <= most, "{sends} frames for {answers} answers");
                prop_assert!(matches!(session.poll(now + deadline), Step::Done(_)), "the end does not last");
                return Ok(());
            }
        }
    }
    Err(TestCaseError::fail("no end"))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn exchange_ends_with_every_answer(script in vec(answer(), 0..40), repeatable: bool) {
        let frame = ReadStatus.request().frame(0);
        let request = RequestFrame::parse(&frame).unwrap();
        let mut session = Exchange::new(&request, repeatable, Policy::default(), &Ids::default());
        run(&mut session, script, |_| ())?;
    }

    #[test]
    fn download_ends_with_every_answer(script in vec(answer(), 0..40), limit in 0_u64..3000) {
        let frame = files::FileName::new("A.JBI").unwrap().save().frame(0);
        let request = RequestFrame::parse(&frame).unwrap();
        let mut session = Download::new(&request, limit, Policy::default(), &Ids::default());
        run(&mut session, script.clone(), |_| ())?;
        prop_assert!(session.bytes() <= limit);
        for (_, _, block, status, data, damage) in script {
            let frame = AnswerFrame {
                division: Division::File, ack: true, id: 1, block, service: 0x96, status, data: &data,
            };
            if let Some(ack) = session.linger(&damage.of(&frame.emit())) {
                RequestFrame::parse(&ack).unwrap();
            }
        }
    }

    #[test]
    fn upload_ends_with_every_answer(script in vec(answer(), 0..40), piece in MAX_DATA + 1..2000) {
        let frame = files::FileName::new("A.JBI").unwrap().load().frame(0);
        let request = RequestFrame::parse(&frame).unwrap();
        let mut session = Upload::new(&request, Policy::default(), &Ids::default());
        let content = vec![7; piece];
        run(&mut session, script, |session| session.feed(&content, false))?;
    }

    #[test]
    fn upload_of_known_length_ends_with_every_answer(script in vec(answer(), 0..40), size in 0_usize..2000) {
        let frame = files::FileName::new("A.JBI").unwrap().load().frame(0);
        let request = RequestFrame::parse(&frame).unwrap();
        let mut session = Upload::new(&request, Policy::default(), &Ids::default());
        let content = vec![7; size];
        run(&mut session, script, |session| session.feed(&content, true))?;
        prop_assert!(session.taken() <= size as u64);
    }
}
