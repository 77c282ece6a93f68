//! Two ends of a line in virtual time, and the input as the disturbance between them.
//!
//! An answer that must match its request never comes from mutations alone. Here the simulator answers, and the input
//! only says which messages are damaged, lost, doubled or replaced. An empty input disturbs nothing.

use std::net::{Ipv4Addr, SocketAddrV4};
use std::sync::Arc;
use std::time::Duration;

use armctl_controller::toyo::request::Request as ToyoRequest;
use armctl_controller::toyo::session::{LineSession, Policy as ToyoPolicy};
use armctl_controller::toyo::simulator::{Simulator as ToyoSimulator, Start as ToyoStart};
use armctl_controller::yerc::files::FileName;
use armctl_controller::yerc::query::{Query as _, ReadStatus};
use armctl_controller::yerc::session::{Download, Exchange, Ids, Policy, Upload};
use armctl_controller::yerc::simulator::{Simulator, Start};
use armctl_controller::yerc::wire::RequestFrame;
use armctl_controller::{Now, Session, Step};
use armctl_transport::devicenet::can::{Bitrate, Frame as CanFrame};
use armctl_transport::devicenet::device::{self, Device as CanDevice};
use armctl_transport::devicenet::scanner::{Identity as ScannerIdentity, Scanner, Token};
use armctl_transport::devicenet::settings::{Images, Profile, Purpose, Settings as CanSettings};
use armctl_transport::devicenet::wire::{self as can_wire, Mac};
use armctl_transport::eip::adapter::{self, Adapter, Output, Setup};
use armctl_transport::eip::error::EipError;
use armctl_transport::eip::originator::{self, Originator};
use armctl_transport::eip::session::{Ask, Token as EipToken};
use armctl_transport::eip::settings::Settings;
use armctl_transport::eip::wire::{Command, Cyclic, Identity, Revision};
use armctl_transport::eip::{IO_PORT, PORT};
use armctl_transport::image::ImagePeer;
use armctl_transport::profibus::master::Master;
use armctl_transport::profibus::rates::Rate;
use armctl_transport::profibus::settings::Settings as DpSettings;
use armctl_transport::profibus::slave::{Setup as DpSetup, Slave};
use armctl_transport::profinet::controller::identifiers::Identifiers;
use armctl_transport::profinet::controller::{Action, Controller, LocalAddress};
use armctl_transport::profinet::device::{self as profinet_device, Device};
use armctl_transport::profinet::layout::Layout;
use armctl_transport::profinet::settings::{Settings as PnSettings, Station};
use armctl_transport::profinet::wire::Mac as EthernetMac;
use armctl_transport::profinet::wire::dcp::IpSuite;
use armctl_transport::profinet::wire::record::Im0;
use armctl_transport::sim::Peer as _;

use crate::targets::seen;

/// Most steps of a world. An undisturbed world opens and exchanges some images in fewer.
const MAX_STEPS: usize = 400;
const MS: Duration = Duration::from_millis(1);
const SIZE: usize = 48;

/// Disturbs messages as the input says, and keeps what was sent.
#[derive(Debug)]
pub struct Disturbance<'a> {
    script: &'a [u8],
    /// Messages that still pass unchanged.
    skip: u8,
    /// Messages before their disturbance.
    pub sent: Vec<Vec<u8>>,
}

impl<'a> Disturbance<'a> {
    pub const fn new(script: &'a [u8]) -> Self {
        Self { script, skip: 0, sent: Vec::new() }
    }

    fn byte(&mut self) -> u8 {
        self.script.split_off_first().copied().unwrap_or_default()
    }

    fn index(&mut self, length: usize) -> usize {
        let at = u16::from_le_bytes([self.byte(), self.byte()]);
        usize::from(at) % length.max(1)
    }

    fn bytes(&mut self) -> Vec<u8> {
        let length = usize::from(self.byte()).min(self.script.len());
        self.script.split_off(..length).unwrap_or_default().to_vec()
    }

