//! `armctl batch`: runs the commands of a file over links that stay open.
//!
//! The whole file is checked before anything is sent: words, flags, robots, and the gate. The lines then run in order
//! until the first failure.

use std::cell::RefCell;
use std::ffi::OsString;
use std::rc::Rc;

use super::parser::Parser;
use super::prepare::{Invocation, PreparedCommand};
use super::{line_words, name_lookup};
use crate::cli::Words;
use crate::command::fleet::session::host;
use armctl_frame::batch::Batch;
use armctl_frame::flags::Globals;
use armctl_frame::interrupt::catch_interrupts;
use armctl_frame::output::Format;
use armctl_frame::prelude::*;
use armctl_frame::run::begin_trace;
use armctl_frame::script_line::{Line, Origin};
use armctl_frame::session_manager::SessionManager;
use armctl_frame::settings::rehearsal::Rehearsals;

/// Envelopes that are collected.
pub type Results = Rc<RefCell<Vec<Value>>>;

/// Runs the commands in a file.
pub async fn run(globals: Globals, batch: Batch) -> Result<(), RunError> {
    refuse_repetition(&globals)?;
    let text = read(&batch.file)?;
    catch_interrupts();
    // With `--jq`, the filter is applied to each envelope separately, so the output is one JSON value for each line.
    let format = if globals.jq.is_some() { Some(Format::Jsonl) } else { globals.format };
    let globals = Globals { format, json: globals.json && globals.jq.is_none(), ..globals };
    let screen = globals.screen();
    let results: Option<Results> = (screen.format == Format::Json).then(Rc::default);
    let (manager, thread) = host::start(move |text| screen.note(text))?;
    let plan = Plan { globals: &globals, batch: &batch, screen, manager, results: results.clone(), rehearsal: None };
    let lines = plan.lines(&text)?;
    begin_trace(globals.trace.as_deref().filter(|_| !globals.dry_run))?;
    let done = plan.run_lines(lines).await;
    thread.end().await;
    if let Some(results) = results {
        screen.json(&*results.borrow())?;
    }
    done
}

/// Rejects the options for repetition, because they belong to a single line and not to the file.
pub fn refuse_repetition(globals: &Globals) -> Result<()> {
    if globals.watch.is_some() || globals.count.is_some() || globals.until.is_some() {
        return Err(Failure::usage("--watch, --count and --until cannot apply to a batch")
            .hint("write these flags after a command in the file"));
    }
    Ok(())
}

pub fn read(path: &Path) -> Result<String> {
    let limit = files::SETTINGS;
    let bytes = if path.as_os_str() == "-" { files::stdin(limit) } else { files::read(path, limit) };
    let bytes = bytes.with_context(|| path.display().to_string())?;
    let text = String::from_utf8(bytes).map_err(|_| {
        Failure::usage(format!("{}: the file is not UTF-8", path.display())).hint("save the file as UTF-8")
    })?;
    Ok(text.strip_prefix('\u{FEFF}').map_or_else(|| text.clone(), ToOwned::to_owned))
}

/// Flags of a rehearsed line. Its output is collected in one form, and its simulator stays alive after the line.
fn rehearsed(globals: Globals) -> Result<Globals> {
    if globals.config.is_some() {
        return Err(Failure::usage("a rehearsal reaches only the robots of the backup, not those of --config")
            .hint("remove --config from the line"));
    }
    Ok(Globals { format: None, json: false, jq: None, no_session: false, ..globals })
}

/// Settings of all lines.
pub struct Plan<'a> {
    /// Flags for all lines.
    pub globals: &'a Globals,
    /// Options of the file.
    pub batch: &'a Batch,
    /// Screen for notes.
    pub screen: Screen,
    /// Manager of the links that stay open between lines.
    pub manager: SessionManager,
    /// Collects the envelopes of the lines, if they are not written at once.
    pub results: Option<Results>,
    /// Records of the robots, if the lines are rehearsed.
    pub rehearsal: Option<Rehearsals>,
}

/// A line that is ready to run.
pub struct Planned {
    ready: PreparedCommand,
    /// Source location.
    pub origin: Origin,
    /// Line as the user typed it.
    pub typed: Arc<str>,
}

