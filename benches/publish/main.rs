//! Time, in poll intervals, until a change of a controller reaches the broker. The benchmark also checks that nothing
//! is lost while the broker is absent.
//!
//! One `armctl publish` polls simulators on the loopback interface once per second, all in this process. The broker in
//! this process acknowledges messages and records their times. The controllers switch HOLD on and off at independent
//! times. `cargo bench --bench publish` uses 300 controllers. `-- --quick` and `cargo test --benches` only check that
//! the benchmark works.

#![expect(clippy::print_stdout, reason = "a benchmark reports to whoever runs it")]

#[path = "../common/mod.rs"]
mod common;

use std::collections::HashMap;
use std::io::{Read as _, Write as _};
use std::net::{TcpListener, TcpStream};
use std::process::{Command, Stdio};
use std::sync::{Arc, Mutex, PoisonError, mpsc};
use std::time::{Duration, Instant};

use anyhow::ensure;
use armctl_controller::yerc as yerc_controller;
use armctl_transport::server::Server;
use armctl_yerc as yerc;
use tokio::task::LocalSet;
use tokio::time::interval_at;

use common::controllers::{ANY, serve_until_failure};
use common::table::{Goal, Row, Table};
use common::{run, runtime};

/// Number of controllers, number of changes of each, and downtime of the broker.
struct Effort {
    robots: usize,
    changes: u32,
    gone: Duration,
}

const FULL: Effort = Effort { robots: 300, changes: 10, gone: Duration::from_secs(60) };
const QUICK: Effort = Effort { robots: 4, changes: 3, gone: Duration::from_secs(3) };
/// Poll interval.
const INTERVAL: Duration = Duration::from_secs(1);
/// Interval of the changes of a controller. It is longer than a poll interval, so that each change is polled.
const CHANGE: Duration = Duration::from_millis(2700);

fn main() -> anyhow::Result<()> {
    let comparisons: [(&str, common::Compare<Effort>); 2] = [("lag", publication_delay), ("gone", outage)];
    run(&comparisons, &FULL, &QUICK)
}

/// Times of each change of HOLD, and of its message at the broker.
#[derive(Default)]
struct Measurements {
    changed_at: Moments,
    published_at: Moments,
}

/// Times by controller and state of HOLD.
type Moments = HashMap<(usize, bool), Vec<Instant>>;

type Shared = Arc<Mutex<Measurements>>;

fn note(book: &Shared, of: fn(&mut Measurements) -> &mut Moments, key: (usize, bool)) {
    let mut book = book.lock().unwrap_or_else(PoisonError::into_inner);
    of(&mut book).entry(key).or_default().push(Instant::now());
}

fn publication_delay(effort: &Effort) -> anyhow::Result<Table> {
    let lags = published(effort, None)?;
    let mut table = Table::new(format!("a change of one of {} controllers, until the broker has it", effort.robots));
    let at = |share: f64| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss,
            reason = "a place in a list"
        )]
        let at = (lags.len() as f64 * share) as usize;
        lags[at.min(lags.len() - 1)]
    };
    let shown = |lag: f64| format!("{lag:.2} intervals");
    table.row(Row::new("half of them", shown(at(0.5))));
    table.row(Row::new("99 of 100", shown(at(0.99))).goal(at(0.99), Goal::AtMost(1.2, "intervals")));
    Ok(table)
}

fn outage(effort: &Effort) -> anyhow::Result<Table> {
    let arrived = published(effort, Some(effort.gone))?.len();
    let made = effort.robots * usize::try_from(effort.changes)?;
    let mut table = Table::new(format!("a broker that is gone for {} s", effort.gone.as_secs()));
    #[expect(clippy::cast_precision_loss, reason = "a few thousand")]
    let lost = (made - arrived) as f64;
    table.row(Row::new("changes that never came", format!("{lost} of {made}")).goal(lost, Goal::AtMost(0.0, "")));
    Ok(table)
}

