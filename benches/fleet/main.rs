//! How long `armctl status` takes over a fleet of mixed families, beside the slowest of its controllers alone.
//!
//! Whole processes, from start to end, on one inventory; the controllers are simulators on the loopback, all in this
//! process, so that they share the machine's cores with the command. `cargo bench --bench fleet` measures 200 of them;
//! `-- --quick`, and `cargo test --benches`, only show that it works.

#![expect(clippy::print_stdout, reason = "a benchmark reports to whoever runs it")]

#[path = "../common/mod.rs"]
mod common;

use std::future::Future;
use std::net::{Ipv4Addr, SocketAddr};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::mpsc;

use anyhow::{Context as _, ensure};
use armctl::command::{toyo, yerc, yrcx};
use armctl::controller::{toyo as toyo_controller, yerc as yerc_controller, yrcx as yrcx_controller};
use armctl::transport::eip::adapter::server::Listen;
use armctl::transport::fault::Faults;
use armctl::transport::line::Pace;
use armctl::transport::server::Server;
use armctl::transport::stream_server::StreamServer;
use tokio::task::LocalSet;

use common::table::{Goal, Row, Table};
use common::{in_turn, median, ratio, run, runtime};

/// How many controllers of yerc, toyo and yrcx there are, and how often the command runs.
struct Effort {
    fleet: [usize; 3],
    rounds: usize,
}

const FULL: Effort = Effort { fleet: [140, 40, 20], rounds: 21 };
const QUICK: Effort = Effort { fleet: [4, 2, 2], rounds: 1 };

/// The names of the families, in the order of a fleet.
const FAMILIES: [&str; 3] = ["yerc", "toyo", "yrcx"];

/// The comparisons, by the word that chooses one.
const COMPARISONS: [(&str, common::Compare<Effort>); 2] = [("lines", lines), ("at-once", at_once)];

fn main() -> anyhow::Result<()> {
    run(&COMPARISONS, &FULL, &QUICK)
}

/// Controllers as they are: a Yaskawa takes some milliseconds for an answer, a Toyo is at the end of 9600 baud.
fn lines(effort: &Effort) -> anyhow::Result<Table> {
    let table = Table::new(format!("status of {} controllers on lines as they are", total(effort)));
    compare(table, effort, Some(Goal::AtMost(2.0, "x")), Delays { answer: "2..8ms", baud: Some(9600) })
}

/// Controllers that answer at once: what is left is the work of this machine, for both ends.
fn at_once(effort: &Effort) -> anyhow::Result<Table> {
    let table = Table::new(format!("status of {} controllers that answer at once", total(effort)));
    compare(table, effort, None, Delays { answer: "0ms", baud: None })
}

/// How slow the controllers are.
#[derive(Clone, Copy)]
struct Delays {
    /// Of a datagram, as `--fault delay=` takes it.
    answer: &'static str,
    /// Of a serial line.
    baud: Option<u32>,
}

fn total(effort: &Effort) -> usize {
    effort.fleet.iter().sum()
}

fn compare(mut table: Table, effort: &Effort, goal: Option<Goal>, delays: Delays) -> anyhow::Result<Table> {
    let folder = tempfile::tempdir()?;
    let inventory = folder.path().join("robots.toml");
    std::fs::write(&inventory, serve(effort.fleet, delays)?)?;
    let ask = |who: &'static str| {
        let mut command = status(&inventory, folder.path(), who);
        move || {
            let status = command.status()?;
            ensure!(status.success(), "{command:?} ended with {status}");
            Ok(())
        }
    };
    let [mut all, mut yerc, mut toyo, mut yrcx] = [ask("*"), ask("yerc0"), ask("toyo0"), ask("yrcx0")];
    let times = in_turn(effort.rounds, [&mut all, &mut yerc, &mut toyo, &mut yrcx])?;
    let [all, ones @ ..] = &times;
    for (family, times) in FAMILIES.iter().zip(ones) {
        table.row(Row::new(family, format!("{:.1} ms", median(times) * 1e3)));
    }
    let slowest = ones.iter().max_by(|a, b| median(a).total_cmp(&median(b))).context("there are families")?;
    let times = ratio(all, slowest);
    let row = Row::new("all of them", format!("{:.1} ms ({times:.2} x)", median(all) * 1e3));
    table.row(match goal {
        Some(goal) => row.goal(times, goal),
        None => row,
    });
    Ok(table)
}

