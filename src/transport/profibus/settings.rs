//! Settings of a link.

use std::time::Duration;

use super::error::ProfibusError;
use super::rates::Rate;
use super::wire::{Configuration, MAX_DATA, MAX_STATION, Parameters, Watchdog};

/// Default address of this master. PLCs usually have address 2 too, but this line has no PLC.
pub const MASTER: u8 = 2;
/// Minimum of the default watchdog time.
const WATCHDOG: Duration = Duration::from_millis(500);
/// Default number of repetitions of a request. Repetitions are needed, because USB converters lose some characters.
const RETRIES: u8 = 3;
/// Minimum watchdog time in cycles.
const CYCLES: u32 = 5;
/// Longest valid cycle and slot time.
const MAX_TIME: Duration = Duration::from_secs(10);

/// Settings of a link. `None` means a default value or automatic detection.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Settings {
    /// Address of the slave.
    pub station: u8,
    /// Address of this master.
    pub master: u8,
    /// Bit rate.
    pub rate: Rate,
    /// Time limit for the start of an answer.
    pub slot: Option<Duration>,
    /// Number of repetitions of a request.
    pub retries: u8,
    /// Time between two exchanges.
    pub cycle: Option<Duration>,
    /// Watchdog time of the slave.
    pub watchdog: Option<Duration>,
    /// Expected ident number.
    pub ident: Option<u16>,
    /// Identifier bytes.
    pub configuration: Option<Vec<u8>>,
    /// User parameters.
    pub parameters: Option<Vec<u8>>,
    /// Size of the image to the slave in bytes.
    pub output_size: usize,
    /// Size of the image from the slave in bytes.
    pub input_size: usize,
    /// Image that is sent first after every opening.
    pub resting: Vec<u8>,
}

/// Times that are computed from the settings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Timing {
    /// Time limit for the start of an answer.
    pub slot: Duration,
    /// Time between two exchanges.
    pub cycle: Duration,
    /// Watchdog time of the slave.
    pub watchdog: Watchdog,
    /// Time for which the master listens before its first telegram.
    pub listen: Duration,
}

impl Settings {
    /// Creates default settings for a slave with this address, this bit rate and this resting image.
    pub fn new(station: u8, rate: Rate, resting: Vec<u8>) -> Self {
        Self {
            station,
            master: MASTER,
            rate,
            slot: None,
            retries: RETRIES,
            cycle: None,
            watchdog: None,
            ident: None,
            configuration: None,
            parameters: None,
            output_size: resting.len(),
            input_size: resting.len(),
            resting,
        }
    }

    /// Checks the settings, and computes the times.
    ///
    /// # Errors
    /// [`ProfibusError::Settings`] describes the problem.
    pub fn timing(&self) -> Result<Timing, ProfibusError> {
        let wrong = |text: String| Err(ProfibusError::Settings(text));
        if self.station > MAX_STATION || self.master > MAX_STATION {
            return wrong(format!("stations have addresses from 0 to {MAX_STATION}"));
        }
        if self.station == self.master {
            return wrong(format!("station and master cannot both be {}", self.station));
        }
        if self.output_size.max(self.input_size) > MAX_DATA || self.resting.len() != self.output_size {
            return wrong(format!(
                "an image can have at most {MAX_DATA} bytes, and its resting image must have the same size"
            ));
        }
        if self.parameters.as_ref().is_some_and(|user| user.len() > Parameters::MAX_USER) {
            return wrong(format!("at most {} bytes of user parameters are possible", Parameters::MAX_USER));
        }
        if let Some(bytes) = &self.configuration {
            let configuration = Configuration::parse(bytes)
                .map_err(|error| ProfibusError::Settings(format!("cannot decode the configuration: {error}")))?;
            self.fits(&configuration)?;
        }
        let slot = self.slot.unwrap_or_else(|| self.usual_slot());
        if slot < self.rate.bits(self.rate.slot) || slot > MAX_TIME {
            let least = self.rate.bits(self.rate.slot);
            return wrong(format!(
                "the slot time at {} must be {least:?} to {MAX_TIME:?}, not {slot:?}",
                self.rate.name
            ));
        }
        let usual = Duration::from_millis(self.rate.cycle_ms);
        let cycle = self.cycle.unwrap_or(usual);
        if cycle > MAX_TIME {
            return wrong(format!("the cycle must be at most {MAX_TIME:?}, not {cycle:?}"));
        }
        let exchange = self.rate.exchange(self.output_size, self.input_size);
        let attempt = exchange + slot;
        let least = (cycle.max(exchange)) * CYCLES + attempt * (u32::from(self.retries) + 1);
        let reported_configuration = self.watchdog.unwrap_or_else(|| least.max(WATCHDOG));
        if reported_configuration < least {
            let least = least.as_millis();
            return wrong(format!("with this cycle, slot time and bit rate the watchdog must be {least} ms or more"));
        }
        let Some(watchdog) = Watchdog::at_least(reported_configuration) else {
            return wrong("the watchdog must be at most 650 s".to_owned());
        };
        // The token timeout of the standard increases with the address of the master: 6 + 2 x address slot times.
        let listen = self.rate.bits(self.rate.slot * (6 + 2 * u32::from(self.master))).max(Duration::from_millis(100));
        Ok(Timing { slot, cycle, watchdog, listen })
    }

