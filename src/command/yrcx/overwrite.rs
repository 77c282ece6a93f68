//! Commands that overwrite stored or taught data: read the old data, confirm old and new, then write.

use std::time::Duration;

use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Value as Json, json};

use super::before::{before, question};
use super::link::Link;
use super::position::{Unit, position};
use super::refusal::refused;
use super::several::{check_echo, is_about_commands};
use crate::client::yrcx;
use crate::command::frame::authority::Authority;
use crate::command::frame::dry_run::Reason;
use crate::command::frame::settings_report::Old;
use crate::command::robot::item::{Item, Written, WrittenItems};
use crate::controller::Risk;
use crate::controller::yrcx::order::{Draft, Order};
use crate::controller::yrcx::table::Command;
use crate::controller::yrcx::table::parameter::Parameter;
use crate::controller::yrcx::value::{Key, Value, Values};
use crate::failure::Failure;
use crate::gate::{Change, Confirmation};

/// Result of a command.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Done {
    /// Values of the answer.
    pub values: Values,
    /// Time from the first transmission of the command to its end.
    pub elapsed: Duration,
    /// Overwritten data, if any.
    pub replaced: Option<Replaced>,
    /// Old value, for a command that sets one.
    pub old: Old,
}

impl From<yrcx::Done> for Done {
    fn from(yrcx::Done { values, elapsed }: yrcx::Done) -> Self {
        Self { values, elapsed, replaced: None, old: Old::UNREAD }
    }
}

/// Overwritten data and its replacement.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Replaced {
    /// `point 7`.
    what: String,
    /// Old data; none if not defined.
    old: Option<String>,
    /// New data, as far as known in advance.
    new: String,
    /// Old and new as JSON, null if unknown.
    data: [Json; 2],
    which: Which,
    /// Whether old and new are equal, so that no write is necessary.
    is_there: bool,
}

/// Overwritten item: kind, name, and owner of a parameter.
#[derive(Debug, Clone, Default, PartialEq)]
struct Which {
    kind: &'static str,
    name: String,
    of: OfAxis,
}

/// Kind of confirmation for a remote command.
pub fn confirmation(command: Command) -> Confirmation {
    match (command, command.row().risk) {
        (Command::AbsoluteReset, _) => Confirmation::Word("reset"),
        (Command::ServoOn | Command::ServoOff | Command::ServoFree, _) | (_, Risk::Destroy) => Confirmation::WhenKnown,
        (_, Risk::Read | Risk::Write | Risk::Motion) => Confirmation::Question,
    }
}

/// Executes a command after reading the data that it replaces; `intent` describes it in one line. Overwriting needs a
/// confirmation. Equal data is not written.
pub async fn give(link: &mut Link, authority: &Authority<'_>, order: &Order, intent: String) -> Result<Done, Failure> {
    if target(order).is_none() {
        // While a person is asked, the robot is not reserved.
        if !authority.asks() {
            link.reserve(order).await?;
        }
        let old = before(link, order).await?;
        authority.confirm(&question(order, intent, &old)).await?;
        return Ok(Done { old, ..link.ask(order).await? });
    }
    give_either(link, authority, order, order).await
}

/// Executes an overwriting command; `other` is the same command for another answer, to show the known part of it in a
/// dry run.
pub async fn give_either(
    link: &mut Link,
    authority: &Authority<'_>,
    order: &Order,
    other: &Order,
) -> Result<Done, Failure> {
    let replaced = confirm(link, authority, order).await?;
    if replaced.is_there {
        return Ok(Done { replaced: Some(replaced), ..Done::default() });
    }
    if link.is_dry() {
        let reason = match order.command() {
            _ if order != other => Reason::about("stores it").depending_on("the unit of the point"),
            command if may_be_there(command) => Reason::default().depending_on(DIFFERS),
            _ => Reason::default(),
        };
        link.plan_depending(order, other, reason);
        return Ok(Done::default());
    }
    let done = link.ask(order).await?;
    Ok(Done { replaced: Some(replaced), ..done })
}

const DIFFERS: &str = "the current data: sent if different";

/// Whether the new data can equal the old data.
fn may_be_there(command: Command) -> bool {
    // The position may change before it is stored.
    !matches!(command, Command::Teach | Command::PointPallet)
}

