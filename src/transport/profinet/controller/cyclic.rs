//! Producer and consumer of cyclic frames.

use super::super::Now;
use super::super::error::Unusable;
use super::super::layout::{Direction, FrameLayout, Layout};
use super::super::settings::{SEND_CLOCK, Settings, swap};
use super::super::wire::cyclic::{Cyclic, GOOD, RUNNING};
use crate::refuse_if;

/// Sender of cyclic frames.
#[derive(Debug, Clone)]
pub struct Producer {
    frame: FrameLayout,
    period: Now,
    step: u16,
    counter: u16,
    due: Now,
    swapped: usize,
    /// Number of frames sent.
    pub sent: u64,
    /// Number of frames that were omitted, because their time was missed.
    pub skipped: u64,
}

impl Producer {
    /// Creates a sender that starts at `now`.
    pub fn new(settings: &Settings, now: Now) -> Self {
        let step = SEND_CLOCK * settings.ratio().unwrap_or(1);
        Self {
            frame: settings.layout.frame(Direction::Output),
            period: settings.cycle,
            step,
            counter: 0,
            due: now,
            swapped: settings.swapped,
            sent: 0,
            skipped: 0,
        }
    }

    /// Time of the next frame.
    pub const fn wake(&self) -> Now {
        self.due
    }

    /// Returns the payload of a frame if one is due. Missed frames are omitted and counted, so there is no burst
    /// afterwards.
    pub fn poll(&mut self, now: Now, image: &[u8]) -> Option<Vec<u8>> {
        if now < self.due {
            return None;
        }
        let periods = now.saturating_sub(self.due).as_nanos() / self.period.as_nanos().max(1);
        let periods = u32::try_from(periods).unwrap_or(u32::MAX - 1);
        self.skipped += u64::from(periods);
        self.due += self.period.saturating_mul(periods + 1);
        // Only the lower 16 bits are used, because the cycle counter has 16 bits.
        let [.., high, low] = periods.to_be_bytes();
        let steps = u16::from_be_bytes([high, low]).wrapping_add(1);
        self.counter = self.counter.wrapping_add(self.step.wrapping_mul(steps));
        self.sent += 1;
        let data = self.data(image);
        Some(Cyclic { data: &data, counter: self.counter, status: RUNNING, transfer: 0 }.emit())
    }

    fn data(&self, image: &[u8]) -> Vec<u8> {
        let mut image = image.to_vec();
        swap(&mut image, self.swapped);
        let mut data = vec![0; usize::from(self.frame.length)];
        let mut rest = &image[..];
        for (place, length) in &self.frame.objects {
            let (at, length) = (usize::from(place.offset), usize::from(*length));
            let (part, behind) = rest.split_at(length.min(rest.len()));
            rest = behind;
            data[at..at + part.len()].copy_from_slice(part);
            data[at + length] = GOOD;
        }
        for place in &self.frame.consumers {
            data[usize::from(place.offset)] = GOOD;
        }
        data
    }
}

/// Result of a received frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FrameResult {
    /// The frame is invalid, or older than the last frame.
    Stale,
    /// The device is alive, but its data is not usable.
    Unusable(Unusable),
    /// An image.
    Image(Vec<u8>),
}

/// Receiver of cyclic frames.
#[derive(Debug, Clone)]
pub struct Consumer {
    frame: FrameLayout,
    /// For each submodule, whether its consumer status must be good. Only the status of a submodule with output data
    /// must be good.
    has_consumer_status: Vec<bool>,
    last: Option<u16>,
    swapped: usize,
    /// Time of the last frame.
    pub last_frame_at: Option<Now>,
    /// Number of accepted frames.
    pub received: u64,
    /// Number of rejected frames.
    pub stale: u64,
}

impl Consumer {
    /// Creates a receiver that has not received a frame yet.
    pub fn new(settings: &Settings) -> Self {
        let frame = settings.layout.frame(Direction::Input);
        let has_consumer_status =
            frame.consumers.iter().map(|place| is_watchdog_fed(&settings.layout, place.slot, place.subslot)).collect();
        Self {
            frame,
            has_consumer_status,
            last: None,
            swapped: settings.swapped,
            last_frame_at: None,
            received: 0,
            stale: 0,
        }
    }

    /// Handles a frame. The caller has checked the frame id.
    pub fn handle(&mut self, now: Now, payload: &[u8]) -> FrameResult {
        let cyclic = Cyclic::parse(payload, usize::from(self.frame.length));
        let Some(cyclic) = cyclic.ok().filter(|cyclic| self.last.is_none_or(|last| cyclic.is_after(last))) else {
            self.stale += 1;
            return FrameResult::Stale;
        };
        self.last = Some(cyclic.counter);
        self.last_frame_at = Some(now);
        self.received += 1;
        match self.image(&cyclic) {
            Ok(image) => FrameResult::Image(image),
            Err(why) => FrameResult::Unusable(why),
        }
    }

