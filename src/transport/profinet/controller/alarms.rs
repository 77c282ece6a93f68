//! Alarm state machine of the controller. It reports each alarm once. It acknowledges first the frame and then the
//! alarm, and repeats its own frames.

use std::time::Duration;

use super::super::Now;
use super::super::wire::alarm::{self, Notification, Pdu, Priority, Rta};

/// Time limit for an acknowledgement.
const ACK_TIMEOUT: Duration = Duration::from_millis(100);
/// Number of repetitions of a frame.
const RETRIES: u32 = 3;
/// Maximum number of queued acknowledgements. A device may have only one unacknowledged alarm per channel.
const MAX_QUEUED_ACKS: usize = 8;

/// One alarm channel.
#[derive(Debug)]
struct Channel {
    priority: Priority,
    /// Sequence number of the last frame of the controller; [`alarm::NONE`] before the first frame.
    sent: u16,
    /// Sequence number of the last frame of the device; [`alarm::NONE`] before the first frame.
    received: u16,
    /// Frame of the controller that waits for its acknowledgement.
    pending: Option<Pending>,
    waiting: Vec<Vec<u8>>,
}

#[derive(Debug)]
struct Pending {
    data: Vec<u8>,
    deadline: Now,
    repeats: u32,
}

/// Both alarm channels of a connection.
#[derive(Debug)]
pub struct Alarms {
    local_reference: u16,
    remote_reference: u16,
    channels: [Channel; 2],
}

/// Result of a received frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum AlarmEvent {
    /// There is nothing to report.
    Nothing,
    /// A new alarm.
    Alarm(Notification),
    /// The device has closed the connection.
    Error(u32),
}

impl Alarms {
    /// Creates the channels with the alarm references of both sides.
    pub fn new(local_reference: u16, remote_reference: u16) -> Self {
        let channel = |priority| Channel {
            priority,
            sent: alarm::NONE,
            received: alarm::NONE,
            pending: None,
            waiting: Vec::new(),
        };
        Self { local_reference, remote_reference, channels: Priority::ALL.map(channel) }
    }

    /// Handles a frame. Frames to send are added to `out` with their channel.
    pub fn handle(
        &mut self,
        now: Now,
        priority: Priority,
        payload: &[u8],
        out: &mut Vec<(Priority, Vec<u8>)>,
    ) -> AlarmEvent {
        let Ok(rta) = Rta::parse(payload) else { return AlarmEvent::Nothing };
        if rta.destination != self.local_reference {
            return AlarmEvent::Nothing;
        }
        let (local_reference, remote_reference) = (self.local_reference, self.remote_reference);
        let channel = &mut self.channels[usize::from(priority == Priority::Low)];
        match rta.pdu {
            Pdu::Error(status) => AlarmEvent::Error(status),
            Pdu::Ack => {
                channel.acknowledged(rta.acknowledged);
                channel.next(now, local_reference, remote_reference, out);
                AlarmEvent::Nothing
            }
            Pdu::Nack => AlarmEvent::Nothing,
            Pdu::Data(data) => {
                channel.acknowledged(rta.acknowledged);
                let expected = match channel.received {
                    alarm::NONE => alarm::FIRST,
                    last => alarm::next_sequence(last),
                };
                let is_new = rta.sequence == expected;
                if !is_new && rta.sequence != channel.received {
                    return AlarmEvent::Nothing;
                }
                channel.received = rta.sequence;
                out.push((priority, channel.frame(local_reference, remote_reference, Pdu::Ack)));
                let alarm = Notification::parse(&data).ok().filter(|_| is_new);
                if let Some(alarm) = &alarm
                    && channel.waiting.len() < MAX_QUEUED_ACKS
                {
                    channel.waiting.push(alarm.acknowledge().emit());
                }
                channel.next(now, local_reference, remote_reference, out);
                alarm.map_or(AlarmEvent::Nothing, AlarmEvent::Alarm)
            }
        }
    }

    /// Repeats frames that timed out. Returns whether the device did not accept an acknowledgement after the last
    /// repetition.
    pub fn poll(&mut self, now: Now, out: &mut Vec<(Priority, Vec<u8>)>) -> bool {
        let (local_reference, remote_reference) = (self.local_reference, self.remote_reference);
        let mut is_lost = false;
        for channel in &mut self.channels {
            let Some(pending) = channel.pending.as_mut().filter(|pending| pending.deadline <= now) else { continue };
            if pending.repeats == RETRIES {
                is_lost = true;
                channel.pending = None;
                continue;
            }
            pending.repeats += 1;
            pending.deadline = now + ACK_TIMEOUT;
            let data = pending.data.clone();
            out.push((channel.priority, channel.frame(local_reference, remote_reference, Pdu::Data(data))));
        }
        is_lost
    }

