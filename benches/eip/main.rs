//! Timing of images compared with a bare timer loop, duration of a remote command, and number of connections of one
//! process. Each line shows the goal next to the measured value.
//!
//! `cargo bench --bench eip` measures everything, with `-- spread trips commands many` only the named parts. `--
//! --quick` and `cargo test --benches` only check that the benchmark works.

#![expect(clippy::print_stdout, reason = "a benchmark reports to whoever runs it")]

use std::net::{Ipv4Addr, SocketAddrV4, UdpSocket};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context as _, ensure};
use armctl_controller::yrcx;
use armctl_controller::yrcx::simulator::Start;
use armctl_frame::output::{ColorChoice, Format, Screen};
use armctl_frame::settings::target::Family as Name;
use armctl_frame::settings::{Selection, Sources};
use armctl_frame::{Access, ConnectMode, Family as _};
use armctl_transport::eip::adapter::server::{AdapterAddresses, Server};
use armctl_transport::eip::adapter::{Application, Assembly, Event, Purpose, Setup};
use armctl_transport::eip::originator::State;
use armctl_transport::eip::scanner::{Connection, Scanner};
use armctl_transport::eip::settings::Settings;
use armctl_transport::eip::tap::Tap;
use armctl_transport::eip::wire::{Cyclic, Identity, Revision};
use armctl_transport::eip::{IO_PORT, Now, PORT};
use armctl_transport::fault::SimulatorFaults;
use armctl_yrcx::eip::simulated;
use armctl_yrcx::link::Yrcx;
use tokio::runtime::{Builder, Runtime};

const RPI: Duration = Duration::from_millis(10);
const SIZE: u16 = 48;
const MANY_CONNECTIONS: u32 = 50;
/// Scan time of a controller.
const SCAN_MS: f64 = 5.0;
/// Maximum spread of the images, relative to the spread of a bare loop.
const GOAL: f64 = 1.2;

/// Amount of work.
struct Effort {
    /// Duration of each round of the measurement `spread`.
    time: Duration,
    rounds: u32,
    many: Duration,
    trips: u32,
}

const FULL: Effort = Effort { time: Duration::from_secs(5), rounds: 11, many: Duration::from_secs(30), trips: 200 };
const QUICK: Effort =
    Effort { time: Duration::from_millis(300), rounds: 1, many: Duration::from_millis(500), trips: 3 };

/// Function that measures and prints.
type Measure = fn(&Effort) -> anyhow::Result<()>;

/// Measurements, by their argument.
const MEASUREMENTS: [(&str, Measure); 4] =
    [("spread", spread), ("trips", trips), ("commands", commands), ("many", many_connections)];

fn main() -> anyhow::Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    // `cargo bench` passes this argument, `cargo test` does not.
    let is_quick = args.iter().any(|arg| arg == "--quick") || !args.iter().any(|arg| arg == "--bench");
    let effort = if is_quick { QUICK } else { FULL };
    let chosen: Vec<&String> = args.iter().filter(|arg| !arg.starts_with('-')).collect();
    for (name, measure) in MEASUREMENTS {
        if chosen.is_empty() || chosen.iter().any(|chosen| *chosen == name) {
            measure(&effort).context(name)?;
        }
    }
    if is_quick || cfg!(debug_assertions) {
        println!("A short or unoptimized run: it shows that all of it works, the figures mean nothing.");
    }
    Ok(())
}

