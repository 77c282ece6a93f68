//! Comparison of each line in `command/example_lines` with the decisions of the gate.

use std::ffi::OsString;

use clap::CommandFactory as _;
use clap::Parser as _;

use crate::app::line_words;
use crate::app::prepare::{Invocation, Task};
use crate::app::suggestions;
use crate::cli::Cli;
use crate::command::common::Common;
use crate::command::example_lines::{all, robot_lines};
use crate::command::fleet::common;
use armctl_controller::Risk::{Destroy, Motion, Read, Write};
use armctl_frame::AnyCommand;
use armctl_frame::gate::Intent;
use armctl_frame::output::redraw::Redraw;
use armctl_frame::output::{ColorChoice, Format};
use armctl_frame::prelude::*;
use armctl_frame::settings::inventory::Inventory;
use armctl_frame::settings::{Selection, Sources};

const STOPS: [&str; 7] =
    ["stop", "yerc stop", "yerc hold on", "yerc job stop", "yrcx emergency-stop", "yrcx stop", "toyo stop"];

/// Two unreachable robots per family. The second robot is read-only.
const ROBOTS: &str = r#"
[[robot]]
name = "yerc"
target = "udp://127.0.0.1:1"
[[robot]]
name = "yrcx"
target = "eip://127.0.0.1:1?role=input_only"
[[robot]]
name = "toyo"
target = "tcp://127.0.0.1:1"
[[robot]]
name = "yerc-ro"
target = "udp://127.0.0.1:2"
read_only = true
[[robot]]
name = "yrcx-ro"
target = "eip://127.0.0.1:2?role=input_only"
read_only = true
[[robot]]
name = "toyo-ro"
target = "tcp://127.0.0.1:2"
read_only = true
"#;

/// Returns a non-interactive run for the selected robots.
fn run(selection: Selection) -> Run {
    let inventory = Inventory::parse(ROBOTS, "robots.toml").unwrap();
    Run {
        screen: Screen::new(Format::Json, ColorChoice::Never, true, 0),
        sources: Sources { selection, inventory, ..Sources::default() },
        gate: armctl_frame::gate::Gate::default(),
        repeat: armctl_frame::run::Repeat::default(),
        filter: None,
        trace: None,
        line: None,
        redraw: Redraw::default(),
        own: armctl_frame::FamilyArguments::default(),
    }
}

fn named(name: &str) -> Selection {
    Selection { robots: vec![name.to_owned()], ..Selection::default() }
}

/// Intent of a line, and what the gate decides about it.
struct LineIntent {
    intent: Intent,
    alone: Result<()>,
    read_only: Result<()>,
    fleet: Result<()>,
}

fn observe(line: &str) -> Result<LineIntent, String> {
    fn of(command: &dyn AnyCommand, family: &str) -> LineIntent {
        LineIntent {
            intent: command.intent(None),
            alone: run(named(family)).check_gate(command),
            read_only: run(named(&format!("{family}-ro"))).check_gate(command),
            fleet: run(Selection { robots: vec![format!("{family}*")], ..Selection::default() }).check_gate(command),
        }
    }
    let words = line_words::split(line)?;
    let cli = Cli::try_parse_from(std::iter::once("armctl".to_owned()).chain(words))
        .map_err(|error| format!("{line}: {error}"))?;
    Ok(match Invocation::from(cli.command) {
        Invocation::Task(Task::Family(_, command)) => {
            let family = command.family().map_or("toyo", Family::name);
            of(&*command, family)
        }
        Invocation::Task(Task::Common(Common::Status(command))) => of(&command, "toyo"),
        Invocation::Task(Task::Common(Common::Alarm(alarm))) => of(&*alarm.command().unwrap(), "toyo"),
        Invocation::Task(Task::Common(Common::Io(io))) => of(&*io.command().unwrap(), "toyo"),
        Invocation::Task(Task::Common(Common::Wait(wait))) => of(&*wait.command().unwrap(), "toyo"),
        Invocation::Task(Task::Common(Common::Position)) => of(&common::position(), "toyo"),
        Invocation::Task(Task::Common(Common::Stop)) => of(&common::stop(), "toyo"),
        Invocation::Task(Task::Common(Common::Backup(command))) => of(command.options(), "toyo"),
        Invocation::Task(Task::Common(Common::Restore(command))) => of(&command, "toyo"),
        Invocation::Task(Task::Common(Common::Diff(command))) => of(&command, "toyo"),
        _ => return Err(format!("{line} is for no robot")),
    })
}

