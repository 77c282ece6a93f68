//! Speed of `armctl decode yerc` on captures, as a whole process, compared with tshark for the same kind of output.
//!
//! The capture has the traffic of four clients: reads of status, position and variables, and a write of an output. It
//! is the same in each run. `cargo bench --bench decode` measures everything, with `-- formats sizes` only the named
//! parts. `-- --quick` and `cargo test --benches` only check that the benchmark works. Where tshark is not installed,
//! its rows are left out.

#![expect(clippy::print_stdout, reason = "a benchmark reports to whoever runs it")]

#[path = "../common/mod.rs"]
mod common;

use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use anyhow::Context as _;
use armctl_controller::yerc::request::Request;
use armctl_controller::yerc::wire::{ANSWER_BIT, AnswerFrame, Division, LAST_BLOCK, Status};
use armctl_transport::tap::CaptureWriter;
use tempfile::TempDir;

use common::table::{Goal, Row, Table};
use common::{Work, measure_time, median, process, ratio, run, run_alternately};

/// Amount of work. Sizes are in bytes.
struct Effort {
    size: u64,
    rounds: usize,
    sizes: &'static [(&'static str, u64)],
}

const FULL: Effort = Effort {
    size: 20_000_000,
    rounds: 3,
    sizes: &[
        ("1 kB", 1000),
        ("1 MB", 1_000_000),
        ("10 MB", 10_000_000),
        ("100 MB", 100_000_000),
        ("1 GB", 1_000_000_000),
    ],
};
const QUICK: Effort = Effort { size: 50_000, rounds: 1, sizes: &[("1 kB", 1000), ("50 kB", 50_000)] };

/// Least speed in terms of tshark.
const GOAL: Goal = Goal::AtLeast(5.0);

/// Formats: our arguments, those of tshark for the same kind of output, and their names in the table.
const FORMATS: [(&str, &[&str], &str, &[&str]); 3] = [
    ("armctl decode yerc", &["decode", "yerc"], "tshark -r, a line per packet", &[]),
    (
        "armctl -o csv decode yerc",
        &["-o", "csv", "decode", "yerc"],
        "tshark -T fields, the same columns",
        &[
            "-T",
            "fields",
            "-e",
            "frame.number",
            "-e",
            "frame.time_relative",
            "-e",
            "ip.src",
            "-e",
            "udp.srcport",
            "-e",
            "ip.dst",
            "-e",
            "udp.dstport",
            "-e",
            "udp.payload",
        ],
    ),
    ("armctl -o json decode yerc", &["-o", "json", "decode", "yerc"], "tshark -T json", &["-T", "json"]),
];

fn main() -> anyhow::Result<()> {
    run(&[("formats", formats), ("sizes", sizes)], &FULL, &QUICK)
}

/// Measures each format against tshark.
fn formats(effort: &Effort) -> anyhow::Result<Table> {
    let (_folder, path) = capture(effort.size)?;
    let size = path.metadata()?.len();
    let mut table = Table::new(format!("decode of a capture of {:.2} MB", megabytes(size)));
    let has_tshark = Command::new("tshark").arg("--version").stdout(Stdio::null()).status().is_ok();
    for (name, args, peer_name, peer_args) in FORMATS {
        let mut decode = armctl(args, &path);
        let ours = || process::assert_success(&mut decode);
        let mut tshark = Command::new("tshark");
        tshark.arg("-r").arg(&path).args(peer_args).stdout(Stdio::null()).stderr(Stdio::null());
        let peer = || if has_tshark { process::assert_success(&mut tshark) } else { Ok(()) };
        let [ours, peer] = run_alternately(effort.rounds, [&mut { ours } as &mut dyn Work, &mut { peer }])?;
        let rate = |times: &[f64]| format!("{:.1} MB/s", megabytes(size) / median(times));
        let row = Row::new(name, rate(&ours));
        if has_tshark {
            table.row(Row::new(peer_name, rate(&peer)));
            table.row(row.with_comparison(ratio(&peer, &ours), "tshark", GOAL));
        } else {
            table.row(row);
        }
    }
    Ok(table)
}