/// Measures how much the intervals between images differ from 10 ms. Two bare loops run at the same time for
/// comparison.
fn spread(effort: &Effort) -> anyhow::Result<()> {
    println!("{:<62}{:>9} {:>9} {:>9}", "deviation from the RPI of 10 ms, median of the rounds", "p50", "p99", "max");
    let mut ratios = Vec::new();
    let mut contenders = [
        "armctl",
        "bare loop: thread::sleep to a deadline, then send",
        "bare loop: tokio::time::sleep_until, then send",
    ]
    .map(|name| (name, Vec::new()));
    for _ in 0..effort.rounds {
        let runtime = runtime()?;
        let server = Server::start(setup(1), Mirror::default(), AdapterAddresses::anywhere(Ipv4Addr::LOCALHOST), None)?;
        let sent = Arc::new(Mutex::new(Vec::new()));
        let images = SocketAddrV4::new(Ipv4Addr::LOCALHOST, server.io_port);
        let tap = {
            let sent = Arc::clone(&sent);
            Tap::new(move |passed| {
                if passed.to == images {
                    sent.lock().expect("nobody panics with it").push(Instant::now());
                }
            })
        };
        let scanner = Scanner::start(Ipv4Addr::LOCALHOST)?;
        let connection = runtime.block_on(scanner.open(server.address(), settings(), tap))?;
        let time = effort.time;
        let bare = thread::spawn(move || bare_loop(images, time));
        let tokio = thread::spawn(move || runtime_loop(images, time));
        let bare = bare.join().expect("the loop does not panic")?;
        let tokio = tokio.join().expect("the loop does not panic")?;
        runtime.block_on(connection.close())?;
        let ours = Deviation::of(&sent.lock().expect("nobody panics with it"));
        let bare = Deviation::of(&bare);
        ratios.push(ours.p99 / bare.p99);
        for ((_, rounds), round) in contenders.iter_mut().zip([ours, bare, Deviation::of(&tokio)]) {
            rounds.push(round);
        }
    }
    for (name, rounds) in &contenders {
        Deviation::median(rounds).print(name);
    }
    let ratio = median(&mut ratios);
    let verdict = verdict(ratio <= GOAL);
    println!(
        "  p99 of armctl / p99 of the bare thread::sleep loop: {ratio:.2}, median of rounds; goal <= {GOAL} {verdict}"
    );
    Ok(())
}

/// Measures the time until the device answers a new image.
fn trips(effort: &Effort) -> anyhow::Result<()> {
    println!("from a new image until what the device makes of it is back: median");
    for rpi in [5, 10, 20].map(Duration::from_millis) {
        let runtime = runtime()?;
        let server = Server::start(setup(1), Mirror::default(), AdapterAddresses::anywhere(Ipv4Addr::LOCALHOST), None)?;
        let scanner = Scanner::start(Ipv4Addr::LOCALHOST)?;
        let mut connection =
            runtime.block_on(scanner.open(server.address(), Settings { rpi, ..settings() }, Tap::default()))?;
        let mut times = Vec::new();
        for trip in 1..=effort.trips {
            let mark = u8::try_from(trip % 251)?;
            let start = Instant::now();
            connection.set_image(1, &[mark; SIZE as usize])?;
            let is_back = |image: &[u8]| image.first() == Some(&mark);
            runtime.block_on(
                connection.views.until(|view| view.input.as_ref().is_some_and(|input| is_back(&input.image))),
            );
            times.push(start.elapsed().as_secs_f64() * 1000.0);
            // The next round starts at another time within the interval.
            thread::sleep(Duration::from_micros(fastrand::u64(..u64::try_from(rpi.as_micros())?)));
        }
        runtime.block_on(connection.close())?;
        println!("  RPI {:>2} ms: {:>6.2} ms", rpi.as_millis(), median(&mut times));
    }
    Ok(())
}

/// Measures the duration of a remote read command on a simulated controller with its scans. The time starts with the
/// call and ends with the report. The controller may become ready for the next command only after this.
fn commands(effort: &Effort) -> anyhow::Result<()> {
    println!("servo status, from giving it to the report: median");
    for rpi in [5, 10, 20].map(Duration::from_millis) {
        let runtime = runtime()?;
        let server = simulated::serve(
            Start::default(),
            AdapterAddresses::anywhere(Ipv4Addr::LOCALHOST),
            SimulatorFaults::default(),
        )?;
        let target = format!("eip://{}?rpi={}ms", server.address(), rpi.as_millis()).parse()?;
        let sources =
            Sources { selection: Selection { target: Some(target), ..Selection::default() }, ..Sources::default() };
        let robot = sources.robots(Some(Name::Yrcx))?.remove(0);
        let screen = Screen::new(Format::Table, ColorChoice::Never, true, 0);
        let access = Access::reading(ConnectMode::Control);
        let order = yrcx::table::Command::ServoStatus.order().build()?;
        let mut times = Vec::new();
        let mut answers = Vec::new();
        runtime.block_on(async {
            let mut link = Yrcx::connect(&robot, access, &screen).await?;
            for _ in 0..effort.trips {
                let start = Instant::now();
                answers.push(link.ask(&order).await?.elapsed.as_secs_f64() * 1000.0);
                times.push(start.elapsed().as_secs_f64() * 1000.0);
                // The next round starts at another time within the interval.
                tokio::time::sleep(Duration::from_micros(fastrand::u64(..u64::try_from(rpi.as_micros())?))).await;
            }
            Yrcx::close(link, &screen).await?;
            anyhow::Ok(())
        })?;
        let goal = rpi.as_secs_f64() * 2000.0 + SCAN_MS + 1.0;
        let (seen, answer) = (median(&mut times), median(&mut answers));
        println!(
            "  RPI {:>2} ms: {seen:>6.2} ms; goal <= {goal} ms {}; {answer:.2} ms from the wire to the answer",
            rpi.as_millis(),
            verdict(seen <= goal)
        );
    }
    Ok(())
}