/// Reads the data that a command overwrites, and asks for confirmation. A dry run notes the reads.
pub async fn confirm(link: &mut Link, authority: &Authority<'_>, order: &Order) -> Result<Replaced, Failure> {
    let Some((noun, what, read)) = target(order) else {
        authority.confirm(&Change::new(order.row().name)).await?;
        return Ok(Replaced { what: order.row().id.to_owned(), ..Replaced::default() });
    };
    let old = there(link, &read.build()?, &format!("{what}, which is overwritten")).await?;
    let old = old.filter(|values| is_defined(order.command(), values));
    let (new, is_same) = wanted(link, order, old.as_ref()).await?;
    let before = old.as_ref().map_or(Json::Null, |values| data(order.command(), values));
    let old = old.map(|values| describe(order.command(), &values));
    let (new, after) = new;
    let change = match &old {
        Some(old) if !is_same => Change::new(format!("overwrite {noun}")).replaces(&what, old, &new),
        _ => Change::none(),
    };
    authority.confirm(&change).await?;
    let data = [before, after];
    let which = which(order);
    Ok(Replaced { what, old, new, data, which, is_there: is_same && may_be_there(order.command()) })
}

/// Item that a command overwrites: kind, name, and its read command.
fn target(order: &Order) -> Option<(&'static str, String, Draft)> {
    let values = order.values();
    let number = |key| values.int(key).unwrap_or_default();
    let of = |command: Command, key| command.order().with(key, number(key));
    Some(match order.command() {
        Command::Teach
        | Command::PointSet
        | Command::PointCopy
        | Command::PointAdd
        | Command::PointSub
        | Command::PointPallet
        | Command::PointElementPulse
        | Command::PointElementMm => {
            ("a point", format!("point {}", number(Key::Point)), of(Command::PointGet, Key::Point))
        }
        Command::CommentSet => {
            let what = format!("comment of point {}", number(Key::Point));
            ("the comment of a point", what, of(Command::CommentGet, Key::Point))
        }
        Command::PalletSet => {
            ("a pallet", format!("pallet {}", number(Key::Pallet)), of(Command::PalletGet, Key::Pallet))
        }
        Command::ShiftSet | Command::ShiftElement => {
            ("a shift", format!("shift {}", number(Key::Shift)), of(Command::ShiftGet, Key::Shift))
        }
        Command::HandSet => ("a hand", format!("hand {}", number(Key::Hand)), of(Command::HandGet, Key::Hand)),
        Command::ParamSet => {
            let name = Parameter::from_number(number(Key::Parameter)).map_or("a parameter", |parameter| parameter.name);
            let axis = number(Key::Axes);
            let axis = if axis == 0 { String::new() } else { format!(" of axis {}", axis.trailing_zeros() + 1) };
            let what = format!("{name}{axis}, robot {}", number(Key::Robot).max(1));
            let read = [Key::Robot, Key::Parameter, Key::Axes].into_iter();
            let read = read.fold(Command::ParamGet.order(), |draft, key| match values.value(key) {
                Some(value) => draft.with(key, value.clone()),
                None => draft,
            });
            ("a parameter", what, read)
        }
        _ => return None,
    })
}

/// Item that a command overwrites, as JSON.
fn which(order: &Order) -> Which {
    let values = order.values();
    let number = |key| values.int(key).unwrap_or_default();
    let (kind, key) = match order.command() {
        Command::CommentSet => ("comment of point", Key::Point),
        Command::PalletSet => ("pallet", Key::Pallet),
        Command::ShiftSet | Command::ShiftElement => ("shift", Key::Shift),
        Command::HandSet => ("hand", Key::Hand),
        Command::ParamSet => {
            let name = Parameter::from_number(number(Key::Parameter)).map_or("parameter", |parameter| parameter.name);
            let axis = Some(number(Key::Axes)).filter(|axis| *axis != 0);
            let axis = axis.and_then(|axis| i32::try_from(axis.trailing_zeros() + 1).ok());
            let of = OfAxis { robot: Some(number(Key::Robot).max(1)), axis };
            return Which { kind: "parameter", name: name.to_owned(), of };
        }
        _ => ("point", Key::Point),
    };
    Which { kind, name: number(key).to_string(), of: OfAxis::default() }
}

/// Reads current data; none if the controller refuses, for example because it is not defined.
pub(super) async fn there(link: &mut Link, order: &Order, about: &str) -> Result<Option<Values>, Failure> {
    if link.is_dry() {
        link.plan(order, about);
        return Ok(None);
    }
    match link.try_ask(order).await? {
        Ok(done) => check_echo(order, &done.values).map(|()| Some(done.values)),
        Err(refusal) if is_about_commands(refusal.alarm) => Err(refused(order.row(), refusal.alarm)),
        Err(_) => Ok(None),
    }
}

