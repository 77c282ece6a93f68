//! Placeholder while the simulator is written.
use super::request::{Answer, Request};
use super::session::{Framed, Framer};
use super::table::Command;
use crate::controller::Now;
/// x
#[derive(Debug, Clone, Default)]
pub struct Start;
impl Start {
    /// x
    pub fn with_axes(self, _: u8) -> Self {
        self
    }
    /// x
    pub fn with_busy(self, _: f64) -> Self {
        self
    }
    /// x
    pub fn parse(_: &str) -> Result<Self, String> {
        Ok(Self)
    }
}
/// x
#[derive(Debug, Default)]
pub struct Simulator {
    framer: Framer,
    out: Vec<Vec<u8>>,
    host: bool,
}
impl Simulator {
    /// x
    pub fn new(_: Start) -> Self {
        Self::default()
    }
    /// x
    pub fn receive(&mut self, _: Now, bytes: &[u8]) {
        for b in bytes {
            if let (Some(Framed::Block(block)), _) = self.framer.push(*b) {
                let Ok(request) = Request::parse(&block) else {
                    self.out.push(b"@NG\r\n".to_vec());
                    continue;
                };
                let page = request.record().number("page").unwrap_or(0);
                let text = match request.command() {
                    Command::Hson => {
                        self.host = true;
                        Answer::Done.text()
                    }
                    Command::Hsof => {
                        self.host = false;
                        Answer::Done.text()
                    }
                    Command::Stas => format!(
                        "@STAS SNO={page} ST1={} ST2=00",
                        match page {
                            0 => "30",
                            2 if self.host => "80",
                            3 => "11",
                            _ => "00",
                        }
                    ),
                    Command::Mpst => "@MPST X=+0000.00 Y=+0000.00 Z=+0000.00 R=+0000.00".to_owned(),
                    _ if request.row().is_order() => Answer::Done.text(),
                    _ => Answer::Refused.text(),
                };
                self.out.push(format!("{text}\r\n").into_bytes());
            }
        }
    }
    /// x
    pub fn damaged(&mut self, _: Now) {}
    /// x
    pub fn transmit(&mut self, _: Now) -> Option<Vec<u8>> {
        if self.out.is_empty() { None } else { Some(self.out.remove(0)) }
    }
    /// x
    pub fn wake(&self) -> Option<Now> {
        None
    }
}
