//! What a service says of itself as it runs: lines on stderr. Where that is the journal of systemd, each begins with its
//! priority (`sd-daemon(3)`) and ends with its fields, so that `journalctl -p warning` and `grep robot=cell3` find it; whoever
//! reaches the journal itself can write entries instead.

use std::fmt::Write as _;

use super::{Screen, escape};

/// How much a line matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// Something is wrong with this service.
    Error,
    /// Something is wrong with what it looks after.
    Warning,
    /// Something that happens now and then.
    Notice,
    /// Something that only who looks for a reason wants to read: from `-v` on.
    Detail,
}

impl Level {
    /// The number of syslog(3).
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

/// Longest value of a field, in characters.
const LONGEST: usize = 200;

/// The value of a field, as it can be shown and is not too long.
pub fn value(text: &str) -> String {
    let text: String = text.chars().take(LONGEST).collect();
    escape::line(&text).into_owned()
}

impl Screen {
    /// Whether somebody wants to read what matters so much.
    pub fn wants(&self, level: Level) -> bool {
        match level {
            Level::Error | Level::Warning => true,
            Level::Notice => !self.quiet,
            Level::Detail => self.verbosity > 0,
        }
    }

    /// Says what happens in a service, with fields for the journal.
    pub fn log(&self, level: Level, text: &str, fields: &[(&str, &str)]) {
        if !self.wants(level) {
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

/// Fields as ` name=value`, with quotes where a value would not end by itself.
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

/// Whether stderr is the journal: the variable may be one that a terminal has passed on.
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

/// Whether stderr is the journal's own socket, and not a file that stands for it.
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
    fn fields_are_plain_or_quoted_and_bounded() {
        let fields = [("robot", "cell3"), ("why", "no answer"), ("text", "a\"b\\c\n"), ("none", "")];
        assert_eq!(list(&fields), " robot=cell3 why=\"no answer\" text=\"a\\\"b\\\\c\\\\n\" none=\"\"");
        assert_eq!(list(&[("long", &"x".repeat(999))]).len(), LONGEST + " long=".len());
        assert_eq!(list(&[("evil", "\u{1b}[2J")]), " evil=\"\\\\x1b[2J\"");
    }
}
