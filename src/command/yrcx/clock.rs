//! `yrcx clock` (4.7.13, 4.7.14, 4.8.1, 4.8.2): date and time of the controller, without a time zone.

use clap::Args;
use jiff::Zoned;
use jiff::civil::{Date, DateTime, Time};
use schemars::JsonSchema;
use serde::Serialize;

use super::link::Link;
use super::link::Yrcx;
use crate::command::frame::orders::Done;
use crate::command::{Command, Context, Report, commands};
use crate::controller::Risk;
use crate::controller::yrcx::order::Order;
use crate::controller::yrcx::table;
use crate::controller::yrcx::value::{Key, Values};
use crate::failure::{Failure, Kind};
use crate::output::view::View;

commands! {
    /// What can be done with the controller's clock.
    pub enum Clock {
        /// Read date and time
        Get(Get),
        /// Set date and time: now, 2026-03-01T08:45:00, 2026-03-01 or 08:45
        Set(Set),
    }
}

const DATE: [Key; 3] = [Key::Year, Key::Month, Key::Day];
const TIME: [Key; 3] = [Key::Hour, Key::Minute, Key::Second];
/// The controller keeps two digits of the year.
const CENTURY: i16 = 2000;

/// Reads date and time of the controller.
#[derive(Debug, Args)]
pub struct Get {}

impl Command for Get {
    type Family = Yrcx;
    type Report = Reading;
    const ID: &'static str = "yrcx.clock.get";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Reading, Failure> {
        let link = context.link;
        let date = link.draft(table::Command::DateGet)?.build()?;
        let time = link.draft(table::Command::TimeGet)?.build()?;
        link.dry_run(&[date.clone(), time.clone()])?;
        let mut day = date_of(&link.run(&date).await?.values)?;
        let moment = time_of(&link.run(&time).await?.values)?;
        // Midnight may have come between the two.
        if moment.hour() == 0 && moment.minute() == 0 {
            day = date_of(&link.run(&date).await?.values)?;
        }
        let now = Zoned::now().datetime();
        Ok(Reading::of(day.to_datetime(moment), now))
    }
}

fn date_of(values: &Values) -> Result<Date, Failure> {
    let [year, month, day] = DATE.map(|key| values.int(key).and_then(|number| i8::try_from(number).ok()).unwrap_or(-1));
    let date = if year < 0 { None } else { Date::new(CENTURY + i16::from(year), month, day).ok() };
    date.ok_or_else(|| malformed(format!("the controller tells a date that does not exist: {year}-{month}-{day}")))
}

fn time_of(values: &Values) -> Result<Time, Failure> {
    let [hour, minute, second] =
        TIME.map(|key| values.int(key).and_then(|number| i8::try_from(number).ok()).unwrap_or(-1));
    let time = Time::new(hour, minute, second, 0);
    time.map_err(|_| malformed(format!("the controller tells a time that does not exist: {hour}:{minute}:{second}")))
}

fn malformed(message: String) -> Failure {
    Failure::new(Kind::Malformed, message).hint("`yrcx clock set now` sets its clock")
}

/// What the clock shows.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Reading {
    /// Local time of the controller, as in `2026-03-01T08:45:00`.
    time: String,
    /// By how much the clock is ahead of this machine's; negative if it is behind.
    ahead_s: i64,
}

impl Reading {
    fn of(time: DateTime, now: DateTime) -> Self {
        Self { time: time.to_string(), ahead_s: time.duration_since(now).as_secs() }
    }
}

impl Report for Reading {
    fn view(&self) -> View {
        let difference = match self.ahead_s {
            0 => "that of this machine".to_owned(),
            ahead @ 1.. => format!("{} ahead of this machine", in_words(ahead.unsigned_abs())),
            behind => format!("{} behind this machine", in_words(behind.unsigned_abs())),
        };
        View::fields([("clock", self.time.replacen('T', " ", 1).into()), ("compared", difference.into())])
    }
}

/// `3 s`, `1:02:03`, `252 days 1:02:03`.
fn in_words(seconds: u64) -> String {
    let (days, hours, minutes) = (seconds / 86_400, seconds / 3600 % 24, seconds / 60 % 60);
    match (days, hours, minutes) {
        (0, 0, 0) => format!("{seconds} s"),
        (0, ..) => format!("{hours}:{minutes:02}:{:02}", seconds % 60),
        _ => format!("{days} days {hours}:{minutes:02}:{:02}", seconds % 60),
    }
}

