//! Comparison of PROFIBUS masters on pseudo-terminals, with a slave of minimal delay. The masters are ours, the one of
//! the crate `profirust`, and the one of PyPI's `pyprofibus`. The last one runs only if `ARMCTL_PROFIBUS_PEERS` is the
//! folder that `tests/profibus/install` created.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context as _, ensure};
use armctl_transport::profibus::driver::Connection;
use armctl_transport::profibus::port::{Port, Serial};
use armctl_transport::profibus::rates::Rate;
use armctl_transport::profibus::settings::Settings;
use armctl_transport::profibus::slave::{Setup, Slave};
use armctl_transport::sim::locked;
use armctl_transport::stream_server::StreamServer;
use profirust::phy::ProfibusPhy;
use profirust::{Baudrate, dp, fdl};
use tokio::sync::mpsc::unbounded_channel;

use super::Effort;
use super::common::table::{Goal, Row, Table};
use super::common::{median, ratio, runtime};
use super::virtual_time::{Echo, resting};

/// Maximum delay of an answer of the slave. It is the same for all masters.
const SLOT: Duration = Duration::from_millis(8);
/// The same delay in bits at 1.5 Mbit/s.
const SLOT_BITS: u16 = 12_000;
const SIZE: usize = 48;

pub fn compare(effort: &Effort) -> anyhow::Result<Table> {
    let python = std::env::var_os("ARMCTL_PROFIBUS_PEERS").map(|folder| Path::new(&folder).join("profibus/bin/python"));
    let (mut ours, mut rust, mut of_python) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..effort.rounds {
        ours.push(armctl(effort.time)?);
        rust.push(profirust(effort.time)?);
        if let Some(python) = &python {
            of_python.push(pyprofibus(python, effort.time)?);
        }
    }
    let mut table = Table::new("PROFIBUS DP, exchanges of 48 bytes each way a second, on a pseudo-terminal");
    let figure = |all: &[f64]| format!("{:.0} /s", median(all));
    table.row(Row::new("armctl, one cycle after the other", figure(&ours)));
    // A higher number is better, so the ratio is the inverse of a ratio of times.
    let comparison =
        |name, all: &[f64]| Row::new(name, figure(all)).compared_with_armctl(ratio(&ours, all), Goal::MoreThan(1.0));
    table.row(comparison("profirust 0.6", &rust));
    if python.is_some() {
        table.row(comparison("pyprofibus 1.13", &of_python));
    } else {
        table.row(Row::new("pyprofibus 1.13", "not installed".to_owned()));
    }
    Ok(table)
}

/// A slave that a thread shares with the measurement.
#[derive(Debug, Clone)]
struct Shared(Arc<Mutex<Slave<Echo>>>);

impl Shared {
    /// Measures the exchanges per second during this time, after the first exchanges.
    fn speed(&self, time: Duration, mut turn: impl FnMut()) -> anyhow::Result<f64> {
        const WARM_UP_EXCHANGES: u64 = 10;

        let mut counted = |until: &dyn Fn(u64) -> bool| {
            loop {
                turn();
                let exchanges = locked(&self.0).exchanges();
                if until(exchanges) {
                    return exchanges;
                }
            }
        };
        let timeout = Instant::now() + Duration::from_secs(30);
        let first = counted(&|exchanges| exchanges > WARM_UP_EXCHANGES || Instant::now() > timeout);
        ensure!(first > WARM_UP_EXCHANGES, "no exchange came about");
        let start = Instant::now();
        let last = counted(&|_| start.elapsed() >= time);
        Ok(f64::from(u32::try_from(last - first)?) / start.elapsed().as_secs_f64())
    }
}

fn rate() -> anyhow::Result<Rate> {
    Rate::from_name("1.5M").context("a speed")
}

/// Runs a slave on a pseudo-terminal while the function `master` uses it.
fn with_slave(master: impl FnOnce(&Shared, &str) -> anyhow::Result<f64>) -> anyhow::Result<f64> {
    let shared = Shared(Arc::new(Mutex::new(Slave::new(Setup::sample_controller(rate()?), Echo::default()))));
    let runtime = runtime()?;
    let (mut server, port) = {
        let _guard = runtime.enter();
        StreamServer::pseudo_terminal(None, None)?
    };
    let (faults, changed) = unbounded_channel();
    let mut peer = Arc::clone(&shared.0);
    let thread = thread::spawn(move || {
        runtime.block_on(server.run(&mut peer, changed));
        runtime.shutdown_background();
    });
    let figure = master(&shared, &port);
    drop(faults);
    thread.join().expect("the slave does not panic");
    figure
}

