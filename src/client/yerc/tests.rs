//! Tests of the client as a library, on simulators in virtual time.

use std::fmt;

use armctl_controller::yerc::query::{ReadStatus, ResetAlarm, SelectJob, Selection, Servo};
use armctl_controller::yerc::simulator::Start;

use super::*;

const MODEL: Model = Model::Dx200;

async fn simulated(risk: Risk) -> Client {
    connected(risk, None).await
}

/// Connects to a simulator with these line faults.
async fn connected(risk: Risk, faults: Option<&str>) -> Client {
    let faults = faults.map(|text| text.parse().unwrap());
    let endpoint = Endpoint::Simulator { start: Box::new(Start::for_model(MODEL)), faults };
    Client::connect(endpoint, Options::new(MODEL).with_risk(risk)).await.unwrap()
}

#[test]
fn clients_can_be_sent_to_other_threads() {
    fn send(_: impl Send) {}
    let mut client = Client::dry_run(Options::new(MODEL));
    send(client.ask(&ReadStatus));
    send(client.read_file(&FileName::new("A.JBI").unwrap()));
    send(client);
}

#[tokio::test(start_paused = true)]
async fn sends_only_granted_requests_and_stops() {
    let mut client = simulated(Risk::Read).await;
    let denied = client.ask(&Servo(true)).await.unwrap_err();
    assert!(matches!(&denied, Error::NotAuthorized(denied) if denied.risk == Risk::Motion), "{denied}");
    assert_eq!(client.totals.sent, 0);
    assert!(!client.has_moved());
    client.stop().await.unwrap();
    assert!(client.ask(&ReadStatus).await.unwrap().held());
    assert!(client.ask(&Servo(true)).await.is_err(), "a stop grants nothing");
}

#[tokio::test(start_paused = true)]
async fn a_refusal_is_an_answer_or_an_error() {
    let mut client = simulated(Risk::Write).await;
    let select = SelectJob::new(MODEL, b"NOSUCH", Selection::Execute { line: 0 }).unwrap();
    let refusal = client.try_ask(&select).await.unwrap().unwrap_err();
    assert_eq!(refusal.to, RefusedRequest::Robot { command: 0x87, instance: 1 });
    let error = client.ask(&select).await.unwrap_err();
    assert!(matches!(error, Error::Refused(again) if again == refusal));
    let missing = client.read_file(&FileName::new("NOSUCH.JBI").unwrap()).await.unwrap_err();
    assert!(matches!(missing, Error::Refused(Refusal { to: RefusedRequest::File(service::SAVE), .. })), "{missing}");
    let exists = client.read_file(&FileName::new("TESTJOB.JBI").unwrap()).await.unwrap();
    assert!(exists.starts_with(b"/JOB"));
    assert_eq!(client.close().await.unwrap().exchanges, 4);
}

#[tokio::test(start_paused = true)]
async fn no_answer_to_a_change_is_an_unknown_outcome() {
    let mut client = connected(Risk::Motion, Some("drop=100%")).await;
    let silent = client.ask(&ReadStatus).await.unwrap_err();
    assert!(matches!(&silent, Error::NoAnswer { counters, .. } if counters.repeats == 3), "{silent}");
    let before = client.totals.sent;
    let unknown = client.ask(&ResetAlarm).await.unwrap_err();
    assert!(matches!(&unknown, Error::OutcomeUnknown { request, .. } if request.command == 0x82), "{unknown}");
    assert_eq!(client.totals.sent, before + 1, "what changes something leaves once");
    assert!(client.stop().await.is_err());
    assert!(client.totals.sent > before + 5, "a stop is repeated");
}

#[tokio::test]
async fn an_answer_behind_stray_datagrams_counts_after_the_deadline() {
    use armctl_controller::yerc::wire::{AnswerFrame, LAST_BLOCK, Status};

    let controller = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
    let ports = [controller.local_addr().unwrap().port(); 2];
    let answer = |id| {
        let data = &[0xC2, 0, 0, 0, 0x40, 0, 0, 0];
        AnswerFrame {
            division: Division::Robot,
            ack: true,
            id,
            block: LAST_BLOCK,
            service: 0x81,
            status: Status::OK,
            data,
        }
        .emit()
    };
    let mut client =
        Client::connect(Endpoint::Udp { host: "127.0.0.1".into(), ports }, Options::new(MODEL)).await.unwrap();
    let first = tokio::task::spawn_blocking(move || {
        let mut request = [0; 64];
        let (_, client) = controller.recv_from(&mut request).unwrap();
        controller.send_to(&answer(request[11]), client).unwrap();
        (controller, client, request[11])
    });
    client.ask(&ReadStatus).await.unwrap();
    let (controller, address, id) = first.await.unwrap();
    // Now 100 stray datagrams and the answer wait in the socket, and the time is already over.
    for _ in 0..100 {
        controller.send_to(b"stray", address).unwrap();
    }
    controller.send_to(&answer(id.wrapping_add(1)), address).unwrap();
    client.policy = client.policy.with(Duration::from_nanos(1), 0);
    assert!(client.ask(&ReadStatus).await.unwrap().servo_on());
}

