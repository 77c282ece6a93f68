//! `armctl repl`: runs command lines over a link that stays open.
//!
//! On a terminal, the prompt is interactive: after an error, the user can type the next line. Input from a pipe is a
//! script: it stops at the first error, with the exit code of this error. Each line is parsed and executed like a
//! separate process. The flags of the REPL precede the flags of the line.

mod assistant;
mod editor;
mod line_parser;
mod prompt;
mod terminal;

use std::io::IsTerminal as _;

use tokio::io::{AsyncBufRead, AsyncBufReadExt as _, AsyncReadExt as _, BufReader};

use self::assistant::Assistant;
use self::editor::{Editor, Input};
use self::line_parser::{LineParser, family_help};
use self::prompt::{Prompt, RobotState, read_state};
use self::terminal::Terminal;
use super::batch::{self, refuse_repetition};
use super::parser::{Parser, Refusal};
use super::prepare::{Invocation, Need, PreparedCommand, sources};
use super::{line_words, name_lookup, refuse, report_failure};
use crate::cli::Words;
use crate::command::families;
use crate::command::fleet::session::host::{self, ManagerThread};
use armctl_frame::ConnectionEffect;
use armctl_frame::failure::omit_program_name;
use armctl_frame::flags::Globals;
use armctl_frame::interrupt::{catch_interrupts, clear_interrupt, interruptible, termination_request};
use armctl_frame::prelude::*;
use armctl_frame::run::begin_trace;
use armctl_frame::script_line::Line;
use armctl_frame::session_manager::SessionManager;

/// Whether stdin is a terminal.
pub fn can_type() -> bool {
    std::io::stdin().is_terminal()
}

/// Prints the commands of a family. Used if the command line is only the name of the family and there is no terminal.
pub fn usage(screen: &Screen, prefix: &[String]) -> RunError {
    if let Err(Refusal::Text(help)) = Parser::default().parse(&family_help(prefix)) {
        screen.usage(&help);
    }
    screen.note(&format!("`armctl {} repl` reads commands from stdin, one per line", prefix.join(" ")));
    RunError { is_reported: true, ..Failure::usage("a command is missing").into() }
}

/// Runs lines until the user leaves the prompt or the script ends.
pub async fn run(globals: Globals, prefix: Vec<String>) -> Result<(), RunError> {
    refuse_repetition(&globals)?;
    catch_interrupts();
    let repl = Repl::new(globals, prefix)?;
    begin_trace(repl.globals.trace.as_deref().filter(|_| !repl.globals.dry_run))?;
    if can_type() { Box::pin(repl.read_lines()).await } else { Box::pin(repl.script()).await }
}

/// State that all lines share.
struct Repl {
    globals: Globals,
    screen: Screen,
    line_parser: LineParser,
    /// Robot for lines that select no robot. Present only if this is one robot of a known family.
    robot: Option<Robot>,
}

/// The next action after a line.
enum Next {
    /// Run the next line.
    Line,
    /// The line failed, and the error was printed.
    Failed(Kind),
    Leave,
}

impl Repl {
    fn new(globals: Globals, mut prefix: Vec<String>) -> Result<Self> {
        let family = prefix.first().and_then(|family| family.parse::<Family>().ok());
        let sources = sources(globals.clone(), Need::Inventory, true)?;
        let has_no_selection = sources.selection.is_empty() && sources.inventory.default.is_none();
        let robots = if has_no_selection { Vec::new() } else { sources.robots(family)? };
        // A simulator without a family can belong to any family, until a line names the family.
        let is_any = family.is_none() && sources.selection.sim;
        let robot = match &robots[..] {
            [robot] if !sources.selection.is_plural() && !is_any => Some(robot.clone()),
            _ => None,
        };
        if let (true, Some(robot)) = (prefix.is_empty(), &robot) {
            prefix.push(robot.family.name().to_owned());
        }
        Ok(Self { screen: globals.screen(), globals, line_parser: LineParser::new(prefix), robot })
    }

