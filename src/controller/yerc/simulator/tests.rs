//! The simulator from outside: datagrams in, datagrams out, in virtual time.

use std::time::Duration;

use proptest::prelude::*;

use super::*;
use crate::controller::yerc::Model;
use crate::controller::yerc::payload::{
    CartesianMove, ControllerStatus, JobInfo, MoveLayout, Position, PulseMove, StatusBit,
};

const PEER: u64 = 7;

/// A simulator with a clock and a hand to send with.
struct Bench {
    simulator: Simulator,
    now: Now,
}

impl Default for Bench {
    fn default() -> Self {
        Self::new("")
    }
}

impl Bench {
    fn new(start: &str) -> Self {
        let start = Start::parse(start, |path| Err(format!("no {path} here"))).unwrap();
        Self { simulator: Simulator::new(start), now: Now::ZERO }
    }

    fn wait(&mut self, millis: u64) {
        self.now += Duration::from_millis(millis);
        self.simulator.advance(self.now);
    }

    fn console(&mut self, line: &str) -> String {
        self.simulator.console(self.now, line).unwrap()
    }

    /// Every frame that a datagram brings forth at once.
    fn exchange(&mut self, division: Division, peer: u64, bytes: &[u8]) -> Vec<Vec<u8>> {
        self.simulator.receive(self.now, division, peer, bytes);
        self.waiting()
    }

    fn waiting(&mut self) -> Vec<Vec<u8>> {
        std::iter::from_fn(|| self.simulator.transmit(self.now)).map(|outgoing| outgoing.bytes).collect()
    }

    /// A robot request: status, and data.
    fn ask(&mut self, command: u16, instance: u16, attribute: u8, service: u8, data: &[u8]) -> (Status, Vec<u8>) {
        let frame = RequestFrame {
            division: Division::Robot,
            ack: false,
            id: 9,
            block: 0,
            command,
            instance,
            attribute,
            service,
            data,
        };
        let frames = self.exchange(Division::Robot, PEER, &frame.emit());
        let answer = AnswerFrame::parse(&frames[0]).unwrap();
        assert_eq!((frames.len(), answer.id, answer.block, answer.service), (1, 9, LAST_BLOCK, service | 0x80));
        (answer.status, answer.data.to_vec())
    }

    fn read(&mut self, command: u16, instance: u16) -> Vec<u8> {
        let (status, data) = self.ask(command, instance, 0, 0x01, &[]);
        assert_eq!(status, Status::OK, "{command:#x} {instance}");
        data
    }

    fn write(&mut self, command: u16, instance: u16, attribute: u8, service: u8, data: &[u8]) -> Status {
        self.ask(command, instance, attribute, service, data).0
    }

    fn set_word(&mut self, command: u16, instance: u16, value: u32) -> Status {
        self.write(command, instance, 1, 0x10, &value.to_le_bytes())
    }

    fn status(&mut self) -> ControllerStatus {
        ControllerStatus::parse(&self.read(0x72, 1)).unwrap()
    }

    fn pose(&mut self, instance: u16) -> Vec<i32> {
        Position::parse(&self.read(0x75, instance)).unwrap().axes.as_slice().to_vec()
    }

    fn job(&mut self) -> JobInfo {
        JobInfo::parse(&self.read(0x73, 1)).unwrap()
    }

    fn select(&mut self, name: &[u8], line: u32) -> Status {
        let mut data = [0; 36];
        data[..name.len()].copy_from_slice(name);
        data[32..].copy_from_slice(&line.to_le_bytes());
        self.write(0x87, 1, 0, 0x02, &data)
    }

    fn start(&mut self) -> Status {
        self.set_word(0x86, 1, 1)
    }

    /// A frame to the file server.
    fn file(&mut self, peer: u64, id: u8, ack: bool, service: u8, block: u32, data: &[u8]) -> Vec<Vec<u8>> {
        let division = Division::File;
        let frame = RequestFrame { division, ack, id, block, command: 0, instance: 0, attribute: 0, service, data };
        self.exchange(division, peer, &frame.emit())
    }

    /// One answer of the file server.
    fn file_one(&mut self, ack: bool, service: u8, block: u32, data: &[u8]) -> (Status, u32, Vec<u8>) {
        let frames = self.file(PEER, 3, ack, service, block, data);
        assert_eq!(frames.len(), 1);
        let answer = AnswerFrame::parse(&frames[0]).unwrap();
        (answer.status, answer.block, answer.data.to_vec())
    }

    /// A whole list or save.
    fn fetch(&mut self, service: u8, name: &[u8]) -> Result<Vec<u8>, Status> {
        let mut content = Vec::new();
        let (mut status, mut block, mut data) = self.file_one(false, service, 0, name);
        for number in 1.. {
            if status != Status::OK {
                return Err(status);
            }
            assert_eq!(block & !LAST_BLOCK, number);
            content.append(&mut data);
            if block & LAST_BLOCK != 0 {
                assert!(self.file(PEER, 3, true, service, block, &[]).is_empty());
                break;
            }
            (status, block, data) = self.file_one(true, service, block, &[]);
        }
        Ok(content)
    }

    /// A whole load in blocks of `size`.
    fn load(&mut self, name: &[u8], content: &[u8], size: usize) -> Status {
        let (status, block, _) = self.file_one(false, 0x15, 0, name);
        if !status.is_ok() {
            return status;
        }
        assert_eq!(block, 0);
        let blocks = content.len().div_ceil(size);
        for (number, piece) in (1u32..).zip(content.chunks(size)) {
            let last = if usize::try_from(number).unwrap() == blocks { LAST_BLOCK } else { 0 };
            let (status, acknowledged, _) = self.file_one(true, 0x15, number | last, piece);
            assert_eq!(acknowledged & !LAST_BLOCK, if status.is_ok() || last != 0 { number } else { 0 });
            if !status.is_ok() || last != 0 {
                return status;
            }
        }
        panic!("an empty file has no blocks");
    }
}

fn hex(text: &str) -> Vec<u8> {
    (0..text.len()).step_by(2).map(|i| u8::from_str_radix(&text[i..i + 2], 16).unwrap()).collect()
}

fn refused(added: u16) -> Status {
    Status::refused(added)
}

fn plain(code: u8) -> Status {
    Status { code, ..Status::OK }
}

