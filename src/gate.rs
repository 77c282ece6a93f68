//! What stands between a typed command and a machine that can hurt someone.

use crate::controller::Risk;
use crate::failure::{Failure, Kind};
use crate::output::Screen;
use crate::settings::Robot;

/// What Ctrl-C does to a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum)]
pub enum OnInterrupt {
    /// Stop the robot, then disconnect.
    #[default]
    Stop,
    /// Disconnect only; the motion goes on.
    Leave,
}

/// What a command wants beyond the usual, because what it does cannot be taken back.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Demand {
    /// A question before a motion, as everywhere.
    #[default]
    Usual,
    /// `--yes` on the command line, and nothing less; says why, as in "a change of E06 needs a power cycle".
    Flag(String),
    /// This word, typed, on a real controller; `--yes` stands for it.
    Word(&'static str),
}

/// What the operator allowed beforehand.
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
    /// Lets a command of `risk` through to `robot`, asking where the contract wants it. `intent` says what will happen,
    /// as in "start the selected job".
    pub fn pass(
        &self,
        screen: &Screen,
        robot: &Robot,
        risk: Risk,
        demand: &Demand,
        intent: &str,
    ) -> Result<(), Failure> {
        if !self.must_ask(screen, robot, risk, demand, intent)? {
            return Ok(());
        }
        screen.ask_note(&format!("{}: a {} controller, not the built-in simulator", robot.label(), robot.family));
        let agreed = match demand {
            Demand::Word(word) => screen.confirm_word(&format!("This will {intent}."), word)?,
            Demand::Usual | Demand::Flag(_) => screen.confirm(&format!("This will {intent}. Go on?"))?,
        };
        if agreed { Ok(()) } else { Err(Failure::new(Kind::RefusedHere, "not confirmed; nothing was sent")) }
    }

    /// Whether a person must be asked; an error if nobody can be, or if it is refused whatever anybody says.
    pub fn must_ask(
        &self,
        screen: &Screen,
        robot: &Robot,
        risk: Risk,
        demand: &Demand,
        intent: &str,
    ) -> Result<bool, Failure> {
        if risk == Risk::Read || self.dry_run {
            return Ok(false);
        }
        if robot.read_only.value {
            return Err(Failure::new(Kind::RefusedHere, format!("{} is read-only", robot.label()))
                .hint("remove read_only from its entry in robots.toml if it may be changed"));
        }
        let refused = |message: String| Failure::new(Kind::RefusedHere, message);
        match demand {
            Demand::Flag(why) if !self.yes => {
                return Err(refused(format!("not confirmed: {why}")).hint("add --yes if it is meant"));
            }
            Demand::Usual if risk < Risk::Motion => return Ok(false),
            _ => {}
        }
        if self.yes || robot.target.value.is_simulated() {
            return Ok(false);
        }
        if !screen.can_ask() {
            let when = if risk == Risk::Motion { "when nobody is in the cell" } else { "if it is meant" };
            return Err(refused(format!("not confirmed: on {} this would {intent}", robot.label()))
                .hint(format!("add --yes {when}, or --dry-run to see what would be sent")));
        }
        Ok(true)
    }

    /// Refuses to move several robots that were not each named.
    pub fn pass_many(risk: Risk, robots: &[Robot], each_named: bool) -> Result<(), Failure> {
        if risk < Risk::Motion || robots.len() < 2 || each_named {
            return Ok(());
        }
        Err(Failure::new(Kind::RefusedHere, format!("{} robots would move at once", robots.len()))
            .hint("name each of them with -r; globs, --tag and --all do not move robots"))
    }
}