#[tokio::test(start_paused = true)]
async fn dry_run_plans_requests_and_has_no_answers() {
    let mut client = Client::dry_run(Options::new(MODEL).with_risk(Risk::Motion));
    client.for_purpose("power for the move").ask(&Servo(true)).await.unwrap();
    assert!(matches!(client.ask(&ReadStatus).await, Err(Error::DryRun)));
    let plan = client.take_plan();
    let abouts: Vec<_> = plan.frames.iter().map(|frame| frame["about"].as_str()).collect();
    assert_eq!(abouts, [Some("power for the move"), None]);
    let mut reader = Client::dry_run(Options::new(MODEL));
    assert!(matches!(reader.ask(&Servo(true)).await, Err(Error::NotAuthorized(_))));
    assert_eq!(reader.take_plan(), Plan::default());
}

#[tokio::test(start_paused = true)]
async fn failing_caller_ends_a_transfer() {
    let mut client = simulated(Risk::Destroy).await;
    let file = FileName::new("TESTJOB.JBI").unwrap();
    let full = |_: &[u8]| Err("disk full");
    let line_error = client.download(&file.save(), MAX_FILE, None, full).await.unwrap_err();
    assert!(matches!(line_error, TransferError { bytes, cause: Cause::Caller("disk full") } if bytes > 0));
    let mut pieces = vec![Err("gone"), Ok(vec![b' '; 1000])];
    let line_error = client
        .upload(&FileName::new("NEW.JBI").unwrap().load(), || pieces.pop().unwrap_or(Ok(Vec::new())))
        .await
        .unwrap_err();
    assert!(matches!(line_error, TransferError { bytes, cause: Cause::Caller("gone") } if bytes > 0));
}

#[derive(Debug, Default)]
struct Counter(Arc<std::sync::Mutex<(Vec<Direction>, Vec<Event>)>>);

impl Watcher<Event> for Counter {
    fn frame(&mut self, direction: Direction, _: crate::AddressPair, bytes: &[u8]) {
        assert!(bytes.starts_with(b"YERC"));
        self.0.lock().unwrap().0.push(direction);
    }

    fn event(&mut self, event: Event) {
        self.0.lock().unwrap().1.push(event);
    }
}

#[tokio::test(start_paused = true)]
async fn watcher_gets_frames_and_other_traffic() {
    let mut client = connected(Risk::Read, Some("drop=100%")).await;
    let told = Arc::default();
    client.watch(Counter(Arc::clone(&told)));
    assert!(client.ask(&ReadStatus).await.is_err());
    let told = told.lock().unwrap();
    assert_eq!(told.0, [Direction::Sent; 4]);
    let repeated = Counters { repeats: 3, ..Counters::default() };
    assert_eq!(told.1, [Event::UnexpectedTraffic(repeated)]);
}

/// Callers match errors, send them to other threads and print them.
#[test]
fn implements_the_error_trait() {
    fn is_error<E: std::error::Error + Send + Sync + Clone + fmt::Debug + 'static>() {}
    is_error::<Error>();
    is_error::<Refusal>();
}

#[tokio::test(start_paused = true)]
async fn refuses_a_request_that_is_larger_than_a_frame() {
    let mut dry_run = Client::dry_run(Options::new(MODEL).with_risk(Risk::Motion));
    let mut client = simulated(Risk::Motion).await;
    for bytes in [MAX_DATA + 1, 70_000] {
        let request = Request { data: vec![0; bytes], ..ReadStatus.request() };
        for client in [&mut client, &mut dry_run] {
            let error = client.raw(&request).await.unwrap_err();
            assert!(matches!(error, Error::TooLarge { bytes: found } if found == bytes), "{error}");
        }
        dry_run.plan(&request, "a frame that is never sent");
    }
    assert_eq!(client.totals.sent, 0);
}

#[tokio::test(start_paused = true)]
async fn accepts_the_longest_time_limit() {
    let options = Options { timeout: Duration::MAX, retries: u32::MAX, ..Options::new(MODEL) };
    let mut client = Client::connect(Endpoint::simulator(MODEL), options).await.unwrap();
    assert!(client.ask(&ReadStatus).await.unwrap().servo_on());
    let take = |_: &[u8]| Ok::<_, Infallible>(());
    let end = client.download(&list(FileType::Jbi), MAX_FILE, Some(Duration::MAX), take).await.unwrap();
    assert!(matches!(end, DownloadEnd::Complete { .. }), "{end:?}");
    client.stop().await.unwrap();
    client.close().await.unwrap();
}
