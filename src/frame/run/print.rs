//! Output of a run on stdout: views for people, envelopes for programs.

use std::collections::HashMap;

use jiff::Timestamp;

use super::failure_log::RoundFailures;
use super::{Run, RunError};
use crate::output::csv::Sheet;
use crate::output::envelope::{Envelope, ErrorBody};
use crate::output::{Format, escape, render};
use crate::prelude::basics::*;
use crate::{AnyCommand, AnyReport, Outcome};

/// Report or failure of a robot. With only one robot, there is no robot in the row.
type RobotRow<'r> = (Option<&'r Robot>, Result<&'r dyn AnyReport, &'r Failure>);

/// Position of a report among other reports.
#[derive(Debug, Clone, Copy)]
pub enum ReportPosition<'a> {
    /// The only report.
    Alone,
    /// The first report of a watch.
    First,
    /// A later report of a watch.
    Next,
    /// A report in a watch with one line per report.
    Line,
    /// A line about a robot in a watch of several robots.
    LineOf(&'a Robot),
    /// One of several robots, with its label.
    Among { label: &'a str, first: bool },
}

impl Run {
    /// Writes the envelope of a failed line, in the order of the lines. Returns `false` if the output is for people,
    /// who see the failure on stderr.
    pub fn report_failure(&self, stopped: &RunError) -> Result<bool> {
        if self.is_for_people() {
            return Ok(false);
        }
        let envelope = stopped.envelope.as_deref().cloned();
        self.emit(self.of_stream(envelope.unwrap_or_else(|| Envelope::failed(None, stopped.failure.clone()))))?;
        Ok(true)
    }

    /// Prints the report of a command without a robot.
    pub fn local(&self, id: &str, report: &dyn AnyReport) -> Result<(), RunError> {
        let failure = report.failure();
        if self.is_for_people() {
            self.show_one(report, ReportPosition::Alone)?;
        } else {
            let envelope = Envelope::local(id, report.data()?);
            let envelope = Envelope { ok: failure.is_none(), error: failure.clone().map(Into::into), ..envelope };
            self.emit(self.of_stream(envelope))?;
        }
        failure.map_or(Ok(()), |failure| Err(RunError { failure, envelope: None, is_reported: self.screen.is_json() }))
    }

    /// Writes the reports of several robots, and also returns them as envelopes.
    pub(super) fn print_many(
        &self,
        command: &dyn AnyCommand,
        robots: &[Robot],
        outcomes: &[Outcome],
        (place, said): (ReportPosition<'_>, &mut RoundFailures<'_>),
    ) -> Result<Vec<Envelope>> {
        let envelopes = envelopes(robots, command.id(), outcomes)?;
        if !self.is_for_people() {
            if self.screen.format == Format::Jsonl {
                envelopes.iter().try_for_each(|envelope| self.emit(with_time(envelope.clone())))?;
            } else {
                self.write(
                    &envelopes.iter().cloned().map(|envelope| self.with_time_mark(envelope)).collect::<Vec<_>>(),
                )?;
            }
            return Ok(envelopes);
        }
        let mut views = Vec::new();
        let mut reasons = Vec::new();
        for (index, (robot, outcome)) in robots.iter().zip(outcomes).enumerate() {
            let reason = match outcome {
                Ok(report) => {
                    let failure = report.failure();
                    views.push(RobotView {
                        robot,
                        view: report.view(),
                        has_failed: failure.is_some(),
                        merged_count: 0,
                    });
                    failure
                }
                Err(failure) => Some(failure.clone()),
            };
            reasons.extend(said.of(index, reason.as_ref()).into_iter().map(|failure| (robot, failure)));
        }
        if self.screen.format.is_rows() {
            let outcomes = robots.iter().zip(outcomes);
            let rows: Vec<_> = outcomes.map(|(robot, outcome)| (Some(robot), outcome.as_deref())).collect();
            let report = rows.iter().find_map(|(_, outcome)| outcome.ok());
            let sheet = report.map(sheet_of).or_else(|| command.sheet());
            if let Some(sheet) = sheet {
                self.show_csv(&sheet.with_outcome(), &rows, place)?;
            }
        } else {
            self.show_many(&fold_failed(views), place)?;
        }
        let summary = command.summary(&envelopes).filter(|_| self.has_trailer());
        if let Some(summary) = summary.and_then(|summary| said.summary(summary).map(str::to_owned)) {
            self.screen.note(&summary);
        }
        for failure in common_failures(&reasons) {
            self.redraw.forget();
            self.screen.failure(&failure);
        }
        Ok(envelopes)
    }

    /// Whether the output is a single table for people, below which a summary can be printed.
    fn has_trailer(&self) -> bool {
        self.screen.format == Format::Table && !self.redraw.is_on() && !self.gate.dry_run
    }

    /// Merges tables with the same columns into one table, with the robot in the first column. Other views are printed
    /// one below the other.
    fn show_many(&self, views: &[RobotView<'_>], place: ReportPosition<'_>) -> Result<()> {
        let names: Vec<String> = views.iter().map(|of| of.named(&of.robot.name)).collect();
        let tables = names.iter().zip(views).map(|(name, of)| Some((name.as_str(), of.view.as_table()?)));
        match tables.collect::<Option<Vec<_>>>().and_then(|tables| Table::joined("robot", &tables)) {
            Some(table) => self.show(&View::table(table), place),
            None => views.iter().enumerate().try_for_each(|(index, of)| {
                let label = of.named(&of.robot.label());
                self.show(&of.view, ReportPosition::Among { label: &label, first: index == 0 })
            }),
        }
    }

    /// Whether reports are printed as views: as tables or as CSV.
    pub fn is_for_people(&self) -> bool {
        self.filter.is_none() && matches!(self.screen.format, Format::Table | Format::Csv | Format::Value)
    }

    pub(super) fn print(
        &self,
        robot: &Robot,
        id: &str,
        report: &dyn AnyReport,
        place: ReportPosition<'_>,
    ) -> Result<()> {
        if self.is_for_people() {
            return match place {
                ReportPosition::LineOf(robot) if self.screen.format.is_rows() => {
                    self.show_csv(&sheet_of(report), &[(Some(robot), Ok(report))], place)
                }
                place => self.show_one(report, place),
            };
        }
        let envelope = envelope(robot, id, Ok(report))?;
        let is_stream = self.screen.format == Format::Jsonl || !matches!(place, ReportPosition::Alone);
        self.emit(if is_stream { with_time(envelope) } else { envelope })
    }

    /// Adds the time to an envelope if the format is a stream.
    fn of_stream(&self, envelope: Envelope) -> Envelope {
        if self.screen.format == Format::Jsonl { with_time(envelope) } else { envelope }
    }

    /// Starts a round of a watch. On a terminal, the round replaces the round before it. Lines of a log are kept.
    pub(super) fn round(&self, is_first: bool, stays: bool) -> ReportPosition<'static> {
        if !stays && self.screen.can_replace() && self.is_for_people() {
            self.redraw.begin();
        }
        match (is_first, stays) {
            (_, true) => ReportPosition::Line,
            (true, false) => ReportPosition::First,
            (false, false) => ReportPosition::Next,
        }
    }

    /// Writes an envelope.
    pub(super) fn emit(&self, envelope: Envelope) -> Result<()> {
        self.write(&self.with_time_mark(envelope))
    }

    fn with_time_mark(&self, envelope: Envelope) -> Envelope {
        match &self.line {
            Some(line) => line.marked(envelope),
            None => envelope,
        }
    }

    /// Writes JSON, or the results of the filter, one per line. Strings are written raw, all other results as JSON.
    fn write(&self, value: &impl Serialize) -> Result<()> {
        let value = match &self.line {
            Some(line) => line.stop_passing(as_value(value)?),
            None if self.filter.is_none() => return self.screen.json(value),
            None => Some(as_value(value)?),
        };
        let Some(value) = value else { return Ok(()) };
        let Some(filter) = &self.filter else { return self.screen.json(&value) };
        filter.apply(&value, |value| match value {
            Value::String(text) => self.screen.data(&format!("{}\n", escape::lines(&text))),
            value => self.screen.json(&value),
        })
    }

    fn show_one(&self, report: &dyn AnyReport, place: ReportPosition<'_>) -> Result<()> {
        match self.screen.format {
            Format::Csv | Format::Value => self.show_csv(&sheet_of(report), &[(None, Ok(report))], place),
            _ => self.show(&report.view(), place),
        }
    }

    /// Writes reports of one kind as CSV, with a row for each robot that failed. Later rounds of a watch are written
    /// below the first header.
    fn show_csv(&self, sheet: &Sheet, rows: &[RobotRow<'_>], place: ReportPosition<'_>) -> Result<()> {
        let is_csv = self.screen.format == Format::Csv;
        let is_round = is_csv
            && self.repeat.is_wanted()
            && !self.repeat.is_quiet
            && matches!(place, ReportPosition::First | ReportPosition::Next);
        let time = (is_round && !sheet.has_column("time")).then(|| Timestamp::now().to_string());
        let mut before: Vec<&str> = time.iter().map(|_| "time").collect();
        before.extend(rows.iter().find_map(|(robot, _)| robot.map(|_| "robot")));
        let header = sheet.header(&before);
        let is_later = matches!(place, ReportPosition::Next | ReportPosition::Line | ReportPosition::LineOf(_));
        let mut text = if is_later && *self.redraw.header.borrow() == header { String::new() } else { header.clone() };
        self.redraw.header.replace(header);
        if !is_csv {
            text.clear();
        }
        for (robot, outcome) in rows {
            let before: Vec<&str> =
                time.as_deref().into_iter().chain(robot.iter().map(|robot| robot.name.as_str())).collect();
            match outcome {
                Ok(report) if is_csv => {
                    let error = report.failure().map(ErrorBody::from).map(|error| as_value(&error)).transpose()?;
                    sheet.rows(&before, &report.data()?, error.as_ref(), &mut text);
                }
                Ok(report) => sheet.values(&before, &report.data()?, &mut text),
                Err(failure) if is_csv => {
                    sheet.failed(&before, &as_value(&ErrorBody::from((*failure).clone()))?, &mut text);
                }
                Err(_) => {}
            }
        }
        self.screen.data(&text)
    }

    fn show(&self, view: &View, place: ReportPosition<'_>) -> Result<()> {
        let screen = &self.screen;
        let text = render::text(view, screen.width(), screen.stdout_color());
        let text = match place {
            ReportPosition::Alone | ReportPosition::First | ReportPosition::Line => text,
            ReportPosition::LineOf(robot) => {
                text.lines().map(|line| format!("{}  {line}\n", escape::line(&robot.name))).collect()
            }
            ReportPosition::Next if self.redraw.is_on() => text,
            ReportPosition::Next => format!("\n{text}"),
            ReportPosition::Among { label, first } => {
                format!("{}{}\n{text}", if first { "" } else { "\n" }, escape::line(label))
            }
        };
        screen.data(&self.redraw.with_erase(text))
    }
}

/// Columns of a report.
fn sheet_of(report: &dyn AnyReport) -> Sheet {
    Sheet::from_schema(&report.schema().to_value(), report.rows())
}

/// Maximum number of robots that failed alike and are listed individually.
const MIN_GROUP: usize = 5;

/// View of one of several robots.
struct RobotView<'r> {
    robot: &'r Robot,
    view: View,
    has_failed: bool,
    /// Number of other robots with the same view.
    merged_count: usize,
}

impl RobotView<'_> {
    /// Name, with the number of robots that failed alike.
    fn named(&self, name: &str) -> String {
        if self.merged_count == 0 { name.to_owned() } else { format!("{name} and {} more", self.merged_count) }
    }
}

