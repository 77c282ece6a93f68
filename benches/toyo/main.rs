//! Use of a serial line, and speed of offline program commands.
//!
//! `cargo bench --bench toyo` measures everything (the line takes one and a half minutes), with `-- check` only the
//! named part. `-- --quick` and `cargo test --benches` only check that the benchmark works.

#![expect(clippy::print_stdout, reason = "a benchmark reports to whoever runs it")]

#[path = "../common/mod.rs"]
mod common;

use std::net::{Ipv4Addr, SocketAddr};
use std::sync::mpsc;
use std::time::Duration;

use anyhow::{Context as _, ensure};
use armctl_controller::toyo::program;
use armctl_controller::toyo::request::Request;
use armctl_controller::toyo::simulator::{Simulator, Start};
use armctl_controller::toyo::table::Parameter;
use armctl_frame::output::{ColorChoice, Format, Screen};
use armctl_frame::settings::target::Family;
use armctl_frame::settings::{Selection, Sources};
use armctl_frame::{Access, ConnectMode, Family as _};
use armctl_toyo::link::{Link, Toyo};
use armctl_toyo::simulated::Simulated;
use armctl_transport::line::Pace;
use armctl_transport::stream_server::StreamServer;

use common::table::{Goal, Row, Table};
use common::{measure_time, median, run, run_alternately, runtime};

/// 9600 baud, 8 data bits, even parity, one stop bit (TO 1-2).
const BAUD: u32 = 9600;
const BITS: u32 = 11;

/// Amount of work: either enough for figures, or only enough for a check.
struct Effort {
    points: i32,
    steps: usize,
    checks: usize,
    instructions: u64,
    runs: usize,
}

const FULL: Effort = Effort { points: 999, steps: 5000, checks: 50, instructions: 1_000_000, runs: 5 };
const QUICK: Effort = Effort { points: 5, steps: 500, checks: 3, instructions: 10_000, runs: 1 };

/// Comparisons, by their argument.
const COMPARISONS: [(&str, common::Compare<Effort>); 3] =
    [("points", points), ("check", check), ("instructions", instructions)];

fn main() -> anyhow::Result<()> {
    run(&COMPARISONS, &FULL, &QUICK)
}

/// Measures reads of rows of the coordinate table over a line of 9600 baud, compared with the transmission time of the
/// characters.
fn points(effort: &Effort) -> anyhow::Result<Table> {
    let address = serve()?;
    let runtime = runtime()?;
    let mut link = connect(&runtime, address)?;
    let table = Parameter::named("point").context("there is a coordinate table")?;
    let mut characters = 0;
    let elapsed = measure_time(&mut || {
        runtime.block_on(async {
            for row in 1..=effort.points {
                let request = Request::read_parameter(table, Some(row))?;
                let answer = link.raw(&request).await?;
                // Both lines end with CR and LF. The LF of the request is not counted, because the controller may
                // answer while the LF is transmitted.
                characters += request.text().len() + 1 + answer.text().len() + 2;
            }
            anyhow::Ok(())
        })
    })?;
    let least = Pace::new(BAUD, BITS).time(characters);
    let busy = least.as_secs_f64() / elapsed.as_secs_f64();
    let mut table = Table::new(format!("{} points over a line of {BAUD} baud", effort.points));
    table.row(Row::new("the characters alone, 11 bits each", format!("{:.1} s", least.as_secs_f64())));
    let row = Row::new("armctl, Link::raw", format!("{:.1} s", elapsed.as_secs_f64()));
    table.row(row.compared_with(busy, Goal::AtLeast(0.95)));
    Ok(table)
}

/// Measures the check of a program with the maximum number of steps.
fn check(effort: &Effort) -> anyhow::Result<Table> {
    let text = long_program(effort.steps);
    let [times] = run_alternately(
        effort.checks,
        [&mut || {
            let checked = program::check(text.as_bytes(), effort.steps);
            ensure!(
                checked.program.is_some_and(|program| program.steps.len() == effort.steps),
                "the program is correct"
            );
            Ok(())
        }],
    )?;
    let millis = median(&times) * 1e3;
    let mut table = Table::new(format!("a program of {} steps", effort.steps));
    let row = Row::new("armctl, program::check", format!("{millis:.2} ms"));
    table.row(row.goal(millis, Goal::AtMost(50.0, "ms")));
    Ok(table)
}

