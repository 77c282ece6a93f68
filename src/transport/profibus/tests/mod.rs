//! Tests of master and slave on a line in virtual time. The line has character timing and faults.

mod peers;
mod survey;
#[cfg(unix)]
mod terminal;

use std::time::Duration;

use proptest::prelude::*;

use super::Now;
use super::error::ProfibusError;
use super::master::{Master, State, View};
use super::rates::{RATES, Rate};
use super::settings::Settings;
use super::slave::{Setup, Slave, SlaveFault};
use super::wire::{Piece, Stream, Telegram};
use crate::fault::LineFaultSpec;
use crate::image::ImagePeer;
use crate::line::Wire;
use crate::sim::Peer;
use crate::testing::hex;

const MS: Duration = Duration::from_millis(1);
const SEC: Duration = Duration::from_secs(1);
const SIZE: usize = 48;

/// Resting image: only SI(00) and SI(06) are on.
fn resting() -> Vec<u8> {
    let mut image = vec![0; SIZE];
    image[32] = 0x41;
    image
}

fn image(number: u8) -> Vec<u8> {
    let mut image = resting();
    image[0] = number;
    image
}

/// Echo peer that records every change of the image.
#[derive(Debug, Default)]
struct Echo {
    image: Option<Vec<u8>>,
    history: Vec<Option<Vec<u8>>>,
}

impl ImagePeer for Echo {
    fn input(&mut self, _now: Now, image: Option<&[u8]>) {
        let image = image.map(<[u8]>::to_vec);
        if self.history.last() != Some(&image) {
            self.history.push(image.clone());
        }
        self.image = image;
    }

    fn output(&mut self, _now: Now) -> Option<Vec<u8>> {
        Some(self.image.clone().unwrap_or_else(|| vec![0; SIZE]))
    }

    fn wake(&self) -> Option<Now> {
        None
    }
}

/// Peer that changes something every five milliseconds.
#[derive(Debug)]
struct Scanning {
    next: Now,
}

impl ImagePeer for Scanning {
    fn input(&mut self, _now: Now, _image: Option<&[u8]>) {}

    fn output(&mut self, now: Now) -> Option<Vec<u8>> {
        self.next = now + 5 * MS;
        None
    }

    fn wake(&self) -> Option<Now> {
        Some(self.next)
    }
}

#[test]
fn peer_works_without_a_master() {
    let setup = Setup::sample_controller(Rate::from_name("500k").unwrap());
    let mut slave = Slave::new(setup, Scanning { next: 5 * MS });
    for number in 1..10 {
        assert_eq!((slave.wake(), slave.transmit(number * 5 * MS)), (Some(number * 5 * MS), None));
    }
}

struct World {
    now: Now,
    master: Master,
    slave: Slave<Echo>,
    wire: Wire,
    sent: Vec<(Now, Vec<u8>)>,
    heard: Vec<u8>,
}

impl World {
    fn new(rate: &str, faults: &str) -> Self {
        Self::with(Settings::new(5, Rate::from_name(rate).unwrap(), resting()), faults)
    }

    fn with(settings: Settings, faults: &str) -> Self {
        let rate = settings.rate;
        let faults = (!faults.is_empty()).then(|| faults.parse::<LineFaultSpec>().unwrap());
        Self {
            now: Now::ZERO,
            master: Master::new(Now::ZERO, settings).unwrap(),
            slave: Slave::new(Setup::sample_controller(rate), Echo::default()),
            wire: Wire::new(Some(rate.pace()), faults),
            sent: Vec::new(),
            heard: Vec::new(),
        }
    }

    /// Runs for `time`, or until the condition is true.
    fn run(&mut self, time: Duration, mut until: impl FnMut(&View) -> bool) -> View {
        let end = self.now + time;
        loop {
            while let Some(bytes) = self.master.poll(self.now) {
                self.wire.send(self.now, &bytes);
                self.sent.push((self.now, bytes));
            }
            let view = self.master.view();
            if until(&view) || self.now >= end {
                return view;
            }
            let due = self.master.due().into_iter().chain(self.wire.due(&self.slave)).min().unwrap_or(end);
            self.now = due.max(self.now + Duration::from_nanos(1)).min(end);
            self.wire.run(self.now, &mut self.slave);
            let mut buffer = [0; 64];
            loop {
                let len = self.wire.take(self.now, &mut buffer);
                if len == 0 {
                    break;
                }
                self.heard.extend(&buffer[..len]);
                self.master.handle(self.now, &buffer[..len]);
            }
        }
    }

