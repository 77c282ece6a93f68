//! The examples of the help have the same result on a served simulator as on the built-in simulator. A served simulator
//! is used over a socket, like a controller.

use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use armctl::command::example_lines::robot_lines;

use crate::support::simulator::Simulator;

/// Lines that do not end, that have a robot name, or that take seconds, such as motions and complete backups.
const EXCLUDED: &[&str] = &[
    "watch",
    "--for",
    "--continuous",
    " -r ",
    " -t ",
    "toyo backup press",
    "toyo backup press --current-task",
    "toyo backup press --resume",
    "toyo home",
    "toyo point list",
    "toyo point dump points.csv",
    "toyo point dump points.csv 1-50 --update",
    "toyo program edit",
    "toyo robot-type 1 0",
    "toyo run sequential",
    "toyo run sequential 1 --repeat 20 --stats",
    "toyo run sequential 10 --wait",
    "yerc file cmos CMOSBK.BIN",
    "yerc file cmos CMOSBK.BIN --download-only",
    "yerc move joint --x 400 --y 0 --z 300 --rx 180 --ry 0 --rz 0 --speed 10%",
    "yerc move linear --to 400,0,300,180,0,0 --speed 50mm/s",
    "yerc move linear --to 400,0,300,180,0,0 --speed 50mm/s --tool 1",
    "yrcx alarm history 1..50",
    "yrcx comment list",
    "yrcx comment dump",
    "yrcx hand-data list",
    "yrcx hand-data dump",
    "yrcx pallet-data list",
    "yrcx pallet-data dump",
    "yrcx point list",
    "yrcx shift-data list",
    "yrcx shift-data dump",
    "yrcx var list",
    "yrcx var dump",
    "yrcx backup press",
    "yrcx backup press --points 0..999",
    "yrcx comment get 0..29",
    "yrcx hand-data get 0..31",
    "yrcx move --point 19 --linear --speed 200mm/s",
    "yrcx movet --point 19 --linear --speed 50mm/s",
    "yrcx pallet --pallet 1 --position 21 --arch 3:0 --speed 20",
    "yrcx pallet-data get 0..39",
    "yrcx point dump points.csv 0..29 --update",
    "yrcx point dump points.csv 0..99",
    "yrcx point get 0..29,100",
    "yrcx shift-data get 0..39",
    "yrcx var get SGI0..SGI31 SGR5",
];
/// Number of lines that run in parallel.
const WORKERS: usize = 6;

/// Runs a line in its own folder. Returns the exit code and the output.
fn run(line: &str, robot: &str) -> (Option<i32>, String) {
    let folder = tempfile::tempdir().expect("there is room for a folder");
    let path: &Path = folder.path();
    let mut shell = Command::new("sh");
    // The lines contain shell quotes, so a shell runs them.
    shell.arg("-c").arg(format!("exec \"$0\" {robot} --yes {line}")).arg(env!("CARGO_BIN_EXE_armctl"));
    shell.current_dir(path).env("HOME", path).env("XDG_RUNTIME_DIR", path).env_remove("ARMCTL_CONFIG");
    let output = shell.stdin(Stdio::null()).output().expect("armctl starts");
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

/// Runs a line on both simulators. Returns the difference of the exit codes, if any.
fn difference(line: &str) -> Option<String> {
    let family = line.split(' ').next().expect("a family");
    let simulator = Simulator::start(family);
    let (within, _) = run(line, "--sim");
    let (served, said) = run(line, &format!("-t '{}'", simulator.url));
    (within != served).then(|| format!("{line}: {within:?} within the command, {served:?} served: {said}"))
}

#[test]
fn help_examples_work_on_a_served_simulator() {
    let lines: Vec<String> = robot_lines()
        .map(|(line, _)| line)
        .filter(|line| ["yerc ", "yrcx ", "toyo "].iter().any(|family| line.starts_with(family)))
        .filter(|line| !EXCLUDED.iter().any(|out| line.contains(out)))
        .collect();
    assert!(lines.len() > 300, "{} examples", lines.len());
    let next = AtomicUsize::new(0);
    let work = || {
        let own_part = std::iter::from_fn(|| lines.get(next.fetch_add(1, Ordering::Relaxed)));
        own_part.filter_map(|line| difference(line)).collect::<Vec<_>>()
    };
    let different: Vec<String> = thread::scope(|scope| {
        let workers: Vec<_> = (0..WORKERS).map(|_| scope.spawn(work)).collect();
        workers.into_iter().flat_map(|worker| worker.join().expect("no panic")).collect()
    });
    assert!(different.is_empty(), "{}", different.join("\n"));
}

/// The controller stores a station and a base in pulses. This also works if the dry run before the question shows
/// another form.
#[test]
fn teaches_stations_and_bases() {
    let simulator = Simulator::start("yerc");
    for line in ["yerc teach EX1 --group S1", "yerc teach BP1", "yerc teach EX1 --dry-run", "yerc teach P9"] {
        let (code, said) = run(line, &format!("-t '{}'", simulator.url));
        assert_eq!(code, Some(0), "{line}: {said}");
    }
}
