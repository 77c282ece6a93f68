//! Tests of the client as a library, on simulators and other peers in virtual time.

use std::fmt;
use std::sync::{Arc, Mutex};

use armctl_controller::yrcx::answer::Status;
use armctl_controller::yrcx::order::{Draft, Order};
use armctl_controller::yrcx::procedure::Procedure;
use armctl_controller::yrcx::session::{NotSentReason, Silence};
use armctl_controller::yrcx::signal::output;
use armctl_controller::yrcx::value::Key;
use armctl_transport::image::ImagePeer;
use armctl_transport::session::client::{AttachResult, attach_at};
use armctl_transport::session::host::Host;
use armctl_transport::session::host::shared_link::SharedLink;
use armctl_transport::session::location::SessionPath;
use armctl_transport::session::wire::Info;
use tokio::time::timeout;

use super::*;

async fn simulated(risk: Risk) -> Client {
    Client::simulated(Start::default(), Options::default().with_risk(risk)).await.unwrap()
}

fn order(draft: Draft) -> Order {
    draft.build().unwrap()
}

fn point(number: i32) -> Order {
    order(Command::PointGet.order().with(Key::Point, number))
}

fn motion() -> Order {
    order(Command::MovePtp.order().with(Key::Point, 1).with(Key::SpeedPercent, 1))
}

fn jog() -> Order {
    order(Command::JogPulse.order().with(Key::Axes, "1").with(Key::Direction, 0).with(Key::Report, 1))
}

/// A peer that always sends the same image and ignores what it receives. With a duration, it sends nothing after this
/// time.
#[derive(Debug)]
struct ConstantPeer(Option<Duration>);

impl ImagePeer for ConstantPeer {
    fn input(&mut self, _: Duration, _: Option<&[u8]>) {}

    fn output(&mut self, now: Duration) -> Option<Vec<u8>> {
        let mut image = Image::default();
        output::CPU_OK.set(&mut image, true);
        self.0.is_none_or(|gone| now < gone).then(|| image.to_bytes().to_vec())
    }

    fn wake(&self) -> Option<Duration> {
        self.0
    }
}

async fn constant_peer_client(risk: Risk, gone: Option<Duration>) -> Client {
    let link = ImageLink::in_process(Box::new(ConstantPeer(gone)));
    Client::connect(link, Options::default().with_risk(risk)).await.unwrap()
}

/// A peer that accepts a command, and then has this status forever.
#[derive(Debug)]
struct StuckPeer {
    status: Status,
    has_command: bool,
}

impl StuckPeer {
    fn link(status: Status) -> ImageLink {
        ImageLink::in_process(Box::new(Self { status, has_command: false }))
    }
}

impl ImagePeer for StuckPeer {
    fn input(&mut self, _: Duration, bytes: Option<&[u8]>) {
        self.has_command |= bytes.is_some_and(|bytes| bytes[..2] != [0, 0]);
    }

    fn output(&mut self, _: Duration) -> Option<Vec<u8>> {
        let mut image = Image::default();
        output::CPU_OK.set(&mut image, true);
        output::PROGRAM_RUNNING.set(&mut image, true);
        image.0[0] = if self.has_command { self.status.word() } else { Status::Ready.word() };
        Some(image.to_bytes().to_vec())
    }

    fn wake(&self) -> Option<Duration> {
        None
    }
}

#[tokio::test(start_paused = true)]
async fn unconfirmed_stop_fails_within_3_s() {
    let power = order(Command::ServoFree.order().with(Key::Axes, "1"));
    for what in [motion(), jog(), power] {
        let link = StuckPeer::link(Status::Running);
        let mut client = Client::connect(link, Options::default().with_risk(Risk::Motion)).await.unwrap();
        assert!(timeout(Duration::from_secs(1), client.ask(&what)).await.is_err());
        let began = Instant::now();
        let stopped = client.stop().await;
        assert!(matches!(stopped, Err(Error::OutcomeUnknown { .. })), "{stopped:?}");
        assert!(began.elapsed() <= Duration::from_secs(3), "{:?}", began.elapsed());
    }
    let link = StuckPeer::link(Status::Running);
    let mut client = Client::connect(link, Options::default().with_risk(Risk::Write)).await.unwrap();
    for stop in [Procedure::stop(), Procedure::emergency_stop()] {
        let began = Instant::now();
        let stopped = client.run_procedure(stop).await;
        assert!(matches!(stopped, Err(Error::Unfinished { .. })), "{stopped:?}");
        assert!(began.elapsed() <= Duration::from_secs(3), "{:?}", began.elapsed());
    }
}

