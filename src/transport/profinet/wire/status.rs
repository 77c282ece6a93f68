//! PNIOStatus: error codes of a device, and the texts of these codes.

use std::fmt;

/// Error code of a device (PNIOStatus): error code, decode, code 1 and code 2, from the highest byte.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Status(pub u32);

/// Names of the fields of a block, by code 2.
type Fields = &'static [(u8, &'static str)];

/// Names of the blocks, by code 1. Each block has its fields, by code 2.
#[rustfmt::skip] // Two levels of indentation more would hide the table.
const BLOCKS: [(u8, &str, Fields); 8] = [
    (0x01, "the connection (ARBlockReq)", &[
        (0x00, "its type"),
        (0x01, "its length"),
        (0x02, "its version"),
        (0x03, "its version"),
        (0x04, "ARType"),
        (0x05, "ARUUID"),
        (0x06, "SessionKey"),
        (0x07, "the MAC address of the controller"),
        (0x08, "the object UUID of the controller"),
        (0x09, "ARProperties"),
        (0x0A, "the activity timeout"),
        (0x0B, "the UDP port"),
        (0x0C, "the length of the controller's name"),
        (0x0D, "the controller's name"),
    ]),
    (0x02, "cyclic data (IOCRBlockReq)", &[
        (0x00, "its type"),
        (0x01, "its length"),
        (0x02, "its version"),
        (0x03, "its version"),
        (0x04, "IOCRType"),
        (0x05, "IOCRReference"),
        (0x06, "the type of its frames"),
        (0x07, "the RT class"),
        (0x08, "DataLength"),
        (0x09, "FrameID"),
        (0x0A, "the send clock"),
        (0x0B, "the cycle (ReductionRatio)"),
        (0x0C, "the phase"),
        (0x0E, "FrameSendOffset"),
        (0x0F, "the watchdog"),
        (0x10, "the data hold time"),
        (0x11, "the tag"),
        (0x12, "the multicast address"),
        (0x13, "the number of APIs"),
        (0x14, "the API"),
        (0x15, "the number of data objects"),
        (0x16, "a slot of a data object"),
        (0x17, "a subslot of a data object"),
        (0x18, "the offset of a data object"),
        (0x19, "the number of consumer statuses"),
        (0x1A, "a slot of a consumer status"),
        (0x1B, "a subslot of a consumer status"),
        (0x1C, "the offset of a consumer status"),
    ]),
    (0x03, "the modules (ExpectedSubmoduleBlockReq)", &[
        (0x00, "its type"),
        (0x01, "its length"),
        (0x02, "its version"),
        (0x03, "its version"),
        (0x04, "the number of APIs, or the module in a slot"),
        (0x05, "the API"),
        (0x06, "the slot, or the submodule"),
        (0x07, "the module, or the length of its data"),
        (0x08, "the properties of the module"),
        (0x09, "the number of submodules"),
        (0x0A, "the subslot"),
        (0x0B, "the submodule"),
        (0x0C, "the properties of the submodule"),
        (0x0D, "the direction of its data"),
        (0x0E, "the length of its data"),
        (0x0F, "the length of IOPS"),
        (0x10, "the length of IOCS"),
    ]),
    (0x04, "alarms (AlarmCRBlockReq)", &[
        (0x00, "it is missing"),
        (0x04, "AlarmCRType"),
        (0x05, "the type of its frames"),
        (0x06, "its properties"),
        (0x07, "the timeout"),
        (0x08, "the retries"),
        (0x09, "the reference"),
        (0x0A, "the maximum length of an alarm"),
        (0x0B, "the VLAN tag for high priority"),
        (0x0C, "the VLAN tag for low priority"),
    ]),
    (0x14, "the control block", &[(0x00, "its type"), (0x04, "ARUUID"), (0x05, "SessionKey"), (0x08, "the command")]),
    (0x16, "ApplicationReady", &[]),
    (0x28, "the release block", &[]),
    (0x3D, "the state of the device", &[(0x00, "it does not match the call")]),
];