    fn open(&mut self) -> View {
        let view = self.run(10 * SEC, |view| view.state != State::Opening);
        assert_eq!(view.state, State::Open, "{:?}", view.last_error);
        view
    }

    fn fails(&mut self) -> String {
        let view = self.run(30 * SEC, |view| view.state == State::Closed);
        assert_eq!(view.state, State::Closed);
        view.last_error.expect("an error").to_string()
    }
}

#[test]
fn start_sequence_matches_a_recording() {
    let mut world = World::new("500k", "");
    world.slave.set_fault(None);
    world.open();
    // armctl sends Get_Cfg, but the other implementations do not. So after Get_Cfg, the frame count bit of armctl is
    // the inverse of their bit.
    let expected = [
        "10 05 02 49 50 16",
        "68 05 05 68 85 82 6D 3C 3E EE 16",
        "68 05 05 68 85 82 5D 3B 3E DD 16",
        "68 0C 0C 68 85 82 7D 3D 3E 88 32 01 0B 12 34 00 0B 16",
        "68 08 08 68 85 82 5D 3E 3E C0 D7 D7 4E 16",
        "68 05 05 68 85 82 7D 3C 3E FE 16",
        "68 07 07 68 FF 82 46 3A 3E 00 00 3F 16",
        "68 33 33 68 05 02 5D 0000000000000000000000000000000000000000000000000000000000000000 41
         000000000000000000000000000000 A5 16",
        "DC 02 02",
    ];
    world.run(MS, |_| false);
    let sent: Vec<Vec<u8>> = world.sent.iter().map(|(_, bytes)| bytes.clone()).collect();
    assert_eq!(sent, expected.map(hex));
}

#[test]
fn sends_the_resting_image_first_and_exchanges_images() {
    let mut world = World::new("500k", "");
    let view = world.open();
    assert_eq!(view.input.unwrap().image[..], resting());
    let change = world.master.set_image(view.generation, &image(7)).unwrap();
    let view =
        world.run(SEC, |view| view.sent >= change && view.input.as_ref().is_some_and(|input| input.image[0] == 7));
    assert_eq!(view.input.unwrap().image[..], image(7));
    assert_eq!(world.slave.peer.history, [Some(resting()), Some(image(7))]);
    world.master.close(world.now);
    let view = world.run(SEC, |view| view.state == State::Closed);
    assert_eq!((view.last_error, world.slave.owner), (None, None));
    assert_eq!(world.slave.peer.history.last(), Some(&None));
    assert_eq!(world.sent.last().unwrap().1[7..16], hex("3D 3E 40 00 00 00 12 34 00")[..]);
}

#[test]
fn every_fault_of_a_slave_has_a_message_of_its_own() {
    for (fault, message) in [
        (
            SlaveFault::Mute,
            "no answer from station 5 to the status request (4 attempts, 10 ms each; no bytes received)",
        ),
        (SlaveFault::Locked, "master 9 owns station 5"),
        (SlaveFault::OtherIdent, "station 5 has ident number 0x1235, not 0x1234"),
        (
            SlaveFault::OtherSize,
            "the configuration C0C7C7 has 16 input bytes from station 5 and 16 output bytes, not 48 and 48",
        ),
        (SlaveFault::NoConfiguration, "refuses the configuration C0D7D7; it needs C0D7D7"),
        (SlaveFault::NoParameters, "refuses the user parameters 000000"),
        (SlaveFault::NotReady, "is not ready for data after 50"),
        (SlaveFault::WrongSize, "station 5 sent 47 bytes of data, not 48"),
        (SlaveFault::Inactive, "station 5 refused Slave_Diag: RS, service not active"),
        (SlaveFault::Master, "station 5 is a master, not a slave"),
        (SlaveFault::Token, "another master is on the bus: station 9 (it passed the token)"),
    ] {
        let settings = Settings { ident: Some(0x1234), ..Settings::new(5, RATES[5], resting()) };
        let mut world = World::with(settings, "");
        world.slave.set_fault(Some(fault));
        let error = world.fails();
        assert!(error.contains(message), "{fault:?}: {error}");
        assert_eq!(world.slave.peer.history.iter().flatten().find(|shown| **shown != resting()), None, "{fault:?}");
        // The slave must not stay locked after a failed opening.
        if !matches!(fault, SlaveFault::Token | SlaveFault::Mute) {
            assert_eq!(world.slave.owner, None, "{fault:?}");
        }
    }
    assert_eq!(SlaveFault::ALL.len(), 14, "a new fault wants a message here, or a test that it does no harm");
}

