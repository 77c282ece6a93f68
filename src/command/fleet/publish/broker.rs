//! Addresses and credentials of the brokers, from the command line, files and the environment.

use std::env;
use std::net::IpAddr;
use std::str::FromStr;

use super::error_text;
use super::uplink::{Endpoint, Hello, Identity, Tls, Trust, Version, Will};
use armctl_frame::prelude::*;

/// Keepalive interval of the connection.
const KEEP_ALIVE: Duration = Duration::from_secs(30);
/// Size limit of password and certificate files, in bytes.
const MAX_FILE_SIZE: u64 = 1 << 20;
/// Environment variable with the password.
const PASSWORD: &str = "ARMCTL_MQTT_PASSWORD";

/// URL of a broker.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Url {
    /// Host name or address.
    pub host: String,
    /// TCP port.
    pub port: u16,
    /// Whether the connection uses TLS.
    pub is_secure: bool,
}

impl Url {
    /// Canonical name, such as `mqtt-192.168.1.5-1883`: the same for all spellings of a broker.
    pub fn key(&self) -> String {
        let scheme = if self.is_secure { "mqtts" } else { "mqtt" };
        let host = self.host.parse().map_or_else(|_| self.host.to_lowercase(), |ip: IpAddr| ip.to_string());
        format!("{scheme}-{host}-{}", self.port)
    }
}

impl fmt::Display for Url {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let scheme = if self.is_secure { "mqtts" } else { "mqtt" };
        let (open, close) = if self.host.contains(':') { ("[", "]") } else { ("", "") };
        write!(f, "{scheme}://{open}{}{close}:{}", self.host, self.port)
    }
}

impl FromStr for Url {
    type Err = String;

    /// The error does not contain the text, because it can include a password.
    fn from_str(text: &str) -> Result<Self, String> {
        const FORM: &str = "write mqtt://HOST[:1883], or mqtts://HOST[:8883] for TLS";
        let Some((scheme, rest)) = text.split_once("://") else { return Err(FORM.to_owned()) };
        let (is_secure, usual) = match scheme.to_ascii_lowercase().as_str() {
            "mqtt" | "tcp" => (false, 1883),
            "mqtts" | "ssl" => (true, 8883),
            _ => return Err(FORM.to_owned()),
        };
        let rest = rest.strip_suffix('/').unwrap_or(rest);
        if rest.contains('@') {
            return Err(format!(
                "remove user and password from the URL, because other users can read the URL; use --user NAME, and \
                 --password-file FILE or {PASSWORD}"
            ));
        }
        let (host, port) = match rest.strip_prefix('[').and_then(|rest| rest.split_once(']')) {
            Some((host, port)) => (host, port.strip_prefix(':').or(port.is_empty().then_some("")).ok_or(FORM)?),
            None => rest.split_once(':').unwrap_or((rest, "")),
        };
        let is_address = host.parse::<IpAddr>().is_ok();
        let is_name = host.chars().all(|c| c.is_alphanumeric() || matches!(c, '.' | '-' | '_'));
        if host.is_empty() || host.len() > 253 || !(is_address || is_name) {
            return Err(FORM.to_owned());
        }
        let port = match port {
            "" => usual,
            port => port.parse().ok().filter(|port| *port != 0).ok_or("the port must be a number from 1 to 65535")?,
        };
        Ok(Self { host: host.to_owned(), port, is_secure })
    }
}

/// Version of MQTT.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Protocol {
    /// MQTT 3.1.1
    #[value(name = "3.1.1")]
    V3,
    /// MQTT 5
    #[value(name = "5")]
    V5,
}

impl From<Protocol> for Version {
    fn from(protocol: Protocol) -> Self {
        match protocol {
            Protocol::V3 => Self::V3,
            Protocol::V5 => Self::V5,
        }
    }
}

