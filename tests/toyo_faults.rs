//! The session of the Toyo family on lines that lose, double, damage, delay or echo characters.
//!
//! The tests run in virtual time, with a controller that counts its executions. Blocks have a fixed width and no
//! checksum. One lost or doubled character is detected. A lost and a doubled character in the same block are not
//! detected, and neither is noise that changes a digit. For these faults, only the number of executions is checked.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use std::collections::HashMap;
use std::time::Duration;

use armctl_controller::toyo::field::Value;
use armctl_controller::toyo::request::{Answer, Request};
use armctl_controller::toyo::session::{ExchangeResult, Framed, Framer, LineSession, Policy};
use armctl_controller::toyo::table::Command;
use armctl_controller::{Session as _, Step};
use armctl_transport::line::{InProcessLine, Pace};
use armctl_transport::sim::Peer;
use tokio::time::Instant;

/// Number of bits of a character with 8 data bits, even parity and one stop bit. The line has 9600 baud.
const BITS: u32 = 11;
const BAUD: u32 = 9600;
const TIMEOUT: Duration = Duration::from_secs(1);

/// A controller with counters. Each order sets one counter to a value that no other order uses.
#[derive(Debug, Default)]
struct Counters {
    framer: Framer,
    is_damaged: bool,
    counters: HashMap<i32, i32>,
    /// How often each value was set.
    executed: HashMap<i32, u32>,
    /// Total number of executions.
    executions: u32,
    answers: Vec<Vec<u8>>,
}

impl Counters {
    fn execute_command(&mut self, block: &str) -> String {
        let request = match Request::parse(block) {
            Ok(request) if request.check().is_ok() => request,
            _ => return "@NG".to_owned(),
        };
        let number = |name| request.record().number(name).unwrap();
        match request.command() {
            Command::Mcst => {
                self.counters.insert(number("counter"), number("count"));
                self.executions += 1;
                *self.executed.entry(number("count")).or_default() += 1;
                "@OK".to_owned()
            }
            Command::Mcnt => {
                let count = self.counters.get(&number("counter")).copied().unwrap_or(0);
                format!("@MCNT CN{:02}={count:04}", number("counter"))
            }
            _ => "@NG".to_owned(),
        }
    }
}

impl Peer for Counters {
    fn receive(&mut self, _now: Duration, _channel: usize, bytes: &[u8]) {
        for byte in bytes {
            let Some(framed) = self.framer.push(*byte).0 else { continue };
            // A controller does not answer a block with a parity error (TO 1-3).
            if !std::mem::take(&mut self.is_damaged)
                && let Framed::Block(block) = framed
            {
                let answer = self.execute_command(&block);
                self.answers.push(format!("{answer}\r\n").into_bytes());
            }
        }
    }

    fn damaged(&mut self, _now: Duration, _channel: usize) {
        self.is_damaged = true;
    }

    fn transmit(&mut self, _now: Duration) -> Option<(usize, Vec<u8>)> {
        if self.answers.is_empty() { None } else { Some((0, self.answers.remove(0))) }
    }

    fn wake(&self) -> Option<Duration> {
        None
    }
}

/// Results of the exchanges on one line.
#[derive(Debug, Default, PartialEq, Eq)]
struct Tally {
    answered: u32,
    refused: u32,
    open: u32,
    /// Reads that returned another value than the stored value.
    wrong: u32,
    /// Orders that were executed more than once. `lost` counts confirmed orders that were not executed.
    doubled: u32,
    lost: u32,
    /// Number of executed orders, whatever their result was.
    executions: u32,
}

async fn exchange(line: &mut LineSession, wire: &mut InProcessLine<Counters>, began: Instant) -> ExchangeResult {
    let mut buffer = [0; 256];
    loop {
        let now = began.elapsed();
        match line.poll(now) {
            Step::Send(bytes) => wire.send(&bytes),
            Step::Wait(until) => {
                let received = wire.receive(&mut buffer, began + until).await.unwrap_or(0);
                line.handle(began.elapsed(), &buffer[..received]);
            }
            Step::Done(ended) => return ended,
            Step::Data(_) | Step::Feed => unreachable!("lines have no payload"),
        }
    }
}

