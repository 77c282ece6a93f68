//! Failures of commands, and their exit codes.

use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize, Serializer};

/// Class of a failure. The class determines the exit code.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// The reader of stdout has closed the pipe. This is not a failure.
    PipeClosed,
    /// Internal error, or a failure of a local file or disk.
    Local,
    /// Invalid command line, inventory or value.
    Usage,
    /// The controller refused the request.
    Refused,
    /// The controller did not answer, or the port is absent or busy.
    NoAnswer,
    /// The answer is malformed or unexpected.
    Malformed,
    /// A request that changes something was sent, and its answer was lost.
    OutcomeUnknown,
    /// armctl rejected the command before anything was sent.
    Rejected,
    /// The condition of `--until` or `--check` was not met.
    ConditionNotMet,
    /// Some robots or items failed, and others succeeded.
    Mixed,
    /// The user pressed Ctrl-C.
    Interrupted,
    /// A filter ended with this exit code (`halt_error` in jq).
    #[serde(skip)]
    Halted(u8),
    /// A dry run has no answer with which the command could continue. This failure ends the command and is never
    /// printed.
    #[serde(skip)]
    DryRun,
}

impl Kind {
    /// Every kind with its exit code and the meaning of the code, in the order of `armctl help exit-codes`.
    pub const TABLE: [(Self, u8, &'static str); 11] = [
        (Self::PipeClosed, 0, "done (also when the reader of stdout closed the pipe)"),
        (Self::Local, 1, "internal error, or a local file or disk"),
        (Self::Usage, 2, "usage or configuration"),
        (Self::Refused, 3, "the controller refused"),
        (Self::NoAnswer, 4, "no answer, or port absent or busy"),
        (Self::Malformed, 5, "malformed or unexpected answer"),
        (Self::OutcomeUnknown, 6, "outcome unknown: armctl sent a change, but the answer was lost"),
        (Self::Rejected, 7, "rejected by armctl: not confirmed, or a read-only robot"),
        (Self::ConditionNotMet, 8, "condition not met (--until, --check, diff)"),
        (Self::Mixed, 9, "some robots or items failed, some did not"),
        (Self::Interrupted, 130, "interrupted"),
    ];

    /// Exit code of the process.
    pub fn exit(self) -> u8 {
        if let Self::Halted(code) = self {
            return code;
        }
        // All other kinds have a row in the table: a test checks that.
        Self::TABLE.iter().find(|(kind, ..)| *kind == self).map_or(1, |row| row.1)
    }
}

/// Ends the process at once, with the exit code of `kind`. Does not wait for other threads.
#[expect(clippy::exit, reason = "the process must end at once")]
pub fn exit_process(kind: Kind) -> ! {
    std::process::exit(kind.exit().into())
}

/// Result of work that fails with a [`Failure`], unless another error is named.
pub type Result<T, E = Failure> = std::result::Result<T, E>;

/// Failure of a command, with a message and an optional hint.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Failure {
    /// Kind of the failure.
    pub kind: Kind,
    /// Error code of the controller, for example `0x2060`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub code: Option<String>,
    /// What happened, as a sentence without a period at its end.
    pub message: String,
    /// What the user can do.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "serialize_hint")]
    #[schemars(with = "String")]
    pub hint: Option<String>,
    /// Whether the report states the same for people. Only the exit code, JSON and CSV show this failure.
    #[serde(skip)]
    pub is_in_report: bool,
}

impl Failure {
    /// Creates a failure of this kind without code and hint.
    pub fn new(kind: Kind, message: impl Into<String>) -> Self {
        Self { kind, code: None, message: message.into(), hint: None, is_in_report: false }
    }

    /// Creates the failure of a comparison that found a difference. The view of the report ends with this message.
    pub fn difference(message: impl Into<String>) -> Self {
        Self { is_in_report: true, ..Self::new(Kind::ConditionNotMet, message) }
    }

    /// Creates a failure for a mistake on the command line or in a settings file.
    pub fn usage(message: impl Into<String>) -> Self {
        let message = message.into();
        Self { hint: decimal_point(&message), ..Self::new(Kind::Usage, message) }
    }

    /// Creates a failure for an internal error, or for an error of the local machine.
    pub fn local(message: impl Into<String>) -> Self {
        Self::new(Kind::Local, message)
    }

    /// Creates a failure for a failed operation on a local file. The exit code is 1, or 0 if a pipe was closed.
    pub fn io(what: impl fmt::Display, error: &std::io::Error) -> Self {
        use std::io::ErrorKind;

        if error.kind() == ErrorKind::BrokenPipe {
            return Self::new(Kind::PipeClosed, "the reader of stdout closed the pipe");
        }
        let failure = Self::local(format!("{what}: {}", plain(error)));
        match error.kind() {
            ErrorKind::PermissionDenied => failure.hint(
                "check the permissions of the folder, or choose another \
                                                         folder",
            ),
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded => {
                failure.hint("free some space, and repeat the command")
            }
            ErrorKind::InvalidData => failure.hint("check that the file has the expected format"),
            ErrorKind::IsADirectory => failure.hint("name a file, not a folder"),
            ErrorKind::FileTooLarge => failure.hint("check that this is the correct file"),
            ErrorKind::NotADirectory => failure.hint("check the path: a part of it is a file, not a folder"),
            ErrorKind::NotFound => {
                failure.hint("check the path: a file to read, or the folder of a file to write, must exist")
            }
            _ => failure,
        }
    }

    /// Adds a hint.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        let number = (self.kind == Kind::Usage).then(|| decimal_point(&self.message)).flatten();
        self.hint = number.or_else(|| Some(hint.into()));
        self
    }

    /// Adds the error code of the controller.
    #[must_use]
    pub fn code(mut self, code: impl Into<String>) -> Self {
        self.code = Some(code.into());
        self
    }
}