/// Sets date and time of the controller, or one of them.
#[derive(Debug, Args)]
#[command(after_help = "The controller keeps local time, and the years 2000 to 2099.")]
pub struct Set {
    /// now, or a date, a time or both: 2026-03-01T08:45:00, 2026-03-01, 08:45
    #[arg(value_name = "TIME", value_parser = moment)]
    moment: Moment,
}

/// What to set the clock to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Moment {
    Now,
    Given { date: Option<Date>, time: Option<Time> },
}

fn moment(text: &str) -> Result<Moment, String> {
    if text == "now" {
        return Ok(Moment::Now);
    }
    let (date, time) = match text.split_once(['T', ' ']) {
        Some((date, time)) => (Some(date), Some(time)),
        None if text.contains(':') => (None, Some(text)),
        None => (Some(text), None),
    };
    let moment = Moment::Given { date: date.map(parse_date).transpose()?, time: time.map(parse_time).transpose()? };
    Ok(moment)
}

fn parse_date(text: &str) -> Result<Date, String> {
    let pieces: Vec<&str> = text.split('-').collect();
    let date = match pieces[..] {
        [year, month, day] => (|| Date::new(digits(year, 4)?, digits(month, 2)?, digits(day, 2)?).ok())(),
        _ => None,
    };
    let date = date.ok_or_else(|| format!("'{text}' is no date such as 2026-03-01"))?;
    match date.year() - CENTURY {
        0..=99 => Ok(date),
        _ => Err("the controller keeps the years 2000 to 2099".to_owned()),
    }
}

fn parse_time(text: &str) -> Result<Time, String> {
    let pieces: Vec<&str> = text.split(':').collect();
    let time = match pieces[..] {
        [hour, minute] => (|| Time::new(digits(hour, 2)?, digits(minute, 2)?, 0, 0).ok())(),
        [hour, minute, second] => (|| Time::new(digits(hour, 2)?, digits(minute, 2)?, digits(second, 2)?, 0).ok())(),
        _ => None,
    };
    time.ok_or_else(|| format!("'{text}' is no time such as 08:45 or 08:45:00"))
}

/// A number of so many digits.
fn digits<N: std::str::FromStr>(text: &str, count: usize) -> Option<N> {
    let fits = text.len() == count && text.bytes().all(|byte| byte.is_ascii_digit());
    text.parse().ok().filter(|_| fits)
}

impl Command for Set {
    type Family = Yrcx;
    type Report = Done;
    const ID: &'static str = "yrcx.clock.set";

    fn risk(&self) -> Risk {
        Risk::Write
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Done, Failure> {
        let link = context.link;
        let (date, time) = match self.moment {
            Moment::Given { date, time } => (date, time),
            Moment::Now => (None, Some(Zoned::now().time())),
        };
        // The time goes first: the clock must not pass midnight by its old time with the new date.
        if let Some(time) = time {
            let order = time_order(link, time)?;
            link.run(&order).await?;
        }
        let date = if self.moment == Moment::Now { Some(Zoned::now().date()) } else { date };
        if let Some(date) = date {
            let order = date_order(link, date)?;
            link.run(&order).await.map_err(|failure| match time {
                Some(_) => {
                    Failure { message: format!("the time is set, but not the date: {}", failure.message), ..failure }
                }
                None => failure,
            })?;
        }
        let date = date.map(|date| date.to_string());
        let time = time.map(|time| time.strftime("%H:%M:%S").to_string());
        let told: Vec<String> = date.into_iter().chain(time).collect();
        Ok(Done::new(format!("the controller's clock is set to {}", told.join(" "))))
    }
}

fn date_order(link: &Link, date: Date) -> Result<Order, Failure> {
    let numbers = [i32::from(date.year() - CENTURY), i32::from(date.month()), i32::from(date.day())];
    let draft = link.draft(table::Command::DateSet)?;
    Ok(DATE.into_iter().zip(numbers).fold(draft, |draft, (key, number)| draft.with(key, number)).build()?)
}

fn time_order(link: &Link, time: Time) -> Result<Order, Failure> {
    let numbers = [time.hour(), time.minute(), time.second()].map(i32::from);
    let draft = link.draft(table::Command::TimeSet)?;
    Ok(TIME.into_iter().zip(numbers).fold(draft, |draft, (key, number)| draft.with(key, number)).build()?)
}

#[cfg(test)]
mod tests {
    use jiff::civil::datetime;