fn cartesian(instance_speed: (u32, u32), coordinate: u32, target: [i32; 6]) -> CartesianMove {
    use crate::controller::yerc::payload::{ExtendedForm, Form, PositionKind, SpeedClass};
    CartesianMove {
        layout: MoveLayout::Words26,
        robot: 1,
        station: 0,
        class: SpeedClass::from_word(instance_speed.0),
        speed: instance_speed.1,
        coordinate: PositionKind::from_word(coordinate),
        target,
        reserved: [0, 0],
        form: Form(0),
        extended: ExtendedForm(0),
        tool: 0,
        user: 0,
        base: [0; 3],
        station_axes: [0; 6],
    }
}

/// Y +500 mm in a straight line at 100 mm/s: five seconds.
fn five_seconds() -> CartesianMove {
    cartesian((1, 1000), 16, [1_000_000, 500_000, 1_200_000, 1_800_000, 0, 0])
}

#[test]
fn the_status_request_of_3_2_1() {
    let mut bench = Bench::default();
    let frames =
        bench.exchange(Division::Robot, PEER, &hex("5945524320000000030100000000000039393939393939397200010000010000"));
    let answer = hex("5945524320000800030101000000008039393939393939398100000000000000c200000040000000");
    assert_eq!(frames, [answer]);
}

#[test]
fn registers_take_both_printed_forms() {
    let mut bench = Bench::default();
    let outline = hex("59455243200002000301000100000000393939393939393979000a00000200003412");
    let answer = hex("5945524320000000030101010000008039393939393939398200000000000000");
    assert_eq!(bench.exchange(Division::Robot, PEER, &outline), [answer]);
    let table = hex("59455243200002000301000100000000393939393939393979000a00011000003512");
    let answer = hex("5945524320000000030101010000008039393939393939399000000000000000");
    assert_eq!(bench.exchange(Division::Robot, PEER, &table), [answer]);
    assert_eq!(bench.ask(0x79, 10, 1, 0x0E, &[]).1, [0x35, 0x12]);
    assert_eq!(bench.write(0x79, 545, 1, 0x10, &[1, 0]), Status::OK);
    assert_eq!(bench.ask(0x79, 545, 1, 0x0E, &[]).1, [0, 0], "the ladder writes this one");
    assert_eq!(bench.write(0x79, 560, 1, 0x10, &[1, 0]), refused(0x2110));
}

#[test]
fn malformed_datagrams_are_told_what_is_wrong() {
    let good = "5945524320000000030100000000000039393939393939397200010000010000";
    let patched = |at: usize, bytes: &str| {
        let mut text = good.to_owned();
        text.replace_range(2 * at..2 * at + bytes.len(), bytes);
        hex(&text)
    };
    let cases = [
        (patched(0, "58"), 0xE4A6),
        (patched(4, "24"), 0xE4A5),
        (patched(6, "04"), 0xE4A7),
        (patched(9, "03"), 0xE4A3),
        (patched(9, "02"), 0xE4A3),
        (patched(10, "02"), 0xE4A2),
        (patched(10, "01"), 0xE4A2),
        (vec![0; 600], 0xE49E),
    ];
    for (bytes, expected) in cases {
        let frames = Bench::default().exchange(Division::Robot, PEER, &bytes);
        assert_eq!(AnswerFrame::parse(&frames[0]).unwrap().status, refused(expected), "{bytes:02x?}");
    }
    assert!(Bench::default().exchange(Division::Robot, PEER, &hex(good)[..31]).is_empty());
}

#[test]
fn addresses_that_do_not_exist() {
    let mut bench = Bench::default();
    assert_eq!(bench.ask(0x8D, 1, 1, 0x0E, &[]).0, plain(0x08));
    assert_eq!(bench.ask(0x72, 1, 1, 0x10, &[]).0, plain(0x08));
    assert_eq!(bench.ask(0x72, 1, 3, 0x0E, &[]).0, plain(0x09));
    assert_eq!(bench.ask(0x72, 2, 0, 0x01, &[]).0, plain(0x28));
    assert_eq!(bench.ask(0x7A, 100, 1, 0x0E, &[]).0, plain(0x28));
    assert_eq!(bench.ask(0x73, 2, 0, 0x01, &[]).0, refused(0xA001));
    assert_eq!(bench.ask(0x75, 2, 0, 0x01, &[]).0, refused(0xA001));
    assert_eq!(bench.ask(0x87, 1, 1, 0x02, &[0; 36]).0, refused(0xA002));
    let mut bench = Bench::new("model = 'fs100'");
    assert_eq!(bench.ask(0x8C, 1, 1, 0x0E, &[]).0, refused(0xA000));
    assert_eq!(bench.ask(0x72, 1, 3, 0x0E, &[]).0, refused(0xA002));
    assert_eq!(bench.ask(0x73, 7, 0, 0x01, &[]).0, refused(0xA001));
    let mut bench = Bench::new("model = 'fs100'\nsoftware = 'FS1.13.00A(JP/US)-00'");
    for command in [0x8A, 0x8B, 0x30A, 0x30B] {
        assert_eq!(bench.ask(command, 1, 0, 0x01, &[]).0, refused(0xA000));
    }
}

#[test]
fn only_fitted_axes_are_answered() {
    let mut bench = Bench::default();
    let sizes = [(0x74, 1), (0x75, 1), (0x75, 101), (0x76, 1), (0x77, 1), (0x75, 11), (0x75, 21)];
    let sizes = sizes.map(|(command, instance)| bench.read(command, instance).len());
    assert_eq!(sizes, [32, 44, 44, 24, 24, 24, 28]);
    assert_eq!(&bench.read(0x74, 1)[..8], b"S\0\0\0L\0\0\0");
    assert_eq!(bench.ask(0x75, 1, 12, 0x0E, &[]).0, refused(0xA002));
    assert_eq!(bench.ask(0x75, 101, 6, 0x0E, &[]).1, 1_000_000i32.to_le_bytes());
}

