//! Check for global flags that have no effect on a command. Such flags are errors.

use super::prepare::Task;
use crate::command::common::{Common, FlagGroups};
use crate::command::fleet::robots::Robots;
use armctl_frame::failure::Failure;
use armctl_frame::flags::Globals;
use armctl_frame::gate::OnInterrupt;

/// Rejects a flag that has no effect on the command.
pub fn check(globals: &Globals, task: &Task) -> Result<(), Failure> {
    let uses = task.properties().flags;
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
