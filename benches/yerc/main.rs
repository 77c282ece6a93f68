//! Speed of armctl compared with minimal programs that do the same work.
//!
//! Every comparison runs its contenders in turn in each round, so that other load affects all of them. The figures are
//! medians, and a ratio is the median of the ratios of adjacent runs. Everything uses the loopback interface and the
//! same kind of server: a thread that blocks in its socket.
//!
//! `cargo bench --bench yerc` measures everything, with `-- status download` only the named parts. `-- --quick` and
//! `cargo test --benches` only check that the benchmark works.

#![expect(clippy::print_stdout, reason = "a benchmark reports to whoever runs it")]

mod bare;
#[path = "../common/mod.rs"]
mod common;
mod peers;

use std::process::Command;
use std::time::Duration;

use anyhow::{Context as _, ensure};
use armctl_controller::yerc::files::FileName;
use armctl_controller::yerc::query::ReadStatus;
use armctl_controller::yerc::session::DownloadEnd;
use armctl_frame::output::{ColorChoice, Format, Screen};
use armctl_frame::settings::target::Family;
use armctl_frame::settings::{Selection, Sources};
use armctl_frame::{Access, ConnectMode, Family as _};
use armctl_yerc::link::{Link, Yerc};
use moto_hses_client::HsesClient;
use tokio::runtime::Runtime;

use common::controllers::{self, Delays};
use common::process;
use common::table::{Goal, Row, Table};
use common::{Work, median, ratio, run, run_alternately, runtime};
use peers::Controller;

const MIB: u64 = 1024 * 1024;

/// Amount of work: either enough for figures, or only enough for a check.
struct Effort {
    status_rounds: usize,
    exchanges: u32,
    download_rounds: usize,
    download: u64,
    starts: usize,
    big: u64,
    files: &'static [(&'static str, u64)],
    readings: u32,
    lines: usize,
    line_rounds: usize,
}

const FULL: Effort = Effort {
    status_rounds: 200,
    exchanges: 400,
    download_rounds: 15,
    download: 16 * MIB,
    starts: 200,
    big: 64 * MIB,
    files: &[("1 kB", 1000), ("64 kB", 64_000), ("1 MB", 1_000_000), ("16 MB", 16_000_000), ("64 MB", 64_000_000)],
    readings: 500,
    lines: 2000,
    line_rounds: 15,
};

const QUICK: Effort = Effort {
    status_rounds: 3,
    exchanges: 200,
    download_rounds: 3,
    download: MIB / 2,
    starts: 5,
    big: 2 * MIB,
    files: &[("1 kB", 1000), ("64 kB", 64_000)],
    readings: 10,
    lines: 200,
    line_rounds: 3,
};

/// Comparisons, by their argument.
const COMPARISONS: [(&str, common::Compare<Effort>); 7] = [
    ("status", status),
    ("download", download),
    ("files", files),
    ("start", start),
    ("memory", memory),
    ("lines", lines),
    ("watch", watch),
];

fn main() -> anyhow::Result<()> {
    run(&COMPARISONS, &FULL, &QUICK)
}

/// Measures round trips of a status request: our link, a bare echo of the same size, and the client of
/// `moto-hses-client`.
fn status(effort: &Effort) -> anyhow::Result<Table> {
    let controller = Controller::start(0)?;
    let runtime = runtime()?;
    let mut link = connect(&runtime, &controller)?;
    let hses = runtime.block_on(HsesClient::new(&controller.robot.to_string()))?;
    let mut echo = bare::Echo::open(controller.robot)?;

    let exchanges = effort.exchanges;
    let ours = || {
        runtime.block_on(async {
            for _ in 0..exchanges {
                link.ask(&ReadStatus).await?;
            }
            anyhow::Ok(())
        })
    };
    let bare = || (0..exchanges).try_for_each(|_| Ok(echo.round_trip()?));
    let other = || {
        runtime.block_on(async {
            for _ in 0..exchanges {
                hses.read_status().await?;
            }
            anyhow::Ok(())
        })
    };
    let [ours, bare, other] =
        run_alternately(effort.status_rounds, [&mut { ours } as &mut dyn Work, &mut { bare }, &mut { other }])?;
    let per_second = |times: &[f64]| format!("{:.0} /s", f64::from(exchanges) / median(times));
    let mut table = Table::new("status round trips over loopback");
    table.row(Row::new("bare blocking UDP echo, 32 bytes out, 40 back", per_second(&bare)));
    let ratio = ratio(&bare, &ours);
    table.row(Row::new("armctl, Link::ask(ReadStatus)", per_second(&ours)).compared_with(ratio, Goal::AtLeast(0.8)));
    let ahead = common::ratio(&other, &ours);
    table.row(
        Row::new("moto-hses-client, read_status", per_second(&other)).compared_with_armctl(ahead, Goal::MoreThan(1.0)),
    );
    Ok(table)
}