#[test]
fn every_readable_command_answers_its_size() {
    for model in ["dx200", "fs100"] {
        let mut bench = Bench::new(&format!("model = '{model}'"));
        let sizes = [(0x70, 60), (0x71, 60), (0x72, 8), (0x73, 44), (0x88, 28), (0x30A, 268), (0x30B, 268)];
        for (command, size) in sizes {
            assert_eq!(bench.read(command, 1).len(), size, "{command:#x}");
        }
        assert_eq!(bench.read(0x89, 11).len(), 48);
    }
    let mut bench = Bench::default();
    let info = bench.read(0x89, 11);
    assert_eq!(&info[..24], b"DS2.07.00A(JP/US)-00\0\0\0\0");
    assert_eq!(&info[24..], b"ES0165D-A0*\0\0\0\0\x0012.34\0\0\0");
    assert_eq!(bench.read(0x89, 12)[24..], [0; 24], "a robot that does not exist has no name");
}

#[test]
fn variables_keep_what_is_written() {
    let mut bench = Bench::default();
    for (command, value) in [
        (0x7A, &[255][..]),
        (0x7B, &[0xFE, 0xFF]),
        (0x7C, &[1, 2, 3, 4]),
        (0x7D, &[0, 0, 0xC0, 0x3F]),
        (0x7E, b"0123456789abcdef"),
        (0x8C, b"0123456789abcdef0123456789abcdef"),
    ] {
        for (attribute, get, set) in [(1, 0x0E, 0x10), (0, 0x01, 0x02), (1, 0x01, 0x02)] {
            assert_eq!(bench.write(command, 42, attribute, set, value), Status::OK, "{command:#x}");
            assert_eq!(bench.ask(command, 42, attribute, get, &[]).1, value);
            assert_eq!(bench.write(command, 42, attribute, set, &vec![0; value.len()]), Status::OK);
        }
    }
    assert_eq!(bench.write(0x7A, 1, 1, 0x10, &[5, 0, 0, 0]), Status::OK);
    assert_eq!(bench.ask(0x7A, 1, 1, 0x0E, b"ignored").1, [5]);
    assert_eq!(bench.write(0x7A, 1, 1, 0x10, &[0, 1, 0, 0]), refused(0xB004));
    assert_eq!(bench.write(0x7B, 1, 1, 0x10, &[0xFF, 0xFF, 0xFF, 0xFF]), Status::OK);
    assert_eq!(bench.write(0x7A, 1, 1, 0x10, &[5, 0]), refused(0xB003));
    bench.write(0x8C, 3, 1, 0x10, b"0123456789abcdef0123456789abcdef");
    bench.write(0x7E, 3, 1, 0x10, b"short\0\0\0\0\0\0\0\0\0\0\0");
    assert_eq!(bench.ask(0x8C, 3, 1, 0x0E, &[]).1[16..], [0; 16], "a short write clears the rest");
}

#[test]
fn positions_are_undefined_until_written() {
    let mut bench = Bench::default();
    assert_eq!(bench.ask(0x7F, 99, 0, 0x01, &[]).0, refused(0xB005));
    assert_eq!(bench.write(0x7F, 99, 6, 0x10, &[1, 0, 0, 0]), refused(0xB005));
    let mut position = [0; 52];
    position[0] = 17;
    assert_eq!(bench.write(0x7F, 99, 0, 0x02, &position), Status::OK);
    assert_eq!(bench.write(0x7F, 99, 6, 0x10, &[1, 2, 3, 4]), Status::OK);
    position[20..24].copy_from_slice(&[1, 2, 3, 4]);
    assert_eq!(bench.read(0x7F, 99), position);
    assert_eq!(bench.ask(0x7F, 99, 0, 0x0E, &[]).1, position);
    position[0] = 1;
    assert_eq!(bench.write(0x7F, 99, 0, 0x02, &position), refused(0xB004));
}

#[test]
fn plural_commands_hold_their_limits() {
    let mut bench = Bench::default();
    let count = |count: u32| count.to_le_bytes();
    assert_eq!(bench.ask(0x302, 3, 0, 0x33, &count(476)).0, refused(0xA101));
    assert_eq!(bench.ask(0x302, 3, 0, 0x33, &count(3)).0, refused(0x1012));
    assert_eq!(bench.ask(0x302, 3, 0, 0x33, &count(0)).0, refused(0x1012));
    assert_eq!(bench.ask(0x302, 3, 0, 0x33, &count(98)).0, plain(0x28));
    assert_eq!(bench.ask(0x302, 3, 0, 0x33, &[1, 0]).0, refused(0xB003));
    assert_eq!(bench.ask(0x302, 10, 0, 0x34, &[2, 0, 0, 0, 8, 9]), (Status::OK, vec![]));
    assert_eq!(bench.ask(0x302, 10, 0, 0x33, &count(2)).1, [2, 0, 0, 0, 8, 9]);
    assert_eq!(bench.ask(0x302, 10, 0, 0x34, &[2, 0, 0, 0, 8]).0, refused(0xB003));
    assert_eq!(bench.ask(0x300, 1, 0, 0x33, &count(474)).1.len(), 478);
    assert_eq!(bench.ask(0x300, 511, 0, 0x33, &count(4)).0, plain(0x28));
    assert_eq!(bench.ask(0x300, 1001, 0, 0x34, &[2, 0, 0, 0, 8, 9]).0, refused(0x2110));
    assert_eq!(bench.ask(0x300, 2701, 0, 0x34, &[2, 0, 0, 0, 8, 9]).0, Status::OK);
    assert_eq!(bench.ask(0x78, 2702, 1, 0x0E, &[]).1, [9]);
    let mixed = [[3, 0, 0, 0].as_slice(), &[1; 6]].concat();
    assert_eq!(bench.ask(0x301, 558, 0, 0x34, &mixed).0, plain(0x28), "the writable registers end at 559");
    assert_eq!(bench.ask(0x306, 7, 0, 0x33, &count(1)).1[4..9], *b"HELLO");
    assert_eq!(bench.ask(0x30C, 0, 0, 0x33, &count(14)).1.len(), 452);
    assert_eq!(bench.ask(0x307, 0, 0, 0x33, &count(3)).1.len(), 160);
    assert_eq!(bench.ask(0x307, 0, 0, 0x33, &count(9)).0, refused(0xB005));
}