#[test]
fn recovers_from_single_faults_by_repetition() {
    for fault in [SlaveFault::Lose, SlaveFault::BadFcs, SlaveFault::Diagnosis] {
        let mut world = World::new("500k", "");
        world.slave.set_fault(Some(fault));
        let view = world.open();
        let change = world.master.set_image(view.generation, &image(1)).unwrap();
        let view = world.run(SEC, |view| view.sent >= change);
        let view = world.run(SEC, |now| now.statistics.sent >= view.statistics.sent + 20);
        assert_eq!(view.state, State::Open, "{fault:?}: {:?}", view.last_error);
        assert_eq!(view.statistics.repeated > 0, fault != SlaveFault::Diagnosis, "{fault:?}");
        // If a request is repeated, the slave repeats its answer without executing the request again.
        assert!(world.slave.exchanges().abs_diff(view.statistics.sent) <= 1, "{fault:?}");
        assert_eq!(world.slave.peer.history, [Some(resting()), Some(image(1))], "{fault:?}");
    }
}

#[test]
fn noise_that_looks_like_an_acknowledgement_is_no_image() {
    let mut world = World::new("500k", "");
    let view = world.open();
    for round in 1..=20 {
        // Only while a request waits, the byte can be taken for its answer.
        world.run(SEC, |now| now.statistics.sent > view.statistics.sent + round);
        world.master.handle(world.now, &hex("E5"));
    }
    let after = world.run(SEC, |now| now.statistics.sent > view.statistics.sent + 40);
    assert_eq!((after.state, after.generation), (State::Open, view.generation), "{:?}", after.last_error);
    assert!(after.statistics.unexpected > 0);
}

#[test]
fn restarted_slave_gets_the_resting_image() {
    let mut world = World::new("500k", "");
    let view = world.open();
    world.master.set_image(view.generation, &image(9)).unwrap();
    world.run(100 * MS, |_| false);
    world.slave.restart(world.now);
    let lost = world.run(SEC, |view| view.state == State::Lost);
    assert!(matches!(lost.last_error, Some(ProfibusError::Left { .. })), "{:?}", lost.last_error);
    let outdated = world.master.set_image(view.generation, &image(9));
    assert_eq!(outdated, Err(ProfibusError::Outdated));
    let again = world.run(10 * SEC, |view| view.state == State::Open);
    assert_eq!((again.state, again.generation), (State::Open, view.generation + 1));
    assert_eq!(world.slave.peer.history, [Some(resting()), Some(image(9)), None, Some(resting())]);
    assert_eq!(world.master.set_image(view.generation, &image(9)), Err(ProfibusError::Outdated));
}

#[test]
fn slave_leaves_data_exchange_without_its_master() {
    let mut world = World::new("500k", "");
    world.open();
    let died = world.now;
    // The master does not run here. Time passes only for the line and the slave.
    world.wire.run(died + 490 * MS, &mut world.slave);
    assert_eq!(world.slave.owner, Some(2));
    world.wire.run(died + 520 * MS, &mut world.slave);
    assert_eq!((world.slave.owner, world.slave.peer.image.as_ref()), (None, None));
}

#[test]
fn reconnects_a_silent_slave() {
    let mut world = World::new("500k", "");
    let view = world.open();
    world.slave.set_fault(Some(SlaveFault::Mute));
    let lost = world.run(SEC, |view| view.state == State::Lost);
    assert!(lost.last_error.unwrap().to_string().contains("to Data_Exchange (4 attempts"));
    world.slave.set_fault(None);
    let again = world.run(5 * SEC, |view| view.state == State::Open);
    assert_eq!((again.state, again.generation), (State::Open, view.generation + 1));
    assert_eq!(world.slave.peer.history.last(), Some(&Some(resting())));
}

