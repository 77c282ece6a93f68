//! Passive listener: receives the data exchange of a PLC and its slave, and sends nothing. It can be used while another
//! master is on the line.

use std::sync::Arc;

use super::wire::{Control, Frame, Piece, Service, Status, Stream, Telegram};

/// Traffic that was received so far.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct BusTraffic {
    /// Last input image of the slave.
    pub input: Option<Arc<[u8]>>,
    /// Last output image of the slave.
    pub output: Option<Arc<[u8]>>,
    /// Master that sends the output image.
    pub master: Option<u8>,
    /// Number of telegrams of any type.
    pub telegrams: u64,
    /// Number of data exchanges of the slave.
    pub exchanges: u64,
    /// Number of bytes that are not part of a telegram.
    pub noise: u64,
}

/// Listener for one station.
#[derive(Debug)]
pub struct Listener {
    station: u8,
    stream: Stream,
    /// Last request for a data exchange that has no answer yet: its master, and the output image.
    last_request: Option<(u8, Vec<u8>)>,
    /// Traffic that was received so far.
    pub heard: BusTraffic,
}

impl Listener {
    /// Creates a listener for the slave with this address.
    pub fn new(station: u8) -> Self {
        Self { station, stream: Stream::default(), last_request: None, heard: BusTraffic::default() }
    }

    /// Handles received bytes. Returns whether they complete a new data exchange.
    pub fn handle(&mut self, bytes: &[u8]) -> bool {
        let before = self.heard.exchanges;
        self.stream.push(bytes);
        while let Some(piece) = self.stream.next_piece() {
            match piece {
                Piece::Noise(..) => self.heard.noise += 1,
                Piece::Telegram(telegram, _) => {
                    self.heard.telegrams += 1;
                    self.take(telegram);
                }
            }
        }
        self.heard.exchanges != before
    }

    fn take(&mut self, telegram: Telegram) {
        let Telegram::Frame(frame) = telegram else { return };
        match frame {
            Frame { to, from, control: Control::Request(service, _), to_sap: None, from_sap: None, data }
                if to == self.station && matches!(service, Service::SendRequestHigh | Service::SendRequestLow) =>
            {
                self.last_request = Some((from, data));
            }
            // A data exchange is complete only when the answer to the last request arrives. Until then, the slave may
            // not have accepted the image.
            Frame {
                to,
                from,
                control: Control::Answer(_, Status::Data | Status::DataHigh),
                to_sap: None,
                from_sap: None,
                data,
            } if from == self.station => {
                let Some((master, output)) = self.last_request.take_if(|last_request| last_request.0 == to) else {
                    return;
                };
                self.heard.master = Some(master);
                self.heard.output = Some(output.into());
                self.heard.input = Some(data.into());
                self.heard.exchanges += 1;
            }
            _ => self.last_request = None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::hex;

    #[test]
    fn listener_finds_both_images_in_other_traffic() {
        let line = hex(concat!(
            "DC 02 02 FF 10 05 02 49 50 16",
            "68 06 06 68 05 02 7D 01 02 03 8A 16",
            "68 05 05 68 02 05 08 AA BB 74 16",
            "68 05 05 68 07 02 7D 01 02 89 16",
            "68 05 05 68 02 07 08 01 02 14 16",
        ));
        let mut listener = Listener::new(5);
        // The test passes the bytes one at a time.
        let news = line.iter().filter(|byte| listener.handle(&[**byte])).count();
        let heard = listener.heard;
        assert_eq!((news, heard.exchanges, heard.telegrams, heard.noise), (1, 1, 6, 1));
        assert_eq!(
            (heard.master, heard.output.as_deref(), heard.input.as_deref()),
            (Some(2), Some(&[1, 2, 3][..]), Some(&[0xAA, 0xBB][..]),)
        );
    }

    #[test]
    fn ignores_answers_to_other_requests_of_the_bus() {
        let mut listener = Listener::new(5);
        // Either the request to this answer was not received, or another station answered. So the answer is not used.
        assert!(!listener.handle(&hex("68 05 05 68 02 05 08 AA BB 74 16")));
        assert!(!listener.handle(&hex("68 05 05 68 05 02 7D 01 02 87 16 10 05 02 49 50 16")));
        assert!(!listener.handle(&hex("68 05 05 68 02 05 08 AA BB 74 16")));
        assert_eq!(listener.heard.input, None);
    }
}