/// Measures the list of captures of several sizes. Each is read once, and the memory in a second run.
fn sizes(effort: &Effort) -> anyhow::Result<Table> {
    let mut table = Table::new("armctl decode yerc, captures of several sizes: time, and memory at most");
    for (name, size) in effort.sizes {
        let (_folder, path) = capture(*size)?;
        let mut decode = armctl(&["decode", "yerc"], &path);
        let elapsed = measure_time(&mut || process::assert_success(&mut decode))?.as_secs_f64();
        let peak = process::peak_memory(&mut decode)?;
        table.row(Row::new(name, format!("{elapsed:.2} s, {:.0} MB", megabytes(peak))));
    }
    Ok(table)
}

fn armctl(args: &[&str], path: &Path) -> Command {
    let mut command = process::unconfigured();
    command.args(args).arg(path);
    command
}

/// Writes a capture of at least this size.
fn capture(size: u64) -> anyhow::Result<(TempDir, PathBuf)> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("traffic.pcapng");
    let mut out = BufWriter::new(File::create(&path)?);
    // A capture may have several sections, so a part of the traffic can be written again and again.
    let mut part = Vec::new();
    let part_size = size.min(1 << 20);
    let mut capture = CaptureWriter::new(&mut part)?;
    let (mut written, mut at) = (0, 0);
    while written < part_size {
        written += exchange(&mut capture, at)?;
        at += 1;
    }
    for _ in 0..size.div_ceil(written.max(1)) {
        out.write_all(&part)?;
    }
    out.flush()?;
    Ok((folder, path))
}

/// Records one exchange of a client. Returns the approximate number of bytes.
fn exchange(capture: &mut CaptureWriter<&mut Vec<u8>>, at: u32) -> anyhow::Result<u64> {
    let position: Vec<u8> = (0..13).flat_map(|word: i32| (word * 1001 - 40).to_le_bytes()).collect();
    let variables: Vec<u8> = [100u32].into_iter().chain(0..100).flat_map(u32::to_le_bytes).collect();
    let request = |command, instance, attribute, service, data: &[u8]| Request {
        command,
        instance,
        attribute,
        service,
        data: data.to_vec(),
    };
    let (request, answer) = match at % 4 {
        0 => (request(0x72, 1, 0, 0x01, &[]), vec![0x42, 0, 0, 0, 0x40, 0, 0, 0]),
        1 => (request(0x75, 101, 0, 0x01, &[]), position),
        2 => (request(0x304, 0, 0, 0x33, &100u32.to_le_bytes()), variables),
        _ => (request(0x78, 1001, 1, 0x10, &[1]), Vec::new()),
    };
    let number = u8::try_from(at / 4 % 4)?;
    let client = SocketAddr::from(([10, 0, 0, 9], 50_000 + u16::from(number)));
    let controller = SocketAddr::from(([10, 0, 0, number + 1], 10_040));
    let id = u8::try_from(at % 256)?;
    let answer = AnswerFrame {
        division: Division::Robot,
        ack: true,
        id,
        block: LAST_BLOCK,
        service: request.service | ANSWER_BIT,
        status: Status::OK,
        data: &answer,
    }
    .emit();
    let time = Duration::from_micros(1_700_000_000_000_000 + u64::from(at) * 1000);
    let request = request.frame(id);
    capture.datagram(time, client, controller, &request)?;
    capture.datagram(time + Duration::from_micros(400), controller, client, &answer)?;
    // Headers of the file and of IP, twice.
    u64::try_from(request.len() + answer.len() + 120).context("a frame is small")
}

#[expect(clippy::cast_precision_loss, reason = "a figure for people")]
fn megabytes(bytes: u64) -> f64 {
    bytes as f64 / 1e6
}