    use super::*;
    use crate::command::yrcx::testing::{
        Reply, Scripted, example, objection, read_example, read_in_turn, run_on, words,
    };

    #[test]
    fn the_examples_of_the_manual() {
        assert_eq!(words(&["clock", "get"]).unwrap(), [example("4.7.13-reference"), example("4.7.14-reference")]);
        let read = read_in_turn(&["4.7.13-reference", "4.7.14-reference"], &["clock", "get"]);
        assert_eq!(read["time"], "2014-01-01T10:59:59");
        assert!(read["ahead_s"].as_i64().unwrap() < 0);
        let (date, time) = (["clock", "set", "2014-02-02"], ["clock", "set", "08:45"]);
        assert_eq!(words(&date).unwrap(), [example("4.8.1-set")]);
        assert_eq!(words(&time).unwrap(), [example("4.8.2-set")]);
        assert_eq!(read_example("4.8.1-set", &date)["done"], "the controller's clock is set to 2014-02-02");
        let both = ["clock", "set", "2014-02-02T08:45:00"];
        assert_eq!(words(&both).unwrap(), [example("4.8.2-set"), example("4.8.1-set")]);
        let done = read_in_turn(&["4.8.2-set", "4.8.1-set"], &both);
        assert_eq!(done["done"], "the controller's clock is set to 2014-02-02 08:45:00");
    }

    fn answer(numbers: [u16; 3]) -> Reply {
        let mut words = [0; 16];
        words[0] = 0x0200;
        words[2..5].copy_from_slice(&numbers);
        Reply::Ends(1, words)
    }

    #[test]
    fn midnight_between_date_and_time_is_noticed() {
        let replies = [answer([26, 12, 31]), answer([0, 0, 0]), answer([27, 1, 1])];
        let (read, peer) = run_on(Scripted::new(replies), &["clock", "get"]);
        assert_eq!((read.unwrap()["time"].as_str(), peer.taken.len()), (Some("2027-01-01T00:00:00"), 3));
    }

    #[test]
    fn a_date_that_does_not_exist_is_no_answer() {
        for replies in [[answer([26, 2, 30]), answer([1, 0, 0])], [answer([26, 2, 1]), answer([24, 0, 0])]] {
            let (read, _) = run_on(Scripted::new(replies), &["clock", "get"]);
            assert_eq!(read.unwrap_err().kind, Kind::Malformed);
        }
    }

    #[test]
    fn now_is_date_and_time_of_this_machine() {
        assert_eq!(moment("now"), Ok(Moment::Now));
        let sent = words(&["clock", "set", "now"]).unwrap();
        assert_eq!((sent[0][0].as_str(), sent[1][0].as_str()), ("0x0603", "0x0602"));
    }

    #[test]
    fn times_are_iso_times_without_a_zone() {
        assert_eq!(moment("2026-03-01 08:45"), moment("2026-03-01T08:45:00"));
        for wrong in
            ["", "today", "2026-02-30", "26-03-01", "2026-3-1", "08:60", "8:45", "2026-03-01T", "08:45Z", "24:00"]
        {
            assert!(moment(wrong).is_err(), "{wrong}");
        }
        assert!(objection(&["clock", "set", "1999-12-31"]).contains("2000 to 2099"));
    }

    #[test]
    fn the_difference_is_told() {
        let reading =
            |second| Reading::of(datetime(2026, 3, 1, 8, 45, second, 0), datetime(2026, 3, 1, 8, 45, 30, 500));
        assert_eq!([29, 30, 35].map(|second| reading(second).ahead_s), [-1, 0, 4]);
        assert_eq!([3, 3723, 90_000].map(in_words), ["3 s", "1:02:03", "1 days 1:00:00"]);
    }
}