    /// The messages that arrive in place of one that was sent.
    fn pass(&mut self, mut message: Vec<u8>) -> Vec<Vec<u8>> {
        if self.sent.len() < 64 {
            self.sent.push(message.clone());
        }
        if self.skip > 0 {
            self.skip -= 1;
            return vec![message];
        }
        match self.byte() {
            skip @ 0..0x80 => self.skip = skip,
            edits @ 0x80..0xB0 => {
                for _ in 0..=edits % 4 {
                    let (at, value) = (self.index(message.len()), self.byte());
                    if let Some(byte) = message.get_mut(at) {
                        *byte = value;
                    }
                }
            }
            0xB0..0xC0 => {
                let at = self.index(message.len());
                message.truncate(at);
            }
            0xC0..0xD0 => message.extend(self.bytes()),
            0xD0..0xE0 => {
                let at = self.index(message.len());
                message.truncate(at);
                message.extend(self.bytes());
            }
            0xE0..0xF0 => message = self.bytes(),
            0xF0..0xF8 => return Vec::new(),
            _ => return vec![message.clone(), message],
        }
        vec![message]
    }
}

fn resting() -> Vec<u8> {
    let mut image = vec![0; SIZE];
    image[32] = 0x41;
    image
}

/// Application of every fieldbus device: shows what it got.
#[derive(Debug, Default)]
struct Echo(Vec<u8>);

impl Echo {
    fn show(&self, image: &mut [u8]) {
        for (shown, taken) in image.iter_mut().zip(&self.0) {
            *shown = *taken;
        }
    }
}

impl adapter::Application for Echo {
    fn image_out(&mut self, _: Now, _: u32, image: &[u8], _: bool) {
        self.0 = image.to_vec();
    }
    fn image_in(&mut self, _: Now, _: u32, image: &mut [u8]) {
        self.show(image);
    }
    fn event(&mut self, _: Now, _: &adapter::Event) {}
}

impl device::Application for Echo {
    fn image_out(&mut self, _: Now, image: &[u8]) {
        self.0 = image.to_vec();
    }
    fn image_in(&mut self, _: Now, image: &mut [u8]) {
        self.show(image);
    }
    fn on_master_lost(&mut self, _: Now) {}
}

impl profinet_device::Application for Echo {
    fn image_out(&mut self, _: Now, image: Option<&[u8]>) {
        self.0 = image.unwrap_or_default().to_vec();
    }
    fn image_in(&mut self, _: Now, image: &mut [u8]) {
        self.show(image);
    }
    fn event(&mut self, _: Now, _: &profinet_device::Event) {}
}

impl ImagePeer for Echo {
    fn input(&mut self, _: Now, image: Option<&[u8]>) {
        self.0 = image.unwrap_or_default().to_vec();
    }
    fn output(&mut self, _: Now) -> Option<Vec<u8>> {
        Some(if self.0.is_empty() { vec![0; SIZE] } else { self.0.clone() })
    }
    fn wake(&self) -> Option<Now> {
        None
    }
}

/// Time of the next step: the earliest that both ends ask for, and never the same time for ever.
fn next(now: Now, wakes: impl IntoIterator<Item = Option<Now>>) -> Now {
    wakes.into_iter().flatten().min().map_or(now + 100 * MS, |wake| wake.max(now + MS / 10))
}

