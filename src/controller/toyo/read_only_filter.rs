//! Filter for a read-only line: decides which characters may pass to the controller.

use super::request::Request;
use super::table::commands::Command;
use crate::Risk;

/// Whether the characters are whole blocks that only read data or stop the robot (STOP, and JGST without a moving axis;
/// TO 2-7).
pub fn only_reads_or_stops(characters: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(characters) else { return false };
    let Some(blocks) = text.strip_suffix(['\r', '\n']) else { return false };
    blocks.split(['\r', '\n']).filter(|block| !block.is_empty()).all(|block| {
        Request::parse(block).is_ok_and(|request| match request.command() {
            Command::Stop => true,
            Command::Jgst => request.risk() < Risk::Motion,
            _ => request.risk() == Risk::Read,
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_reads_and_stops_pass() {
        for block in ["@STAS SNO=0\r\n", "@STOP\r\n", "@JGST X=SP Y=SP Z=SP R=SP\r\n", "@MPST\r\n@STAS SNO=1\r\n"] {
            assert!(only_reads_or_stops(block.as_bytes()), "{block}");
        }
        for block in [
            "@HOME\r\n",
            "@JGST X=+H Y=SP Z=SP R=SP\r\n",
            "@HSON\r\n",
            "@STAS SNO=0\r\n@HOME\r\n",
            "@STAS SNO=0\r@HOME\r",
            "@HO",
            "@NONE\r\n",
            "\u{e9}\r\n",
        ] {
            assert!(!only_reads_or_stops(block.as_bytes()), "{block}");
        }
    }
}
