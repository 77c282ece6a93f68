//! Master and slave on lines with exact bit times. Each has its own clock.

use std::time::Duration;

use anyhow::{Context as _, ensure};
use armctl_transport::devicenet::can::bus::Bus;
use armctl_transport::devicenet::can::{Bitrate, Frame};
use armctl_transport::devicenet::device::{Application, Device, Setup as NodeSetup};
use armctl_transport::devicenet::scanner::{Identity, Scanner, State as LinkState};
use armctl_transport::devicenet::settings::{Images, Profile, Purpose, Settings as NodeSettings};
use armctl_transport::devicenet::wire::Mac;
use armctl_transport::image::ImagePeer;
use armctl_transport::line::Wire;
use armctl_transport::profibus::master::Master;
use armctl_transport::profibus::rates::Rate;
use armctl_transport::profibus::settings::Settings;
use armctl_transport::profibus::slave::{Setup, Slave};

use super::Effort;
use super::common::table::{Goal, Row, Table};

const SIZE: usize = 48;
const LINK: u64 = 1;
/// Time limit of a run that works.
const MAX_VIRTUAL_TIME: Duration = Duration::from_secs(3600);
/// Maximum duration of an exchange relative to its bit times.
const GOAL: Goal = Goal::AtMost(1.1, "x");

/// Returns the image with the signals SI(00) and SI(06) on.
pub fn resting() -> Vec<u8> {
    let mut image = vec![0; SIZE];
    image[32] = 0x41;
    image
}

/// Application that returns its outputs as inputs.
#[derive(Debug)]
pub struct Echo(Vec<u8>);

impl Default for Echo {
    fn default() -> Self {
        Self(vec![0; SIZE])
    }
}

impl ImagePeer for Echo {
    fn input(&mut self, _: Duration, image: Option<&[u8]>) {
        self.0 = image.map_or_else(|| vec![0; SIZE], <[u8]>::to_vec);
    }

    fn output(&mut self, _: Duration) -> Option<Vec<u8>> {
        Some(self.0.clone())
    }

    fn wake(&self) -> Option<Duration> {
        None
    }
}

impl Application for Echo {
    fn image_out(&mut self, _: Duration, image: &[u8]) {
        self.0 = image.to_vec();
    }

    fn image_in(&mut self, _: Duration, image: &mut [u8]) {
        image.copy_from_slice(&self.0);
    }

    fn on_master_lost(&mut self, _: Duration) {}
}