/// EtherNet/IP: an originator that opens a connection, asks and closes it.
pub fn eip(link: &mut Disturbance<'_>) {
    let [ours, theirs] = [Ipv4Addr::new(10, 0, 0, 1), Ipv4Addr::new(10, 0, 0, 2)];
    let identity = Identity {
        address: SocketAddrV4::new(theirs, PORT),
        vendor: 636,
        device_type: 43,
        product: 5,
        revision: Revision { major: 1, minor: 2 },
        status: 0,
        serial: 1,
        name: "RCX".to_owned(),
        state: Some(3),
    };
    let settings = Settings { output_size: 48, input_size: 48, resting: resting(), ..Settings::default() };
    let mut adapter = Adapter::new(Setup::new(identity, (100, 48), (150, 48), 1), Echo::default());
    adapter.listens(SocketAddrV4::new(theirs, PORT), IO_PORT);
    let identifiers = Arc::new(originator::Identifiers::new(1, 2, 3));
    let target = SocketAddrV4::new(theirs, PORT);
    let mut originator = Originator::new(target, IO_PORT, settings, identifiers).expect("the settings are valid");
    originator.ask(Ask { token: EipToken(7), what: "list", command: Command::LIST_IDENTITY, data: Vec::new() });
    let (mut now, mut client) = (Now::ZERO, 0);
    for step in 0..MAX_STEPS {
        if step == MAX_STEPS / 2 {
            originator.close();
        }
        while let Some(action) = originator.poll(now) {
            match action {
                originator::Action::Connect => {
                    client += 1;
                    adapter.connected(client, ours);
                    originator.connected(now);
                }
                originator::Action::Send(bytes) => {
                    link.pass(bytes).iter().for_each(|bytes| adapter.received(now, client, bytes));
                }
                originator::Action::Disconnect => adapter.disconnected(client),
                originator::Action::Datagram(_, bytes) => {
                    let from = SocketAddrV4::new(ours, IO_PORT);
                    link.pass(bytes).iter().for_each(|bytes| adapter.receive_datagram(now, from, bytes));
                }
                originator::Action::Join(_) | originator::Action::Leave(_) => {}
                originator::Action::Answer(_, result) => seen(format!("{result:?}")),
            }
        }
        while let Some(output) = adapter.poll(now) {
            match output {
                Output::Send(_, bytes) => link.pass(bytes).iter().for_each(|bytes| originator.received(now, bytes)),
                Output::HangUp(_) => originator.disconnected(&EipError::Ended),
                Output::Datagram(_, bytes) => {
                    for bytes in link.pass(bytes) {
                        if let Ok(datagram) = Cyclic::parse(&bytes)
                            && originator.expects(theirs, datagram.id)
                        {
                            originator.receive_datagram(now, IO_PORT, &datagram);
                        }
                    }
                }
                Output::Discovered(..) => {}
            }
        }
        if let Some(error) = originator.view().last_error {
            seen(error.to_string());
        }
        if originator.is_finished() {
            break;
        }
        now = next(now, [originator.wake(), adapter.wake()]);
    }
}

/// DeviceNet: a master that searches, opens a connection, and reads an attribute.
pub fn devicenet(link: &mut Disturbance<'_>) {
    let mac = |number| Mac::new(number).expect("a MAC");
    let mut scanner = Scanner::new(ScannerIdentity { mac: mac(1), vendor: 0xFFFF, serial: 7 });
    let mut device = CanDevice::on_line(device::Setup::sample_controller(mac(5), Bitrate::K500, 48), Echo::default());
    let profiles = [48, 4].map(|size| Profile { name: "a profile", resting: resting()[..size].to_vec() });
    let purpose = Purpose::Images(Images::usual(profiles.to_vec(), None));
    let settings = CanSettings { slave: mac(5), purpose, timeout: 1000 * MS };
    scanner.open(1, settings).expect("the settings are valid");
    let mut now = Now::ZERO;
    let frame = |bytes: &[u8]| {
        let (id, data) = bytes.split_at_checked(2)?;
        CanFrame::new(u16::from_be_bytes([id[0] & 7, id[1]]), data.get(..data.len().min(8))?)
    };
    let plain = |frame: &CanFrame| [&frame.id().to_be_bytes(), frame.data()].concat();
    for step in 0..MAX_STEPS {
        match step {
            50 => scanner.ask(1, Token(1), can_wire::Request::get(can_wire::class::IDENTITY, 1, 7)),
            150 => scanner.find(now),
            300 => scanner.close(now, 1),
            _ => {}
        }
        while let Some(sent) = scanner.poll(now) {
            link.pass(plain(&sent))
                .iter()
                .filter_map(|bytes| frame(bytes))
                .for_each(|frame| device.handle(now, &frame));
        }
        while let Some(sent) = device.poll(now) {
            link.pass(plain(&sent))
                .iter()
                .filter_map(|bytes| frame(bytes))
                .for_each(|frame| scanner.handle(now, &frame));
        }
        while let Some(reply) = scanner.reply() {
            seen(format!("{reply:?}"));
        }
        if let Some(error) = scanner.view(1).and_then(|view| view.last_error.as_ref()) {
            seen(error.to_string());
        }
        scanner.changed();
        now = next(now, [scanner.wake(), device.wake()]);
    }
}

