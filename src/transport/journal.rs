//! Writer for the systemd journal in its native protocol: one datagram per entry, with fields for `journalctl`
//! (<https://systemd.io/JOURNAL_NATIVE_PROTOCOL/>).

use std::io;
use std::os::unix::net::UnixDatagram;
use std::path::Path;

/// Socket path of the journal.
pub const PLACE: &str = "/run/systemd/journal/socket";

/// Connection to the journal.
#[derive(Debug)]
pub struct Journal {
    socket: UnixDatagram,
}

impl Journal {
    /// Connects to the journal socket.
    pub fn at(place: &Path) -> io::Result<Self> {
        let socket = UnixDatagram::unbound()?;
        socket.connect(place)?;
        Ok(Self { socket })
    }

    /// Writes an entry. Field names consist of letters, digits and `_`, and start with a letter.
    pub fn write(&self, fields: &[(&str, &str)]) -> io::Result<()> {
        let mut entry = Vec::new();
        for (name, value) in fields {
            entry.extend(name.bytes().map(|letter| letter.to_ascii_uppercase()));
            // If a value has several lines, the protocol requires the length of the value before it.
            if value.contains('\n') {
                entry.push(b'\n');
                entry.extend(u64::try_from(value.len()).unwrap_or(u64::MAX).to_le_bytes());
            } else {
                entry.push(b'=');
            }
            entry.extend(value.bytes());
            entry.push(b'\n');
        }
        self.socket.send(&entry).map(|_| ())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_is_a_datagram_of_fields() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("socket");
        assert!(Journal::at(&place).is_err());
        let listener = UnixDatagram::bind(&place).unwrap();
        let journal = Journal::at(&place).unwrap();
        journal.write(&[("message", "no answer"), ("PRIORITY", "4"), ("robot", "a\nb=c")]).unwrap();
        let mut entry = [0; 100];
        let length = listener.recv(&mut entry).unwrap();
        // The protocol page shows these two forms of a field.
        let expected = b"MESSAGE=no answer\nPRIORITY=4\nROBOT\n\x05\0\0\0\0\0\0\0a\nb=c\n";
        assert_eq!(&entry[..length], expected);
    }
}
