//! Failures for the broker's refusals and connection errors, with hints.

use super::broker::Url;
use super::uplink::{Loss, Refusal, TlsError, Version};
use armctl_frame::failure::{Failure, Kind};

/// Return codes of MQTT 3.1.1, section 3.2.2.3: meaning, hint, and whether a setting causes the refusal.
const RETURN_CODES: [(u8, &str, &str, bool); 5] = [
    (
        1,
        "the broker does not support this version of MQTT",
        "try --protocol 5, or look up the versions that the broker supports",
        true,
    ),
    (2, "the broker does not accept the name of this client", "set another name with --node", true),
    (3, "the broker is not available at the moment", "check the broker", false),
    (4, "wrong user name or password", "check --user and the password", true),
    (5, "not authorized to connect", "check --user, the password, and the rights of this user at the broker", true),
];

/// Reason codes of MQTT 5, section 3.2.2.2.
const REASON_CODES: [(u8, &str, &str, bool); 20] = [
    (0x80, "the broker gives no reason", "see the log of the broker", false),
    (0x81, "the broker reports a malformed CONNECT", "try --protocol 3.1.1", true),
    (0x82, "the broker reports a protocol error in CONNECT", "try --protocol 3.1.1", true),
    (0x83, "the reason is not defined in MQTT", "see the log of the broker", false),
    (0x84, "the broker does not support this version of MQTT", "try --protocol 3.1.1", true),
    (0x85, "the broker does not accept the name of this client", "set another name with --node", true),
    (0x86, "wrong user name or password", "check --user and the password", true),
    (0x87, "not authorized to connect", "check --user, the password, and the rights of this user at the broker", true),
    (0x88, "the broker is not available at the moment", "check the broker", false),
    (0x89, "the broker is busy", "check the load and the limits of the broker", false),
    (0x8a, "this client is banned", "ask the administrator of the broker", true),
    (0x8c, "the broker needs another login method", "use a user with a password, or a client certificate", true),
    (0x90, "the broker does not accept the topic of the last will", "set another --prefix", true),
    (0x95, "CONNECT is too large for the broker", "set a shorter --prefix and --node", true),
    (0x97, "a quota is used up", "check the limits of the broker", false),
    (0x99, "the broker does not accept the last will", "see the log of the broker", true),
    (
        0x9a,
        "the broker stores no retained messages, but this command needs them",
        "allow retained messages at the broker",
        true,
    ),
    (0x9b, "the broker does not acknowledge messages (QoS 1)", "allow QoS 1 at the broker", true),
    (0x9c, "the broker redirects clients to another broker", "use the address of that broker", true),
    (0x9d, "the broker has a new address", "use the new address of the broker", true),
];

/// Failure for a refused CONNECT.
pub fn refusal(url: &Url, refusal: &Refusal) -> Failure {
    let Refusal { version, code, reason, server } = refusal;
    let codes: &[(u8, &str, &str, bool)] = match version {
        Version::V3 => &RETURN_CODES,
        Version::V5 => &REASON_CODES,
    };
    let found = codes.iter().find(|(known, ..)| known == code);
    let (_, why, advice, is_setting) = found.copied().unwrap_or((0, "the code is not defined", "", false));
    let text = reason.as_ref().map(|reason| format!(" ({reason})")).unwrap_or_default();
    let other_server = server.as_ref().map(|server| format!(": {server}")).unwrap_or_default();
    let kind = if is_setting { Kind::Usage } else { Kind::NoAnswer };
    let failure = Failure::new(kind, format!("{url} refuses this client: {why}{text}{other_server}"));
    let failure = failure.code(format!("0x{code:02X}"));
    if advice.is_empty() { failure } else { failure.hint(advice) }
}

/// Failure for a connection that failed or was lost.
pub fn loss(url: &Url, loss: &Loss) -> Failure {
    if let Loss::Tls(error) = loss {
        return certificate_hint(url, error);
    }
    let failure = Failure::new(Kind::NoAnswer, format!("{url}: {loss}"));
    let hint = match loss {
        Loss::Connect(_) => "check host and port, and check that the broker runs",
        Loss::Garbage(_) if !url.is_secure => "check that this is a broker; for TLS, write mqtts://",
        Loss::Closed | Loss::Unanswered if !url.is_secure => {
            "see the log of the broker; for a TLS port, write mqtts://; for an old broker, add --protocol 3.1.1"
        }
        loss if loss.is_takeover() => "set a different name for each publisher with --node",
        _ => "see the log of the broker",
    };
    failure.hint(hint)
}

/// Failure for a certificate error.
pub fn certificate_hint(url: &Url, error: &TlsError) -> Failure {
    let (hint, kind) = match error {
        TlsError::UnknownIssuer => {
            ("set the certificate of the authority that signed the broker's certificate: --ca FILE", Kind::Usage)
        }
        TlsError::WrongName => ("use the name in the certificate as the host of the URL", Kind::Usage),
        TlsError::Expired | TlsError::NotYetValid => {
            ("check the clock of this computer, or give the broker a new certificate", Kind::Usage)
        }
        TlsError::Revoked | TlsError::Certificate(_) => ("give the broker a valid certificate", Kind::Usage),
        TlsError::NoTls => ("use the TLS port of the broker, usually 8883, or mqtt:// without TLS", Kind::Usage),
        TlsError::Rejected(_) => ("set a certificate that the broker trusts: --cert FILE --key FILE", Kind::Usage),
        TlsError::NothingInCommon(_) => ("use a broker that supports TLS 1.2 or 1.3", Kind::Usage),
        TlsError::Setup(_) => ("use PEM files, which begin with -----BEGIN; see --ca, --cert and --key", Kind::Usage),
        TlsError::Other(_) => ("see the log of the broker", Kind::NoAnswer),
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
    fn describes_every_code_with_a_remedy_for_permanent_ones() {
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
            "mqtt://broker:1883 refuses this client: the broker has a new address (sorry): b:1"
        );
    }

    #[test]
    fn certificate_errors_are_setting_errors() {
        assert_eq!(loss(&url(), &Loss::Tls(TlsError::Expired)).kind, Kind::Usage);
        assert_eq!(loss(&url(), &Loss::Closed).kind, Kind::NoAnswer);
    }
}