    /// Runs lines from a terminal.
    async fn read_lines(mut self) -> Result<(), RunError> {
        let terminal = Terminal::save();
        omit_program_name();
        let (mut editor, say) = Editor::start(&self.screen, Assistant::new(&self.line_parser, &self.globals))?;
        let (manager, thread) = host::start(say)?;
        let outcome = self.prompt(&mut editor, &terminal, &manager).await;
        thread.end().await;
        outcome
    }

    async fn prompt(
        &mut self,
        editor: &mut Editor,
        terminal: &Terminal,
        manager: &SessionManager,
    ) -> Result<(), RunError> {
        // If the end of the connection would stop the robot, the connection is not opened here. The command that needs
        // the connection opens it after a confirmation.
        if let Some(robot) = &self.robot
            && !self.globals.dry_run
            && !matches!(
                (families::driver(robot).connection_effect)(robot, ConnectMode::Control),
                ConnectionEffect::Stops(_)
            )
        {
            line_of(manager, "repl").hold(robot, self.globals.trace.as_deref(), &self.screen).await?;
        }
        self.screen.note("Tab completes a word, `help` lists the commands, `exit` or Ctrl-D ends the prompt.");
        // Ctrl-C clears the line. On an empty line, the user must press Ctrl-C twice to leave.
        let mut is_second = false;
        let mut is_new = true;
        loop {
            let seen = match &self.robot {
                Some(robot) if !self.globals.dry_run => {
                    read_state(robot, &line_of(manager, "repl"), &self.screen).await
                }
                _ => RobotState::NotAsked,
            };
            if std::mem::take(&mut is_new) {
                for left in seen.leftovers() {
                    self.screen.note(&format!("left on by an earlier command: {}; {}", left.what, left.undo));
                }
            }
            let prompt = Prompt::new(self.line_parser.prefix(), self.robot.as_ref(), &seen, self.screen.stdout_color());
            let typed = tokio::select! {
                typed = editor.read(prompt) => typed,
                how = termination_request() => {
                    terminal.restore_control().await;
                    // The cursor is still behind the typed text, so a new line is started.
                    self.screen.ask_note("");
                    return Err(interrupted(how));
                }
            };
            let text = match typed {
                Input::Line(text) => text,
                Input::Interrupted if is_second => return Err(interrupted("Ctrl-C again")),
                Input::Interrupted => {
                    self.screen.note("Press Ctrl-C again, or type `exit`, to end the prompt.");
                    is_second = true;
                    continue;
                }
                Input::End => return Ok(()),
                Input::Failed(failure) => return Err(failure.into()),
            };
            is_second = false;
            // Pasted text can contain several lines.
            for line in text.lines() {
                match Box::pin(self.run_line(line, manager)).await {
                    Next::Line => {}
                    Next::Failed(_) => break,
                    Next::Leave => return Ok(()),
                }
            }
            if let Some(how) = clear_interrupt() {
                return Err(interrupted(how));
            }
        }
    }

    /// Runs the lines from a pipe or file until the first error.
    async fn script(mut self) -> Result<(), RunError> {
        let screen = self.screen;
        let (manager, thread): (SessionManager, ManagerThread) = host::start(move |text| screen.note(text))?;
        let outcome = self.lines(&manager).await;
        thread.end().await;
        outcome
    }

    async fn lines(&mut self, manager: &SessionManager) -> Result<(), RunError> {
        let mut stdin = BufReader::new(tokio::io::stdin());
        let mut number = 0;
        loop {
            number += 1;
            let Some(line) = interruptible(line(&mut stdin, number)).await?? else { return Ok(()) };
            match Box::pin(self.run_line(&line, manager)).await {
                Next::Line => {}
                Next::Failed(kind) => {
                    let failure = Failure::new(kind, format!("stopped at line {number}"));
                    if !self.screen.is_json() {
                        self.screen.note(&failure.message);
                    }
                    return Err(RunError { is_reported: true, ..failure.into() });
                }
                Next::Leave => return Ok(()),
            }
        }
    }

