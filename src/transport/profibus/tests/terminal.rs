//! Tests on a pseudo-terminal. It has no bit rate and no parity.

use std::io::{Read as _, Write as _};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use serialport::{SerialPort as _, TTYPort};

use super::super::driver::Connection;
use super::super::error::ProfibusError;
use super::super::master::State;
use super::super::port::{Port, Serial};
use super::super::rates::Rate;
use super::super::settings::Settings;
use super::super::slave::{Setup, Slave};
use super::{Echo, MS, image, resting};
use crate::sim::Peer as _;

/// A slave that runs on a thread behind a pseudo-terminal, and the path of the other end.
struct Served {
    slave: Arc<Mutex<Slave<Echo>>>,
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    path: String,
}

impl Served {
    fn new(rate: Rate) -> Self {
        let (mut near, far) = TTYPort::pair().unwrap();
        let path = far.name().unwrap();
        // An open port is locked, so the other end must be closed here.
        drop(far);
        near.set_timeout(MS).unwrap();
        let slave = Arc::new(Mutex::new(Slave::new(Setup::sample_controller(rate), Echo::default())));
        let is_over = Arc::new(AtomicBool::new(false));
        let (on_thread, over) = (Arc::clone(&slave), Arc::clone(&is_over));
        let thread = std::thread::spawn(move || {
            let start = Instant::now();
            let mut buffer = [0; 256];
            while !over.load(Ordering::SeqCst) {
                // Reads fail while the other end is closed.
                let len = near.read(&mut buffer).unwrap_or(0);
                if len == 0 {
                    std::thread::yield_now();
                }
                let mut slave = on_thread.lock().unwrap();
                if len > 0 {
                    slave.receive(start.elapsed(), 0, &buffer[..len]);
                }
                // The time is 1 ms ahead, so that the delay of the answer has already passed.
                while let Some((_, bytes)) = slave.transmit(start.elapsed() + MS) {
                    let _ = near.write_all(&bytes);
                }
            }
        });
        Self { slave, is_over, thread: Some(thread), path }
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// The time limits are long, because other tests can keep the computer busy.
fn settings() -> Settings {
    let rate = Rate::from_name("500k").unwrap();
    let slot = Some(Duration::from_millis(500));
    Settings { slot, watchdog: Some(Duration::from_secs(60)), ..Settings::new(5, rate, resting()) }
}

fn opener(path: &str) -> super::super::driver::Opener {
    let path = path.to_owned();
    let rate = Rate::from_name("500k").unwrap();
    Box::new(move || Ok(Box::new(Serial::open(&path, rate)?) as Box<dyn Port>))
}

#[tokio::test]
async fn exchanges_images_over_a_terminal_and_frees_the_slave() {
    let served = Served::new(settings().rate);
    let seen = Arc::new(Mutex::new(Vec::new()));
    let tapped = Arc::clone(&seen);
    let tap = Box::new(move |bytes: &[u8]| tapped.lock().unwrap().push(bytes.to_vec()));
    let mut connection = Connection::open(settings(), opener(&served.path), Some(tap)).await.unwrap();
    let generation = connection.view().generation;
    connection.set_image(generation, &image(3)).unwrap();
    while connection.view().input.is_none_or(|input| input.image[0] != 3) {
        connection.views.changed().await;
    }
    connection.close().await.unwrap();
    let slave = served.slave.lock().unwrap();
    assert_eq!(slave.owner, None);
    assert_eq!(slave.peer.history, [Some(resting()), Some(image(3)), None]);
    // The tap recorded whole telegrams in both directions.
    let seen = seen.lock().unwrap();
    assert_eq!(seen[..2], [super::hex("10 05 02 49 50 16"), super::hex("10 02 05 00 07 16")]);
}

#[tokio::test]
async fn dropped_connection_frees_the_slave() {
    let served = Served::new(settings().rate);
    let connection = Connection::open(settings(), opener(&served.path), None).await.unwrap();
    assert_eq!(served.slave.lock().unwrap().owner, Some(2));
    drop(connection);
    assert_eq!(served.slave.lock().unwrap().owner, None);
}

#[tokio::test]
async fn reopens_an_adapter_that_was_unplugged() {
    let first = Served::new(settings().rate);
    let second = Served::new(settings().rate);
    // After a reconnect of an adapter, the same name leads to another terminal.
    let (there, back) = (first.path.clone(), second.path.clone());
    let mut count = 0;
    let rate = settings().rate;
    let opener = Box::new(move || {
        count += 1;
        let path = if count == 1 { &there } else { &back };
        Ok(Box::new(Serial::open(path, rate)?) as Box<dyn Port>)
    });
    let mut connection = Connection::open(settings(), opener, None).await.unwrap();
    drop(first);
    while connection.view().state != State::Lost {
        connection.views.changed().await;
    }
    assert!(matches!(connection.view().last_error, Some(ProfibusError::Gone(_))), "{:?}", connection.view().last_error);
    while connection.view().state != State::Open {
        connection.views.changed().await;
    }
    assert_eq!(connection.view().generation, 2);
    connection.close().await.unwrap();
}

#[tokio::test]
async fn missing_port_is_an_error() {
    let error = Connection::open(settings(), opener("/dev/there-is-no-such-port"), None).await.unwrap_err();
    assert_eq!(error.to_string(), "/dev/there-is-no-such-port: no such port");
    let error = Connection::open(settings(), opener("/dev/null"), None).await.unwrap_err();
    assert_eq!(error.to_string(), "/dev/null: this is not a serial port");
}