/// Measures polls of 48 bytes: the time from the first bit of a poll to the last bit of its answer, compared with the
/// bits of these 14 frames.
pub fn devicenet(effort: &Effort) -> anyhow::Result<Table> {
    const FRAMES: usize = 14;
    const CYCLE: Duration = Duration::from_millis(4);

    let (bitrate, slave) = (Bitrate::K500, Mac::new(5).context("a MAC")?);
    let identity = Identity { mac: Mac::new(1).context("a MAC")?, vendor: 0xFFFF, serial: 7 };
    let setup = NodeSetup::sample_controller(slave, bitrate, u16::try_from(SIZE)?);
    let images = Images {
        profiles: vec![Profile { name: "Normal", resting: resting() }],
        cycle: CYCLE,
        rate: Images::rate_of(CYCLE),
    };
    let settings = NodeSettings { slave, purpose: Purpose::Images(images), timeout: Duration::from_secs(1) };
    let (mut scanner, mut device) = (Scanner::new(identity), Device::on_line(setup, Echo::default()));
    let mut bus = Bus::new(bitrate, 2);
    scanner.open(LINK, settings)?;
    let (mut now, mut polls, mut frames) = (Duration::ZERO, Vec::new(), Vec::<(Duration, Frame)>::new());
    let (mut took, mut bits, mut count) = (Duration::ZERO, Duration::ZERO, 0);
    while count < effort.exchanges {
        ensure!(now < MAX_VIRTUAL_TIME, "{:?}", scanner.view(LINK));
        while let Some(frame) = scanner.poll(now) {
            bus.send(now, 0, frame);
        }
        while let Some(frame) = device.poll(now) {
            bus.send(now, 1, frame);
        }
        let mut has_passed = false;
        while let Some(passed) = bus.pass(now) {
            has_passed = true;
            if passed.from == 0 {
                device.handle(now, &passed.frame);
            } else {
                scanner.handle(now, &passed.frame);
            }
            if [0x42D, 0x3C5].contains(&passed.frame.id()) {
                frames.push((passed.at, passed.frame));
            }
        }
        let view = scanner.view(LINK).context("the link is gone")?;
        if frames.len() == FRAMES && view.state == LinkState::Open {
            let begin = frames[0].0.saturating_sub(frames[0].1.time(bitrate));
            took += frames[FRAMES - 1].0.saturating_sub(begin);
            bits += frames.iter().map(|(_, frame)| frame.time(bitrate)).sum::<Duration>();
            polls.push(begin);
            count += 1;
            let generation = view.generation;
            let mut image = resting();
            image[..32].fill_with(|| fastrand::u8(..));
            scanner.set_image(LINK, generation, &image)?;
        }
        frames.truncate(if frames.len() >= FRAMES { 0 } else { FRAMES });
        let next = scanner.wake().into_iter().chain(device.wake()).chain(bus.wake()).min().unwrap_or(MAX_VIRTUAL_TIME);
        // Work that is due now is done at the start of the next pass of the loop.
        now = if has_passed { now } else { next.max(now + Duration::from_nanos(100)) };
    }
    let span = polls.last().zip(polls.first()).map_or(Duration::ZERO, |(last, first)| last.saturating_sub(*first));
    let period = span / u32::try_from(polls.len().saturating_sub(1).max(1))?;
    let mut table = Table::new("DeviceNet, 500 kbit/s, 48 bytes each way, in virtual time");
    let ratio = took.as_secs_f64() / bits.as_secs_f64();
    table.row(Row::new("14 frames, bit by bit", millis(bits / count)));
    table.row(Row::new("an exchange", millis(took / count)).with_comparison(ratio, "its bits", GOAL));
    table.row(Row::new("from poll to poll at cycle=4ms", millis(period)));
    Ok(table)
}

/// Measures consecutive exchanges, compared with the bits of both telegrams, the pause before them, and the maximum
/// delay of the answer.
pub fn profibus(effort: &Effort) -> anyhow::Result<Table> {
    let mut table = Table::new("PROFIBUS DP, 48 bytes each way, one cycle after the other, in virtual time");
    for (name, of_line, of_cycle) in
        [("500k", "bits and TSDR at 500 kbit/s", "a cycle"), ("9.6k", "bits and TSDR at 9.6 kbit/s", "a cycle")]
    {
        let rate = Rate::from_name(name).context("a speed")?;
        let settings = Settings { cycle: Some(Duration::ZERO), ..Settings::new(5, rate, resting()) };
        let mut master = Master::new(Duration::ZERO, settings)?;
        let mut slave = Slave::new(Setup::sample_controller(rate), Echo::default());
        let mut wire = Wire::new(Some(rate.pace()), None);
        let (mut now, mut start) = (Duration::ZERO, None);
        let exchanges = u64::from(effort.exchanges.min(500));
        while slave.exchanges() < exchanges + 1 {
            ensure!(now < MAX_VIRTUAL_TIME, "{:?}", master.view());
            while let Some(bytes) = master.poll(now) {
                wire.send(now, &bytes);
            }
            let due = master.due().into_iter().chain(wire.due(&slave)).min().unwrap_or(MAX_VIRTUAL_TIME);
            now = due.max(now + Duration::from_nanos(1));
            wire.run(now, &mut slave);
            let mut buffer = [0; 64];
            loop {
                let len = wire.take(now, &mut buffer);
                if len == 0 {
                    break;
                }
                master.handle(now, &buffer[..len]);
            }
            if slave.exchanges() == 1 {
                start.get_or_insert(now);
            }
        }
        let cycle = now.saturating_sub(start.context("no exchange")?) / u32::try_from(exchanges)?;
        let limit = rate.exchange(SIZE, SIZE);
        let ratio = cycle.as_secs_f64() / limit.as_secs_f64();
        table.row(Row::new(of_line, millis(limit)));
        table.row(Row::new(of_cycle, millis(cycle)).with_comparison(ratio, "the line", GOAL));
    }
    Ok(table)
}

pub fn millis(time: Duration) -> String {
    format!("{:.3} ms", time.as_secs_f64() * 1000.0)
}
