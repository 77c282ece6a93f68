//! `yerc teach`: stores the current position of a group in a position variable. The aliases are `position teach P5` and
//! `var set P5=here`.

use super::moves::{compared, is_standing, moved_during_question};
use super::position;
use super::var::{PositionData, as_position, different_words, is_undefined, stored_position, variable_name};
use crate::failure::refusal_failure;
use crate::item_requests::ReadError;
use crate::prelude::*;
use armctl_controller::names::Kind;
use armctl_controller::yerc::query::{Coordinates, Query as _, ReadPosition, ReadVariable, WriteVariable};
use armctl_controller::yerc::variables::{Reference, Value, VariableKind};
use armctl_frame::teach::{TeachReport, mismatch, unverified};

/// Stores the current position of a group in a position variable and reads it back (FS and DX 3.3.6, 3.3.16 to
/// 3.3.18).
#[derive(Debug, Args)]
#[command(
    after_help = "The command stores the position of `yerc position`, with servo power on or off. Use P for a robot, \
                  BP for its base, and EX for a station. Without --coordinates, the variable keeps its type; an \
                  undefined variable gets pulses. `yerc position teach P5` and `yerc var set P5=here` do the same."
)]
pub struct Teach {
    /// Position variable, for example P5, BP1 or EX1, or a name
    #[arg(value_name = "REF", value_parser = variable, add = complete::VARIABLE)]
    variable: Reference,
    /// Control group to read [default: R1 for P, B1 for BP, S1 for EX]
    #[arg(long)]
    group: Option<Group>,
    /// Store pulses or base coordinates [default: type of the variable]
    #[arg(long, value_enum)]
    coordinates: Option<StoredAs>,
}

/// Type of a position that `teach` can store.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum StoredAs {
    /// Pulses of each axis
    Pulse,
    /// X, Y, Z, Rx, Ry and Rz in base coordinates
    Base,
}

impl From<StoredAs> for Coordinates {
    fn from(stored: StoredAs) -> Self {
        match stored {
            StoredAs::Pulse => Self::Pulse,
            StoredAs::Base => Self::Base,
        }
    }
}

fn variable(text: &str) -> Result<Reference, String> {
    names::parse_or_name(&[Kind::Variable], "P0", text, position_variable)
}

fn position_variable(text: &str) -> Result<Reference, String> {
    let reference: Reference = text.parse().map_err(|error| format!("{error}"))?;
    if reference.kind.is_position() {
        Ok(reference)
    } else {
        Err(format!("{reference} is not a position variable; use P, BP or EX"))
    }
}

impl Command for Teach {
    type Family = Yerc;
    type Report = TeachReport;
    const ID: &'static str = "yerc.teach";
    const RISK: Risk = Risk::Destroy;
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    fn intent(&self) -> String {
        format!("overwrite {}", self.variable)
    }

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Self::Report> {
        let Context { link, confirmer, robot, screen, .. } = context;
        let label = variable_name(names::of_robot(robot, screen), self.variable);
        let (name, group) = (self.variable.to_string(), self.group()?);
        let Some(old) = self.read(link.for_purpose("content of the variable")).await.known()? else {
            return Err(self.plan(link, group).await?);
        };
        let coordinates = self.coordinates(old.as_ref())?;
        let (here, report) = position::ask(link, group, coordinates).await?;
        let new = stored_position(group, here);
        let is_unchanged = old.as_ref().map(Value::emit) == Some(new.emit());
        let is_asked = confirmer.asks_user();
        confirmer.confirm(&self.change(link, group, &label, old.as_ref().filter(|_| !is_unchanged), &here)).await?;
        if is_asked {
            let (now, _) = position::ask(link, group, coordinates).await?;
            if !is_standing(&here, &now) {
                return Err(moved_during_question(group, &now));
            }
        }
        let shown = |value: &Value| PositionData::of(value).map(|data| data.text().to_owned()).unwrap_or_default();
        if !is_unchanged {
            link.ask(&WriteVariable::new(self.variable.number, new.clone()).map_err(usage)?).await?;
            let read_back = self.read(link).await;
            let read_back = read_back.map_err(|failure| unverified(&name, failure, &format!("yerc var get {name}")))?;
            if read_back.as_ref().map(Value::emit) != Some(new.emit()) {
                let held_value = read_back.as_ref().map_or_else(|| "nothing".to_owned(), shown);
                return Err(mismatch(&name, &shown(&new), &held_value));
            }
        }
        let per_degree = link.pulses_per_degree(group);
        let held = |value: &Value| position::has_taught_axes(group, value, per_degree);
        Ok(TeachReport::new(name, old.as_ref().map(held), held(&new), report).unchanged(is_unchanged))
    }
}

