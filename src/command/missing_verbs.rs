//! Nouns and verbs that all families share, and explanations for the families that lack a noun or verb.

use armctl_frame::failure::Failure;

/// Nouns of every family with their verbs. If a controller does not support a verb, [`MISSING`] explains that.
pub const SHARED: &[(&str, &[&str])] = &[
    ("status", &[""]),
    ("position", &[""]),
    ("alarm", &["list", "history", "watch", "reset"]),
    ("io", &["get", "set", "watch", "list"]),
    ("var", &["get", "set", "watch", "list", "dump", "restore"]),
    ("counter", &["get", "set", "watch", "list", "dump", "restore"]),
    ("timer", &["get", "set", "watch", "list", "dump", "restore"]),
    ("param", &["get", "set", "watch", "list", "dump", "restore"]),
    ("point", &["get", "set", "list", "dump", "restore", "copy", "delete"]),
    ("override", &["get", "set"]),
    ("program", &["list", "show", "get", "put", "start", "stop", "select", "search", "check"]),
    ("job", &["list", "show", "get", "put", "start", "stop", "select", "search", "check"]),
    ("move", &[""]),
    ("jog", &[""]),
    ("home", &[""]),
    ("stop", &[""]),
    ("servo", &[""]),
    ("teach", &[""]),
    ("names", &[""]),
    ("backup", &[""]),
    ("restore", &[""]),
    ("diff", &[""]),
    ("explain", &[""]),
];

/// Commands that a family lacks: words after `armctl`, reason, and what to use instead.
#[rustfmt::skip]
pub const MISSING: &[(&str, &str, &str)] = &[
    ("yerc counter", "a Yaskawa controller has no counters",
        "use a variable, because jobs count in variables: `armctl yerc var get B0`"),
    ("yerc timer", "the protocol does not read timers", "use `armctl yerc hours` to read the operating hours"),
    ("yerc param", "the protocol does not read single parameters",
        "use `armctl yerc file get '*.PRM'` to download the parameter files"),
    ("yerc point", "taught points of a Yaskawa controller are position variables P, BP and EX",
        "use `armctl yerc var get P5` to read a point; see `armctl yerc var -h`"),
    ("yerc job get", "jobs are files on a Yaskawa controller", "use `armctl yerc file get WELD.JBI` to download a job"),
    ("yerc job put", "jobs are files on a Yaskawa controller", "see `armctl yerc file put -h`"),
    ("yerc jog", "the protocol has no jog", "use moves by distances as jog steps: see `armctl yerc move relative -h`"),
    ("yerc override", "the protocol does not set the speed override",
        "set `--speed` of a move: see `armctl yerc move joint -h`; use `armctl yerc job show` to see the override of \
         a job"),
    ("yerc home", "the protocol has no return to origin",
        "start a job that moves to the home position: see `armctl yerc job -h`; set the mechanical origin at the \
         pendant"),
    ("yerc explain", "no connection is necessary to explain a code", "use `armctl explain yerc CODE`"),

    ("yrcx counter", "a YRCX has no counters",
        "use a variable, because programs count in variables: `armctl yrcx var get SGI0`"),
    ("yrcx timer", "the fieldbus does not read timers", "use `armctl yrcx program show --task 1` to see a task"),
    ("yrcx override", "a YRCX has no override, but a manual, an automatic and a program speed",
        "use `armctl yrcx info speed` to read the speeds; see `armctl yrcx speed -h` to set a speed"),
    ("yrcx point delete", "the fieldbus does not delete points", "replace the point: see `armctl yrcx point set -h`"),
    ("yrcx program list", "the fieldbus does not list programs",
        "use `armctl yrcx program show --task 1` to see the program of a task"),
    ("yrcx program get", "the fieldbus does not transfer the texts of programs", "use the maker's support software"),
    ("yrcx program put", "the fieldbus does not transfer the texts of programs", "use the maker's support software"),
    ("yrcx program search", "the fieldbus does not transfer the texts of programs",
        "use `armctl yrcx program show --task 1` to see the line that runs"),
    ("yrcx program check", "the fieldbus does not transfer the texts of programs", "use the maker's support software"),
    ("yrcx program stop", "a signal stops the programs", "use `armctl yrcx stop` to stop the robot program"),
    ("yrcx names", "a YRCX stores no names of signals",
        "use `armctl names set NAME ADDRESS` to set a name in robots.toml"),
    ("yrcx explain", "no connection is necessary to explain a code", "use `armctl explain yrcx CODE`"),
    ("yrcx hold", "a YRCX has no hold", "use `armctl yrcx stop` to stop the robot program"),

    ("toyo var", "a Toyo controller has no variables",
        "use counters, timers and parameters: `armctl toyo counter get 1`, `armctl toyo timer get 1`, `armctl toyo \
         param list`"),
    ("toyo timer set", "only programs set timers", "use `armctl toyo timer get 1` to read a timer"),
    ("toyo timer dump", "a timer changes all the time, so a file of timers has no use",
        "use `armctl toyo timer list -o csv` to print the timers"),
    ("toyo timer restore", "only programs set timers", "use `armctl toyo timer get 1` to read a timer"),
    ("toyo point delete", "the protocol does not delete points",
        "set all axes of the point to 0, which counts as empty: see `armctl toyo point set -h`"),
    ("toyo program start", "`armctl toyo run` starts the three kinds of programs", "see `armctl toyo run -h`"),
    ("toyo program stop", "one command stops programs and motions", "use `armctl toyo stop` to stop the robot"),
    ("toyo program select", "each task has one sequential program",
        "use `armctl toyo task set 2` to select the task; see `armctl toyo palletizing -h` for palletizing programs"),
    ("toyo move", "the protocol moves only to taught points", "see `armctl toyo run -h`"),
    ("toyo names", "a Toyo controller stores no names of signals",
        "use `armctl names set NAME ADDRESS` to set a name in robots.toml"),
    ("toyo explain", "no connection is necessary to explain a code", "use `armctl explain toyo CODE`"),
    ("toyo hold", "the protocol has no hold", "use `armctl toyo stop` to stop programs and motions"),
];

