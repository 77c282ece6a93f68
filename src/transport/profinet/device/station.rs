//! DCP in the simulated device: identity, name, IP address.

use super::super::Now;
use super::super::wire::dcp::{self, Block, Dcp, IpSuite, Kind, Service, Setting};
use super::super::wire::frame::{Frame, id};
use super::{Application, Device, Event, Fault, MAX_DELAYED, MAX_RESPONSE_DELAY, RESPONSE_DELAY_STEP};

/// DCP error codes.
const UNKNOWN_OPTION: u8 = 1;
const UNKNOWN_SETTING: u8 = 2;
const NOT_TAKEN: u8 = 3;
const LOCAL_REASONS: u8 = 5;
const IN_OPERATION: u8 = 6;

impl<A: Application> Device<A> {
    pub(super) fn handle_identify(&mut self, now: Now, frame: &Frame<'_>) {
        let Ok(dcp) = Dcp::parse(frame.payload) else { return };
        if dcp.service != Service::Identify || dcp.kind != Kind::Request || !self.is_addressee(&dcp) {
            return;
        }
        let settings = [
            Setting::NAME,
            Setting::OPTIONS,
            Setting::STATION_TYPE,
            Setting::DEVICE_ID,
            Setting::ROLE,
            Setting::INSTANCE,
            Setting::IP,
        ];
        let blocks = settings.iter().filter_map(|setting| self.value(*setting)).collect();
        let payload = dcp.answer(blocks).emit();
        let answer = self.frame_to(frame.source, None, id::DCP_IDENTIFIED, &payload);
        let spread = u32::from(self.setup.mac.0[5]) % u32::from(dcp.delay.clamp(1, MAX_RESPONSE_DELAY));
        if self.delayed_frames.len() < MAX_DELAYED {
            self.delayed_frames.push((now + RESPONSE_DELAY_STEP * spread, answer));
        }
    }

    /// Whether a request is for this device. This is so if all filters of the request match. A request with a delay of
    /// 0 is not valid.
    fn is_addressee(&self, dcp: &Dcp) -> bool {
        let setup = &self.setup;
        let id = [setup.id.0.to_be_bytes(), setup.id.1.to_be_bytes()].concat();
        let fits = |block: &Block| match block.setting {
            Setting::ALL => dcp.blocks.len() == 1 && block.data.is_empty(),
            Setting::NAME => block.data == setup.name.as_bytes() && !setup.name.is_empty(),
            Setting::STATION_TYPE => block.data == setup.kind.as_bytes(),
            Setting::DEVICE_ID => block.data == id,
            _ => false,
        };
        dcp.delay != 0 && !dcp.blocks.is_empty() && dcp.blocks.iter().all(fits)
    }

    fn value(&self, setting: Setting) -> Option<Block> {
        let setup = &self.setup;
        let value = |bytes: &[u8]| Some(Block::value(setting, 0, bytes));
        match setting {
            Setting::NAME => value(setup.name.as_bytes()),
            Setting::OPTIONS => value(&[1, 2, 2, 2, 2, 3]),
            Setting::STATION_TYPE => value(setup.kind.as_bytes()),
            Setting::DEVICE_ID => value(&[setup.id.0.to_be_bytes(), setup.id.1.to_be_bytes()].concat()),
            Setting::ROLE => value(&[1, 0]),
            Setting::INSTANCE => value(&setup.instance.to_be_bytes()),
            Setting::MAC => value(&setup.mac.0),
            Setting::IP => {
                let none = [0; 12];
                let bytes = setup.ip.map_or(none, |suite| suite.bytes());
                Some(Block::value(setting, u16::from(setup.ip.is_some()), &bytes))
            }
            _ => None,
        }
    }

    pub(super) fn handle_get_set(&mut self, now: Now, frame: &Frame<'_>) {
        let Ok(dcp) = Dcp::parse(frame.payload) else { return };
        if dcp.kind != Kind::Request {
            return;
        }
        let blocks: Vec<Block> = match dcp.service {
            Service::Get => {
                let answer = |block: &Block| {
                    let unknown = Block::response(block.setting, UNKNOWN_SETTING);
                    self.value(block.setting).unwrap_or(unknown)
                };
                dcp.blocks.iter().map(answer).collect()
            }
            Service::Set => {
                dcp.blocks.iter().map(|block| Block::response(block.setting, self.set(now, block))).collect()
            }
            Service::Identify | Service::Hello => return,
        };
        let payload = dcp.answer(blocks).emit();
        let answer = self.frame_to(frame.source, None, id::DCP_GET_SET, &payload);
        self.actions.push_back(super::Action::Frame(answer));
    }

    /// Sets a value. Returns 0 after success, or the DCP error code.
    fn set(&mut self, now: Now, block: &Block) -> u8 {
        let Some((qualifier, value)) = block.data.split_first_chunk::<2>() else { return NOT_TAKEN };
        let is_permanent = qualifier[1] & 1 == 1;
        match block.setting {
            Setting::NAME | Setting::IP if self.ar.is_some() => IN_OPERATION,
            Setting::NAME => {
                let Ok(name) = std::str::from_utf8(value) else { return NOT_TAKEN };
                if !name.is_empty() && dcp::check_name(name).is_err() {
                    return NOT_TAKEN;
                }
                name.clone_into(&mut self.setup.name);
                self.application.event(now, &Event::Named(name.to_owned(), is_permanent));
                0
            }
            Setting::IP => {
                let Ok(suite) = IpSuite::parse(value) else { return NOT_TAKEN };
                let is_same = self.setup.ip.is_some_and(|own| own.address == suite.address);
                let is_kept = !self.setup.takes_ip || self.fault == Some(Fault::KeepsAddress);
                if is_kept && !is_same {
                    return LOCAL_REASONS;
                }
                if value.len() != 12 || suite.address.is_multicast() {
                    return NOT_TAKEN;
                }
                self.setup.ip = Some(suite).filter(|suite| !suite.address.is_unspecified());
                self.application.event(now, &Event::Addressed(suite, is_permanent));
                0
            }
            Setting::SIGNAL if value == [1, 0] => {
                self.application.event(now, &Event::Blink);
                0
            }
            Setting::RESET if *qualifier == [0, 4] && value.is_empty() => {
                self.abort(now, 0x20);
                self.setup.name.clear();
                if self.setup.takes_ip {
                    self.setup.ip = None;
                }
                self.application.event(now, &Event::Reset);
                0
            }
            Setting::SIGNAL | Setting::RESET => NOT_TAKEN,
            Setting(1 | 2 | 5, _) => UNKNOWN_SETTING,
            Setting(..) => UNKNOWN_OPTION,
        }
    }
}
