//! `yrcx clock` (4.7.13, 4.7.14, 4.8.1, 4.8.2): date and time of the controller, without time zone.

use jiff::Zoned;
use jiff::civil::{Date, DateTime, Time};

use super::confirmed_write::read_current;
use super::read_requests::ask_each;
use crate::prelude::*;
use armctl_frame::items;
use armctl_frame::items::ItemError;
use armctl_frame::robot::item::{Item, Written, WrittenItems};
use armctl_frame::settings_report::OLD_VALUE;

commands! {
    /// Commands for the controller clock.
    pub enum Clock {
        /// Read date and time
        Get(Get),
        /// Set date and time, for example `now`, 2026-03-01T08:45:00, 2026-03-01 or 08:45
        Set(Set),
    }
}

const DATE: [Key; 3] = [Key::Year, Key::Month, Key::Day];
const TIME: [Key; 3] = [Key::Hour, Key::Minute, Key::Second];
/// Century of the controller's years: the controller stores only two digits of the year.
const CENTURY: i16 = 2000;

/// Reads date and time of the controller.
#[derive(Debug, Args)]
pub struct Get {}

impl Command for Get {
    type Family = Yrcx;
    type Report = Reading;
    const ID: &'static str = "yrcx.clock.get";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Reading> {
        let Context { link, screen, .. } = context;
        let order = |command| link.draft(command)?.valid_order();
        let orders = [order(table::Command::DateGet)?, order(table::Command::TimeGet)?];
        let mut outcomes = ask_each(link, screen, "reading the clock", &orders).await?.outcomes.into_iter();
        let mut of_next = || outcomes.next().unwrap_or_else(|| Err(Failure::local("the clock was not read")));
        let mut date = of_next().and_then(|values| date_of(&values));
        let time = of_next().and_then(|values| time_of(&values));
        // Midnight may have passed between the two requests: read the date again.
        if let (Ok(_), Ok(moment)) = (&date, &time)
            && moment.hour() == 0
            && moment.minute() == 0
        {
            date = link.ask(&orders[0]).await.and_then(|done| date_of(&done.values));
        }
        let reading = Reading::of(date, time, Zoned::now().datetime());
        items::all_failed(PARTS, &reading.errors)?;
        Ok(reading)
    }
}

fn date_of(values: &Values) -> Result<Date> {
    let [year, month, day] = DATE.map(|key| values.int(key).and_then(|number| i8::try_from(number).ok()).unwrap_or(-1));
    let date = if year < 0 { None } else { Date::new(CENTURY + i16::from(year), month, day).ok() };
    date.ok_or_else(|| malformed(format!("the controller reported an invalid date: {year}-{month}-{day}")))
}

fn time_of(values: &Values) -> Result<Time> {
    let [hour, minute, second] =
        TIME.map(|key| values.int(key).and_then(|number| i8::try_from(number).ok()).unwrap_or(-1));
    let time = Time::new(hour, minute, second, 0);
    time.map_err(|_| malformed(format!("the controller reported an invalid time: {hour}:{minute}:{second}")))
}

fn malformed(message: String) -> Failure {
    Failure::new(Kind::Malformed, message).hint("use `yrcx clock set now` to set the clock of the controller")
}

/// Clock reading.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Reading {
    /// Local time of the controller, for example `2026-03-01T08:45:00`; null if the date or the time could not be read.
    time: Option<String>,
    /// Date, for example `2026-03-01`; null if the date could not be read.
    date: Option<String>,
    /// Time of day, for example `08:45:00`; null if the time could not be read.
    time_of_day: Option<String>,
    /// Difference to the clock of this computer in seconds; negative if the controller's clock is behind; null if the
    /// date or the time could not be read.
    ahead_s: Option<i64>,
    /// Values that could not be read, and the reason.
    errors: Vec<ItemError>,
}

impl Reading {
    fn of(date: Result<Date>, time: Result<Time>, now: DateTime) -> Self {
        let moment = date.as_ref().ok().zip(time.as_ref().ok()).map(|(date, time)| date.to_datetime(*time));
        Self {
            time: moment.map(|moment| moment.to_string()),
            date: date.as_ref().ok().map(ToString::to_string),
            time_of_day: time.as_ref().ok().map(describe),
            ahead_s: moment.map(|moment| moment.duration_since(now).as_secs()),
            errors: [("date", date.err()), ("time", time.err())]
                .into_iter()
                .filter_map(|(name, failure)| Some(ItemError::new(name, failure?)))
                .collect(),
        }
    }
}

fn describe(time: &Time) -> String {
    time.strftime("%H:%M:%S").to_string()
}

impl Report for Reading {
    fn view(&self) -> View {
        let Some(ahead_s) = self.ahead_s else {
            let fields = [("date", self.date.as_deref()), ("time", self.time_of_day.as_deref())];
            return View::fields(fields.map(|(name, value)| (name, Cell::optional(value))));
        };
        let difference = match ahead_s {
            0 => "same as this computer".to_owned(),
            ahead @ 1.. => format!("{} ahead of this computer", in_words(ahead.unsigned_abs())),
            behind => format!("{} behind this computer", in_words(behind.unsigned_abs())),
        };
        let clock = self.time.as_ref().map(|time| time.replacen('T', " ", 1));
        View::fields([("clock", Cell::optional(clock.as_deref())), ("compared", difference.into())])
    }