/// Measures a download that is not stored: our link, and a bare loop that checks the block number.
fn download(effort: &Effort) -> anyhow::Result<Table> {
    let size = effort.download;
    let controller = Controller::start(size)?;
    let runtime = runtime()?;
    let mut link = connect(&runtime, &controller)?;
    let mut plain = bare::Download::open(controller.file)?;

    let request = FileName::new("BIG.DAT")?.save();
    let ours = || {
        let mut sum = 0;
        let end = runtime.block_on(link.download(&request, u64::MAX, None, |piece| {
            sum += piece.len() as u64;
            Ok(())
        }));
        let end = end?;
        ensure!(matches!(end, DownloadEnd::Complete { bytes, .. } if bytes == size && sum == size), "{end:?}");
        Ok(())
    };
    let bare = || {
        let bytes = plain.run()?;
        ensure!(bytes == size, "{bytes} bytes came");
        Ok(())
    };
    let [ours, bare] = run_alternately(effort.download_rounds, [&mut { ours } as &mut dyn Work, &mut { bare }])?;
    let rate = |times: &[f64]| format!("{:.1} MiB/s", mebibytes(size) / median(times));
    let mut table = Table::new(format!("download of {:.1} MiB in blocks of 479 bytes", mebibytes(size)));
    table.row(Row::new("bare blocking stop-and-wait", rate(&bare)));
    let ratio = ratio(&bare, &ours);
    table.row(Row::new("armctl, Link::download", rate(&ours)).compared_with(ratio, Goal::AtLeast(0.9)));
    Ok(table)
}

/// Measures whole processes that fetch and store a file, for files of several sizes, and the same bare loop.
fn files(effort: &Effort) -> anyhow::Result<Table> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().to_str().context("the folder for temporary files is not UTF-8")?;
    let mut table = Table::new("armctl yerc file get, from start to exit, and the bare loop in the same time");
    for (name, size) in effort.files {
        let controller = Controller::start(*size)?;
        let mut plain = bare::Download::open(controller.file)?;
        let mut get = armctl(&controller, &["yerc", "file", "get", "BIG.DAT", "--force", "--dir", path]);
        let ours = || process::assert_success(&mut get);
        let bare = || plain.run().map(|_| ()).map_err(Into::into);
        let [ours, bare] = run_alternately(effort.line_rounds, [&mut { ours } as &mut dyn Work, &mut { bare }])?;
        let figure = format!("{:.1} ms", median(&ours) * 1e3);
        table.row(Row::new(name, figure).compared_with(ratio(&bare, &ours), Goal::AtLeast(0.9)));
    }
    Ok(table)
}

/// Measures a watch: its readings per time, compared with its interval.
fn watch(effort: &Effort) -> anyhow::Result<Table> {
    let controller = Controller::start(0)?;
    let mut table = Table::new(format!("armctl yerc status --watch, {} readings", effort.readings));
    for (name, interval, millis) in
        [("every 10 ms", "10ms", 10), ("every 20 ms", "20ms", 20), ("every 100 ms", "100ms", 100)]
    {
        let count = (effort.readings * 10 / millis).max(5);
        let mut watch =
            armctl(&controller, &["--json", "--count", &count.to_string(), "--watch", interval, "yerc", "status"]);
        let elapsed = common::measure_time(&mut || process::assert_success(&mut watch))?;
        // The first reading is at the start.
        let least = Duration::from_millis(u64::from(millis) * u64::from(count - 1)).as_secs_f64();
        let figure = format!("{:.2} ms", elapsed.as_secs_f64() * 1e3 / f64::from(count - 1));
        let ratio = least / elapsed.as_secs_f64();
        table.row(Row::new(name, figure).with_comparison(ratio, "the interval", Goal::AtLeast(0.9)));
    }
    Ok(table)
}

/// Measures `armctl yerc status` from start to exit, compared with a process that does nothing.
fn start(effort: &Effort) -> anyhow::Result<Table> {
    let controller = Controller::start(0)?;
    let mut status = armctl(&controller, &["yerc", "status"]);
    let ours = || process::assert_success(&mut status);
    let mut nothing = process::run_empty_process();
    let bare = || process::assert_success(&mut nothing);
    let [ours, bare] = run_alternately(effort.starts, [&mut { ours } as &mut dyn Work, &mut { bare }])?;
    let mut table = Table::new("a whole process, start to exit");
    let millis = |times: &[f64]| median(times) * 1e3;
    table.row(Row::new("true", format!("{:.2} ms", millis(&bare))));
    let row = Row::new("armctl yerc status", format!("{:.2} ms", millis(&ours)));
    table.row(row.goal(millis(&ours), Goal::AtMost(3.0, "ms")));
    Ok(table)
}

