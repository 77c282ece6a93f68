//! The measurement.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::{Ipv4Addr, SocketAddr, TcpStream};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context as _, ensure};
use armctl::command::fleet::service::make_room;
use armctl::command::{toyo, yerc, yrcx};
use armctl::controller::{toyo as toyo_controller, yerc as yerc_controller, yrcx as yrcx_controller};
use armctl::transport::eip::adapter::server::Listen;
use armctl::transport::server::Server;
use armctl::transport::stream_server::StreamServer;
use tokio::task::LocalSet;

use crate::common::table::{Goal, Row, Table};
use crate::common::{run, runtime};

/// How many controllers of yerc, toyo and yrcx there are, and how long they are watched.
struct Effort {
    plant: [usize; 3],
    time: Duration,
}

const FULL: Effort = Effort { plant: [350, 100, 50], time: Duration::from_secs(60) };
const QUICK: Effort = Effort { plant: [3, 2, 1], time: Duration::from_millis(500) };

/// Time until every link is open and memory is what it will be.
const WARM_UP: u32 = 6;
/// Time from one reading to the next, as usual for Prometheus.
const SCRAPE: Duration = Duration::from_secs(5);
/// What the issue allows: percent of a core, and MB.
const HALF: f64 = 50.0;
const MEMORY: f64 = 64.0;

pub fn main() -> anyhow::Result<()> {
    make_room();
    let seconds = std::env::args().find_map(|word| word.strip_prefix("--seconds=")?.parse().ok());
    let full = Effort { time: seconds.map_or(FULL.time, Duration::from_secs), ..FULL };
    run(&[("metrics", metrics)], &full, &QUICK)
}

fn metrics(effort: &Effort) -> anyhow::Result<Table> {
    let folder = tempfile::tempdir()?;
    let inventory = folder.path().join("robots.toml");
    std::fs::write(&inventory, serve(effort.plant)?)?;
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    command.arg("--config").arg(&inventory).args(["--all", "serve", "metrics", "--listen", "127.0.0.1:0"]);
    command.env_clear().env("HOME", folder.path()).stdin(Stdio::null()).stdout(Stdio::piped());
    let mut service = Service(command.spawn()?);
    let at = service.place()?;
    let count: usize = effort.plant.iter().sum();
    let process = service.0.id();
    let sum = |page: &str, name: &str| -> f64 {
        let lines = page.lines().filter(|line| line.strip_prefix(name).is_some_and(|rest| rest.starts_with('{')));
        lines.filter_map(|line| line.rsplit(' ').next()?.parse::<f64>().ok()).sum()
    };
    while (sum(&page(at)?, "armctl_robot_up") - f64::from(u32::try_from(count)?)).abs() > 0.5 {
        thread::sleep(Duration::from_millis(100));
    }
    thread::sleep(effort.time.min(Duration::from_secs(1)) * WARM_UP);
    let polls = |page: &str| sum(page, "armctl_polls_total");
    let (first, began, before, memory) = (page(at)?, Instant::now(), used(process)?, memory_of(process)?);
    let mut most: f64 = memory;
    let mut read = Vec::new();
    while began.elapsed() < effort.time {
        thread::sleep(SCRAPE.min(effort.time.saturating_sub(began.elapsed())));
        let start = Instant::now();
        let length = page(at)?.len();
        read.push((start.elapsed(), length));
        most = most.max(memory_of(process)?);
    }
    let (seconds, after) = (began.elapsed().as_secs_f64(), memory_of(process)?);
    let last = page(at)?;
    let share = 100.0 * used(process)?.saturating_sub(before).as_secs_f64() / seconds;
    let rate = (polls(&last) - polls(&first)) / seconds;
    let failed = sum(&last, "armctl_poll_failures_total");
    let (slowest, length) = read.iter().max().copied().context("it was read")?;
    let mut table = Table::new(format!("serve metrics: {count} controllers once a second, for {seconds:.0} s"));
    table.row(Row::new("of one core", format!("{share:.1} %")).goal(share, Goal::AtMost(HALF, "%")));
    table.row(Row::new("memory, at most", format!("{most:.1} MB")).goal(most, Goal::AtMost(MEMORY, "MB")));
    table.row(Row::new("memory, from begin to end", format!("{memory:.1} to {after:.1} MB")));
    table.row(Row::new("polls a second", format!("{rate:.1}")));
    table.row(Row::new(
        "polls that failed, were left out",
        format!("{failed}, {}", sum(&last, "armctl_polls_missed_total")),
    ));
    let kilobytes = length / 1000;
    table.row(Row::new("a page, at the slowest", format!("{kilobytes} kB in {:.1} ms", slowest.as_secs_f64() * 1e3)));
    Ok(table)
}

/// Ends with the measurement.
struct Service(Child);

