//! What the tests of every family need.

use futures_util::FutureExt as _;
use serde_json::Value;

use super::authority::Authority;
use super::dry_run::{DryRun, is_end};
use super::{Access, AnyCommand, Context, Family, Need};
use crate::controller::Risk;
use crate::failure::Failure;
use crate::gate::{Gate, Grant};
use crate::output::Screen;
use crate::settings::Robot;

/// Where tests write: nowhere.
pub static QUIET: Screen = Screen::silent();

/// A link that may do anything.
pub fn everything() -> Access {
    Access { granted: Grant::of(Risk::Motion), ..Access::reading(Need::Command) }
}

/// What a command needs beside its arguments; all questions are answered by `--yes`.
pub fn context<'a, F: Family>(robot: &'a Robot, link: &'a mut F::Link) -> Context<'a, F> {
    let gate = Gate { yes: true, ..Gate::default() };
    let authority = Authority::new(gate, &QUIET, robot, Risk::Motion, Grant::of(Risk::Motion));
    Context { robot, link, screen: &QUIET, several: false, authority }
}

/// The report of a dry run, as it is written.
pub fn planned<F: Family>(
    robot: &Robot,
    command: &dyn AnyCommand<F>,
    prepare: impl FnOnce(&mut F::Link),
) -> Result<Value, Failure> {
    let intent = command.intent(Some(robot));
    let grant = Grant::of(intent.granted_at_first());
    let access = Access { granted: grant.clone(), dry_run: true, ..Access::reading(command.need()) };
    let mut link = F::connect(robot, access, &QUIET).now_or_never().expect("a dry run opens nothing")?;
    prepare(&mut link);
    let gate = Gate { dry_run: true, ..Gate::default() };
    let authority = Authority::new(gate, &QUIET, robot, intent.risk, grant);
    let context = Context { robot, link: &mut link, screen: &QUIET, several: false, authority };
    match command.run(context).now_or_never().expect("a dry run waits for nothing") {
        Err(failure) if !is_end(&failure) => Err(failure),
        _ => super::AnyReport::data(&DryRun::from(F::rehearsed(&mut link))),
    }
}

/// The frames of [`planned`].
pub fn frames(planned: &Value) -> Vec<Value> {
    planned["frames"].as_array().expect("frames").clone()
}