/// PROFIBUS: a master and a slave.
pub fn profibus(link: &mut Disturbance<'_>) {
    let rate = Rate::from_name("500k").expect("a rate");
    let mut now = Now::ZERO;
    let mut master = Master::new(now, DpSettings::new(5, rate, resting())).expect("the settings are valid");
    let mut slave = Slave::new(DpSetup::sample_controller(rate), Echo::default());
    for step in 0..MAX_STEPS {
        if step == MAX_STEPS - 50 {
            master.close(now);
        }
        while let Some(bytes) = master.poll(now) {
            link.pass(bytes).iter().for_each(|bytes| slave.receive(now, 0, bytes));
        }
        while let Some((_, bytes)) = slave.transmit(now) {
            link.pass(bytes).iter().for_each(|bytes| master.handle(now, bytes));
        }
        let view = master.view();
        seen(view.last_error.map(|error| error.to_string()));
        seen(view.details.diagnosis.map(|diagnosis| diagnosis.to_string()));
        now = next(now, [master.due(), slave.wake()]);
    }
}

/// PROFINET: a controller that finds its device, opens a connection, gets an alarm, and releases.
pub fn profinet(link: &mut Disturbance<'_>) {
    let suite = |last| IpSuite {
        address: Ipv4Addr::new(192, 168, 78, last),
        mask: Ipv4Addr::new(255, 255, 255, 0),
        gateway: Ipv4Addr::new(192, 168, 78, last),
    };
    let local = LocalAddress { mac: EthernetMac([2, 0, 0, 0, 0, 1]), ip: suite(1) };
    let layout = || Layout::two_modules(0x101, 0x102);
    let settings = PnSettings { resting: resting(), ..PnSettings::new(Station::Name("yrcx-sim".to_owned()), layout()) };
    let identifiers = Arc::new(Identifiers::random());
    let mut controller = Controller::new(local, settings, identifiers).expect("the settings are valid");
    let setup = profinet_device::Setup {
        mac: EthernetMac([2, 0, 0, 0, 0, 2]),
        name: "yrcx-sim".to_owned(),
        kind: "YRCX like".to_owned(),
        id: (0xFFFF, 1),
        instance: 1,
        ip: Some(suite(2)),
        takes_ip: true,
        layout: layout(),
        shortest: 32,
        im0: Im0 { vendor: 0xFFFF, software: ('V', 1, 0, 0), ..Im0::default() },
    };
    let mut device = Device::new(setup, Echo::default());
    let [ours, theirs] = [1, 2].map(|last| SocketAddrV4::new(suite(last).address, 34964));
    let mut now = Duration::from_secs(1000);
    for step in 0..MAX_STEPS {
        match step {
            200 => device.abort(now, 3),
            350 => controller.close(now),
            _ => {}
        }
        while let Some(action) = controller.poll(now) {
            match action {
                Action::Frame(bytes) => link.pass(bytes).iter().for_each(|bytes| device.frame(now, bytes)),
                Action::Datagram(_, bytes) => {
                    link.pass(bytes).iter().for_each(|bytes| device.datagram(now, ours, bytes));
                }
            }
        }
        while let Some(action) = device.poll(now) {
            match action {
                Action::Frame(bytes) => link.pass(bytes).iter().for_each(|bytes| controller.frame(now, bytes)),
                Action::Datagram(_, bytes) => {
                    link.pass(bytes).iter().for_each(|bytes| controller.datagram(now, theirs, bytes));
                }
            }
        }
        seen(controller.view().last_error.map(|error| error.to_string()));
        while let Some(alarm) = controller.take_alarm() {
            seen(alarm.describe());
        }
        if controller.is_finished() {
            break;
        }
        now = next(now, [controller.wake(), device.wake()]);
    }
}

