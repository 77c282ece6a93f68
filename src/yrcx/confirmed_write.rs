//! Commands that overwrite stored or taught data. They read the old data, ask the user to confirm old and new data,
//! then write.

use serde_json::Value as Json;

use super::command_result::{CommandResult, ReplacedRow};
use super::data::{Comments, Hands, Pallets, Points, Shifts};
use super::numbered_tables::{Kind, Numbered, Row};
use super::old_values::{question, read_old_values};
use super::param::{Amount, Parameters, Setting};
use super::position::Unit;
use super::read_requests::{check_echo, refuses_all_commands};
use super::refusal::refused;
use crate::prelude::*;
use armctl_controller::yrcx::table::Command;
use armctl_controller::yrcx::table::parameter::Parameter;
use armctl_frame::robot::item::{Item, Written, WrittenItems, as_requested};
use armctl_frame::store::{describe_change, overwriting};

/// Kind of confirmation for a remote command.
pub fn confirmation(command: Command) -> Confirmation {
    match (command, command.row().risk) {
        (Command::AbsoluteReset, _) => Confirmation::Word("reset"),
        (Command::ServoOn | Command::ServoOff | Command::ServoFree, _) | (_, Risk::Destroy) => Confirmation::WhenKnown,
        (_, Risk::Read | Risk::Write | Risk::Motion) => Confirmation::Question,
    }
}

/// Executes a command after reading the data that it replaces. `intent` describes the command in one line. The user
/// must confirm before data is overwritten. If old and new data are equal, nothing is written.
pub async fn execute_confirmed(
    link: &mut Link,
    confirmer: &Confirmer<'_>,
    order: &Order,
    intent: String,
) -> Result<CommandResult> {
    if !overwrites(order) {
        // The robot is not reserved while a question is open.
        if !confirmer.asks_user() {
            link.reserve(order).await?;
        }
        let old = read_old_values(link, order).await?;
        confirmer.confirm(&question(order, intent, &old)).await?;
        return Ok(CommandResult { old, ..link.ask(order).await? });
    }
    execute_with_alternative(link, confirmer, order, order).await
}

/// Executes a command that overwrites data. `other` is the command that would be sent after another answer; a dry run
/// shows only the words that `order` and `other` have in common.
pub async fn execute_with_alternative(
    link: &mut Link,
    confirmer: &Confirmer<'_>,
    order: &Order,
    other: &Order,
) -> Result<CommandResult> {
    let replaced = confirm(link, confirmer, order).await?;
    if replaced.is_unchanged {
        return Ok(CommandResult { replaced: Some(replaced), ..CommandResult::default() });
    }
    if link.is_dry_run() {
        let reason = match order.command() {
            _ if order != other => Reason::about("stores it").depending_on("the unit of the point"),
            command if can_compare(command) => Reason::default().depending_on(DIFFERS),
            _ => Reason::default(),
        };
        link.plan_depending(order, other, reason);
        return Ok(CommandResult::default());
    }
    let done = link.ask(order).await?;
    Ok(CommandResult { replaced: Some(replaced), ..done })
}

const DIFFERS: &str = "the current data: sent if different";

/// Whether armctl can compare the new data with the old data before it writes.
fn can_compare(command: Command) -> bool {
    // For these commands, the position may change before the controller stores it.
    !matches!(command, Command::Teach | Command::PointPallet)
}

/// Whether a command overwrites a row of a table.
fn overwrites(order: &Order) -> bool {
    order.row().risk == Risk::Destroy && order.command() != Command::AbsoluteReset
}

/// Reads the row that a command overwrites, and asks the user for confirmation. A dry run notes the reads.
pub async fn confirm(link: &mut Link, confirmer: &Confirmer<'_>, order: &Order) -> Result<ReplacedRow> {
    match order.command() {
        _ if !overwrites(order) => {
            confirmer.confirm(&Change::new(order.row().name)).await?;
            Ok(ReplacedRow::default())
        }
        Command::ParamSet => Parameters::confirm(link, confirmer, order).await,
        Command::CommentSet => Numbered::<Comments>::confirm(link, confirmer, order).await,
        Command::PalletSet => Numbered::<Pallets>::confirm(link, confirmer, order).await,
        Command::ShiftSet | Command::ShiftElement => Numbered::<Shifts>::confirm(link, confirmer, order).await,
        Command::HandSet => Numbered::<Hands>::confirm(link, confirmer, order).await,
        _ => Numbered::<Points>::confirm(link, confirmer, order).await,
    }
}

/// A table whose rows remote commands overwrite.
trait OverwritableTable: Writable<Family = Yrcx> {
    /// The table and the row that a command overwrites.
    fn target(order: &Order) -> Result<(Self, Self::Key)>;

    /// Request that reads a row.
    fn read_order(&self, key: Self::Key) -> Result<Order>;

    /// Content of a row from an answer.
    fn row(&self, key: Self::Key, values: Values) -> Self::Wire;

    /// Returns the new content of a row; a description in words if the content is not known in advance.
    async fn replacement(&self, link: &mut Link, order: &Order, old: Option<&Values>)
    -> Result<Result<Values, String>>;

