//! Output: the only module that writes to stdout and stderr.
//!
//! stdout contains only data. Prompts, progress, hints and logs are written to stderr.

pub mod busy_work;
pub mod csv;
pub mod editor;
pub mod envelope;
pub mod escape;
pub mod fullscreen;
pub mod immediate_exit;
pub mod jq;
pub mod log;
mod pager;
pub mod painter;
pub mod progress;
pub mod prompt;
mod question;
pub mod redraw;
pub mod render;
pub mod view;
mod wrap;

use std::io::{self, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::Context as _;
use serde::Serialize;

use crate::failure::{Failure, Kind, pasteable};

/// Output format.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Format {
    /// Tables for people.
    Table,
    /// One envelope, or an array of envelopes.
    Json,
    /// One envelope per line, with the time.
    Jsonl,
    /// Comma-separated values.
    Csv,
    /// Only values, separated by tabs, for a shell.
    Value,
}

impl Format {
    /// Whether the format writes a report as rows, with columns from the schema of the report.
    pub fn is_rows(self) -> bool {
        matches!(self, Self::Csv | Self::Value)
    }
}

/// Use of color.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum ColorChoice {
    /// On a terminal with colors, or if `CLICOLOR_FORCE` is set, but not if `NO_COLOR` is set.
    Auto,
    /// Always, even in a file.
    Always,
    /// Never.
    Never,
}

/// Output settings, and functions that print.
#[derive(Debug, Clone, Copy)]
#[expect(clippy::struct_excessive_bools, reason = "each is an independent flag")]
pub struct Screen {
    /// Format of the data on stdout.
    pub format: Format,
    /// Whether only errors and questions are printed on stderr.
    pub quiet: bool,
    /// Verbosity: 1 (`-v`) summary, 2 (`-vv`) frames, 3 (`-vvv`) bytes.
    pub verbosity: u8,
    color: ColorChoice,
    pager: bool,
    plain_errors: bool,
    questions: bool,
}

impl Screen {
    /// Creates the output settings from flags and environment.
    pub fn new(format: Format, color: ColorChoice, quiet: bool, verbosity: u8) -> Self {
        Self { format, quiet, verbosity, color, pager: false, plain_errors: false, questions: true }
    }

    /// Sets whether errors are printed as plain text even if the data is JSON. Only `--jq` uses this.
    #[must_use]
    pub fn with_plain_errors(self, plain_errors: bool) -> Self {
        Self { plain_errors, ..self }
    }

    /// Sets whether questions are allowed.
    #[must_use]
    pub fn with_questions(self, questions: bool) -> Self {
        Self { questions, ..self }
    }

    /// Sets whether long texts are shown in a pager.
    #[must_use]
    pub fn with_pager(self, pager: bool) -> Self {
        Self { pager, ..self }
    }

    /// Returns output settings that print only errors, as JSON. For tests.
    #[cfg(any(test, feature = "testing"))]
    pub const fn silent() -> Self {
        Self {
            format: Format::Json,
            quiet: true,
            verbosity: 0,
            color: ColorChoice::Never,
            pager: false,
            plain_errors: false,
            questions: true,
        }
    }

    /// Returns the same settings, but only errors are printed.
    #[must_use]
    pub fn silenced(self) -> Self {
        Self { quiet: true, verbosity: 0, ..self }
    }

    /// Whether errors are printed as JSON.
    pub fn is_json(&self) -> bool {
        matches!(self.format, Format::Json | Format::Jsonl) && !self.plain_errors
    }

    /// Whether stdout is a terminal.
    pub fn is_stdout_terminal(&self) -> bool {
        io::stdout().is_terminal()
    }

    /// Whether the user can press Ctrl-C, because stdin is a terminal.
    pub fn can_interrupt(&self) -> bool {
        io::stdin().is_terminal()
    }

    /// Whether the user can select something that is missing in the command line. Questions must be allowed, and the
    /// output must not be for a program.
    pub fn can_choose(&self) -> bool {
        self.can_ask() && !self.is_json() && std::env::var_os("CI").is_none_or(|value| value.is_empty())
    }

    /// Whether the user can be asked, because stdin and stderr are terminals and questions are allowed.
    pub fn can_ask(&self) -> bool {
        self.questions && io::stdin().is_terminal() && io::stderr().is_terminal()
    }

    /// Whether progress on stderr can be redrawn.
    pub fn can_redraw(&self) -> bool {
        !self.quiet && io::stderr().is_terminal() && !is_dumb()
    }

    /// Whether a table on stdout can replace the previous one.
    pub fn can_replace(&self) -> bool {
        self.format == Format::Table && io::stdout().is_terminal() && !is_dumb()
    }

    /// Width of tables in columns.
    pub fn width(&self) -> u16 {
        if io::stdout().is_terminal() { console_width() } else { 80 }
    }

    /// Whether output on stdout has colors.
    pub fn stdout_color(&self) -> bool {
        self.wants_color(io::stdout().is_terminal())
    }

    fn wants_color(&self, is_terminal: bool) -> bool {
        let has_colors = is_terminal && shows_colors();
        match self.color {
            ColorChoice::Always => true,
            ColorChoice::Never => false,
            ColorChoice::Auto => {
                let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
                let is_forced = set("CLICOLOR_FORCE").is_some_and(|value| value != "0");
                set("NO_COLOR").is_none() && (is_forced || (has_colors && !is_dumb()))
            }
        }
    }

    /// Writes data.
    pub fn data(&self, text: &str) -> Result<(), Failure> {
        self.bytes(text.as_bytes())
    }

