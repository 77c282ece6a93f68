//! Alarm state machine of the simulated device. It sends alarms and repeats them. If an alarm is not acknowledged, it
//! aborts the connection. Both channels work in the same way.

use std::time::Duration;

use super::super::Now;
use super::super::wire::alarm::{Acknowledgement, FIRST, NONE, Notification, Pdu, Priority, Rta};

#[derive(Debug, Default)]
struct Channel {
    /// Number of DATA frames that were sent. The field below is the number of DATA frames that were accepted.
    sent: u16,
    taken: u16,
    is_in_flight: Option<(Notification, Now, u16)>,
    /// Whether the frame was acknowledged, but not yet the alarm in the frame.
    is_framed: bool,
    waiting: Vec<Notification>,
}

/// Both channels of a connection.
#[derive(Debug)]
pub(super) struct Alarms {
    local_reference: u16,
    remote_reference: u16,
    timeout: Duration,
    retries: u16,
    channels: [Channel; 2],
}

/// Result of a received frame.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum AlarmEvent {
    Nothing,
    /// An alarm was acknowledged. Contains the frames to send, and the alarm.
    Noted(Vec<Vec<u8>>, Notification),
    /// The frame is a repetition. Contains the acknowledgement to send.
    Again(Vec<u8>),
    Ended(u32),
    /// The frame violates the protocol.
    Wrong,
}

/// Returns the sequence number of frame number `count`. Count 0 stands for no frame.
const fn number(count: u16) -> u16 {
    match count {
        0 => NONE,
        1 => FIRST,
        count => (count - 2) & 0x7FFF,
    }
}

/// Returns the next count. After the last sequence number, the count continues with the count of sequence number 0.
const fn next(count: u16) -> u16 {
    if number(count) == 0x7FFF { 2 } else { count + 1 }
}

impl Alarms {
    pub(super) fn new(local_reference: u16, remote_reference: u16, timeout: Duration, retries: u16) -> Self {
        Self { local_reference, remote_reference, timeout, retries, channels: Default::default() }
    }

    fn frame(&self, priority: Priority, pdu: Pdu) -> Vec<u8> {
        let channel = &self.channels[usize::from(priority == Priority::Low)];
        let (sequence, acknowledged) = (number(channel.sent), number(channel.taken));
        Rta { destination: self.remote_reference, source: self.local_reference, sequence, acknowledged, pdu }.emit()
    }

    pub(super) fn error(&self, status: u32) -> Vec<u8> {
        self.frame(Priority::Low, Pdu::Error(status))
    }

    pub(super) fn raise(&mut self, now: Now, alarm: &Notification) -> Option<Vec<u8>> {
        let priority = alarm.priority;
        let timeout = self.timeout;
        let channel = &mut self.channels[usize::from(priority == Priority::Low)];
        if channel.is_in_flight.is_some() {
            channel.waiting.push(alarm.clone());
            return None;
        }
        channel.sent = next(channel.sent);
        channel.is_framed = false;
        channel.is_in_flight = Some((alarm.clone(), now + timeout, 0));
        Some(self.frame(priority, Pdu::Data(alarm.emit())))
    }

    pub(super) fn wake(&self) -> Option<Now> {
        self.channels.iter().filter_map(|channel| channel.is_in_flight.as_ref()).map(|(_, due, _)| *due).min()
    }

    /// Repeats unacknowledged frames. Returns `None` if a frame is still unacknowledged after its last repetition.
    pub(super) fn poll(&mut self, now: Now) -> Option<Vec<(Priority, Vec<u8>)>> {
        let mut out = Vec::new();
        for (at, priority) in Priority::ALL.into_iter().enumerate() {
            let (retries, timeout) = (self.retries, self.timeout);
            let Some((alarm, due, tries)) = &mut self.channels[at].is_in_flight else { continue };
            if *due > now {
                continue;
            }
            if *tries == retries {
                return None;
            }
            *tries += 1;
            *due = now + timeout;
            let data = alarm.emit();
            out.push((priority, self.frame(priority, Pdu::Data(data))));
        }
        Some(out)
    }

    pub(super) fn handle(&mut self, now: Now, priority: Priority, payload: &[u8]) -> AlarmEvent {
        let Ok(rta) = Rta::parse(payload) else { return AlarmEvent::Wrong };
        if (rta.destination, rta.source) != (self.local_reference, self.remote_reference) {
            return AlarmEvent::Wrong;
        }
        let channel = &mut self.channels[usize::from(priority == Priority::Low)];
        match rta.pdu {
            Pdu::Error(status) => AlarmEvent::Ended(status),
            Pdu::Nack => AlarmEvent::Nothing,
            Pdu::Ack => {
                channel.is_framed |= rta.acknowledged == number(channel.sent);
                AlarmEvent::Nothing
            }
            Pdu::Data(data) => {
                if rta.sequence == number(channel.taken) && channel.taken > 0 {
                    return AlarmEvent::Again(self.frame(priority, Pdu::Ack));
                }
                let Ok(noted) = Acknowledgement::parse(&data) else { return AlarmEvent::Wrong };
                let is_next = rta.sequence == number(next(channel.taken));
                let is_framed = channel.is_framed || rta.acknowledged == number(channel.sent);
                let Some((alarm, ..)) = channel.is_in_flight.take_if(|(alarm, ..)| alarm.acknowledge() == noted) else {
                    return AlarmEvent::Wrong;
                };
                if !is_next || !is_framed {
                    return AlarmEvent::Wrong;
                }
                channel.taken = next(channel.taken);
                let waiting = (!channel.waiting.is_empty()).then(|| channel.waiting.remove(0));
                let mut out = vec![self.frame(priority, Pdu::Ack)];
                out.extend(waiting.and_then(|alarm| self.raise(now, &alarm)));
                AlarmEvent::Noted(out, alarm)
            }
        }
    }
}
