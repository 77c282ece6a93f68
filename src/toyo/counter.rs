//! `toyo counter` and `toyo timer`.

use super::eeprom_tables::Listed;
use super::item_reads::read_each;
use super::number_arguments::{Numbers, number, read_back, read_back_mismatch};
use crate::prelude::*;
use armctl_controller::names::Kind;
use armctl_controller::toyo::field;
use armctl_controller::toyo::names as names_of;
use armctl_frame::store::{Get, List, Row};

table_commands! {
    /// Commands for counters.
    Counter of Counters {}
}

commands! {
    /// Commands for timers. The protocol can only read timers.
    pub enum Timer {
        /// Read timers 1 to 9
        Get(Get<Timers>),
        /// List timers that are not at 0
        List(List<Timers>),
        /// Print each change of timers
        Watch(Watch<Get<Timers>>),
    }
}

/// The counters of the controller.
#[derive(Debug)]
pub struct Counters;

/// Fields of a counter: number and count, as in MCST CN01=0000.
fn fields() -> &'static [field::Field] {
    table::Command::Mcst.row().requests[0].fields
}

/// Number in a text such as `CN05`. The letters can be missing.
fn bare<'t>(letters: &str, text: &'t str) -> &'t str {
    let has_letters = text.get(..letters.len()).is_some_and(|front| front.eq_ignore_ascii_case(letters));
    if has_letters { &text[letters.len()..] } else { text }
}

impl Store for Counters {
    type Family = Toyo;
    type Key = i32;
    type Wire = Record;
    type Value = i32;
    type More = Listed;
    type Options = Single;

    const WORDS: TableWords = TableWords {
        nouns: ["counter", "counters"],
        placeholder: "N",
        range: "Counters (1 to 99), such as 5, CN05 or 1-10, or a name",
        reading: None,
        writing: Some("A counter accepts values from 0 to 9999, also while a program runs."),
    };
    const IDS: Ids = ids!("toyo.counter");
    const LABELS: Option<Kind> = Some(Kind::Counter);
    const COMPLETE: ValueKind = complete::COUNTER;

    fn keys(text: &str) -> Result<Vec<i32>, String> {
        Ok(Numbers::of(&[Numbers::parse(&fields()[0], bare("CN", text))?], &fields()[0]))
    }

    fn all() -> Vec<i32> {
        Numbers::of(&[], &fields()[0])
    }

    fn name(counter: i32) -> String {
        names_of::counter(u8::try_from(counter).unwrap_or(u8::MAX))
    }

    async fn open(_link: &mut Link, _options: &Single) -> Result<Self> {
        Ok(Self)
    }

    fn fields(&self) -> Vec<Field> {
        vec![Field::number("count", "count")]
    }

    fn texts(&self, record: &Record) -> Vec<String> {
        vec![count(record).map_or_else(|| record.written(), |count| count.to_string())]
    }

    fn value(&self, record: &Record) -> Option<i32> {
        count(record)
    }

    fn more(&self, _counter: i32, record: Option<&Record>) -> Listed {
        Listed::of(record)
    }

    fn is_blank(&self, record: &Record) -> bool {
        count(record) == Some(0)
    }

    async fn read(&self, link: &mut Link, screen: &Screen, counters: &[i32]) -> Result<Answers<Record>> {
        let requests: Vec<Request> = counters.iter().copied().map(read).collect();
        Ok(Answers::of(read_each(link, screen, "reading counters", &requests).await?))
    }
}

fn read(counter: i32) -> Request {
    Request::of(table::Command::Mcnt, [Value::Number(counter)])
}

fn count(record: &Record) -> Option<i32> {
    record.is_listed().then(|| record.number("count")).flatten()
}

/// Request that sets a counter.
fn order(counter: i32, count: i32) -> Request {
    Request::of(table::Command::Mcst, [Value::Number(counter), Value::Number(count)])
}

impl Writable for Counters {
    type Draft = Option<i32>;

    const RISK: Risk = Risk::Write;

    fn draft(&self, _counter: i32, texts: &[Option<&str>]) -> Result<Option<i32>, String> {
        texts.first().copied().flatten().map(|text| number(&fields()[1], text)).transpose()
    }

    fn complete_draft(&self, counter: i32, draft: &Option<i32>, _old: Option<&Record>) -> Result<Record> {
        let missing = || Failure::usage(format!("{}: the count is missing", Self::name(counter)));
        let count = draft.ok_or_else(|| missing().hint("write a number from 0 to 9999"))?;
        let record = read(counter).row().answers[0].record(vec![Value::Number(counter), Value::Number(count)]);
        record.map_err(|error| wrong(&error))
    }

    async fn plan(&self, link: &mut Link, rows: &[Row<Self>]) -> Result<()> {
        for (counter, draft) in rows {
            let text = match draft {
                Some(count) => order(*counter, *count).text(),
                None => format!("@MCST {}=?", Self::name(*counter)),
            };
            link.plan_overwriting(&read(*counter), &text).await?;
        }
        Ok(())
    }

    async fn write(&self, link: &mut Link, _screen: &Screen, rows: &[RowDifference<'_, Self>]) -> Result<()> {
        for (counter, _, new) in rows {
            let new_count = count(new).unwrap_or_default();
            let order = order(*counter, new_count);
            link.ask(&order).await?;
            match count(&read_back(link, &order, &read(*counter)).await?) {
                Some(stored) if stored != new_count => {
                    return Err(read_back_mismatch(&order, &format!("the counter is {stored}"))
                        .hint("repeat the command; a running program can change the counter at the same time"));
                }
                _ => {}
            }
        }
        Ok(())
    }
}

/// The timers of the controller.
#[derive(Debug)]
pub struct Timers;

/// Field of the timer number, as in MTMR TN=1.
fn timer() -> &'static field::Field {
    &table::Command::Mtmr.row().requests[0].fields[0]
}