/// Measures the peak memory of a large download.
fn memory(effort: &Effort) -> anyhow::Result<Table> {
    let controller = Controller::start(effort.big)?;
    let folder = tempfile::tempdir()?;
    let path = folder.path().to_str().context("the folder for temporary files is not UTF-8")?;
    let mut get = armctl(&controller, &["yerc", "file", "get", "BIG.DAT", "--dir", path]);
    let peak = process::peak_memory(&mut get)?;
    let received = std::fs::metadata(folder.path().join("BIG.DAT"))?.len();
    ensure!(received == effort.big, "{received} bytes were stored");
    let mut table = Table::new(format!("memory for a download of {:.0} MiB", mebibytes(effort.big)));
    let row = Row::new("armctl yerc file get, resident at most", format!("{:.1} MiB", mebibytes(peak)));
    table.row(row.goal(mebibytes(peak), Goal::AtMost(20.0, "MiB")));
    Ok(table)
}

/// Measures the lines of a command file on its shared link, on links of their own, and on a simulator.
fn lines(effort: &Effort) -> anyhow::Result<Table> {
    let count = effort.lines;
    let controller = Controller::start(0)?;
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("lines");
    std::fs::write(&file, "yerc status\n".repeat(count))?;
    let file = file.to_str().context("the folder for temporary files is not UTF-8")?;
    // To open the shared link, armctl reads more than the status.
    let inventory = folder.path().join("robots.toml");
    std::fs::write(&inventory, controllers::serve([1, 0, 0], Delays::default(), 1)?)?;
    let mut echo = bare::Echo::open(controller.robot)?;
    let bare = || (0..count).try_for_each(|_| Ok(echo.round_trip()?));
    let batch = |args: &[&str]| {
        let mut command = process::unconfigured();
        command.arg("--config").arg(&inventory).args(["-r", "yerc0", "batch", file]).args(args);
        command.env("XDG_RUNTIME_DIR", folder.path());
        move || process::assert_success(&mut command)
    };
    let (shared, own) = (batch(&[]), batch(&["--no-session"]));
    let mut simulated = process::unconfigured();
    simulated.args(["--sim", "batch", file]).env("XDG_RUNTIME_DIR", folder.path());
    let simulated = || process::assert_success(&mut simulated);
    let [bare, own, shared, simulated] = run_alternately(
        effort.line_rounds,
        [&mut { bare } as &mut dyn Work, &mut { own }, &mut { shared }, &mut { simulated }],
    )?;
    #[expect(clippy::cast_precision_loss, reason = "a few thousand lines")]
    let micros = |times: &[f64]| format!("{:.0} us", median(times) * 1e6 / count as f64);
    let mut table = Table::new(format!("one line of a command file with {count} lines `yerc status`"));
    table.row(Row::new("bare blocking UDP echo", micros(&bare)));
    table.row(Row::new("armctl batch --no-session", micros(&own)));
    // A line on the shared link takes at most 1.5 times as long as a line on its own link.
    let goal = Goal::AtLeast(0.667);
    table.row(Row::new("armctl batch", micros(&shared)).with_comparison(ratio(&own, &shared), "--no-session", goal));
    table.row(Row::new("armctl batch --sim", micros(&simulated)).with_comparison(
        ratio(&own, &simulated),
        "--no-session",
        goal,
    ));
    Ok(table)
}

/// Returns a command with the binary of the same build, for `controller`.
fn armctl(controller: &Controller, args: &[&str]) -> Command {
    let mut command = process::unconfigured();
    command.arg("--target").arg(controller.url()).args(args);
    command
}

/// Connects like a command of armctl.
fn connect(runtime: &Runtime, controller: &Controller) -> anyhow::Result<Link> {
    let target = controller.url().parse()?;
    let selection = Selection { target: Some(target), ..Selection::default() };
    let sources = Sources { selection, ..Sources::default() };
    let robots = sources.robots(Some(Family::Yerc))?;
    let robot = robots.first().context("a target is a robot")?;
    let access = Access::reading(ConnectMode::Control);
    let screen = Screen::new(Format::Table, ColorChoice::Never, true, 0);
    Ok(runtime.block_on(Yerc::connect(robot, access, &screen))?)
}

#[expect(clippy::cast_precision_loss, reason = "a figure for people")]
fn mebibytes(bytes: u64) -> f64 {
    bytes as f64 / MIB as f64
}
