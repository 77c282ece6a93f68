//! PROFINET links with the options of a URL.

use std::path::Path;
use std::time::Duration;

use crate::fieldbus::{ConnectionParameters, Purpose, device_file, options};
use armctl_controller::yrcx::image::{COMMAND_WORDS, Image};
use armctl_controller::yrcx::signal::resting;
use armctl_frame::settings::target::profinet::{Profinet, address};
use armctl_frame::settings::target::{Address, Bus};
use armctl_transport::image::tap::Tap;
use armctl_transport::image::{Cause, ImageLink, LinkError};
use armctl_transport::profinet::commission;
use armctl_transport::profinet::error::ProfinetError;
use armctl_transport::profinet::gsdml::{Gsdml, Head, MAX_FILE_SIZE};
use armctl_transport::profinet::interface::Interface;
use armctl_transport::profinet::layout::{Direction, Layout};
use armctl_transport::profinet::link::Link;
use armctl_transport::profinet::network;
use armctl_transport::profinet::settings::{MAX_WATCHDOG, Settings, Startup, Station};
use armctl_transport::profinet::simulated::Network;
use armctl_transport::profinet::wire::record::Parameter;

pub(super) async fn open(at: ConnectionParameters<'_>, purpose: Purpose) -> Result<ImageLink, LinkError> {
    let profinet: &Profinet = at.options()?;
    // Without raw Ethernet, no other advice helps.
    if let Err(error @ ProfinetError::Platform) = Interface::find(&profinet.interface) {
        return Err(error.into());
    }
    if purpose == Purpose::Look {
        // To read the signals, armctl would have to open a connection, and the end of the connection would stop the
        // controller.
        let cause = Cause::new("a PROFINET device sends its signals only to the controller that owns the connection");
        return Err(LinkError::Refused(
            cause.advice("open a session with `armctl session open`, then read through that session"),
        ));
    }
    let settings = settings(profinet, at.bus.listen_before)?;
    if let Some(network) = Network::find(&profinet.interface) {
        return Ok(ImageLink::in_process(Box::new(network.open(settings)?)));
    }
    Ok(ImageLink::over(Link::open(&profinet.interface, settings, at.tap).await?))
}

/// Opens a connection until data flows, then closes it.
pub(super) async fn attempt(profinet: &Profinet, settings: Settings, tap: Tap) -> Result<(), ProfinetError> {
    if let Some(network) = Network::find(&profinet.interface) {
        // A device in this process always receives the close request, so the result of the close does not matter.
        let _ = ImageLink::in_process(Box::new(network.open(settings)?)).close().await;
        return Ok(());
    }
    network::Network::shared(&profinet.interface)?.open(settings, tap).await?.close().await
}

/// Returns the addresses of a station, which DCP reports: name and MAC address.
pub(super) fn addresses(bus: &Bus) -> Result<Vec<Address>, LinkError> {
    let profinet: &Profinet = options(bus)?;
    let interface = Interface::find(&profinet.interface)?;
    let found = commission::find(&interface, &profinet.station)?;
    let names = [Station::Name(found.station.name), Station::Mac(found.mac)];
    Ok(names.iter().map(|name| address(&profinet.interface, name)).collect())
}

/// Returns the link settings. `calm` is the minimum cycle for a caller that reads rarely.
pub(super) fn settings(profinet: &Profinet, calm: Duration) -> Result<Settings, LinkError> {
    let Modules { layout, parameters, shortest, startup } = modules(profinet)?;
    let sizes = (layout.size(Direction::Input), layout.size(Direction::Output));
    let fits = sizes.0 == sizes.1 && [Image::BYTES, Image::SIGNAL_BYTES].contains(&sizes.0);
    if !fits {
        let (input, output) = sizes;
        let cause = Cause::new(format!(
            "the modules have {input} bytes from the controller and {output} bytes to the controller, not {} each way",
            Image::BYTES
        ));
        return Err(LinkError::Settings(
            cause.advice("correct `layout=` in the URL; use `yrcx profinet probe` to find the layout"),
        ));
    }
    if profinet.cycle < shortest {
        let cause =
            Cause::new(format!("the device needs a cycle of at least {} ms", shortest.as_micros().div_ceil(1000)));
        return Err(LinkError::Settings(cause.advice("set a longer `cycle=` in the URL")));
    }
    let cycle = profinet.cycle.max(whole(calm));
    let watchdog = profinet.watchdog.max(cycle * 3).min(MAX_WATCHDOG);
    let legacy = profinet.startup == Startup::Legacy;
    let resting = resting().to_link(sizes.1);
    let settings = Settings {
        ip: profinet.ip,
        startup: if legacy { Startup::Legacy } else { startup },
        cycle,
        watchdog,
        parameters,
        resting,
        swapped: if profinet.is_big_endian && sizes.0 == Image::BYTES { 2 * COMMAND_WORDS } else { 0 },
        ..Settings::new(profinet.station.clone(), layout)
    };
    settings.check()?;
    Ok(settings)
}

