//! Simulated controller as a DeviceNet slave.

use std::io;
use std::net::{Ipv4Addr, SocketAddr};

use super::bus::BUS;
use crate::prelude::basics::*;
use crate::simulated::{Simulated, faults_of_url, start};
use armctl_controller::yrcx::simulator::{Simulator, Start};
use armctl_frame::settings::target::Sim;
use armctl_frame::settings::target::devicenet::SLCAN;
use armctl_transport::devicenet::can::Bitrate;
use armctl_transport::devicenet::device::{Application, Device, DeviceFault, Setup};
use armctl_transport::devicenet::hub::{Hub, Listen};
use armctl_transport::devicenet::wire::Mac;
use armctl_transport::fault::{self, FaultNames, FaultSpec, SimulatorFaults};
use armctl_transport::image::ImagePeer;

/// Name of the simulator with the four-byte image, for `bus=` and `--bus`.
const COMPACT: &str = "devicenet-compact";
/// Default MAC ID of a simulated controller.
pub(super) const MAC: u8 = 5;

/// Starts a simulator behind an SLCAN adapter on the loopback interface, with the faults of the URL.
pub fn on_loopback(sim: &Sim) -> Result<Hub<Controller>> {
    let faults = faults_of_url(sim, &FAULTS)?;
    let setup = Setup::sample_controller(Mac::new(MAC).unwrap_or_default(), Bitrate::K500, size(sim.bus));
    let listen = Listen::Tcp(SocketAddr::from((Ipv4Addr::LOCALHOST, 0)));
    let served = serve(start(sim)?, setup, &[listen], faults);
    Ok(served.context("the simulator on the loopback")?)
}

/// Returns the URL of a simulated controller behind the adapter at `place`.
pub fn target(place: &str) -> String {
    format!("{}://{place}?mac={MAC}", SLCAN.name)
}

/// Returns the image size, in bytes, of the simulator with this name: the whole image, or only its signals.
pub fn size(simulator: Option<&str>) -> u16 {
    if simulator == Some(COMPACT) { 4 } else { 48 }
}

/// Serves a controller as a slave.
pub fn serve(start: Start, setup: Setup, listen: &[Listen], faults: Faults) -> io::Result<Hub<Controller>> {
    let bitrate = setup.bitrate;
    let device = Device::on_line(setup, Controller(Simulated(Simulator::new(start).with_link_alarm(BUS.link_alarm))));
    let hub = Hub::start(bitrate, Some(device), listen, None)?;
    set_faults(&hub, faults);
    Ok(hub)
}

/// Faults of frames and of the slave.
type Faults = SimulatorFaults<FaultSpec, DeviceFault>;

/// Names of the simulated faults. There is no fault that corrupts frames: frames have a checksum, so a corrupted frame
/// would be lost.
pub const FAULTS: FaultNames<DeviceFault> =
    FaultNames { link: &["drop", "dup", "delay", "reorder", "seed"], device: &DeviceFault::ALL };

/// Sets the faults of frames and of the slave.
pub fn set_faults(hub: &Hub<Controller>, faults: Faults) {
    hub.set_faults(faults.link.map(fault::Faults::pair));
    hub.with(|device, _| device.set_fault(faults.device));
}

/// A simulated controller behind its node.
#[derive(Debug)]
pub struct Controller(pub Simulated);

impl Application for Controller {
    fn image_out(&mut self, now: Duration, image: &[u8]) {
        self.0.input(now, Some(image));
    }

    fn image_in(&mut self, now: Duration, image: &mut [u8]) {
        self.0.0.advance(now);
        let shown = self.0.0.output().to_link(image.len());
        for (byte, shown) in image.iter_mut().zip(shown) {
            *byte = shown;
        }
    }

    fn on_master_lost(&mut self, now: Duration) {
        self.0.input(now, None);
    }
}