fn armctl(time: Duration) -> anyhow::Result<f64> {
    with_slave(|shared, port| {
        let (port, rate) = (PathBuf::from(port), rate()?);
        let settings = Settings { cycle: Some(Duration::ZERO), slot: Some(SLOT), ..Settings::new(5, rate, resting()) };
        let path = port.to_str().context("its path is UTF-8")?.to_owned();
        let opener = Box::new(move || Ok(Box::new(Serial::open(&path, rate)?) as Box<dyn Port>));
        let runtime = runtime()?;
        let connection = runtime.block_on(Connection::open(settings, opener, None))?;
        let speed = shared.speed(time, || thread::sleep(Duration::from_millis(1)));
        runtime.block_on(connection.close())?;
        speed
    })
}

fn pyprofibus(python: &Path, time: Duration) -> anyhow::Result<f64> {
    with_slave(|shared, port| {
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/profibus/master.py");
        let mut command = Command::new(python);
        command.arg(script).arg(port).arg("1000000000").stdout(Stdio::null()).stderr(Stdio::null());
        let mut master = command.spawn()?;
        let speed = shared.speed(time, || thread::sleep(Duration::from_millis(1)));
        master.kill()?;
        master.wait()?;
        speed
    })
}

/// Adapter from our port to the interface of `profirust`.
struct Phy {
    port: Serial,
    received: Vec<u8>,
    start: Instant,
    sent_until: Duration,
    rate: Rate,
}

impl ProfibusPhy for Phy {
    fn poll_transmission(&mut self, _now: profirust::time::Instant) -> bool {
        self.start.elapsed() < self.sent_until
    }

    fn transmit_data<F, R>(&mut self, _now: profirust::time::Instant, f: F) -> R
    where
        F: FnOnce(&mut [u8]) -> (usize, R),
    {
        let mut buffer = [0; 512];
        let (len, result) = f(&mut buffer);
        if len > 0 {
            self.port.send(&buffer[..len]).expect("the terminal is there");
            self.sent_until = self.start.elapsed() + self.rate.pace().time(len);
        }
        result
    }

    fn receive_data<F, R>(&mut self, _now: profirust::time::Instant, f: F) -> R
    where
        F: FnOnce(&[u8]) -> (usize, R),
    {
        let mut buffer = [0; 512];
        let len = self.port.receive(&mut buffer, Duration::from_micros(50)).expect("the terminal is there");
        self.received.extend(&buffer[..len]);
        let (dropped, result) = f(&self.received);
        self.received.drain(..dropped);
        result
    }
}

fn profirust(time: Duration) -> anyhow::Result<f64> {
    with_slave(|shared, port| {
        let rate = rate()?;
        let (mut inputs, mut outputs) = ([0; SIZE], [0; SIZE]);
        outputs[32] = 0x41;
        let mut master = dp::DpMaster::new(vec![]);
        let options = dp::PeripheralOptions {
            ident_number: 0x1234,
            user_parameters: Some(&[0, 0, 0]),
            config: Some(&[0xC0, 0xD7, 0xD7]),
            max_tsdr: 150,
            ..Default::default()
        };
        master.add(dp::Peripheral::new(5, options, &mut inputs[..], &mut outputs[..]));
        let parameters = fdl::ParametersBuilder::new(2, Baudrate::B1500000)
            .slot_bits(SLOT_BITS)
            .max_retry_limit(3)
            .watchdog_timeout(profirust::time::Duration::from_millis(1000))
            .build_verified(&master);
        let mut station = fdl::FdlActiveStation::new(parameters);
        let start = Instant::now();
        let port = Serial::open(port, rate)?;
        let mut phy = Phy { port, received: Vec::new(), start, sent_until: Duration::ZERO, rate };
        station.set_online();
        master.enter_operate();
        shared.speed(time, || {
            let micros = i64::try_from(start.elapsed().as_micros()).unwrap_or(i64::MAX);
            station.poll(profirust::time::Instant::from_micros(micros), &mut phy, &mut master);
            master.take_last_events();
        })
    })
}