impl Plan<'_> {
    /// Prepares all lines. If there are errors, returns the errors of all lines.
    pub fn lines(&self, text: &str) -> Result<Vec<Planned>> {
        let file: Arc<str> = self.batch.file.display().to_string().into();
        let mut parser = Parser::default();
        let mut planned = Vec::new();
        let mut errors = Vec::new();
        for (index, line) in text.lines().enumerate() {
            let origin = Origin { file: Arc::clone(&file), line: index + 1 };
            match self.line(&mut parser, line, &origin) {
                Ok(line) => planned.extend(line),
                Err(failure) => errors.push((origin, failure)),
            }
        }
        let Some((_, first)) = errors.first() else { return Ok(planned) };
        let reasons: Vec<String> = errors
            .iter()
            .map(|(origin, failure)| {
                let hint = failure.hint.as_ref().filter(|_| errors.len() > 1);
                let hint = hint.map(|hint| format!(" ({hint})")).unwrap_or_default();
                format!("{origin}: {}{hint}", failure.message)
            })
            .collect();
        let hint = first.hint.clone().filter(|_| errors.len() == 1).unwrap_or_else(|| "correct these lines".to_owned());
        let failure = Failure::new(first.kind, reasons.join("\n"));
        Err(failure.hint(format!("{hint}; nothing was sent: armctl checks the whole file first")))
    }

    fn line(&self, parser: &mut Parser, line: &str, origin: &Origin) -> Result<Option<Planned>> {
        let usage = |why: String| Failure::usage(why).hint("see `armctl help batch`");
        let value = |name: &str| {
            let set = self.batch.set.iter().rev().find(|(other, _)| other == name);
            set.map(|(_, value)| value.as_str())
        };
        let words = line_words::split(line).map_err(usage)?;
        let words: Vec<String> = words
            .iter()
            .map(|word| line_words::expand_variables(word, value))
            .collect::<Result<_, _>>()
            .map_err(usage)?;
        if words.is_empty() {
            return Ok(None);
        }
        self.words(parser, words, line, origin).map(Some)
    }

    /// Prepares a command line. `typed` is the line as the user typed it.
    pub fn words(&self, parser: &mut Parser, words: Vec<String>, typed: &str, origin: &Origin) -> Result<Planned> {
        let args: Vec<OsString> = std::iter::once("armctl".to_owned()).chain(words).map(OsString::from).collect();
        let parsed = name_lookup::parse(parser, &args, Some(self.globals), true);
        let Words { globals, command } = parsed.map_err(|refusal| refusal.failure())?;
        let globals = if self.rehearsal.is_some() { rehearsed(globals)? } else { globals };
        let says_format = globals.format.is_some() || globals.json || globals.jq.is_some();
        if says_format && self.screen.is_json() {
            return Err(Failure::usage("a line of a batch cannot have its own output format")
                .hint("remove the format from the line"));
        }
        let typed: Arc<str> = typed.trim().into();
        let line = Line {
            typed: Arc::clone(&typed),
            manager: self.manager.clone(),
            origin: Some(origin.clone()),
            results: self.results.clone(),
            rehearsal: self.rehearsal.clone(),
        };
        let Invocation::Task(task) = command.into() else {
            return Err(Failure::usage("this command cannot run from a file").hint("see `armctl help batch`"));
        };
        let ready = PreparedCommand::new(globals, Some(self.globals), task, Some(line))?;
        if let Some(why) = ready.task.properties().why_not_in_batch {
            return Err(Failure::usage(format!("this command cannot run from a file: {why}"))
                .hint("run it in another terminal"));
        }
        if self.rehearsal.is_some() && !ready.task.properties().can_rehearse {
            return Err(Failure::usage(
                "this command cannot be rehearsed: it does not only use the robots of the backup",
            )
            .hint("remove the line from the file, or run the file with `armctl batch`"));
        }
        ready.check_gate()?;
        Ok(Planned { ready, origin: origin.clone(), typed })
    }

    /// Runs lines until the first failure.
    pub async fn run_lines(&self, lines: Vec<Planned>) -> Result<(), RunError> {
        let all = lines.len();
        let mut failed: Vec<(Origin, Failure)> = Vec::new();
        let mut started = 0;
        for Planned { ready, origin, typed } in lines {
            started += 1;
            if !self.screen.is_json() {
                self.screen.note(&format!("{origin}: {typed}"));
            }
            let PreparedCommand { run, task } = ready;
            let Err(stopped) = Box::pin(task.go(&run)).await else { continue };
            if stopped.failure.kind == Kind::PipeClosed {
                return Err(stopped);
            }
            if !stopped.is_reported && !run.report_failure(&stopped)? {
                let message = format!("{origin}: {}", stopped.failure.message);
                run.screen.failure(&Failure { message, ..stopped.failure.clone() });
            }
            let is_last = stopped.failure.kind == Kind::Interrupted || !self.batch.keep_going;
            failed.push((origin, stopped.failure));
            if is_last {
                break;
            }
        }
        let Some((origin, first)) = failed.first() else { return Ok(()) };
        let message = if self.batch.keep_going && started == all {
            let line_numbers: Vec<String> = failed.iter().map(|(origin, _)| origin.line.to_string()).collect();
            format!("{} of {all} commands failed; lines: {}", failed.len(), line_numbers.join(", "))
        } else {
            format!(
                "stopped at {}; commands done before it: {}; not started: {}",
                origin,
                started - failed.len(),
                all - started
            )
        };
        if !self.screen.is_json() {
            self.screen.note(&message);
        }
        Err(RunError { failure: Failure { message, ..first.clone() }, envelope: None, is_reported: true })
    }
}
