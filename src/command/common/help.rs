//! `armctl help [TOPIC | COMMAND …]`.

use clap::{Args, CommandFactory as _};

use crate::cli::Cli;
use crate::command::ValueKind;
use crate::command::run::Run;
use crate::controller::nearest::nearest;
use crate::controller::{toyo, yerc, yrcx};
use crate::failure::{Failure, Kind};

/// Explains a topic, or a command.
#[derive(Debug, Args)]
pub struct Help {
    /// A topic (exit-codes, targets, inventory, output, safety, scripting, sessions, repl, batch,
    /// completion, simulator, toyo-setup, yerc-setup, yrcx-setup), or a command
    #[arg(add = ValueKind::HelpWord)]
    words: Vec<String>,
}

/// Topics with a line about each and their text.
const TOPICS: [(&str, &str, &str); 14] = [
    ("targets", "how to say which robot", include_str!("topics/targets.txt")),
    ("inventory", "robots.toml", include_str!("topics/inventory.txt")),
    ("output", "tables, JSON, jq, colour", include_str!("topics/output.txt")),
    ("safety", "what asks, what refuses, what Ctrl-C does", include_str!("topics/safety.txt")),
    ("scripting", "watching, waiting, piping", include_str!("topics/scripting.txt")),
    ("sessions", "links that outlive commands", include_str!("topics/sessions.txt")),
    ("repl", "a prompt for one robot", include_str!("topics/repl.txt")),
    ("batch", "files of commands", include_str!("topics/batch.txt")),
    ("completion", "what Tab offers, in which shells", include_str!("topics/completion.txt")),
    (SIMULATOR, "servers, start state, console, faults", include_str!("topics/simulator.txt")),
    ("profibus", "a YRCX over PROFIBUS DP", include_str!("topics/profibus.txt")),
    ("toyo-setup", "cable and settings of a Toyo controller", include_str!("topics/toyo-setup.txt")),
    ("yerc-setup", "settings of an FS100 or DX200", include_str!("topics/yerc-setup.txt")),
    ("yrcx-setup", "settings of a YRCX", include_str!("topics/yrcx-setup.txt")),
];

/// The topic that ends with the examples that the simulators' own tests read.
const SIMULATOR: &str = "simulator";

/// The topic that is made from the table of failures.
const EXIT_CODES: &str = "exit-codes";

impl Help {
    pub(super) fn run(self, run: &Run) -> Result<(), Failure> {
        run.screen.data(&text(&self.words, run.screen.stdout_color())?)
    }
}

/// Every topic with a line about it.
pub fn topics() -> impl Iterator<Item = (&'static str, &'static str)> {
    let exit = (EXIT_CODES, "what the exit codes mean");
    std::iter::once(exit).chain(TOPICS.iter().map(|(name, about, _)| (*name, *about)))
}

/// The help on some words; on none, that of the whole tool and the list of topics.
pub fn text(words: &[String], color: bool) -> Result<String, Failure> {
    if let [word] = words {
        if word == EXIT_CODES {
            return Ok(exit_codes());
        }
        if let Some((.., text)) = TOPICS.iter().find(|(name, ..)| name == word) {
            let examples = if word == SIMULATOR { start_states() } else { String::new() };
            return Ok(format!("{text}{examples}"));
        }
    }
    let mut root = Cli::command();
    root.build();
    let mut command = &mut root;
    for word in words {
        let known: Vec<String> = command.get_subcommands().map(|sub| sub.get_name().to_owned()).collect();
        let Some(sub) = command.find_subcommand_mut(word) else {
            let failure = Failure::usage(format!("there is no topic or command '{word}'"));
            let topics = topics().map(|(name, _)| name);
            return Err(match nearest(word, known.iter().map(String::as_str).chain(topics)) {
                Some(near) => failure.hint(format!("did you mean '{near}'?")),
                None => failure.hint("`armctl help` lists topics and commands"),
            });
        };
        command = sub;
    }
    let help = command.render_long_help();
    let mut text = if color { help.ansi().to_string() } else { help.to_string() };
    if words.is_empty() {
        text.push_str("\nTopics (armctl help TOPIC):\n");
        for (name, about) in topics() {
            text.push_str(&format!("  {name:<12} {about}\n"));
        }
    }
    Ok(text)
}

fn start_states() -> String {
    let [yerc, yrcx, toyo] = [yerc::simulator::EXAMPLE, yrcx::simulator::EXAMPLE, toyo::simulator::EXAMPLE];
    format!("{yerc}\nThis one those of yrcx:\n\n{yrcx}\nAnd this one those of toyo:\n\n{toyo}")
}

fn exit_codes() -> String {
    Kind::TABLE.iter().map(|(_, exit, meaning)| format!("{exit:>4}  {meaning}\n")).collect()
}
