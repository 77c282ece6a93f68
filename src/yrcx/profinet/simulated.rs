//! Simulated controller as a PROFINET IO device.

use std::time::Duration;

use super::bus::BUS;
use crate::simulated::{Simulated, faults_of_url, start};
use armctl_controller::yrcx::simulator::{Simulator, Start};
use armctl_frame::failure::Failure;
use armctl_frame::settings::target::Sim;
use armctl_frame::settings::target::profinet::SCHEME;
use armctl_transport::fault::{FaultNames, FaultSpec, SimulatorFaults};
use armctl_transport::image::ImagePeer;
use armctl_transport::profinet::device::{Application, Device, Event, Fault, Setup};
use armctl_transport::profinet::layout::Layout;
use armctl_transport::profinet::simulated::Network;
use armctl_transport::profinet::wire::Mac;
use armctl_transport::profinet::wire::record::Im0;

/// Default name of a simulated station.
pub(super) const NAME: &str = "yrcx-sim";
/// Modules of a simulated device, 48 bytes in each direction. The numbers are placeholders, because the numbers of the
/// real device are not public.
const MODULES: (u32, u32) = (0x101, 0x102);

/// In-process network with a simulator, with the faults of the URL.
pub fn in_process(sim: &Sim) -> Result<Network, Failure> {
    let faults: SimulatorFaults<FaultSpec, Fault> = faults_of_url(sim, &FAULTS)?;
    let controller = controller(start(sim)?);
    let device = |mac, ip| {
        let setup = Setup { mac, ip: Some(ip), takes_ip: true, ..setup(NAME, layout()) };
        let mut device = Device::new(setup, controller);
        device.set_fault(faults.device);
        device
    };
    Ok(Network::new(device, faults.link))
}

/// Names of the simulated faults. There is no fault that corrupts frames: frames have a checksum, so a corrupted frame
/// would be lost.
const FAULTS: FaultNames<Fault> =
    FaultNames { link: &["drop", "dup", "delay", "reorder", "seed"], device: &Fault::ALL };

/// URL of a simulated station on an interface.
pub fn target(interface: &str) -> String {
    format!("{}://{NAME}@{interface}?layout={}", SCHEME.name, layout())
}

/// Layout of a simulated device.
pub fn layout() -> Layout {
    Layout::two_modules(MODULES.0, MODULES.1)
}

/// Returns the configuration of a simulated device. Its vendor and device ids are not assigned to a manufacturer.
pub fn setup(name: &str, layout: Layout) -> Setup {
    let id = (0xFFFF, 1);
    Setup {
        mac: Mac::default(),
        name: name.to_owned(),
        kind: "YRCX simulator".to_owned(),
        id,
        instance: 1,
        ip: None,
        takes_ip: false,
        layout,
        shortest: 32,
        im0: Im0 {
            vendor: id.0,
            order_id: "YRCX simulator".to_owned(),
            serial: "1".to_owned(),
            software: ('V', 1, 0, 0),
            ..Im0::default()
        },
    }
}

/// Application of a device: a simulated controller.
pub fn controller(start: Start) -> Controller {
    Controller(Simulated(Simulator::new(start).with_link_alarm(BUS.link_alarm)))
}

/// A simulated controller behind its device.
#[derive(Debug)]
pub struct Controller(pub Simulated);

impl Application for Controller {
    fn image_out(&mut self, now: Duration, image: Option<&[u8]>) {
        self.0.input(now, image);
    }

    fn image_in(&mut self, now: Duration, image: &mut [u8]) {
        self.0.0.advance(now);
        image.copy_from_slice(&self.0.0.output().to_link(image.len()));
    }

    fn event(&mut self, _now: Duration, _event: &Event) {}
}