/// Login at the broker.
#[derive(Debug, Args)]
#[group(skip)]
pub struct Login {
    /// User name at the broker
    #[arg(long, value_name = "NAME", help_heading = "Broker")]
    user: Option<String>,
    /// File with the password (or ARMCTL_MQTT_PASSWORD)
    #[arg(long, value_name = "FILE", requires = "user", help_heading = "Broker")]
    password_file: Option<PathBuf>,
    /// Certificate of the authority that signed the broker's certificate (PEM) [default: the certificate authorities of
    /// this computer]
    #[arg(long, value_name = "FILE", help_heading = "Broker")]
    ca: Option<PathBuf>,
    /// Certificate of this client (PEM)
    #[arg(long, value_name = "FILE", requires = "key", help_heading = "Broker")]
    cert: Option<PathBuf>,
    /// Private key of this client (PEM)
    #[arg(long, value_name = "FILE", requires = "cert", help_heading = "Broker")]
    key: Option<PathBuf>,
    /// Send the password without TLS, and print no warning
    #[arg(long = "insecure", requires = "user", help_heading = "Broker")]
    is_insecure: bool,
    /// Version of MQTT
    #[arg(long, value_name = "VERSION", default_value = "5", help_heading = "Broker")]
    protocol: Protocol,
}

/// Connection settings of a broker, without the last will.
#[derive(Debug)]
pub struct Broker {
    /// URL for messages.
    pub url: Url,
    /// Address.
    pub endpoint: Endpoint,
    version: Version,
    user: Option<String>,
    password: Secret,
}

/// A value that is never printed.
#[derive(Clone)]
struct Secret(Option<Vec<u8>>);

impl fmt::Debug for Secret {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "a password" } else { "no password" })
    }
}

impl Broker {
    /// Settings of these brokers, with warnings about the storage and transmission of secrets. Each file is read once,
    /// because it can be a pipe.
    pub fn for_urls(urls: &[Url], login: &Login) -> Result<(Vec<Self>, Vec<String>)> {
        let has_tls_words = login.ca.is_some() || login.cert.is_some();
        if has_tls_words && urls.iter().all(|url| !url.is_secure) {
            let host = urls.first().map_or("HOST", |url| &url.host);
            return Err(
                Failure::usage("--ca, --cert and --key need TLS").hint(format!("write mqtts://{host}:8883 for TLS"))
            );
        }
        let trust = match &login.ca {
            Some(path) => Trust::Roots(bytes(path)?),
            None => Trust::System,
        };
        let identity = match (&login.cert, &login.key) {
            (Some(certificates), Some(key)) => Some(Identity { certificates: bytes(certificates)?, key: bytes(key)? }),
            _ => None,
        };
        let password = Secret(password(login)?);
        let mut warnings = Vec::new();
        for (file, secret) in [(&login.password_file, "password"), (&login.key, "private key")] {
            if let Some(path) = file
                && others_can_read(path)?
            {
                let path = path.display();
                warnings.push(format!(
                    "{path}: other users of this computer can read this {secret}; run `chmod 600 {path}`"
                ));
            }
        }
        let mut brokers = Vec::with_capacity(urls.len());
        for url in urls {
            let tls = if url.is_secure {
                let tls = Tls::new(&url.host, &trust, identity.as_ref());
                Some(Arc::new(tls.map_err(|error| error_text::certificate_hint(url, &error))?))
            } else {
                None
            };
            if password.0.is_some() && !url.is_secure && !login.is_insecure && !is_this_machine(&url.host) {
                warnings.push(format!(
                    "{url}: armctl sends the password without encryption; use mqtts://, or --insecure on a trusted \
                     network"
                ));
            }
            brokers.push(Self {
                url: url.clone(),
                endpoint: Endpoint { host: url.host.clone(), port: url.port, tls },
                version: login.protocol.into(),
                user: login.user.clone(),
                password: password.clone(),
            });
        }
        Ok((brokers, warnings))
    }

    /// CONNECT contents with this last will.
    pub fn connect_packet(&self, client_id: String, will: Will) -> Hello {
        Hello {
            version: self.version,
            client_id,
            user: self.user.clone(),
            password: self.password.0.clone(),
            keep_alive: KEEP_ALIVE,
            will: Some(will),
        }
    }
}