#[test]
fn master_stays_silent_next_to_another_master() {
    for (heard, message) in [
        ("DC 03 04 DC 04 03", "another master is on the bus: station 4 (it passed the token)"),
        ("10 05 04 49 52 16", "another master is on the bus: station 4 (it sent a request)"),
        ("10 04 05 00 09 16", "another master is on the bus: station 4 (a station answered it)"),
        ("00 81 FF 03", "cannot decode the traffic on the bus at this bit rate (4 bytes)"),
    ] {
        let mut world = World::new("500k", "");
        world.master.handle(MS, &hex(heard));
        assert_eq!(world.fails(), message);
        assert!(world.sent.is_empty(), "{heard}");
    }
    // Opening a port can cause a noise character.
    let mut world = World::new("500k", "");
    world.master.handle(MS, &[0]);
    world.open();
}

#[test]
fn master_pauses_while_another_master_is_active() {
    let mut world = World::new("500k", "");
    let view = world.open();
    world.run(100 * MS, |_| false);
    world.master.handle(world.now, &hex("10 07 04 49 54 16"));
    let lost = world.master.view();
    assert_eq!(lost.last_error.unwrap().to_string(), "another master is on the bus: station 4 (it sent a request)");
    let (said, until) = (world.sent.len(), world.now + 3 * SEC);
    while world.now < until {
        world.run(500 * MS, |_| false);
        world.master.handle(world.now, &hex("10 07 04 49 54 16"));
    }
    assert_eq!(world.sent.len(), said);
    let again = world.run(5 * SEC, |view| view.state == State::Open);
    assert_eq!(again.generation, view.generation + 1);
}

#[test]
fn ignores_the_echo_of_an_adapter() {
    let mut world = World::new("500k", "echo");
    let view = world.open();
    assert!(view.details.echoes);
    let view = world.run(SEC, |view| view.statistics.sent >= 20);
    assert_eq!((view.statistics.repeated, view.statistics.noise, view.statistics.unexpected), (0, 0, 0));
    // With crossed wires or a dead slave, only an echo arrives. The master must not interpret the echo as an answer.
    let mut world = World::new("500k", "echo");
    world.slave.set_fault(Some(SlaveFault::Mute));
    assert!(world.fails().contains("only the echo of the adapter received"));
}

#[test]
fn cycles_are_kept_without_drift_and_without_bursts() {
    let mut world = World::new("500k", "");
    world.open();
    let view = world.run(20 * SEC, |_| false);
    assert!((999..=1001).contains(&view.statistics.sent), "{}", view.statistics.sent);
    assert_eq!(view.statistics.skipped, 0);
    // The computer is busy for some time. Missed cycles are not sent later.
    world.now += 110 * MS;
    world.wire.run(world.now, &mut world.slave);
    let after = world.run(100 * MS, |_| false);
    assert!((4..=6).contains(&after.statistics.skipped), "{}", after.statistics.skipped);
    assert!(after.statistics.sent - view.statistics.sent <= 6);
}

#[test]
fn full_load_is_within_ten_percent_of_the_bit_time() {
    for name in ["9.6k", "500k"] {
        let rate = Rate::from_name(name).unwrap();
        let settings = Settings { cycle: Some(Duration::ZERO), ..Settings::new(5, rate, resting()) };
        let mut world = World::with(settings, "");
        let view = world.open();
        let (start, before) = (world.now, view.statistics.received);
        let view = world.run(30 * SEC, |view| view.statistics.received >= before + 100);
        assert_eq!(view.statistics.received, before + 100, "{:?}", view.last_error);
        let cycle = world.now.saturating_sub(start) / 100;
        // An exchange consists of two telegrams of 57 characters, the pause before the request, and the delay of the
        // answer.
        let bits = rate.pace().time(2 * 57) + rate.bits(33 + 11);
        assert!(cycle <= bits * 11 / 10, "{name}: {cycle:?} for {bits:?}");
        assert!(cycle >= bits, "{name}: {cycle:?} is faster than the line");
    }
}