    /// Reads the row that a command overwrites, and asks for confirmation.
    async fn confirm(link: &mut Link, confirmer: &Confirmer<'_>, order: &Order) -> Result<ReplacedRow> {
        let (table, key) = Self::target(order)?;
        let about = format!("old content of {}", Self::asked(key));
        let values = read_current(link, &table.read_order(key)?, &about).await?;
        let new = table.replacement(link, order, values.as_ref()).await?.map(|values| table.row(key, values));
        let old = values.map(|values| table.row(key, values)).filter(|old| !table.is_blank(old));
        let is_same = old.as_ref().zip(new.as_ref().ok()).is_some_and(|(old, new)| Self::is_equal(old, new));
        let change = match (&old, &new) {
            (Some(old), Ok(new)) => describe_change(&table, &[(key, Some(old), new)]),
            (Some(old), Err(words)) => {
                let [old, _] = table.difference(old, old);
                overwriting(&table, &[[Self::asked(key), old, words.clone()]])
            }
            (None, _) => Change::none(),
        };
        confirmer.confirm(&change).await?;
        let value = |row: Option<&Self::Wire>| row.and_then(|row| serde_json::to_value(table.value(row)?).ok());
        Ok(ReplacedRow {
            kind: Self::WORDS.nouns[0],
            name: Self::name(key),
            values: [value(old.as_ref()), value(new.as_ref().ok())],
            is_unchanged: is_same && can_compare(order.command()),
        })
    }
}

impl<K: Kind> OverwritableTable for Numbered<K> {
    fn target(order: &Order) -> Result<(Self, i32)> {
        Ok((Self::default(), order.values().int(K::READ.1).unwrap_or_default()))
    }

    fn read_order(&self, number: i32) -> Result<Order> {
        Self::read_order(number)
    }

    fn row(&self, _number: i32, values: Values) -> Row {
        Row::new::<K>(values)
    }

    async fn replacement(
        &self,
        link: &mut Link,
        order: &Order,
        old: Option<&Values>,
    ) -> Result<Result<Values, String>> {
        let (command, values) = (order.command(), order.values());
        let number = |key| values.int(key).unwrap_or_default();
        Ok(match command {
            Command::Teach => {
                let is_mm = number(Key::Unit) == 1;
                let read = if is_mm { Command::PositionMm } else { Command::PositionPulse };
                let read = read.order().with(Key::Robot, number(Key::Robot)).valid_order()?;
                let position = read_current(link, &read, "current position, which the command stores").await?;
                position.map_or(Err("the current position".to_owned()), |mut position| {
                    position.set(Key::Unit, i32::from(is_mm));
                    Ok(position)
                })
            }
            Command::PointCopy | Command::PointAdd | Command::PointSub => {
                let source = Command::PointGet.order().with(Key::Point, number(Key::Point2)).valid_order()?;
                let about = format!("point {}, a source of the calculation", number(Key::Point2));
                let source = read_current(link, &source, &about).await?;
                computed_point(command, (number(Key::Point), old), (number(Key::Point2), source.as_ref()))
            }
            Command::PointPallet => {
                Err(format!("position {} of pallet {}", number(Key::WorkPosition), number(Key::Pallet)))
            }
            Command::PointElementPulse | Command::PointElementMm | Command::ShiftElement => {
                with_changed_element(command, values, old)
            }
            _ => Ok(Self::stored(values)),
        })
    }
}

impl OverwritableTable for Parameters {
    fn target(order: &Order) -> Result<(Self, Setting)> {
        let number = |key| order.values().int(key).unwrap_or_default();
        let unknown = || Failure::usage("this parameter does not exist").hint("see `yrcx param get -h`");
        let parameter = Parameter::from_number(number(Key::Parameter)).ok_or_else(unknown)?;
        let axis = u8::try_from(number(Key::Axes).trailing_zeros() + 1).ok().filter(|_| parameter.per_axis);
        Ok((Self { robot: u8::try_from(number(Key::Robot)).unwrap_or_default() }, (parameter, axis)))
    }

    fn read_order(&self, key: Setting) -> Result<Order> {
        Self::read_order(self, key)
    }

    fn row(&self, key: Setting, values: Values) -> Amount {
        Amount::new(key, values.int(Key::Value).unwrap_or_default())
    }

    async fn replacement(
        &self,
        _link: &mut Link,
        order: &Order,
        _old: Option<&Values>,
    ) -> Result<Result<Values, String>> {
        Ok(Ok(order.values().clone()))
    }
}

/// Reads the current data; `None` in a dry run, or if the controller refuses, for example because the data is not
/// defined.
pub async fn read_current(link: &mut Link, order: &Order, about: &str) -> Result<Option<Values>> {
    if link.is_dry_run() {
        link.plan(order, about);
        return Ok(None);
    }
    match link.try_ask(order).await? {
        Ok(done) => check_echo(order, &done.values).map(|()| Some(done.values)),
        Err(refusal) if refuses_all_commands(refusal.alarm) => Err(refused(order.row(), refusal.alarm)),
        Err(_) => Ok(None),
    }
}

/// Computes the point that the controller will compute from two points; a description in words if it is unknown.
fn computed_point(
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

/// Returns a point or shift with one changed element; a description in words if the rest of the row is unknown.
fn with_changed_element(command: Command, values: &Values, old: Option<&Values>) -> Result<Values, String> {
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

/// Steps of a position in mm.
pub fn mm(steps: i32) -> String {
    format!("{:.3}", f64::from(steps) / 1000.0)
}

/// Report of a stored row.
pub type StoredReport = WrittenItems<Json>;

/// Builds the report of a stored row, with the old content.
pub fn stored(words: impl Into<String>, given: &CommandResult) -> StoredReport {
    let ReplacedRow { kind, name, values: [old, new], is_unchanged } = given.replaced.clone().unwrap_or_default();
    let words = if is_unchanged {
        format!("{} already has this content; nothing was written", as_requested(kind, &name))
    } else {
        words.into()
    };
    WrittenItems::describe(words, vec![Written::new(Item::new(kind, name, Ok(new)), old, !is_unchanged)])
}
