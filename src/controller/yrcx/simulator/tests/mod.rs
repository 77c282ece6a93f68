//! Tests of the simulator by images, in virtual time.

use std::time::Duration;

use super::*;
use crate::yrcx::answer::{Answer, Status};
use crate::yrcx::image::Words;
use crate::yrcx::order::Draft;
use crate::yrcx::signal::{Side, Signal, input, output, resting};
use crate::yrcx::table::Command;
use crate::yrcx::value::{Key, Values};

mod examples;
mod handshake;
mod life;
mod motion;
mod programs;
mod refusals;
mod replay;
mod sessions;
mod signals;

/// A simulator with a clock and a master.
struct Bench {
    simulator: Simulator,
    now: Now,
    image: Image,
}

impl Default for Bench {
    fn default() -> Self {
        Self::new("")
    }
}

impl Bench {
    fn new(start: &str) -> Self {
        let mut bench =
            Self { simulator: Simulator::new(Start::parse(start).unwrap()), now: Now::ZERO, image: resting() };
        bench.wait(200);
        bench
    }

    /// Sends the image for some time.
    fn wait(&mut self, millis: u64) {
        self.simulator.input(self.now, Some(&self.image));
        self.now += Duration::from_millis(millis);
        self.simulator.advance(self.now);
    }

    fn console(&mut self, line: &str) -> String {
        self.simulator.console(self.now, line).unwrap()
    }

    fn words(&self) -> Words {
        self.simulator.output().command()
    }

    fn is_on(&self, signal: Signal) -> bool {
        signal.is_on(self.simulator.output())
    }

    /// Switches an input and waits for the minimum edge interval.
    fn set(&mut self, signal: Signal, on: bool) {
        signal.set(&mut self.image, on);
        self.wait(120);
    }

    fn pulse(&mut self, signal: Signal) {
        self.set(signal, true);
        self.set(signal, false);
    }

    /// Sends a command for one scan.
    fn begin(&mut self, words: &Words) {
        let mut data = *words;
        data[0] = 0;
        self.image.set_command(&data);
        self.wait(5);
        self.image.set_command(words);
        self.wait(5);
    }

    /// Waits for the end of a command, and resets the status.
    fn end(&mut self) -> Words {
        for _ in 0..200_000 {
            if Status::from_word(self.words()[0]).is_end() {
                let words = self.words();
                self.image.set_command(&[0; 16]);
                self.wait(5);
                assert_eq!(self.words(), [0; 16], "ready after the status reset");
                return words;
            }
            assert_eq!(self.words()[0], 0x0100, "the run status until the end");
            self.wait(5);
        }
        panic!("never over");
    }

    /// Runs a command that is given as words.
    fn send(&mut self, words: &Words) -> Words {
        self.begin(words);
        self.end()
    }

    /// Runs a command.
    fn ask(&mut self, draft: Draft) -> Answer {
        let order = draft.build().unwrap();
        let words = self.send(order.words());
        Answer::parse(&order, &words).unwrap()
    }

    /// Asserts a normal end.
    fn done(&mut self, draft: Draft) -> Values {
        match self.ask(draft) {
            Answer::Done(values) => values,
            other => panic!("{other:?}: {}", self.console("why")),
        }
    }

    /// Asserts that a command is refused or aborted.
    fn refused(&mut self, draft: Draft) -> String {
        match self.ask(draft) {
            Answer::Refused { alarm, .. } => alarm.to_string(),
            other => panic!("{other:?}"),
        }
    }

    /// Position of a robot in pulses.
    fn pulses(&mut self, robot: i32) -> [i32; 4] {
        self.done(Command::PositionPulse.order().with(Key::Robot, robot)).axes().unwrap()
    }

    /// Position of a robot in 0.001 mm.
    fn steps(&mut self, robot: i32) -> [i32; 4] {
        self.done(Command::PositionMm.order().with(Key::Robot, robot)).axes().unwrap()
    }
}

/// Words that begin with `head`. All other words are 0.
fn words(head: &[u16]) -> Words {
    let mut words = [0; 16];
    words[..head.len()].copy_from_slice(head);
    words
}
