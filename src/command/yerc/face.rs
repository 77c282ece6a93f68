//! What the rest of the house may ask of `yerc`.

use clap::ArgMatches;

use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;

use super::commands::Commands;
use super::decode::Decode;
use super::explain::Explain;
use super::file::{Restore, back_up};
use super::serve::Serve;
use super::top::Eye;
use super::{check, connect, link, overview};
use crate::command::backup::{BackedUp, Items, Making, Restored, Restoring};
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

use crate::controller::yerc::{passing, simulator, status};
use crate::failure::Failure;
use crate::output::Screen;
use crate::settings::Robot;
use crate::settings::target::Family;
use crate::transport::session::host::Guard;
use crate::transport::session::host::held::Held;

/// The family `yerc`.
pub struct Yerc;

impl Face for Yerc {
    fn family(&self) -> Family {
        Family::Yerc
    }

    fn title(&self) -> &'static str {
        "Yaskawa FS100 / DX200"
    }

    fn urls(&self) -> Vec<(String, &'static str)> {
        vec![("udp://".to_owned(), "yerc: name or address of the controller")]
    }

    fn codes(&self) -> Vec<(String, String)> {
        let statuses = status::all_statuses().map(|row| (format!("0x{:02X}", row.code), row.name.to_owned()));
        statuses.chain(status::all_added().map(|row| (format!("0x{:04X}", row.code), row.name.to_owned()))).collect()
    }

    fn setup(&self) -> (&'static str, &'static str) {
        ("settings of an FS100 or DX200", include_str!("setup.txt"))
    }

    fn start_state(&self) -> &'static str {
        simulator::EXAMPLE
    }

    fn augment(&self, command: clap::Command) -> clap::Command {
        words::augment::<Commands>(command, "Yaskawa FS100 / DX200 over the high-speed Ethernet server (UDP)")
    }

    fn lay_out(&self, command: clap::Command, is_named: &dyn Fn(&str) -> bool) -> clap::Command {
        Commands::lay_out(command, is_named)
    }

    fn has_command(&self, word: &str) -> bool {
        words::has_command::<Commands>(word)
    }

    fn read(&self, matches: &mut ArgMatches) -> Result<Typed, clap::Error> {
        Ok(words::read::<Commands>(matches)?.into())
    }

    fn schemas(&self) -> Vec<SchemaEntry> {
        Commands::schemas()
    }

    fn tool(&self, kind: ToolKind) -> Option<Tool> {
        Some(match kind {
            ToolKind::Decode => Tool::decode::<Decode>(),
            ToolKind::Explain => Tool::explain::<Explain>(),
            ToolKind::Simulate => Tool::simulate::<Serve>(),
        })
    }

    fn connect<'a>(
        &self,
        robot: &'a Robot,
        access: Access,
        screen: &'a Screen,
    ) -> LocalBoxFuture<'a, Result<Box<dyn Connection>, Failure>> {
        connection::connect::<link::Yerc>(robot, access, screen)
    }

    fn entry(&self, robot: &Robot, mode: ConnectMode) -> Entry {
        link::Yerc::entry(robot, mode)
    }

    fn overview<'a>(&self, connection: &'a mut dyn Connection) -> LocalBoxFuture<'a, Result<OverviewReport, Failure>> {
        async move { overview::overview(connection::link::<link::Yerc>(connection)?).await }.boxed_local()
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
        async move { Ok(Held::Datagrams(connect::hold(robot, access, screen).await?).into()) }.boxed_local()
    }

    fn guard(&self) -> Guard {
        Guard { sends: passing::only_reads_or_stops, shows: |_, _| false }
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
        async move {
            let results = Restore::of(restoring).run(context.of()?).await?;
            Ok(Restored::new(&restoring.folder, Items::from(results)))
        }
        .boxed_local()
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
