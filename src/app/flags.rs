//! Check for global flags that have no effect on a command. Such flags are errors.

use super::prepare::Task;
use crate::command::common::Common;
use crate::command::fleet::robots::Robots;
use armctl_frame::failure::Failure;
use armctl_frame::flags::Globals;
use armctl_frame::gate::OnInterrupt;

/// Groups of global flags that a command uses. All commands also use the output flags.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "each is an independent group of flags")]
struct FlagGroups {
    robots: bool,
    /// Flags for the link, for example the timeout.
    link: bool,
    /// `--watch` and the other flags for repetition.
    repeat: bool,
    /// `--yes` and `--dry-run`.
    gate: bool,
}

const ALL: FlagGroups = FlagGroups { robots: true, link: true, repeat: true, gate: true };
const NONE: FlagGroups = FlagGroups { robots: false, link: false, repeat: false, gate: false };

impl FlagGroups {
    fn for_task(task: &Task) -> Self {
        match task {
            Task::Family(_, command) if command.driver().is_none() => NONE,
            Task::Family(..) => ALL,
            Task::Common(common) => Self::for_common(common),
        }
    }

    fn for_common(common: &Common) -> Self {
        match common {
            Common::Backup(backup) if !backup.takes_robot() => NONE,
            Common::Diff(diff) if !diff.may_ask_robots() => NONE,
            Common::Status(_)
            | Common::Alarm(_)
            | Common::Io(_)
            | Common::Position
            | Common::Stop
            | Common::Wait(_)
            | Common::Top(_)
            | Common::Restore(_)
            | Common::Backup(_)
            | Common::Diff(_)
            | Common::Robots(Robots::Check(_)) => ALL,
            Common::Record(_) => Self { gate: false, ..ALL },
            #[cfg(feature = "plant")]
            Common::Serve(_) => Self { gate: false, ..ALL },
            #[cfg(feature = "plant")]
            Common::Publish(_) => ALL,
            Common::Session(_) | Common::Report(_) => Self { repeat: false, ..ALL },
            Common::Robots(Robots::List) | Common::Names(_) => Self { robots: true, ..NONE },
            Common::Robots(Robots::Discover(_)) => Self { link: true, gate: true, ..NONE },
            Common::Explain(_) => Self { robots: true, link: true, ..NONE },
            // These commands show the settings that a link would use, or check a connection, so they use the link
            // flags.
            Common::Robots(Robots::Show(_)) | Common::Setup(_) => Self { link: true, ..NONE },
            Common::Robots(_)
            | Common::Sim(_)
            | Common::Decode(_)
            | Common::Wireshark(_)
            | Common::Completions(_)
            | Common::Man(_)
            | Common::Schema(_)
            | Common::Help(_) => NONE,
        }
    }
}

/// Rejects a flag that has no effect on the command.
pub fn check(globals: &Globals, task: &Task) -> Result<(), Failure> {
    let uses = FlagGroups::for_task(task);
    match global_flags(globals).into_iter().find(|(flag, is_meant)| flag.is_some() && !is_meant(uses)) {
        Some((Some(flag), _)) => Err(unused_flag(flag, task)),
        _ => Ok(()),
    }
}

/// A flag as the user typed it, if present, and the function that returns whether a command uses it.
type Flag = (Option<&'static str>, fn(FlagGroups) -> bool);

/// Returns all global flags of the line. `--for` is not included, because it belongs to `--until` or to the command
/// itself.
fn global_flags(globals: &Globals) -> [Flag; 17] {
    let Globals { sim, target, robot, all, tag, trace, yes, dry_run, .. } = globals;
    let Globals { on_interrupt, timeout, retries, encoding, no_session, watch, count, until, check, .. } = globals;
    [
        (sim.then_some("--sim"), |uses| uses.robots),
        (target.as_ref().map(|_| "--target"), |uses| uses.robots),
        (robot.first().map(|_| "--robot"), |uses| uses.robots),
        (all.then_some("--all"), |uses| uses.robots),
        (tag.first().map(|_| "--tag"), |uses| uses.robots),
        (trace.as_ref().map(|_| "--trace"), |uses| uses.link),
        (timeout.map(|_| "--timeout"), |uses| uses.link),
        (retries.map(|_| "--retries"), |uses| uses.link),
        (encoding.map(|_| "--encoding"), |uses| uses.link),
        (no_session.then_some("--no-session"), |uses| uses.link),
        (watch.map(|_| "--watch"), |uses| uses.repeat),
        (count.map(|_| "--count"), |uses| uses.repeat),
        (until.as_ref().map(|_| "--until"), |uses| uses.repeat),
        (check.as_ref().map(|_| "--check"), |uses| uses.repeat),
        (yes.then_some("--yes"), |uses| uses.gate),
        (dry_run.then_some("--dry-run"), |uses| uses.gate),
        ((*on_interrupt != OnInterrupt::Stop).then_some("--on-interrupt"), |uses| uses.gate),
    ]
}

fn unused_flag(flag: &str, task: &Task) -> Failure {
    let hint = match (flag, task) {
        ("--tag", Task::Common(Common::Robots(Robots::Add(_)))) => {
            "use --with-tag to give the new robot a tag; --tag only selects robots".to_owned()
        }
        _ => format!("remove {flag}"),
    };
    Failure::usage(format!("{flag} has no effect on this command")).hint(hint)
}
