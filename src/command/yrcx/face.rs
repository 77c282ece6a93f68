//! What the rest of the house may ask of `yrcx`.

use clap::ArgMatches;
use clap::{Args as _, FromArgMatches as _};
use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;

use super::backup::{Restore, back_up};
use super::commands::Commands;
use super::decode::Decode;
use super::explain::Explain;
use super::serve::ServeArgs;
use super::top::Eye;
use super::trace::Recorder;
use super::unit::Unit;
use super::{check, hold, link, overview};
use crate::command::backup::{BackedUp, Making, Restored, Restoring};
use crate::command::face::layers::Layer;
use crate::command::face::overview::OverviewReport;
use crate::command::face::sample::{Depth, Sample};
use crate::command::face::tool::{Tool, ToolKind};
use crate::command::face::words::{self, Typed};
use crate::command::face::{Face, HeldLink, Watch};
use crate::command::frame::connection;
use crate::command::{
    Access, AnyContext, Command as _, CommandSet as _, ConnectMode, Connection, Entry, Family as _, SchemaEntry,
};

use crate::controller::yrcx::{alarm, passing, simulator};
use crate::failure::Failure;
use crate::output::Screen;
use crate::settings::Robot;
use crate::settings::target::{BUSES, Family};
use crate::transport::session::host::Guard;
use crate::transport::session::host::held::Held;

/// The family `yrcx`.
pub struct Yrcx;

impl Face for Yrcx {
    fn family(&self) -> Family {
        Family::Yrcx
    }

    fn title(&self) -> &'static str {
        "OMRON / Yamaha YRCX"
    }

    fn urls(&self) -> Vec<(String, &'static str)> {
        BUSES.iter().map(|bus| (format!("{}://", bus.name), bus.about)).collect()
    }

    fn codes(&self) -> Vec<(String, String)> {
        alarm::KNOWN.iter().map(|known| (known.alarm.to_string(), known.text.to_owned())).collect()
    }

    fn setup(&self) -> (&'static str, &'static str) {
        ("settings of a YRCX", include_str!("setup.txt"))
    }

    fn start_state(&self) -> &'static str {
        simulator::EXAMPLE
    }

    fn augment(&self, command: clap::Command) -> clap::Command {
        words::augment::<Commands>(Unit::augment_args(command), "OMRON / Yamaha YRCX over a fieldbus")
            .after_help("Settings and first contact: `armctl help yrcx-setup`.")
    }

    fn lay_out(&self, command: clap::Command, is_named: &dyn Fn(&str) -> bool) -> clap::Command {
        Commands::lay_out(Unit::augment_args(command), is_named)
    }

    fn has_command(&self, word: &str) -> bool {
        words::has_command::<Commands>(word)
    }

    fn read(&self, matches: &mut ArgMatches) -> Result<Typed, clap::Error> {
        let unit = Unit::from_arg_matches_mut(matches)?;
        Ok(Typed { unit: unit.number(), prefix: unit.words(), wish: words::read::<Commands>(matches)? })
    }

    fn schemas(&self) -> Vec<SchemaEntry> {
        Commands::schemas()
    }

    fn tool(&self, kind: ToolKind) -> Option<Tool> {
        Some(match kind {
            ToolKind::Decode => Tool::decode::<Decode>(),
            ToolKind::Explain => Tool::explain::<Explain>(),
            ToolKind::Simulate => Tool::simulate::<ServeArgs>(),
        })
    }

    fn connect<'a>(
        &self,
        robot: &'a Robot,
        access: Access,
        screen: &'a Screen,
    ) -> LocalBoxFuture<'a, Result<Box<dyn Connection>, Failure>> {
        connection::connect::<link::Yrcx>(robot, access, screen)
    }

    fn entry(&self, robot: &Robot, mode: ConnectMode) -> Entry {
        link::Yrcx::entry(robot, mode)
    }

    fn overview<'a>(&self, connection: &'a mut dyn Connection) -> LocalBoxFuture<'a, Result<OverviewReport, Failure>> {
        async move { overview::overview(connection::link::<link::Yrcx>(connection)?).await }.boxed_local()
    }

    fn check<'a>(
        &self,
        robot: &'a Robot,
        access: Access,
        screen: &'a Screen,
    ) -> LocalBoxFuture<'a, Result<Vec<Layer>, Failure>> {
        check::check(robot, access, screen).boxed_local()
    }

    fn watch<'a>(
        &self,
        robot: &'a Robot,
        access: Access,
        screen: &'a Screen,
    ) -> LocalBoxFuture<'a, Result<Box<dyn Watch>, Failure>> {
        async move { Ok(Box::new(Eye::open(robot, access, screen).await?) as Box<dyn Watch>) }.boxed_local()
    }

    fn hold<'a>(
        &self,
        robot: &'a Robot,
        access: &'a Access,
        screen: &'a Screen,
    ) -> LocalBoxFuture<'a, Result<HeldLink, Failure>> {
        async move {
            let (images, recorder) = hold::hold(robot, access, screen).await?;
            let finish = recorder.map(|recorder| Box::new(|| Recorder::finish(recorder)) as Box<_>);
            Ok(HeldLink { held: Held::Images(images), finish })
        }
        .boxed_local()
    }

    fn guard(&self) -> Guard {
        Guard { sends: |_| false, shows: passing::only_stops }
    }

    fn session_records(&self) -> bool {
        true
    }

    fn session_commands(&self) -> bool {
        true
    }

    fn back_up<'a>(
        &self,
        context: AnyContext<'a>,
        making: &'a Making,
    ) -> LocalBoxFuture<'a, Result<BackedUp, Failure>> {
        async move { back_up(context.of()?, making.clone()).await }.boxed_local()
    }

    fn restore<'a>(
        &self,
        context: AnyContext<'a>,
        restoring: &'a Restoring,
    ) -> LocalBoxFuture<'a, Result<Restored, Failure>> {
        async move { Restore::of(restoring).run(context.of()?).await }.boxed_local()
    }
}

impl Watch for Eye {
    fn look(&mut self, depth: Depth) -> LocalBoxFuture<'_, Result<Sample, Failure>> {
        Eye::look(self, depth).boxed_local()
    }

    fn close(self: Box<Self>, screen: &Screen) -> LocalBoxFuture<'_, Result<(), Failure>> {
        Eye::close(*self, screen).boxed_local()
    }
}
