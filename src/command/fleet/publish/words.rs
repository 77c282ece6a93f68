//! Failures for the broker's refusals and connection errors, with hints.

use super::broker::Url;
use super::uplink::{Loss, Refusal, TlsError, Version};
use crate::failure::{Failure, Kind};

/// Return codes of MQTT 3.1.1, section 3.2.2.3: meaning, hint, and whether it concerns a setting.
const RETURN_CODES: [(u8, &str, &str, bool); 5] = [
    (1, "it does not speak this version of MQTT", "try --protocol 5, or ask which versions it has", true),
    (2, "it does not accept the name of this client", "give another name with --node", true),
    (3, "it is not available at present", "look at the broker", false),
    (4, "wrong user name or password", "check --user and the password", true),
    (5, "not authorized to connect", "check --user and the password, and what the broker lets this user do", true),
];

/// Reason codes of MQTT 5, section 3.2.2.2.
const REASON_CODES: [(u8, &str, &str, bool); 20] = [
    (0x80, "it gives no reason", "its log tells more", false),
    (0x81, "it says that CONNECT is malformed", "try --protocol 3.1.1", true),
    (0x82, "it says that CONNECT breaks the protocol", "try --protocol 3.1.1", true),
    (0x83, "for a reason of its own", "its log tells more", false),
    (0x84, "it does not speak this version of MQTT", "try --protocol 3.1.1", true),
    (0x85, "it does not accept the name of this client", "give another name with --node", true),
    (0x86, "wrong user name or password", "check --user and the password", true),
    (0x87, "not authorized to connect", "check --user and the password, and what the broker lets this user do", true),
    (0x88, "it is not available at present", "look at the broker", false),
    (0x89, "it is busy", "look at its load and its limits", false),
    (0x8a, "this client is banned", "ask who runs the broker", true),
    (0x8c, "it wants another way to log in", "a user with a password, or a client certificate", true),
    (0x90, "it does not accept the topic of the last will", "choose another --prefix", true),
    (0x95, "CONNECT is too large for it", "choose a shorter --prefix and --node", true),
    (0x97, "a quota is used up", "look at its limits", false),
    (0x99, "it does not accept the last will", "its log tells more", true),
    (0x9a, "it keeps no retained messages, and this command needs them", "allow retained messages", true),
    (0x9b, "it does not acknowledge messages (QoS 1)", "allow QoS 1", true),
    (0x9c, "it sends clients to another broker", "name that one", true),
    (0x9d, "it has moved", "name its new place", true),
];

/// Failure for a refused CONNECT.
pub fn refusal(url: &Url, refusal: &Refusal) -> Failure {
    let Refusal { version, code, reason, server } = refusal;
    let codes: &[(u8, &str, &str, bool)] = match version {
        Version::V3 => &RETURN_CODES,
        Version::V5 => &REASON_CODES,
    };
    let found = codes.iter().find(|(known, ..)| known == code);
    let (_, why, advice, is_setting) = found.copied().unwrap_or((0, "with a code that has no meaning", "", false));
    let told = reason.as_ref().map(|reason| format!(" ({reason})")).unwrap_or_default();
    let elsewhere = server.as_ref().map(|server| format!(": {server}")).unwrap_or_default();
    let kind = if is_setting { Kind::Usage } else { Kind::NoAnswer };
    let failure = Failure::new(kind, format!("{url} refuses this client: {why}{told}{elsewhere}"));
    let failure = failure.code(format!("0x{code:02X}"));
    if advice.is_empty() { failure } else { failure.hint(advice) }
}

/// Failure for a connection that failed or was lost.
pub fn loss(url: &Url, loss: &Loss) -> Failure {
    if let Loss::Tls(error) = loss {
        return distrust(url, error);
    }
    let failure = Failure::new(Kind::NoAnswer, format!("{url}: {loss}"));
    let hint = match loss {
        Loss::Connect(_) => "check host and port, and whether the broker runs",
        Loss::Garbage(_) if !url.is_secure => "this may be no broker; for TLS, write mqtts://",
        Loss::Closed | Loss::Unanswered if !url.is_secure => {
            "its log tells why; a port for TLS is reached with mqtts://, an old broker with --protocol 3.1.1"
        }
        loss if loss.is_takeover() => "each armctl that publishes needs a name of its own: --node",
        _ => "its log tells more",
    };
    failure.hint(hint)
}

/// Failure for a certificate error.
pub fn distrust(url: &Url, error: &TlsError) -> Failure {
    let (hint, kind) = match error {
        TlsError::UnknownIssuer => {
            ("--ca FILE names the certificate of the authority that signed the broker's", Kind::Usage)
        }
        TlsError::WrongName => ("write the name that is in the certificate into the URL", Kind::Usage),
        TlsError::Expired | TlsError::NotYetValid => {
            ("give the broker a new certificate; or this machine's clock is wrong", Kind::Usage)
        }
        TlsError::Revoked | TlsError::Certificate(_) => ("give the broker a valid certificate", Kind::Usage),
        TlsError::NoTls => ("mqtt:// is without TLS; TLS is usually on port 8883", Kind::Usage),
        TlsError::Rejected(_) => ("--cert FILE --key FILE: a certificate that the broker trusts", Kind::Usage),
        TlsError::NothingInCommon(_) => ("the broker needs TLS 1.2 or 1.3", Kind::Usage),
        TlsError::Setup(_) => ("PEM files begin with -----BEGIN; see --ca, --cert and --key", Kind::Usage),
        TlsError::Other(_) => ("its log tells more", Kind::NoAnswer),
    };
    Failure::new(kind, format!("{url}: {error}")).hint(hint)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn url() -> Url {
        "mqtt://broker".parse().unwrap()
    }

    #[test]
    fn every_code_has_words_and_those_that_stay_say_what_to_do() {
        for version in [Version::V3, Version::V5] {
            for code in 1..=u8::MAX {
                let failure = refusal(&url(), &Refusal { version, code, reason: None, server: None });
                assert!(failure.message.starts_with("mqtt://broker:1883 refuses this client: "));
                assert!(failure.kind != Kind::Usage || failure.hint.is_some(), "{code}");
            }
        }
        let refused =
            Refusal { version: Version::V5, code: 0x9d, reason: Some("sorry".into()), server: Some("b:1".into()) };
        assert_eq!(
            refusal(&url(), &refused).message,
            "mqtt://broker:1883 refuses this client: it has moved (sorry): b:1"
        );
    }

    #[test]
    fn a_wrong_certificate_is_about_a_setting_and_a_cable_is_not() {
        assert_eq!(loss(&url(), &Loss::Tls(TlsError::Expired)).kind, Kind::Usage);
        assert_eq!(loss(&url(), &Loss::Closed).kind, Kind::NoAnswer);
    }
}
