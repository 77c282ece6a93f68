//! Verbs that every family has. Each robot gets the command of its family.

pub mod alarm;
pub mod io;
pub mod line;

use crate::command::families::{self, FAMILIES};
use armctl_frame::command::AnyContext;
use armctl_frame::face::shared_commands::SharedVerb;
use armctl_frame::gate::Intent;
use armctl_frame::output::csv::Sheet;
use armctl_frame::prelude::*;
use armctl_frame::robot::position::AllPositions;
use armctl_frame::{AnyCommand, Driver, Outcome, SchemaEntry};

/// A verb with the command of each family.
pub struct SharedVerbCommands {
    id: &'static str,
    commands: [(Family, Box<dyn AnyCommand>); FAMILIES.len()],
}

impl SharedVerbCommands {
    /// Creates a verb; `id` is its command id in envelopes and schemas.
    pub fn new(id: &'static str, verb: SharedVerb) -> Self {
        Self { id, commands: FAMILIES.map(|face| (face.family, (face.shared)(verb))) }
    }

    fn of(&self, robot: &Robot) -> &dyn AnyCommand {
        let found = self.commands.iter().find(|(family, _)| *family == robot.family);
        found.map_or(&*self.commands[0].1, |(_, command)| &**command)
    }
}

impl AnyCommand for SharedVerbCommands {
    fn id(&self) -> &'static str {
        self.id
    }

    fn intent(&self, robot: Option<&Robot>) -> Intent {
        if let Some(robot) = robot {
            return self.of(robot).intent(Some(robot));
        }
        let [first, rest @ ..] = &self.commands;
        let most = |most: Intent, (_, command): &(Family, Box<dyn AnyCommand>)| {
            let intent = command.intent(None);
            if intent.risk > most.risk { intent } else { most }
        };
        rest.iter().fold(first.1.intent(None), most)
    }

    fn driver(&self) -> Option<&'static Driver> {
        Some(&PER_ROBOT)
    }

    fn connect_mode(&self, robot: &Robot) -> ConnectMode {
        self.of(robot).connect_mode(robot)
    }

    fn sheet(&self) -> Option<Sheet> {
        self.commands[0].1.sheet()
    }

    fn run_unsettled<'a>(&'a self, context: AnyContext<'a>) -> LocalBoxFuture<'a, Outcome> {
        self.of(context.robot).run_unsettled(context)
    }
}

/// `armctl stop`: the stop command of each family.
pub fn stop() -> SharedVerbCommands {
    SharedVerbCommands::new("stop", SharedVerb::Stop)
}

/// `armctl position`: current position of each robot.
pub fn position() -> SharedVerbCommands {
    SharedVerbCommands::new("position", SharedVerb::Position)
}

/// Schemas of the reports.
pub fn schemas() -> Vec<SchemaEntry> {
    let stop = SchemaEntry::of::<SetReport>("stop");
    let position = SchemaEntry::of::<AllPositions>("position");
    alarm::schemas().into_iter().chain(io::schemas()).chain([position, stop]).collect()
}

/// Connects to each robot with the driver of its family.
static PER_ROBOT: Driver = Driver {
    family: None,
    stop: &[],
    connection_effect: |robot, mode| (families::driver(robot).connection_effect)(robot, mode),
    end_effect: |robot| (families::driver(robot).end_effect)(robot),
    takes_one_client: |robot| (families::driver(robot).takes_one_client)(robot),
    addresses: |robot| (families::driver(robot).addresses)(robot),
    connect: |robot, access, screen| (families::driver(robot).connect)(robot, access, screen),
};