    fn failure(&self) -> Option<Failure> {
        items::verdict(PARTS, &self.errors)
    }
}

/// Number of values in a reading: date and time.
const PARTS: usize = 2;

/// Formats a duration, for example `3 s`, `1:02:03`, `252 days 1:02:03`.
fn in_words(seconds: u64) -> String {
    let (days, hours, minutes) = (seconds / 86_400, seconds / 3600 % 24, seconds / 60 % 60);
    match (days, hours, minutes) {
        (0, 0, 0) => format!("{seconds} s"),
        (0, ..) => format!("{hours}:{minutes:02}:{:02}", seconds % 60),
        _ => format!("{days} days {hours}:{minutes:02}:{:02}", seconds % 60),
    }
}

/// Sets the date of the controller, the time, or both.
#[derive(Debug, Args)]
#[command(after_help = "The controller clock uses local time. It supports the years 2000 to 2099.")]
pub struct Set {
    /// `now` for the time of this computer, or a date, a time or both, for example 2026-03-01T08:45:00, 2026-03-01 or
    /// 08:45
    #[arg(value_name = "TIME", value_parser = moment)]
    moment: Moment,
}

/// Date and time to set.
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
    let date = date.ok_or_else(|| format!("'{text}' is not a valid date, such as 2026-03-01"))?;
    match date.year() - CENTURY {
        0..=99 => Ok(date),
        _ => Err("the year must be 2000 to 2099".to_owned()),
    }
}

fn parse_time(text: &str) -> Result<Time, String> {
    let pieces: Vec<&str> = text.split(':').collect();
    let time = match pieces[..] {
        [hour, minute] => (|| Time::new(digits(hour, 2)?, digits(minute, 2)?, 0, 0).ok())(),
        [hour, minute, second] => (|| Time::new(digits(hour, 2)?, digits(minute, 2)?, digits(second, 2)?, 0).ok())(),
        _ => None,
    };
    time.ok_or_else(|| format!("'{text}' is not a valid time, such as 08:45 or 08:45:00"))
}

/// Parses a number that has exactly `count` digits.
fn digits<N: std::str::FromStr>(text: &str, count: usize) -> Option<N> {
    let fits = text.len() == count && text.bytes().all(|byte| byte.is_ascii_digit());
    text.parse().ok().filter(|_| fits)
}

impl Command for Set {
    type Family = Yrcx;
    type Report = WrittenItems<String>;
    const ID: &'static str = "yrcx.clock.set";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<WrittenItems<String>> {
        let link = context.link;
        let (date, time) = match self.moment {
            Moment::Given { date, time } => (date, time),
            Moment::Now => (None, Some(Zoned::now().time())),
        };
        let [old_date, old_time] =
            read_before(link, time.is_some(), date.is_some() || self.moment == Moment::Now).await?;
        // The time is set before the date. Otherwise the old time could pass midnight and advance the new date.
        let mut items = Vec::new();
        if let Some(time) = time {
            let order = time_order(link, time)?;
            link.ask(&order).await?;
            items.push(written("time", Ok(describe(&time)), old_time));
        }
        let date = if self.moment == Moment::Now { Some(Zoned::now().date()) } else { date };
        if let Some(date) = date {
            let order = date_order(link, date)?;
            let outcome = link.ask(&order).await.map(|_| date.to_string());
            if time.is_none() {
                outcome.as_ref().map_err(Clone::clone)?;
            }
            items.insert(0, written("date", outcome, old_date));
        }
        let values: Vec<&str> = items.iter().filter_map(|written| written.new.as_deref()).collect();
        Ok(WrittenItems::describe(format!("the controller's clock is set to {}", values.join(" ")), items))
    }
}

/// The date or the time that was set, or why it was not.
fn written(name: &str, outcome: Result<String>, old: Option<String>) -> Written<String> {
    let is_written = outcome.is_ok();
    Written::new(Item::new("clock", name, outcome.map(Some)), old, is_written)
}

/// Reads the current date, time, or both: the values that armctl will set. Values that cannot be read stay unknown.
async fn read_before(link: &mut Link, time: bool, date: bool) -> Result<[Option<String>; 2]> {
    let mut found = [None, None];
    if date {
        let order = link.draft(table::Command::DateGet)?.valid_order()?;
        let values = read_current(link, &order, OLD_VALUE).await?;
        found[0] = values.and_then(|values| date_of(&values).ok()).map(|date| date.to_string());
    }
    if time {
        let order = link.draft(table::Command::TimeGet)?.valid_order()?;
        let values = read_current(link, &order, OLD_VALUE).await?;
        found[1] = values.and_then(|values| time_of(&values).ok()).as_ref().map(describe);
    }
    Ok(found)
}