    /// Checks that the images have the sizes of a configuration.
    pub fn fits(&self, configuration: &Configuration) -> Result<(), ProfibusError> {
        let (input, output) = (configuration.input(), configuration.output());
        if (input, output) == (self.input_size, self.output_size) {
            return Ok(());
        }
        Err(ProfibusError::Size {
            station: self.station,
            configuration: configuration.bytes().to_vec(),
            input,
            output,
            expected_input: self.input_size,
            expected_output: self.output_size,
        })
    }

    fn usual_slot(&self) -> Duration {
        self.rate.bits(self.rate.slot).max(Duration::from_millis(self.rate.adapter_ms))
    }
}

#[cfg(test)]
mod tests {
    use super::super::rates::RATES;
    use super::*;

    fn settings(rate: &str) -> Settings {
        Settings::new(5, Rate::from_name(rate).unwrap(), vec![0; 48])
    }

    #[test]
    fn default_times_are_consistent_at_every_bit_rate() {
        for rate in RATES {
            let settings = Settings { rate, ..settings("500k") };
            let timing = settings.timing().unwrap();
            assert!(timing.cycle > rate.exchange(48, 48), "{rate:?}");
            assert!(timing.watchdog.time() >= timing.cycle * 5, "{rate:?}");
        }
        let timing = settings("500k").timing().unwrap();
        assert_eq!((timing.slot.as_millis(), timing.cycle.as_millis()), (10, 20));
        assert_eq!((timing.watchdog.time().as_millis(), timing.listen.as_millis()), (500, 100));
        assert_eq!(settings("9.6k").timing().unwrap().slot.as_millis(), 60);
    }

    #[test]
    fn rejects_invalid_settings() {
        let usual = settings("500k");
        let ms = |ms| Some(Duration::from_millis(ms));
        for (settings, message) in [
            (Settings { station: 126, ..usual.clone() }, "0 to 125"),
            (Settings { station: 2, ..usual.clone() }, "both be 2"),
            (Settings { resting: vec![0; 47], ..usual.clone() }, "the same size"),
            (Settings { slot: Some(Duration::from_micros(100)), ..usual.clone() }, "slot time at 500k"),
            (Settings { watchdog: ms(100), ..usual.clone() }, "or more"),
            (Settings { watchdog: Some(Duration::from_secs(700)), ..usual.clone() }, "650 s"),
            (Settings { cycle: Some(Duration::from_secs(11)), ..usual.clone() }, "cycle"),
            (Settings { configuration: Some(vec![0x1F]), ..usual.clone() }, "16 input bytes from station 5"),
            (Settings { configuration: Some(vec![0xC0]), ..usual.clone() }, "cannot decode"),
            (Settings { parameters: Some(vec![0; 238]), ..usual }, "237 bytes"),
        ] {
            let error = settings.timing().unwrap_err().to_string();
            assert!(error.contains(message), "{error}");
        }
    }
}