/// Rounds up to a valid cycle time.
fn whole(time: Duration) -> Duration {
    const MAX_CYCLE_MS: u64 = 512;
    let millis = u64::try_from(time.as_millis()).unwrap_or(MAX_CYCLE_MS).clamp(1, MAX_CYCLE_MS);
    Duration::from_millis(millis.next_power_of_two())
}

/// Known properties of the modules of a device.
struct Modules {
    layout: Layout,
    parameters: Vec<Parameter>,
    shortest: Duration,
    startup: Startup,
}

fn modules(profinet: &Profinet) -> Result<Modules, LinkError> {
    match (&profinet.layout, &profinet.gsdml) {
        (Some(layout), _) => Ok(Modules {
            layout: layout.clone(),
            parameters: Vec::new(),
            shortest: Duration::ZERO,
            startup: Startup::Advanced,
        }),
        (None, Some(path)) => file(path),
        (None, None) => {
            let cause = Cause::new("the URL does not define the modules of the device");
            Err(LinkError::Settings(cause.advice(
                "set gsdml= to the manufacturer's GSDML file, or layout= to the result of `yrcx profinet probe`",
            )))
        }
    }
}

/// Selects modules of a GSDML file. There must be exactly one selection that has the image size of a YRCX.
fn file(path: &Path) -> Result<Modules, LinkError> {
    /// Unit in which the file gives the shortest cycle.
    const UNIT: Duration = Duration::from_nanos(31_250);
    let wrong = |text: String| Cause::new(format!("{}: {text}", path.display()));
    let gsdml = read(path)?;
    let chosen = |head: &Head| -> Option<Modules> {
        let chosen = head.choose(Image::BYTES, Image::BYTES)?;
        Some(Modules {
            layout: head.layout(&chosen).ok()?,
            parameters: head.parameters(&chosen).ok()?,
            shortest: UNIT * u32::from(head.shortest),
            startup: if head.startup == (false, true) { Startup::Legacy } else { Startup::Advanced },
        })
    };
    let mut found = gsdml.heads.iter().filter_map(chosen);
    if let (Some(only), None) = (found.next(), found.next()) {
        return Ok(only);
    }
    let size = Image::BYTES;
    let cause = wrong(format!("the file does not have exactly one selection of modules with {size} bytes each way"));
    let advice = "set `layout=` in the URL instead; use `yrcx profinet gsdml FILE` to list the modules";
    Err(LinkError::Settings(cause.advice(advice)))
}

pub(super) fn read(path: &Path) -> Result<Gsdml, LinkError> {
    device_file(path, MAX_FILE_SIZE, "use the manufacturer's GSDML file: `gsdml=` in the URL, or FILE", Gsdml::parse)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fieldbus::bus_of;
    use armctl_frame::settings::target::profinet::Profinet;

    const LAYOUT: &str = "layout=0:1,1:0x101:i48,2:0x102:o48";

    fn of(url: &str, calm: Duration) -> Result<Settings, LinkError> {
        settings(bus_of(url).unwrap().options::<Profinet>().unwrap(), calm)
    }

    #[test]
    fn converts_url_options_to_settings() {
        let ms = Duration::from_millis;
        let usual = of(&format!("profinet://robot@eth0?{LAYOUT}"), Duration::ZERO).unwrap();
        assert_eq!((usual.cycle, usual.watchdog, usual.swapped), (ms(16), ms(320), 0));
        assert_eq!(usual.resting, resting().to_link(48));
        assert_eq!(usual.resting[32], 0x41, "SI(00) and SI(06)");
        let big = of(&format!("profinet://robot@eth0?{LAYOUT}&words=be&startup=legacy"), Duration::ZERO).unwrap();
        assert_eq!((big.swapped, big.startup), (32, Startup::Legacy));
        let calm = of(&format!("profinet://robot@eth0?{LAYOUT}&cycle=8ms"), ms(200)).unwrap();
        assert_eq!((calm.cycle, calm.watchdog), (ms(256), ms(768)));
    }

    #[test]
    fn invalid_settings_have_a_hint() {
        let error = of("profinet://robot@eth0", Duration::ZERO).unwrap_err();
        assert!(error.cause().advice.as_ref().unwrap().contains("set gsdml= to"), "{error:?}");
        let error = of("profinet://robot@eth0?layout=1:1:i48,2:2:o32", Duration::ZERO).unwrap_err();
        assert!(error.to_string().contains("48 bytes from the controller and 32 bytes to the controller"), "{error}");
    }
}