/// Whether data is defined.
fn is_defined(command: Command, values: &Values) -> bool {
    match command {
        Command::CommentSet => values.text(Key::Comment).is_some_and(|text| !text.is_empty()),
        Command::PalletSet => [Key::CountX, Key::CountY, Key::CountZ].iter().all(|key| values.int(*key) != Some(0)),
        Command::HandSet => values.int(Key::Owner) != Some(0),
        _ => true,
    }
}

/// New data as text and JSON, and whether it equals the old data.
async fn wanted(link: &mut Link, order: &Order, old: Option<&Values>) -> Result<((String, Json), bool), Failure> {
    let (command, values) = (order.command(), order.values());
    let number = |key| values.int(key).unwrap_or_default();
    let new = match command {
        Command::Teach => {
            let is_mm = number(Key::Unit) == 1;
            let read = if is_mm { Command::PositionMm } else { Command::PositionPulse };
            let read = read.order().with(Key::Robot, number(Key::Robot)).build()?;
            let place = there(link, &read, "current position, which is stored").await?;
            place.map_or(Err("the current position".to_owned()), |mut place| {
                place.set(Key::Unit, i32::from(is_mm));
                Ok(place)
            })
        }
        Command::PointCopy | Command::PointAdd | Command::PointSub => {
            let source = Command::PointGet.order().with(Key::Point, number(Key::Point2)).build()?;
            let about = format!("point {}, a source of the calculation", number(Key::Point2));
            let source = there(link, &source, &about).await?;
            computed(command, (number(Key::Point), old), (number(Key::Point2), source.as_ref()))
        }
        Command::PointPallet => {
            Err(format!("position {} of pallet {}", number(Key::WorkPosition), number(Key::Pallet)))
        }
        Command::PointElementPulse | Command::PointElementMm | Command::ShiftElement => element(command, values, old),
        _ => Ok(values.clone()),
    };
    Ok(match new {
        Ok(new) => {
            let is_same = old.is_some_and(|old| is_same(command, old, &new));
            ((describe(command, &new), data(command, &new)), is_same)
        }
        Err(words) => ((words, Json::Null), false),
    })
}

/// Point that the controller computes from two points; a text if it is unknown.
fn computed(
    command: Command,
    (number, old): (i32, Option<&Values>),
    (other, source): (i32, Option<&Values>),
) -> Result<Values, String> {
    let sign = match command {
        Command::PointCopy => return source.cloned().ok_or_else(|| format!("point {other}")),
        Command::PointAdd => 1,
        _ => -1,
    };
    let words = || format!("point {number} {} point {other}", if sign > 0 { "+" } else { "-" });
    let (old, source) = old.zip(source).ok_or_else(words)?;
    if old.int(Key::Unit) != source.int(Key::Unit) {
        return Err(words());
    }
    let mut new = old.clone();
    for key in Key::AXES {
        let axis = |values: &Values| values.int(key).unwrap_or_default();
        new.set(key, axis(old).saturating_add(sign * axis(source)));
    }
    Ok(new)
}

/// Point or shift with one changed element; a text if the element cannot be read.
fn element(command: Command, values: &Values, old: Option<&Values>) -> Result<Values, String> {
    let number = values.int(Key::Element).unwrap_or_default().trailing_zeros();
    let value = values.int(Key::Value).unwrap_or_default();
    let is_mm = command != Command::PointElementPulse;
    let words = || {
        let (value, unit) = if is_mm { (mm(value), Unit::Mm) } else { (value.to_string(), Unit::Pulse) };
        format!("element {} = {value} {}", number + 1, unit.symbol())
    };
    let key = usize::try_from(number).ok().and_then(|at| Key::AXES.get(at)).ok_or_else(words)?;
    let old = old.ok_or_else(words)?;
    if command != Command::ShiftElement && (old.int(Key::Unit) == Some(1)) != is_mm {
        return Err(words());
    }
    let mut new = old.clone();
    new.set(*key, value);
    Ok(new)
}

/// Fields that define a point.
const POINT: [Key; 6] = [Key::Unit, Key::HandSystem, Key::Axis1, Key::Axis2, Key::Axis3, Key::Axis4];
const HAND: [Key; 4] = [Key::Data1, Key::Data2, Key::Data3, Key::Data4];

/// Whether old and new data are equal.
fn is_same(command: Command, old: &Values, new: &Values) -> bool {
    let zero = Value::Int(0);
    let has =
        |keys: &[Key]| keys.iter().all(|key| old.value(*key).unwrap_or(&zero) == new.value(*key).unwrap_or(&zero));
    match command {
        Command::CommentSet => has(&[Key::Comment]),
        Command::PalletSet => has(&[Key::CountX, Key::CountY, Key::CountZ, Key::FirstPoint]),
        Command::ShiftSet | Command::ShiftElement => has(&Key::AXES),
        Command::HandSet => has(&HAND) && owner(old) == owner(new),
        Command::ParamSet => has(&[Key::Value]),
        _ => has(&POINT),
    }
}

