//! `armctl robots check`: checks each layer of a connection, with hints for problems.

use crate::command::families;
use armctl_frame::Family;
use armctl_frame::dry_run::Plan;
use armctl_frame::face::layers;
use armctl_frame::face::layers::Layer;
use armctl_frame::prelude::*;
use armctl_frame::settings::target;

/// Checks each layer of the connection between this computer and the robot, and shows which settings to change. It
/// changes nothing. The exit code is 8 if a layer failed.
#[derive(Debug, Args)]
pub struct Check {
    /// A robot in the inventory, or a target URL [default: the robots that -r, -t and other flags select]
    #[arg(value_name = "NAME|URL", add = ValueKind::RobotOrUrl)]
    pub name: Option<String>,
}

/// Robots of any family. The check of the family connects to each of them.
#[derive(Debug)]
pub struct Checked;

impl Family for Checked {
    const FAMILY: Option<target::Family> = None;
    /// Access for the check.
    type Link = Access;
    const STOP: &'static [&'static str] = &[];

    async fn connect(_robot: &Robot, access: Access, _screen: &Screen) -> Result<Access> {
        Ok(access)
    }

    async fn halt(_link: &mut Access) -> Result<String> {
        Ok("no motion command was sent".to_owned())
    }

    fn planned(_link: &mut Access) -> Plan {
        Plan::default()
    }

    fn addresses(robot: &Robot) -> Result<Vec<target::Address>> {
        (families::driver(robot).addresses)(robot)
    }

    async fn close(_link: Access, _screen: &Screen) -> Result<()> {
        Ok(())
    }
}

impl Command for Check {
    type Family = Checked;
    type Report = CheckReport;
    const ID: &'static str = "robots.check";
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    async fn run(&self, context: Context<'_, Checked>) -> Result<CheckReport> {
        let Context { robot, screen, .. } = context;
        let access = context.link.clone();
        if access.dry_run {
            return Err(Failure::usage("a check has no dry run: its requests depend on the answers")
                .hint("run the command without --dry-run; a check only reads"));
        }
        CheckReport::of(robot, access, screen).await
    }
}

/// The layers of a robot.
#[derive(Debug, Serialize, JsonSchema)]
pub struct CheckReport {
    layers: Vec<Layer>,
    #[serde(skip)]
    family: &'static str,
}

impl CheckReport {
    /// Checks each layer of a robot.
    pub async fn of(robot: &Robot, access: Access, screen: &Screen) -> Result<Self> {
        let mut layers = (families::of(robot.family).check)(robot, access, screen).await?;
        layers.extend(layers::drafts());
        Ok(Self { layers, family: robot.family.name() })
    }
}

impl Report for CheckReport {
    fn view(&self) -> View {
        View::table(layers::table(&self.layers))
    }

    fn failure(&self) -> Option<Failure> {
        let (layer, found) = layers::first_failed(&self.layers)?;
        Some(
            Failure::new(Kind::ConditionNotMet, format!("{layer}: {found}"))
                .hint(format!("see `armctl help {}-setup` for the settings of the controller", self.family)),
        )
    }
}
