//! Line editor in its own thread, so that links and signals are handled while the user types.

use std::sync::mpsc as blocking;
use std::sync::{Mutex, PoisonError};

use rustyline::config::{Behavior, BellStyle, CompletionType};
use rustyline::error::ReadlineError;
use rustyline::history::FileHistory;
use rustyline::{ColorMode, Config, ExternalPrinter as _};
use tokio::sync::mpsc;

use super::assistant::Assistant;
use super::prompt::Prompt;
use armctl_frame::local_names::state_folder;
use armctl_frame::output::escape;
use armctl_frame::prelude::*;

/// Maximum number of lines in the history.
const HISTORY_SIZE: usize = 2000;

/// Result of reading a line.
#[derive(Debug)]
pub enum Input {
    /// A line. Pasted text can contain several lines.
    Line(String),
    /// Ctrl-C: the user discarded the line.
    Interrupted,
    /// The user pressed Ctrl-D, or the terminal was closed.
    End,
    /// The terminal failed.
    Failed(Failure),
}

/// Reads lines from the terminal.
#[derive(Debug)]
pub struct Editor {
    prompts: blocking::Sender<Prompt>,
    typed: mpsc::UnboundedReceiver<Input>,
}

type LineEditor = rustyline::Editor<Assistant, FileHistory>;

impl Editor {
    /// Takes control of the terminal. Returns the editor with a function that prints messages above the line that the
    /// user types.
    pub fn start(screen: &Screen, assistant: Assistant) -> Result<(Self, impl Fn(&str) + Send + Sync + 'static)> {
        let (prompts, asked) = blocking::channel();
        let (answer, typed) = mpsc::unbounded_channel();
        let mut editor = editor(screen, assistant).map_err(|error| unusable(&error))?;
        let history = History::find(&mut editor, screen);
        let printer = Mutex::new(editor.create_external_printer().ok());
        let screen = *screen;
        let say = move |text: &str| {
            let mut printer = printer.lock().unwrap_or_else(PoisonError::into_inner);
            let print =
                printer.as_mut().filter(|_| !screen.quiet).map(|to| to.print(format!("{}\n", escape::lines(text))));
            if !matches!(print, Some(Ok(()))) {
                screen.note(text);
            }
        };
        let work = move || {
            while let Ok(prompt) = asked.recv() {
                let typed = read(&mut editor, &prompt, history.as_ref());
                if answer.send(typed).is_err() {
                    return;
                }
            }
        };
        let thread = std::thread::Builder::new().name("editor".to_owned()).spawn(work);
        thread.context("start")?;
        Ok((Self { prompts, typed }, say))
    }

    /// Reads a line.
    pub async fn read(&mut self, prompt: Prompt) -> Input {
        if self.prompts.send(prompt).is_err() {
            return Input::End;
        }
        self.typed.recv().await.unwrap_or(Input::End)
    }
}

fn read(editor: &mut LineEditor, prompt: &Prompt, history: Option<&History>) -> Input {
    match editor.readline(&(&prompt.plain, &prompt.styled)) {
        Ok(line) => {
            // An error of the history is not reported, because it would be repeated for every line.
            let is_new = editor.add_history_entry(line.trim()).unwrap_or(false);
            if let Some(history) = history.filter(|_| is_new) {
                let _ = editor.append_history(&history.0);
            }
            Input::Line(line)
        }
        Err(ReadlineError::Interrupted) => Input::Interrupted,
        Err(ReadlineError::Eof) => Input::End,
        Err(error) => Input::Failed(unusable(&error)),
    }
}

fn unusable(error: &ReadlineError) -> Failure {
    Failure::local(format!("terminal error: {error}")).hint("send the lines through a pipe: `armctl repl < FILE`")
}

fn editor(screen: &Screen, assistant: Assistant) -> rustyline::Result<LineEditor> {
    let config = Config::builder()
        .max_history_size(HISTORY_SIZE)?
        .history_ignore_space(true)
        .completion_type(CompletionType::List)
        .bell_style(BellStyle::None)
        .color_mode(if screen.stdout_color() { ColorMode::Enabled } else { ColorMode::Disabled })
        // If stdout is a file, the prompt is written to the terminal.
        .behavior(if screen.is_stdout_terminal() { Behavior::Stdio } else { Behavior::PreferTerm })
        .build();
    let mut editor = LineEditor::with_config(config)?;
    editor.set_helper(Some(assistant));
    Ok(editor)
}

struct History(PathBuf);

impl History {
    fn find(editor: &mut LineEditor, screen: &Screen) -> Option<Self> {
        let folder = state_folder()?;
        let path = folder.join("history");
        let found = std::fs::create_dir_all(&folder)
            .map_err(ReadlineError::Io)
            .and_then(|()| if path.exists() { editor.load_history(&path) } else { Ok(()) });
        if let Err(error) = found {
            screen.detail(
                1,
                &format!("{}: {error}; armctl keeps the history only until the prompt ends", path.display()),
            );
            return None;
        }
        Some(Self(path))
    }
}