/// Runs a hundred orders, with a read after each order.
async fn run_exchanges(faults: &str, seed: u64) -> Tally {
    const EXCHANGES: i32 = 100;
    let pace = Pace::new(BAUD, BITS);
    let spec = format!("{faults},seed={seed}").parse().expect("faults");
    let mut wire = InProcessLine::new(Counters::default(), Some(pace), Some(spec));
    let mut line = LineSession::new(Policy { timeout: TIMEOUT, retries: 3, character: pace.time(1) });
    let began = Instant::now();
    let mut tally = Tally::default();
    for order in 1..=EXCHANGES {
        let counter = order % 7 + 1;
        let set = Request::new(Command::Mcst, vec![Value::Number(counter), Value::Number(order)]).unwrap();
        line.begin(&set, false);
        let started = Instant::now();
        let ended = exchange(&mut line, &mut wire, began).await;
        assert!(started.elapsed() <= 4 * TIMEOUT, "an order ends in time: {:?}", started.elapsed());
        let executed = wire.peer().executed.get(&order).copied().unwrap_or(0);
        tally.doubled += executed.saturating_sub(1);
        match ended {
            ExchangeResult::Answered(block) => match set.answer(&block).unwrap() {
                Answer::Done => {
                    tally.answered += 1;
                    tally.lost += u32::from(executed == 0);
                }
                Answer::Refused => tally.refused += 1,
                Answer::Data(_) => panic!("an order has no data"),
            },
            ExchangeResult::NoAnswer | ExchangeResult::InvalidAnswer { .. } => tally.open += 1,
        }
        let read = Request::new(Command::Mcnt, vec![Value::Number(counter)]).unwrap();
        line.begin(&read, true);
        let started = Instant::now();
        let ended = exchange(&mut line, &mut wire, began).await;
        assert!(started.elapsed() <= 12 * TIMEOUT, "a read ends in time: {:?}", started.elapsed());
        let stored = wire.peer().counters.get(&counter).copied().unwrap_or(0);
        if let ExchangeResult::Answered(block) = ended
            && let Answer::Data(record) = read.answer(&block).unwrap()
        {
            tally.wrong += u32::from(record.number("count") != Some(stored));
        }
    }
    tally.executions = wire.peer().executions;
    tally
}

fn virtual_time() -> tokio::runtime::Runtime {
    tokio::runtime::Builder::new_current_thread().enable_time().start_paused(true).build().expect("a runtime")
}

/// Tests each fault alone and combinations of faults, with many seeds.
#[test]
fn faults_never_double_lose_or_confuse_orders() {
    let grid = [
        "drop=0.5%",
        "drop=5%",
        "dup=0.5%",
        "dup=5%",
        "parity=1%",
        "parity=10%",
        "delay=0..50ms",
        // An answer can come after the timeout, but still within the time in which a late answer is discarded.
        "delay=0..900ms",
        "echo",
        "echo,drop=1%",
        "echo,dup=3%,delay=0..100ms",
        "drop=2%,parity=2%,delay=0..400ms",
        "drop=20%",
    ];
    for faults in grid {
        let mut all = Tally::default();
        for seed in 0..25 {
            let tally = virtual_time().block_on(run_exchanges(faults, seed));
            assert_eq!((tally.doubled, tally.lost, tally.wrong), (0, 0, 0), "{faults}, seed {seed}: {tally:?}");
            all.answered += tally.answered;
            all.open += tally.open;
            all.refused += tally.refused;
        }
        // The faults must have an effect, but some orders must also succeed.
        let has_effect = faults == "delay=0..50ms" || faults == "echo" || all.open + all.refused > 0;
        assert!(has_effect && all.answered > 0, "{faults}: {all:?}");
    }
}

#[test]
fn no_damage_executes_an_order_twice() {
    for faults in ["noise=0.5%", "noise=5%", "drop=5%,dup=5%", "noise=1%,drop=1%,dup=1%,parity=1%,delay=0..200ms,echo"]
    {
        for seed in 0..25 {
            let tally = virtual_time().block_on(run_exchanges(faults, seed));
            assert!(tally.executions <= 100, "{faults}, seed {seed}: {tally:?}");
        }
    }
}

#[test]
fn faultless_line_is_as_fast_as_its_characters() {
    let time = virtual_time().block_on(async {
        let began = Instant::now();
        let tally = run_exchanges("drop=0%", 0).await;
        assert_eq!(tally, Tally { answered: 100, executions: 100, ..Tally::default() });
        began.elapsed()
    });
    // "@MCST CN01=0001\r\n" and "@OK\r\n", "@MCNT CN=01\r\n" and "@MCNT CN01=0001\r\n" have 17 + 5 + 13 + 17
    // characters. The controller answers at the CR of a request, so the LF of a request needs no additional time.
    let characters = Pace::new(BAUD, BITS).time(100 * (16 + 5 + 12 + 17));
    assert!(time >= characters && time < characters + Duration::from_millis(200), "{time:?} for {characters:?}");
}
