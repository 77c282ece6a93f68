//! Comparison of our PROFINET controller and the controller of PyPI's `profinet-py`. Each is connected to the simulated
//! device through another network card. Measured are the time until data, the timing of frames compared with a bare
//! timer loop in the same minute, and CPU time.
//!
//! The benchmark needs user namespaces, and `ARMCTL_PROFINET_PEERS` for the other controller. Missing parts are
//! reported.

use std::net::UdpSocket;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context as _, ensure};
use armctl_transport::image::tap::Tap;
use armctl_transport::profinet::layout::Layout;
use armctl_transport::profinet::network::Network;
use armctl_transport::profinet::settings::{Settings, Station};

use super::common::runtime;
use super::common::table::{Row, Table};
use super::virtual_time::resting;
use super::{Effort, namespaces};

const CYCLE: Duration = Duration::from_millis(16);

/// Script that runs the contenders one after the other, with the same recorder of their frames. Each contender prints
/// its figures on a line.
const CHILD_VARIABLE: &str = r#"
$THERE "$ARMCTL" sim yrcx --bus profinet --interface pd0 > "$FOLDER/sim" 2>&1 & D=$!
wait_for profinet:// "$FOLDER/sim" $D
look() {
    name=$1
    shift
    rm -f "$FOLDER/looker"
    python3 "$LOOKER" pc0 $name 0.016 > "$FOLDER/looker" & L=$!
    wait_for ready "$FOLDER/looker" $L
    "$@" 2>&1
    kill $L
    wait $L
    cat "$FOLDER/looker"
}
for round in $ROUNDS; do
    ROLE=controller look armctl "$PROGRAM"
    [ -z "$PEERS" ] || look profinet-py "$PEERS/bin/python" "$SCRIPT" pc0 yrcx-sim yrcx time=$SECONDS_EACH
    ROLE=bare look bare "$PROGRAM"
done
kill $D
wait $D
"#;

/// Results of one run of a controller.
struct Figures {
    name: &'static str,
    connect: Vec<f64>,
    jitter: Vec<f64>,
    cost: Vec<f64>,
}

pub fn compare(effort: &Effort) -> anyhow::Result<Table> {
    let program = std::env::current_exe()?;
    let folder = tempfile::tempdir()?;
    let peers = std::env::var("ARMCTL_PROFINET_PEERS").unwrap_or_default();
    let rounds = (0..effort.rounds).map(|round| round.to_string()).collect::<Vec<_>>().join(" ");
    let seconds = effort.time.as_secs_f64().to_string();
    let variables = [
        ("PROGRAM", program.to_str().context("its path is UTF-8")?),
        ("ARMCTL", env!("CARGO_BIN_EXE_armctl")),
        ("FOLDER", folder.path().to_str().context("its path is UTF-8")?),
        ("PEERS", peers.as_str()),
        ("SCRIPT", concat!(env!("CARGO_MANIFEST_DIR"), "/tests/profinet/controller.py")),
        ("LOOKER", concat!(env!("CARGO_MANIFEST_DIR"), "/benches/fieldbus/looker.py")),
        ("ROUNDS", rounds.as_str()),
        ("SECONDS_EACH", seconds.as_str()),
    ];
    let mut table = Table::new("PROFINET IO, 48 bytes each way every 16 ms, from another network namespace");
    let Some(said) = namespaces::run(CHILD_VARIABLE, &variables) else {
        table.row(Row::new(namespaces::SKIPPED, String::new()));
        return Ok(table);
    };
    let mut all = ["armctl", "bare", "profinet-py"].map(|name| Figures {
        name,
        connect: Vec::new(),
        jitter: Vec::new(),
        cost: Vec::new(),
    });
    for words in said.lines().map(|line| line.split_whitespace().collect::<Vec<_>>()) {
        let Some(figures) = all.iter_mut().find(|figures| words.first() == Some(&figures.name)) else { continue };
        match words[1..] {
            ["figures", connect, used] => {
                figures.connect.push(connect.parse()?);
                let frames = effort.time.as_secs_f64() / CYCLE.as_secs_f64();
                figures.cost.push(used.parse::<f64>()? * 1000.0 / frames);
            }
            ["jitter", jitter] => figures.jitter.push(jitter.parse()?),
            _ => {}
        }
    }
    let [ours, bare, theirs] = &all;
    ensure!(ours.connect.len() == effort.rounds && bare.jitter.len() == effort.rounds, "{said}");
    let ratio = |figures: &Figures| super::common::ratio(&figures.jitter, &bare.jitter);
    for (name, figures) in [
        (
            ["armctl: from nothing to data", "armctl: p99 of the deviation of frames", "armctl: CPU of 1,000 frames"],
            ours,
        ),
        (["profinet-py: from nothing to data", "profinet-py: p99 of the deviation", "profinet-py: CPU"], theirs),
    ] {
        if figures.connect.is_empty() {
            table.row(Row::new("profinet-py", "not installed".to_owned()));
            continue;
        }
        table.row(Row::new(name[0], ms(&figures.connect)));
        table.row(Row::new(name[1], ms(&figures.jitter)).times(ratio(figures), "a bare loop"));
        table.row(Row::new(name[2], ms(&figures.cost)));
    }
    table.row(Row::new("a bare loop: p99 of the deviation", ms(&bare.jitter)));
    Ok(table)
}

fn ms(all: &[f64]) -> String {
    format!("{:.2} ms", super::common::median(all) * 1000.0)
}

fn time() -> anyhow::Result<Duration> {
    Ok(Duration::from_secs_f64(std::env::var("SECONDS_EACH")?.parse()?))
}

/// Our controller, in a separate process.
pub fn controller() -> anyhow::Result<()> {
    let settings = Settings {
        watchdog: Duration::from_millis(1600),
        resting: resting(),
        cycle: CYCLE,
        ..Settings::new(Station::Name("yrcx-sim".to_owned()), Layout::two_modules(0x101, 0x102))
    };
    let runtime = runtime()?;
    let start = Instant::now();
    let network = Network::shared("pc0")?;
    let connection = runtime.block_on(network.open(settings, Tap::default()))?;
    let connect = start.elapsed().as_secs_f64();
    let used = cpu()?;
    thread::sleep(time()?);
    let used = cpu()? - used;
    ensure!(connection.views.now().generation == 1, "the connection was lost: {:?}", connection.views.now().last_error);
    println!("armctl figures {connect} {used}");
    runtime.block_on(connection.close())?;
    Ok(())
}

/// Minimal loop that sends every 16 ms.
pub fn bare_loop() -> anyhow::Result<()> {
    let socket = UdpSocket::bind("192.168.79.1:0")?;
    let (start, mut due) = (Instant::now(), Instant::now());
    while start.elapsed() < time()? {
        due += CYCLE;
        thread::sleep(due.saturating_duration_since(Instant::now()));
        socket.send_to(&[0; 64], "192.168.79.2:9")?;
    }
    Ok(())
}

/// CPU time of all threads of this process, in seconds.
pub fn cpu() -> anyhow::Result<f64> {
    const NANOS: f64 = 1e9;

    let mut all = 0.0;
    for thread in std::fs::read_dir("/proc/self/task")? {
        let text = std::fs::read_to_string(thread?.path().join("schedstat"))?;
        all += text.split(' ').next().unwrap_or_default().parse::<f64>()? / NANOS;
    }
    Ok(all)
}
