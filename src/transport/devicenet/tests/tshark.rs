//! Comparison with Wireshark's dissector: names of identifiers, and the duplicate MAC check.

use std::process::Command;

use crate::devicenet::can::Frame;
use crate::devicenet::wire::{DuplicateCheck, Id, Mac};

/// Creates a pcap file with link type 227.
fn capture(frames: &[Frame]) -> Vec<u8> {
    let mut file = Vec::new();
    for word in [0xA1B2_C3D4u32, 2 | 4 << 16, 0, 0, 65_535, 227] {
        file.extend(word.to_le_bytes());
    }
    for frame in frames {
        let bytes = frame.to_capture();
        let len = u32::try_from(bytes.len()).unwrap();
        for word in [0, 0, len, len] {
            file.extend(word.to_le_bytes());
        }
        file.extend(bytes);
    }
    file
}

/// Returns the fields that tshark decodes from each frame; `None` if tshark is not installed.
fn fields(frames: &[Frame], names: &[&str]) -> Option<Vec<Vec<String>>> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("devicenet.pcap");
    std::fs::write(&path, capture(frames)).unwrap();
    let mut command = Command::new("tshark");
    command.arg("-r").arg(&path).args(["-d", "can.subdissector,devicenet", "-T", "fields"]);
    for name in names {
        command.args(["-e", name]);
    }
    let Ok(output) = command.output() else {
        println!("skipped: tshark is not installed");
        return None;
    };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    Some(text.lines().map(|line| line.split('\t').map(str::to_owned).collect()).collect())
}

/// Name that tshark shows for a message; `None` if it shows no such name.
fn name(id: Id) -> Option<&'static str> {
    Some(match id {
        Id::Group1(..) => "Other Group 1 Message",
        Id::MulticastAnswer(_) => "Slave's I/O Multicast Poll Response",
        Id::Change(_) => "Slave's I/O Change of State or Cyclic Message",
        Id::StrobeAnswer(_) => "Slave's I/O Bit-Strobe Response Message",
        Id::PollAnswer(_) => "Slave's I/O Poll Response or COS/Cyclic Ack Message",
        Id::Strobe(_) => "Master's I/O Bit-Strobe Command Message",
        Id::MulticastPoll(_) => "Master's I/O Multicast Poll Group ID",
        Id::ChangeAck(_) => "Master's Change of State or Cyclic Acknowledge Message",
        Id::Answer(_) => "Slave's Explicit/Unconnected Response Messages",
        Id::Request(_) => "Master's Explicit Request Messages",
        Id::Poll(_) => "Master's I/O Poll Command/COS/Cyclic Messages",
        Id::Unconnected(_) => "Group 2 Only Unconnected Explicit Request Messages",
        Id::Duplicate(_) => "Duplicate MAC ID Check Messages",
        // For these messages, tshark shows the name of the service instead.
        Id::Group3(..) | Id::UnconnectedAnswer(_) | Id::UnconnectedRequest(_) => return None,
        Id::Group4(0x2C) => "Communication Faulted Response Message",
        Id::Group4(0x2D) => "Communication Faulted Request Message",
        Id::Group4(0x2E) => "Offline Ownership Response Message",
        Id::Group4(0x2F) => "Offline Ownership Request Message",
        Id::Group4(_) => "Reserved Group 4 Message",
    })
}

#[test]
fn every_identifier_has_the_name_that_tshark_gives_it() {
    let frames: Vec<Frame> = (0..0x800).map(|id| Frame::new(id, &[0; 8]).unwrap()).collect();
    let Some(told) = fields(&frames, &["devicenet.src_mac_id", "devicenet.grp_msg3.id", "_ws.col.Info"]) else {
        return;
    };
    assert_eq!(told.len(), frames.len());
    for (frame, told) in frames.iter().zip(&told) {
        let [source, message3, info] = told.as_slice() else { panic!("{told:?}") };
        let Some(id) = Id::parse(frame.id()) else {
            assert!(info.starts_with("Invalid CAN Message"), "{frame}: {info}");
            continue;
        };
        match name(id) {
            Some(name) => assert!(info.starts_with(name), "{frame}: {info}, not {name}"),
            None => assert_eq!(message3.parse::<u16>().unwrap(), (frame.id() - 0x600) >> 6, "{frame}"),
        }
        if let Some(mac) = id.sender() {
            // In a multicast poll, the MAC is the MAC of a group, and not of the source.
            assert_eq!(source.parse::<u8>().unwrap(), mac.number(), "{frame}");
        }
    }
}

#[test]
fn parses_duplicate_checks_like_tshark() {
    let check = DuplicateCheck { is_answer: true, port: 0, vendor: 636, serial: 0x00C0_FFEE };
    let frame = Frame::new(Id::Duplicate(Mac::new(5).unwrap()).emit(), &check.emit()).unwrap();
    let names = ["devicenet.dup_mac_id.rr", "devicenet.dup_mac_id.vendor", "devicenet.dup_mac_id.serial_number"];
    let Some(told) = fields(&[frame], &names) else { return };
    let [answer, vendor, serial] = told[0].as_slice() else { panic!("{told:?}") };
    assert!(answer == "1" || answer == "True" || answer == "0x01", "{answer}");
    assert!(vendor == "636" || vendor == "0x027c", "{vendor}");
    assert_eq!(u32::from_str_radix(serial.trim_start_matches("0x"), 16), Ok(0x00C0_FFEE), "{serial}");
}
