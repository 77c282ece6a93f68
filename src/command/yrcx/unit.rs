//! `--unit`: which robot of the controller a command is for.

use std::pin::Pin;

use clap::Args;

use super::{Family, Yrcx};
use crate::command::{AnyCommand, Context, Need, Noun as _, Outcome};
use crate::controller::Risk;
use crate::gate::Demand;
use crate::output::Screen;

/// Which robot of the controller a command is for.
#[derive(Debug, Args)]
pub struct Unit {
    /// Robot of the controller, 1 to 4; 0 is the first, or all of them where a command can be for all
    #[arg(long, global = true, value_name = "N", default_value_t = 0, hide_default_value = true, help_heading = "Which robot",
        value_parser = clap::value_parser!(u8).range(0..=4))]
    unit: u8,
}

impl Unit {
    /// The command for this robot.
    pub fn of(&self, verb: Yrcx) -> Box<dyn AnyCommand<Family>> {
        Box::new(OfUnit { unit: self.unit, command: verb.command() })
    }

    /// The words that say the same.
    pub fn words(&self) -> Vec<String> {
        if self.unit == 0 { Vec::new() } else { vec!["--unit".to_owned(), self.unit.to_string()] }
    }
}

/// A command for one robot of the controller.
struct OfUnit {
    unit: u8,
    command: Box<dyn AnyCommand<Family>>,
}

impl AnyCommand<Family> for OfUnit {
    fn id(&self) -> &'static str {
        self.command.id()
    }

    fn risk(&self) -> Risk {
        self.command.risk()
    }

    fn intent(&self) -> String {
        let intent = self.command.intent();
        let robot = format!("robot {}", self.unit);
        if self.unit == 0 || intent.contains(&robot) { intent } else { format!("{intent}, {robot}") }
    }

    fn demand(&self) -> Demand {
        self.command.demand()
    }

    fn is_endless(&self) -> bool {
        self.command.is_endless()
    }

    fn need(&self) -> Need {
        self.command.need()
    }

    fn takes_robot(&self) -> bool {
        self.command.takes_robot()
    }

    fn without_robot(&self, screen: &Screen) -> Option<Outcome> {
        self.command.without_robot(screen)
    }

    fn run<'a>(&'a self, context: Context<'a, Family>) -> Pin<Box<dyn Future<Output = Outcome> + 'a>> {
        context.link.set_unit(self.unit);
        self.command.run(context)
    }
}