/// Failure for a line with a command that the family lacks. `path` has the words that lead to a command, by its own
/// name and not by an alias.
pub fn missing(path: &[&str], rest: &[&str]) -> Option<Failure> {
    let typed: Vec<&str> = path.iter().chain(rest).copied().collect();
    let is_meant = |(words, ..): &&(&str, &str, &str)| {
        let words: Vec<&str> = words.split(' ').collect();
        words.len() > path.len() && typed.starts_with(&words)
    };
    let (words, why, instead) = MISSING.iter().find(is_meant)?;
    Some(Failure::usage(format!("{words}: {why}")).hint(*instead))
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;
    use crate::cli::Cli;
    use armctl_frame::settings::target::Family;

    /// Whether the words lead to a command, by its own name or by an alias.
    fn exists(line: &str) -> bool {
        let root = Cli::command();
        line.split(' ').try_fold(&root, |command, word| command.find_subcommand(word)).is_some()
    }

    /// The line with aliases replaced by the commands' own names, as far as the words lead to a command.
    fn own_names(line: &str) -> String {
        let root = Cli::command();
        let mut command = Some(&root);
        let words = line.split(' ').map(|word| {
            command = command.and_then(|command| command.find_subcommand(word));
            command.map_or(word, clap::Command::get_name).to_owned()
        });
        words.collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn every_shared_verb_works_or_explains_what_is_missing() {
        let mut silent = Vec::new();
        for family in Family::ALL {
            for verb in SHARED.iter().flat_map(|(noun, verbs)| verbs.iter().map(move |verb| format!("{noun} {verb}"))) {
                let line = own_names(&format!("{family} {}", verb.trim_end()));
                let is_told = MISSING.iter().any(|(words, ..)| format!("{line} ").starts_with(&format!("{words} ")));
                if exists(&line) == is_told {
                    silent.push(format!("{line}: a command {}, a sentence {is_told}", exists(&line)));
                }
            }
        }
        assert!(silent.is_empty(), "one of both is wanted: {silent:#?}");
    }

    #[test]
    fn explanations_name_existing_commands() {
        for (words, why, instead) in MISSING {
            assert!(!exists(words), "{words} is a command");
            assert!(!why.contains("armctl") || why.contains('`'), "{words}: {why}");
            for line in instead.split('`').skip(1).step_by(2) {
                let words = line.trim_start_matches("armctl ").split(' ');
                let words: Vec<&str> =
                    words.take_while(|word| word.bytes().all(|byte| byte.is_ascii_lowercase())).collect();
                let leads = words
                    .iter()
                    .try_fold(&Cli::command(), |command, word| {
                        command.find_subcommand(word).or_else(|| (!command.has_subcommands()).then_some(command))
                    })
                    .is_some();
                assert!(leads, "{line}");
            }
        }
    }
}