/// Opens fifty connections at 10 ms, with watchdogs at both ends: with our adapter, and with another adapter.
fn many_connections(effort: &Effort) -> anyhow::Result<()> {
    println!(
        "{MANY_CONNECTIONS} connections at 10 ms, watchdogs of 160 ms at both ends, {} s",
        effort.many.as_secs_f64()
    );
    let server = Server::start(
        setup(MANY_CONNECTIONS),
        Mirror::default(),
        AdapterAddresses::anywhere(Ipv4Addr::LOCALHOST),
        None,
    )?;
    hold_connections("our adapter", server.address(), effort)?;
    let ended = server.with(|adapter, _| adapter.application.timed_out);
    println!("  our adapter: {ended} connections timed out there; goal 0 {}", verdict(ended == 0));
    ensure!(ended == 0, "the adapter missed images");

    let target_image = Ipv4Addr::new(127, 44, 18, 50);
    if UdpSocket::bind((target_image, IO_PORT)).is_err() {
        println!("  ciplink: left out, port {IO_PORT} of {target_image} cannot be had");
        return Ok(());
    }
    let outputs = (0..MANY_CONNECTIONS).map(|index| ciplink::adapter::Assembly::output(output(index), SIZE.into()));
    let inputs = [ciplink::adapter::Assembly::input(100, SIZE.into()), ciplink::adapter::Assembly::config(1, 0)];
    let config = ciplink::adapter::AdapterConfig {
        assemblies: outputs.chain(inputs).collect(),
        bind: target_image,
        port: 0,
        ..ciplink::adapter::AdapterConfig::default()
    };
    let adapter = ciplink::adapter::Adapter::start(config)?;
    let std::net::SocketAddr::V4(address) = adapter.addr() else { anyhow::bail!("it has an IPv4 address") };
    hold_connections("ciplink", address, effort)?;
    let mut ended = 0;
    while let Some(event) = adapter.next_event(Some(Duration::ZERO)) {
        ended += u32::from(matches!(event, ciplink::adapter::Event::TimedOut(_)));
    }
    println!("  ciplink: {ended} connections timed out there; goal 0 {}", verdict(ended == 0));
    ensure!(ended == 0, "the adapter missed images");
    Ok(())
}

/// Keeps fifty connections open for this time.
fn hold_connections(name: &str, target: SocketAddrV4, effort: &Effort) -> anyhow::Result<()> {
    let runtime = runtime()?;
    let scanner = Scanner::start(Ipv4Addr::LOCALHOST)?;
    let mut connections: Vec<Connection> = Vec::new();
    for index in 0..MANY_CONNECTIONS {
        let settings = Settings { output: output(index), ..settings() };
        connections.push(runtime.block_on(scanner.open(target, settings, Tap::default()))?);
    }
    thread::sleep(effort.many);
    let (mut sent, mut received, mut lost, mut skipped) = (0, 0, 0, 0);
    for connection in &connections {
        let view = connection.views.now();
        ensure!(view.state == State::Open && view.generation == 1, "{:?} {:?}", view.state, view.last_error);
        let statistics = view.statistics;
        sent += statistics.sent;
        received += statistics.received;
        lost += statistics.lost;
        skipped += statistics.skipped;
    }
    println!("  {name}: {sent} images sent, {received} received, {lost} lost, {skipped} intervals skipped");
    for connection in connections {
        runtime.block_on(connection.close())?;
    }
    Ok(())
}

/// Minimal loop that sends an image every 10 ms.
fn bare_loop(to: SocketAddrV4, time: Duration) -> anyhow::Result<Vec<Instant>> {
    let (socket, image) = bare_image(to)?;
    let start = Instant::now();
    let mut due = start;
    let mut sent = Vec::new();
    while start.elapsed() < time {
        due += RPI;
        thread::sleep(due.saturating_duration_since(Instant::now()));
        sent.push(Instant::now());
        socket.send(&image)?;
    }
    Ok(sent)
}