#[test]
fn gate_checks_every_command() {
    let mut wrong = Vec::new();
    for (line, risk) in robot_lines() {
        let LineIntent { intent, alone, read_only, fleet } = match observe(&line) {
            Ok(seen) => seen,
            Err(why) => {
                wrong.push(why);
                continue;
            }
        };
        let is_stop = STOPS.iter().any(|stop| line.starts_with(stop));
        let refused = |outcome: &Result<()>| outcome.as_ref().is_err_and(|failure| failure.kind == Kind::Rejected);
        let is_when_known = intent.confirmation == Confirmation::WhenKnown;
        let is_asked = risk == Motion || risk == Destroy && !is_when_known;
        for (what, is_right) in [
            ("its risk", intent.risk == risk),
            ("whether it is a stop", intent.is_stop == is_stop),
            ("a question", risk < Destroy || intent.confirmation != Confirmation::Question || !intent.text.is_empty()),
            ("nobody to ask", refused(&alone) == is_asked),
            // For a read-only robot, the commands `backup` and `diff` send only reads.
            (
                "a read-only robot",
                refused(&read_only) == (risk > Read && !is_stop)
                    || line.split(' ').any(|word| ["backup", "diff"].contains(&word)),
            ),
            ("a fleet", refused(&fleet) == (risk >= Destroy || (risk > Read && !is_stop && refused(&read_only)))),
            ("its first grant", intent.initial_risk() <= if is_when_known { (risk).min(Write) } else { risk }),
        ] {
            if !is_right {
                wrong.push(format!("{line}: {what} ({:?}, {:?})", intent.risk, intent.confirmation));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_command_has_valid_examples() {
    let mut leaves = BTreeSet::new();
    let whole = Cli::command();
    for word in whole.get_subcommands() {
        collect(word, word.get_name(), &mut leaves);
    }
    for leaf in leaves {
        let lines = all().filter(|line| format!("{line} ").starts_with(&format!("{leaf} "))).count();
        assert!(lines >= 2, "{leaf}: {lines} examples in command/leaves");
    }
    for line in all() {
        let words = line_words::split(&line).unwrap();
        let parsed = Cli::try_parse_from(std::iter::once("armctl".to_owned()).chain(words));
        assert!(parsed.is_ok(), "{line}: {}", parsed.unwrap_err());
    }
}

fn collect(command: &clap::Command, path: &str, leaves: &mut BTreeSet<String>) {
    if !command.has_subcommands() {
        leaves.insert(path.to_owned());
    }
    for below in command.get_subcommands() {
        collect(below, &format!("{path} {}", below.get_name()), leaves);
    }
}

#[test]
fn no_suggestion_is_dangerous() {
    for line in
        ["init", "home", "delete x", "toyo inti", "yerc job strat", "yrcx mvoe --point 1", "toyo jgo", "servo on"]
    {
        let args: Vec<OsString> = std::iter::once("armctl").chain(line.split(' ')).map(Into::into).collect();
        let mut whole = Cli::command();
        let error = whole.try_get_matches_from_mut(&args).unwrap_err();
        let text = suggestions::add_suggestion(error, &args, &whole).render().to_string();
        let tips: Vec<&str> = text.lines().filter(|line| line.contains("tip: ")).collect();
        for dangerous in ["init", "delete", "start", "home", "move", "jog"] {
            let proposes =
                |tip: &&str| tip.contains(&format!("{dangerous}`")) || tip.contains(&format!("'{dangerous}'"));
            assert!(!tips.iter().any(proposes), "{line}: {text}");
        }
    }
}