/// Creates a client of the session at this path.
async fn attached_client(location: &SessionPath) -> Client {
    let AttachResult::Session(attached_client) =
        attach_at(location, "cell", "test", armctl_transport::session::wire::Purpose::Any).await.unwrap()
    else {
        panic!("nobody holds it")
    };
    Client::connect(ImageLink::in_session(attached_client), Options::default()).await.unwrap()
}

#[tokio::test]
async fn waiting_client_sees_changes_of_other_clients() {
    let folder = tempfile::tempdir().unwrap();
    let location = SessionPath::at(folder.path().join("cell"));
    let info = Info { pid: 1, ..Info::own("cell", "yrcx", "sim:", "armctl session open") };
    let claim = location.claim(&info).unwrap().unwrap();
    let link = ImageLink::in_process(Box::new(Simulated::new(Start::default())));
    let held =
        SharedLink::Images(open_session_link(link, true, Instant::now() + Duration::from_secs(60)).await.unwrap());
    let mut host = Host::new(claim, "cell".to_owned(), info, held, |_| {}).unwrap();
    let work = async {
        let (mut one, mut other) = (attached_client(&location).await, attached_client(&location).await);
        let (here, there) = (point(1), point(2));
        for _ in 0..100 {
            // Both clients need the link at the same time: each must wait for the command of the other.
            let (first, second) = tokio::join!(one.ask(&here), other.ask(&there));
            first.unwrap();
            second.unwrap();
        }
    };
    tokio::select! {
        _ = host.serve() => panic!("nobody closed it"),
        () = work => {}
    }
}

#[tokio::test(start_paused = true)]
async fn sends_only_granted_requests_and_stops() {
    let mut client = simulated(Risk::Motion).await;
    client.run_procedure(Procedure::run()).await.unwrap();
    client.grant(Grant::default());
    let denied = client.ask(&motion()).await.unwrap_err();
    assert!(matches!(&denied, Error::NotAuthorized(denied) if denied.risk == Risk::Motion), "{denied}");
    assert_eq!(client.totals().commands, 0);
    assert!(output::PROGRAM_RUNNING.is_on(&client.input_image().await.unwrap()));
    assert_eq!(client.stop().await.unwrap(), StopResult::Started);
    assert!(!output::PROGRAM_RUNNING.is_on(&client.input_image().await.unwrap()));
    assert!(client.ask(&motion()).await.is_err(), "a stop grants nothing");
    assert_eq!(client.stop().await.unwrap(), StopResult::Nothing);
}

#[tokio::test(start_paused = true)]
async fn a_refusal_is_an_answer_or_an_error() {
    let mut client = simulated(Risk::Read).await;
    let refusal = client.try_ask(&point(7)).await.unwrap().unwrap_err();
    assert_eq!(refusal.order, point(7));
    let error = client.ask(&point(7)).await.unwrap_err();
    assert!(matches!(error, Error::Refused(again) if *again == refusal));
    assert_eq!(client.raw(&point(7)).await.unwrap().words[1..3], [refusal.alarm.group, refusal.alarm.category]);
    assert_eq!(client.ask(&point(1)).await.unwrap().values.axes(), Some([100_000, 100_000, 0, 0]));
    assert_eq!(client.close().await.unwrap().commands, 4);
}

#[tokio::test(start_paused = true)]
async fn no_answer_to_a_change_is_an_unknown_outcome() {
    let mut client = constant_peer_client(Risk::Write, None).await;
    let silent = client.ask(&point(1)).await.unwrap_err();
    assert!(matches!(&silent, Error::NoAnswer { why: Silence::NotTaken, .. }), "{silent}");
    let before = client.totals().commands;
    let unknown = client.ask(&order(Command::AlarmReset.order())).await.unwrap_err();
    assert!(matches!(&unknown, Error::OutcomeUnknown { command: Command::AlarmReset, .. }), "{unknown}");
    assert_eq!(client.totals().commands, before + 1, "what changes something leaves once");
}

#[tokio::test(start_paused = true)]
async fn sends_a_read_once_plus_retries_with_a_timeout_each() {
    for retries in [0, 4] {
        let link = ImageLink::in_process(Box::new(ConstantPeer(None)));
        let options = Options { timeout: Duration::from_millis(300), retries, ..Options::default() };
        let mut client = Client::connect(link, options).await.unwrap();
        let (began, before) = (Instant::now(), client.totals().commands);
        let silent = client.ask(&point(1)).await.unwrap_err();
        assert!(matches!(&silent, Error::NoAnswer { why: Silence::NotTaken, .. }), "{silent}");
        assert_eq!(client.totals().commands - before, retries + 1);
        let (waited, patience) = (began.elapsed(), 300 * u128::from(retries + 1));
        assert!((patience..patience + 300).contains(&waited.as_millis()), "{waited:?} with {retries} retries");
    }
}

