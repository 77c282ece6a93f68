//! CPU time and memory of `armctl serve metrics`, which polls the controllers of a plant once per second.
//!
//! The controllers of all families are simulated on the loopback interface in this process. The command is a separate
//! process, or four processes that share the robots by tags. The metrics are read every five seconds, as Prometheus
//! does. CPU time (including the kernel) and memory are read from the statistics of Linux.
//!
//! `cargo bench --bench plant` watches 500 controllers for a minute, then 2,000 controllers with four processes. `--
//! metrics --seconds=600` watches 500 controllers for ten minutes. `-- --quick` and `cargo test --benches` only check
//! that the benchmark works.

#![expect(clippy::print_stdout, reason = "a benchmark reports to whoever runs it")]

#[path = "../common/mod.rs"]
mod common;

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::{SocketAddr, TcpStream};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context as _, ensure};
use armctl::command::fleet::service::make_room;

use common::controllers::{Delays, serve};
use common::process::{cpu_time, memory};
use common::run;
use common::table::{Goal, Row, Table};

/// Number of controllers of yerc, toyo and yrcx per process, and duration.
struct Effort {
    plant: [usize; 3],
    time: Duration,
}

const FULL: Effort = Effort { plant: [350, 100, 50], time: Duration::from_secs(60) };
const QUICK: Effort = Effort { plant: [3, 2, 1], time: Duration::from_millis(500) };

/// Number of processes that share a larger plant.
const SHARDS: usize = 4;
/// Time until every link is open and the memory use is stable.
const WARM_UP: u32 = 6;
/// Interval of the reads; usual for Prometheus.
const SCRAPE: Duration = Duration::from_secs(5);
/// Limits of a process: percent of a CPU core, and MB.
const MAX_CPU_PERCENT: f64 = 50.0;
const MEMORY: f64 = 64.0;

fn main() -> anyhow::Result<()> {
    make_room();
    let seconds = std::env::args().find_map(|word| word.strip_prefix("--seconds=")?.parse().ok());
    let full = Effort { time: seconds.map_or(FULL.time, Duration::from_secs), ..FULL };
    let comparisons: [(&str, common::Compare<Effort>); 2] = [("metrics", metrics), ("shards", shards)];
    run(&comparisons, &full, &QUICK)
}

/// Measures a plant with one process.
fn metrics(effort: &Effort) -> anyhow::Result<Table> {
    let count: usize = effort.plant.iter().sum();
    let title = format!("serve metrics: {count} controllers once a second, for {} s", effort.time.as_secs());
    watched_plant(Table::new(title), effort.plant, effort.time, 1)
}

/// Measures a larger plant with one process for each part of it.
fn shards(effort: &Effort) -> anyhow::Result<Table> {
    let plant = effort.plant.map(|count| count * SHARDS);
    let (count, time) = (plant.iter().sum::<usize>(), effort.time.as_secs());
    let title = format!("serve metrics: {count} controllers once a second, {SHARDS} processes by tags, for {time} s");
    watched_plant(Table::new(title), plant, effort.time, SHARDS)
}

/// Statistics of a process.
struct Reading {
    used: Duration,
    memory: f64,
    page: String,
}