impl Store for Timers {
    type Family = Toyo;
    type Key = i32;
    type Wire = Record;
    type Value = f64;
    type More = Listed;
    type Options = Single;

    const WORDS: TableWords = TableWords {
        nouns: ["timer", "timers"],
        placeholder: "N",
        range: "Timers (1 to 9), such as 5, TN5 or 1-3, or a name",
        reading: Some("Values are in seconds."),
        writing: None,
    };
    const IDS: Ids = ids!("toyo.timer");
    const LABELS: Option<Kind> = Some(Kind::Timer);
    const COMPLETE: ValueKind = complete::TIMER;

    fn keys(text: &str) -> Result<Vec<i32>, String> {
        Ok(Numbers::of(&[Numbers::parse(timer(), bare("TN", text))?], timer()))
    }

    fn all() -> Vec<i32> {
        Numbers::of(&[], timer())
    }

    fn name(number: i32) -> String {
        names_of::timer(u8::try_from(number).unwrap_or(u8::MAX))
    }

    async fn open(_link: &mut Link, _options: &Single) -> Result<Self> {
        Ok(Self)
    }

    fn fields(&self) -> Vec<Field> {
        vec![Field::number("time_s", "time (s)")]
    }

    fn texts(&self, record: &Record) -> Vec<String> {
        vec![self.value(record).map_or_else(|| record.written(), |seconds| format!("{seconds:.1}"))]
    }

    fn value(&self, record: &Record) -> Option<f64> {
        record.is_listed().then(|| f64::from(record.number("time").unwrap_or(0)) / 10.0)
    }

    fn more(&self, _timer: i32, record: Option<&Record>) -> Listed {
        Listed::of(record)
    }

    fn is_blank(&self, record: &Record) -> bool {
        record.number("time") == Some(0)
    }

    async fn read(&self, link: &mut Link, screen: &Screen, timers: &[i32]) -> Result<Answers<Record>> {
        let requests = timers.iter().map(|number| Request::of(table::Command::Mtmr, [Value::Number(*number)]));
        let requests: Vec<Request> = requests.collect();
        Ok(Answers::of(read_each(link, screen, "reading timers", &requests).await?))
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::{Bench, Fault};
    use armctl_frame::failure::Kind;

    #[test]
    fn a_set_counter_is_read_back() {
        let mut bench = Bench::new("sim:");
        assert_eq!(bench.data(&["counter", "set", "5", "7"])["items"][0]["value"], 7);
        let other =
            |block: &str, _| if block == "@MCNT CN=05" { Fault::Answered("@MCNT CN05=0008") } else { Fault::None };
        let failure = Bench::with_faults("", other).0.run(&["counter", "set", "5", "7"]).unwrap_err();
        assert_eq!(failure.kind, Kind::ConditionNotMet);
        assert_eq!(failure.message, "CN05: the controller accepted @MCST CN05=0007, but the counter is 8");
        let silent = |block: &str, count| if block == "@MCNT CN=05" && count > 1 { Fault::Lost } else { Fault::None };
        let failure = Bench::with_faults("", silent).0.run(&["counter", "set", "5", "7"]).unwrap_err();
        assert_eq!(failure.kind, Kind::OutcomeUnknown);
    }

    #[test]
    fn counter_set_reports_old_and_new_value() {
        let mut bench = Bench::new("sim:");
        bench.data(&["counter", "set", "5", "7"]);
        let set = bench.data(&["counter", "set", "5", "8"])["items"][0].clone();
        assert_eq!((&set["old"], &set["new"]), (&7.into(), &8.into()), "{set}");
        // This controller refuses to report the counter, but accepts the write. A missing counter is not written.
        let refuses = |block: &str, count| {
            if block == "@MCNT CN=05" && count == 1 { Fault::Answered("@NG") } else { Fault::None }
        };
        assert_eq!(
            Bench::with_faults("", refuses).0.data(&["counter", "set", "5", "7"])["items"][0]["old"],
            serde_json::Value::Null
        );
        let silent = |block: &str, _| if block.starts_with("@MC") { Fault::Lost } else { Fault::None };
        let (mut bench, received) = Bench::with_faults("", silent);
        assert_eq!(bench.run(&["counter", "set", "5", "7"]).unwrap_err().kind, Kind::NoAnswer);
        assert!(!received.borrow().iter().any(|block| block.starts_with("@MCST")), "nothing was written");
    }

    #[test]
    fn a_late_ok_does_not_confirm_the_next_order() {
        // The client gave up the previous command. The `@OK` for that command arrives later.
        let late = |block: &str, _| match block {
            "@MCST CN05=0007" => Fault::Late(std::time::Duration::from_millis(3010)),
            "@MCST CN06=0001" => Fault::Lost,
            _ => Fault::None,
        };
        let (mut bench, received) = Bench::with_faults("host = true\n", late);
        assert_eq!(bench.run(&["counter", "set", "5", "7"]).unwrap_err().kind, Kind::OutcomeUnknown);
        received.borrow_mut().clear();
        // The command received no `@OK`, so its outcome is unknown.
        assert_eq!(bench.run(&["counter", "set", "6", "1"]).unwrap_err().kind, Kind::OutcomeUnknown);
        assert_eq!(received.borrow()[..2], ["@MCNT CN=06", "@MCST CN06=0001"], "something harmless is asked first");
    }
}
