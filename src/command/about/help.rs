//! `armctl help [TOPIC | COMMAND …]`.

use clap::Command;
use clap::builder::StyledStr;

use super::{environment, page};
use crate::command::families::FAMILIES;
use armctl_frame::face::Face;
use armctl_frame::prelude::*;

/// Show the help of a topic or a command.
#[derive(Debug, Args)]
pub struct Help {
    /// A topic (options, exit-codes, environment, targets, inventory, output, safety, scripting, sessions, repl, batch,
    /// completion, simulator, toyo-setup, toyo-instructions, yerc-setup, yrcx-setup), or a command
    #[arg(add = ValueKind::HelpWord)]
    words: Vec<String>,
}

/// Topics with summary and text.
const TOPICS: [(&str, &str, &str); 13] = [
    ("targets", "select a robot; URLs", include_str!("topics/targets.txt")),
    ("devicenet", "adapters, first contact, lamps", include_str!("topics/devicenet.txt")),
    ("profibus", "wiring, URL, first contact", include_str!("topics/profibus.txt")),
    ("profinet", "requirements, URL, first contact", include_str!("topics/profinet.txt")),
    ("inventory", "robots.toml", include_str!("topics/inventory.txt")),
    ("output", "tables, JSON, jq, color", include_str!("topics/output.txt")),
    ("safety", "risks, confirmation, Ctrl-C", include_str!("topics/safety.txt")),
    ("scripting", "JSON, exit codes, waiting", include_str!("topics/scripting.txt")),
    ("sessions", "keep a connection open", include_str!("topics/sessions.txt")),
    ("repl", "interactive prompt", include_str!("topics/repl.txt")),
    ("batch", "command files", include_str!("topics/batch.txt")),
    ("completion", "Tab in five shells", include_str!("topics/completion.txt")),
    (SIMULATOR, "servers, start state, console, faults", include_str!("topics/simulator.txt")),
];

/// Topic that ends with the start state examples, which are also tested.
const SIMULATOR: &str = "simulator";

/// Topic that is generated from the table of failures.
const EXIT_CODES: &str = "exit-codes";

/// Topic that is generated from the table of variables.
const ENVIRONMENT: &str = "environment";

/// Topic that is generated from the options of every command.
const OPTIONS: &str = "options";

impl Help {
    /// Prints the help; `root` creates the whole command line.
    pub fn run(self, run: &Run, root: fn() -> Command) -> Result<()> {
        run.screen.read(&text(&self.words, run.screen.stdout_color(), root)?)
    }
}

/// Every topic with its summary.
pub fn topics() -> impl Iterator<Item = (String, &'static str)> {
    let generated = [
        (OPTIONS, "options of every command"),
        (EXIT_CODES, "meaning of the exit codes"),
        (ENVIRONMENT, "environment variables"),
    ];
    let made = generated.into_iter().map(|(name, about)| (name.to_owned(), about));
    let texts = TOPICS.iter().map(|(name, about, _)| ((*name).to_owned(), *about));
    let more = sections().into_iter().map(|(name, about, _)| (name.to_owned(), about));
    made.chain(texts).chain(setups().into_iter().map(|(name, about, _)| (name, about))).chain(more)
}

/// Additional topics of the families.
fn sections() -> Vec<(&'static str, &'static str, String)> {
    FAMILIES.iter().flat_map(|face| (face.topics)()).collect()
}

/// Setup topics of the families.
fn setups() -> Vec<(String, &'static str, &'static str)> {
    let mut setups = FAMILIES.map(|face| {
        let (about, text) = face.setup;
        (format!("{}-setup", face.family), about, text)
    });
    setups.sort_unstable();
    setups.into()
}

/// Help for these words; without words, the help of armctl and the list of topics.
pub fn text(words: &[String], color: bool, root: fn() -> Command) -> Result<String> {
    if let [word] = words {
        if word == EXIT_CODES {
            return Ok(exit_codes());
        }
        if word == ENVIRONMENT {
            return Ok(environment::text());
        }
        if let Some((.., text)) = TOPICS.iter().find(|(name, ..)| name == word) {
            let examples = if word == SIMULATOR { start_states() } else { String::new() };
            return Ok(format!("{text}{examples}"));
        }
        if let Some((.., text)) = setups().iter().find(|(name, ..)| name == word) {
            return Ok((*text).to_owned());
        }
        if let Some((.., text)) = sections().into_iter().find(|(name, ..)| name == word) {
            return Ok(text);
        }
    }
    let mut root = root();
    root.build();
    let shown = |help: StyledStr| if color { help.ansi().to_string() } else { help.to_string() };
    if words == [OPTIONS] {
        return Ok(shown(page::options(&root)));
    }
    let mut command = &root;
    for word in words {
        let subcommands: Vec<String> = command.get_subcommands().map(|sub| sub.get_name().to_owned()).collect();
        let Some(sub) = command.find_subcommand(word) else {
            let failure = Failure::usage(format!("unknown topic or command '{word}'"));
            let known: Vec<String> = subcommands.into_iter().chain(topics().map(|(name, _)| name)).collect();
            return Err(match nearest(word, known.iter().map(String::as_str)) {
                Some(near) => failure.hint(format!("did you mean '{near}'?")),
                None => failure.hint("list topics and commands: `armctl help`"),
            });
        };
        command = sub;
    }
    let path: Vec<&str> = words.iter().map(String::as_str).collect();
    let mut text = shown(page::page(&root, &path, true));
    if words.is_empty() {
        text.push_str("\nTopics (armctl help TOPIC):\n");
        let width = topics().map(|(name, _)| name.len()).max().unwrap_or_default();
        for (name, about) in topics() {
            text.push_str(&format!("  {name:<width$}  {about}\n"));
        }
    }
    Ok(text)
}

fn start_states() -> String {
    let example = |face: &&Face| {
        format!(
            "
Keys of {}:

{}",
            face.family,
            comments_above(face.start_state)
        )
    };
    FAMILIES.iter().map(example).collect()
}

/// Width of a topic.
const COLUMNS: usize = 80;

/// Moves the comment of a long line above the line.
fn comments_above(toml: &str) -> String {
    let wrap_columns = |line: &str| match line.rsplit_once("  # ") {
        Some((code, comment)) if line.chars().count() > COLUMNS => format!("# {comment}\n{}\n", code.trim_end()),
        _ => format!("{line}\n"),
    };
    toml.lines().map(wrap_columns).collect()
}

fn exit_codes() -> String {
    Kind::TABLE.iter().map(|(_, exit, meaning)| format!("{exit:>4}  {meaning}\n")).collect()
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;
    use crate::cli::Cli;

    #[test]
    fn topics_fit_80_columns() {
        for (name, _) in topics().filter(|(name, _)| name != OPTIONS) {
            let text = text(std::slice::from_ref(&name), false, Cli::command).unwrap();
            // A TOML table is on one line.
            let may_be_long = |line: &&str| line.contains(" = ") && !line.contains("  # ");
            let long = text.lines().filter(|line| line.chars().count() > COLUMNS && !may_be_long(line));
            let long: Vec<&str> = long.collect();
            assert!(long.is_empty(), "{name}: {long:#?}");
        }
    }
}
