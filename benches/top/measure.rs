//! The measurement.

use std::fmt::Write as _;
use std::net::{Ipv4Addr, SocketAddr};
use std::process::Command;
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context as _, ensure};
use armctl::command::{toyo, yerc, yrcx};
use armctl::controller::yerc::Model;
use armctl::controller::yerc::simulator::Simulator;
use armctl::transport::eip::adapter::server::Listen;
use armctl::transport::server::Server;
use armctl::transport::stream_server::StreamServer;

use crate::common::run;
use crate::common::table::{Goal, Row, Table};
use crate::terminal::Terminal;

/// How many controllers of each family, and how long they are watched.
struct Effort {
    yerc: usize,
    toyo: usize,
    yrcx: usize,
    time: Duration,
    every: &'static str,
}

const FULL: Effort = Effort { yerc: 40, toyo: 5, yrcx: 5, time: Duration::from_secs(10), every: "100ms" };
const QUICK: Effort = Effort { yerc: 2, toyo: 1, yrcx: 1, time: Duration::from_millis(300), every: "100ms" };

/// Most of a core, in percent, that the issue allows.
const QUARTER: f64 = 25.0;

pub fn main() -> anyhow::Result<()> {
    run(&[("top", top)], &FULL, &QUICK)
}

/// All in a list, and one of them on its screen.
fn top(effort: &Effort) -> anyhow::Result<Table> {
    let targets = controllers(effort)?;
    let folder = tempfile::tempdir()?;
    let mut inventory = String::new();
    for (number, (family, target)) in (1..).zip(&targets) {
        write!(inventory, "[[robot]]\nname = \"cell{number}\"\nfamily = \"{family}\"\ntarget = \"{target}\"\n")?;
    }
    let path = folder.path().join("robots.toml");
    std::fs::write(&path, inventory)?;
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    command.args(["top", "--watch", effort.every]).env("ARMCTL_CONFIG", &path).env("TERM", "xterm-256color");
    command.env("LANG", "C.UTF-8").env("XDG_RUNTIME_DIR", folder.path()).env_remove("NO_COLOR");
    let mut terminal = Terminal::start(command, 120, 60)?;
    let count = targets.len();
    terminal.shows(&format!("{count} robots · {count} answer"));
    let in_list = share(&mut terminal, effort.time)?;
    terminal.press("\r");
    terminal.shows("SIGNALS");
    let on_screen = share(&mut terminal, effort.time)?;
    terminal.press("q");
    ensure!(terminal.end().success(), "top did not end well");
    let mut table = Table::new(format!("top: {count} robots every {}, of one core", effort.every));
    let goal = Goal::AtMost(QUARTER, "% of a core");
    table.row(Row::new("all in the list", format!("{in_list:.1} %")).goal(in_list, goal));
    table.row(Row::new("one on its screen, the others go on", format!("{on_screen:.1} %")).goal(on_screen, goal));
    Ok(table)
}

/// What it uses of a core, in percent, while it is shown for so long.
fn share(terminal: &mut Terminal, time: Duration) -> anyhow::Result<f64> {
    let (began, before) = (Instant::now(), used(terminal.child.id())?);
    while began.elapsed() < time {
        ensure!(terminal.read(), "top wrote nothing any more");
    }
    let used = used(terminal.child.id())?.saturating_sub(before);
    Ok(100.0 * used.as_secs_f64() / began.elapsed().as_secs_f64())
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

/// Starts controllers that end with the process; says family and target of each.
fn controllers(effort: &Effort) -> anyhow::Result<Vec<(&'static str, String)>> {
    let mut targets = Vec::new();
    for _ in 0..effort.yerc {
        targets.push(("yerc", served(yerc_controller)?));
    }
    for _ in 0..effort.toyo {
        targets.push(("toyo", served(toyo_controller)?));
    }
    for _ in 0..effort.yrcx {
        let start = yrcx::simulated::start(None)?;
        let server = yrcx::eip::simulated::serve(start, Listen::anywhere(Ipv4Addr::LOCALHOST), None)?;
        targets.push(("yrcx", format!("eip://{}", server.address())));
        // It serves as long as it is there.
        std::mem::forget(server);
    }
    Ok(targets)
}

/// What tells where a controller is.
type Tell = mpsc::Sender<String>;

/// Serves a controller on a thread of its own, and waits until it says where it is.
fn served(serve: fn(&Tell) -> anyhow::Result<()>) -> anyhow::Result<String> {
    let (tell, told) = mpsc::channel();
    thread::spawn(move || serve(&tell));
    told.recv().context("a simulator did not start")
}

const ANYWHERE: SocketAddr = SocketAddr::new(std::net::IpAddr::V4(Ipv4Addr::LOCALHOST), 0);

fn yerc_controller(tell: &Tell) -> anyhow::Result<()> {
    let start = yerc::simulated::start(None, Model::Dx200, None)?;
    crate::common::runtime()?.block_on(async {
        let mut server = Server::bind([ANYWHERE, ANYWHERE], None).await?;
        tell.send(format!("udp://{}?file_port={}", server.local(0)?, server.local(1)?.port()))?;
        let mut controller = yerc::simulated::Simulated(Simulator::new(start));
        loop {
            server.turn(&mut controller).await?;
        }
    })
}

fn toyo_controller(tell: &Tell) -> anyhow::Result<()> {
    let start = toyo::simulated::start(None, None, None)?;
    crate::common::runtime()?.block_on(async {
        let (mut server, local) = StreamServer::tcp(ANYWHERE, None, None).await?;
        tell.send(format!("tcp://{local}"))?;
        let mut controller = toyo::simulated::Simulated::new(start);
        loop {
            server.turn(&mut controller).await?;
        }
    })
}