/// Returns the delays from each change to the broker, in poll intervals, in ascending order.
fn published(effort: &Effort, gone: Option<Duration>) -> anyhow::Result<Vec<f64>> {
    let book = Shared::default();
    let folder = tempfile::tempdir()?;
    let inventory = folder.path().join("robots.toml");
    let (go, wait) = tokio::sync::watch::channel(false);
    std::fs::write(&inventory, serve(effort, &book, &wait)?)?;
    let broker = FakeBroker::start(&book)?;
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    command.arg("--config").arg(&inventory).args(["publish", &broker.url, "--protocol", "3.1.1", "--kinds", "status"]);
    command.args(["--watch", "1s", "--node", "bench", "-q"]);
    command.env_clear().env("HOME", folder.path()).stdin(Stdio::null()).stdout(Stdio::null());
    let mut publisher = command.spawn()?;
    let robots = effort.robots;
    let is_complete = |book: &Measurements, at_least: u32| {
        let told: usize = book.published_at.values().map(Vec::len).sum();
        told >= robots + robots * usize::try_from(at_least).unwrap_or(usize::MAX)
    };
    // Wait until every controller is known, before the first controller changes.
    wait_until(&book, Duration::from_secs(60), |book| is_complete(book, 0))?;
    go.send(true)?;
    if let Some(gone) = gone {
        std::thread::sleep(CHANGE);
        broker.go_away(true);
        std::thread::sleep(gone);
        broker.go_away(false);
    }
    let most = CHANGE * (effort.changes + 1) + gone.unwrap_or_default() * 2 + Duration::from_secs(90);
    let ended = wait_until(&book, most, |book| is_complete(book, effort.changes));
    publisher.kill()?;
    publisher.wait()?;
    if gone.is_none() {
        ended?;
    }
    let book = book.lock().unwrap_or_else(PoisonError::into_inner);
    let mut lags: Vec<f64> = Vec::new();
    for (key, made) in &book.changed_at {
        let told = book.published_at.get(key).map(Vec::as_slice).unwrap_or_default();
        // The first state was published before any change.
        let told = &told[usize::from(!key.1).min(told.len())..];
        lags.extend(made.iter().zip(told).map(|(made, told)| (*told - *made).as_secs_f64() / INTERVAL.as_secs_f64()));
    }
    ensure!(!lags.is_empty(), "nothing came");
    lags.sort_by(f64::total_cmp);
    Ok(lags)
}

fn wait_until(book: &Shared, within: Duration, is_so: impl Fn(&Measurements) -> bool) -> anyhow::Result<()> {
    let deadline = Instant::now() + within;
    while !is_so(&book.lock().unwrap_or_else(PoisonError::into_inner)) {
        ensure!(Instant::now() < deadline, "it took too long");
        std::thread::sleep(Duration::from_millis(20));
    }
    Ok(())
}

/// Serves controllers until the process ends, and returns their inventory.
fn serve(effort: &Effort, book: &Shared, go: &tokio::sync::watch::Receiver<bool>) -> anyhow::Result<String> {
    let (tell, told) = mpsc::channel();
    let (robots, changes) = (effort.robots, effort.changes);
    let (book, go) = (Arc::clone(book), go.clone());
    std::thread::spawn(move || {
        let local = LocalSet::new();
        for number in 0..robots {
            let (tell, book, go) = (tell.clone(), Arc::clone(&book), go.clone());
            local.spawn_local(async move {
                serve_until_failure(controller(number, changes, tell, book, go)).await;
            });
        }
        drop(tell);
        runtime().map(|runtime| runtime.block_on(local))
    });
    let entries: Vec<String> = told.iter().take(robots).collect();
    ensure!(entries.len() == robots, "not every controller could be served");
    Ok(entries.concat())
}

async fn controller(
    number: usize,
    changes: u32,
    tell: mpsc::Sender<String>,
    book: Shared,
    mut go: tokio::sync::watch::Receiver<bool>,
) -> anyhow::Result<()> {
    let mut server = Server::bind([ANY, ANY], None).await?;
    let (port, files) = (server.local(0)?, server.local(1)?.port());
    tell.send(format!("[[robot]]\nname = \"r{number}\"\ntarget = \"udp://{port}?file_port={files}\"\n"))?;
    drop(tell);
    let start = yerc::simulator_start::start(None, None, yerc_controller::Model::Dx200, None)?;
    let mut controller = yerc::simulator_start::Simulated(yerc_controller::simulator::Simulator::new(start));
    while !*go.borrow_and_update() {
        tokio::select! {
            outcome = server.turn(&mut controller) => outcome?,
            begun = go.changed() => begun?,
        }
    }
    // The changes start at times that are independent of each other and of the polls.
    let phase = CHANGE.mul_f64(fastrand::f64());
    let mut ticks = interval_at(tokio::time::Instant::now() + phase, CHANGE);
    let mut left = changes;
    loop {
        tokio::select! {
            outcome = server.turn(&mut controller) => outcome?,
            _ = ticks.tick(), if left > 0 => {
                let is_held = (changes - left).is_multiple_of(2);
                let line = if is_held { "hold external on" } else { "hold external off" };
                controller.0.console(server.now(), line).map_err(anyhow::Error::msg)?;
                note(&book, |book| &mut book.changed_at, (number, is_held));
                left -= 1;
            }
        }
    }
}

