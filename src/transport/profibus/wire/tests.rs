//! Tests with bytes that two independent codecs decoded, with a third codec, and with random bytes.

use std::time::Duration;

use profirust::fdl;
use proptest::prelude::*;

use super::*;
use crate::testing::hex;

/// Telegrams with which master 2 opens slave 5: sender, bytes, service access point, data. The ident number is
/// invented. Two independent codecs decoded each line.
const START: [(u8, &str, Option<u8>, &str); 21] = [
    (2, "10 05 02 49 50 16", None, ""),
    (5, "10 02 05 00 07 16", None, ""),
    (2, "68 05 05 68 85 82 6D 3C 3E EE 16", Some(60), ""),
    (5, "68 0B 0B 68 82 85 08 3E 3C 02 05 00 FF 12 34 D5 16", Some(62), "02 05 00 FF 12 34"),
    (2, "68 05 05 68 85 82 5D 3B 3E DD 16", Some(59), ""),
    (5, "68 08 08 68 82 85 08 3E 3B C0 D7 D7 F6 16", Some(62), "C0 D7 D7"),
    (2, "68 0C 0C 68 85 82 5D 3D 3E 88 1E 01 0B 12 34 01 D8 16", Some(61), "88 1E 01 0B 12 34 01"),
    (5, "E5", None, ""),
    (2, "68 08 08 68 85 82 7D 3E 3E C0 D7 D7 6E 16", Some(62), "C0 D7 D7"),
    (5, "E5", None, ""),
    (2, "68 05 05 68 85 82 5D 3C 3E DE 16", Some(60), ""),
    (5, "68 0B 0B 68 82 85 08 3E 3C 00 0C 00 02 12 34 DD 16", Some(62), "00 0C 00 02 12 34"),
    (2, EXCHANGE, None, IMAGE),
    (5, ANSWER, None, IMAGE),
    (2, "68 07 07 68 FF 82 46 3A 3E 00 00 3F 16", Some(58), "00 00"),
    (2, "68 07 07 68 FF 82 46 3A 3E 02 00 41 16", Some(58), "02 00"),
    (2, "68 0C 0C 68 85 82 7D 3D 3E 40 00 00 00 12 34 00 85 16", Some(61), "40 00 00 00 12 34 00"),
    (5, "E5", None, ""),
    (5, "10 02 05 03 0A 16", None, ""),
    (2, "DC 02 02", None, ""),
    (2, "68 05 05 68 85 82 7D 3C 3E FE 16", Some(60), ""),
];
const IMAGE: &str =
    "0000000000000000000000000000000000000000000000000000000000000000 41 000000000000000000000000000000";
const EXCHANGE: &str = "68 33 33 68 05 02 7D
    0000000000000000000000000000000000000000000000000000000000000000 41 000000000000000000000000000000 C5 16";
const ANSWER: &str = "68 33 33 68 02 05 08
    0000000000000000000000000000000000000000000000000000000000000000 41 000000000000000000000000000000 50 16";

fn parse_telegram(bytes: &[u8]) -> Telegram {
    match Telegram::parse(bytes) {
        Ok(Parsed::Whole(telegram, len)) if len == bytes.len() => telegram,
        other => panic!("{bytes:02X?}: {other:?}"),
    }
}

#[test]
fn telegrams_of_a_start_match_a_recording() {
    for (from, text, sap, data) in START {
        let bytes = hex(text);
        let telegram = parse_telegram(&bytes);
        assert_eq!(telegram.emit(), bytes, "{text}");
        if let Telegram::Frame(frame) = telegram {
            assert_eq!((frame.from, frame.to_sap, frame.data), (from, sap, hex(data)), "{text}");
        }
    }
}

#[test]
fn control_codes_are_those_of_the_standard() {
    let srd = |count| Control::Request(Service::SendRequestHigh, count).byte();
    assert_eq!(srd(FrameCount::First), 0x6D);
    assert_eq!(srd(FrameCount::First.next()), 0x5D);
    assert_eq!(srd(FrameCount::First.next().next()), 0x7D);
    assert_eq!(Control::Request(Service::SendHigh, FrameCount::None).byte(), 0x46);
    assert_eq!(Control::Answer(Station::Slave, Status::NoService).byte(), 0x03);
    assert_eq!(Control::Answer(Station::MasterInRing, Status::Ok).byte(), 0x30);
    for byte in 0..=255 {
        if let Ok(control) = Control::parse(byte, 0) {
            // A function code with FCB but without FCV must also keep its value.
            assert_eq!(control.byte(), byte);
        }
    }
}

