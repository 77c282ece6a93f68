//! Simulated PROFINET device with modules. The device has no sockets and no clock. It is stricter than real devices.

use std::collections::VecDeque;
use std::net::{Ipv4Addr, SocketAddrV4};
use std::time::Duration;

use super::Now;
use super::controller::Action;
use super::layout::{Direction, Layout};
use super::wire::Mac;
use super::wire::alarm::{Notification, Priority};
use super::wire::dcp::IpSuite;
use super::wire::frame::{Frame, id};
use super::wire::record::{Im0, Parameter};
use super::wire::rpc::{Datagram, Header, Kind};
use super::wire::status::Status;

mod alarms;
mod ar;
mod calls;
mod checks;
mod fault;
pub mod server;
mod station;

use ar::Ar;
pub use fault::Fault;

/// Configuration of a device.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Setup {
    /// MAC address.
    pub mac: Mac,
    /// Station name. It may be empty.
    pub name: String,
    /// Device type, as text.
    pub kind: String,
    /// Vendor id and device id.
    pub id: (u16, u16),
    /// Instance in the object UUID.
    pub instance: u16,
    /// IP address; `None` if the device has no address yet.
    pub ip: Option<IpSuite>,
    /// Whether DCP can set the IP address. On a real interface this is `false`, because the device uses the address of
    /// the interface.
    pub takes_ip: bool,
    /// Modules.
    pub layout: Layout,
    /// Shortest supported cycle, in units of 31.25 us.
    pub shortest: u16,
    /// I&M0 record of the device.
    pub im0: Im0,
}

/// Application behind the device.
pub trait Application {
    /// Handles the output image. The image is `None` if there is no connection, if the provider status is bad, or if
    /// the controller has stopped.
    fn image_out(&mut self, now: Now, image: Option<&[u8]>);
    /// Updates the image to the controller. The buffer contains the previous image.
    fn image_in(&mut self, now: Now, image: &mut [u8]);
    /// Handles an event.
    fn event(&mut self, now: Now, event: &Event);
}

/// Event of a device.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Event {
    /// A controller connected.
    Connected(Ipv4Addr),
    /// The controller confirmed ApplicationReady.
    Ready,
    /// A record was written.
    Written(Parameter),
    /// The connection ended. Contains the reason; `None` after a release.
    Ended(Option<Status>),
    /// The device refused a controller.
    Refused(Status),
    /// The controller acknowledged an alarm.
    AlarmNoted(Notification),
    /// The station name was set. `true` means that the name is permanent.
    Named(String, bool),
    /// The IP address was set. `true` means that the address is permanent.
    Addressed(IpSuite, bool),
    /// A client requested that the device blinks.
    Blink,
    /// The station name and the IP address were reset.
    Reset,
}

/// A simulated device.
#[derive(Debug)]
pub struct Device<A> {
    /// The configuration.
    pub setup: Setup,
    /// The application.
    pub application: A,
    ar: Option<Ar>,
    fault: Option<Fault>,
    /// The last answers. The device answers a repeated call with the same bytes.
    answers: VecDeque<(Header, SocketAddrV4, Vec<u8>)>,
    /// Frames to send later, with their times.
    delayed_frames: Vec<(Now, Vec<u8>)>,
    image: Vec<u8>,
    actions: VecDeque<Action>,
}

/// Number of answers that are kept.
const MAX_ANSWERS: usize = 8;
/// Maximum number of delayed Identify answers.
const MAX_DELAYED: usize = 32;
/// Maximum delay of an Identify answer that a request may contain, in steps of 10 ms.
const MAX_RESPONSE_DELAY: u16 = 6400;
const RESPONSE_DELAY_STEP: Duration = Duration::from_millis(10);

impl<A: Application> Device<A> {
    /// Creates a device without a connection.
    pub fn new(setup: Setup, application: A) -> Self {
        let image = vec![0; setup.layout.size(Direction::Input)];
        Self {
            setup,
            application,
            ar: None,
            fault: None,
            answers: VecDeque::new(),
            delayed_frames: Vec::new(),
            image,
            actions: VecDeque::new(),
        }
    }