    fn image(&self, cyclic: &Cyclic<'_>) -> Result<Vec<u8>, Unusable> {
        refuse_if(!cyclic.is_usable(), Unusable::Status(cyclic.status, cyclic.transfer))?;
        let is_good = |at: usize| cyclic.data.get(at).is_some_and(|status| status & GOOD != 0);
        let mut image = Vec::new();
        for (place, length) in &self.frame.objects {
            let (at, length) = (usize::from(place.offset), usize::from(*length));
            if !is_good(at + length) {
                // If the submodule has no data, its status is ignored.
                if length == 0 {
                    continue;
                }
                return Err(Unusable::Provider(place.slot, place.subslot));
            }
            image.extend_from_slice(&cyclic.data[at..at + length]);
        }
        for (place, _) in self
            .frame
            .consumers
            .iter()
            .zip(&self.has_consumer_status)
            .filter(|(_, has_consumer_status)| **has_consumer_status)
        {
            refuse_if(!is_good(usize::from(place.offset)), Unusable::Consumer(place.slot, place.subslot))?;
        }
        swap(&mut image, self.swapped);
        Ok(image)
    }
}

fn is_watchdog_fed(layout: &Layout, slot: u16, subslot: u16) -> bool {
    layout.find(slot, subslot).is_some_and(|submodule| submodule.output > 0)
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::super::super::settings::Station;
    use super::*;

    const CYCLE: Duration = Duration::from_millis(16);

    fn settings() -> Settings {
        Settings::new(Station::Name("a".to_owned()), Layout::two_modules(0x101, 0x102))
    }

    /// The expected frame to the device is from the worked example in the notes.
    #[test]
    fn output_frames_are_those_of_the_example() {
        let mut producer = Producer::new(&settings(), Now::ZERO);
        let image: Vec<u8> = (1..=48).collect();
        let bytes = producer.poll(Now::ZERO, &image).unwrap();
        assert_eq!(bytes[..48], image);
        assert_eq!(bytes[48..], [0x80, 0x80, 0x80, 0x80, 0x80, 2, 0, 0x35, 0]);
        assert_eq!((producer.poll(CYCLE / 2, &image), producer.wake()), (None, CYCLE));
        assert_eq!(producer.poll(CYCLE, &image).unwrap()[53..55], [4, 0]);
    }

    #[test]
    fn skips_missed_frames_and_keeps_the_interval() {
        let mut producer = Producer::new(&settings(), Now::ZERO);
        producer.poll(Now::ZERO, &[0; 48]);
        let bytes = producer.poll(CYCLE * 4 + CYCLE / 2, &[0; 48]).unwrap();
        assert_eq!((bytes[53..55].to_vec(), producer.skipped, producer.wake()), (vec![10, 0], 3, CYCLE * 5));
        assert_eq!(producer.poll(CYCLE * 4 + CYCLE / 2, &[0; 48]), None);
    }

    #[test]
    fn cycle_counters_wrap() {
        let mut producer = Producer::new(&settings(), Now::ZERO);
        let mut consumer = Consumer::new(&settings());
        for index in 0..1000u32 {
            let bytes = producer.poll(CYCLE * index, &[1; 48]).unwrap();
            let counter = u16::from_be_bytes([bytes[53], bytes[54]]);
            let verdict = consumer.handle(CYCLE * index, &input(counter, 0x35));
            assert_eq!(verdict, FrameResult::Image(vec![5; 48]), "{index}");
        }
        assert_eq!((producer.sent, consumer.received, consumer.stale), (1000, 1000, 0));
    }

    fn input(counter: u16, status: u8) -> Vec<u8> {
        let mut data = vec![0x80; 3];
        data.extend([5; 48]);
        data.extend([0x80, 0x80]);
        Cyclic { data: &data, counter, status, transfer: 0 }.emit()
    }

    #[test]
    fn accepts_only_good_data() {
        let mut consumer = Consumer::new(&settings());
        assert_eq!(consumer.handle(Now::ZERO, &input(0x200, 0x35)), FrameResult::Image(vec![5; 48]));
        assert_eq!(consumer.handle(Now::ZERO, &input(0x200, 0x35)), FrameResult::Stale);
        assert_eq!(consumer.handle(Now::ZERO, &input(0x100, 0x35)), FrameResult::Stale);
        assert_eq!(consumer.handle(Now::ZERO, &[0; 20]), FrameResult::Stale);
        let stop = consumer.handle(CYCLE, &input(0x400, 0x25));
        assert_eq!((stop, consumer.last_frame_at), (FrameResult::Unusable(Unusable::Status(0x25, 0)), Some(CYCLE)));
        let mut bad = input(0x600, 0x35);
        bad[51] = 0;
        assert_eq!(consumer.handle(CYCLE, &bad), FrameResult::Unusable(Unusable::Provider(1, 1)));
        let mut deaf = input(0x800, 0x35);
        deaf[52] = 0x60;
        assert_eq!(consumer.handle(CYCLE, &deaf), FrameResult::Unusable(Unusable::Consumer(2, 1)));
        let mut head = input(0xA00, 0x35);
        head[0] = 0;
        assert_eq!(consumer.handle(CYCLE, &head), FrameResult::Image(vec![5; 48]), "the head has no data to be bad");
    }
}
