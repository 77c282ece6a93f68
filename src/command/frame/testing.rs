//! What the tests of every family need.

use futures_util::FutureExt as _;
use serde_json::Value;

use super::authority::Authority;
use super::command::{AnyCommand, AnyContext, Context};
use super::connection::{self, Access, ConnectMode, Family, Lent};
use super::dry_run::{DryRun, is_end};
use super::orders::BEFORE;
use super::report::{AnyReport as _, Outcome};
use crate::controller::Risk;
use crate::failure::Failure;
use crate::gate::{Gate, Grant};
use crate::output::Screen;
use crate::settings::Robot;

/// Where tests write: nowhere.
pub static QUIET: Screen = Screen::silent();

/// A link that may do anything.
pub fn everything() -> Access {
    Access { granted: Grant::of(Risk::Motion), ..Access::reading(ConnectMode::Control) }
}

/// What a command needs beside its arguments; all questions are answered by `--yes`.
pub fn context<'a, F: Family>(robot: &'a Robot, link: &'a mut F::Link) -> Context<'a, F> {
    let gate = Gate { yes: true, ..Gate::default() };
    let authority = Authority::new(gate, &QUIET, robot, Risk::Motion, Grant::of(Risk::Motion));
    Context { robot, link, screen: &QUIET, several: false, authority }
}

/// Runs a command over a link that stays the test's.
pub async fn run<F: Family>(command: &dyn AnyCommand, context: Context<'_, F>) -> Outcome {
    let Context { robot, link, screen, several, authority } = context;
    let mut lent = Lent::<F>(link);
    command.run(AnyContext { robot, connection: &mut lent, screen, several, authority }).await
}

/// The report of a dry run, as it is written.
pub fn planned<F: Family>(
    robot: &Robot,
    command: &dyn AnyCommand,
    prepare: impl FnOnce(&mut F::Link),
) -> Result<Value, Failure> {
    let intent = command.intent(Some(robot));
    let grant = Grant::of(intent.granted_at_first());
    let access = Access { granted: grant.clone(), dry_run: true, ..Access::reading(command.connect_mode(robot)) };
    let connected = command.connect(robot, access, &QUIET).now_or_never().expect("a dry run opens nothing");
    let mut connection = connected?;
    prepare(connection::link::<F>(&mut *connection)?);
    let gate = Gate { dry_run: true, ..Gate::default() };
    let authority = Authority::new(gate, &QUIET, robot, intent.risk, grant);
    let context = AnyContext { robot, connection: &mut *connection, screen: &QUIET, several: false, authority };
    match command.run(context).now_or_never().expect("a dry run waits for nothing") {
        Err(failure) if !is_end(&failure) => Err(failure),
        _ => DryRun::from(connection.planned()).data(),
    }
}

/// The frames of [`planned`] without those that only read what is replaced.
pub fn frames(planned: &Value) -> Vec<Value> {
    all_frames(planned).into_iter().filter(|frame| frame["about"] != BEFORE).collect()
}

/// All frames of [`planned`].
pub fn all_frames(planned: &Value) -> Vec<Value> {
    planned["frames"].as_array().expect("frames").clone()
}

/// How many frames of [`planned`] only read what is replaced.
pub fn count_before(planned: &Value) -> usize {
    all_frames(planned).len() - frames(planned).len()
}
