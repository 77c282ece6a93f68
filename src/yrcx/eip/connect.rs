//! EtherNet/IP links and explicit messaging sessions, with the options of a URL.

use std::time::Duration;

use crate::fieldbus::{ConnectionParameters, Purpose};
use armctl_controller::yrcx::signal::resting;
use armctl_frame::settings::target::eip::{Eip, EipRole};
use armctl_transport::eip::client::Client;
use armctl_transport::eip::error::EipError;
use armctl_transport::eip::image_reader::Assembly;
use armctl_transport::eip::link::{Class1, Reading, resolve};
use armctl_transport::eip::settings::{Multiplier, Role, Settings};
use armctl_transport::eip::wire::Key;
use armctl_transport::image::{Cause, ImageLink, LinkError};

pub(super) async fn open(at: ConnectionParameters<'_>, purpose: Purpose) -> Result<ImageLink, LinkError> {
    let eip: &Eip = at.options()?;
    if purpose == Purpose::Look && eip.role == EipRole::Owner {
        return check_layers(&at, eip).await;
    }
    let settings = settings(&at, eip)?;
    Ok(ImageLink::over(Class1::open(&eip.host, eip.port, settings, at.tap.into()).await?))
}

/// Creates the explicit messaging client for the board.
pub(super) async fn client(at: &ConnectionParameters<'_>) -> Result<(Client, Eip), LinkError> {
    let eip: &Eip = at.options()?;
    let target = resolve(&eip.host, eip.port).await?;
    Ok((Client::new(target, at.robot.timeout.value, at.tap.clone().into()), eip.clone()))
}

/// Heartbeat instances for input-only connections, as boards of several manufacturers use them. armctl tries them in
/// this order. If a connection with the first instance is lost, the board does not report this to its controller. With
/// the last instance, the board may report it.
const HEARTBEATS: [u32; 5] = [6, 238, 254, 198, 3];
/// Minimum interval of reads, because boards answer explicit messages with low priority.
const PAUSE: Duration = Duration::from_millis(20);

/// Opens a read-only link. It reads with explicit messages, which have no lasting effect. If the board refuses these
/// messages, it opens an input-only connection.
async fn check_layers(at: &ConnectionParameters<'_>, eip: &Eip) -> Result<ImageLink, LinkError> {
    let (client, _) = client(at).await?;
    let assembly = Assembly { instance: eip.input, size: eip.input_size };
    let refused = match Reading::open(client, assembly, eip.rpi.max(at.bus.listen_before).max(PAUSE)).await {
        Err(error @ EipError::Refused { .. }) => error,
        opened => return Ok(ImageLink::over(opened?)),
    };
    for output in HEARTBEATS {
        let listening =
            Settings { role: Role::InputOnly, output, output_size: 0, resting: Vec::new(), ..settings(at, eip)? };
        match Class1::open(&eip.host, eip.port, listening, at.tap.clone().into()).await {
            Err(EipError::Refused { .. }) => {}
            opened => return Ok(ImageLink::over(opened?)),
        }
    }
    let cause = Cause::new(format!("the board refuses to send its inputs to a read-only client: {refused}"));
    Err(LinkError::Refused(cause.advice(
        "check `in=` in the URL, or add `role=input_only` and `out=` with the heartbeat instance from the board's EDS file",
    )))
}

fn settings(at: &ConnectionParameters<'_>, eip: &Eip) -> Result<Settings, LinkError> {
    let role = match eip.role {
        EipRole::Owner => Role::ExclusiveOwner,
        EipRole::InputOnly => Role::InputOnly,
        EipRole::ListenOnly => Role::ListenOnly,
    };
    let is_owner = role == Role::ExclusiveOwner;
    let output_size = if is_owner { eip.output_size } else { 0 };
    let wrong = || Cause::new(format!("there is no multiplier {}", eip.multiplier));
    Ok(Settings {
        role,
        output: eip.output,
        input: eip.input,
        configuration: eip.configuration,
        configuration_data: Vec::new(),
        output_size,
        input_size: eip.input_size,
        rpi: eip.rpi.max(at.bus.listen_before),
        multiplier: Multiplier::of(eip.multiplier).ok_or_else(|| LinkError::Settings(wrong()))?,
        multicast: eip.multicast,
        key: eip.key.map(|key| Key {
            vendor: key.vendor,
            device_type: key.device_type,
            product: key.product,
            major: key.major,
            minor: key.minor,
            compatible: false,
        }),
        resting: if is_owner { resting().to_link(output_size.into()) } else { Vec::new() },
        timeout: at.robot.timeout.value,
    })
}