#[test]
fn parses_eight_bytes_in_both_formats() {
    let variable = hex("68 0B 0B 68 82 85 08 3E 3C 02 05 00 FF 12 34 D5 16");
    let fixed = hex("A2 82 85 08 3E 3C 02 05 00 FF 12 34 D5 16");
    assert_eq!(parse_telegram(&variable), parse_telegram(&fixed));
    assert_eq!(parse_telegram(&fixed).emit(), variable);
}

#[test]
fn errors_describe_the_problem() {
    for (text, message) in [
        ("10 05 02 49 51 16", "frame check sequence at offset 4: is 0x51, not 0x50"),
        ("10 05 02 49 50 17", "end delimiter at offset 5: is 0x17, not 0x16"),
        ("68 05 06 68", "repeated length at offset 2: is 0x06, not 0x05"),
        ("68 05 05 10", "repeated start at offset 3: is 0x10, not 0x68"),
        ("68 03 03 68", "length at offset 1: is 0x03"),
        ("68 FA FA 68", "length at offset 1: is 0xfa"),
        ("DC 7E 02", "address at offset 1: is 0x7e"),
        ("00", "start delimiter at offset 0: is 0x00"),
        ("10 05 02 C9 D0 16", "function code at offset 3: is 0xc9"),
        (
            "10 85 02 49 D0 16",
            "service access point of the receiver at offset 4: needs 1 bytes, but only 0 are present",
        ),
    ] {
        assert_eq!(Telegram::parse(&hex(text)).unwrap_err().to_string(), message, "{text}");
    }
}

#[test]
fn describes_a_diagnosis() {
    let text = |data: &str| Diagnosis::parse(&hex(data)).unwrap().to_string();
    assert_eq!(text("02 05 00 FF 12 34"), "not ready for data, needs parameters, no master, ident 0x1234");
    assert_eq!(text("00 0C 00 02 12 34"), "watchdog on, master 2, ident 0x1234");
    assert_eq!(
        text("C8 04 80 09 00 01 03 AA BB 42 05 83 45 26 C1"),
        "wrong parameters, locked by another master, diagnosis overflow, master 9, ident 0x0001, device AABB, \
         modules 0 2, module 3 input channel 5: line break, revision 1"
    );
    let error = Diagnosis::parse(&hex("08 04 00 FF 12 34 05 01")).unwrap_err();
    assert_eq!(error.to_string(), "block of the diagnosis at offset 6: needs 5 bytes, but only 2 are present");
}

#[test]
fn identifiers_give_the_image_size_in_every_format() {
    // Examples: two modules per direction, one module with both directions, a special identifier in words, a special
    // identifier in bytes.
    for (text, modules) in [
        ("5F 57 6F 67", 4),
        ("DF D7 EF E7", 4),
        ("7F 77", 2),
        ("FF F7", 2),
        ("C0 D7 D7", 1),
        ("C0 AF AF", 1),
        ("00 C0 D7 D7 0F", 3),
        ("C2 D7 D7 AA BB", 1),
        ("40 D7 80 D7", 2),
    ] {
        let configuration = Configuration::parse(&hex(text)).unwrap();
        let found = (configuration.input(), configuration.output(), configuration.modules().len());
        assert_eq!(found, (48, 48, modules), "{text}");
    }
    assert!(Configuration::parse(&hex("C0 D7")).is_err());
    assert!(Configuration::parse(&hex("C3 D7 D7 01")).is_err());
    assert!(Configuration::parse(&[0x7F; 8]).is_err());
}

#[test]
fn watchdogs_are_products() {
    let watchdog = |ms| Watchdog::at_least(Duration::from_millis(ms)).unwrap();
    assert_eq!(watchdog(300), Watchdog::from_factors([30, 1]).unwrap());
    assert_eq!(watchdog(0).time(), Duration::from_millis(10));
    for ms in [10, 2550, 2560, 5110, 10_001, 650_000] {
        let time = watchdog(ms).time();
        assert!((ms..=ms + ms / 40 + 10).contains(&u64::try_from(time.as_millis()).unwrap()), "{ms}: {time:?}");
    }
    assert_eq!(Watchdog::at_least(Duration::from_secs(700)), None);
}