#[test]
fn each_state_refuses_with_its_own_code() {
    let cases = [
        ("remote off", 0x2100),
        ("mode teach", 0x2080),
        ("servo off", 0x2070),
        ("alarm 8000", 0x2060),
        ("hold pendant on", 0x2020),
        ("hold external on", 0x2040),
        ("edit on", 0x2130),
    ];
    for (line, expected) in cases {
        let mut bench = Bench::new("job = 'HOME'");
        bench.console(line);
        assert_eq!(bench.start(), refused(expected), "start after {line}");
        let order = five_seconds().emit();
        assert_eq!(bench.write(0x8A, 2, 1, 0x02, &order), refused(expected), "move after {line}");
    }
    let mut bench = Bench::default();
    assert_eq!(bench.start(), refused(0x4060));
    assert_eq!(bench.select(b"NOBODY", 0), refused(0x4040));
    assert_eq!(bench.select(b"TESTJOB", 10), Status::OK);
    assert_eq!(bench.select(b"TESTJOB", 1000), refused(0xB004));
    bench.console("remote off");
    assert_eq!(bench.set_word(0x83, 2, 1), refused(0x2100));
    assert_eq!(bench.write(0x7A, 0, 1, 0x10, &[1]), refused(0x2100));
    assert_eq!(bench.file_one(false, 0x09, 0, b"TESTJOB.JBI").0, refused(0x2100));
    let mut bench = Bench::new("play_write = false");
    assert_eq!(bench.write(0x7A, 0, 1, 0x10, &[1]), refused(0x2110));
}

#[test]
fn alarms_take_the_power_and_a_reset_gives_it_back() {
    let mut bench = Bench::default();
    assert_eq!(bench.read(0x70, 1), [0; 60]);
    bench.console("alarm 4315 3 1");
    let status = bench.status();
    assert!(status.alarm() && !status.servo_on());
    assert_eq!(&bench.read(0x70, 1)[28..44], b"COLLISION DETECT");
    assert_eq!(&bench.read(0x30A, 1)[60..66], b"[SV#1]");
    assert_eq!(&bench.read(0x71, 1001)[..2], [0xDB, 0x10]);
    assert_eq!(bench.set_word(0x83, 2, 1), refused(0x2060));
    assert_eq!(bench.set_word(0x82, 1, 1), Status::OK);
    assert_eq!(bench.set_word(0x83, 2, 1), Status::OK);
    assert_eq!(bench.status().words, [0xC2, 0x40]);
    bench.console("alarm 1300");
    assert_eq!(bench.set_word(0x82, 1, 1), refused(0x2060), "a major alarm needs a restart");
    bench.console("alarm clear");
    bench.console("estop");
    assert_eq!(bench.set_word(0x83, 2, 1), refused(0x3450));
}

#[test]
fn every_class_of_the_history_has_entries() {
    let mut bench = Bench::default();
    for first in [1, 1001, 2001, 3001, 4001] {
        assert_ne!(bench.read(0x71, first)[..4], [0; 4], "{first}");
    }
    assert_eq!(bench.read(0x71, 100), [0; 60]);
    let japanese = bench.read(0x71, 2001);
    let (name, _, broken) = encoding_rs::SHIFT_JIS.decode(&japanese[28..42]);
    assert_eq!((&*name, broken), ("エアー圧力低下", false));
}

#[test]
fn a_straight_move_arrives_in_time_and_exactly() {
    let mut bench = Bench::default();
    assert_eq!(bench.write(0x8A, 2, 1, 0x02, &five_seconds().emit()), Status::OK);
    assert!(bench.status().running());
    assert_eq!(bench.write(0x8A, 2, 1, 0x02, &five_seconds().emit()), refused(0x2010));
    bench.wait(2500);
    assert_eq!(bench.pose(101)[..3], [1_000_000, 250_000, 1_200_000]);
    assert_ne!(bench.read(0x76, 1), [0; 24]);
    bench.wait(2499);
    assert!(bench.status().running());
    bench.wait(1);
    assert!(!bench.status().running());
    assert_eq!(bench.pose(101), [1_000_000, 500_000, 1_200_000, 1_800_000, 0, 0]);
    assert_ne!(bench.pose(1)[0], 0, "pulses have followed");
    assert_eq!(bench.read(0x76, 1), [0; 24]);
}

#[test]
fn every_kind_of_move_reaches_its_target() {
    let mut bench = Bench::default();
    let link = cartesian((0, 10_000), 17, [700_000, -300_000, 900_000, -1_799_999, 100, -900_000]);
    assert_eq!(bench.write(0x8A, 1, 1, 0x02, &link.emit()), Status::OK);
    bench.wait(10_000);
    assert_eq!(bench.pose(101), link.target);
    let step = cartesian((1, 500), 16, [1000, -2000, 3000, 0, 0, 0]);
    assert_eq!(bench.write(0x8A, 3, 1, 0x02, &step.emit()), Status::OK);
    bench.wait(10_000);
    assert_eq!(bench.pose(101)[..3], [701_000, -302_000, 903_000]);
    let mut printed = cartesian((1, 15_000), 18, [0, 100_000, 1_000_000, 1_800_000, 0, 0]);
    printed.layout = MoveLayout::Words25;
    printed.user = 1;
    assert_eq!(bench.write(0x8A, 2, 1, 0x02, &printed.emit()), Status::OK);
    bench.wait(10_000);
    assert_eq!(bench.pose(101)[..3], [500_000, 100_000, 1_000_000]);
    let pulses = PulseMove::parse(&hex(&format!("0100000000000000{}", "00".repeat(80)))).unwrap();
    let mut pulses = PulseMove { speed: 5000, ..pulses };
    pulses.axes = [1234, -5678, 91_011, 1213, -1415, 1617, 0, 0];
    pulses.base = [2000, 0, 0];
    assert_eq!(bench.write(0x8B, 1, 1, 0x02, &pulses.emit()), Status::OK);
    bench.wait(10_000);
    assert_eq!(bench.pose(1), [1234, -5678, 91_011, 1213, -1415, 1617]);
    assert_eq!(bench.pose(11), [2000]);
    let station = PulseMove {
        robot: 0,
        station: 1,
        axes: [0; 8],
        base: [0; 3],
        station_axes: [9000, -9000, 0, 0, 0, 0],
        ..pulses
    };
    assert_eq!(bench.write(0x8B, 1, 1, 0x02, &station.emit()), Status::OK);
    bench.wait(10_000);
    assert_eq!(bench.pose(21), [9000, -9000]);
}

