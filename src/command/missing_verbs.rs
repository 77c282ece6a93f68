//! The nouns and verbs that all families share, and what a family says that lacks one.

use crate::failure::Failure;

/// Verbs of every family. Where a controller cannot do one, [`MISSING`] has a sentence for it.
pub const SHARED: &[&str] = &[
    "status",
    "position",
    "alarm list",
    "alarm history",
    "alarm watch",
    "alarm reset",
    "io get",
    "io set",
    "io watch",
    "io list",
    "var get",
    "var set",
    "var watch",
    "var list",
    "var dump",
    "var restore",
    "counter get",
    "counter set",
    "counter watch",
    "counter list",
    "counter dump",
    "counter restore",
    "timer get",
    "timer set",
    "timer watch",
    "timer list",
    "timer dump",
    "timer restore",
    "param get",
    "param set",
    "param watch",
    "param list",
    "param dump",
    "param restore",
    "point get",
    "point set",
    "point list",
    "point dump",
    "point restore",
    "point copy",
    "point delete",
    "override get",
    "override set",
    "program list",
    "program show",
    "program get",
    "program put",
    "program start",
    "program stop",
    "program select",
    "program search",
    "program check",
    "job list",
    "job show",
    "job get",
    "job put",
    "job start",
    "job stop",
    "job select",
    "job search",
    "job check",
    "move",
    "jog",
    "home",
    "stop",
    "servo",
    "teach",
    "names",
    "backup",
    "restore",
    "diff",
    "explain",
];

/// What a family lacks: its words behind `armctl`, what it says, and what to use instead.
#[rustfmt::skip]
pub const MISSING: &[(&str, &str, &str)] = &[
    ("yerc counter", "a Yaskawa controller has no counters", "jobs count in variables: `armctl yerc var get B0`"),
    ("yerc timer", "the protocol does not read timers", "`armctl yerc hours` reads the operating hours"),
    ("yerc param", "the protocol does not read single parameters",
        "`armctl yerc file get '*.PRM'` downloads the parameter files"),
    ("yerc point", "taught points of a Yaskawa controller are position variables P, BP and EX",
        "`armctl yerc var get P5` reads one; see `armctl yerc var -h`"),
    ("yerc job get", "jobs are files on a Yaskawa controller", "`armctl yerc file get WELD.JBI` downloads one"),
    ("yerc job put", "jobs are files on a Yaskawa controller", "see `armctl yerc file put -h`"),
    ("yerc job search", "the protocol does not search in jobs", "`armctl yerc job show --source` shows the line that runs"),
    ("yerc job check", "the controller checks a job when it is loaded", "see `armctl yerc file put -h`"),
    ("yerc jog", "the protocol has no jog", "moves by distances are its steps: see `armctl yerc move relative -h`"),
    ("yerc override", "the protocol does not set the speed override",
        "moves take `--speed`: see `armctl yerc move joint -h`; `armctl yerc job show` shows the override of a job"),
    ("yerc home", "the protocol has no return to origin",
        "a job can move to the home position: see `armctl yerc job -h`; the mechanical origin is set at the pendant"),
    ("yerc explain", "codes are explained without a connection", "`armctl explain yerc CODE`"),

    ("yrcx counter", "a YRCX has no counters", "programs count in variables: `armctl yrcx var get SGI0`"),
    ("yrcx timer", "the fieldbus does not read timers", "`armctl yrcx program show` shows the tasks"),
    ("yrcx override", "a YRCX has a manual, an automatic and a program speed",
        "`armctl yrcx info speed` reads them; to set one, see `armctl yrcx speed -h`"),
    ("yrcx point delete", "the fieldbus does not delete points", "to replace a point, see `armctl yrcx point set -h`"),
    ("yrcx program list", "the fieldbus does not list programs", "`armctl yrcx program show` shows which one each task runs"),
    ("yrcx program get", "the fieldbus carries no texts of programs", "use the maker's support software"),
    ("yrcx program put", "the fieldbus carries no texts of programs", "use the maker's support software"),
    ("yrcx program search", "the fieldbus carries no texts of programs", "`armctl yrcx program show` shows which line runs"),
    ("yrcx program check", "the fieldbus carries no texts of programs", "use the maker's support software"),
    ("yrcx program stop", "programs stop by a signal", "`armctl yrcx stop` stops the robot program"),
    ("yrcx names", "a YRCX keeps no names of signals", "`armctl names set NAME ADDRESS` gives one in robots.toml"),
    ("yrcx explain", "codes are explained without a connection", "`armctl explain yrcx CODE`"),
    ("yrcx hold", "a YRCX has no hold", "`armctl yrcx stop` stops the robot program"),

    ("toyo var", "a Toyo controller has no variables",
        "it has counters, timers and parameters: `armctl toyo counter get 1`, `armctl toyo timer get 1`, `armctl toyo param list`"),
    ("toyo timer set", "only programs set timers", "`armctl toyo timer get 1` reads one"),
    ("toyo timer dump", "a timer runs, so a file of timers has no use", "`armctl toyo timer list -o csv` prints the timers"),
    ("toyo timer restore", "only programs set timers", "`armctl toyo timer get 1` reads one"),
    ("toyo point delete", "the protocol does not delete points",
        "a point with all axes at 0 counts as empty: see `armctl toyo point set -h`"),
    ("toyo program start", "programs of three kinds are started by `armctl toyo run`", "see `armctl toyo run -h`"),
    ("toyo program stop", "one command stops all that moves", "`armctl toyo stop` stops it"),
    ("toyo program select", "each task has one sequential program",
        "`armctl toyo task set 2` selects the task; see `armctl toyo palletizing -h` for the others"),
    ("toyo move", "the protocol moves to taught points only", "see `armctl toyo run -h`"),
    ("toyo names", "a Toyo controller keeps no names of signals", "`armctl names set NAME ADDRESS` gives one in robots.toml"),
    ("toyo explain", "codes are explained without a connection", "`armctl explain toyo CODE`"),
    ("toyo hold", "the protocol has no hold", "`armctl toyo stop` stops what moves"),
];

/// What is said of a line whose words lead to what a family lacks. `path` are those that lead to a command, by its own
/// names.
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
    use crate::settings::target::Family;

    /// Whether words lead to a command, by its own name or another.
    fn exists(line: &str) -> bool {
        let root = Cli::command();
        line.split(' ').try_fold(&root, |command, word| command.find_subcommand(word)).is_some()
    }

    /// The line by the commands' own names, as far as it leads.
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
            for verb in SHARED {
                let line = own_names(&format!("{family} {verb}"));
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