#[test]
fn noise_does_not_hide_a_telegram() {
    let telegram = hex("68 05 05 68 85 82 6D 3C 3E EE 16");
    // A start byte to which no telegram belongs, then a telegram with a wrong checksum.
    let mut bytes = hex("68 68 10 05 02 49 51 16 00 DC FF");
    bytes.extend(&telegram);
    let mut stream = Stream::default();
    stream.push(&bytes);
    let mut found = Vec::new();
    while let Some(piece) = stream.next_piece() {
        if let Piece::Telegram(_, bytes) = piece {
            found.push(bytes);
        }
    }
    assert_eq!(found, [telegram]);
    assert!(stream.is_empty());
}

fn counts() -> impl Strategy<Value = FrameCount> {
    prop_oneof![Just(FrameCount::None), Just(FrameCount::First), any::<bool>().prop_map(FrameCount::Counters)]
}

fn frames() -> impl Strategy<Value = Frame> {
    let control = prop_oneof![
        counts().prop_map(|count| Control::Request(Service::SendRequestHigh, count)),
        Just(Control::Answer(Station::Slave, Status::DataHigh)),
    ];
    let sap = || proptest::option::of(0_u8..64);
    (0_u8..=127, 0_u8..=127, control, sap(), sap(), proptest::collection::vec(any::<u8>(), 0..=MAX_DATA))
        .prop_map(|(to, from, control, to_sap, from_sap, data)| Frame { to, from, control, to_sap, from_sap, data })
}

proptest! {
    #[test]
    fn frames_round_trip_and_match_another_parser(frame in frames()) {
        let bytes = frame.emit();
        prop_assert_eq!(parse_telegram(&bytes), Telegram::Frame(frame.clone()));
        let Some(Ok((fdl::Telegram::Data(theirs), len))) = fdl::Telegram::deserialize(&bytes) else {
            return Err(TestCaseError::fail("the other codec does not read it"));
        };
        prop_assert_eq!(len, bytes.len());
        prop_assert_eq!((theirs.h.da, theirs.h.sa), (frame.to, frame.from));
        prop_assert_eq!((theirs.h.dsap, theirs.h.ssap), (frame.to_sap, frame.from_sap));
        prop_assert_eq!(theirs.h.fc.to_byte(), frame.control.byte());
        prop_assert_eq!(theirs.pdu, &frame.data[..]);
    }

    #[test]
    fn parses_telegrams_of_another_encoder(frame in frames()) {
        let fc = fdl::FunctionCode::from_byte(frame.control.byte()).unwrap();
        let header = fdl::DataTelegramHeader {
            da: frame.to, sa: frame.from, dsap: frame.to_sap, ssap: frame.from_sap, fc,
        };
        let mut buffer = [0; 300];
        let len = header.serialize(&mut buffer, frame.data.len(), |data| data.copy_from_slice(&frame.data));
        prop_assert_eq!(parse_telegram(&buffer[..len]), Telegram::Frame(frame));
    }

    #[test]
    fn splits_any_bytes_without_loss(bytes in proptest::collection::vec(
        prop_oneof![any::<u8>(), Just(0x68), Just(0x10), Just(0xA2), Just(0xE5), Just(0xDC)], 0..200,
    )) {
        let mut stream = Stream::default();
        stream.push(&bytes);
        let mut seen = Vec::new();
        while let Some(piece) = stream.next_piece() {
            match piece {
                Piece::Telegram(_, bytes) => seen.extend(bytes),
                Piece::Noise(byte, _) => seen.push(byte),
            }
        }
        prop_assert_eq!(&seen[..], &bytes[..seen.len()]);
    }

    #[test]
    fn any_data_is_parsed_or_an_error(data in proptest::collection::vec(any::<u8>(), 0..=MAX_DATA)) {
        if let Ok(diagnosis) = Diagnosis::parse(&data) {
            prop_assert_eq!(Diagnosis::parse(&diagnosis.emit()).unwrap().to_string(), diagnosis.to_string());
        }
        if let Ok(parameters) = Parameters::parse(&data) {
            prop_assert_eq!(Parameters::parse(&parameters.emit()).unwrap(), parameters);
        }
        if let Ok(configuration) = Configuration::parse(&data) {
            prop_assert!(configuration.input() <= MAX_DATA && configuration.output() <= MAX_DATA);
        }
        let _ = GlobalControl::parse(&data).map(|control| control.to_string());
    }

    #[test]
    fn detects_a_changed_byte(
        frame in frames(), at in any::<prop::sample::Index>(), bits in 1_u8..,
    ) {
        let mut bytes = frame.emit();
        let at = 1 + at.index(bytes.len() - 1);
        bytes[at] ^= bits;
        prop_assert!(Telegram::parse(&bytes).is_err());
    }
}