fn date_order(link: &Link, date: Date) -> Result<Order> {
    let numbers = [i32::from(date.year() - CENTURY), i32::from(date.month()), i32::from(date.day())];
    let draft = link.draft(table::Command::DateSet)?;
    DATE.into_iter().zip(numbers).fold(draft, |draft, (key, number)| draft.with(key, number)).valid_order()
}

fn time_order(link: &Link, time: Time) -> Result<Order> {
    let numbers = [time.hour(), time.minute(), time.second()].map(i32::from);
    let draft = link.draft(table::Command::TimeSet)?;
    TIME.into_iter().zip(numbers).fold(draft, |draft, (key, number)| draft.with(key, number)).valid_order()
}

#[cfg(test)]
mod tests {
    use jiff::civil::datetime;

    use super::*;
    use crate::testing::{Reply, Scripted, objection, read_in_turn, report_on, run_on, words};

    #[test]
    fn a_clock_of_the_past_is_behind() {
        let read = read_in_turn(&["4.7.13-reference", "4.7.14-reference"], &["clock", "get"]);
        assert!(read["ahead_s"].as_i64().unwrap() < 0);
    }

    fn answer(numbers: [u16; 3]) -> Reply {
        let mut words = [0; 16];
        words[0] = 0x0200;
        words[2..5].copy_from_slice(&numbers);
        Reply::AddressPair(1, words)
    }

    #[test]
    fn detects_midnight_between_date_and_time() {
        let replies = [answer([26, 12, 31]), answer([0, 0, 0]), answer([27, 1, 1])];
        let (read, peer) = run_on(Scripted::new(replies), &["clock", "get"]);
        assert_eq!((read.unwrap()["time"].as_str(), peer.taken.len()), (Some("2027-01-01T00:00:00"), 3));
    }

    fn unanswered_reply() -> Reply {
        let mut words = [0; 16];
        words[..3].copy_from_slice(&[0x4000, 5, 1]);
        Reply::AddressPair(1, words)
    }

    #[test]
    fn refused_part_does_not_hide_the_other() {
        let (date, time) = (answer([26, 3, 1]), answer([8, 45, 0]));
        for (replies, asked, of_date, of_time) in [
            ([unanswered_reply(), time.clone()], "date", json!(null), json!("08:45:00")),
            ([answer([26, 2, 30]), time], "date", json!(null), json!("08:45:00")),
            ([date.clone(), unanswered_reply()], "time", json!("2026-03-01"), json!(null)),
            ([date, answer([24, 0, 0])], "time", json!("2026-03-01"), json!(null)),
        ] {
            let (read, failure, peer) = report_on(Scripted::new(replies), &["clock", "get"]);
            assert_eq!((&read["date"], &read["time_of_day"], &read["time"]), (&of_date, &of_time, &json!(null)));
            assert_eq!((&read["errors"][0]["asked"], peer.taken.len()), (&json!(asked), 2));
            let failure = failure.unwrap();
            assert_eq!(failure.kind.exit(), 9);
            assert!(failure.message.starts_with(&format!("1 of 2 failed: {asked}: ")), "{failure}");
        }
        let (refused, _) = run_on(Scripted::new([unanswered_reply(), unanswered_reply()]), &["clock", "get"]);
        let failure = refused.unwrap_err();
        assert_eq!(failure.message, "all 2 failed: date: the controller refused date-get: alarm 5.1, program syntax");
        assert_eq!(failure.kind.exit(), 3);
    }

    #[test]
    fn reports_the_time_that_was_set_if_the_date_is_refused() {
        let line = ["clock", "set", "2014-02-02T08:45:00"];
        let (set, failure, _) = report_on(
            Scripted::new([unanswered_reply(), unanswered_reply(), answer([0; 3]), unanswered_reply()]),
            &line,
        );
        let [date, time] = [&set["items"][0], &set["items"][1]];
        assert_eq!((&date["new"], &time["new"]), (&json!(null), &json!("08:45:00")));
        assert_eq!((&date["error"]["asked"], &date["error"]["code"]), (&json!("date"), &json!("5.1")));
        assert_eq!(failure.unwrap().kind.exit(), 9);
        let (refused, peer) =
            run_on(Scripted::new([unanswered_reply(), unanswered_reply(), unanswered_reply()]), &line);
        assert_eq!((refused.unwrap_err().kind.exit(), peer.taken.len()), (3, 3), "the date does not go alone");
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
    fn reports_the_clock_difference() {
        let now = datetime(2026, 3, 1, 8, 45, 30, 500);
        let reading = |second| Reading::of(Ok(now.date()), Ok(Time::constant(8, 45, second, 0)), now);
        assert_eq!([29, 30, 35].map(|second| reading(second).ahead_s), [Some(-1), Some(0), Some(4)]);
        assert_eq!([3, 3723, 90_000].map(in_words), ["3 s", "1:02:03", "1 days 1:00:00"]);
    }
}
