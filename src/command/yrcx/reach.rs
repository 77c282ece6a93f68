//! The ways to a controller: EtherNet/IP, the simulator.

use super::simulated;
use super::trace::Recorder;
use crate::command::Access;
use crate::controller::yrcx::image::Image;
use crate::controller::yrcx::signal::resting;
use crate::failure::{Failure, Kind};
use crate::output::Screen;
use crate::settings::Robot;
use crate::settings::target::{self, EipRole, Place};
use crate::transport::eip::settings::{Multiplier, Role, Settings};
use crate::transport::eip::trouble::Trouble;
use crate::transport::eip::wire::Key;
use crate::transport::image::{ImageLink, OpenError};

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
        match self {
            Self::Eip(eip) => {
                let settings = settings(robot, eip)?;
                let (recorder, tap) = Recorder::start(access, screen)?.unzip();
                let opened = ImageLink::open(&eip.host, eip.port, settings, tap.unwrap_or_default()).await;
                let link = opened.map_err(|error| not_open(&robot.label(), eip, &error))?;
                Ok((link, recorder))
            }
            Self::Sim(sim) => Ok((ImageLink::in_process(simulated::in_process(sim)?), None)),
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
        multiplier: Multiplier::of(eip.multiplier)
            .ok_or_else(|| Failure::usage(format!("there is no multiplier {}", eip.multiplier)))?,
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

fn not_open(label: &str, eip: &target::Eip, error: &OpenError) -> Failure {
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
        Trouble::Impossible(_) => (Kind::Usage, "`armctl help targets` tells what an eip: URL can say"),
        Trouble::Local { .. } | Trouble::Outdated | Trouble::Ended => {
            (Kind::Local, "check the network settings of this machine, and its firewall")
        }
    };
    let failure = Failure::new(kind, format!("{label}: {trouble}"));
    match trouble.code() {
        Some(code) => failure.code(format!("{:#06x}", code.code)).hint(as_hint(code.remedy)),
        None => failure.hint(hint),
    }
}

/// A sentence as hints are written: small, without a full stop.
fn as_hint(sentence: &str) -> String {
    let mut chars = sentence.trim_end_matches('.').chars();
    chars.next().map(|first| first.to_lowercase().chain(chars).collect()).unwrap_or_default()
}