/// YERC: a read, a download and an upload, one after the other.
pub fn yerc(link: &mut Disturbance<'_>) {
    let mut simulator = Simulator::new(Start::default());
    let (ids, policy) = (Ids::default(), Policy::default());
    let mut now = Now::ZERO;
    let status = ReadStatus.request().frame(0);
    let status = RequestFrame::parse(&status).expect("a frame");
    run_yerc(&mut Exchange::new(&status, true, policy, &ids), &mut simulator, &mut now, link, |_| ());
    let name = FileName::new("TESTJOB.JBI").expect("a name");
    let save = name.save().frame(0);
    let save = RequestFrame::parse(&save).expect("a frame");
    let mut download = Download::new(&save, 10_000, policy, &ids);
    run_yerc(&mut download, &mut simulator, &mut now, link, |_| ());
    assert!(download.bytes() <= 10_000, "a download stays within its limit");
    let load = FileName::new("NEW.JBI").expect("a name").load().frame(0);
    let load = RequestFrame::parse(&load).expect("a frame");
    let content = b"/JOB\r\n//NAME NEW\r\n//INST\r\nNOP\r\nEND\r\n".repeat(30);
    let feed = |upload: &mut Upload| upload.feed(&content, true);
    run_yerc(&mut Upload::new(&load, policy, &ids), &mut simulator, &mut now, link, feed);
}

fn run_yerc<S: Session>(
    session: &mut S,
    simulator: &mut Simulator,
    now: &mut Now,
    link: &mut Disturbance<'_>,
    feed: impl Fn(&mut S),
) {
    for _ in 0..MAX_STEPS {
        match session.poll(*now) {
            Step::Send(bytes) => {
                let frame = RequestFrame::parse(&bytes).expect("sessions send valid frames");
                let division = frame.division;
                for bytes in link.pass(bytes) {
                    simulator.receive(*now, division, 0, &bytes);
                }
            }
            Step::Data(piece) => assert!(!piece.is_empty(), "a piece has bytes"),
            Step::Feed => feed(session),
            Step::Wait(until) => {
                let mut is_quiet = true;
                while let Some(outgoing) = simulator.transmit(*now) {
                    is_quiet = false;
                    link.pass(outgoing.bytes).iter().for_each(|bytes| session.handle(*now, bytes));
                }
                if is_quiet {
                    *now = next(*now, [Some(until), simulator.wake()]);
                }
            }
            Step::Done(_) => return,
        }
    }
}

/// TOYO: requests of each kind on a line.
pub fn toyo(link: &mut Disturbance<'_>) {
    let mut simulator = ToyoSimulator::new(ToyoStart::default());
    let policy = ToyoPolicy { timeout: 1000 * MS, retries: 2, character: MS };
    let mut session = LineSession::new(policy);
    let mut now = Now::ZERO;
    for text in ["STAS SNO=0", "HSON", "RPAR M10", "SYSP", "MTOP"] {
        let Ok(request) = ToyoRequest::parse(&format!("@{text}")) else { continue };
        session.begin(&request, true);
        for _ in 0..MAX_STEPS {
            match session.poll(now) {
                Step::Send(bytes) => link.pass(bytes).iter().for_each(|bytes| simulator.receive(now, bytes)),
                Step::Wait(until) => {
                    let mut is_quiet = true;
                    while let Some(bytes) = simulator.transmit(now) {
                        is_quiet = false;
                        link.pass(bytes).iter().for_each(|bytes| session.handle(now, bytes));
                    }
                    if is_quiet {
                        now = next(now, [Some(until), simulator.wake()]);
                    }
                }
                Step::Data(_) | Step::Feed => unreachable!("a line has no pieces"),
                Step::Done(result) => {
                    seen(format!("{result:?} {:?} {:?}", session.take_refuted(), session.counters()));
                    break;
                }
            }
        }
    }
}