/// Merges views of many robots that failed alike. A robot that works always has its own view.
fn fold_failed(views: Vec<RobotView<'_>>) -> Vec<RobotView<'_>> {
    let mut groups: Vec<(View, usize)> = Vec::new();
    let group_of = |groups: &[(View, usize)], view: &View| groups.iter().position(|(other, _)| other == view);
    for RobotView { view, .. } in views.iter().filter(|of| of.has_failed) {
        match group_of(&groups, view) {
            Some(at) => groups[at].1 += 1,
            None => groups.push((view.clone(), 1)),
        }
    }
    groups.retain(|(_, robots)| *robots > MIN_GROUP);
    let mut folded = Vec::new();
    for of in views {
        match group_of(&groups, &of.view).filter(|_| of.has_failed) {
            Some(at) => {
                let merged_count = std::mem::take(&mut groups[at].1);
                // Only the first of the group has not been counted yet.
                if merged_count > 0 {
                    folded.push(RobotView { merged_count: merged_count - 1, ..of });
                }
            }
            None => folded.push(of),
        }
    }
    folded
}

/// Failures of robots. Failures that robots have in common are merged.
fn common_failures(reasons: &[(&Robot, Failure)]) -> Vec<Failure> {
    /// Maximum number of robot names in a merged failure.
    const MAX_NAMES: usize = 3;

    let why = |(robot, failure): &(&Robot, Failure)| {
        let message = failure.message.strip_prefix(&robot.label()).unwrap_or(&failure.message);
        let hint = failure.hint.as_ref().map(|hint| generalize(hint, robot));
        (failure.kind, generalize(message.trim_start_matches(": "), robot), hint)
    };
    let mut groups: Vec<(_, Vec<&(&Robot, Failure)>)> = Vec::new();
    let mut places = HashMap::new();
    for reason in reasons {
        let why = why(reason);
        let at = *places.entry((why.0.exit(), why.1.clone(), why.2.clone())).or_insert_with(|| {
            groups.push((why, Vec::new()));
            groups.len() - 1
        });
        groups[at].1.push(reason);
    }
    let failures = groups.into_iter().flat_map(|((kind, message, hint), all)| {
        if all.len() <= MIN_GROUP {
            return all.into_iter().map(|(robot, failure)| with_robot_name(robot, failure.clone())).collect();
        }
        let names: Vec<&str> = all.iter().take(MAX_NAMES).map(|(robot, _)| robot.name.as_str()).collect();
        let message = format!("{} and {} more robots: {message}", names.join(", "), all.len() - MAX_NAMES);
        vec![Failure { hint, ..Failure::new(kind, message) }]
    });
    failures.collect()
}

/// Text in which dots replace the name, host and port of the robot.
fn generalize(text: &str, robot: &Robot) -> String {
    let url = robot.target.value.url();
    let parts = url.split(|one: char| !one.is_alphanumeric() && !"._-".contains(one));
    let parts = parts.filter(|part| part.len() > 1 && part.contains(|one: char| one.is_ascii_digit()));
    std::iter::once(robot.name.as_str())
        .chain(parts)
        .fold(text.replace(url, "…"), |text, part| without_part(&text, part))
}

/// Text in which dots replace a word.
fn without_part(text: &str, word: &str) -> String {
    let is_part = |one: Option<char>| one.is_some_and(|one| one.is_alphanumeric() || one == '_' || one == '-');
    let mut out = String::with_capacity(text.len());
    let mut done = 0;
    for (at, found) in text.match_indices(word) {
        let (before, after) = (text[..at].chars().next_back(), text[at + found.len()..].chars().next());
        if !is_part(before) && !is_part(after) {
            out.push_str(&text[done..at]);
            out.push('…');
            done = at + found.len();
        }
    }
    out.push_str(&text[done..]);
    out
}

/// Failure with the name of the robot, unless it is a link failure that already has the name.
pub(super) fn with_robot_name(robot: &Robot, failure: Failure) -> Failure {
    let label = robot.label();
    let is_named = failure.message.starts_with(&label);
    let message = if is_named { failure.message } else { format!("{label}: {}", failure.message) };
    Failure { message, ..failure }
}

/// Envelopes for the reports or failures of several robots.
pub(super) fn envelopes(robots: &[Robot], id: &str, outcomes: &[Outcome]) -> Result<Vec<Envelope>> {
    let pairs = robots.iter().zip(outcomes);
    pairs.map(|(robot, outcome)| envelope(robot, id, outcome.as_deref().map_err(Clone::clone))).collect()
}

pub fn envelope(robot: &Robot, id: &str, outcome: Result<&dyn AnyReport>) -> Result<Envelope> {
    let report = match outcome {
        Err(failure) => return Ok(Envelope::of(robot, id, Err(failure))),
        Ok(report) => report,
    };
    let failure = report.failure();
    let envelope = Envelope::of(robot, id, Ok(report.data()?));
    Ok(Envelope { ok: failure.is_none(), error: failure.map(Into::into), ..envelope })
}

pub fn with_time(envelope: Envelope) -> Envelope {
    Envelope { time: Some(Timestamp::now()), ..envelope }
}

/// Converts an output to a JSON value.
pub fn as_value(value: &impl Serialize) -> Result<Value> {
    serde_json::to_value(value).map_err(|error| Failure::local(format!("report as JSON: {error}")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Sources;
    use crate::settings::inventory::Inventory;

    fn robots(count: u16) -> Vec<Robot> {
        let one = |at: u16| {
            format!("[[robot]]\nname = \"r{at}\"\nfamily = \"yerc\"\ntarget = \"udp://127.0.0.1:{}\"\n", 2000 + at)
        };
        let inventory = Inventory::parse(&(0..count).map(one).collect::<String>(), "robots.toml").unwrap();
        let mut sources = Sources { inventory, ..Sources::default() };
        sources.selection.all = true;
        sources.robots(None).unwrap()
    }

    #[test]
    fn merges_rows_of_robots_that_failed_alike() {
        let names = |failed: &dyn Fn(usize) -> bool, count: u16| -> Vec<String> {
            let robots = robots(count);
            let view = |(at, robot)| RobotView {
                robot,
                view: View::text(if failed(at) { "no answer" } else { "stopped" }.to_owned()),
                has_failed: failed(at),
                merged_count: 0,
            };
            let folded = fold_failed(robots.iter().enumerate().map(view).collect());
            folded.iter().map(|of| of.named(&of.robot.name)).collect()
        };
        assert_eq!(names(&|_| true, 2500), ["r0 and 2499 more"]);
        assert_eq!(names(&|at| at != 1, 8), ["r0 and 6 more", "r1"]);
        assert_eq!(names(&|_| true, 5).len(), 5, "few are listed");
        assert_eq!(names(&|_| false, 8).len(), 8, "robots that work are listed");
    }

    #[test]
    fn merges_common_failures() {
        let failures = |robots: &[Robot]| -> Vec<String> {
            let failure = |robot: &Robot| {
                let message = format!("{}: nothing listens on UDP port {}", robot.label(), 2000 + robots.len());
                let port = robot.target.value.url().rsplit(':').next().unwrap();
                Failure::new(Kind::NoAnswer, message.replace(&(2000 + robots.len()).to_string(), port))
                    .hint(format!("`armctl robots check {}`", robot.name))
            };
            let reasons: Vec<(&Robot, Failure)> = robots.iter().map(|robot| (robot, failure(robot))).collect();
            common_failures(&reasons)
                .into_iter()
                .map(|failure| format!("{} | {}", failure.message, failure.hint.unwrap()))
                .collect()
        };
        let few = failures(&robots(2));
        assert_eq!(few[1], "r1 (udp://127.0.0.1:2001): nothing listens on UDP port 2001 | `armctl robots check r1`");
        let many = failures(&robots(2500));
        assert_eq!(many, ["r0, r1, r2 and 2497 more robots: nothing listens on UDP port … | `armctl robots check …`"]);
    }
}