#[test]
fn moves_that_must_not_be_sent() {
    type Change = fn(&mut CartesianMove);
    let mut bench = Bench::default();
    let good = five_seconds();
    let cases: [(u16, Change, u16); 14] = [
        (2, |order| order.station = 1, 0xB008),
        (2, |order| order.robot = 0, 0xB008),
        (2, |order| order.robot = 2, 0xB008),
        (2, |order| order.speed = 0, 0xB009),
        (2, |order| order.speed = 15_001, 0xB009),
        (1, |_| (), 0xB009),
        (2, |order| order.coordinate = crate::controller::yerc::payload::PositionKind::Tool, 0xB00B),
        (2, |order| order.coordinate = crate::controller::yerc::payload::PositionKind::Pulse, 0xB00B),
        (2, |order| order.reserved[1] = 1, 0xB004),
        (2, |order| order.form.0 = 0x40, 0xB00C),
        (2, |order| order.tool = 64, 0xB00D),
        (2, |order| order.user = 64, 0xB00E),
        (2, |order| order.base[1] = 1, 0xB004),
        (2, |order| order.station_axes[0] = 1, 0xB004),
    ];
    for (instance, change, expected) in cases {
        let mut order = good;
        change(&mut order);
        assert_eq!(bench.write(0x8A, instance, 1, 0x02, &order.emit()), refused(expected), "{order:?}");
    }
    let user = |user| CartesianMove { coordinate: crate::controller::yerc::payload::PositionKind::User, user, ..good };
    assert_eq!(bench.write(0x8A, 2, 1, 0x02, &user(0).emit()), refused(0xB00E));
    assert_eq!(bench.write(0x8A, 2, 1, 0x02, &user(9).emit()), refused(0x3350));
    assert_eq!(bench.write(0x8A, 2, 1, 0x02, &good.emit()[..96]), refused(0xB003));
    assert_eq!(bench.write(0x8A, 4, 1, 0x02, &good.emit()), plain(0x28));
    assert!(!bench.status().running());
}

#[test]
fn hold_stops_on_the_way_and_the_move_is_over() {
    let mut bench = Bench::default();
    bench.write(0x8A, 2, 1, 0x02, &five_seconds().emit());
    bench.wait(1000);
    assert_eq!(bench.set_word(0x83, 1, 1), Status::OK);
    assert!(bench.status().running(), "it still slows down");
    bench.wait(100);
    let status = bench.status();
    assert!(!status.running() && status.has(StatusBit::HoldCommand));
    assert_eq!(bench.pose(101)[1], 105_000, "100 mm, and 5 mm to stop");
    assert_eq!(bench.write(0x8A, 2, 1, 0x02, &five_seconds().emit()), refused(0x2050));
    assert_eq!(bench.set_word(0x83, 1, 2), Status::OK);
    bench.wait(10_000);
    assert_eq!(bench.pose(101)[1], 105_000);
    bench.write(0x8A, 2, 1, 0x02, &five_seconds().emit());
    bench.wait(500);
    assert_eq!(bench.set_word(0x83, 2, 2), Status::OK);
    let status = bench.status();
    assert!(!status.running() && !status.servo_on());
    assert_eq!(bench.pose(101)[1], 155_000, "without power it stops at once");
}

#[test]
fn a_soft_limit_raises_an_alarm() {
    let mut bench = Bench::default();
    let far = cartesian((1, 15_000), 16, [5_000_000, 0, 1_200_000, 1_800_000, 0, 0]);
    assert_eq!(bench.write(0x8A, 2, 1, 0x02, &far.emit()), Status::OK);
    bench.wait(10_000);
    assert!(bench.status().alarm());
    assert_eq!(bench.pose(101)[0], 3_000_000);
    assert_eq!(bench.read(0x70, 1)[..2], 4416u16.to_le_bytes());
}

#[test]
fn a_job_runs_line_by_line() {
    let mut bench = Bench::default();
    assert_eq!(bench.select(b"TESTJOB", 0), Status::OK);
    assert_eq!(bench.start(), Status::OK);
    assert_eq!(bench.start(), refused(0x2010));
    assert_eq!(bench.select(b"HOME", 0), refused(0x2010));
    assert!(bench.status().running());
    bench.wait(1000);
    let job = bench.job();
    assert_eq!((job.name.as_bytes(), job.line, job.speed_override), (&b"TESTJOB"[..], 5, 10_000));
    assert_eq!(job.step, 2);
    assert!(bench.pose(1)[2] < 0, "on its way down");
    bench.wait(60_000);
    assert!(!bench.status().running());
    assert_eq!((bench.job().line, bench.ask(0x7A, 0, 1, 0x0E, &[]).1), (0, vec![3]));
    assert_eq!(bench.pose(1), [68_000, 100_000, 0, 0, -30_000, 0]);
}

#[test]
fn hold_pauses_a_job_and_start_takes_it_up_again() {
    let mut bench = Bench::default();
    bench.select(b"TESTJOB", 0);
    bench.start();
    bench.wait(2000);
    bench.set_word(0x83, 1, 1);
    bench.wait(1000);
    let (line, pose) = (bench.job().line, bench.pose(1));
    assert!(!bench.status().running());
    assert_eq!(bench.start(), refused(0x2050));
    bench.set_word(0x83, 1, 2);
    bench.wait(1000);
    assert_eq!((bench.job().line, bench.pose(1)), (line, pose));
    assert_eq!(bench.start(), Status::OK);
    bench.wait(60_000);
    assert_eq!((bench.status().running(), bench.ask(0x7A, 0, 1, 0x0E, &[]).1), (false, vec![3]));
}

#[test]
fn calls_inputs_and_the_cycle_switch() {
    let mut bench = Bench::default();
    bench.select(b"MAIN", 0);
    bench.start();
    bench.wait(100);
    assert_eq!(bench.job().name.as_bytes(), b"TESTJOB");
    assert_eq!(bench.ask(0x7C, 0, 1, 0x0E, &[]).1, [1, 0, 0, 0]);
    assert_eq!(bench.ask(0x78, 1001, 1, 0x0E, &[]).1, [0b10]);
    bench.wait(60_000);
    assert_eq!(bench.job().name.as_bytes(), b"MAIN");
    assert_eq!(bench.ask(0x78, 1001, 1, 0x0E, &[]).1, [0]);

    bench.console("io 10 off");
    bench.select(b"WAITIN", 0);
    bench.start();
    bench.wait(5000);
    assert_eq!((bench.status().running(), bench.job().line), (true, 1));
    bench.console("io 10 on");
    bench.wait(100);
    assert_eq!(bench.ask(0x7A, 10, 1, 0x0E, &[]).1, [1]);
    bench.wait(2000);
    assert_eq!(bench.ask(0x7A, 10, 1, 0x0E, &[]).1, [2]);

    assert_eq!(bench.set_word(0x84, 2, 1), Status::OK);
    bench.select(b"COUNT", 0);
    for line in 1..=3 {
        bench.start();
        bench.wait(100);
        assert_eq!((bench.status().running(), bench.job().line), (false, line));
    }
    assert_eq!(bench.set_word(0x84, 2, 3), Status::OK);
    bench.select(b"COUNT", 0);
    bench.start();
    bench.wait(1000);
    assert!(bench.status().running(), "continuous");
    assert_eq!(bench.set_word(0x84, 2, 2), Status::OK);
    bench.wait(1000);
    assert!(!bench.status().running(), "to the end of the cycle");
}