impl Teach {
    /// Control group of the position. It must match the kind of the variable.
    fn group(&self) -> Result<Group> {
        let (first, what) = match self.variable.kind {
            VariableKind::Bp => (Group::Base(1), "bases, such as B1"),
            VariableKind::Ex => (Group::Station(1), "stations, such as S1"),
            _ => (Group::R1, "robots, such as R1"),
        };
        let group = self.group.unwrap_or(first);
        if std::mem::discriminant(&group) == std::mem::discriminant(&first) {
            return Ok(group);
        }
        let message =
            format!("{} cannot store a position of {group}: {} are for {what}", self.variable, self.axis_letters());
        Err(Failure::usage(message).hint("use P for a robot, BP for its base, EX for a station"))
    }

    fn axis_letters(&self) -> &'static str {
        self.variable.kind.letters()
    }

    /// Content of the variable; `None` if the variable is undefined.
    async fn read(&self, link: &mut Link) -> Result<Option<Value>> {
        match link.ask_optional(&ReadVariable::new(self.variable.kind, self.variable.number)).await? {
            Ok(value) => Ok(Some(value)),
            Err(refusal) if is_undefined(&ReadError::Refused(refusal)) => Ok(None),
            Err(refusal) => Err(refusal_failure(refusal)),
        }
    }

    /// Coordinates to store: the requested coordinates. Without a request, the type that the variable has, or pulses if
    /// the variable is undefined.
    fn coordinates(&self, old: Option<&Value>) -> Result<Coordinates> {
        match (self.coordinates, old.map(as_position).map(|old| old.kind)) {
            (Some(stored), _) => Ok(stored.into()),
            (None, None | Some(PositionKind::Pulse)) => Ok(Coordinates::Pulse),
            (None, Some(PositionKind::Base)) => Ok(Coordinates::Base),
            (None, Some(_)) => {
                let text = old.and_then(PositionData::of).map(|data| data.text().to_owned()).unwrap_or_default();
                let message =
                    format!("{} contains {text}, but armctl stores only pulses or base coordinates", self.variable);
                Err(Failure::usage(message)
                    .hint("add --coordinates pulse or --coordinates base to change the type of the variable"))
            }
        }
    }

    /// Text of the confirmation.
    fn change(&self, link: &Link, group: Group, called: &str, old: Option<&Value>, here: &Position) -> Change {
        let Some(old) = old.map(as_position) else { return Change::none() };
        let per_degree = link.pulses_per_degree(group);
        let change = Change::new(format!("overwrite {called} with the position of {group}"));
        if old.kind != here.kind {
            let shown =
                |position| PositionData::of(&stored_position(group, position)).map(|data| data.text().to_owned());
            return change.replaces(
                &self.variable.to_string(),
                &shown(old).unwrap_or_default(),
                &shown(*here).unwrap_or_default(),
            );
        }
        let change = compared(change, group, &old, here.axes.as_slice(), per_degree);
        [("tool", old.tool, here.tool), ("user", old.user, here.user)]
            .into_iter()
            .filter(|(_, old, new)| old != new)
            .fold(change, |change, (what, old, new)| change.replaces(what, &old.to_string(), &new.to_string()))
    }

    /// In a dry run, records what follows the first read.
    async fn plan(&self, link: &mut Link, group: Group) -> Result<Failure> {
        let model = link.model_for(|model| ReadPosition::new(model, group, Coordinates::Pulse)).await?;
        let asked = |coordinates| ReadPosition::new(model, group, coordinates).map_err(usage);
        let coordinates = self.coordinates.map_or(Coordinates::Pulse, Coordinates::from);
        let single_group = asked(coordinates)?;
        // Only robot positions can be stored in a type other than pulses.
        let is_robot = matches!(group, Group::Robot(_));
        let is_open = self.coordinates.is_none() && is_robot;
        let other = if is_open { asked(Coordinates::Base)? } else { single_group };
        let reason = Reason::about("current position");
        let reason = if is_open { reason.depending_on("the content of the variable") } else { reason };
        link.plan_depending(&single_group.request(), &other.request(), reason);
        link.plan_existing_axes(group, coordinates);
        let [one, other] = different_words()
            .map(|position| Position { kind: if is_robot { position.kind } else { PositionKind::Pulse }, ..position });
        let write =
            |position| WriteVariable::new(self.variable.number, stored_position(group, position)).map_err(usage);
        let reason = Reason::about("stores it")
            .depending_on("the current position, and whether the variable already contains this position");
        link.plan_depending(&write(one)?.request(), &write(other)?.request(), reason);
        let query = ReadVariable::new(self.variable.kind, self.variable.number);
        link.plan_if(
            &query.request(),
            Reason::about("content of the variable after the write").depending_on("whether the position was written"),
        );
        Ok(unknown())
    }
}
