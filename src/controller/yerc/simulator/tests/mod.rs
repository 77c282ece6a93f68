//! Tests of the simulator by datagrams, in virtual time.

use std::time::Duration;

use super::*;
use crate::testing::hex;
use crate::yerc::Model;
use crate::yerc::payload::{
    AxisNames, CartesianMove, ControllerStatus, JobInfo, MoveLayout, Position, PulseMove, StatusBit,
};

mod files;
mod life;
mod motion;
mod replay;
mod robot;
mod survival;

const PEER: u64 = 7;

/// A simulator with a clock.
struct Bench {
    simulator: Simulator,
    now: Now,
}

impl Default for Bench {
    fn default() -> Self {
        Self::new("")
    }
}

impl Bench {
    fn new(start: &str) -> Self {
        let start = Start::parse(start, |path| Err(format!("no {path} here"))).unwrap();
        Self { simulator: Simulator::new(start), now: Now::ZERO }
    }

    fn wait(&mut self, millis: u64) {
        self.now += Duration::from_millis(millis);
        self.simulator.advance(self.now);
    }

    fn console(&mut self, line: &str) -> String {
        self.simulator.console(self.now, line).unwrap()
    }

    /// Sends a datagram and returns all immediate answers.
    fn exchange(&mut self, division: Division, peer: u64, bytes: &[u8]) -> Vec<Vec<u8>> {
        self.simulator.receive(self.now, division, peer, bytes);
        self.waiting()
    }

    fn waiting(&mut self) -> Vec<Vec<u8>> {
        std::iter::from_fn(|| self.simulator.transmit(self.now)).map(|outgoing| outgoing.bytes).collect()
    }

    /// Sends a robot request and returns the status and the data.
    fn ask(&mut self, command: u16, instance: u16, attribute: u8, service: u8, data: &[u8]) -> (Status, Vec<u8>) {
        let frame = RequestFrame {
            division: Division::Robot,
            ack: false,
            id: 9,
            block: 0,
            command,
            instance,
            attribute,
            service,
            data,
        };
        let frames = self.exchange(Division::Robot, PEER, &frame.emit());
        let answer = AnswerFrame::parse(&frames[0]).unwrap();
        assert_eq!((frames.len(), answer.id, answer.block, answer.service), (1, 9, LAST_BLOCK, service | 0x80));
        (answer.status, answer.data.to_vec())
    }

    fn read(&mut self, command: u16, instance: u16) -> Vec<u8> {
        let (status, data) = self.ask(command, instance, 0, 0x01, &[]);
        assert_eq!(status, Status::OK, "{command:#x} {instance}");
        data
    }

    fn write(&mut self, command: u16, instance: u16, attribute: u8, service: u8, data: &[u8]) -> Status {
        self.ask(command, instance, attribute, service, data).0
    }

    fn set_word(&mut self, command: u16, instance: u16, value: u32) -> Status {
        self.write(command, instance, 1, 0x10, &value.to_le_bytes())
    }

    fn status(&mut self) -> ControllerStatus {
        ControllerStatus::parse(&self.read(0x72, 1)).unwrap()
    }

    fn pose(&mut self, instance: u16) -> Vec<i32> {
        let names = AxisNames::parse(&self.read(0x74, instance)).unwrap().names;
        let fitted = names.iter().filter(|name| !name.is_empty()).count();
        Position::parse(&self.read(0x75, instance)).unwrap().axes.as_slice()[..fitted].to_vec()
    }

    fn job(&mut self) -> JobInfo {
        JobInfo::parse(&self.read(0x73, 1)).unwrap()
    }

    fn select(&mut self, name: &[u8], line: u32) -> Status {
        let mut data = [0; 36];
        data[..name.len()].copy_from_slice(name);
        data[32..].copy_from_slice(&line.to_le_bytes());
        self.write(0x87, 1, 0, 0x02, &data)
    }

    fn start(&mut self) -> Status {
        self.set_word(0x86, 1, 1)
    }

    /// Sends a frame to the file server.
    fn file(&mut self, peer: u64, id: u8, ack: bool, service: u8, block: u32, data: &[u8]) -> Vec<Vec<u8>> {
        let division = Division::File;
        let frame = RequestFrame { division, ack, id, block, command: 0, instance: 0, attribute: 0, service, data };
        self.exchange(division, peer, &frame.emit())
    }

    /// Sends a frame and returns the only answer of the file server.
    fn file_one(&mut self, ack: bool, service: u8, block: u32, data: &[u8]) -> (Status, u32, Vec<u8>) {
        let frames = self.file(PEER, 3, ack, service, block, data);
        assert_eq!(frames.len(), 1);
        let answer = AnswerFrame::parse(&frames[0]).unwrap();
        (answer.status, answer.block, answer.data.to_vec())
    }

    /// Fetches a complete list or file.
    fn fetch(&mut self, service: u8, name: &[u8]) -> Result<Vec<u8>, Status> {
        let mut content = Vec::new();
        let (mut status, mut block, mut data) = self.file_one(false, service, 0, name);
        for number in 1.. {
            if status != Status::OK {
                return Err(status);
            }
            assert_eq!(block & !LAST_BLOCK, number);
            content.append(&mut data);
            if block & LAST_BLOCK != 0 {
                assert!(self.file(PEER, 3, true, service, block, &[]).is_empty());
                break;
            }
            (status, block, data) = self.file_one(true, service, block, &[]);
        }
        Ok(content)
    }

    /// Loads a file in blocks of `size`.
    fn load(&mut self, name: &[u8], content: &[u8], size: usize) -> Status {
        let (status, block, _) = self.file_one(false, 0x15, 0, name);
        if !status.is_ok() {
            return status;
        }
        assert_eq!(block, 0);
        let blocks = content.len().div_ceil(size);
        for (number, piece) in (1u32..).zip(content.chunks(size)) {
            let last = if usize::try_from(number).unwrap() == blocks { LAST_BLOCK } else { 0 };
            let (status, acknowledged, _) = self.file_one(true, 0x15, number | last, piece);
            assert_eq!(acknowledged & !LAST_BLOCK, if status.is_ok() || last != 0 { number } else { 0 });
            if !status.is_ok() || last != 0 {
                return status;
            }
        }
        panic!("an empty file has no blocks");
    }
}

fn refused(added: u16) -> Status {
    Status::refused(added)
}

fn plain(code: u8) -> Status {
    Status { code, ..Status::OK }
}

fn cartesian(instance_speed: (u32, u32), coordinate: u32, target: [i32; 6]) -> CartesianMove {
    use crate::yerc::payload::{ExtendedForm, Form, PositionKind, SpeedClass};
    CartesianMove {
        layout: MoveLayout::Words26,
        robot: 1,
        station: 0,
        class: SpeedClass::from_word(instance_speed.0),
        speed: instance_speed.1,
        coordinate: PositionKind::from_word(coordinate),
        target,
        reserved: [0, 0],
        form: Form(0),
        extended: ExtendedForm(0),
        tool: 0,
        user: 0,
        base: [0; 3],
        station_axes: [0; 6],
    }
}

/// A straight move of Y by +500 mm at 100 mm/s. It takes five seconds.
fn five_seconds() -> CartesianMove {
    cartesian((1, 1000), 16, [1_000_000, 500_000, 1_200_000, 1_800_000, 0, 0])
}
