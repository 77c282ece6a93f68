//! The ways to a controller: EtherNet/IP, the simulator.

use std::net::SocketAddrV4;
use std::time::Duration;

use super::eip::board::Board;
use super::simulated;
use super::trace::Recorder;
use crate::command::{Access, ConnectMode};
use crate::controller::yrcx::image::Image;
use crate::controller::yrcx::signal::resting;
use crate::failure::{Failure, Kind};
use crate::output::Screen;
use crate::settings::Robot;
use crate::settings::target::{self, EipRole, Place, Target};
use crate::transport::eip::client::Client;
use crate::transport::eip::reader::Assembly;
use crate::transport::eip::settings::{Multiplier, Role, Settings};
use crate::transport::eip::tap::Tap;
use crate::transport::eip::trouble::Trouble;
use crate::transport::eip::wire::Key;
use crate::transport::image::{self, ImageLink, OpenError};

/// How a robot is reached.
#[derive(Debug)]
pub enum Way<'a> {
    /// EtherNet/IP.
    Eip(&'a target::Eip),
    /// The built-in simulator.
    Sim(&'a target::Sim),
}

/// The way that a robot's target names.
pub fn way(robot: &Robot) -> Result<Way<'_>, Failure> {
    match &robot.target.value.place {
        Place::Eip(eip) => Ok(Way::Eip(eip)),
        Place::Sim(sim) => Ok(Way::Sim(sim)),
        Place::Udp(_) | Place::Serial(_) | Place::Tcp(_) => {
            Err(Failure::usage(format!("yrcx is not reached over {}:", robot.target.value.scheme()))
                .hint("use eip:// or sim:"))
        }
    }
}

impl Way<'_> {
    /// Opens it, with a record of its packets where that is wanted.
    pub async fn open(
        &self,
        robot: &Robot,
        access: &Access,
        screen: &Screen,
    ) -> Result<(ImageLink, Option<Recorder>), Failure> {
        let (recorder, tap) = match self {
            Self::Eip(_) => Recorder::start(access, screen)?.unzip(),
            Self::Sim(_) => (None, None),
        };
        match Box::pin(self.connect(robot, access, tap.unwrap_or_default())).await {
            Ok(link) => Ok((link, recorder)),
            Err(failure) => {
                // Why it did not open is worth more than what became of the record of it.
                let _ = recorder.map_or(Ok(()), Recorder::finish);
                Err(failure)
            }
        }
    }

    /// The network board, for messages alone.
    pub async fn board(
        &self,
        robot: &Robot,
        access: &Access,
        screen: &Screen,
    ) -> Result<(Board, Option<Recorder>), Failure> {
        match self {
            Self::Eip(eip) => {
                let (recorder, tap) = Recorder::start(access, screen)?.unzip();
                let client = client(robot, eip, tap.unwrap_or_default()).await?;
                Ok((Board::new(client, (*eip).clone(), robot.label(), None), recorder))
            }
            Self::Sim(sim) => {
                let server = simulated::on_loopback(sim)?;
                let eip = at(server.address())?;
                let client = client(robot, &eip, Tap::default()).await?;
                Ok((Board::new(client, eip, robot.label(), Some(server)), None))
            }
        }
    }

    async fn connect(&self, robot: &Robot, access: &Access, tap: Tap) -> Result<ImageLink, Failure> {
        match self {
            Self::Eip(eip) if access.mode == ConnectMode::Monitor && eip.role == EipRole::Owner => {
                see(robot, eip, tap).await
            }
            Self::Eip(eip) => open(robot, eip, tap).await,
            // What goes wrong on a network takes one.
            Self::Sim(sim) if simulated::has_faults(sim) => {
                let server = simulated::on_loopback(sim)?;
                let link = open(robot, &at(server.address())?, tap).await?;
                Ok(link.keeping(Box::new(server)))
            }
            Self::Sim(sim) => Ok(ImageLink::in_process(Box::new(simulated::in_process(sim)?))),
        }
    }

    /// Bytes of the image to the controller. Beyond the image itself they are 0.
    pub fn output_size(&self) -> usize {
        match self {
            Self::Eip(eip) => eip.output_size.into(),
            Self::Sim(_) => Image::BYTES,
        }
    }
}

/// A simulator on the loopback.
fn at(address: SocketAddrV4) -> Result<target::Eip, Failure> {
    match format!("eip://{address}").parse::<Target>()?.place {
        Place::Eip(eip) => Ok(eip),
        _ => Err(Failure::local(format!("{address} is no address of an adapter"))),
    }
}

async fn open(robot: &Robot, eip: &target::Eip, tap: Tap) -> Result<ImageLink, Failure> {
    let opened = ImageLink::open(&eip.host, eip.port, settings(robot, eip)?, tap).await;
    opened.map_err(|error| not_open(&robot.label(), eip, &error))
}

/// Instances for the heartbeats of a connection that only listens to inputs, as boards of several makers have them. The
/// first of them is one whose loss a board does not tell its controller; the last one may be.
const HEARTBEATS: [u32; 5] = [6, 238, 254, 198, 3];
/// Least pause between two looks: boards answer messages when they have nothing better to do.
const PAUSE: Duration = Duration::from_millis(20);

