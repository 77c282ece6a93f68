//! Log of a service on stderr. If stderr is connected to the systemd journal, each line starts with its priority
//! (`sd-daemon(3)`) and ends with its fields. `journalctl -p warning` and `grep robot=cell3` can then find the line. If
//! the journal can be accessed directly, entries are written to it instead.

use std::fmt::Write as _;

use super::{Screen, escape};

/// Level of a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// A problem of the service itself.
    Error,
    /// A problem of something that the service watches, for example a robot.
    Warning,
    /// An event that occurs from time to time.
    Notice,
    /// Details for troubleshooting. They are printed with `-v`.
    Detail,
}

impl Level {
    /// Returns the priority of the level (syslog(3)).
    pub fn priority(self) -> u8 {
        match self {
            Self::Error => 3,
            Self::Warning => 4,
            Self::Notice => 5,
            Self::Detail => 6,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Error => "error: ",
            Self::Warning => "warning: ",
            Self::Notice | Self::Detail => "",
        }
    }
}

/// Maximum length of a field value in characters.
const MAX_VALUE_LENGTH: usize = 200;

/// Escapes a field value and limits its length.
pub fn value(text: &str) -> String {
    let text: String = text.chars().take(MAX_VALUE_LENGTH).collect();
    escape::line(&text).into_owned()
}

impl Screen {
    /// Whether messages of this level are printed.
    pub fn is_enabled(&self, level: Level) -> bool {
        match level {
            Level::Error | Level::Warning => true,
            Level::Notice => !self.quiet,
            Level::Detail => self.verbosity > 0,
        }
    }

    /// Logs a message. The fields are added if the log goes to the journal.
    pub fn log(&self, level: Level, text: &str, fields: &[(&str, &str)]) {
        if !self.is_enabled(level) {
            return;
        }
        let text = escape::line(text);
        if is_journal() {
            Self::stderr(&format!("<{}>{text}{}\n", level.priority(), list(fields)));
        } else {
            Self::prose(&format!("{}{text}\n", level.name()));
        }
    }
}

/// Formats fields as ` name=value`. Values are quoted if necessary.
fn list(fields: &[(&str, &str)]) -> String {
    let mut all = String::new();
    for (name, value) in fields {
        let value = self::value(value);
        let is_plain = !value.is_empty() && !value.contains([' ', '"', '=', '\\']);
        let _never_fails = if is_plain {
            write!(all, " {name}={value}")
        } else {
            write!(all, " {name}=\"{}\"", value.replace('\\', "\\\\").replace('"', "\\\""))
        };
    }
    all
}

/// Whether stderr is the journal. The environment variable is not sufficient, because a terminal may have inherited it.
#[cfg(unix)]
fn is_journal() -> bool {
    let Some(named) = std::env::var_os("JOURNAL_STREAM") else { return false };
    let own = rustix::fs::fstat(std::io::stderr()).map(|stat| format!("{}:{}", stat.st_dev, stat.st_ino));
    own.is_ok_and(|own| named == *own)
}

#[cfg(not(unix))]
fn is_journal() -> bool {
    false
}

/// Whether stderr is the socket of the journal, and not a file to which stderr was redirected.
#[cfg(unix)]
pub fn is_journal_socket() -> bool {
    let is_socket = rustix::fs::fstat(std::io::stderr())
        .is_ok_and(|stat| rustix::fs::FileType::from_raw_mode(stat.st_mode) == rustix::fs::FileType::Socket);
    is_socket && is_journal()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotes_and_limits_fields() {
        let fields = [("robot", "cell3"), ("why", "no answer"), ("text", "a\"b\\c\n"), ("none", "")];
        assert_eq!(list(&fields), " robot=cell3 why=\"no answer\" text=\"a\\\"b\\\\c\\\\n\" none=\"\"");
        assert_eq!(list(&[("long", &"x".repeat(999))]).len(), MAX_VALUE_LENGTH + " long=".len());
        assert_eq!(list(&[("evil", "\u{1b}[2J")]), " evil=\"\\\\x1b[2J\"");
    }
}