#[test]
fn files_come_back_as_they_went() {
    let mut bench = Bench::default();
    let any: Vec<u8> = (0..5000u32).map(|i| i.to_le_bytes()[0] ^ i.to_le_bytes()[1]).collect();
    for (size, len) in [(479, 5000), (400, 5000), (1, 7), (479, 479), (479, 958)] {
        assert_eq!(bench.load(b"ANY.DAT", &any[..len], size), Status::OK);
        assert_eq!(bench.fetch(0x16, b"ANY.DAT"), Ok(any[..len].to_vec()));
    }
    let list = bench.fetch(0x32, b"*.DAT").unwrap();
    assert!(list.starts_with(b"ANY.DAT\r\n") && list.ends_with(b"VAR.DAT\r\n"));
    assert_eq!(bench.file_one(false, 0x09, 0, b"ANY.DAT").0, Status::OK);
    assert_eq!(bench.file_one(false, 0x09, 0, b"ANY.DAT").0, refused(0xE2B3));
    assert_eq!(bench.file_one(false, 0x09, 0, b"VAR.DAT").0, refused(0xE2AF));
    assert_eq!(bench.file_one(false, 0x09, 0, b"NONE.JBI").0, refused(0x4040));
    let nothing = |added: u32| Err(Status { code: 0, added_size: 1, added });
    assert_eq!(bench.fetch(0x16, b"NONE.JBI"), nothing(0xE29C));
    let jobs = bench.fetch(0x32, b"").unwrap();
    assert_eq!(bench.fetch(0x32, b"*.*").unwrap(), jobs);
    assert!(jobs.windows(10).any(|name| name == b"\x83e\x83X\x83g.JBI"));
    assert_eq!(bench.fetch(0x32, b"*.TXT"), Err(refused(0xE2A0)));
    assert_eq!(bench.fetch(0x16, b"TESTJOB.JBI\0"), Err(refused(0xE49D)));
    for extension in ["JBI", "DAT", "CND", "PRM", "SYS", "LST"] {
        assert!(!bench.fetch(0x32, format!("*.{extension}").as_bytes()).unwrap().is_empty());
    }
}

#[test]
fn jobs_are_checked_when_they_are_loaded() {
    let mut bench = Bench::default();
    let job = bench.fetch(0x16, b"HOME.JBI").unwrap();
    let renamed = String::from_utf8(job.clone()).unwrap().replace("HOME", "NEW").into_bytes();
    assert_eq!(bench.load(b"HOME.JBI", &job, 479), refused(0x4030));
    assert_eq!(bench.load(b"NEW.JBI", &job, 479), refused(0x5390));
    let bare: Vec<u8> = renamed.iter().copied().filter(|&byte| byte != b'\r').collect();
    assert_eq!(bench.load(b"NEW.JBI", &bare, 479), refused(0x5130));
    assert_eq!(bench.fetch(0x16, b"NEW.JBI"), Err(Status { code: 0, added_size: 1, added: 0xE29C }));
    assert_eq!(bench.load(b"NEW.JBI", &renamed, 100), Status::OK);
    assert_eq!(bench.select(b"NEW", 0), Status::OK);
    assert_eq!(bench.load(b"SYSTEM.SYS", b"x", 479), refused(0xE28C));
    let mut bench = Bench::new("replace_jobs = true");
    assert_eq!(bench.load(b"HOME.JBI", &job, 479), Status::OK);
}

#[test]
fn an_empty_list_is_said_by_model() {
    let mut bench = Bench::new("stock_files = false");
    assert_eq!(bench.fetch(0x32, b"*.JBI"), Err(Status { code: 0, added_size: 1, added: 0xE2A7 }));
    let mut bench = Bench::new("stock_files = false\nmodel = 'fs100'");
    assert_eq!(bench.fetch(0x32, b"*.JBI"), Err(refused(0xE2B3)));
    assert_eq!(bench.fetch(0x16, b"A.JBI"), Err(refused(0x4040)));
}

#[test]
fn repeated_frames_of_a_save_are_answered_once_and_again_after_a_pause() {
    let mut bench = Bench::new("[[file]]\nname = 'BIG.DAT'\nsize = 1000");
    let first = bench.file(PEER, 1, false, 0x16, 0, b"BIG.DAT");
    assert!(bench.file(PEER, 1, false, 0x16, 0, b"BIG.DAT").is_empty(), "an echo");
    bench.wait(100);
    assert_eq!(bench.file(PEER, 1, false, 0x16, 0, b"BIG.DAT"), first);
    let second = bench.file(PEER, 1, true, 0x16, 1, &[]);
    assert!(bench.file(PEER, 1, true, 0x16, 1, &[]).is_empty());
    bench.wait(100);
    assert_eq!(bench.file(PEER, 1, true, 0x16, 1, &[]), second);
    assert_eq!(bench.file(PEER, 1, false, 0x16, 0, b"BIG.DAT").len(), 0, "a late copy of the request");
    let last = bench.file(PEER, 1, true, 0x16, 2, &[]);
    assert_eq!(AnswerFrame::parse(&last[0]).unwrap().block, LAST_BLOCK | 3);
    assert!(bench.file(PEER, 1, true, 0x16, LAST_BLOCK | 3, &[]).is_empty());
    assert!(bench.file(PEER, 1, true, 0x16, LAST_BLOCK | 3, &[]).is_empty());
}