impl Service {
    fn place(&mut self) -> anyhow::Result<SocketAddr> {
        let mut line = String::new();
        BufReader::new(self.0.stdout.take().context("a pipe")?).read_line(&mut line)?;
        let place = line.trim_end().rsplit("http://").next().unwrap_or_default();
        place.trim_end_matches("/metrics").parse().with_context(|| format!("no address: {line}"))
    }
}

impl Drop for Service {
    fn drop(&mut self) {
        let _gone = self.0.kill();
        let _ended = self.0.wait();
    }
}

fn page(at: SocketAddr) -> anyhow::Result<String> {
    let mut stream = TcpStream::connect(at)?;
    write!(stream, "GET /metrics HTTP/1.1\r\nHost: {at}\r\n\r\n")?;
    let mut page = String::new();
    stream.read_to_string(&mut page)?;
    ensure!(page.starts_with("HTTP/1.1 200 "), "no page: {page}");
    Ok(page)
}

/// The time of the processor that a process has used (proc(5)): fields 14 and 15, in hundredths of a second.
fn used(process: u32) -> anyhow::Result<Duration> {
    let stat = std::fs::read_to_string(format!("/proc/{process}/stat")).context("this takes a Linux with /proc")?;
    // The name, in parentheses, may have blanks.
    let (_, fields) = stat.rsplit_once(')').context("no name in /proc")?;
    let fields: Vec<&str> = fields.split_ascii_whitespace().collect();
    let ticks = |at: usize| -> anyhow::Result<u64> { Ok(fields.get(at).context("too few fields in /proc")?.parse()?) };
    Ok(Duration::from_millis(10 * (ticks(11)? + ticks(12)?)))
}

/// The memory that a process holds, in MB.
fn memory_of(process: u32) -> anyhow::Result<f64> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status"))?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).context("no memory in /proc")?;
    let kilobytes: f64 = line.trim().trim_end_matches(" kB").parse()?;
    Ok(kilobytes * 1024.0 / 1e6)
}

/// Serves a plant until the process ends, and gives its inventory.
fn serve(plant: [usize; 3]) -> anyhow::Result<String> {
    let (tell, told) = mpsc::channel();
    let [yerc_count, toyo_count, yrcx_count] = plant;
    thread::spawn(move || {
        let local = LocalSet::new();
        for number in 0..yerc_count {
            let tell = tell.clone();
            local.spawn_local(until_it_fails(yerc(move |target| tell.send(entry("yerc", number, &target)).is_ok())));
        }
        for number in 0..toyo_count {
            let tell = tell.clone();
            local.spawn_local(until_it_fails(toyo(move |target| tell.send(entry("toyo", number, &target)).is_ok())));
        }
        for number in 0..yrcx_count {
            let tell = tell.clone();
            local.spawn_local(until_it_fails(yrcx(move |target| tell.send(entry("yrcx", number, &target)).is_ok())));
        }
        // Where one fails to start, the list below is short of it.
        drop(tell);
        runtime().map(|runtime| runtime.block_on(local))
    });
    let count = plant.iter().sum();
    let entries: Vec<String> = told.iter().take(count).collect();
    ensure!(entries.len() == count, "not every controller could be served");
    Ok(entries.concat())
}

fn entry(family: &str, number: usize, target: &str) -> String {
    format!("[[robot]]\nname = \"{family}{number}\"\nfamily = \"{family}\"\ntarget = \"{target}\"\n")
}

async fn until_it_fails(served: impl Future<Output = anyhow::Result<()>>) {
    if let Err(error) = served.await {
        println!("a simulated controller ended: {error:#}");
    }
}

const ANY: SocketAddr = SocketAddr::new(std::net::IpAddr::V4(Ipv4Addr::LOCALHOST), 0);

async fn yerc(tell: impl FnOnce(String) -> bool) -> anyhow::Result<()> {
    let mut server = Server::bind([ANY, ANY], None).await?;
    ensure!(tell(format!("udp://{}?file_port={}", server.local(0)?, server.local(1)?.port())), "nobody listens");
    let start = yerc::simulated::start(None, yerc_controller::Model::Dx200, None)?;
    let mut controller = yerc::simulated::Simulated(yerc_controller::simulator::Simulator::new(start));
    loop {
        server.turn(&mut controller).await?;
    }
}

async fn toyo(tell: impl FnOnce(String) -> bool) -> anyhow::Result<()> {
    let (mut server, address) = StreamServer::tcp(ANY, None, None).await?;
    ensure!(tell(format!("tcp://{address}")), "nobody listens");
    let mut controller = toyo::simulated::Simulated::new(toyo_controller::simulator::Start::default());
    loop {
        server.turn(&mut controller).await?;
    }
}

async fn yrcx(tell: impl FnOnce(String) -> bool) -> anyhow::Result<()> {
    let start = yrcx_controller::simulator::Start::default();
    // It has threads of its own.
    let server = yrcx::eip::simulated::serve(start, Listen::anywhere(Ipv4Addr::LOCALHOST), None)?;
    ensure!(tell(format!("eip://{}", server.address())), "nobody listens");
    std::future::pending().await
}
