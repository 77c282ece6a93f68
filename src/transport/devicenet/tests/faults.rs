//! Connections on a bus that loses, doubles, delays and reorders frames.

use std::time::Duration;

use super::world::{LINK, Line, MS, SECOND, World, resting};
use crate::devicenet::scanner::State;

const KINDS: [Line; 5] = [
    Line { drop: 100, duplicate: 0, late: 0, swap: 0, reorder: 0 },
    Line { drop: 0, duplicate: 300, late: 0, swap: 0, reorder: 0 },
    Line { drop: 0, duplicate: 0, late: 200, swap: 0, reorder: 0 },
    Line { drop: 0, duplicate: 0, late: 0, swap: 200, reorder: 0 },
    Line { drop: 100, duplicate: 100, late: 100, swap: 100, reorder: 0 },
];

/// Sends numbered images for two seconds. Each image is sent only after the previous one is confirmed, as with
/// commands. The master must not confirm an image that the slave did not receive.
fn numbered(line: Line, seed: u64, size: u16, context: &str) -> World {
    let mut world = World::linked(size, seed);
    world.line = line;
    let mut number = 0u8;
    let mut waits: Option<(u32, u64)> = None;
    let end = world.now + SECOND * 2;
    while world.now < end {
        world.run(MS);
        let view = world.view();
        if let Some((generation, change)) = waits {
            if view.generation != generation || view.state != State::Open {
                waits = None;
            } else if view.sent >= change {
                waits = None;
                let was_taken = world.mirror().history.iter().any(|(_, image)| image[1] == number);
                assert!(was_taken, "{context}: {number} is told to have been taken");
            }
        } else if view.state == State::Open {
            number += 1;
            let mut image = resting(size.into());
            image[1..].fill(number);
            let change = world.scanner.set_image(LINK, view.generation, &image).unwrap();
            waits = Some((view.generation, change));
        }
    }
    assert!(number > 10, "{context}: only {number} images in 2 s");
    world
}

/// On every bus, the slave receives the images in order. After it has received a later image, it does not receive an
/// earlier image again.
#[test]
fn delivers_each_image_once_and_correctly() {
    for (kind, line) in KINDS.iter().enumerate() {
        for seed in 0..16 {
            for size in [48u16, 4] {
                let context = format!("kind {kind}, seed {seed}, size {size}");
                let mut world = numbered(*line, seed, size, &context);
                let mut last = 0;
                for (at, image) in &world.mirror().history {
                    if *image == resting(size.into()) {
                        continue;
                    }
                    assert!(image[1..].iter().all(|byte| *byte == image[1]) || size > 8, "{context}: {image:?}");
                    assert!(image[1] >= last, "{context}: {} after {last} at {at:?}", image[1]);
                    last = image[1];
                }
            }
        }
    }
}

/// Frames with the same identifier overtake each other. Within a fragmented image, the fragment counts reveal this, so
/// no command is mixed or repeated. Two cases cannot be detected, because the frames look the same. First, the last
/// fragment of one image can replace the last fragment of the next image (six bytes of general-purpose signals).
/// Second, an image in a single frame (4 bytes, without commands) can return for one cycle.
#[test]
fn reordered_frames_cause_no_command() {
    /// Offset of the last fragment in an image.
    const LAST: usize = 42;

    for seed in 0..32 {
        for reorder in [20, 100, 300] {
            let line = Line { reorder, ..Line::default() };
            let context = format!("{reorder} of 10,000, seed {seed}");
            let mut world = numbered(line, seed, 48, &context);
            let mut last = 0;
            for (at, image) in &world.mirror().history {
                if image[1] == 0 {
                    continue;
                }
                assert!(image[1..LAST].iter().all(|byte| *byte == image[1]), "{context}: {image:?} at {at:?}");
                assert!(image[LAST..].iter().all(|byte| *byte == image[LAST]), "{context}: {image:?} at {at:?}");
                assert!(image[1] >= last, "{context}: {} after {last} at {at:?}", image[1]);
                last = image[1];
            }
            numbered(line, seed, 4, &context);
        }
    }
}

/// Half an hour of polls with 1 % lost frames. The small images run for a shorter time.
#[test]
fn half_an_hour_at_one_percent_loses_no_image_and_does_not_drift() {
    polls_at_one_percent(4, SECOND * 180);
    polls_at_one_percent(48, SECOND * 1800);
}

fn polls_at_one_percent(size: u16, time: Duration) {
    let mut world = World::linked(size, 4);
    world.line = Line { drop: 100, ..Line::default() };
    let start = world.now;
    let (mut shown, mut taken) = (0u32, 0u32);
    while world.now < start + time {
        let mut image = resting(size.into());
        image[1..3].copy_from_slice(&shown.to_le_bytes()[..2]);
        shown += 1;
        let change = world.scanner.set_image(LINK, 1, &image).unwrap();
        world.until(SECOND, |world| world.view().sent >= change);
        taken += u32::from(world.mirror().image == image);
        world.run(MS * 500);
    }
    let view = world.view();
    assert_eq!((view.state, view.generation), (State::Open, 1), "{:?}", view.last_error);
    assert_eq!(shown, taken);
    // There is one poll every 20 ms. Only a poll after a missing answer is later.
    let all = world.now.saturating_sub(start).as_millis() / 20;
    assert!(
        u128::from(view.statistics.sent + view.statistics.skipped).abs_diff(all) < 10,
        "{:?} {all}",
        view.statistics
    );
}

/// An exchange takes only the time of its bits: 14 frames and the gap between polls.
#[test]
fn exchange_time_is_close_to_its_bits() {
    let mut world = World::linked(48, 1);
    world.trace.clear();
    let busy = world.bus.busy();
    world.run(SECOND);
    let polls = world.trace.iter().filter(|(_, frame)| frame.id() == 0x42D && frame.data()[0] == 0).count();
    assert_eq!(polls, 50);
    let each = world.bus.busy().saturating_sub(busy) / 50;
    assert!((MS * 3..MS * 4).contains(&each), "{each:?}");
    // The time is measured from the first bit of a poll to the last bit of its answer.
    let first = world.trace.iter().position(|(_, frame)| frame.id() == 0x42D && frame.data()[0] == 0).unwrap();
    let (begin, end) = (world.trace[first].0, world.trace[first + 13].0);
    assert_eq!(world.trace[first + 13].1.id(), 0x3C5);
    let took = end.saturating_sub(begin);
    assert!(took < each * 11 / 10, "{took:?} {each:?}");
}
