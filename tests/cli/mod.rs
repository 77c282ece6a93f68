//! Runs every command with the built binary, and checks its output and exit code.
//!
//! `NAME.console` files are transcripts; `transcript.rs` describes their syntax. `SNAPSHOTS=overwrite cargo test --test
//! terminal cli::` writes the output into them. To extend a transcript, add the commands, run this command line, and
//! review the result.
#![cfg(unix)]

mod csv;
mod exits;
mod json;
mod served;
mod transcript;

use std::collections::BTreeSet;

use clap::CommandFactory as _;

macro_rules! transcripts {
    ($($name:ident)*) => {
        $(#[test]
        fn $name() {
            transcript::check(stringify!($name));
        })*

        const TRANSCRIPTS: &[&str] = &[$(stringify!($name)),*];
    };
}

transcripts! {
    alarms
    backups
    batch
    captures
    cell
    command_help
    common_commands
    common_terms
    conditions
    decode
    edit
    exit_codes
    explain
    files
    fleet_backups
    fleets
    help
    information
    inventory
    jobs
    metrics
    mistakes
    models
    moves
    names
    positions
    publish
    raw
    recordings
    repl
    robots
    robots_check
    running
    sessions
    sheets
    signals
    simulator
    status
    tables
    teaching
    top
    toyo_backups
    toyo_io
    toyo_motion
    toyo_palletizing
    toyo_parameters
    toyo_points
    toyo_programs
    toyo_registers
    toyo_system
    usage
    variables
    watches
    yerc_control
    yrcx
    yrcx_data
    yrcx_devicenet
    yrcx_eip
    yrcx_info
    yrcx_jog
    yrcx_motion
    yrcx_profibus
    yrcx_profinet
    yrcx_profinet_stations
    yrcx_programs
}

#[test]
fn runs_every_transcript() {
    assert_eq!(transcript::names(), TRANSCRIPTS, "transcripts are listed above in the order of the alphabet");
}

/// Commands that print scripts, pages, texts or schemas, and not reports.
const PLAIN: [&str; 4] = ["completions", "man", "help", "schema"];

#[test]
fn every_command_has_transcripts() {
    let root = armctl::cli::Cli::command();
    let (mut tables, mut jsons) = (BTreeSet::new(), BTreeSet::new());
    for line in transcript::commands() {
        for typed in line.split(['|', ';', '&']) {
            let common_terms: Vec<&str> = typed.split_whitespace().collect();
            let path = path(&root, &common_terms);
            let is_json = ["--json", "json", "jsonl", "--jq"].iter().any(|word| common_terms.contains(word));
            if is_json {
                jsons.insert(path)
            } else {
                tables.insert(path)
            };
        }
    }
    let mut leaves = Vec::new();
    collect_leaves(&root, "", &mut leaves);
    let missing =
        |seen: &BTreeSet<String>| leaves.iter().filter(|leaf| !seen.contains(*leaf)).cloned().collect::<Vec<_>>();
    assert_eq!(missing(&tables), [""; 0], "commands without a transcript");
    let without_examples: Vec<String> =
        missing(&jsons).into_iter().filter(|leaf| !PLAIN.contains(&leaf.as_str())).collect();
    assert_eq!(without_examples, [""; 0], "commands without a transcript in JSON");
}

/// The command at the beginning of these words, for example `yerc file get`.
fn path(root: &clap::Command, common_terms: &[&str]) -> String {
    let mut command = root;
    let mut path = Vec::new();
    for word in common_terms {
        if let Some(sub) = command.get_subcommands().find(|sub| sub.get_name() == *word) {
            path.push(*word);
            command = sub;
        }
    }
    path.join(" ")
}

fn collect_leaves(command: &clap::Command, path: &str, leaves: &mut Vec<String>) {
    for sub in command.get_subcommands() {
        let path = format!("{path} {}", sub.get_name());
        if sub.get_subcommands().next().is_none() {
            leaves.push(path.trim_start().to_owned());
        }
        collect_leaves(sub, &path, leaves);
    }
}
