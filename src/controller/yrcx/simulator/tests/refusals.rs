//! Invalid commands are refused. The checks of the simulator and of the client are independent, and must have the same
//! result.

use fastrand::Rng;

use super::*;
use crate::yrcx::order::Order;
use crate::yrcx::simulator::request::Request;
use crate::yrcx::table::{ROWS, Row};

/// Valid commands, at least one for each row.
fn sendable() -> Vec<Words> {
    let mut all: Vec<Words> = examples::examples().into_iter().map(|(_, words, _)| words).collect();
    for row in ROWS {
        let of = |words: &&Words| Row::from_word(words[0]).unwrap();
        let alike = |words: &&Words| of(words).request == row.request && of(words).rules == row.rules;
        let like = all.iter().find(alike).or_else(|| all.iter().find(|words| of(words).section == row.section));
        let mut words = *like.unwrap_or_else(|| panic!("no example is like {}", row.id));
        words[0] = words[0] & 0xF000 | row.code;
        all.push(words);
    }
    all
}

#[test]
fn every_command_is_answered() {
    let mut seen = 0;
    for words in sendable().iter().filter(|words| words[0] != 0) {
        let row = Row::from_word(words[0]).unwrap();
        let mut bench = Bench::default();
        bench.begin(words);
        if row.pace == crate::yrcx::table::DurationClass::Jog {
            bench.set(input::STOP, false);
        }
        let answer = bench.end();
        assert_ne!(answer[..3], [0x4000, 12, 75], "{}: {}", row.id, bench.console("why"));
        assert_ne!(answer[..3], [0x4000, 4, 202], "{}: {}", row.id, bench.console("why"));
        seen += 1;
    }
    assert!(seen >= 96 + 110, "{seen}");
}

#[test]
fn both_checks_agree_on_every_word() {
    let commands = sendable();
    let mut random = Rng::with_seed(4);
    let mut refused = 0;
    for turn in 0..60_000 {
        let mut words = commands[random.usize(..commands.len())];
        for _ in 0..random.usize(1..=2) {
            let at = random.usize(..16);
            words[at] = match random.u32(..4) {
                0 => words[at] ^ 1 << random.u32(..16),
                1 => random.u16(..),
                2 => random.u16(..40),
                _ => 0,
            };
        }
        let (client, simulator) = (Order::parse(&words), Request::read(&words));
        match (&client, &simulator) {
            // The simulator is stricter here than the decoder of the client: it refuses padding of different
            // characters. The client never sends such padding.
            (Ok(_), Err(fault)) if fault.why.ends_with("characters after the end") => {}
            _ => assert_eq!(
                client.is_ok(),
                simulator.is_ok(),
                "turn {turn}: {words:04X?}\n{:?}\n{:?}",
                client.err(),
                simulator.err()
            ),
        }
        refused += usize::from(Order::parse(&words).is_err());
    }
    assert!((20_000..58_000).contains(&refused), "{refused}");
}

#[test]
fn the_manual_names_these() {
    let mut bench = Bench::default();
    let cases: [(&[u16], [u16; 2]); 14] = [
        (&[0x0001, 0xC004, 0, 50, 19], [4, 202]),                // both position outputs
        (&[0x0001, 0x0001, 0, 0, 19], [4, 202]),                 // no axis
        (&[0x0001, 0x0001, 0x10, 0, 19], [4, 202]),              // a reserved axis
        (&[0x0001, 0x0006, 0, 50, 19], [4, 202]),                // a speed that is not defined here
        (&[0x0001, 0x0004, 0, 101, 19], [4, 202]),               // too fast
        (&[0x0001, 0x0004, 0, 50, 30_000], [4, 202]),            // no such point
        (&[0x0001, 0x0000, 0, 50, 19], [4, 202]),                // a speed without its flag
        (&[0x0001, 0x0004, 0, 50, 19, 1], [4, 202]),             // a word that is not used
        (&[0x0010, 0x0001, 3, 0, 19], [4, 202]),                 // DRIVE of two axes
        (&[0x0002, 0x0010, 0x600, 0, 19, 0, 0, 0, 5], [4, 202]), // two arch axes
        (&[0x5001, 0, 0, 0, 19], [4, 202]),                      // robot 5
        (&[0x1032, 6], [4, 202]),                                // incremental and absolute
        (&[0x1042], [12, 75]),                                   // no robot here
        (&[0x0777], [12, 75]),                                   // no command
    ];
    for (request, alarm) in cases {
        let answer = bench.send(&words(request));
        assert_eq!(answer[..4], [0x4000, alarm[0], alarm[1], 0], "{request:04X?}: {}", bench.console("why"));
    }
    assert_eq!(bench.pulses(1), [0; 4], "nothing moved");
}

#[test]
fn survives_any_words() {
    let mut random = Rng::with_seed(7);
    let mut bench = Bench::default();
    for turn in 0..20_000 {
        for word in &mut bench.image.0 {
            if random.u32(..8) == 0 {
                *word = random.u16(..);
            }
        }
        if random.bool() {
            bench.image.0[0] = if random.bool() { 0 } else { ROWS[random.usize(..ROWS.len())].code };
        }
        if random.u32(..50) == 0 {
            bench.simulator.input(bench.now, None);
        }
        bench.wait(random.u64(..40));
        assert!(matches!(bench.words()[0], 0 | 0x0100 | 0x0200 | 0x4000), "turn {turn}");
        if random.u32(..50) == 0 {
            bench.image = resting();
            bench.wait(200);
            bench.pulse(input::ALARM_RESET);
            bench.pulse(input::SERVO_ON);
        }
    }
}

#[test]
fn extreme_numbers_do_not_break_anything() {
    let mut bench =
        Bench::new("[points]\n1 = { pulse = [2147483647, -2147483648, 0, 0] }\n2 = { pulse = [1, 0, 0, 0] }");
    let numbers = [i32::MIN, i32::MAX, 0];
    for value in numbers {
        for command in [Command::MoveMm, Command::MovePulse, Command::MoveiMm, Command::MoveiPulse] {
            let draft = Key::AXES.into_iter().fold(command.order(), |draft, key| draft.with(key, value));
            bench.ask(draft.clone());
            bench.ask(draft.with(Key::Robot, 2));
        }
        for command in [Command::DriveMm, Command::DrivePulse, Command::PushMm, Command::PushPulse] {
            bench.ask(command.order().with(Key::Axes, "3").with(Key::Target, value));
        }
        let set = Command::ParamSet.order().with(Key::Parameter, "WEIGHT").with(Key::Value, value.max(0));
        bench.ask(set);
    }
    assert_eq!(bench.refused(Command::PointAdd.order().with(Key::Point, 1).with(Key::Point2, 2)), "6.901");
    assert_eq!(bench.refused(Command::MovePtp.order().with(Key::Point, 1)), "2.334");
    let hand = Command::HandSet.order().with(Key::Hand, 3).with(Key::Data4, 1);
    let hand = [Key::Data1, Key::Data2, Key::Data3].into_iter().fold(hand, |draft, key| draft.with(key, i32::MAX));
    bench.done(hand);
    bench.done(Command::HandSelect.order().with(Key::Hand, 3));
    bench.ask(Command::PositionMm.order());
    bench.ask(Command::MoveLinear.order().with(Key::Point, 19));
    assert!(matches!(
        bench.ask(Command::JogCartesian.order().with(Key::Axes, "1").with(Key::Direction, "+")),
        Answer::Refused { .. }
    ));
}
