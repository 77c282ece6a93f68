//! Moves to the position in a variable (`--to P2`), and to axis angles in degrees (`--deg`).

use super::arguments::{Destination, Speed, Values};
use super::execution::{Execution, Goal, MotionReport, plan_looks};
use super::question::Question;
use super::{Target, cartesian_move, describe_path, unnamed_base_axes};
use crate::failure::refusal_failure;
use crate::item_requests::ReadError;
use crate::position;
use crate::prelude::*;
use crate::var::{different_words, is_undefined, variable_name};
use armctl_controller::units;
use armctl_controller::yerc::payload::{Axes, ExtendedForm, ExternalPosition, Form, MAX_AXES, PulseMove};
use armctl_controller::yerc::query::{
    Coordinates, MoveCartesian, MoveKind, MovePulse, Query, ReadPosition, ReadVariable,
};
use armctl_controller::yerc::variables::{Reference, Value, VariableKind};

/// A move to a position in a variable or to axis angles.
pub(super) struct Motion<'a> {
    pub(super) target: &'a Target,
    pub(super) kind: MoveKind,
    pub(super) speed: Speed,
}

impl Motion<'_> {
    /// Reads the target, asks the user to confirm, and starts the motion.
    pub(super) async fn run(&self, context: Context<'_, Yerc>, destination: &Destination) -> Result<MotionReport> {
        let link = &mut *context.link;
        let (name, value) = match destination {
            Destination::Degrees(degrees) => {
                self.target.refuse_extra_flags("--deg", self.target.frame.user.is_some())?;
                (None, Value::Position(self.rotated_axis(link, degrees)?))
            }
            Destination::Variable(variable) => {
                let has_frame = self.target.frame.tool.is_some() || self.target.frame.user.is_some();
                self.target.refuse_extra_flags(&format!("--to {variable}"), has_frame)?;
                let group = self.target.mover.group;
                is_suitable(*variable, group)?;
                match read(link, *variable).await.known()? {
                    Some(value) => (Some(*variable), value),
                    None => return Err(self.plan(link, *variable).await?),
                }
            }
        };
        let per_degree = context.link.pulses_per_degree(self.target.mover.group).to_vec();
        let target = position::has_taught_axes(self.target.mover.group, &value, &per_degree);
        let label = name.map(|variable| variable_name(names::of_robot(context.robot, context.screen), variable));
        let mut report = match value {
            Value::Position(position) if position.kind.is_cartesian() => {
                let question = self.question(label.as_deref(), &value);
                self.cartesian(context.link, position, name).await?.run(context, &question).await?
            }
            _ => {
                let question = self.question(label.as_deref(), &value);
                self.pulses(context.link, &value, name).await?.run(context, &question).await?
            }
        };
        report.leads_to(name.map(|name| name.to_string()), target);
        Ok(report)
    }

    fn question(&self, name: Option<&str>, value: &Value) -> Question<'static> {
        let (kind, how, robot, station) = match value {
            Value::Position(position) => {
                let Position { kind, tool, user, form, extended, .. } = *position;
                let how = match kind {
                    PositionKind::Pulse => format!("in pulses, tool {tool},"),
                    PositionKind::User => format!("in user coordinates {user}, tool {tool},"),
                    kind => format!("in {} coordinates, tool {tool},", word(kind)),
                };
                let forms = position::form_words(form);
                let more = position::extended_words(extended);
                let plus = if more.is_empty() { "" } else { "+" };
                let how = if kind == PositionKind::Pulse { how } else { format!("{how} form {forms}{plus}{more}") };
                (kind, how, Some(position.axes.padded()[..position.shown_axes()].to_vec()), None)
            }
            Value::External(ExternalPosition { axes, .. }) => {
                (PositionKind::Pulse, "in pulses".to_owned(), None, Some(Values(axes.as_slice().to_vec())))
            }
            _ => (PositionKind::Pulse, String::new(), None, None),
        };
        let to = name.map(|name| format!(" to {name}")).unwrap_or_default();
        Question {
            what: format!("move {} {}{to}", self.target.mover.group, describe_path(self.kind)),
            preposition: "to",
            kind,
            manner: how,
            robot,
            base: (None, units::PULSE),
            station: station.map(std::borrow::Cow::Owned),
            speed: self.speed,
        }
    }

    async fn pulses(&self, link: &mut Link, value: &Value, name: Option<Reference>) -> Result<Execution<MovePulse>> {
        let group = self.target.mover.group;
        let (robot, station) = self.target.mover.words();
        let mut order = PulseMove {
            robot,
            station,
            class: self.speed.class,
            speed: self.speed.word,
            axes: [0; 8],
            tool: 0,
            base: [0; 3],
            station_axes: [0; 6],
        };
        let (axes, unnamed) = match value {
            Value::Position(position) if position.kind == PositionKind::Pulse => {
                (order.axes, order.tool) = (position.axes.padded(), position.tool);
                (position.axes, unnamed_base_axes(group, None))
            }
            Value::External(external) if external.kind == PositionKind::Pulse => {
                let [first @ .., seventh, eighth] = external.axes.padded();
                if (seventh, eighth) != (0, 0) {
                    return Err(unsuitable_target(
                        name,
                        "the position has more axes than a move of a station supports",
                    ));
                }
                order.station_axes = first;
                (external.axes, Vec::new())
            }
            _ => {
                return Err(unsuitable_target(
                    name,
                    "the type of the position is neither pulses nor coordinates of the manual",
                ));
            }
        };
        let order = link.by_model(|model| MovePulse::new(model, self.kind, order)).await?;
        let goal = Goal::Pulses(axes.as_slice().to_vec());
        Ok(Execution { order, group, goal, unnamed, no_wait: self.target.mover.end.no_wait() })
    }

    async fn cartesian(
        &self,
        link: &mut Link,
        position: Position,
        name: Option<Reference>,
    ) -> Result<Execution<MoveCartesian>> {
        let group = self.target.mover.group;
        let [x, y, z, rx, ry, rz, re, eighth] = position.axes.padded();
        if (re, eighth) != (0, 0) {
            return Err(unsuitable_target(
                name,
                "a move to coordinates does not support the seventh axis of the position",
            )
            .hint("teach the position in pulses, which support all axes"));
        }
        let target = [x, y, z, rx, ry, rz];
        let mut order = cartesian_move(link, &self.target.mover, self.speed, &self.target.frame);
        order.coordinate = position.kind;
        (order.target, order.form, order.extended) = (target, position.form, position.extended);
        // The user coordinate number applies only to user coordinates. Other moves need the number 0.
        (order.tool, order.user) = (position.tool, if position.kind == PositionKind::User { position.user } else { 0 });
        let model = link.model_for(|model| MoveCartesian::new(model, self.kind, order)).await?;
        let order = MoveCartesian::new(model, self.kind, order).map_err(|error| {
            let why = error.to_string();
            unsuitable_target(name, &format!("a move does not support the position: {why}"))
                .hint("teach the position in pulses, which support all axes")
        })?;
        let goal = match position.kind {
            PositionKind::Base => Goal::Base(target, position.tool),
            _ => Goal::Unknown(Coordinates::Base),
        };
        Ok(Execution {
            order,
            group,
            goal,
            unnamed: unnamed_base_axes(group, None),
            no_wait: self.target.mover.end.no_wait(),
        })
    }

    /// Converts degrees to pulses with the pulses per degree in the inventory.
    fn rotated_axis(&self, link: &Link, degrees: &[f64]) -> Result<Position> {
        let group = self.target.mover.group;
        let per_degree = link.pulses_per_degree(group);
        if per_degree.len() < degrees.len() {
            let known = per_degree.len();
            let message =
                format!("pulses_per_degree is known for {known} axes of {group}, but --deg has {}", degrees.len());
            return Err(Failure::usage(message).hint(
                "set pulses_per_degree = [S, L, U, R, B, T] for R1 in robots.toml; the pendant shows pulses and \
                 degrees",
            ));
        }
        let pulses = degrees.iter().zip(per_degree).map(|(degrees, per_degree)| rounded(degrees * per_degree));
        let too_far =
            || Failure::usage("--deg: the number of pulses is too large for an axis").hint("check pulses_per_degree");
        let pulses: Vec<i32> = pulses.collect::<Option<_>>().ok_or_else(too_far)?;
        let mut words = [0; MAX_AXES];
        words.iter_mut().zip(&pulses).for_each(|(word, pulses)| *word = *pulses);
        Ok(Position {
            kind: PositionKind::Pulse,
            form: Form(0),
            tool: self.target.frame.tool.unwrap_or(0),
            user: 0,
            extended: ExtendedForm(0),
            axes: Axes::new(&pulses).unwrap_or_else(|| Axes::full(words)),
        })
    }

    /// In a dry run, records what follows. The kind of move is unknown.
    async fn plan(&self, link: &mut Link, variable: Reference) -> Result<Failure> {
        let group = self.target.mover.group;
        let model = link.model_for(|model| ReadPosition::new(model, group, Coordinates::Pulse)).await?;
        if let Group::Robot(number) = group {
            let base = ReadPosition::new(model, Group::Base(number), Coordinates::Pulse).map_err(usage)?;
            link.plan(&base.request(), "current position of the axes without a target");
        }
        let reason = Reason::about("current position").depending_on("whether the variable contains pulses");
        let pulse = ReadPosition::new(model, group, Coordinates::Pulse).map_err(usage)?;
        let base = ReadPosition::new(model, group, Coordinates::Base).unwrap_or(pulse);
        link.plan_depending(&pulse.request(), &base.request(), reason);
        link.plan_existing_axes(group, Coordinates::Pulse);
        let holds = format!("starts the motion, if {variable} contains");
        let [one, other] = different_words();
        let (robot, station) = self.target.mover.words();
        let pulses = |word: i32| PulseMove {
            robot,
            station,
            class: self.speed.class,
            speed: self.speed.word,
            axes: if robot == 0 { [0; 8] } else { [word; 8] },
            tool: if robot == 0 { 0 } else { word.unsigned_abs() },
            base: [0; 3],
            station_axes: if robot == 0 { [word; 6] } else { [0; 6] },
        };
        let order = |word| MovePulse::new(model, self.kind, pulses(word)).map_err(usage);
        let (first, second) = (order(0)?, order(-1)?);
        let about = format!("{holds} pulses");
        link.plan_depending(&first.request(), &second.request(), Reason::about(&about).depending_on("its content"));
        if robot != 0 {
            let coordinates = |position: Position, kind, flag: u32| {
                let mut order = cartesian_move(link, &self.target.mover, self.speed, &self.target.frame);
                (order.coordinate, order.target) = (kind, [position.axes.padded()[0]; 6]);
                (order.form, order.extended) = (Form(flag), ExtendedForm(flag));
                (order.tool, order.user) = (flag, flag);
                MoveCartesian::new(model, self.kind, order).map_err(usage)
            };
            let first = coordinates(one, PositionKind::Base, 0)?;
            let second = coordinates(other, PositionKind::User, 1)?;
            let about = format!("{holds} coordinates");
            let reason = Reason::about(&about).depending_on("its content");
            link.plan_depending(&first.request(), &second.request(), reason);
        }
        if !self.target.mover.end.no_wait() {
            plan_looks(link, group, Coordinates::Pulse).await?;
        }
        Ok(unknown())
    }
}