#[tokio::test(start_paused = true)]
async fn dry_run_plans_requests_and_has_no_answers() {
    let mut client = Client::dry_run(Options::default().with_risk(Risk::Motion));
    client.ask(&motion()).await.unwrap();
    assert!(matches!(client.ask(&point(1)).await, Err(Error::DryRun)));
    assert!(matches!(client.input_image().await, Err(Error::DryRun)));
    client.run_procedure(Procedure::run()).await.unwrap();
    let plan = client.take_plan();
    let words: Vec<_> = plan.frames.iter().filter_map(|frame| frame["wi"][0].as_str()).collect();
    assert_eq!(words, ["0x0001", "0x0101"]);
    assert_eq!(plan.frames.last().unwrap()["about"], "auto-start (SI(12)) off");
    assert_eq!(client.stop().await.unwrap(), StopResult::Nothing);
    let mut reader = Client::dry_run(Options::default());
    assert!(matches!(reader.ask(&motion()).await, Err(Error::NotAuthorized(_))));
    assert_eq!(reader.take_plan(), Plan::default());
}

#[tokio::test(start_paused = true)]
async fn dropped_motion_continues_until_a_stop() {
    let mut client = simulated(Risk::Motion).await;
    assert!(timeout(Duration::from_millis(300), client.ask(&motion())).await.is_err());
    let stopped = client.stop().await.unwrap();
    assert!(matches!(&stopped, StopResult::Motion { order, .. } if **order == motion()), "{stopped:?}");
    assert!(client.begin(&motion()).await.unwrap().is_none(), "it goes on by itself");
    let busy = client.ask(&point(1)).await.unwrap_err();
    assert!(matches!(busy, Error::CommandRunning { command: Command::MovePtp }), "{busy}");
    assert!(matches!(client.stop().await.unwrap(), StopResult::Motion { .. }));
    assert!(client.ask(&point(1)).await.is_ok());
}

