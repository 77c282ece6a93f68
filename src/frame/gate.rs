//! Safety gate: authorizes a command before anything is sent to a robot.
//!
//! A command declares its maximum risk ([`Risk`]). The loop that runs all commands checks the risk here before anything
//! is sent. The command then gets a [`Grant`], and its link checks each frame against this grant. A command can
//! therefore not do more than was authorized. A command that overwrites data raises its grant later, when it has read
//! this data and the user has confirmed the change.

use crate::failure::{Failure, Kind};
use crate::output::Screen;
use crate::settings::{Origin, Robot};
pub use armctl_client::Grant;
use armctl_client::NotAuthorized;
use armctl_controller::Risk;

/// What Ctrl-C does during a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum)]
pub enum OnInterrupt {
    /// Stop the robot, then disconnect.
    #[default]
    Stop,
    /// Disconnect only; the motion continues.
    Leave,
}

/// Type of confirmation that a command requires.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Confirmation {
    /// The user must answer a question before anything is sent.
    #[default]
    Question,
    /// The user must type this word before anything is sent, because the effect cannot be undone.
    Word(&'static str),
    /// The command itself asks the question, when it has read the data that it replaces.
    WhenKnown,
}

/// What a command declares to the gate.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Intent {
    /// Maximum risk of the command.
    pub risk: Risk,
    /// Text that completes "This will …", for example `start job COUNT`.
    pub text: String,
    /// Kind of confirmation that the command needs.
    pub confirmation: Confirmation,
    /// Whether the command stops the robot. A stop is always allowed.
    pub is_stop: bool,
}

impl Intent {
    /// Returns the risk that is granted before the command itself asks a question.
    pub fn initial_risk(&self) -> Risk {
        match self.confirmation {
            Confirmation::WhenKnown => self.risk.min(Risk::Write),
            Confirmation::Question | Confirmation::Word(_) => self.risk,
        }
    }
}

impl From<NotAuthorized> for Failure {
    fn from(NotAuthorized { what, risk }: NotAuthorized) -> Self {
        Self::local(format!("internal error: {what} ({}) is not authorized; nothing was sent", risk.name()))
            .hint("report this error: it is a bug in armctl")
    }
}

/// Permissions on the command line.
#[derive(Debug, Clone, Copy, Default)]
pub struct Gate {
    /// `--yes`.
    pub yes: bool,
    /// `--dry-run`.
    pub dry_run: bool,
    /// `--on-interrupt`.
    pub on_interrupt: OnInterrupt,
}

impl Gate {
    /// Whether the user must answer a question.
    ///
    /// # Errors
    /// A question is necessary but not possible, or the robot is read-only.
    pub fn must_ask(&self, screen: &Screen, robot: &Robot, intent: &Intent) -> Result<bool, Failure> {
        self.check_read_only(robot, intent)?;
        if !self.needs_yes(robot, intent.risk) {
            return Ok(false);
        }
        // The command may find that it replaces nothing, and then no question is necessary. A motion always requires a
        // question.
        let may_be_nothing = intent.confirmation == Confirmation::WhenKnown && intent.risk < Risk::Motion;
        if !screen.can_ask() && !may_be_nothing && robot.rehearsal.is_none() {
            return Err(not_confirmed(robot, intent.risk, &intent.text));
        }
        Ok(true)
    }

    /// Refuses a change of a read-only robot. A stop is always allowed.
    fn check_read_only(&self, robot: &Robot, intent: &Intent) -> Result<(), Failure> {
        if intent.risk == Risk::Read || self.dry_run || intent.is_stop || !robot.read_only.value {
            return Ok(());
        }
        let hint = |name: &str| {
            format!("allow changes with `armctl robots set {name} read_only=off`: the inventory protects this robot")
        };
        Err(Failure::new(Kind::Rejected, format!("{} is read-only", robot.label())).hint(
            match &robot.read_only_entry {
                Some(entry) => format!("'{entry}' in robots.toml has the same address; {}", hint(entry)),
                None if robot.read_only.origin == Origin::Defaults => {
                    "use `armctl robots edit` to allow changes: [defaults] in robots.toml sets read_only".to_owned()
                }
                None => hint(&robot.name),
            },
        ))
    }

    /// Whether a confirmation is required, and `--yes` is missing. In a rehearsal, a simulator stands for a robot.
    pub fn needs_yes(&self, robot: &Robot, risk: Risk) -> bool {
        let is_real = !robot.target.value.is_simulated() || robot.rehearsal.is_some();
        risk >= Risk::Destroy && !self.yes && !self.dry_run && is_real
    }