/// Returns a program with jumps, calls, counters and moves, and with one label in ten steps.
fn long_program(steps: usize) -> String {
    const BODY: [&str; 9] = [
        "MOVP a PT=1 CN=0 S V=0 POST",
        "OUT STN=0 PN1=.......1",
        "CNT+ CN1=1",
        "JMPC TAG=again CN1>=10",
        "TIM TM=0.5",
        "IN STN=0 PN1=......1. AND",
        "MOV i X=1.5 Y=-2 Z=0 R=0 T V=2 PASS",
        "CAL TAG=again",
        "SPD V=5",
    ];
    let mut lines = vec!["again:".to_owned()];
    for step in 2..steps {
        lines.push(match step % 10 {
            0 => format!("part{step}:"),
            other => BODY[other - 1].to_owned(),
        });
    }
    lines.push("END".to_owned());
    lines.join("\n")
}

/// Measures a loop of a counter and a jump in the simulator. The benchmark controls the clock.
fn instructions(effort: &Effort) -> anyhow::Result<Table> {
    let [times] = run_alternately(
        effort.runs,
        [&mut || {
            let start = Start::parse(
                "host = true\norigin = true\ninstruction_us = 1000\n\
             steps = { 1 = [\"TAG TAG=001\", \"CNT+ CN01=0001\", \"CNT CN01=0000\", \"JMP TAG=001\"] }\n",
            );
            let mut simulator = Simulator::new(start.map_err(anyhow::Error::msg)?);
            simulator.receive(Duration::ZERO, b"@SPST 0001\r\n");
            let answer = simulator.transmit(Duration::ZERO).context("an answer")?;
            ensure!(answer == b"@OK\r\n", "{}", String::from_utf8_lossy(&answer));
            simulator.advance(Duration::from_millis(effort.instructions));
            ensure!(simulator.state().executing, "the program still runs");
            Ok(())
        }],
    )?;
    let seconds = median(&times);
    let mut table = Table::new(format!("{} instructions in the simulator", effort.instructions));
    let row = Row::new("armctl, Simulator::advance", format!("{seconds:.3} s"));
    table.row(row.goal(seconds, Goal::AtMost(1.0, "s")));
    Ok(table)
}

/// Serves a simulated controller behind a line of 9600 baud until the process ends.
fn serve() -> anyhow::Result<SocketAddr> {
    let (tell, told) = mpsc::channel();
    std::thread::spawn(move || {
        let runtime = runtime()?;
        runtime.block_on(async {
            let any = SocketAddr::from((Ipv4Addr::LOCALHOST, 0));
            let (mut server, address) = StreamServer::tcp(any, Some(Pace::new(BAUD, BITS)), None).await?;
            let mut controller = Simulated::new(Start::default());
            tell.send(address)?;
            loop {
                server.turn(&mut controller).await?;
            }
            #[expect(unreachable_code, reason = "it says what the block would return")]
            anyhow::Ok(())
        })
    });
    told.recv().context("the server listens")
}

/// Connects like a command of armctl.
fn connect(runtime: &tokio::runtime::Runtime, address: SocketAddr) -> anyhow::Result<Link> {
    let selection = Selection { target: Some(format!("tcp://{address}").parse()?), ..Selection::default() };
    let sources = Sources { selection, ..Sources::default() };
    let robots = sources.robots(Some(Family::Toyo))?;
    let robot = robots.first().context("a target is a robot")?;
    let access = Access::reading(ConnectMode::Control);
    let screen = Screen::new(Format::Table, ColorChoice::Never, true, 0);
    Ok(runtime.block_on(Toyo::connect(robot, access, &screen))?)
}