/// Sends commands in the way that a controller with an image needs: a number, then 0 before the next number. Returns
/// the confirmed commands and the commands that the slave received.
fn commands(seed: u64, faults: &str) -> (Vec<u8>, Vec<u8>, View) {
    let settings = Settings { retries: 6, slot: Some(10 * MS), ..Settings::new(5, RATES[5], resting()) };
    let mut world = World::with(settings, &format!("{faults},seed={seed}"));
    let mut done = Vec::new();
    let mut given = 0;
    while world.now < 25 * SEC && given < 200 {
        let view = world.run(15 * SEC, |view| view.state == State::Open || view.state == State::Closed);
        if view.state != State::Open {
            break;
        }
        let generation = view.generation;
        given += 1;
        let mut is_done = true;
        for number in [given, 0] {
            let Ok(_) = world.master.set_image(generation, &image(number)) else {
                is_done = false;
                break;
            };
            // The input must be from the slave, and must belong to this generation.
            let view = world.run(5 * SEC, |view| {
                let is_shown =
                    |input: &super::master::Input| input.generation == generation && input.image[0] == number;
                view.generation != generation || view.state != State::Open || view.input.as_ref().is_some_and(is_shown)
            });
            is_done &= view.state == State::Open && view.generation == generation;
        }
        if is_done {
            done.push(given);
        }
    }
    let history = &world.slave.peer.history;
    let shown: Vec<u8> = history.iter().map(|shown| shown.as_ref().map_or(0, |shown| shown[0])).collect();
    let mut before = 0;
    let mut executed = Vec::new();
    for number in shown {
        if number != before && number != 0 {
            executed.push(number);
        }
        before = number;
    }
    (done, executed, world.master.view())
}

#[test]
fn faults_never_repeat_or_change_a_command() {
    let mut exchanges = 0;
    let mut repeated = 0;
    for seed in 0..26 {
        let (done, executed, view) = commands(seed, "parity=0.2%,drop=0.1%,dup=0.1%");
        assert!(executed.windows(2).all(|pair| pair[0] < pair[1]), "seed {seed}: {executed:?}");
        assert!(done.iter().all(|number| executed.contains(number)), "seed {seed}: {done:?} of {executed:?}");
        exchanges += view.statistics.sent;
        repeated += view.statistics.repeated;
    }
    assert!(exchanges >= 10_000, "{exchanges}");
    assert!(repeated > exchanges / 20, "{repeated} of {exchanges}: hardly any faults");
}

#[test]
fn delayed_answer_is_not_used_for_the_next_request() {
    // The delay can be longer than the slot time. An answer can then arrive after its request was repeated.
    let (done, executed, view) = commands(3, "delay=0..14ms");
    assert!(executed.windows(2).all(|pair| pair[0] < pair[1]), "{executed:?}");
    assert!(done.iter().all(|number| executed.contains(number)), "{done:?} of {executed:?}");
    assert!(view.statistics.unexpected > 0, "nothing came late");
}

#[test]
fn master_sends_only_valid_telegrams() {
    let mut world = World::new("500k", "parity=1%,seed=5");
    world.run(5 * SEC, |_| false);
    for (_, bytes) in &world.sent {
        let mut stream = Stream::default();
        stream.push(bytes);
        assert!(matches!(stream.next_piece(), Some(Piece::Telegram(..))), "{bytes:02X?}");
        assert!(stream.is_empty());
    }
    let begins =
        |bytes: &[u8]| matches!(Telegram::parse(bytes), Ok(super::wire::Parsed::Whole(Telegram::Token { .. }, _)));
    assert!(world.sent.iter().any(|(_, bytes)| begins(bytes)), "no token");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn no_bytes_make_either_end_panic(
        pieces in proptest::collection::vec(
            (0_u32..50, proptest::collection::vec(prop_oneof![any::<u8>(), Just(0x68), Just(0x10), Just(5), Just(2)], 0..80)), 0..30,
        ),
        has_opened in any::<bool>(),
    ) {
        let mut world = World::new("500k", "");
        if has_opened {
            world.open();
        }
        for (pause, bytes) in pieces {
            world.run(pause * MS, |_| false);
            world.master.handle(world.now, &bytes);
            world.slave.receive(world.now, 0, &bytes);
        }
    }
}
