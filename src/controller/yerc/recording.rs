//! Reads and their answers as text, for recordings.

use super::request::Request;
use super::wire::Status;
use crate::text::{hex, unhex};

/// Mark of a refusal.
const REFUSED: char = '!';

/// Text of a request: command, instance, attribute, service and data: `0x72 1 0 0x01`.
pub fn request_text(request: &Request) -> String {
    let Request { command, instance, attribute, service, data } = request;
    let text = format!("{command:#04x} {instance} {attribute} {service:#04x} {}", hex(data));
    text.trim_end().to_owned()
}

/// Parses the text of a request.
pub fn parse_request(text: &str) -> Option<Request> {
    let mut words = text.split(' ');
    let mut next = || words.next();
    let command = u16::from_str_radix(next()?.strip_prefix("0x")?, 16).ok()?;
    let (instance, attribute) = (next()?.parse().ok()?, next()?.parse().ok()?);
    let service = u8::from_str_radix(next()?.strip_prefix("0x")?, 16).ok()?;
    let data = unhex(next().unwrap_or_default())?;
    Some(Request { command, instance, attribute, service, data })
}

/// Text of an answer: its data in hexadecimal, or `!` and the status of a refusal: code, size of the added status, added
/// status.
pub fn answer_text(status: Status, data: &[u8]) -> String {
    if status.is_ok() {
        return hex(data);
    }
    let Status { code, added_size, added } = status;
    format!("{REFUSED}{code:02x} {added_size} {added:04x}")
}

/// Parses the text of an answer.
pub fn parse_answer(text: &str) -> Option<(Status, Vec<u8>)> {
    let Some(refusal) = text.strip_prefix(REFUSED) else { return Some((Status::OK, unhex(text)?)) };
    let [code, added_size, added] = <[&str; 3]>::try_from(refusal.split(' ').collect::<Vec<_>>()).ok()?;
    let (code, added) = (u8::from_str_radix(code, 16).ok()?, u32::from_str_radix(added, 16).ok()?);
    let added_size = added_size.parse().ok().filter(|size| *size <= 2)?;
    Some((Status { code, added_size, added }, Vec::new()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_of_exchanges_are_parsed_again() {
        let request = Request { command: 0x300, instance: 1001, attribute: 0, service: 0x33, data: vec![4, 0, 0, 0] };
        assert_eq!(request_text(&request), "0x300 1001 0 0x33 04000000");
        let status = Request { command: 0x72, instance: 1, data: Vec::new(), service: 1, ..request.clone() };
        assert_eq!(request_text(&status), "0x72 1 0 0x01");
        for request in [request, status] {
            assert_eq!(parse_request(&request_text(&request)), Some(request));
        }
        let plain = Status { code: 8, ..Status::OK };
        for (status, data) in [(Status::OK, vec![1, 0xAB]), (Status::refused(0x2060), vec![]), (plain, vec![])] {
            assert_eq!(parse_answer(&answer_text(status, &data)), Some((status, data)));
        }
        assert_eq!(answer_text(Status::refused(0x2060), &[]), "!1f 1 2060");
        for wrong in ["", "72 1 0 1", "0x72", "0x72 1 0 0x01 5"] {
            assert_eq!(parse_request(wrong), None, "{wrong}");
        }
        for wrong in ["!", "!1f", "!1f 3 0000", "5"] {
            assert_eq!(parse_answer(wrong), None, "{wrong}");
        }
    }
}