/// Sees what the controller shows without owning it: by messages, which leave nothing behind; where the board does not
/// answer them, by a connection that only listens.
async fn see(robot: &Robot, eip: &target::Eip, tap: Tap) -> Result<ImageLink, Failure> {
    let label = robot.label();
    let client = client(robot, eip, tap.clone()).await?;
    let assembly = Assembly { instance: eip.input, size: eip.input_size };
    let refused = match ImageLink::reading(client, assembly, eip.rpi.max(PAUSE)).await {
        Err(OpenError::Trouble(trouble @ Trouble::Refused { .. })) => trouble,
        opened => return opened.map_err(|error| not_open(&label, eip, &error)),
    };
    for output in HEARTBEATS {
        let listening =
            Settings { role: Role::InputOnly, output, output_size: 0, resting: Vec::new(), ..settings(robot, eip)? };
        match ImageLink::open(&eip.host, eip.port, listening, tap.clone()).await {
            Err(OpenError::Trouble(Trouble::Refused { .. })) => {}
            opened => return opened.map_err(|error| not_open(&label, eip, &error)),
        }
    }
    let message = format!("{label}: the board shows its inputs to nobody who only looks: {refused}");
    Err(Failure::new(Kind::Refused, message).hint(
        "check in of the URL; or add role=input_only and out= with the instance for heartbeats from the EDS file of the board",
    ))
}

/// A session for messages with the board.
async fn client(robot: &Robot, eip: &target::Eip, tap: Tap) -> Result<Client, Failure> {
    let target = image::resolve(&eip.host, eip.port).await;
    let target = target.map_err(|error| not_open(&robot.label(), eip, &error))?;
    Ok(Client::new(target, robot.timeout.value, tap))
}

fn settings(robot: &Robot, eip: &target::Eip) -> Result<Settings, Failure> {
    let role = match eip.role {
        EipRole::Owner => Role::ExclusiveOwner,
        EipRole::InputOnly => Role::InputOnly,
        EipRole::ListenOnly => Role::ListenOnly,
    };
    let mut image = resting().to_bytes().to_vec();
    image.resize(eip.output_size.into(), 0);
    let is_owner = role == Role::ExclusiveOwner;
    Ok(Settings {
        role,
        output: eip.output,
        input: eip.input,
        configuration: eip.configuration,
        configuration_data: Vec::new(),
        output_size: if is_owner { eip.output_size } else { 0 },
        input_size: eip.input_size,
        rpi: eip.rpi,
        multiplier: Multiplier::of(eip.multiplier).ok_or_else(|| {
            Failure::usage(format!("there is no multiplier {}", eip.multiplier))
                .hint("it is 4, 8, 16, 32, 64, 128, 256 or 512")
        })?,
        multicast: eip.multicast,
        key: eip.key.map(|key| Key {
            vendor: key.vendor,
            device_type: key.device_type,
            product: key.product,
            major: key.major,
            minor: key.minor,
            compatible: false,
        }),
        resting: if is_owner { image } else { Vec::new() },
        timeout: robot.timeout.value,
    })
}

/// Extended status of a refusal: somebody owns the outputs.
const OWNED: u32 = 0x0106;

pub fn not_open(label: &str, eip: &target::Eip, error: &OpenError) -> Failure {
    let trouble = match error {
        OpenError::NotFound => {
            return Failure::new(Kind::NoAnswer, format!("{label}: cannot find host '{}'", eip.host))
                .hint("check the name, or use the address of the controller");
        }
        OpenError::NotIpv4 => {
            return Failure::usage(format!("{label}: '{}' has no IPv4 address, as EtherNet/IP needs", eip.host))
                .hint("use the IPv4 address of the controller");
        }
        OpenError::Trouble(trouble) => trouble,
    };
    let (kind, hint) = match trouble {
        Trouble::Unreachable { .. } | Trouble::NoAnswer { .. } | Trouble::Hangup { .. } | Trouble::Silent { .. } => {
            (Kind::NoAnswer, "check the address, that the controller is on, and that its EtherNet/IP board is enabled")
        }
        Trouble::Encapsulation { .. } | Trouble::Refused { .. } => {
            (Kind::Refused, "check in, out, config, in_size and out_size of the URL: `armctl help targets`")
        }
        Trouble::Malformed { .. } | Trouble::Senseless { .. } => {
            (Kind::Malformed, "check that an EtherNet/IP adapter has this address")
        }
        Trouble::Misfit { .. } => (Kind::Malformed, "check in and in_size of the URL: `yrcx eip probe` finds both"),
        Trouble::Impossible(_) => (Kind::Usage, "`armctl help targets` tells what an eip: URL can say"),
        Trouble::Local { .. } | Trouble::Outdated | Trouble::Ended => {
            (Kind::Local, "check the network settings of this machine, and its firewall")
        }
    };
    if trouble.code().is_some_and(|code| code.code == OWNED) {
        let message = format!("{label}: another master, such as a PLC, commands the controller");
        return Failure::new(Kind::Refused, message).code(format!("{OWNED:#06x}")).hint(
            "`yrcx io get` and `yrcx status` see its signals beside the owner; to command from here, stop the owner's \
             connection first: take the controller out of the PLC's scan list, or close the session",
        );
    }
    let failure = Failure::new(kind, format!("{label}: {trouble}"));
    match trouble.code() {
        Some(code) => failure.code(format!("{:#06x}", code.code)).hint(as_hint(code.remedy)),
        None => failure.hint(hint),
    }
}

/// A sentence as hints are written: small, without a full stop.
pub fn as_hint(sentence: &str) -> String {
    let mut chars = sentence.trim_end_matches('.').chars();
    chars.next().map(|first| first.to_lowercase().chain(chars).collect()).unwrap_or_default()
}