#[tokio::test(start_paused = true)]
async fn leaving_waits_for_a_short_command_and_not_for_a_motion() {
    for (order, waits) in [(point(1), true), (motion(), false)] {
        let link = StuckPeer::link(Status::Running);
        let mut client = Client::connect(link, Options::default().with_risk(Risk::Motion)).await.unwrap();
        assert!(timeout(Duration::from_millis(300), client.ask(&order)).await.is_err());
        let began = Instant::now();
        client.leave().await.unwrap();
        assert_eq!(began.elapsed() >= Duration::from_secs(1), waits, "{order:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_read_ends_with_its_answer_and_the_reset_is_confirmed_later() {
    let mut client = simulated(Risk::Write).await;
    let told = Arc::default();
    client.watch(EventRecorder(Arc::clone(&told)));
    let status = |client: &Client| client.input.map(|image| image.0[0]);
    for _ in 0..2 {
        client.ask(&point(1)).await.unwrap();
        assert_eq!(status(&client), Some(Status::NormalEnd.word()));
        let image = client.input_image().await.unwrap();
        assert_eq!(image.0[0], Status::Ready.word(), "the image of a client does not have the status of its last read");
        client.ask(&point(1)).await.unwrap();
        client.ask(&order(Command::AlarmReset.order())).await.unwrap();
        assert_eq!(status(&client), Some(Status::Ready.word()), "a change is complete when the controller is ready");
    }
    client.ask(&point(1)).await.unwrap();
    client.leave().await.unwrap();
    assert_eq!(status(&client), Some(Status::Ready.word()));
    let is_surprise = |event: &Event| matches!(event, Event::StatusReset(..) | Event::NotReleased(_));
    assert!(!told.lock().unwrap().iter().any(is_surprise));
}

#[tokio::test(start_paused = true)]
async fn a_controller_that_is_never_ready_again_is_reported() {
    let connect = async || {
        let link = StuckPeer::link(Status::NormalEnd);
        let mut client = Client::connect(link, Options { retries: 0, ..Options::default() }).await.unwrap();
        let told = Arc::<Mutex<Vec<Event>>>::default();
        client.watch(EventRecorder(Arc::clone(&told)));
        client.ask(&point(1)).await.unwrap();
        (client, told)
    };
    let (mut client, told) = connect().await;
    client.leave().await.unwrap();
    assert!(matches!(told.lock().unwrap().last(), Some(Event::NotReleased(Command::PointGet))));
    let (mut client, _) = connect().await;
    let next = client.ask(&point(1)).await.unwrap_err();
    let why = NotSentReason::NotReady(Status::NormalEnd);
    assert!(matches!(&next, Error::NotSent { why: reason, .. } if *reason == why), "{next}");
}

#[tokio::test(start_paused = true)]
async fn a_jog_ends_after_its_time() {
    let mut client = simulated(Risk::Motion).await;
    let jogged = client.jog(&jog(), Some(Duration::from_millis(500))).await.unwrap();
    let place = jogged.values.axes().unwrap();
    assert!(place[0] > 0, "{place:?}");
    assert!(!client.is_jogging());
}

#[tokio::test(start_paused = true)]
async fn monitor_reads_images_and_sends_no_commands() {
    let link = ImageLink::in_process(Box::new(Simulated::new(Start::default())));
    let options = Options { commands: false, ..Options::default() };
    let mut client = Client::connect(link, options).await.unwrap();
    assert!(output::CPU_OK.is_on(&client.input_image().await.unwrap()) && client.output_image().is_none());
    assert!(matches!(client.ask(&point(1)).await, Err(Error::MonitorOnly { .. })));
    let mut without_link = Client::without_link(Options::default());
    assert!(matches!(without_link.input_image().await, Err(Error::Silent)));
    assert!(matches!(without_link.ask(&point(1)).await, Err(Error::MonitorOnly { .. })));
}

#[derive(Debug, Default)]
struct EventRecorder(Arc<Mutex<Vec<Event>>>);

impl Watcher<Event> for EventRecorder {
    fn event(&mut self, event: Event) {
        self.0.lock().unwrap().push(event);
    }
}

#[tokio::test(start_paused = true)]
async fn watcher_gets_images_and_losses() {
    let link = ImageLink::in_process(Box::new(ConstantPeer(Some(Duration::from_secs(1)))));
    let mut client = Client::over(link, Options::default());
    let told = Arc::default();
    client.watch(EventRecorder(Arc::clone(&told)));
    client.ready().await.unwrap();
    let lost = client.wait_for_input(|_| false).await.unwrap_err();
    assert!(matches!(lost, Error::Silent), "{lost}");
    let told = told.lock().unwrap();
    let is_shown = |event: &Event| matches!(event, Event::ImageSent(image) if *image == resting());
    assert!(told.iter().any(is_shown) && told.iter().any(|event| matches!(event, Event::ImageReceived(_))), "{told:?}");
    assert!(matches!(told.last(), Some(Event::Lost { is_reopening: true, .. })), "{told:?}");
    assert_eq!(client.totals().losses, 1);
}

#[tokio::test(start_paused = true)]
async fn controller_without_image_is_an_error() {
    let link = ImageLink::in_process(Box::new(ConstantPeer(Some(Duration::ZERO))));
    assert!(matches!(Client::connect(link, Options::default()).await, Err(Error::Silent)));
}

/// Callers match errors, send them to other threads and print them.
#[test]
fn implements_the_error_trait() {
    fn is_error<E: std::error::Error + Send + Sync + Clone + fmt::Debug + 'static>() {}
    is_error::<Error>();
    is_error::<Refusal>();
}

#[tokio::test(start_paused = true)]
async fn accepts_the_longest_time_limit() {
    let options = Options { timeout: Duration::MAX, retries: u32::MAX, ..Options::default() };
    let mut client = Client::simulated(Start::default(), options.with_risk(Risk::Motion)).await.unwrap();
    assert!(output::SERVO_ON.is_on(&client.input_image().await.unwrap()));
    client.ask(&point(1)).await.unwrap();
    client.run_procedure(Procedure::power_on()).await.unwrap();
    client.close().await.unwrap();
}

#[test]
fn a_quantity_fits_only_a_field_of_its_unit() {
    use crate::units::{Millimetres, MillimetresPerSecond, Percent, Pulses};
    let go = || Command::MovePtp.order().with(Key::Point, 1);
    let exact = go().with(Key::SpeedPercent, 50).build();
    assert_eq!(go().with(Key::SpeedPercent, Percent::from(50)).build(), exact);
    assert!(go().with(Key::SpeedPercent, Percent::from_steps(5_050)).build().is_err(), "50.5 %");
    assert!(go().with(Key::SpeedPercent, MillimetresPerSecond::from(50)).build().is_err());
    assert!(go().with(Key::Point, Millimetres::from(1)).build().is_err());
    assert!(go().with(Key::Point, Pulses::from(1)).build().is_err());
}
