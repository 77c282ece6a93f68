//! `armctl rehearse`: runs commands on simulators of a backup, and reports what they changed.

use std::cell::RefCell;
use std::rc::Rc;

use super::batch::{Plan, Results, read, refuse_repetition};
use super::parser::Parser;
use super::prepare::{Need, prepare};
use crate::command::families;
use crate::command::fleet::cell::{SavedRobot, inventory_text, robots_in};
use crate::command::fleet::rehearsal::{ID, LineResult, RehearsalReport, RehearsedRobot, Snapshot};
use crate::command::fleet::session::host;
use armctl_frame::batch::{Batch, Rehearse};
use armctl_frame::flags::Globals;
use armctl_frame::interrupt::catch_interrupts;
use armctl_frame::output::Format;
use armctl_frame::prelude::*;
use armctl_frame::script_line::Origin;
use armctl_frame::settings::rehearsal::{Rehearsal, Rehearsals};

/// Runs the commands, and prints the report.
pub async fn run(globals: Globals, rehearse: Rehearse) -> Result<(), RunError> {
    refuse_repetition(&globals)?;
    if globals.config.is_some() || globals.dry_run {
        let flag = if globals.dry_run { "--dry-run" } else { "--config" };
        return Err(Failure::usage(format!("{flag} has no effect on a rehearsal"))
            .hint(format!("remove {flag}"))
            .into());
    }
    let saved = robots_in(&rehearse.from)?;
    catch_interrupts();
    let folder = tempfile::tempdir().context("a temporary folder")?;
    let inventory = folder.path().join("robots.toml");
    let entries = saved.iter().map(|robot| robot.entry(&robot.simulator_url()?)).collect::<Result<_>>()?;
    std::fs::write(&inventory, inventory_text(&rehearse.from, entries)?).context("a temporary folder")?;
    let records = |robot: &SavedRobot| (robot.name.clone(), Rehearsal::new(rehearse.speed));
    let records: Rehearsals = Arc::new(saved.iter().map(records).collect());
    let lines =
        Globals { config: Some(inventory), format: Some(Format::Json), json: false, jq: None, ..globals.clone() };
    let snapshots = lines.clone().without_robot();
    let batch = Batch {
        file: rehearse.file.clone().unwrap_or_else(|| "command".into()),
        keep_going: rehearse.keep_going,
        set: rehearse.set.clone(),
    };
    let (manager, thread) = host::start({
        let screen = globals.screen();
        move |text| screen.note(text)
    })?;
    let plan = |globals| Plan {
        globals,
        batch: &batch,
        screen: globals.screen(),
        manager: manager.clone(),
        results: Some(Results::default()),
        rehearsal: Some(Arc::clone(&records)),
    };
    let rehearsed = Rehearsed { rehearse: &rehearse, saved: &saved, records: &records, folder: folder.path() };
    let report = rehearsed.report(&plan(&lines), &plan(&snapshots)).await;
    thread.end().await;
    let run = prepare(globals, Need::Nothing, None)?;
    run.local(ID, &report?)
}

/// A rehearsal.
struct Rehearsed<'a> {
    rehearse: &'a Rehearse,
    saved: &'a [SavedRobot],
    records: &'a Rehearsals,
    /// Folder for the snapshots.
    folder: &'a Path,
}

