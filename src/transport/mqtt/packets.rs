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
