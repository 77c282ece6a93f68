//! Requests of the robot server: addresses, sizes, memory.

use super::*;

#[test]
fn the_status_request_of_3_2_1() {
    let mut bench = Bench::default();
    let frames =
        bench.exchange(Division::Robot, PEER, &hex("5945524320000000030100000000000039393939393939397200010000010000"));
    let answer = hex("5945524320000800030101000000008039393939393939398100000000000000c200000040000000");
    assert_eq!(frames, [answer]);
}

#[test]
fn registers_accept_both_forms_of_the_manual() {
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
fn answers_malformed_datagrams_with_an_error() {
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
fn refuses_missing_addresses() {
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
fn can_answer_for_missing_axes() {
    let asked = [(0x74, 1), (0x75, 1), (0x75, 101), (0x76, 1), (0x77, 1), (0x75, 11), (0x75, 21)];
    for (state, sizes) in [
        ("", [32, 52, 52, 32, 32, 24, 28]),
        ("trim_axes = true", [32, 44, 44, 24, 24, 24, 28]),
        ("robot_axes = 7", [32, 48, 48, 28, 28, 24, 28]),
        ("robot_axes = 7\ntrim_axes = false", [32, 52, 52, 32, 32, 52, 52]),
    ] {
        let mut bench = Bench::new(state);
        assert_eq!(asked.map(|(command, instance)| bench.read(command, instance).len()), sizes, "{state}");
    }
    let mut bench = Bench::new("trim_axes = true");
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
    assert_eq!(&info[..24], b"DN2.07.00A(JP/US)-00\0\0\0\0");
    assert_eq!(&info[24..], b"ES0165D-A0*\0\0\0\0\x0012.34\0\0\0");
    assert_eq!(bench.read(0x89, 12)[24..], [0; 24], "a robot that does not exist has no name");
}

#[test]
fn variables_keep_written_values() {
    let mut bench = Bench::default();
    for (command, value) in [
        (0x7A, &[255][..]),
        (0x7B, &[0xFE, 0xFF]),
        (0x7C, &[1, 2, 3, 4]),
        (0x7D, &[0, 0, 0xC0, 0x3F]),
        (0x7E, b"0123456789abcdef"),
        (0x8C, b"0123456789abcdef0123456789abcdef"),
    ] {
        for (attribute, get, set) in [(1, 0x0E, 0x10), (0, 0x0E, 0x10), (0, 0x01, 0x02), (1, 0x01, 0x02)] {
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
fn plural_commands_respect_their_limits() {
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