/// A broker that acknowledges messages, and records the HOLD states in them.
struct FakeBroker {
    url: String,
    is_away: Arc<Mutex<bool>>,
    lines: Arc<Mutex<Vec<TcpStream>>>,
}

impl FakeBroker {
    fn start(book: &Shared) -> anyhow::Result<Self> {
        let listener = TcpListener::bind(ANY)?;
        let url = format!("mqtt://{}", listener.local_addr()?);
        let (is_away, lines) = (Arc::new(Mutex::new(false)), Arc::new(Mutex::new(Vec::new())));
        let broker = Self { url, is_away: Arc::clone(&is_away), lines: Arc::clone(&lines) };
        let book = Arc::clone(book);
        std::thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                if *is_away.lock().unwrap_or_else(PoisonError::into_inner) {
                    continue;
                }
                if let Ok(line) = stream.try_clone() {
                    lines.lock().unwrap_or_else(PoisonError::into_inner).push(line);
                }
                let book = Arc::clone(&book);
                std::thread::spawn(move || serve_client(stream, &book));
            }
        });
        Ok(broker)
    }

    fn go_away(&self, is_away: bool) {
        *self.is_away.lock().unwrap_or_else(PoisonError::into_inner) = is_away;
        if is_away {
            for line in self.lines.lock().unwrap_or_else(PoisonError::into_inner).drain(..) {
                // An error is ignored: the connection may be closed already.
                let _closed = line.shutdown(std::net::Shutdown::Both);
            }
        }
    }
}

/// Reads packets of one client until it disconnects. A message without an acknowledgement is sent again by the client,
/// and counts only once.
fn serve_client(mut stream: TcpStream, book: &Shared) -> Option<()> {
    loop {
        let mut head = [0; 1];
        stream.read_exact(&mut head).ok()?;
        let (mut len, mut shift) = (0_usize, 0);
        loop {
            let mut byte = [0; 1];
            stream.read_exact(&mut byte).ok()?;
            len |= usize::from(byte[0] & 0x7f) << shift;
            shift += 7;
            if byte[0] < 0x80 {
                break;
            }
        }
        let mut body = vec![0; len];
        stream.read_exact(&mut body).ok()?;
        match head[0] >> 4 {
            1 => stream.write_all(&[0x20, 2, 0, 0]).ok()?,
            3 => {
                let topic = usize::from(u16::from_be_bytes([body[0], body[1]]));
                let id = [body[2 + topic], body[3 + topic]];
                handle_packet(book, &body[2..2 + topic], &body[4 + topic..]);
                stream.write_all(&[0x40, 2, id[0], id[1]]).ok()?;
            }
            12 => stream.write_all(&[0xd0, 0]).ok()?,
            _ => {}
        }
    }
}

fn handle_packet(book: &Shared, topic: &[u8], payload: &[u8]) -> Option<()> {
    let number = std::str::from_utf8(topic).ok()?.strip_prefix("armctl/r")?.split_once('/')?.0.parse().ok()?;
    let envelope: serde_json::Value = serde_json::from_slice(payload).ok()?;
    let is_held = envelope["data"]["held"].as_bool()?;
    {
        // A message that repeats the state is not a change.
        let book = book.lock().unwrap_or_else(PoisonError::into_inner);
        let count = |key: bool| book.published_at.get(&(number, key)).map_or(0, Vec::len);
        let is_new = if is_held { count(true) < count(false) } else { count(false) <= count(true) };
        if !is_new {
            return None;
        }
    }
    note(book, |book| &mut book.published_at, (number, is_held));
    Some(())
}