/// The same loop, with tokio's timer.
fn runtime_loop(to: SocketAddrV4, time: Duration) -> anyhow::Result<Vec<Instant>> {
    let (socket, image) = bare_image(to)?;
    runtime()?.block_on(async {
        let start = Instant::now();
        let mut due = tokio::time::Instant::now();
        let mut sent = Vec::new();
        while start.elapsed() < time {
            due += RPI;
            tokio::time::sleep_until(due).await;
            sent.push(Instant::now());
            socket.send(&image)?;
        }
        Ok(sent)
    })
}

/// Returns a socket to the adapter, and an image that belongs to no connection of the adapter.
fn bare_image(to: SocketAddrV4) -> anyhow::Result<(UdpSocket, Vec<u8>)> {
    let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0))?;
    socket.connect(to)?;
    Ok((socket, Cyclic { id: 0, sequence: 1, count: 1, body: &[0; SIZE as usize] }.emit(Some(1))))
}

/// Deviation of intervals from 10 ms, in microseconds.
struct Deviation {
    p50: f64,
    p99: f64,
    max: f64,
}

impl Deviation {
    fn of(times: &[Instant]) -> Self {
        let mut all: Vec<f64> =
            times.windows(2).map(|pair| ((pair[1] - pair[0]).as_secs_f64() - RPI.as_secs_f64()).abs() * 1e6).collect();
        all.sort_by(f64::total_cmp);
        let at = |percent: usize| all.get(all.len().saturating_sub(1) * percent / 100).copied().unwrap_or(f64::NAN);
        Self { p50: at(50), p99: at(99), max: at(100) }
    }

    /// The median of each figure over the rounds.
    fn median(rounds: &[Self]) -> Self {
        let of = |figure: fn(&Self) -> f64| median(&mut rounds.iter().map(figure).collect::<Vec<_>>());
        Self { p50: of(|round| round.p50), p99: of(|round| round.p99), max: of(|round| round.max) }
    }

    fn print(&self, name: &str) {
        let Self { p50, p99, max } = self;
        println!("  {name:<60}{p50:>9.0} {p99:>9.0} {max:>9.0} us");
    }
}

const fn verdict(is_met: bool) -> &'static str {
    if is_met { "met" } else { "MISSED" }
}

fn median(all: &mut [f64]) -> f64 {
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Application that returns the last image.
#[derive(Debug, Default)]
struct Mirror {
    image: Vec<u8>,
    timed_out: u32,
}

impl Application for Mirror {
    fn image_out(&mut self, _: Now, _: u32, image: &[u8], _: bool) {
        self.image.clear();
        self.image.extend(image);
    }

    fn image_in(&mut self, _: Now, _: u32, image: &mut [u8]) {
        for (byte, last) in image.iter_mut().zip(&self.image) {
            *byte = *last;
        }
    }

    fn event(&mut self, _: Now, event: &Event) {
        self.timed_out += u32::from(matches!(event, Event::TimedOut(_)));
    }
}

/// Returns the configuration of an adapter with one output assembly for each of several owners.
fn setup(owners: u32) -> Setup {
    let identity = Identity {
        address: SocketAddrV4::new(Ipv4Addr::LOCALHOST, PORT),
        vendor: 636,
        device_type: 43,
        product: 5,
        revision: Revision { major: 1, minor: 1 },
        status: 0,
        serial: 1,
        name: "RCX".to_owned(),
        state: Some(3),
    };
    let outputs = (1..owners).map(|index| Assembly { instance: output(index), purpose: Purpose::Output, size: SIZE });
    let mut setup = Setup::new(identity, (100, SIZE), (output(0), SIZE), 1);
    setup.assemblies.extend(outputs);
    setup.most_connections = 64;
    setup.most_sessions = 64;
    setup
}

const fn output(index: u32) -> u32 {
    150 + index
}

/// Settings with watchdogs of 16 intervals, as in real plants.
fn settings() -> Settings {
    Settings {
        output: output(0),
        output_size: SIZE,
        input_size: SIZE,
        rpi: RPI,
        resting: vec![0; SIZE.into()],
        ..Settings::default()
    }
}

fn runtime() -> anyhow::Result<Runtime> {
    Ok(Builder::new_current_thread().enable_all().build()?)
}