#[test]
fn repeated_blocks_of_a_load_are_stored_once() {
    let mut bench = Bench::default();
    bench.file(PEER, 1, false, 0x15, 0, b"A.DAT");
    let ack = bench.file(PEER, 1, true, 0x15, 1, b"one");
    bench.wait(100);
    assert_eq!(bench.file(PEER, 1, true, 0x15, 1, b"one"), ack);
    let ack = bench.file(PEER, 1, true, 0x15, LAST_BLOCK | 2, b"two");
    bench.wait(100);
    assert_eq!(bench.file(PEER, 1, true, 0x15, LAST_BLOCK | 2, b"two"), ack);
    assert!(bench.file(PEER, 1, false, 0x15, 0, b"A.DAT").is_empty(), "a late copy of the request");
    assert_eq!(bench.fetch(0x16, b"A.DAT"), Ok(b"onetwo".to_vec()));
    bench.file(PEER, 2, false, 0x15, 0, b"B.DAT");
    assert_eq!(bench.file_one(true, 0x15, 2, b"gap").0, refused(0xE4A1));
    assert_eq!(bench.file_one(true, 0x15, 1, b"late").0, refused(0xE4A2));
}

#[test]
fn one_transfer_at_a_time_and_none_for_ever() {
    let mut bench = Bench::new("[[file]]\nname = 'BIG.DAT'\nsize = 1000");
    bench.file(1, 1, false, 0x16, 0, b"BIG.DAT");
    let busy = bench.file(2, 1, false, 0x32, 0, b"");
    assert_eq!(AnswerFrame::parse(&busy[0]).unwrap().status, refused(0xE444));
    assert_eq!(bench.simulator.wake(), Some(Duration::from_secs(5)));
    bench.wait(5000);
    let dropped = bench.file(1, 1, true, 0x16, 1, &[]);
    assert_eq!(AnswerFrame::parse(&dropped[0]).unwrap().status, refused(0xE28B));
    bench.file(1, 1, false, 0x16, 0, b"BIG.DAT");
    bench.console("remote off");
    let dropped = bench.file(1, 1, true, 0x16, 1, &[]);
    assert_eq!(AnswerFrame::parse(&dropped[0]).unwrap().status, refused(0xFFFE));
    assert_eq!(bench.file(2, 1, false, 0x32, 0, b"").len(), 1);
}

#[test]
fn a_batch_backup_takes_its_time_and_is_then_a_file() {
    const PATH: &[u8] = b"/SPDRV/CMOSBK.BIN";
    let mut bench = Bench::new("backup_seconds = 600\nbackup_size = 2000");
    assert!(bench.file(PEER, 1, false, 0x16, 0, PATH).is_empty());
    bench.wait(599_000);
    assert!(bench.waiting().is_empty());
    assert!(bench.file(PEER, 2, false, 0x16, 0, PATH).is_empty(), "asked again");
    bench.wait(1000);
    let frames = bench.waiting();
    let answer = AnswerFrame::parse(&frames[0]).unwrap();
    assert_eq!((frames.len(), answer.id, answer.block, answer.data.len()), (1, 2, LAST_BLOCK, 0));
    assert_eq!(bench.fetch(0x16, PATH).unwrap().len(), 2000);
    assert!(bench.file(PEER, 3, false, 0x16, 0, PATH).is_empty(), "the next one is made anew");
    let mut bench = Bench::new("remote = false");
    assert_eq!(bench.file_one(false, 0x16, 0, PATH).0, refused(0xE250));
    let mut bench = Bench::new("model = 'fs100'\nsoftware = 'FS1.13.00A(JP/US)-00'");
    assert_eq!(bench.file_one(false, 0x16, 0, PATH).0, refused(0xE2A0));
}

#[test]
fn management_times_advance() {
    let mut bench = Bench::default();
    let elapsed = |data: Vec<u8>| String::from_utf8(data[16..].to_vec()).unwrap();
    assert_eq!(elapsed(bench.read(0x88, 1)), "002345:00'00");
    bench.wait(3_661_000);
    assert_eq!(elapsed(bench.read(0x88, 1)), "002346:01'01");
    assert_eq!(elapsed(bench.read(0x88, 211)), "000987:00'00");
    bench.write(0x8A, 2, 1, 0x02, &five_seconds().emit());
    bench.wait(60_000);
    assert_eq!(elapsed(bench.read(0x88, 211)), "000987:00'05");
    assert_eq!(bench.ask(0x88, 12, 0, 0x01, &[]).0, refused(0xA001));
}

#[test]
fn a_start_state_from_text() {
    let mut bench = Bench::new(
        r#"
        model = "fs100"
        cycle = "continuous"
        answer_delay_ms = 20
        variables = { B0 = 9, S1 = "テスト", P5 = { type = "base", axes = [1, 2, 3] } }
        io = { "25010" = true }
        registers = { "600" = 5 }
        positions = { R1 = [1, 2, 3, 4, 5, 6] }
        [[alarm]]
        code = 4315
        [[event]]
        at_ms = 1000
        do = "alarm clear"
        [[event]]
        at_ms = 1500
        do = "servo on"
        "#,
    );
    bench.simulator.answer_delay = Duration::ZERO;
    assert_eq!(bench.ask(0x7A, 0, 1, 0x0E, &[]).1, [9]);
    assert_eq!(bench.ask(0x7E, 1, 1, 0x0E, &[]).1[..6], *b"\x83e\x83X\x83g");
    assert_eq!(bench.ask(0x78, 2501, 1, 0x0E, &[]).1, [1]);
    assert_eq!(bench.ask(0x79, 600, 1, 0x0E, &[]).1, [5, 0]);
    assert_eq!(bench.pose(1), [1, 2, 3, 4, 5, 6]);
    assert_eq!(bench.status().words, [0xC4, 0x10]);
    assert_eq!(bench.simulator.wake(), Some(Duration::from_secs(1)));
    bench.wait(2000);
    assert_eq!(bench.status().words, [0xC4, 0x40]);
}