    /// Time of the next [`poll`](Self::poll).
    pub fn wake(&self) -> Option<Now> {
        self.channels.iter().filter_map(|channel| channel.pending.as_ref()).map(|pending| pending.deadline).min()
    }

    /// Returns the frame that closes the connection.
    pub fn error(&self, status: u32) -> (Priority, Vec<u8>) {
        let low = &self.channels[1];
        (low.priority, low.frame(self.local_reference, self.remote_reference, Pdu::Error(status)))
    }
}

impl Channel {
    fn frame(&self, local_reference: u16, remote_reference: u16, pdu: Pdu) -> Vec<u8> {
        let (sequence, acknowledged) = (self.sent, self.received);
        Rta { destination: remote_reference, source: local_reference, sequence, acknowledged, pdu }.emit()
    }

    fn acknowledged(&mut self, sequence: u16) {
        if sequence == self.sent {
            self.pending = None;
        }
    }

    /// Sends the next queued frame, if no frame waits for its acknowledgement.
    fn next(&mut self, now: Now, local_reference: u16, remote_reference: u16, out: &mut Vec<(Priority, Vec<u8>)>) {
        if self.pending.is_some() || self.waiting.is_empty() {
            return;
        }
        let data = self.waiting.remove(0);
        self.sent = match self.sent {
            alarm::NONE => alarm::FIRST,
            last => alarm::next_sequence(last),
        };
        out.push((self.priority, self.frame(local_reference, remote_reference, Pdu::Data(data.clone()))));
        self.pending = Some(Pending { data, deadline: now + ACK_TIMEOUT, repeats: 0 });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::hex;

    const FIRST: &str = concat!(
        "0001 0000 11 11 FFFF FFFE 0022 0002 001E 0100 0001 00000000 0001 0001 00000101 00000001 A800",
        "8000 0000 28000006",
    );

    fn handle(alarms: &mut Alarms, payload: &[u8]) -> (AlarmEvent, Vec<Vec<u8>>) {
        let mut out = Vec::new();
        let heard = alarms.handle(Now::ZERO, Priority::Low, payload, &mut out);
        (heard, out.into_iter().map(|(_, bytes)| bytes).collect())
    }

    /// Bytes that were sent to a device, from the notes on alarms.
    #[test]
    fn acknowledges_and_reports_an_alarm_once() {
        let mut alarms = Alarms::new(1, 0);
        let (heard, sent) = handle(&mut alarms, &hex(FIRST));
        assert!(matches!(heard, AlarmEvent::Alarm(alarm) if alarm.kind == 1));
        let ack = hex("0000 0001 13 01 FFFE FFFF 0000");
        let noted = hex("0000 0001 11 11 FFFF FFFF 0016 8002 0012 0100 0001 00000000 0001 0001 A800 00000000");
        assert_eq!(sent, [ack, noted]);
        let (heard, sent) = handle(&mut alarms, &hex(FIRST));
        assert_eq!((heard, sent.len()), (AlarmEvent::Nothing, 1), "acknowledged again, not reported again");
        handle(&mut alarms, &hex("0001 0000 13 01 FFFF FFFF 0000"));
        assert_eq!(alarms.wake(), None);
        let second = FIRST.replacen("FFFF FFFE", "0000 FFFF", 1);
        let (heard, sent) = handle(&mut alarms, &hex(&second));
        assert!(matches!(heard, AlarmEvent::Alarm(_)));
        assert_eq!(sent[1][6..10], hex("0000 0000")[..], "both counts go on");
    }

    #[test]
    fn repeats_an_acknowledgement_up_to_a_limit() {
        let mut alarms = Alarms::new(1, 0);
        let (_, sent) = handle(&mut alarms, &hex(FIRST));
        let mut now = Now::ZERO;
        for _ in 0..RETRIES {
            now = alarms.wake().unwrap();
            let mut out = Vec::new();
            assert!(!alarms.poll(now, &mut out));
            assert_eq!(out, [(Priority::Low, sent[1].clone())]);
        }
        assert!(alarms.poll(now + ACK_TIMEOUT, &mut Vec::new()));
        assert_eq!(alarms.wake(), None);
    }

    #[test]
    fn ignores_alarms_of_other_connections_or_order() {
        let mut alarms = Alarms::new(2, 0);
        assert_eq!(handle(&mut alarms, &hex(FIRST)), (AlarmEvent::Nothing, Vec::new()));
        let mut alarms = Alarms::new(1, 0);
        let ahead = FIRST.replacen("FFFF FFFE", "0005 FFFE", 1);
        assert_eq!(handle(&mut alarms, &hex(&ahead)), (AlarmEvent::Nothing, Vec::new()));
        let error = hex("0001 0000 14 01 0000 0000 0004 CF81FD05");
        assert_eq!(handle(&mut alarms, &error), (AlarmEvent::Error(0xCF81_FD05), Vec::new()));
    }
}
