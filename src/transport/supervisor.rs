//! Notifications to the service manager, as in `sd_notify(3)`: datagrams to the socket whose path is in the variable
//! `NOTIFY_SOCKET`. Without this variable, nothing is sent.

use std::io;
use std::time::Duration;

/// Service manager that started this process.
#[derive(Debug, Default)]
pub struct Supervisor {
    #[cfg(unix)]
    socket: Option<unix::Socket>,
    watchdog: Option<Duration>,
}

impl Supervisor {
    /// Finds the service manager in the environment.
    #[cfg(unix)]
    pub fn find() -> io::Result<Self> {
        let Some(name) = std::env::var_os("NOTIFY_SOCKET").filter(|name| !name.is_empty()) else {
            return Ok(Self::default());
        };
        let number = |name: &str| std::env::var(name).ok().and_then(|value| value.parse::<u64>().ok());
        // A child process can inherit the variables of its parent, so the process id must match.
        let is_own = number("WATCHDOG_PID").is_none_or(|process| process == u64::from(std::process::id()));
        let watchdog = number("WATCHDOG_USEC").filter(|micros| is_own && *micros > 0).map(Duration::from_micros);
        Ok(Self { socket: Some(unix::Socket::named(&name)?), watchdog })
    }

    /// Returns a supervisor that sends nothing: this system has no supported service manager.
    #[cfg(not(unix))]
    pub fn find() -> io::Result<Self> {
        Ok(Self::default())
    }

    /// Interval of the keepalive messages: half of the watchdog time of the service manager.
    pub fn keepalive_interval(&self) -> Option<Duration> {
        self.watchdog.map(|within| within / 2)
    }

    /// Reports that the service is ready, so that dependent services can start.
    pub fn ready(&self, status: &str) -> io::Result<()> {
        self.send_state(&format!("READY=1\nSTATUS={status}"))
    }

    /// Sends a keepalive with a status text.
    pub fn send_keepalive(&self, status: &str) -> io::Result<()> {
        self.send_state(&format!("WATCHDOG=1\nSTATUS={status}"))
    }

    /// Reports that the service is stopping.
    pub fn stopping(&self) -> io::Result<()> {
        self.send_state("STOPPING=1")
    }

    #[cfg(unix)]
    fn send_state(&self, text: &str) -> io::Result<()> {
        self.socket.as_ref().map_or(Ok(()), |socket| socket.send(text))
    }

    #[cfg(not(unix))]
    fn send_state(&self, _text: &str) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(unix)]
mod unix {
    use std::ffi::OsStr;
    use std::io;
    use std::os::unix::ffi::OsStrExt as _;
    use std::os::unix::net::{SocketAddr, UnixDatagram};

    #[derive(Debug)]
    pub struct Socket {
        own: UnixDatagram,
        to: SocketAddr,
    }

    impl Socket {
        pub fn named(name: &OsStr) -> io::Result<Self> {
            let own = UnixDatagram::unbound()?;
            // A service manager that does not read its messages must not block this process.
            own.set_nonblocking(true)?;
            let to = match name.as_bytes() {
                [b'@', name @ ..] => in_abstract(name)?,
                _ => SocketAddr::from_pathname(name)?,
            };
            Ok(Self { own, to })
        }

        pub fn send(&self, text: &str) -> io::Result<()> {
            match self.own.send_to_addr(text.as_bytes(), &self.to) {
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => Ok(()),
                sent => sent.map(|_| ()),
            }
        }
    }

    #[cfg(target_os = "linux")]
    fn in_abstract(name: &[u8]) -> io::Result<SocketAddr> {
        <SocketAddr as std::os::linux::net::SocketAddrExt>::from_abstract_name(name)
    }

    #[cfg(not(target_os = "linux"))]
    fn in_abstract(_name: &[u8]) -> io::Result<SocketAddr> {
        Err(io::Error::from(io::ErrorKind::Unsupported))
    }
}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::net::UnixDatagram;

    use super::*;

    #[test]
    fn sends_a_state_in_one_datagram() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("notify");
        let manager = UnixDatagram::bind(&path).unwrap();
        let socket = Some(unix::Socket::named(path.as_os_str()).unwrap());
        let supervisor = Supervisor { socket, watchdog: Some(Duration::from_secs(10)) };
        assert_eq!(supervisor.keepalive_interval(), Some(Duration::from_secs(5)));
        let heard = || {
            let mut text = [0; 100];
            let length = manager.recv(&mut text).unwrap();
            String::from_utf8_lossy(&text[..length]).into_owned()
        };
        supervisor.ready("3 robots").unwrap();
        assert_eq!(heard(), "READY=1\nSTATUS=3 robots");
        supervisor.send_keepalive("2 answer").unwrap();
        assert_eq!(heard(), "WATCHDOG=1\nSTATUS=2 answer");
        supervisor.stopping().unwrap();
        assert_eq!(heard(), "STOPPING=1");
        assert!(Supervisor::default().ready("no supervisor").is_ok());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn supports_abstract_socket_names() {
        use std::os::linux::net::SocketAddrExt as _;
        use std::os::unix::net::SocketAddr;

        let name = format!("armctl-test-{}", std::process::id());
        let manager = UnixDatagram::bind_addr(&SocketAddr::from_abstract_name(&name).unwrap()).unwrap();
        unix::Socket::named(format!("@{name}").as_ref()).unwrap().send("READY=1").unwrap();
        let mut text = [0; 20];
        let length = manager.recv(&mut text).unwrap();
        assert_eq!(&text[..length], b"READY=1");
    }

    #[test]
    fn missing_manager_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let socket = Some(unix::Socket::named(folder.path().join("nobody").as_os_str()).unwrap());
        assert!(Supervisor { socket, watchdog: None }.stopping().is_err());
    }
}