    /// Activates a fault; `None` deactivates the active fault.
    pub const fn set_fault(&mut self, fault: Option<Fault>) {
        self.fault = fault;
    }

    /// Whether data is exchanged in both directions.
    pub fn is_running(&self) -> bool {
        self.ar.as_ref().is_some_and(Ar::is_running)
    }

    /// Restarts the device, as after a power cycle.
    pub fn restart(&mut self, now: Now) {
        self.actions.clear();
        self.delayed_frames.clear();
        self.answers.clear();
        self.drop_ar(now, Some(Status::abort(0x1A)));
    }

    /// Aborts the connection for this reason.
    pub fn abort(&mut self, now: Now, reason: u8) {
        let Some(ar) = &self.ar else { return };
        let payload = ar.alarms.error(Status::abort(reason).0);
        self.send_alarm(Priority::Low, &payload);
        self.drop_ar(now, Some(Status::abort(reason)));
    }

    /// Raises an alarm if a controller is connected. Alarms that are still waiting are sent first.
    pub fn raise(&mut self, now: Now, alarm: &Notification) {
        let Some(ar) = &mut self.ar else { return };
        let payload = ar.alarms.raise(now, alarm);
        if let Some(payload) = payload {
            self.send_alarm(alarm.priority, &payload);
        }
    }

    fn send_alarm(&mut self, priority: Priority, payload: &[u8]) {
        let Some(mac) = self.ar.as_ref().map(|ar| ar.mac) else { return };
        let frame = self.frame_to(mac, Some(priority.tag()), priority.frame_id(), payload);
        self.actions.push_back(Action::Frame(frame));
    }

    fn frame_to(&self, destination: Mac, tag: Option<u16>, id: u16, payload: &[u8]) -> Vec<u8> {
        Frame { destination, source: self.setup.mac, tag, id, payload }.emit()
    }

    fn drop_ar(&mut self, now: Now, reason: Option<Status>) {
        if self.ar.take().is_some() {
            self.application.image_out(now, None);
            self.application.event(now, &Event::Ended(reason));
        }
    }

    /// Time of the next [`poll`](Self::poll).
    pub fn wake(&self) -> Option<Now> {
        if !self.actions.is_empty() {
            return Some(Now::ZERO);
        }
        let delayed_frames = self.delayed_frames.iter().map(|(at, _)| *at).min();
        delayed_frames.into_iter().chain(self.ar.as_ref().map(Ar::wake)).min()
    }

    /// Returns the next action at `now`.
    pub fn poll(&mut self, now: Now) -> Option<Action> {
        if self.actions.is_empty() {
            self.tick(now);
        }
        self.actions.pop_front()
    }

    fn tick(&mut self, now: Now) {
        let mut due = Vec::new();
        self.delayed_frames.retain_mut(|(at, frame)| {
            if *at <= now {
                due.push(Action::Frame(std::mem::take(frame)));
            }
            *at > now
        });
        self.actions.extend(due);
        self.tick_ar(now);
    }

    /// Handles a received frame.
    pub fn frame(&mut self, now: Now, bytes: &[u8]) {
        let Ok(frame) = Frame::parse(bytes) else { return };
        if frame.destination == Mac::DCP_IDENTIFY && frame.id == id::DCP_IDENTIFY {
            self.handle_identify(now, &frame);
        }
        if frame.destination != self.setup.mac || frame.source.is_group() {
            return;
        }
        match frame.id {
            id::DCP_GET_SET => self.handle_get_set(now, &frame),
            frame_id if self.ar.as_ref().is_some_and(|ar| ar.mac == frame.source) => {
                match Priority::from_frame_id(frame_id) {
                    Some(priority) => self.handle_alarm(now, priority, frame.payload),
                    None => self.handle_data(now, frame_id, frame.payload),
                }
            }
            _ => {}
        }
    }

    /// Handles a datagram for UDP port 34964.
    pub fn datagram(&mut self, now: Now, from: SocketAddrV4, bytes: &[u8]) {
        let Ok(datagram) = Datagram::parse(bytes) else { return };
        match datagram.header.kind {
            Kind::REQUEST => self.called(now, from, &datagram),
            Kind::RESPONSE => self.ready_answered(now, &datagram),
            _ => {}
        }
    }
}
