//! Commands that every family has: `armctl alarm history`, `alarm reset`, `stop`. Each robot gets the command of its
//! family, and the reports have the common keys.

use serde::Serializer;

use super::registration::Declaration;
use crate::AnyContext;
use crate::connection;
use crate::gate::Intent;
use crate::output::csv::Sheet;
use crate::prelude::basics::*;
use crate::report::sheet_of;
use crate::{AnyCommand, Command, ConnectMode, Driver, Outcome};

/// Shared commands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SharedVerb {
    /// `armctl alarm history`.
    AlarmHistory,
    /// `armctl alarm reset`.
    AlarmReset,
    /// `armctl stop`.
    Stop,
    /// `armctl position`.
    Position,
}

/// Conversion of a family report to the common report.
pub trait CommonReport {
    /// Common report type.
    type Core: Report + 'static;

    /// Report without family-specific fields.
    fn core(&self) -> Self::Core;
}

/// Family command for a shared verb, without arguments.
pub fn command<F: Declaration>(verb: SharedVerb) -> Box<dyn AnyCommand> {
    match verb {
        SharedVerb::AlarmHistory => Box::new(CommonCommand(default_arguments::<F::AlarmHistory>())),
        SharedVerb::AlarmReset => Box::new(CommonCommand(default_arguments::<F::AlarmReset>())),
        SharedVerb::Stop => Box::new(CommonCommand(F::stop_command())),
        SharedVerb::Position => Box::new(CommonCommand(default_arguments::<F::Position>())),
    }
}

/// A command with default arguments.
///
/// # Panics
/// If the command has arguments without a default, which a test excludes.
pub fn default_arguments<C: Args>() -> C {
    // The position command of a YRCX reads this global option.
    let until = clap::Arg::new("until").long("until").global(true);
    let command = C::augment_args(clap::Command::new("usual").arg(until));
    let matches = command.try_get_matches_from(["usual"]).and_then(|matches| C::from_arg_matches(&matches));
    matches.expect("a command that needs no arguments; a test holds that")
}

/// A command whose report is reduced to the common fields.
struct CommonCommand<C>(C);

impl<C: Command<Report: CommonReport>> AnyCommand for CommonCommand<C> {
    fn id(&self) -> &'static str {
        C::ID
    }

    fn intent(&self, robot: Option<&Robot>) -> Intent {
        AnyCommand::intent(&self.0, robot)
    }

    fn driver(&self) -> Option<&'static Driver> {
        Some(connection::driver::<C::Family>())
    }

    fn connect_mode(&self, _robot: &Robot) -> ConnectMode {
        Command::connect_mode(&self.0)
    }

    fn sheet(&self) -> Option<Sheet> {
        Some(sheet_of::<<C::Report as CommonReport>::Core>())
    }

    fn run_unsettled<'a>(&'a self, context: AnyContext<'a>) -> LocalBoxFuture<'a, Outcome> {
        async move {
            let several = context.several;
            let report = Command::run(&self.0, context.of()?).await?;
            let core = report.core();
            // A single robot is shown in the form of its family.
            let view = if several { core.view() } else { report.view() };
            Ok(Box::new(Core { core, view, failure: report.failure() }) as Box<_>)
        }
        .boxed_local()
    }
}

/// Common fields of a report, with the view and the failure of the full report.
struct Core<R> {
    core: R,
    view: View,
    failure: Option<Failure>,
}

impl<R: Serialize> Serialize for Core<R> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.core.serialize(serializer)
    }
}

impl<R: JsonSchema> JsonSchema for Core<R> {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        R::schema_name()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        R::json_schema(generator)
    }
}

impl<R: Report> Report for Core<R> {
    const ROWS: RowsOf = R::ROWS;

    fn view(&self) -> View {
        self.view.clone()
    }

    fn failure(&self) -> Option<Failure> {
        self.failure.clone()
    }
}