/// Content of a variable. The variable must be defined.
async fn read(link: &mut Link, variable: Reference) -> Result<Value> {
    let question = ReadVariable::new(variable.kind, variable.number);
    match link.for_purpose("target position").ask_optional(&question).await? {
        Ok(value) => Ok(value),
        Err(refusal) if is_undefined(&ReadError::Refused(refusal)) => {
            let message = format!("{variable} was never taught; no motion command was sent");
            Err(Failure { message, ..refusal_failure(refusal) }
                .hint(format!("use `yerc teach {variable}` to store the current position")))
        }
        Err(refusal) => Err(refusal_failure(refusal)),
    }
}

/// Rejects a variable that belongs to another kind of group.
fn is_suitable(variable: Reference, group: Group) -> Result<()> {
    let is_right = match group {
        Group::Robot(_) => variable.kind == VariableKind::P,
        Group::Station(_) => variable.kind == VariableKind::Ex,
        Group::Base(_) => false,
    };
    if is_right {
        return Ok(());
    }
    let message = format!("{variable} is not a position for {group}");
    Err(Failure::usage(message)
        .hint("use P for a robot and EX for a station (--group S1); a base moves with its robot"))
}

fn unsuitable_target(name: Option<Reference>, why: &str) -> Failure {
    let name = name.map_or_else(|| "this".to_owned(), |name| name.to_string());
    Failure::new(Kind::Usage, format!("{name} is not a valid target: {why}; no motion command was sent"))
}

/// Name of a coordinate system.
fn word(kind: PositionKind) -> &'static str {
    PositionKind::ALL.iter().find(|row| row.0 == kind).map_or("other", |row| row.2)
}

/// Rounds to a whole number of pulses; `None` if the number does not fit.
fn rounded(pulses: f64) -> Option<i32> {
    let text = format!("{pulses:.0}");
    text.parse().ok()
}
