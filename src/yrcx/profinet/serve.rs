//! Server for a simulated controller as an IO device on a network interface.

use super::simulated::{Controller, NAME, controller, layout, setup};
use crate::fieldbus::{Operator, RunningSimulation, Serve, ServeOptions};
use crate::prelude::basics::*;
use crate::simulated::{faults, faults_of_option};
use armctl_frame::settings::target::profinet::{self, SCHEME};
use armctl_transport::fault::{FaultNames, FaultSpec, SimulatorFaults};
use armctl_transport::image::LinkError;
use armctl_transport::profinet::device::Fault;
use armctl_transport::profinet::device::server::Server;
use armctl_transport::profinet::interface::Interface;
use armctl_transport::profinet::layout::Layout;

/// Options of the simulated device.
#[derive(Debug, Args)]
#[group(skip)]
pub struct ServeArgs {
    /// PROFINET: Ethernet interface of the device. The device uses the address of this interface
    #[arg(long, value_name = "IFACE")]
    interface: Option<String>,
    /// PROFINET: name of the station
    #[arg(long, value_name = "NAME", default_value = NAME, value_parser = profinet::name)]
    station_name: String,
    /// PROFINET: modules of the device, for example 1:0x101:i48,2:0x102:o48
    #[arg(long, value_name = "LAYOUT")]
    layout: Option<Layout>,
}

/// Names of the simulated faults of the device. On a real Ethernet interface, armctl does not simulate faults of
/// frames.
const DEVICE_FAULTS: FaultNames<Fault> = FaultNames { link: &[], device: &Fault::ALL };

impl Serve for ServeArgs {
    fn serve(&self, ServeOptions { start, faults, .. }: ServeOptions<'_>) -> Result<RunningSimulation> {
        let Some(interface) = &self.interface else {
            return Err(Failure::usage("a PROFINET device needs an Ethernet interface")
                .hint("add --interface IFACE; use `ip link` to list the interfaces"));
        };
        let faults: SimulatorFaults<FaultSpec, Fault> = faults_of_option(faults, &DEVICE_FAULTS)?;
        let layout = self.layout.clone().unwrap_or_else(layout);
        let target = format!("{}://{}@IFACE?layout={layout}", SCHEME.name, self.station_name);
        let setup = setup(&self.station_name, layout);
        let started = Interface::find(interface).and_then(|found| Server::start(&found, setup, controller(start)));
        let server = started.map_err(|error| not_open("simulator", &SCHEME, &LinkError::from(error)))?;
        server.with(|device, _| device.set_fault(faults.device));
        Ok(RunningSimulation { target, address: None, operator: Box::new(server) })
    }
}

impl Operator for Server<Controller> {
    fn console(&self, line: &str) -> Result<String, String> {
        self.with(|device, now| match line.trim() {
            "restart" => {
                device.restart(now);
                Ok("the device was switched off and on".to_owned())
            }
            line => device.application.0.0.console(now, line),
        })
    }

    fn set_faults(&self, text: Option<&str>) -> Result<(), String> {
        let faults: SimulatorFaults<FaultSpec, Fault> = faults(text, &DEVICE_FAULTS)?;
        self.with(|device, _| device.set_fault(faults.device));
        Ok(())
    }
}
