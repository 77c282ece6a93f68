//! How a controller is connected to: over a fieldbus, or as a simulator in this process.

use std::fmt;

use super::buses::{self, BUSES};
use super::fieldbus::{At, Board, Fieldbus, Purpose, Simulation};
use super::link_error::not_open;
use super::simulated;
use super::trace::{Opening, Recorder};
use crate::command::{Access, ConnectMode};
use crate::failure::Failure;
use crate::output::Screen;
use crate::settings::Robot;
use crate::settings::target::bus::simulators;
use crate::settings::target::{self, Bus, Place};
use crate::transport::image::ImageLink;
use crate::transport::image::tap::Tap;

/// What a target leads to.
#[derive(Debug, Clone, Copy)]
pub enum Endpoint<'a> {
    /// A controller on a fieldbus.
    Bus(&'a Bus, &'static Fieldbus),
    /// The built-in simulator.
    Sim(&'a target::Sim),
}

/// What a robot's target leads to.
pub fn endpoint(robot: &Robot) -> Result<Endpoint<'_>, Failure> {
    match &robot.target.value.place {
        Place::Bus(bus) => match buses::by_name(bus.scheme.bus) {
            Some(fieldbus) => Ok(Endpoint::Bus(bus, fieldbus)),
            None => Err(Failure::local(format!("nothing is known of {}", bus.scheme.bus))),
        },
        Place::Sim(sim) => Ok(Endpoint::Sim(sim)),
        Place::Udp(_) | Place::Serial(_) | Place::Tcp(_) => {
            let schemes: Vec<String> = target::BUSES.iter().map(|scheme| format!("{}://", scheme.name)).collect();
            let schemes = schemes.join(", ");
            Err(Failure::usage(format!("yrcx is not reached over {}:", robot.target.value.scheme()))
                .hint(format!("use {schemes} or sim:")))
        }
    }
}

/// What asks a device without a link for images, with whatever must live as long.
pub type OpenBoard = (Box<dyn Board>, Option<Box<dyn fmt::Debug>>);

impl Endpoint<'_> {
    /// Opens a link, with a record of its packets where that is wanted.
    pub async fn open(
        &self,
        robot: &Robot,
        access: &Access,
        screen: &Screen,
    ) -> Result<(ImageLink, Option<Recorder>), Failure> {
        let purpose = if access.mode == ConnectMode::Monitor { Purpose::Look } else { Purpose::Command };
        match *self {
            Self::Bus(bus, fieldbus) => {
                let (recorder, tap) = Recorder::start(access, screen, fieldbus.link_type)?.unzip();
                let (opening, watched) = Opening::watch(screen).filter(|_| tap.is_none()).unzip();
                let at = At { robot, bus, tap: tap.or(watched).unwrap_or_default() };
                match (fieldbus.open)(at, purpose).await {
                    Ok(link) => Ok((link, recorder)),
                    Err(error) => {
                        if let Some(opening) = opening {
                            opening.show(screen);
                        }
                        // Why it did not open is worth more than what became of the record of it.
                        let _ = recorder.map_or(Ok(()), Recorder::finish);
                        Err(not_open(&robot.label(), bus.scheme, &error))
                    }
                }
            }
            // What goes wrong on a network takes one.
            Self::Sim(sim) if sim.bus.is_some() || simulated::has_faults(sim) => {
                let (fieldbus, Simulation { bus, controller }) = simulate(sim)?;
                let opened = (fieldbus.open)(At { robot, bus: &bus, tap: Tap::default() }, Purpose::Command).await;
                let link = opened.map_err(|error| not_open(&robot.label(), bus.scheme, &error))?;
                Ok((link.keeping(controller), None))
            }
            Self::Sim(sim) => Ok((ImageLink::in_process(Box::new(simulated::in_process(sim)?)), None)),
        }
    }

    /// Opens what can be asked without a link for images.
    pub async fn board(
        &self,
        robot: &Robot,
        access: &Access,
        screen: &Screen,
    ) -> Result<(OpenBoard, Option<Recorder>), Failure> {
        match *self {
            Self::Bus(bus, fieldbus) => {
                let (recorder, tap) = Recorder::start(access, screen, fieldbus.link_type)?.unzip();
                let (opening, watched) = Opening::watch(screen).filter(|_| tap.is_none()).unzip();
                let at = At { robot, bus, tap: tap.or(watched).unwrap_or_default() };
                let opened = (fieldbus.board)(at).await;
                if let (Err(_), Some(opening)) = (&opened, &opening) {
                    opening.show(screen);
                }
                let board = opened.map_err(|error| not_open(&robot.label(), bus.scheme, &error))?;
                Ok(((board, None), recorder))
            }
            Self::Sim(sim) => {
                let (fieldbus, Simulation { bus, controller }) = simulate(sim)?;
                let opened = (fieldbus.board)(At { robot, bus: &bus, tap: Tap::default() }).await;
                let board = opened.map_err(|error| not_open(&robot.label(), bus.scheme, &error))?;
                Ok(((board, Some(controller)), None))
            }
        }
    }

    /// The fieldbus of it; of a simulator, the one that it would be on.
    pub fn fieldbus(&self) -> &'static Fieldbus {
        match self {
            Self::Bus(_, fieldbus) => fieldbus,
            Self::Sim(sim) => simulated_on(sim),
        }
    }

    /// Whether a link to it commands the controller, if its command wants that.
    pub fn is_owner(&self) -> bool {
        match self {
            Self::Bus(bus, _) => bus.is_owner,
            Self::Sim(_) => true,
        }
    }
}

/// The fieldbus that a simulator is on.
fn simulated_on(sim: &target::Sim) -> &'static Fieldbus {
    let named = sim.bus.and_then(|wanted| simulators().find(|(name, _)| *name == wanted));
    named.and_then(|(_, bus)| buses::by_name(bus)).unwrap_or(BUSES[0])
}

/// Starts a simulated controller on its fieldbus.
fn simulate(sim: &target::Sim) -> Result<(&'static Fieldbus, Simulation), Failure> {
    let fieldbus = simulated_on(sim);
    Ok((fieldbus, (fieldbus.simulate)(sim)?))
}
