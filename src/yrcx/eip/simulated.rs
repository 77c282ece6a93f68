//! Simulated controller as an EtherNet/IP adapter.

use std::io;
use std::net::{Ipv4Addr, SocketAddrV4};

use super::bus::BUS;
use crate::prelude::basics::*;
use crate::simulated::{Simulated, faults_of_url, start};
use armctl_controller::yrcx::simulator::{Simulator, Start};
use armctl_frame::settings::target::Sim;
use armctl_transport::eip::PORT;
use armctl_transport::eip::adapter::server::{AdapterAddresses, Server};
use armctl_transport::eip::adapter::{AdapterFault, Application, Event, Setup};
use armctl_transport::eip::settings::Role;
use armctl_transport::eip::wire::{Identity, Revision};
use armctl_transport::fault::{self, FaultNames, FaultSpec, SimulatorFaults};
use armctl_transport::image::ImagePeer;

/// Starts a simulator as an adapter on the loopback interface, with the faults of the URL.
pub fn on_loopback(sim: &Sim) -> Result<Server<Controller>> {
    let faults = faults_of_url(sim, &FAULTS)?;
    let listen = AdapterAddresses::anywhere(Ipv4Addr::LOCALHOST);
    let server = serve(start(sim)?, listen, faults);
    Ok(server.context("the simulator on the loopback")?)
}

/// Faults of images and of the adapter.
type Faults = SimulatorFaults<FaultSpec, AdapterFault>;

/// Faults by name.
pub const FAULTS: FaultNames<AdapterFault> =
    FaultNames { link: &["drop", "dup", "delay", "reorder", "corrupt", "seed"], device: &AdapterFault::ALL };

/// Input, output and configuration assembly. An older controller of the manufacturer has these numbers.
const INPUT: u32 = 100;
const OUTPUT: u32 = 150;
const CONFIGURATION: u32 = 1;

/// Serves a controller as an adapter.
pub fn serve(start: Start, listen: AdapterAddresses, faults: Faults) -> io::Result<Server<Controller>> {
    let size = u16::try_from(Image::BYTES).map_err(io::Error::other)?;
    let setup = Setup::new(identity(), (INPUT, size), (OUTPUT, size), CONFIGURATION);
    let controller = Controller(Simulated(Simulator::new(start).with_link_alarm(BUS.link_alarm)));
    let server = Server::start(setup, controller, listen, None)?;
    set_faults(&server, faults);
    Ok(server)
}

/// Sets the faults of images and of the adapter.
pub fn set_faults(server: &Server<Controller>, faults: Faults) {
    server.set_faults(faults.link.map(fault::Faults::pair));
    server.with(|adapter, _| adapter.set_fault(faults.device));
}

/// Code of the state "operational" (volume 2, 2-4.2.2).
const OPERATIONAL: u8 = 3;

fn identity() -> Identity {
    Identity {
        address: SocketAddrV4::new(Ipv4Addr::UNSPECIFIED, PORT),
        vendor: 636,
        device_type: 43,
        product: 5,
        revision: Revision { major: 1, minor: 1 },
        status: 0,
        serial: 1,
        name: "YRCX simulator of armctl".to_owned(),
        state: Some(OPERATIONAL),
    }
}

/// A simulated controller behind its adapter.
#[derive(Debug)]
pub struct Controller(pub Simulated);

impl Application for Controller {
    fn image_out(&mut self, now: Duration, _instance: u32, image: &[u8], run: bool) {
        // The controller ignores the image of a master that is idle.
        if run {
            self.0.input(now, Some(image));
        }
    }

    fn image_in(&mut self, now: Duration, _instance: u32, image: &mut [u8]) {
        let shown = self.0.output(now).unwrap_or_default();
        for (byte, shown) in image.iter_mut().zip(shown) {
            *byte = shown;
        }
    }

    fn is_silent(&mut self, now: Duration) -> bool {
        self.0.0.advance(now);
        self.0.0.is_silent()
    }

    fn event(&mut self, now: Duration, event: &Event) {
        if let Event::Closed(peer) | Event::TimedOut(peer) = event
            && peer.role == Role::ExclusiveOwner
        {
            self.0.input(now, None);
        }
    }
}