    async fn run_line(&mut self, text: &str, manager: &SessionManager) -> Next {
        let words = match line_words::split(text) {
            Ok(words) => words,
            Err(why) => {
                return failed(
                    &self.screen,
                    Failure::usage(why).hint("close the quotes; characters in quotes have no special meaning").into(),
                );
            }
        };
        match &words[..] {
            [] => return Next::Line,
            [word] if matches!(word.as_str(), "exit" | "quit") => return Next::Leave,
            _ => {}
        }
        let args = self.line_parser.args(&words);
        let Words { globals, command } =
            match name_lookup::parse(&mut self.line_parser.parser, &args, Some(&self.globals), true) {
                Ok(words) => words,
                // In a script, a line without a verb is an error.
                Err(error @ Refusal::Verb(..)) if !can_type() => return failed(&self.screen, error.failure().into()),
                Err(error) => {
                    return refuse(&args, &error, self.screen.is_json(), false)
                        .map_or_else(Next::Failed, |()| Next::Line);
                }
            };
        let own = globals.clone();
        let globals = globals.within(&self.globals);
        let screen = globals.screen();
        let line = line_of(manager, text);
        let done = match command.into() {
            Invocation::Task(task) => match PreparedCommand::new(own, Some(&self.globals), task, Some(line)) {
                Ok(ready) => Box::pin(ready.run()).await,
                Err(failure) => Err(failure.into()),
            },
            Invocation::Batch(batch) => Box::pin(batch::run(globals, batch)).await,
            Invocation::Rehearse(_) => {
                Err(Failure::usage("a rehearsal cannot run at the prompt").hint("end the prompt with `exit`").into())
            }
            Invocation::Teach(_) => Err(Failure::usage("the teach panel needs its own terminal")
                .hint("end the prompt, then run `armctl teach`")
                .into()),
            Invocation::Prompt(_) => {
                Err(Failure::usage("the interactive prompt is already open").hint("end the prompt with `exit`").into())
            }
            Invocation::Bare(prefix) => Err(usage(&screen, &prefix)),
        };
        done.map_or_else(|stopped| failed(&screen, stopped), |()| Next::Line)
    }
}

/// Reads the next line of a script; `None` at the end of the script.
async fn line(script: impl AsyncBufRead + Unpin, number: usize) -> Result<Option<String>> {
    /// Maximum length of a line. Input without line ends is not a script.
    const MAX_LINE_LEN: u64 = 1 << 20;

    let mut bytes = Vec::new();
    let read = script.take(MAX_LINE_LEN).read_until(b'\n', &mut bytes).await;
    let length = read.context("stdin")?;
    if u64::try_from(length).unwrap_or(u64::MAX) >= MAX_LINE_LEN {
        return Err(Failure::usage(format!("line {number} of stdin is longer than 1 MiB"))
            .hint("write one command per line; see `armctl help repl`"));
    }
    if length == 0 {
        return Ok(None);
    }
    let text = String::from_utf8(bytes).map_err(|_| {
        Failure::local(format!("line {number} of stdin is not UTF-8")).hint("convert the input: iconv -t UTF-8")
    })?;
    Ok(Some(text.trim_end_matches(['\n', '\r']).to_owned()))
}

fn line_of(manager: &SessionManager, typed: &str) -> Line {
    Line { typed: Arc::from(typed.trim()), manager: manager.clone(), origin: None, results: None, rehearsal: None }
}

fn failed(screen: &Screen, stopped: RunError) -> Next {
    Next::Failed(report_failure(screen, stopped))
}

fn interrupted(how: &str) -> RunError {
    Failure::new(Kind::Interrupted, how).into()
}
