//! Simulated controller as a PROFIBUS slave behind a pseudo-terminal.

use std::io;
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::Duration;

use tokio::runtime::Builder;
use tokio::sync::mpsc::{UnboundedSender, unbounded_channel};

use super::bus::BUS;
use crate::simulated::{Simulated, faults_of_url, start};
use armctl_controller::yrcx::simulator::{Simulator, Start};
use armctl_frame::failure::{Failure, plain};
use armctl_frame::settings::target::Sim;
use armctl_frame::settings::target::profibus::SCHEME;
use armctl_transport::fault::{FaultNames, LineFaultSpec, SimulatorFaults};
use armctl_transport::profibus::rates::{RATES, Rate};
use armctl_transport::profibus::slave::{Setup, Slave, SlaveFault};
use armctl_transport::sim::locked;
use armctl_transport::stream_server::StreamServer;

/// Options of a slave.
#[derive(Debug, Clone)]
pub struct Options {
    /// Address.
    pub station: u8,
    /// Ident number.
    pub ident: u16,
    /// Bit rate.
    pub rate: Rate,
    /// Faults of characters and of the slave.
    pub faults: Faults,
}

impl Default for Options {
    fn default() -> Self {
        let rate = Rate::from_name("500k").unwrap_or(RATES[0]);
        let Setup { station, ident, .. } = Setup::sample_controller(rate);
        Self { station, ident, rate, faults: Faults::default() }
    }
}

/// Starts a simulator with the faults of the URL.
pub fn in_process(sim: &Sim) -> Result<Server, Failure> {
    let faults = faults_of_url(sim, &FAULTS)?;
    serve(start(sim)?, Options { faults, ..Options::default() })
}

/// Faults of characters and of the slave.
type Faults = SimulatorFaults<LineFaultSpec, SlaveFault>;

/// Faults by name.
pub const FAULTS: FaultNames<SlaveFault> =
    FaultNames { link: &["noise", "parity", "drop", "dup", "delay", "echo", "seed"], device: &SlaveFault::ALL };

/// A running simulated slave. It stops when this value is dropped.
#[derive(Debug)]
pub struct Server {
    slave: Arc<Mutex<Slave<Simulated>>>,
    port: String,
    options: Options,
    clock: tokio::time::Instant,
    /// Sends new faults of characters to the server thread. The thread ends when this sender is dropped.
    faults: Option<UnboundedSender<Option<LineFaultSpec>>>,
    thread: Option<JoinHandle<()>>,
}

/// Serves a controller as a slave behind a pseudo-terminal.
pub fn serve(start: Start, options: Options) -> Result<Server, Failure> {
    let failed = |error: io::Error| Failure::local(format!("cannot create a pseudo-terminal: {}", plain(&error)));
    let setup = Setup { station: options.station, ident: options.ident, ..Setup::sample_controller(options.rate) };
    let mut slave = Slave::new(setup, Simulated(Simulator::new(start).with_link_alarm(BUS.link_alarm)));
    slave.set_fault(options.faults.device);
    let slave = Arc::new(Mutex::new(slave));
    let runtime = Builder::new_current_thread().enable_all().build().map_err(failed)?;
    let (mut server, port) = {
        let _guard = runtime.enter();
        StreamServer::pseudo_terminal(Some(options.rate.pace()), options.faults.link.clone()).map_err(failed)?
    };
    let (faults, changed) = unbounded_channel();
    let mut peer = Arc::clone(&slave);
    let clock = tokio::time::Instant::now();
    let serve = move || {
        runtime.block_on(server.run(&mut peer, changed));
        // A read of the terminal may still block, so do not wait for it.
        runtime.shutdown_background();
    };
    let thread = std::thread::Builder::new().name("profibus-slave".to_owned()).spawn(serve).map_err(failed)?;
    Ok(Server { slave, port, options, clock, faults: Some(faults), thread: Some(thread) })
}

impl Server {
    /// Path of the port.
    pub fn port(&self) -> &str {
        &self.port
    }

    /// Returns the URL of the slave; `name` is another name of its port. The time limits are longer than on a real
    /// line: master and slave share a processor, and a pseudo-terminal does not keep the timing of characters.
    pub fn url(&self, name: Option<&str>) -> String {
        let (scheme, port) = (SCHEME.name, name.unwrap_or(&self.port));
        let (station, baud) = (self.options.station, self.options.rate.name);
        let slot = SLOT.max(self.options.rate.bits(self.options.rate.slot)).as_millis();
        format!("{scheme}://{port}?station={station}&baud={baud}&slot={slot}ms")
    }

    /// Sets the faults of characters and of the slave.
    pub fn set_faults(&self, faults: Faults) {
        if let Some(changed) = &self.faults {
            // If the thread has ended, no line can have faults.
            let _ = changed.send(faults.link);
        }
        self.with(|slave, _| slave.set_fault(faults.device));
    }

    /// Calls `act` with the slave.
    pub fn with<T>(&self, act: impl FnOnce(&mut Slave<Simulated>, Duration) -> T) -> T {
        act(&mut locked(&self.slave), self.clock.elapsed())
    }
}

/// Minimum slot time. It is long enough for a busy computer.
const SLOT: Duration = Duration::from_millis(60);

impl Drop for Server {
    fn drop(&mut self) {
        drop(self.faults.take());
        if let Some(thread) = self.thread.take() {
            // If the thread panicked, the panic message was already printed.
            let _ = thread.join();
        }
    }
}
