//! PROFIBUS links with the options of a URL.

use std::path::Path;
use std::time::Duration;

use crate::fieldbus::{ConnectionParameters, Purpose, device_file};
use armctl_controller::yrcx::image::{COMMAND_WORDS, Image};
use armctl_controller::yrcx::signal::resting;
use armctl_frame::settings::target::profibus::Profibus;
use armctl_transport::image::tap::Tap;
use armctl_transport::image::{Cause, ImageLink, LinkError};
use armctl_transport::profibus::driver::Opener;
use armctl_transport::profibus::gsd::{Gsd, MAX_FILE, Module};
use armctl_transport::profibus::link::{ByteSwap, Listening, Master};
use armctl_transport::profibus::port::{Port, Serial};
use armctl_transport::profibus::rates::Rate;
use armctl_transport::profibus::settings::Settings;

pub(super) async fn open(at: ConnectionParameters<'_>, purpose: Purpose) -> Result<ImageLink, LinkError> {
    let profibus: &Profibus = at.options()?;
    // A read-only link must not become the master that sets the outputs. A slave sends its image only to its master, so
    // the link listens.
    if purpose == Purpose::Look || !profibus.is_owner {
        return listen(profibus, at.tap, at.robot.timeout.value).await;
    }
    let settings = settings(profibus, at.bus.listen_before)?;
    Ok(ImageLink::over(Master::open(settings, byte_swap(profibus), opener(profibus)?, at.tap).await?))
}

/// Listens to the data exchange between the slave and another master.
pub(super) async fn listen(profibus: &Profibus, tap: Tap, timeout: Duration) -> Result<ImageLink, LinkError> {
    let (silence, opener) = (timeout.max(LISTEN), opener(profibus)?);
    let listening = Listening::open(profibus.station, Image::BYTES, byte_swap(profibus), opener, tap, silence).await;
    Ok(ImageLink::over(listening?))
}

const fn byte_swap(profibus: &Profibus) -> ByteSwap {
    ByteSwap { bytes: if profibus.is_big_endian { 2 * COMMAND_WORDS } else { 0 } }
}

/// Minimum time to listen. It is longer than the longest cycle of a master.
const LISTEN: Duration = Duration::from_secs(3);

/// Returns a function that opens the adapter. The link calls it again after a loss.
pub(super) fn opener(profibus: &Profibus) -> Result<Opener, LinkError> {
    let (path, rate) = (profibus.port.clone(), rate(profibus)?);
    Ok(Box::new(move || Ok(Box::new(Serial::open(&path, rate)?) as Box<dyn Port>)))
}

fn rate(profibus: &Profibus) -> Result<Rate, LinkError> {
    let unknown = || LinkError::Settings(Cause::new(format!("{} is not a PROFIBUS bit rate", profibus.baud)));
    Rate::from_baud(profibus.baud).ok_or_else(unknown)
}

/// Returns the link settings. Options of the URL have priority over the GSD file.
pub(super) fn settings(profibus: &Profibus, calm: Duration) -> Result<Settings, LinkError> {
    let usual = Settings::new(profibus.station, rate(profibus)?, resting().to_link(Image::BYTES));
    let mut settings = Settings {
        master: profibus.master,
        slot: profibus.slot,
        retries: profibus.retries.unwrap_or(usual.retries),
        cycle: profibus.cycle.or((!calm.is_zero()).then_some(calm)),
        watchdog: profibus.watchdog,
        ..usual
    };
    if let Some(path) = &profibus.gsd {
        let (gsd, module) = file(path, profibus.module.as_deref())?;
        settings.ident = Some(gsd.ident);
        settings.parameters = Some([&gsd.parameters[..], &module.parameters].concat());
        settings.configuration = Some(module.configuration);
    }
    settings.ident = profibus.ident.or(settings.ident);
    settings.parameters = profibus.parameters.clone().or(settings.parameters);
    settings.configuration = profibus.configuration.clone().or(settings.configuration);
    Ok(settings)
}

/// Reads a GSD file and selects a module: the module with this name, or the only module with the size of the image.
fn file(path: &Path, module: Option<&str>) -> Result<(Gsd, Module), LinkError> {
    let wrong = |text: String| Cause::new(format!("{}: {text}", path.display()));
    let gsd = device_file(path, MAX_FILE, "set `gsd=` in the URL to the manufacturer's GSD file", Gsd::parse)?;
    let found = match module {
        Some(name) => gsd.modules.iter().find(|module| module.name.eq_ignore_ascii_case(name)),
        None => gsd.fitting(Image::BYTES, Image::BYTES),
    };
    let Some(module) = found.cloned() else {
        let names: Vec<&str> = gsd.modules.iter().map(|module| module.name.as_str()).collect();
        let size = Image::BYTES;
        let cause = wrong(format!(
            "the file has no module with this name, or not exactly one module with {size} bytes \
                                   each way"
        ));
        let advice = format!("set `module=` in the URL to one of: {}", names.join(", "));
        return Err(LinkError::Settings(cause.advice(advice)));
    };
    Ok((gsd, module))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fieldbus::bus_of;
    use armctl_transport::profibus::rates::RATES;

    fn of(url: &str) -> Result<Settings, LinkError> {
        settings(bus_of(url).unwrap().options::<Profibus>().unwrap(), Duration::ZERO)
    }

    #[test]
    fn every_bit_rate_of_a_url_is_one_of_the_line() {
        for rate in RATES {
            let url = format!("profibus:///dev/null?station=5&baud={}", rate.name);
            assert_eq!(of(&url).unwrap().rate, rate);
        }
    }

    #[test]
    fn gsd_file_completes_the_url() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("unit.gsd");
        let text = "#Profibus_DP\nIdent_Number=0x1234\nUser_Prm_Data=1,2\nModule=\"24 words\" 0x7F,0x77\nEndModule\n\
                    Module=\"8 words\" 0x77\nEndModule\n";
        std::fs::write(&path, text).unwrap();
        let url = format!("profibus:///dev/null?station=5&gsd={}", path.display());
        let settings = of(&url).unwrap();
        assert_eq!((settings.ident, settings.parameters), (Some(0x1234), Some(vec![1, 2])));
        assert_eq!(settings.configuration, Some(vec![0x7F, 0x77]));
        assert_eq!(of(&format!("{url}&ident=1&prm=00")).unwrap().parameters, Some(vec![0]));
        let error = of(&format!("{url}&module=9")).unwrap_err();
        assert!(error.cause().advice.as_deref().unwrap().ends_with("24 words, 8 words"), "{error:?}");
        std::fs::write(&path, "Ident_Number=0x1234").unwrap();
        assert!(of(&url).unwrap_err().to_string().contains("line 1: Ident_Number: #Profibus_DP"));
    }
}