/// Whether the group of the file, or other users, can read the file.
#[cfg(unix)]
fn others_can_read(path: &Path) -> Result<bool> {
    use std::os::unix::fs::PermissionsExt as _;

    // Credentials of the service manager are in a private folder. Their access list appears as group permissions.
    if env::var_os("CREDENTIALS_DIRECTORY").is_some_and(|folder| !folder.is_empty() && path.starts_with(folder)) {
        return Ok(false);
    }
    let metadata = path.metadata().with_context(|| path.display().to_string())?;
    Ok(metadata.is_file() && metadata.permissions().mode() & 0o044 != 0)
}

/// File permissions are not checked on this system.
#[cfg(not(unix))]
#[expect(clippy::unnecessary_wraps, reason = "the Unix version reads the file's permissions")]
fn others_can_read(_: &Path) -> Result<bool> {
    Ok(false)
}

/// Whether the host is this computer.
fn is_this_machine(host: &str) -> bool {
    match host.parse::<IpAddr>() {
        Ok(address) => address.to_canonical().is_loopback(),
        Err(_) => host.eq_ignore_ascii_case("localhost"),
    }
}

fn bytes(path: &Path) -> Result<Vec<u8>> {
    Ok(files::read(path, MAX_FILE_SIZE).with_context(|| path.display().to_string())?)
}

/// Password from the file without its line end, or from the environment.
fn password(login: &Login) -> Result<Option<Vec<u8>>> {
    if let Some(path) = &login.password_file {
        let mut password = bytes(path)?;
        while password.last().is_some_and(|last| matches!(last, b'\n' | b'\r')) {
            password.pop();
        }
        if password.is_empty() {
            return Err(Failure::usage(format!("{}: the file contains no password", path.display()))
                .hint("write only the password into the file"));
        }
        return Ok(Some(password));
    }
    match env::var_os(PASSWORD).filter(|password| !password.is_empty()) {
        None => Ok(None),
        Some(_) if login.user.is_none() => Err(Failure::usage(format!("{PASSWORD} is set, but no user"))
            .hint(format!("add --user NAME, or unset {PASSWORD}"))),
        Some(password) => Ok(Some(password.into_encoded_bytes())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parses_and_formats_urls() {
        for (text, shown) in [
            ("mqtt://broker", "mqtt://broker:1883"),
            ("mqtts://broker.plant.example", "mqtts://broker.plant.example:8883"),
            ("MQTT://10.0.0.7:2000/", "mqtt://10.0.0.7:2000"),
            ("mqtt://[::1]:1884", "mqtt://[::1]:1884"),
            ("mqtts://[fe80::1]", "mqtts://[fe80::1]:8883"),
        ] {
            assert_eq!(text.parse::<Url>().unwrap().to_string(), shown);
        }
    }

    #[test]
    fn rejects_invalid_urls_without_printing_them() {
        for text in [
            "broker",
            "http://broker",
            "mqtt://",
            "mqtt://:1883",
            "mqtt://a b",
            "mqtt://a:0",
            "mqtt://a:70000",
            "mqtt://[::1",
            "mqtt://[::1]x",
            "mqtt://a/topic",
            "mqtt://a?x",
        ] {
            assert!(text.parse::<Url>().is_err(), "{text}");
        }
        let message = "mqtts://me:hunter2@broker".parse::<Url>().unwrap_err();
        assert!(message.contains("--password-file") && !message.contains("hunter2"), "{message}");
        let told = "mqtt://broker:hunter2".parse::<Url>().unwrap_err();
        assert!(!told.contains("hunter2"), "{told}");
    }

    #[test]
    fn recognizes_only_loopback_as_this_machine() {
        for host in ["127.0.0.1", "127.3.2.1", "::1", "::ffff:127.0.0.1", "localhost", "LocalHost"] {
            assert!(is_this_machine(host), "{host}");
        }
        for host in ["192.168.1.5", "0.0.0.0", "::", "broker", "localhost.example", "fe80::1"] {
            assert!(!is_this_machine(host), "{host}");
        }
    }

    #[test]
    fn hides_the_password() {
        let secret = format!("{:?}", Secret(Some(b"hunter2".to_vec())));
        assert_eq!(secret, "a password");
    }
}