impl Rehearsed<'_> {
    /// Runs the commands on `lines`, and reads the robots before and after with `snapshots`.
    async fn report(&self, lines: &Plan<'_>, snapshots: &Plan<'_>) -> Result<RehearsalReport, RunError> {
        let planned = if let Some(file) = &self.rehearse.file {
            lines.lines(&read(file)?)?
        } else {
            let typed = self.rehearse.command.join(" ");
            let words = self.rehearse.command.iter().skip_while(|word| *word == "armctl").cloned().collect();
            let origin = Origin { file: "command".into(), line: 1 };
            vec![lines.words(&mut Parser::default(), words, &typed, &origin)?]
        };
        let typed: BTreeMap<usize, String> =
            planned.iter().map(|planned| (planned.origin.line, planned.typed.to_string())).collect();
        let before = self.snapshots(snapshots, "before").await?;
        for record in self.records.values() {
            record.motions.take();
            record.take_questions();
        }
        let outcome = lines.run_lines(planned).await;
        let failure = match outcome {
            Err(stopped) if stopped.failure.kind == Kind::Interrupted => return Err(stopped),
            outcome => outcome.err().map(|stopped| stopped.failure),
        };
        let mut running = BTreeMap::new();
        let settle = duration::display(self.rehearse.settle);
        for SavedRobot { name, .. } in self.saved {
            let words = ["wait", "idle", "--for", &settle, "-r", name].map(ToOwned::to_owned);
            let is_running = match ask(snapshots, words.into()).await {
                Ok(_) => Some(false),
                Err(failure) if failure.kind == Kind::ConditionNotMet => Some(true),
                Err(failure) if failure.kind == Kind::Interrupted => return Err(failure.into()),
                Err(_) => None,
            };
            running.insert(name.as_str(), is_running);
        }
        let recorded: Vec<_> =
            self.records.iter().map(|(name, record)| (name, record.motions.take(), record.take_questions())).collect();
        let after = self.snapshots(snapshots, "after").await?;
        let mut robots = Vec::new();
        for (SavedRobot { name, family, .. }, snapshots) in self.saved.iter().zip(before.iter().zip(&after)) {
            let mut robot = RehearsedRobot::compare(name, *family, [snapshots.0, snapshots.1])?;
            robot.running = running.get(name.as_str()).copied().flatten();
            robots.push(robot);
        }
        for (name, motions, questions) in recorded {
            if let Some(robot) = robots.iter_mut().find(|robot| robot.robot == *name) {
                robot.motions = motions.into_iter().map(Into::into).collect();
                robot.questions = questions;
            }
        }
        let results = lines.results.as_ref().map(Rc::clone).unwrap_or_default();
        Ok(RehearsalReport {
            folder: self.rehearse.from.display().to_string(),
            time_factor: self.rehearse.speed.factor(),
            lines: results.borrow().iter().map(|envelope| line_result(envelope, &typed)).collect(),
            robots,
            failure,
        })
    }

    /// Saves all robots below `time`.
    async fn snapshots(&self, plan: &Plan<'_>, time: &str) -> Result<Vec<Snapshot>> {
        let mut snapshots = Vec::new();
        for SavedRobot { name, family, .. } in self.saved {
            let path = self.folder.join(time).join(name);
            let folder = path.display().to_string();
            let named = |failure: Failure| {
                let message = format!("{name}: the simulator cannot be read: {}", failure.message);
                Failure { message, ..failure }
            };
            match ask(plan, ["backup", &folder, "-q", "-r", name].map(ToOwned::to_owned).into()).await {
                // A part that the controller refuses is missing in both snapshots.
                Err(failure) if failure.kind != Kind::Mixed => return Err(named(failure)),
                _ => {}
            }
            let list = async |words: &[&str]| {
                let words = [words, &["-r", name]].concat().into_iter().map(ToOwned::to_owned);
                Ok::<_, Failure>(values_of(&ask(plan, words.collect()).await?))
            };
            let mut values = BTreeMap::new();
            for noun in families::of(*family).unsaved {
                values.append(&mut list(&[family.name(), noun, "list", "--empty"]).await.map_err(named)?);
            }
            let signals = list(&["io", "list"]).await.unwrap_or_default();
            snapshots.push(Snapshot { folder: path, values, signals });
        }
        Ok(snapshots)
    }
}

/// Runs a command that is not part of the rehearsal. Returns its data.
async fn ask(plan: &Plan<'_>, words: Vec<String>) -> Result<Value> {
    let origin = Origin { file: "rehearse".into(), line: 1 };
    let planned = plan.words(&mut Parser::default(), words, "rehearse", &origin)?;
    let outcome = plan.run_lines(vec![planned]).await;
    let envelopes = plan.results.as_deref().map(RefCell::take).unwrap_or_default();
    outcome.map_err(|stopped| stopped.failure)?;
    Ok(envelopes
        .into_iter()
        .next()
        .and_then(|mut envelope| envelope.get_mut("data").map(Value::take))
        .unwrap_or_default())
}

/// Values of the items of a report by name. `io list` does not list a signal that is off and has no name.
fn values_of(report: &Value) -> BTreeMap<String, String> {
    let items = report.get("items").and_then(Value::as_array).into_iter().flatten();
    let text = |value: &Value| match value {
        Value::Bool(is_on) => if *is_on { "on" } else { "off" }.to_owned(),
        other => other.to_string(),
    };
    items.filter_map(|item| Some((item.get("name")?.as_str()?.to_owned(), text(item.get("value")?)))).collect()
}

fn line_result(envelope: &Value, typed: &BTreeMap<usize, String>) -> LineResult {
    let line = envelope.get("line").and_then(Value::as_u64).and_then(|line| usize::try_from(line).ok());
    let line = line.unwrap_or_default();
    LineResult {
        line,
        typed: typed.get(&line).cloned().unwrap_or_default(),
        robot: envelope.get("robot").and_then(Value::as_str).map(ToOwned::to_owned),
        ok: envelope.get("ok").and_then(Value::as_bool).unwrap_or_default(),
        error: envelope.get("error").cloned(),
    }
}
