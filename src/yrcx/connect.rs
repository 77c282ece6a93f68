//! Connection to a controller: over a fieldbus, or a simulator in this process.

use super::buses::{self, BUSES};
use super::fieldbus::{self, Board, ConnectionParameters, Fieldbus, Purpose, Simulation};
use super::simulated;
use super::trace::{Opening, Recorder};
use crate::prelude::basics::*;
use armctl_frame::settings::target::bus::simulators;
use armctl_frame::settings::target::{self, Bus, Place};
use armctl_transport::image::ImageLink;
use armctl_transport::image::tap::Tap;

/// Endpoint of a target.
#[derive(Debug, Clone, Copy)]
pub enum Endpoint<'a> {
    /// A controller on a fieldbus.
    Bus(&'a Bus, &'static Fieldbus),
    /// The built-in simulator.
    Sim(&'a target::Sim),
}

/// Endpoint of a robot's target.
pub fn endpoint(robot: &Robot) -> Result<Endpoint<'_>> {
    match &robot.target.value.place {
        Place::Bus(bus) => match buses::by_name(bus.scheme.bus) {
            Some(fieldbus) => Ok(Endpoint::Bus(bus, fieldbus)),
            None => Err(Failure::local(format!("internal error: fieldbus {} is not supported", bus.scheme.bus))),
        },
        Place::Sim(sim) => Ok(Endpoint::Sim(sim)),
        Place::Udp(_) | Place::Serial(_) | Place::Tcp(_) => {
            let schemes: Vec<String> = target::BUSES.iter().map(|scheme| format!("{}://", scheme.name)).collect();
            let schemes = schemes.join(", ");
            Err(Failure::usage(format!("a yrcx controller cannot be reached over {}:", robot.target.value.scheme()))
                .hint(format!("use {schemes} or sim:")))
        }
    }
}

/// A value that was opened, with the simulator that must live as long as this value.
type WithSimulator<T> = (T, Option<Box<dyn fmt::Debug>>);
/// Explicit messaging client.
pub type OpenBoard = WithSimulator<Box<dyn Board>>;

impl Endpoint<'_> {
    /// Opens a link, with a packet recorder if requested.
    pub async fn open(&self, robot: &Robot, access: &Access, screen: &Screen) -> Result<(ImageLink, Option<Recorder>)> {
        let purpose = match self {
            // Faults of the network can only be simulated on a simulated network.
            Self::Sim(sim) if sim.bus.is_none() && !simulated::has_faults(sim) => {
                return Ok((
                    ImageLink::in_process(Box::new(simulated::in_process(sim, robot.simulator_options())?)),
                    None,
                ));
            }
            Self::Bus(..) if access.mode == ConnectMode::Monitor => Purpose::Look,
            Self::Bus(..) | Self::Sim(_) => Purpose::Command,
        };
        let opened = self.on_fieldbus(robot, access, screen, |fieldbus, at| (fieldbus.open)(at, purpose)).await?;
        let ((link, controller), recorder) = opened;
        Ok((controller.into_iter().fold(link, ImageLink::with_owned), recorder))
    }

    /// Opens the explicit messaging client.
    pub async fn board(
        &self,
        robot: &Robot,
        access: &Access,
        screen: &Screen,
    ) -> Result<(OpenBoard, Option<Recorder>)> {
        self.on_fieldbus(robot, access, screen, |fieldbus, at| (fieldbus.board)(at)).await
    }

    /// Opens a value on the fieldbus. Also returns the simulator that must live as long as this value, and the packet
    /// recorder if a recording is requested.
    async fn on_fieldbus<T>(
        &self,
        robot: &Robot,
        access: &Access,
        screen: &Screen,
        open: impl for<'a> FnOnce(&'static Fieldbus, ConnectionParameters<'a>) -> fieldbus::Opening<'a, T>,
    ) -> Result<(WithSimulator<T>, Option<Recorder>)> {
        match *self {
            Self::Bus(bus, fieldbus) => {
                let (recorder, tap) = Recorder::start(access, screen, fieldbus.link_type)?.unzip();
                let (watch, watched) = Opening::watch(screen).filter(|_| tap.is_none()).unzip();
                match open(fieldbus, ConnectionParameters { robot, bus, tap: tap.or(watched).unwrap_or_default() })
                    .await
                {
                    Ok(opened) => Ok(((opened, None), recorder)),
                    Err(error) => {
                        if let Some(watch) = watch {
                            watch.show(screen);
                        }
                        // The error of the connection is reported, so an error of the recording is ignored.
                        let _ = recorder.map_or(Ok(()), Recorder::finish);
                        Err(not_open(&robot.label(), bus.scheme, &error))
                    }
                }
            }
            Self::Sim(sim) => {
                let (fieldbus, Simulation { bus, controller }) = simulate(sim)?;
                let opened = open(fieldbus, ConnectionParameters { robot, bus: &bus, tap: Tap::default() }).await;
                let opened = opened.map_err(|error| not_open(&robot.label(), bus.scheme, &error))?;
                Ok(((opened, Some(controller)), None))
            }
        }
    }

    /// Fieldbus of the endpoint; for a simulator, the fieldbus that it simulates.
    pub fn fieldbus(&self) -> &'static Fieldbus {
        match self {
            Self::Bus(_, fieldbus) => fieldbus,
            Self::Sim(sim) => simulated_on(sim),
        }
    }

    /// Whether a connection in control mode sends commands to the controller.
    pub fn is_owner(&self) -> bool {
        match self {
            Self::Bus(bus, _) => bus.is_owner,
            Self::Sim(_) => true,
        }
    }
}

/// Returns the fieldbus that a simulator simulates.
fn simulated_on(sim: &target::Sim) -> &'static Fieldbus {
    let named = sim.bus.and_then(|wanted| simulators().find(|(name, _)| *name == wanted));
    named.and_then(|(_, bus)| buses::by_name(bus)).unwrap_or(BUSES[0])
}

/// Starts a simulated controller on its fieldbus.
fn simulate(sim: &target::Sim) -> Result<(&'static Fieldbus, Simulation)> {
    let fieldbus = simulated_on(sim);
    Ok((fieldbus, (fieldbus.simulate)(sim)?))
}