/// Watches the plant with this number of processes, and adds the results to the table.
fn watched_plant(mut table: Table, plant: [usize; 3], time: Duration, processes: usize) -> anyhow::Result<Table> {
    let folder = tempfile::tempdir()?;
    std::fs::write(folder.path().join("robots.toml"), serve(plant, Delays::default(), processes)?)?;
    let services =
        (0..processes).map(|shard| Service::start(folder.path(), shard)).collect::<anyhow::Result<Vec<_>>>()?;
    #[expect(clippy::cast_precision_loss, reason = "some thousands")]
    let count = plant.iter().sum::<usize>() as f64;
    let all = |name: &str| -> anyhow::Result<f64> {
        services.iter().map(|service| Ok(sum(&service.page()?, name))).sum::<anyhow::Result<f64>>()
    };
    while all("armctl_robot_up")? < count - 0.5 {
        thread::sleep(Duration::from_millis(100));
    }
    thread::sleep(time.min(Duration::from_secs(1)) * WARM_UP);
    let read = || services.iter().map(Service::read).collect::<anyhow::Result<Vec<_>>>();
    let (began, first) = (Instant::now(), read()?);
    let (mut most, mut slowest) = (0.0_f64, (Duration::ZERO, 0));
    while began.elapsed() < time {
        thread::sleep(SCRAPE.min(time.saturating_sub(began.elapsed())));
        for service in &services {
            let start = Instant::now();
            let length = service.page()?.len();
            slowest = slowest.max((start.elapsed(), length));
            most = most.max(memory(service.0.id())?);
        }
    }
    let (seconds, last) = (began.elapsed().as_secs_f64(), read()?);
    let pairs = || first.iter().zip(&last);
    let shares = pairs().map(|(first, last)| 100.0 * last.used.saturating_sub(first.used).as_secs_f64() / seconds);
    let share = shares.fold(0.0, f64::max);
    let polls = |reading: &Reading| sum(&reading.page, "armctl_polls_total");
    let rate = pairs().map(|(first, last)| polls(last) - polls(first)).sum::<f64>() / seconds;
    let [failed, missed] = ["armctl_poll_failures_total", "armctl_polls_missed_total"]
        .map(|name| pairs().map(|(first, last)| sum(&last.page, name) - sum(&first.page, name)).sum::<f64>());
    let flat = pairs().map(|(first, last)| (last.memory, first.memory)).reduce(|a, b| if b.0 > a.0 { b } else { a });
    let (after, before) = flat.context("there is a process")?;
    table.row(
        Row::new("of one core, each at most", format!("{share:.1} %")).goal(share, Goal::AtMost(MAX_CPU_PERCENT, "%")),
    );
    table.row(Row::new("memory, each at most", format!("{most:.1} MB")).goal(most, Goal::AtMost(MEMORY, "MB")));
    table.row(Row::new("memory, from begin to end", format!("{before:.1} to {after:.1} MB")));
    table.row(Row::new("polls a second", format!("{rate:.1}")));
    table.row(Row::new("polls that failed, were left out", format!("{failed}, {missed}")));
    let (time, length) = slowest;
    let page = format!("{} kB in {:.1} ms", length / 1000, time.as_secs_f64() * 1e3);
    table.row(Row::new("a page, at the slowest", page));
    Ok(table)
}

/// Returns the sum of all samples of a metric.
fn sum(page: &str, name: &str) -> f64 {
    let lines = page.lines().filter(|line| line.strip_prefix(name).is_some_and(|rest| rest.starts_with('{')));
    lines.filter_map(|line| line.rsplit(' ').next()?.parse::<f64>().ok()).sum()
}

/// A running service. It stops when it is dropped.
struct Service(Child, SocketAddr);

impl Service {
    /// Starts a service for one part of the robots of a folder.
    fn start(folder: &Path, shard: usize) -> anyhow::Result<Self> {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.arg("--config").arg(folder.join("robots.toml")).args(["--tag", &format!("shard{shard}")]);
        command.args(["serve", "metrics", "--listen", "127.0.0.1:0"]);
        command.env_clear().env("HOME", folder).stdin(Stdio::null()).stdout(Stdio::piped());
        let mut process = command.spawn()?;
        let mut line = String::new();
        BufReader::new(process.stdout.take().context("a pipe")?).read_line(&mut line)?;
        let place = line.trim_end().rsplit("http://").next().unwrap_or_default();
        let place = place.trim_end_matches("/metrics").parse().with_context(|| format!("no address: {line}"))?;
        Ok(Self(process, place))
    }

    fn page(&self) -> anyhow::Result<String> {
        let mut stream = TcpStream::connect(self.1)?;
        write!(stream, "GET /metrics HTTP/1.1\r\nHost: {}\r\n\r\n", self.1)?;
        let mut page = String::new();
        stream.read_to_string(&mut page)?;
        ensure!(page.starts_with("HTTP/1.1 200 "), "no page: {page}");
        Ok(page)
    }

    fn read(&self) -> anyhow::Result<Reading> {
        Ok(Reading { used: cpu_time(self.0.id())?, memory: memory(self.0.id())?, page: self.page()? })
    }
}

impl Drop for Service {
    fn drop(&mut self) {
        let _gone = self.0.kill();
        let _ended = self.0.wait();
    }
}
