//! `armctl status`: one line per robot of any family.

use crate::command::families;
use armctl_frame::dry_run::Plan;
use armctl_frame::face::{Face, OverviewReport};
use armctl_frame::output::envelope::Envelope;
use armctl_frame::prelude::*;
use armctl_frame::script_line::Line;
use armctl_frame::settings::place::Place;
use armctl_frame::settings::target;
use armctl_frame::shared_session::{can_share, open_shared_session};
use armctl_frame::{Connection, ConnectionEffect, Family};

/// Robots of any family, for commands that all families support.
#[derive(Debug)]
pub struct Fleet;

/// A connection to a robot of any family.
pub enum Link {
    /// An open connection with the face of its family.
    Open(&'static Face, Box<dyn Connection>),
    /// No connection, with the reason.
    Absent(Box<Absent>),
}

/// A robot that could not be reached, and how to try again.
pub struct Absent {
    /// The reason.
    pub failure: Failure,
    robot: Robot,
    access: Access,
    /// Whether the reason was reported. If so, the next command tries again to connect.
    is_asked: bool,
}

impl Link {
    /// Tries again to connect to a robot that did not answer the last command.
    pub async fn open_link(&mut self, screen: &Screen) -> Result<()> {
        let Self::Absent(absent) = self else { return Ok(()) };
        if !std::mem::replace(&mut absent.is_asked, true) {
            return Ok(());
        }
        let (robot, access) = (absent.robot.clone(), absent.access.clone());
        match Fleet::connect(&robot, access.clone(), screen).await? {
            Self::Absent(again) => absent.failure = again.failure,
            Self::Open(face, connection) => {
                let driver = face.driver;
                if !can_share(driver, &robot) {
                    *self = Self::Open(face, connection);
                    return Ok(());
                }
                // Connect again through a shared session, so that other commands can use the link of this robot.
                connection.close(screen).await?;
                let robot = open_shared_session(driver, &robot).await?;
                *self = Fleet::connect(&robot, access, screen).await?;
            }
        }
        Ok(())
    }
}

impl Family for Fleet {
    const FAMILY: Option<target::Family> = None;
    type Link = Link;
    const STOP: &'static [&'static str] = &[];

    async fn connect(robot: &Robot, access: Access, screen: &Screen) -> Result<Link> {
        let face = families::of(robot.family);
        match (face.driver.connect)(robot, access.clone(), screen).await {
            Ok(connection) => Ok(Link::Open(face, connection)),
            // A robot that does not answer gets a line in the table as well.
            Err(failure) if failure.kind == Kind::NoAnswer => {
                Ok(Link::Absent(Box::new(Absent { failure, robot: robot.clone(), access, is_asked: false })))
            }
            Err(failure) => Err(failure),
        }
    }

    async fn halt(link: &mut Link) -> Result<String> {
        match link {
            Link::Open(_, connection) => connection.halt().await,
            Link::Absent(_) => Ok("nothing was sent".to_owned()),
        }
    }

    fn planned(link: &mut Link) -> Plan {
        match link {
            Link::Open(_, connection) => connection.planned(),
            Link::Absent(_) => Plan::default(),
        }
    }

    fn connection_effect(robot: &Robot, mode: ConnectMode) -> ConnectionEffect {
        (families::driver(robot).connection_effect)(robot, mode)
    }

    fn takes_one_client(robot: &Robot) -> bool {
        (families::driver(robot).takes_one_client)(robot)
    }

    fn addresses(robot: &Robot) -> Result<Vec<target::Address>> {
        (families::driver(robot).addresses)(robot)
    }

    async fn close(link: Link, screen: &Screen) -> Result<()> {
        match link {
            Link::Open(_, connection) => connection.close(screen).await,
            Link::Absent(_) => Ok(()),
        }
    }
}

/// Shows for each robot whether it answers, and its mode, servo state, alarm and position.
#[derive(Debug, Default, Args)]
pub struct Overview {
    /// Also count the robots of each site, area, line or cell
    #[arg(long, value_name = "LEVEL", value_parser = Place::KEYS)]
    by: Option<String>,
}

impl Command for Overview {
    type Family = Fleet;
    type Report = OverviewReport;
    const ID: &'static str = "status";
    const CONNECT_MODE: ConnectMode = ConnectMode::Monitor;

    async fn run(&self, context: Context<'_, Fleet>) -> Result<OverviewReport> {
        let found = match context.link.open_link(context.screen).await {
            Ok(()) => match context.link {
                Link::Open(face, connection) => (face.overview)(&mut **connection).await,
                Link::Absent(absent) => Err(absent.failure.clone()),
            },
            Err(failure) => Err(failure),
        };
        let report = found.or_else(|failure| self.without_answer(context.robot, failure))?;
        let mut report = OverviewReport { family: context.robot.family.name(), ..report };
        report.state.fault.explain(context.robot)?;
        Ok(report)
    }

    /// A missing answer is a state of the robot here, and not a failure.
    fn without_answer(&self, robot: &Robot, failure: Failure) -> Result<OverviewReport> {
        if failure.kind != Kind::NoAnswer {
            return Err(failure);
        }
        Ok(OverviewReport { family: robot.family.name(), failure: Some(failure), ..OverviewReport::default() })
    }

    /// Summary line `32 robots, 30 answer, 1 alarm`, below a line for each place of the level `--by`.
    fn summary(&self, envelopes: &[Envelope]) -> Option<String> {
        let mut lines = Vec::new();
        if let Some(key) = &self.by {
            // Robots without a place are last.
            let mut places: BTreeMap<(bool, Option<&str>), Vec<&Envelope>> = BTreeMap::new();
            for envelope in envelopes {
                let place = envelope.place.as_ref().and_then(|place| place.get(key));
                places.entry((place.is_none(), place)).or_default().push(envelope);
            }
            for ((_, place), envelopes) in places {
                let label = place.map_or_else(|| format!("no {key}"), |place| format!("{key} {place}"));
                lines.push(format!("{label}: {}", count(&envelopes.into_iter())));
            }
        }
        lines.push(count(&envelopes.iter()));
        Some(lines.join("\n"))
    }
}

/// Counts robots, answers and alarms.
fn count<'a>(envelopes: &(impl Iterator<Item = &'a Envelope> + Clone)) -> String {
    let count = |field: &str| {
        let is_true = |envelope: &&Envelope| envelope.data.as_ref().is_some_and(|data| data[field] == true);
        envelopes.clone().filter(is_true).count()
    };
    let (robots, answer, alarms) = (envelopes.clone().count(), count("reachable"), count("faulted"));
    let plural = |number: usize| if number == 1 { "" } else { "s" };
    let verb = if answer == 1 { "answers" } else { "answer" };
    let number = if alarms == 0 { "no".to_owned() } else { alarms.to_string() };
    format!("{robots} robot{}, {answer} {verb}, {number} alarm{}", plural(robots), plural(alarms.max(1)))
}

/// Overview of a robot, with the connections of an interactive session.
pub async fn look(robot: &Robot, line: &Line, screen: &Screen) -> Result<OverviewReport> {
    let overview = Overview::default();
    let access = Access::reading(overview.connect_mode());
    let access = line.connect(robot, access, screen).await?;
    let mut connection = Fleet::connect(robot, access, screen).await?;
    let confirmer = Confirmer::reading(screen, robot);
    let context = Context { robot, link: &mut connection, screen, several: false, confirmer };
    let report = overview.run(context).await;
    Fleet::close(connection, screen).await?;
    report
}
