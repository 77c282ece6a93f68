use super::*;
use crate::{toyo, yerc, yrcx};

const VLAN: &[u8] = include_bytes!("../../../../tests/cli/files/vlan.pcap");
const LINES: &[u8] = include_bytes!("../../../../tests/cli/files/lines.pcapng");
const SPEED: &[u8] = include_bytes!("../../../../tests/cli/files/speed.pcapng");

fn complete_capture<D: CaptureDecoder>(
    file: &[u8],
    selection: &Selection,
    decoder: D,
) -> Result<Capture<D::Field>, Failure> {
    let source = Source { name: "file", open: || Ok(file), selection };
    let (capture, _) = source.capture(decoder, ROOM, false)?;
    Ok(capture.expect("there is room"))
}

/// Number of messages and of packets without a message, for each family.
fn message_counts(file: &[u8], selection: &Selection) -> [Option<(usize, u64)>; 3] {
    fn count<F: Field>(capture: Result<Capture<F>, Failure>) -> Option<(usize, u64)> {
        let capture = capture.ok()?;
        // Views must accept any content.
        capture.list();
        capture.details();
        Some((capture.messages.len(), capture.other_packets))
    }
    [
        count(complete_capture(file, selection, yerc::decode::FrameDecoder::default())),
        count(complete_capture(file, selection, toyo::decode::LineDecoder::default())),
        count(complete_capture(file, selection, yrcx::decode::ImageDecoder::new(true))),
    ]
}

#[test]
fn finds_the_messages_of_each_family() {
    let all = Selection::default();
    assert_eq!(message_counts(VLAN, &all), [Some((3, 2)), Some((0, 5)), Some((0, 5))]);
    assert_eq!(message_counts(LINES, &all), [Some((0, 11)), Some((6, 3)), Some((0, 11))]);
    assert_eq!(message_counts(SPEED, &all), [Some((0, 18)), Some((0, 18)), Some((24, 0))]);
}

#[test]
fn selects_hosts_and_ports() {
    let selection = |host: &str, port| Selection { frame: None, host: host.parse().ok(), port };
    assert_eq!(message_counts(VLAN, &selection("192.168.255.1", Some(10040)))[0], Some((3, 2)));
    assert_eq!(message_counts(VLAN, &selection("192.168.255.3", None))[0], Some((0, 5)));
    assert_eq!(message_counts(VLAN, &selection("", Some(10041)))[0], Some((0, 5)));
}

#[test]
fn reports_cut_and_damaged_files() {
    let all = Selection::default();
    for file in [VLAN, LINES, SPEED] {
        for end in 0..file.len() {
            message_counts(&file[..end], &all);
            let mut damaged = file.to_vec();
            damaged[end] = !damaged[end];
            message_counts(&damaged, &all);
        }
    }
}
