//! CONNECT, and properties of MQTT 5.

use std::time::Duration;

use mqtt_protocol_core::mqtt::packet::{MessageExpiryInterval, Packet, Properties, Property, Qos, v3_1_1, v5_0};
use mqtt_protocol_core::mqtt::result_code::MqttError;

use super::message::{Hello, Message, Version};

/// Maximum number of characters that a report contains of a text from a broker.
const MAX_TEXT_LEN: usize = 200;

/// The property of a message that expires. MQTT counts in whole seconds, so a fraction becomes a whole second.
pub(super) fn expiry_property(expiry: Duration) -> Result<Property, MqttError> {
    let seconds = expiry.as_secs() + u64::from(expiry.subsec_nanos() > 0);
    let expiry = MessageExpiryInterval::new(u32::try_from(seconds).unwrap_or(u32::MAX))?;
    Ok(Property::MessageExpiryInterval(expiry))
}

/// Creates CONNECT.
pub(super) fn connect(hello: &Hello) -> Result<Packet, MqttError> {
    let Hello { version, client_id, user, password, keep_alive, will } = hello;
    let seconds = u16::try_from(keep_alive.as_secs()).unwrap_or(u16::MAX);
    // The builders of both versions have the same methods, but different types.
    macro_rules! build {
        ($connect:path) => {{
            let mut builder =
                <$connect>::builder().client_id(client_id.as_str())?.clean_start(true).keep_alive(seconds);
            if let Some(Message { topic, payload, retain, .. }) = will {
                builder = builder.will_message(topic.as_str(), payload.clone(), Qos::AtLeastOnce, *retain)?;
            }
            if let Some(user) = user {
                builder = builder.user_name(user.as_str())?;
            }
            if let Some(password) = password {
                builder = builder.password(password.clone())?;
            }
            builder.build()?.into()
        }};
    }
    Ok(match version {
        Version::V3 => build!(v3_1_1::Connect),
        Version::V5 => build!(v5_0::Connect),
    })
}

/// Returns the reason text of the broker, and the other server that it recommends.
pub(super) fn texts(properties: &Properties) -> (Option<String>, Option<String>) {
    let mut found = (None, None);
    for property in properties {
        match property {
            Property::ReasonString(reason) => found.0 = Some(shorten(reason.val())),
            Property::ServerReference(server) => found.1 = Some(shorten(server.val())),
            _ => {}
        }
    }
    found
}

fn shorten(text: &str) -> String {
    text.chars().take(MAX_TEXT_LEN).collect()
}

/// Finds packets with the identifier 0, which MQTT forbids (3.1.1, section 2.3.1; 5, section 2.2.1). The codec accepts
/// such a packet, and panics when it answers it.
#[derive(Debug, Default)]
pub(super) struct IdentifierCheck {
    /// First byte of the packet: type and flags.
    head: Option<u8>,
    /// Remaining length, from `shift` bits so far.
    length: usize,
    shift: u32,
    /// Position in the packet after the length; `None` inside the head.
    at: Option<usize>,
    /// Length of the topic of PUBLISH.
    topic: usize,
    is_zero: bool,
}

impl IdentifierCheck {
    /// Whether the bytes up to this one can belong to valid packets.
    pub(super) fn accepts(&mut self, byte: u8) -> bool {
        let Some(head) = self.head else {
            self.head = Some(byte);
            return true;
        };
        let Some(at) = self.at else {
            self.length |= usize::from(byte & 0x7F) << self.shift.min(21);
            self.shift += 7;
            if byte & 0x80 == 0 {
                self.at = Some(0);
                self.end_at(0);
            }
            return true;
        };
        let is_publish = head >> 4 == 3;
        if is_publish && at < 2 {
            self.topic = self.topic << 8 | usize::from(byte);
        }
        let identifier = match head >> 4 {
            3 if head & 0b0110 != 0 => (at >= 2).then_some(2 + self.topic),
            4..=7 | 9 | 11 => Some(0),
            _ => None,
        };
        let is_valid = match identifier.and_then(|identifier| at.checked_sub(identifier)) {
            Some(0) => {
                self.is_zero = byte == 0;
                true
            }
            Some(1) => !self.is_zero || byte != 0,
            _ => true,
        };
        self.end_at(at + 1);
        is_valid
    }

    fn end_at(&mut self, at: usize) {
        if at < self.length {
            self.at = Some(at);
        } else {
            *self = Self::default();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::IdentifierCheck;

    fn accepts(bytes: &[u8]) -> bool {
        let mut check = IdentifierCheck::default();
        bytes.iter().all(|byte| check.accepts(*byte))
    }

    #[test]
    fn only_an_identifier_of_0_is_refused() {
        const CONNACK: &[u8] = &[0x20, 2, 0, 0];
        for packet in [
            &[0x40, 2, 0, 1][..],
            &[0x90, 3, 1, 0, 1],
            &[0xD0, 0],
            // No identifier: QoS 0.
            &[0x30, 5, 0, 1, b'a', 0, 0],
            &[0x32, 6, 0, 1, b'a', 0, 9, 0],
            &[0x32, 0x83, 0, 0, 1, b'a'],
        ] {
            assert!(accepts(&[CONNACK, packet, packet, CONNACK].concat()), "{packet:?}");
        }
        for packet in [
            &[0x40, 2, 0, 0][..],
            &[0x62, 2, 0, 0],
            &[0x32, 6, 0, 1, b'a', 0, 0, 0],
            &[0x3D, 4, 0, 0, 0, 0],
            &[0xB0, 4, 0, 0, 0, 0],
        ] {
            assert!(!accepts(&[CONNACK, packet].concat()), "{packet:?}");
        }
    }
}