/// Errors of the RPC layer (code 1 is 0x40), by code 2.
const RPC: [(u8, &str); 10] = [
    (0x00, "the length of the arguments is wrong"),
    (0x01, "it contains unknown blocks"),
    (0x02, "the cyclic data of one direction is missing"),
    (0x03, "wrong number of alarm channels"),
    (0x04, "no free connection: another controller uses the device, or the last connection has not timed out yet"),
    (0x05, "the connection is unknown or has ended"),
    (0x06, "the state does not allow this call"),
    (0x07, "the connection could not start: not enough memory or timers"),
    (0x08, "the device has no free resources"),
    (0x09, "another connection uses its ports"),
];

/// Errors of record access, by code 1.
const RECORDS: [(u8, &str); 18] = [
    (0xA0, "read error"),
    (0xA1, "write error"),
    (0xA2, "the module failed"),
    (0xA7, "the device is busy"),
    (0xA8, "version conflict"),
    (0xA9, "not supported"),
    (0xB0, "no such record"),
    (0xB1, "the length is wrong"),
    (0xB2, "no such slot or subslot"),
    (0xB3, "the type does not match"),
    (0xB4, "no such area"),
    (0xB5, "not possible in this state"),
    (0xB6, "access is denied"),
    (0xB7, "a value is out of its range"),
    (0xB8, "a parameter is invalid"),
    (0xC2, "the resource is busy"),
    (0xC3, "the resource is unavailable"),
    (0xC0, "read constraint conflict"),
];

/// Abort reasons of RTA (code 1 is 0xFD), by code 2.
const REASONS: [(u8, &str); 32] = [
    (0x01, "an alarm came out of sequence"),
    (0x02, "the connection was closed"),
    (0x03, "out of memory for alarms, or an alarm was lost"),
    (0x04, "the cyclic data could not be started"),
    (0x05, "no cyclic data came in time (watchdog or data hold)"),
    (0x06, "the next step of the connection did not come in time (activity timeout)"),
    (0x07, "the alarm channel could not be started"),
    (0x08, "an alarm was not acknowledged"),
    (0x09, "an alarm could not be sent"),
    (0x0A, "an alarm could not be acknowledged"),
    (0x0B, "an error frame came instead of an alarm"),
    (0x0C, "a message was out of its range"),
    (0x0D, "the connection was aborted"),
    (0x0E, "the same controller connected again"),
    (0x0F, "the connection was released"),
    (0x10, "the device was deactivated"),
    (0x11, "the connection was removed"),
    (0x12, "a protocol was violated"),
    (0x13, "the name of the station could not be resolved"),
    (0x14, "RPC bind failed"),
    (0x15, "Connect failed"),
    (0x16, "Read failed"),
    (0x17, "Write failed"),
    (
        0x18,
        "a control call failed. Usually, ApplicationReady was not answered: check that UDP port 34964 is open on this \
         computer",
    ),
    (0x19, "the device asked for a pull or plug of a module"),
    (0x1A, "the application of the device has ended"),
    (0x1B, "the link is down"),
    (0x1C, "a MAC address could not be resolved"),
    (0x1D, "synchronization was lost"),
    (0x1E, "the ports of the device do not match"),
    (0x1F, "the name or the address of the station was changed"),
    (0x20, "the device was reset to factory settings"),
];

impl Status {
    /// Creates a status from its parts.
    pub const fn new(code: u8, decode: u8, code1: u8, code2: u8) -> Self {
        Self(u32::from_be_bytes([code, decode, code1, code2]))
    }

    /// Returns the status of an abort for this reason.
    pub const fn abort(reason: u8) -> Self {
        Self::new(0xCF, 0x81, 0xFD, reason)
    }

    /// Returns error code, decode, code 1 and code 2.
    pub const fn parts(self) -> [u8; 4] {
        self.0.to_be_bytes()
    }

    /// Whether the device refused because it has no free connection.
    pub const fn is_owned(self) -> bool {
        matches!(self.parts(), [_, 0x81, 0x40, 0x04])
    }

    /// Whether the device refused because it does not have this connection.
    pub const fn is_unknown_ar(self) -> bool {
        matches!(self.parts(), [_, 0x81, 0x40, 0x05])
    }

