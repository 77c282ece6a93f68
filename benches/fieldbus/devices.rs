//! Eight PROFINET devices with a cycle of 8 ms, controlled by one process through one network card. No watchdog may
//! expire. `cargo bench --bench fieldbus -- devices 600` runs for ten minutes.

use std::thread;
use std::time::{Duration, Instant};

use anyhow::Context as _;
use armctl_transport::image::tap::Tap;
use armctl_transport::profinet::layout::Layout;
use armctl_transport::profinet::network::{Connection, Network};
use armctl_transport::profinet::settings::{Settings, Station};

use super::common::runtime;
use super::common::table::{Goal, Row, Table};
use super::profinet::cpu;
use super::virtual_time::resting;
use super::{Effort, namespaces};

const CYCLE: Duration = Duration::from_millis(8);
/// Default watchdog time of a target.
const WATCHDOG: Duration = Duration::from_millis(320);
const DEVICES: usize = 8;
/// Interval at which the age of the last frames is checked.
const SAMPLE_INTERVAL: Duration = Duration::from_millis(4);

/// Script that starts a bridge with a device in its own network namespace at each port. It then starts this program as
/// the controller of the devices.
const CHILD_VARIABLE: &str = r#"
ip link add pn0 type bridge
ip addr add 192.168.80.1/24 dev pn0
ip link set pn0 up
for n in $NUMBERS; do
    unshare -n sleep 3600 & P=$!
    ALL="$ALL $P"
    until [ "$(readlink /proc/$P/ns/net)" != "$(readlink /proc/self/ns/net)" ] && grep -q sleep /proc/$P/cmdline; do :; done
    ip link add pa$n type veth peer name pb$n
    ip link set pb$n netns $P
    ip link set pa$n master pn0 up
    nsenter -t $P -n sh -c "ip addr add 192.168.80.1$n/24 dev pb$n; ip link set lo up; ip link set pb$n up"
    nsenter -t $P -n "$ARMCTL" sim yrcx --bus profinet --interface pb$n --station-name robot-$n > "$FOLDER/$n" 2>&1 & D=$!
    ALL="$ALL $D"
    wait_for profinet:// "$FOLDER/$n" $D
done
ROLE=devices "$PROGRAM" 2>&1
cat /proc/loadavg
kill $ALL
"#;

pub fn compare(effort: &Effort) -> anyhow::Result<Table> {
    let program = std::env::current_exe()?;
    let folder = tempfile::tempdir()?;
    let seconds = std::env::args().find_map(|word| word.parse().ok()).unwrap_or(effort.time.as_secs_f64());
    let numbers = (1..=DEVICES).map(|number| number.to_string()).collect::<Vec<_>>().join(" ");
    let seconds = seconds.to_string();
    let variables = [
        ("PROGRAM", program.to_str().context("its path is UTF-8")?),
        ("ARMCTL", env!("CARGO_BIN_EXE_armctl")),
        ("FOLDER", folder.path().to_str().context("its path is UTF-8")?),
        ("NUMBERS", numbers.as_str()),
        ("SECONDS_EACH", seconds.as_str()),
    ];
    let mut table = Table::new("PROFINET IO, 8 devices every 8 ms from one process, watchdogs of 320 ms");
    let Some(said) = namespaces::run(CHILD_VARIABLE, &variables) else {
        table.row(Row::new(namespaces::SKIPPED, String::new()));
        return Ok(table);
    };
    let figures = said.lines().find_map(|line| line.strip_prefix("held "));
    let figures: Vec<f64> = figures.unwrap_or_default().split(' ').filter_map(|word| word.parse().ok()).collect();
    let [time, lost, sent, received, skipped, longest, cost] = figures[..] else { anyhow::bail!("{said}") };
    table.row(Row::new("time that all were held", format!("{time:.0} s")));
    table.row(Row::new("connections lost", format!("{lost}")).goal(lost, Goal::AtMost(0.0, "")));
    table.row(Row::new("frames sent, and received", format!("{sent}, {received}")));
    table.row(Row::new("cycles that no frame went out in", format!("{skipped}")));
    table.row(Row::new("longest without a frame of a device", format!("{:.1} ms", longest * 1000.0)));
    table.row(Row::new("CPU of 1,000 frames sent", format!("{:.2} ms", cost * 1e6 / sent)));
    Ok(table)
}

/// Runs the controller of all devices, and prints a line with the results.
pub fn hold() -> anyhow::Result<()> {
    let time = Duration::from_secs_f64(std::env::var("SECONDS_EACH")?.parse()?);
    let runtime = runtime()?;
    let network = Network::shared("pn0")?;
    let mut connections = Vec::new();
    for number in 1..=DEVICES {
        let settings = Settings {
            watchdog: WATCHDOG,
            resting: resting(),
            cycle: CYCLE,
            ..Settings::new(Station::Name(format!("robot-{number}")), Layout::two_modules(0x101, 0x102))
        };
        connections.push(runtime.block_on(network.open(settings, Tap::default()))?);
    }
    let totals = || {
        let per_device = connections.iter().map(Connection::statistics);
        per_device.fold([0; 4], |all: [u64; 4], own| {
            let own = [own.losses, own.sent, own.received, own.skipped];
            std::array::from_fn(|at| all[at] + own[at])
        })
    };
    let (before, used, start) = (totals(), cpu()?, Instant::now());
    let mut received_frames = [(0, start); DEVICES];
    let mut longest = Duration::ZERO;
    while start.elapsed() < time {
        thread::sleep(SAMPLE_INTERVAL);
        for (connection, (count, since)) in connections.iter().zip(&mut received_frames) {
            let received = connection.statistics().received;
            longest = longest.max(since.elapsed());
            if received != *count {
                (*count, *since) = (received, Instant::now());
            }
        }
    }
    let (time, used, after) = (start.elapsed().as_secs_f64(), cpu()? - used, totals());
    let [lost, sent, received, skipped]: [u64; 4] = std::array::from_fn(|at| after[at] - before[at]);
    println!("held {time} {lost} {sent} {received} {skipped} {} {used}", longest.as_secs_f64());
    for connection in connections {
        runtime.block_on(connection.close())?;
    }
    Ok(())
}