    /// Writes bytes to stdout.
    pub fn bytes(&self, bytes: &[u8]) -> Result<(), Failure> {
        let _busy = busy_work::register();
        let mut stdout = io::stdout().lock();
        Ok(stdout.write_all(bytes).and_then(|()| stdout.flush()).context("stdout")?)
    }

    /// Writes a value as JSON. In a pipe or with `jsonl`, this is one line; on a terminal, the JSON is indented.
    pub fn json(&self, value: &impl Serialize) -> Result<(), Failure> {
        let _busy = busy_work::register();
        let pretty = self.format == Format::Json && self.is_stdout_terminal();
        let mut text = if pretty { escape::json_pretty(value) } else { escape::json_line(value) }
            .map_err(|error| Failure::local(format!("cannot write the report as JSON: {error}")))?;
        text.push('\n');
        self.data(&text)
    }

    /// Writes a value as JSON. The text is not built in memory first.
    pub fn json_as_it_comes(&self, value: &impl Serialize) -> Result<(), Failure> {
        let pretty = self.format == Format::Json && self.is_stdout_terminal();
        let mut stdout = io::BufWriter::new(io::stdout().lock());
        let written = escape::json_to(&mut stdout, value, pretty).map_err(io::Error::from);
        let ended = written.and_then(|()| stdout.write_all(b"\n")).and_then(|()| stdout.flush());
        Ok(ended.context("stdout")?)
    }

    /// Prints a message on stderr, unless `--quiet` is set.
    pub fn note(&self, text: &str) {
        if !self.quiet {
            Self::prose(&format!("{}\n", escape::lines(text)));
        }
    }

    /// Prints a description and a command line below it on stderr, unless `--quiet`. The command line is not wrapped: a
    /// line feed in a pasted command would end the command early.
    pub fn note_command(&self, description: &str, command: &str) {
        self.note(description);
        if !self.quiet {
            Self::stderr(&format!("  {}\n", escape::line(command)));
        }
    }

    /// Prints a note that the output is from a simulator, once, and only on a terminal.
    pub fn note_simulator(&self) {
        static IS_PRINTED: AtomicBool = AtomicBool::new(false);

        if self.format == Format::Table && io::stderr().is_terminal() && !IS_PRINTED.swap(true, Ordering::Relaxed) {
            self.note("this is the built-in simulator, not a controller");
        }
    }

    /// Prints progress of long work where a progress bar is not possible. Nothing is printed if stderr is for a
    /// program.
    pub fn step(&self, text: &str) {
        if !self.can_redraw() && !self.is_json() {
            self.note(text);
        }
    }

    /// Prints a message on stderr if the verbosity is at least `level`.
    pub fn detail(&self, level: u8, text: &str) {
        if self.verbosity >= level {
            Self::prose(&format!("{}\n", escape::lines(text)));
        }
    }

    /// Prints a failure on stderr: `error:`, then an empty line and `hint:`.
    pub fn failure(&self, failure: &Failure) {
        if failure.kind == Kind::PipeClosed || failure.is_in_report {
            return;
        }
        if let Kind::Halted(_) = failure.kind {
            return Self::stderr(&escape::lines(&failure.message));
        }
        let label = if failure.kind == Kind::Interrupted { "interrupted:" } else { "error:" };
        let code = failure.code.as_ref().map(|code| format!(" [{code}]")).unwrap_or_default();
        let hint = failure
            .hint
            .as_ref()
            .map(|hint| format!("\n{} {}\n", self.paint_stderr("1;36", "hint:"), escape::lines(&pasteable(hint))));
        let message = escape::lines(&failure.message);
        Self::prose(&format!("{} {message}{code}\n{}", self.paint_stderr("1;31", label), hint.unwrap_or_default()));
    }

    /// Formats a word for stderr, with color if possible.
    fn paint_stderr(&self, code: &str, word: &str) -> String {
        let color = self.wants_color(io::stderr().is_terminal());
        if color { format!("\x1b[{code}m{word}\x1b[0m") } else { word.to_owned() }
    }

    /// Prints a usage error of the parser.
    pub fn usage(&self, text: &clap::builder::StyledStr) {
        let color = self.wants_color(io::stderr().is_terminal());
        Self::prose(&if color { text.ansi().to_string() } else { text.to_string() });
    }

    /// Prints a line of JSON on stderr.
    pub fn failure_json(&self, value: &impl Serialize) {
        match escape::json_line(value) {
            Ok(text) => Self::stderr(&format!("{text}\n")),
            Err(error) => Self::stderr(&format!("error: {error}\n")),
        }
    }

    /// Prints text for people. On a terminal, lines are broken between words.
    fn prose(text: &str) {
        if io::stderr().is_terminal() {
            let (_, columns) = dialoguer::console::Term::stderr().size();
            Self::stderr(&wrap::wrap(text, columns.max(40).into()));
        } else {
            Self::stderr(text);
        }
    }

    /// Writes to stderr. An error is ignored, because it cannot be reported. The exit code still shows the result.
    fn stderr(text: &str) {
        let _ = io::stderr().lock().write_all(text.as_bytes());
    }
}

/// Whether the terminal can show colors.
#[cfg(unix)]
const fn shows_colors() -> bool {
    true
}

/// Whether the console can show colors. Switches escape sequences on, because the console of an old Windows starts
/// without them.
#[cfg(windows)]
fn shows_colors() -> bool {
    ratatui::crossterm::ansi_support::supports_ansi()
}

fn is_dumb() -> bool {
    std::env::var_os("TERM").is_some_and(|term| term == "dumb")
}

fn console_width() -> u16 {
    let (_, columns) = dialoguer::console::Term::stdout().size();
    columns.max(40)
}
