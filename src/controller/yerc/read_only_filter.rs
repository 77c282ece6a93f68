//! Filter for a read-only link: decides which datagrams may pass to the controller.

use super::request::Request;
use super::table::service;
use super::wire::RequestFrame;
use crate::Risk;

/// Whether a datagram only reads data, or stops the robot (HOLD on; FS and DX 3.3.20). Of transfer frames, only the
/// frames of a download may pass.
pub fn only_reads_or_stops(datagram: &[u8]) -> bool {
    let Ok(frame) = RequestFrame::parse(datagram) else { return false };
    if frame.ack {
        return frame.data.is_empty();
    }
    let is_hold = (frame.command, frame.instance, frame.service) == (0x83, 1, service::SET_SINGLE)
        && frame.data == [1, 0, 0, 0].as_slice();
    is_hold || Request::from(frame).risk() == Risk::Read
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::yerc::files::{ack_frame, data_frame};

    fn passes(command: u16, instance: u16, service: u8, data: &[u8]) -> bool {
        let data = data.to_vec();
        only_reads_or_stops(&Request { command, instance, attribute: 1, service, data }.frame(7))
    }

    #[test]
    fn reads_and_hold_pass_and_nothing_else() {
        assert!(passes(0x72, 1, 0x0E, &[]));
        assert!(passes(0x83, 1, 0x10, &[1, 0, 0, 0]));
        for (command, instance, service, data) in [
            (0x83, 1, 0x10, [2, 0, 0, 0]),
            (0x83, 2, 0x10, [1, 0, 0, 0]),
            (0x86, 1, 0x10, [1, 0, 0, 0]),
            (0x7A, 0, 0x10, [1, 0, 0, 0]),
        ] {
            assert!(!passes(command, instance, service, &data), "{command:#04x} {instance}");
        }
    }

    #[test]
    fn files_can_be_read_but_not_written() {
        assert!(only_reads_or_stops(&Request::file(service::SAVE, *b"A.JBI").frame(1)));
        assert!(only_reads_or_stops(&ack_frame(1, service::SAVE, 1)));
        for frame in [
            Request::file(service::LOAD, *b"A.JBI").frame(1),
            Request::file(service::DELETE, *b"A.JBI").frame(1),
            data_frame(1, 1, b"/JOB"),
            b"YERC".to_vec(),
        ] {
            assert!(!only_reads_or_stops(&frame));
        }
    }
}