    /// Name of the refused call or alarm.
    pub const fn call(self) -> &'static str {
        match self.parts()[0] {
            0xDB => "Connect",
            0xDC => "Release",
            0xDD => "Control",
            0xDE => "Read",
            0xDF => "Write",
            0xCF => "the connection",
            0xDA => "an alarm acknowledgement",
            _ => "the call",
        }
    }

    /// Remedies; empty if none is known.
    pub const fn remedies(self) -> &'static [&'static str] {
        match self.parts() {
            [_, 0x81, 0x40, 0x04] => &["end the other controller's connection, or wait until its watchdog ends it"],
            [_, 0x81, 0x01 | 0x40, _] => &["connect again"],
            [_, 0x81, 0x02, 0x07] => &["set startup=legacy in the target"],
            [_, 0x81, 0x02, 0x08 | 0x16..=0x1C] | [_, 0x81, 0x03, _] => {
                &["compare layout= or gsdml= of the target with the modules of the device"]
            }
            [_, 0x81, 0x02, 0x0A..=0x10] => &["set a longer cycle= or another watchdog= in the target"],
            [0xCF, 0x81, 0xFD, 0x05 | 0x06] => &["set a longer watchdog= or cycle= in the target", "check the cable"],
            [0xCF, 0x81, 0xFD, 0x18] => &["open UDP port 34964 in the firewall of this computer"],
            [0xCF, 0x81, 0xFD, 0x1F | 0x20] => &["search for the station again: its name or address has changed"],
            _ => &[],
        }
    }

    /// Text of the status, without the four codes; `None` if the status is unknown.
    pub fn meaning(self) -> Option<String> {
        let [_, decode, code1, code2] = self.parts();
        let named = |list: &[(u8, &'static str)], code| list.iter().find(|entry| entry.0 == code).map(|entry| entry.1);
        match (decode, code1) {
            (0x80, _) => named(&RECORDS, code1).map(str::to_owned),
            (0x81, 0xFD) => named(&REASONS, code2).map(str::to_owned),
            (0x81, 0x40) => named(&RPC, code2).map(str::to_owned),
            (0x81, _) => {
                let (_, block, fields) = BLOCKS.iter().find(|block| block.0 == code1)?;
                Some(match named(fields, code2) {
                    Some(field) => format!("it refuses {block}: {field}"),
                    None => format!("it refuses {block}: field {code2:#04x}"),
                })
            }
            _ => None,
        }
    }
}

impl fmt::Display for Status {
    /// Writes the text and the four codes. The codes are included because some devices use other field numbers.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [code, decode, code1, code2] = self.parts();
        if let Some(meaning) = self.meaning() {
            write!(f, "{meaning} ")?;
        }
        write!(f, "({code:02X} {decode:02X} {code1:02X} {code2:02X})")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn describes_statuses_with_their_bytes() {
        let cases = [
            (0xDB81_0209, "it refuses cyclic data (IOCRBlockReq): FrameID (DB 81 02 09)"),
            (0xDB81_01FF, "it refuses the connection (ARBlockReq): field 0xff (DB 81 01 FF)"),
            (0xDE80_B000, "no such record (DE 80 B0 00)"),
            (0xCF81_FD05, "no cyclic data came in time (watchdog or data hold) (CF 81 FD 05)"),
            (0xDC81_4005, "the connection is unknown or has ended (DC 81 40 05)"),
            (0x1234_5678, "(12 34 56 78)"),
        ];
        for (status, text) in cases {
            assert_eq!(Status(status).to_string(), text);
        }
        assert!(Status(0xDB81_4004).is_owned() && Status(0xDC81_4005).is_unknown_ar());
        assert_eq!(Status::abort(5), Status(0xCF81_FD05));
    }

    #[test]
    fn every_reason_has_a_unique_text() {
        for (at, (code, _)) in REASONS.iter().enumerate() {
            assert_eq!(usize::from(*code), at + 1);
        }
        assert_eq!(Status::abort(0x21).meaning(), None);
    }
}
