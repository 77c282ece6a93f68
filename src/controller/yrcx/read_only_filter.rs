//! Filter for a read-only link: decides which images may pass to the controller.

use super::image::{COMMAND_WORDS, Image};
use super::signal::input;

/// Whether a change of the image only stops the robot. It must contain no command, and switch nothing except SI(00) or
/// SI(06) off.
pub fn only_stops(before: &[u8], after: &[u8]) -> bool {
    let image = |bytes: &[u8]| Image::from_link(bytes).unwrap_or_default();
    let (before, after) = (image(before), image(after));
    let mut still = before;
    for stop in [input::EMERGENCY_STOP, input::STOP] {
        stop.set(&mut still, stop.is_on(&before) && stop.is_on(&after));
    }
    after.0[..COMMAND_WORDS].iter().all(|word| *word == 0) && after.0[COMMAND_WORDS..] == still.0[COMMAND_WORDS..]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::yrcx::signal::resting;

    fn passes(change: impl FnOnce(&mut Image)) -> bool {
        let before = resting();
        let mut after = before;
        change(&mut after);
        only_stops(&before.to_bytes(), &after.to_bytes())
    }

    #[test]
    fn stops_pass_and_nothing_else() {
        assert!(passes(|_| ()));
        assert!(passes(|image| input::STOP.set(image, false)));
        assert!(passes(|image| input::EMERGENCY_STOP.set(image, false)));
        assert!(!passes(|image| image.0[0] = 1));
        assert!(!passes(|image| image.0[COMMAND_WORDS] |= 2));
        let mut stopped = resting();
        input::STOP.set(&mut stopped, false);
        assert!(!only_stops(&stopped.to_bytes(), &resting().to_bytes()), "a stop is not taken back");
        assert!(only_stops(&resting().to_link(4), &stopped.to_link(4)), "where signals are alone, too");
        assert!(!only_stops(&stopped.to_link(4), &resting().to_link(4)));
    }
}