#[test]
fn mistakes_in_a_start_state_are_told_with_their_line() {
    let cases = [
        ("\nmodel = 'dx300'", "line 2"),
        ("\n\nspeed = 5", "line 3"),
        ("variables = { B0 = 256 }", "line 1: B0: the value must be 0 to 255"),
        ("variables = { Q0 = 1 }", "'Q0' is no variable"),
        ("\nio = { 10018 = true }", "line 2: '10018' is no signal"),
        ("\n[[event]]\nat_ms = 0\ndo = 'alrm 1'", "no such line: 'alrm 1'"),
        ("[[file]]\nname = 'A.JBI'\ntext = 'x'", "'A.JBI' does not hold a job"),
        ("[[file]]\nname = 'A.DAT'\npath = 'nowhere'", "nowhere: no nowhere here"),
        ("job = 'NOBODY'", "there is no job 'NOBODY'"),
        ("groups = ['R1', 'R9']", "'R9' is no group"),
    ];
    for (text, expected) in cases {
        let error = Start::parse(text, |path| Err(format!("no {path} here"))).unwrap_err();
        assert!(error.contains(expected), "{text}: {error}");
    }
}

#[test]
fn the_console_says_what_is_wrong() {
    let mut bench = Bench::default();
    let mut wrong = |line: &str| bench.simulator.console(Now::ZERO, line).unwrap_err();
    assert_eq!(wrong("servo maybe"), "'maybe' is not on or off");
    assert_eq!(wrong("io 10018 on"), "#10018: robot user output signals end in 0 to 7");
    assert_eq!(wrong("alarm 0"), "'0' is not a number from 1 to 9999");
    assert!(wrong("dance").starts_with("no such line: 'dance'"));
    bench.set_word(0x83, 3, 1);
    assert_eq!(bench.simulator.console(Now::ZERO, "mode teach"), Err("the pendant is locked by HLOCK".into()));
    assert!(bench.console("state").starts_with("play mode, command remote, servo on, one cycle, hlock"));
}

#[test]
fn answers_come_after_the_delay_and_busy_is_seeded() {
    let start = Start::parse("answer_delay_ms = 20", |_| Err(String::new())).unwrap();
    let mut simulator = Simulator::new(start);
    let request = hex("5945524320000000030100000000000039393939393939397200010000010000");
    simulator.receive(Now::ZERO, Division::Robot, PEER, &request);
    assert_eq!(simulator.transmit(Duration::from_millis(19)), None);
    assert_eq!(simulator.wake(), Some(Duration::from_millis(20)));
    assert!(simulator.transmit(Duration::from_millis(20)).is_some());
    let busy = |seed| {
        let mut bench =
            Bench { simulator: Simulator::new(Start::default().with_seed(seed).with_busy(0.5)), now: Now::ZERO };
        (0..32).map(|_| bench.ask(0x72, 1, 0, 1, &[]).0 == refused(0xD8FA)).collect::<Vec<_>>()
    };
    assert_eq!(busy(1), busy(1));
    assert_ne!(busy(1), busy(2));
    assert_eq!(Start::for_model(Model::Fs100).model(), Model::Fs100);
}

#[test]
fn a_large_file_costs_nothing_until_it_is_read() {
    let mut bench = Bench::new("[[file]]\nname = 'BIG.DAT'\nsize = 67108864");
    let (_, block, data) = bench.file_one(false, 0x16, 0, b"BIG.DAT");
    assert_eq!((block, data.len()), (1, 479));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn any_datagrams_are_survived(
        datagrams in proptest::collection::vec(
            (any::<bool>(), 0u64..3, 0u64..5000, proptest::collection::vec(any::<u8>(), 0..560)), 0..20)
    ) {
        let mut simulator = Simulator::new(Start::default());
        let mut now = Now::ZERO;
        for (file, peer, wait, bytes) in datagrams {
            now += Duration::from_millis(wait);
            simulator.receive(now, if file { Division::File } else { Division::Robot }, peer, &bytes);
            while simulator.transmit(now).is_some() {}
        }
    }

    #[test]
    fn any_well_formed_request_is_answered(
        requests in proptest::collection::vec(
            (0x6Eu16..0x90, prop_oneof![0u16..130, 1000u16..1010, any::<u16>()], 0u8..15,
             prop_oneof![Just(0x01u8), Just(0x02), Just(0x0E), Just(0x10), Just(0x33), Just(0x34), any::<u8>()],
             prop_oneof![
                 proptest::collection::vec(any::<u8>(), 0..479),
                 proptest::collection::vec(0u8..3, 4),
                 proptest::collection::vec(0u8..2, 88),
                 proptest::collection::vec(0u8..2, 104)], 0u64..3000), 0..30),
        plural in any::<bool>(), fs100 in any::<bool>(),
    ) {
        let model = if fs100 { Model::Fs100 } else { Model::Dx200 };
        let mut simulator = Simulator::new(Start::for_model(model));
        let mut now = Now::ZERO;
        for (command, instance, attribute, service, data, wait) in requests {
            now += Duration::from_millis(wait);
            let command = if plural { command + 0x292 } else { command };
            let frame = RequestFrame {
                division: Division::Robot, ack: false, id: 1, block: 0, command, instance, attribute, service, data: &data,
            };
            simulator.receive(now, Division::Robot, 0, &frame.emit());
            let answer = simulator.transmit(now).expect("every request is answered");
            let answer = AnswerFrame::parse(&answer.bytes).expect("answers are frames");
            prop_assert_eq!(answer.block, LAST_BLOCK);
            prop_assert!(answer.status.is_ok() || answer.data.is_empty());
        }
    }

    #[test]
    fn any_file_frames_are_survived(
        frames in proptest::collection::vec(
            (any::<bool>(), 0u64..2, 0u8..3,
             prop_oneof![Just(0x09u8), Just(0x15), Just(0x16), Just(0x32), any::<u8>()],
             prop_oneof![0u32..4, (0u32..4).prop_map(|block| block | LAST_BLOCK), any::<u32>()],
             prop_oneof![
                 Just(b"TESTJOB.JBI".to_vec()), Just(b"A.DAT".to_vec()), Just(b"".to_vec()),
                 Just(b"/SPDRV/CMOSBK.BIN".to_vec()), proptest::collection::vec(any::<u8>(), 0..479)],
             0u64..3000), 0..30)
    ) {
        let mut simulator = Simulator::new(Start::default());
        let mut now = Now::ZERO;
        for (ack, peer, id, service, block, data, wait) in frames {
            now += Duration::from_millis(wait);
            let frame = RequestFrame {
                division: Division::File, ack, id, block, command: 0, instance: 0, attribute: 0, service, data: &data,
            };
            simulator.receive(now, Division::File, peer, &frame.emit());
            while let Some(answer) = simulator.transmit(now) {
                prop_assert!(AnswerFrame::parse(&answer.bytes).is_ok());
            }
        }
    }
}