/// Whether `yerc`, `yrcx` and `toyo` are commands where the user types: at the prompt, or as links to the binary.
static FAMILIES_ARE_COMMANDS: AtomicBool = AtomicBool::new(false);

/// Keeps the program name out of the commands in hints, because the user types commands without it.
pub fn omit_program_name() {
    FAMILIES_ARE_COMMANDS.store(true, Ordering::Relaxed);
}

/// Hint with commands that can be pasted: the program name precedes the name of a family.
pub fn pasteable(hint: &str) -> String {
    if FAMILIES_ARE_COMMANDS.load(Ordering::Relaxed) { hint.to_owned() } else { with_program_name(hint) }
}

fn serialize_hint<H, S>(hint: &H, serializer: S) -> Result<S::Ok, S::Error>
where
    H: Clone + Into<Option<String>>,
    S: Serializer,
{
    hint.clone().into().map(|hint| pasteable(&hint)).serialize(serializer)
}

fn with_program_name(hint: &str) -> String {
    let is_of_family =
        |code: &str| code.split_once(' ').is_some_and(|(word, _)| matches!(word, "yerc" | "yrcx" | "toyo"));
    // Every second part is between backticks.
    let parts = hint.split('`').enumerate().map(|(index, part)| match part {
        code if index % 2 == 1 && is_of_family(code) => format!("armctl {code}"),
        text => text.to_owned(),
    });
    parts.collect::<Vec<_>>().join("`")
}

/// Returns the hint for a message that refuses a number with a decimal comma, for example `'2,5' is not a number`.
pub fn decimal_point(message: &str) -> Option<String> {
    let quoted = message.split('\'').zip(message.split('\'').skip(1)).skip(1).step_by(2);
    let refused = quoted.filter(|(_, after)| after.starts_with(" is no") && !after.contains("whole"));
    let mut numbers = refused.filter_map(|(text, _)| {
        let (before, after) = text.split_once(',')?;
        let digits = after.trim_end_matches(|c: char| !c.is_ascii_digit());
        let is_number =
            before.parse::<i64>().is_ok() && !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit());
        is_number.then(|| format!("use a decimal point: {before}.{after}"))
    });
    numbers.next()
}

/// Text of an I/O error without the number of the error, for example without `(os error 13)`.
pub fn plain(error: &std::io::Error) -> String {
    armctl_files::plain(error).to_lowercase()
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Failure {}

/// Converts an error with contexts. If the inner error is a [`Failure`] or an I/O error, the contexts precede its
/// message, and its kind and hint stay the same. Any other error becomes a local failure.
impl From<anyhow::Error> for Failure {
    fn from(error: anyhow::Error) -> Self {
        let mut context = String::new();
        for cause in error.chain() {
            if let Some(failure) = cause.downcast_ref::<Self>() {
                return Self { message: context + &failure.message, ..failure.clone() };
            }
            context += &match cause.downcast_ref::<std::io::Error>() {
                Some(io) => return Self::io(context.trim_end_matches(": "), io),
                None => format!("{cause}: "),
            };
        }
        Self::local(context.trim_end_matches(": "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn program_name_precedes_the_family_in_a_hint() {
        for (hint, printed) in [
            ("use `toyo ports` to list the ports", "use `armctl toyo ports` to list the ports"),
            ("`yerc status`, `yrcx io get SI(01)`", "`armctl yerc status`, `armctl yrcx io get SI(01)`"),
            ("see `armctl help yerc`, or `armctl yerc status`", "see `armctl help yerc`, or `armctl yerc status`"),
            ("yerc status and `yerc` are not commands", "yerc status and `yerc` are not commands"),
            ("set `in=` in the URL of yrcx", "set `in=` in the URL of yrcx"),
        ] {
            assert_eq!(with_program_name(hint), printed);
        }
    }

    #[test]
    fn exit_codes_match_the_contract() {
        let codes: Vec<u8> = Kind::TABLE.iter().map(|(kind, ..)| kind.exit()).collect();
        assert_eq!(codes, [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 130]);
    }

    #[test]
    fn hints_at_a_decimal_comma() {
        for (message, hint) in [
            ("x: '2,5' is not a number, 1 to 9 mm", Some("use a decimal point: 2.5")),
            ("'-12,50mm/s' is not a valid speed", Some("use a decimal point: -12.50mm/s")),
            ("'2,5' is not a whole number", None),
            ("'1,2,3' is not a number", None),
            ("four numbers are wanted, not '1,5'", None),
            ("robot 'a,b' is not there", None),
        ] {
            assert_eq!(Failure::usage(message).hint.as_deref(), hint, "{message}");
            let hinted = Failure::usage(message).hint("look");
            assert_eq!(hinted.hint.as_deref(), hint.or(Some("look")), "{message}");
        }
    }

    #[test]
    fn context_precedes_the_message_and_keeps_kind_and_hint() {
        let refused = Failure::new(Kind::Refused, "no").code("0x2060").hint("ask again");
        let told = Failure::from(anyhow::Error::new(refused.clone()).context("job").context("cell3"));
        assert_eq!(told, Failure { message: "cell3: job: no".into(), ..refused });

        let absent = || std::io::Error::from(std::io::ErrorKind::NotFound);
        let told = Failure::from(anyhow::Error::new(absent()).context("robots.toml"));
        assert_eq!(told, Failure::io("robots.toml", &absent()));

        let told = Failure::from(anyhow::anyhow!("a page of paper").context("printer"));
        assert_eq!(told, Failure::local("printer: a page of paper"));
    }
}