    /// Refuses a motion of several robots, or overwriting data on several robots, unless the command line names each
    /// robot.
    pub fn check_named_robots(robots: &[(&Robot, Intent)], is_named: impl Fn(&Robot) -> bool) -> Result<(), Failure> {
        let unnamed =
            robots.iter().filter(|(robot, intent)| intent.risk >= Risk::Destroy && !intent.is_stop && !is_named(robot));
        let unnamed: Vec<&(&Robot, Intent)> = unnamed.collect();
        let Some((_, intent)) = unnamed.first().filter(|_| robots.len() > 1) else { return Ok(()) };
        let names: Vec<&str> = unnamed.iter().map(|(robot, _)| robot.name.as_str()).collect();
        let count_text = format!("{} of {} robots", unnamed.len(), robots.len());
        let message = format!("not confirmed: on {count_text} ({}) this would {}", names.join(", "), intent.text);
        Err(Failure::new(Kind::Rejected, message).hint(
            "name each robot with -r. Patterns, --tag and --all are not accepted for a command that moves, deletes or \
             overwrites",
        ))
    }
}

/// What a command deletes or overwrites, for the confirmation.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Change {
    /// Text that completes "This will …", for example `overwrite 2 points`.
    text: String,
    items: Vec<String>,
    notes: Vec<String>,
    is_empty: bool,
}

/// Maximum number of items that a question lists. Further items are only counted.
const MAX_ITEMS: usize = 12;

impl Change {
    /// Creates a change. `text` completes "This will …", for example `delete 2 files`.
    pub fn new(text: impl Into<String>) -> Self {
        Self { text: text.into(), ..Self::default() }
    }

    /// Creates a change that overwrites no data of the user.
    pub fn none() -> Self {
        Self { is_empty: true, ..Self::default() }
    }

    /// Adds a value that is replaced, with its old and new value.
    #[must_use]
    pub fn replaces(mut self, what: &str, old: &str, new: &str) -> Self {
        self.items.push(format!("{what}: {old} -> {new}"));
        self
    }

    /// Adds an object that is completely deleted or overwritten.
    #[must_use]
    pub fn item(mut self, what: impl Into<String>) -> Self {
        self.items.push(what.into());
        self
    }

    /// Adds a consequence, for example `a power cycle is needed`.
    #[must_use]
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// Whether the change is empty, so that no question is necessary.
    pub fn is_empty(&self) -> bool {
        self.is_empty
    }

    /// Returns the lines that are printed before the question.
    pub fn lines(&self) -> Vec<String> {
        let mut lines = vec![format!("This will {}{}", self.text, if self.items.is_empty() { "." } else { ":" })];
        lines.extend(self.items.iter().take(MAX_ITEMS).map(|item| format!("  {item}")));
        if self.items.len() > MAX_ITEMS {
            lines.push(format!("  and {} more", self.items.len() - MAX_ITEMS));
        }
        lines.extend(self.notes.iter().cloned());
        lines
    }

    /// Describes the change in one line.
    pub fn format_line(&self) -> String {
        match &self.items[..] {
            [] => self.text.clone(),
            [item] => format!("{} ({item})", self.text),
            [item, rest @ ..] => format!("{} ({item}, and {} more)", self.text, rest.len()),
        }
    }
}

/// Returns the failure for data that changed while the question was open.
pub fn data_changed(message: impl Into<String>) -> Failure {
    Failure::new(Kind::Rejected, message)
        .hint("check the state, then repeat the command: another client changed the data")
}

/// Returns the failure for a question that is necessary but not possible.
pub fn not_confirmed(robot: &Robot, risk: Risk, text: &str) -> Failure {
    let when = if risk == Risk::Motion { " when no person is in the cell" } else { "" };
    Failure::new(Kind::Rejected, format!("not confirmed: on {} this would {text}", robot.label()))
        .hint(format!("pass --yes to confirm{when}, or --dry-run to see what would be sent"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_the_items_of_a_long_change() {
        let change = (0..20).fold(Change::new("delete 20 files"), |change, n| change.item(format!("{n}.JBI")));
        assert_eq!(change.lines().len(), 1 + MAX_ITEMS + 1);
        assert_eq!(change.lines().last().unwrap(), "  and 8 more");
        assert_eq!(change.format_line(), "delete 20 files (0.JBI, and 19 more)");
    }
}