/// Robot that a hand belongs to.
fn owner(hand: &Values) -> i32 {
    hand.int(Key::Owner).or_else(|| hand.int(Key::Robot)).unwrap_or_default().max(1)
}

/// Text of the data that a command defines.
fn describe(command: Command, values: &Values) -> String {
    let number = |key| values.int(key).unwrap_or_default();
    match command {
        Command::CommentSet => format!("'{}'", values.text(Key::Comment).unwrap_or_default()),
        Command::PalletSet => {
            let [nx, ny, nz] = [Key::CountX, Key::CountY, Key::CountZ].map(number);
            format!("{nx} x {ny} x {nz}, first point {}", number(Key::FirstPoint))
        }
        Command::ShiftSet | Command::ShiftElement => four(values, Unit::Mm),
        Command::HandSet => {
            let place = if number(Key::Data4) == 0 { "" } else { ", on the R axis" };
            let [first, second, third] =
                [number(Key::Data1).to_string(), mm(number(Key::Data2)), mm(number(Key::Data3))];
            format!("{first}, {second} mm, {third} mm{place}, robot {}", owner(values))
        }
        Command::ParamSet => {
            let unit = Parameter::from_number(number(Key::Parameter)).map_or("", |parameter| parameter.unit);
            format!("{} {unit}", number(Key::Value)).trim_end().to_owned()
        }
        _ => {
            let unit = if number(Key::Unit) == 1 { Unit::Mm } else { Unit::Pulse };
            let hand = match number(Key::HandSystem) {
                1 => ", right-handed",
                2 => ", left-handed",
                _ => "",
            };
            format!("{}{hand}", four(values, unit))
        }
    }
}

/// Data that a command defines, in the fields of its read command.
fn data(command: Command, values: &Values) -> Json {
    let number = |key| values.int(key).unwrap_or_default();
    let mm = |key| f64::from(number(key)) / 1000.0;
    match command {
        Command::CommentSet => values.text(Key::Comment).unwrap_or_default().into(),
        Command::PalletSet => json!({
            "nx": number(Key::CountX),
            "ny": number(Key::CountY),
            "nz": number(Key::CountZ),
            "first_point": number(Key::FirstPoint),
        }),
        Command::ShiftSet | Command::ShiftElement => json!({ "shift_mm": Key::AXES.map(mm) }),
        Command::HandSet => json!({
            "robot": owner(values),
            "data_1": number(Key::Data1),
            "data_2_mm": mm(Key::Data2),
            "data_3_mm": mm(Key::Data3),
            "data_4": number(Key::Data4),
        }),
        Command::ParamSet => number(Key::Value).into(),
        _ => {
            let unit = if number(Key::Unit) == 1 { Unit::Mm } else { Unit::Pulse };
            json!(position(values, unit))
        }
    }
}

fn four(values: &Values, unit: Unit) -> String {
    let axis = |key| {
        let value = values.int(key).unwrap_or_default();
        if unit == Unit::Mm { mm(value) } else { value.to_string() }
    };
    format!("{} {}", Key::AXES.map(axis).join(", "), unit.symbol())
}

/// Steps of a position in mm.
pub fn mm(steps: i32) -> String {
    format!("{:.3}", f64::from(steps) / 1000.0)
}

/// Report of numbered data that was stored.
pub type Stored = WrittenItems<Json, OfAxis>;

/// Owner of a parameter.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, JsonSchema)]
pub struct OfAxis {
    /// Robot, 1 to 4; null unless it is a parameter.
    pub robot: Option<i32>,
    /// Axis, 1 to 4; null unless it is a parameter of an axis.
    #[serde(rename = "axis_number")]
    pub axis: Option<i32>,
}

/// Report of stored data, with the old data.
pub fn stored(words: impl Into<String>, given: &Done) -> Stored {
    let Replaced { what, new, data, which: Which { kind, name, of }, is_there, .. } =
        given.replaced.clone().unwrap_or_default();
    let [old, now] = data.map(|data| Some(data).filter(|data| !data.is_null()));
    let words = if is_there { format!("{what}: {new} already; nothing was written") } else { words.into() };
    let item = Item::with(kind, name, of, Ok(now));
    WrittenItems::describe(words, vec![Written::new(item, old, !is_there)])
}
