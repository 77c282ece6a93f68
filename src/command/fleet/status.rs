//! `armctl status`: one line a robot, of whichever family.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use crate::command::frame::authority::Authority;
use crate::command::frame::dry_run::Plan;
use crate::command::frame::script_line::Line;
use crate::command::{Access, Command, Context, Entry, Family, Need, Report, toyo, yerc, yrcx};
use crate::failure::{Failure, Kind};
use crate::output::Screen;
use crate::output::view::{Cell, Table, Tone, View};
use crate::settings::{Robot, target};

/// Robots of any family, for what all of them can be asked.
#[derive(Debug)]
pub struct Fleet;

/// A connection to a robot of any family.
#[derive(Debug)]
pub enum Link {
    /// To an FS100 or DX200.
    Yerc(Box<yerc::link::Link>),
    /// To a YRCX.
    Yrcx(Box<yrcx::link::Link>),
    /// To a Toyo controller.
    Toyo(Box<toyo::link::Link>),
    /// To nobody: this is why.
    Absent(Failure),
}

impl Family for Fleet {
    const FAMILY: Option<target::Family> = None;
    type Link = Link;

    async fn connect(robot: &Robot, access: Access, screen: &Screen) -> Result<Link, Failure> {
        let connected = match robot.family {
            target::Family::Yerc => yerc::Family::connect(robot, access, screen).await.map(Box::new).map(Link::Yerc),
            target::Family::Toyo => toyo::Family::connect(robot, access, screen).await.map(Box::new).map(Link::Toyo),
            target::Family::Yrcx => yrcx::Family::connect(robot, access, screen).await.map(Box::new).map(Link::Yrcx),
        };
        match connected {
            // A robot that is not there has a line as well.
            Err(failure) if failure.kind == Kind::NoAnswer => Ok(Link::Absent(failure)),
            connected => connected,
        }
    }

    async fn halt(link: &mut Link) -> Result<String, Failure> {
        match link {
            Link::Yerc(link) => yerc::Family::halt(link).await,
            Link::Yrcx(link) => yrcx::Family::halt(link).await,
            Link::Toyo(link) => toyo::Family::halt(link).await,
            Link::Absent(_) => Ok("nothing was sent".to_owned()),
        }
    }

    fn rehearsed(link: &mut Link) -> Plan {
        match link {
            Link::Yerc(link) => yerc::Family::rehearsed(link),
            Link::Yrcx(link) => yrcx::Family::rehearsed(link),
            Link::Toyo(link) => toyo::Family::rehearsed(link),
            Link::Absent(_) => Plan::default(),
        }
    }

    fn entry(robot: &Robot, need: Need) -> Entry {
        match robot.family {
            target::Family::Yerc => yerc::Family::entry(robot, need),
            target::Family::Yrcx => yrcx::Family::entry(robot, need),
            target::Family::Toyo => toyo::Family::entry(robot, need),
        }
    }

    async fn close(link: Link, screen: &Screen) -> Result<(), Failure> {
        match link {
            Link::Yerc(link) => yerc::Family::close(*link, screen).await,
            Link::Yrcx(link) => yrcx::Family::close(*link, screen).await,
            Link::Toyo(link) => toyo::Family::close(*link, screen).await,
            Link::Absent(_) => Ok(()),
        }
    }
}

/// Whether robots answer, their mode, servo, alarm and position.
#[derive(Debug, Args)]
pub struct Overview {}

impl Command for Overview {
    type Family = Fleet;
    type Report = OverviewReport;
    const ID: &'static str = "status";

    fn need(&self) -> Need {
        Need::Sight
    }

    async fn run(&self, context: Context<'_, Fleet>) -> Result<OverviewReport, Failure> {
        let found = match context.link {
            Link::Yerc(link) => yerc::overview(link).await,
            Link::Yrcx(link) => yrcx::overview(link).await,
            Link::Toyo(link) => toyo::overview(link).await,
            Link::Absent(failure) => Err(failure.clone()),
        };
        match found {
            Ok(report) => Ok(report),
            Err(failure) if failure.kind == Kind::NoAnswer => {
                Ok(OverviewReport { failure: Some(failure), ..OverviewReport::default() })
            }
            Err(failure) => Err(failure),
        }
    }
}

/// How a robot is, asked among other lines of this process.
pub async fn look(robot: &Robot, line: &Line, screen: &Screen) -> Result<OverviewReport, Failure> {
    let overview = Overview {};
    let access = Access::reading(overview.need());
    let access = line.connecting(robot, access, screen).await?;
    let mut connection = Fleet::connect(robot, access, screen).await?;
    let authority = Authority::reading(screen, robot);
    let context = Context { robot, link: &mut connection, screen, several: false, authority };
    let report = overview.run(context).await;
    Fleet::close(connection, screen).await?;
    report
}

/// The state of one robot in a line.
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub struct OverviewReport {
    /// Where it is false, all that follows is null.
    pub reachable: bool,
    /// `teach` or `play` (yerc); `auto` or `manual` (yrcx); `automatic`, `step` or `program` (toyo); null if unknown.
    pub mode: Option<&'static str>,
    /// Servo power.
    pub servo_on: Option<bool>,
    /// A job or program runs, or an axis moves.
    pub running: Option<bool>,
    /// Held or paused.
    pub held: Option<bool>,
    /// An alarm is present (yerc, yrcx).
    pub alarm: Option<bool>,
    /// An error is present.
    pub error: Option<bool>,
    /// The first robot in base coordinates.
    pub position: Option<PositionMm>,
    /// Why the position was not asked (yrcx without a session); null where it was.
    pub not_asked: Option<&'static str>,
    /// Why it is not reachable.
    #[serde(skip)]
    pub failure: Option<Failure>,
}

/// A place in base coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct PositionMm {
    /// X.
    pub x_mm: f64,
    /// Y.
    pub y_mm: f64,
    /// Z.
    pub z_mm: f64,
}

impl Report for OverviewReport {
    fn view(&self) -> View {
        let mut table = Table::new(&["reachable", "mode", "servo", "state", "alarm", "x y z (mm)"], "");
        if !self.reachable {
            let dash = || Cell::from("-");
            table.row([Cell::from("no").tone(Tone::Bad), dash(), dash(), dash(), dash(), dash()]);
            return View::table(table);
        }
        let state = match (self.held, self.running) {
            (Some(true), _) => Cell::from("hold").tone(Tone::Warning),
            (_, Some(true)) => Cell::from("running").tone(Tone::Good),
            _ => "stopped".into(),
        };
        let alarm = match (self.alarm, self.error) {
            (Some(true), _) => Cell::from("alarm").tone(Tone::Bad),
            (_, Some(true)) => Cell::from("error").tone(Tone::Bad),
            _ => "none".into(),
        };
        let position = self.position.as_ref().map(|at| format!("{:.3} {:.3} {:.3}", at.x_mm, at.y_mm, at.z_mm));
        table.row([
            Cell::from("yes").tone(Tone::Good),
            Cell::maybe(self.mode),
            Cell::maybe(self.servo_on.map(Cell::switch)),
            state,
            alarm,
            Cell::maybe(position.or(self.not_asked.map(|_| "not asked".to_owned()))),
        ]);
        View::table(table)
    }

    fn failure(&self) -> Option<Failure> {
        self.failure.clone()
    }
}