fn status(inventory: &Path, home: &Path, who: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    command.arg("--config").arg(inventory).args(["-r", who, "status", "--json"]);
    command.env_clear().env("HOME", home).stdin(Stdio::null()).stdout(Stdio::null());
    command
}

/// Serves a fleet until the process ends, and gives its inventory.
fn serve(fleet: [usize; 3], delays: Delays) -> anyhow::Result<String> {
    let (tell, told) = mpsc::channel();
    std::thread::spawn(move || {
        let local = LocalSet::new();
        for (family, count) in FAMILIES.into_iter().zip(fleet) {
            for number in 0..count {
                let tell = tell.clone();
                let tell = move |target: String| {
                    let entry = format!("[[robot]]\nname = \"{family}{number}\"\ntarget = \"{target}\"\n");
                    tell.send(entry).map_err(|_| anyhow::anyhow!("nobody wants to know where they are"))
                };
                match family {
                    "yerc" => drop(local.spawn_local(until_it_fails(yerc(tell, delays)))),
                    "toyo" => drop(local.spawn_local(until_it_fails(toyo(tell, delays)))),
                    _ => drop(local.spawn_local(until_it_fails(yrcx(tell)))),
                }
            }
        }
        // Where one fails to start, the list below is short of it.
        drop(tell);
        runtime().map(|runtime| runtime.block_on(local))
    });
    let entries: Vec<String> = told.iter().take(fleet.iter().sum()).collect();
    ensure!(entries.len() == fleet.iter().sum::<usize>(), "not every controller could be served");
    Ok(entries.concat())
}

async fn until_it_fails(served: impl Future<Output = anyhow::Result<()>>) {
    if let Err(error) = served.await {
        println!("a simulated controller ended: {error:#}");
    }
}

const ANY: SocketAddr = SocketAddr::new(std::net::IpAddr::V4(Ipv4Addr::LOCALHOST), 0);

async fn yerc(tell: impl FnOnce(String) -> anyhow::Result<()>, delays: Delays) -> anyhow::Result<()> {
    let faults = format!("delay={}", delays.answer).parse().map_err(anyhow::Error::msg)?;
    let mut server = Server::bind([ANY, ANY], Some(Faults::pair(faults))).await?;
    tell(format!("udp://{}?file_port={}", server.local(0)?, server.local(1)?.port()))?;
    let start = yerc::simulated::start(None, yerc_controller::Model::Dx200, None)?;
    let mut controller = yerc::simulated::Simulated(yerc_controller::simulator::Simulator::new(start));
    loop {
        server.turn(&mut controller).await?;
    }
}

async fn toyo(tell: impl FnOnce(String) -> anyhow::Result<()>, delays: Delays) -> anyhow::Result<()> {
    let pace = delays.baud.map(|baud| Pace::new(baud, 11));
    let (mut server, address) = StreamServer::tcp(ANY, pace, None).await?;
    tell(format!("tcp://{address}"))?;
    let mut controller = toyo::simulated::Simulated::new(toyo_controller::simulator::Start::default());
    loop {
        server.turn(&mut controller).await?;
    }
}

async fn yrcx(tell: impl FnOnce(String) -> anyhow::Result<()>) -> anyhow::Result<()> {
    let start = yrcx_controller::simulator::Start::default();
    // It has threads of its own.
    let server = yrcx::eip::simulated::serve(start, Listen::anywhere(Ipv4Addr::LOCALHOST), None)?;
    tell(format!("eip://{}", server.address()))?;
    std::future::pending().await
}
