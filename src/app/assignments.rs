//! Converts an argument `NAME=VALUE` for commands that expect name and value in another form: as two words (`counter
//! set 1 0`), or with a flag (`point set 7 --mm 1,2,3,4`).

use std::ffi::OsString;

use clap::Command;

use super::typed_line::TypedLine;
use armctl_frame::setting::Pair;

/// Converts a command line to the form that its command expects. Returns `None` if no conversion is necessary.
pub fn split_assignments(args: &[OsString], whole: &Command) -> Option<Vec<OsString>> {
    if !args.iter().any(|word| word == "set") {
        return None;
    }
    let typed = TypedLine::new(args, whole);
    let verb = typed.path.iter().try_fold(whole, |command, word| command.find_subcommand(word))?;
    if verb.get_name() != "set" {
        return None;
    }
    let mut line: Vec<Vec<OsString>> = args.iter().map(|word| vec![word.clone()]).collect();
    if let Some(Pair { name, is_list }) = Pair::of(verb) {
        let (word, value) = typed.rest.get(name)?.split_once('=')?;
        let values: Vec<&str> = if is_list { value.split(',').collect() } else { vec![value] };
        // A value must not be interpreted as a flag.
        if values.iter().any(|value| value.starts_with('-') && value.parse::<f64>().is_err()) {
            return None;
        }
        *line.get_mut(*typed.rest_positions.get(name)?)? =
            std::iter::once(word).chain(values).map(OsString::from).collect();
    } else {
        for (at, word) in typed.rest_positions.iter().zip(&typed.rest).skip(1) {
            let flag = word.split_once('=').map(|(name, _)| name);
            let mut own_flags = verb.get_arguments().filter(|argument| !argument.is_global_set());
            if flag.is_some() && own_flags.any(|argument| argument.get_long() == flag) {
                line[*at] = vec![format!("--{word}").into()];
            }
        }
    }
    Some(line.concat())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use clap::CommandFactory as _;

    use super::super::parser::Parser;
    use super::*;
    use crate::cli::Cli;

    /// All verbs that read numbered items, with the first and last item of a range.
    const RANGES: &[(&str, &str, &str)] = &[
        ("toyo accel-table get", "1", "3"),
        ("toyo counter get", "1", "3"),
        ("toyo easy get", "1", "3"),
        ("toyo mvm get", "1", "3"),
        ("toyo point get", "1", "3"),
        ("toyo speed-table get", "1", "3"),
        ("toyo timer get", "1", "3"),
        ("toyo torque-table get", "1", "3"),
        ("io get", "20010", "20012"),
        ("toyo io get", "IN1", "IN3"),
        ("yerc io get", "20010", "20012"),
        ("yerc register get", "1", "3"),
        ("yerc var get", "B1", "B3"),
        ("yrcx alarm history", "1", "3"),
        ("yrcx comment get", "1", "3"),
        ("yrcx hand-data get", "1", "3"),
        ("yrcx io get", "SO20", "SO22"),
        ("yrcx pallet-data get", "1", "3"),
        ("yrcx point get", "1", "3"),
        ("yrcx port get", "DO2", "DO4"),
        ("yrcx shift-data get", "1", "3"),
        ("yrcx var get", "SGI1", "SGI3"),
    ];

    /// `get` commands without a range of numbers, because they read names, one program, or several numbers of one
    /// object.
    const NO_RANGES: [&str; 6] = [
        "toyo palletizing get",
        "toyo param get",
        "toyo program get",
        "yerc file get",
        "yrcx eip get",
        "yrcx param get",
    ];

    /// All `set` commands, in the form that they have in common.
    const SETTINGS: &[&str] = &[
        "toyo accel-table set 5=0.25",
        "toyo counter set 1=0",
        "toyo easy set 1=10,5,20",
        "toyo easy set 1 loop=5",
        "toyo io set OUT1.3=on",
        "toyo mvm set 1 origin=5",
        "toyo palletizing set 1 source-p1=100,0,0",
        "toyo param set P01=100,200,0,0",
        "toyo param set P01 ax2=150",
        "toyo point set 1=1,-2,3,4",
        "toyo point set 1 z=12.5",
        "toyo speed-table set 5=80",
        "toyo torque-table set 1=50,60",
        "yerc io set 27010=on 27011=off",
        "yerc register set 5=1000",
        "yerc var set B0=255 R3=-2.5",
        "yrcx comment set 100='WAIT ORG'",
        "yrcx hand-data set 1 data-1=100 data-2=50",
        "yrcx io set servo-on=on",
        "yrcx pallet-data set 10 nx=3 ny=2",
        "yrcx param set TOLE.3=1000",
        "yrcx point set 7 mm=1,2,3,4",
        "yrcx port set DO2=7",
        "yrcx shift-data set 4=1,2,-3,4",
        "yrcx var set SGR1=-0.5",
    ];

    /// Exceptions: verbs with a single object, numbered objects without a name, and settings of the inventory, which
    /// have their own test.
    const NO_SETTINGS: [&str; 7] = [
        "names set",
        "robots set",
        "toyo coordinate set",
        "toyo override set",
        "toyo task set",
        "yrcx clock set",
        "yrcx eip set",
    ];

    fn words(line: &str) -> Vec<OsString> {
        shlex::split(&format!("armctl {line}")).unwrap().into_iter().map(Into::into).collect()
    }

    /// Collects the paths of the commands below `command` that `is_one` selects.
    fn verbs(command: &Command, path: &str, is_one: &dyn Fn(&Command) -> bool, found: &mut BTreeSet<String>) {
        for verb in command.get_subcommands() {
            let path = format!("{path} {}", verb.get_name());
            if !verb.has_subcommands() && is_one(verb) {
                found.insert(path.trim().to_owned());
            }
            verbs(verb, &path, is_one, found);
        }
    }

    fn of<'a>(lines: impl IntoIterator<Item = &'a str>) -> BTreeSet<String> {
        lines.into_iter().map(|line| line.split(' ').take(3).collect::<Vec<_>>().join(" ")).collect()
    }

    #[test]
    fn all_commands_accept_the_same_ranges() {
        let mut found = BTreeSet::new();
        let is_one = |verb: &Command| verb.get_name() == "get" && verb.get_positionals().next().is_some();
        verbs(&Cli::command(), "", &is_one, &mut found);
        let listed = of(RANGES.iter().map(|(line, ..)| *line).chain(NO_RANGES));
        assert_eq!(found.difference(&listed).collect::<Vec<_>>(), Vec::<&String>::new(), "not tried");
        let mut parser = Parser::default();
        for (verb, first, last) in RANGES {
            let digits = last.trim_start_matches(|c: char| c.is_ascii_alphabetic());
            for range in [
                format!("{first}..{last}"),
                format!("{first}-{last}"),
                format!("{first}-{digits}"),
                format!("{first}..{digits}"),
                format!("{first},{last}"),
                format!("{first}-{last},{first}"),
                format!("{first} {last}"),
            ] {
                assert!(parser.parse(&words(&format!("{verb} {range}"))).is_ok(), "{verb} {range}");
            }
        }
    }

    #[test]
    fn all_commands_accept_the_same_assignments() {
        let mut found = BTreeSet::new();
        verbs(&Cli::command(), "", &|verb| verb.get_name() == "set", &mut found);
        let listed = of(SETTINGS.iter().copied().chain(NO_SETTINGS));
        assert_eq!(found.symmetric_difference(&listed).collect::<Vec<_>>(), Vec::<&String>::new(), "not tried");
        let mut parser = Parser::default();
        for line in SETTINGS {
            assert!(parser.parse(&words(line)).is_ok(), "{line}");
        }
    }

    #[test]
    fn assignment_equals_separate_words() {
        let whole = Cli::command();
        let parted = |line: &str| {
            let line = split_assignments(&words(line), &whole)?;
            Some(line[1..].iter().map(|word| word.to_str().unwrap().to_owned()).collect::<Vec<_>>().join(" "))
        };
        for (line, expected) in [
            ("toyo counter set --sim 1=0", Some("toyo counter set --sim 1 0")),
            ("yrcx --unit 2 var set SGR1=-0.5 -q", Some("yrcx --unit 2 var set SGR1 -0.5 -q")),
            ("yrcx comment set 100=a=b,c", Some("yrcx comment set 100 a=b,c")),
            ("toyo point set 1=1,2,3,4", Some("toyo point set 1 1 2 3 4")),
            ("toyo point set 1=z=5", Some("toyo point set 1 z=5")),
            ("yrcx point set 7 mm=1,2,3,4", Some("yrcx point set 7 --mm=1,2,3,4")),
            ("yrcx comment set 100=--yes", None),
            ("toyo param set P01=--yes", None),
            ("toyo counter set 1 0", None),
        ] {
            assert_eq!(parted(line).as_deref(), expected, "{line}");
        }
        assert_eq!(parted("yrcx point set 7 yes=1").as_deref(), Some("yrcx point set 7 yes=1"), "no flag of all");
    }
}
