//! Tests of the client as a library, on simulators in virtual time.

use std::sync::{Arc, Mutex};

use armctl_controller::toyo::simulator::Start;

use super::*;

/// Connects to a simulator with this start state and these line faults.
async fn connected(risk: Risk, state: &str, faults: Option<&str>) -> Client {
    let faults = faults.map(|text| text.parse().unwrap());
    let start = Box::new(Start::parse(state).unwrap());
    let endpoint = Endpoint::Simulator { start, baud: Some(BAUD), faults };
    Client::connect(endpoint, Options::default().with_risk(risk)).await.unwrap()
}

fn counter(number: i32, value: i32) -> Request {
    Request::of(Command::Mcst, [Value::Number(number), Value::Number(value)])
}

#[test]
fn client_and_its_futures_are_send() {
    fn send(_: impl Send) {}
    let mut client = Client::dry_run(Options::default());
    send(client.status());
    send(client.stop(MotionKind::Jog));
    send(client);
}

#[tokio::test(start_paused = true)]
async fn only_a_stop_is_sent_without_a_grant() {
    let mut client = connected(Risk::Read, "", None).await;
    let denied = client.ask(&Request::bare(Command::Home)).await.unwrap_err();
    assert!(matches!(&denied, Error::NotAuthorized(denied) if denied.risk == Risk::Write), "{denied}: the host first");
    assert!(client.raw_text("@XXXX").await.is_err() && client.moving().is_none());
    client.stop(MotionKind::Program).await.unwrap();
    client.stop(MotionKind::Jog).await.unwrap();
    let sent_before = client.session.counters().sent;
    let denied = client.ask(&Request::bare(Command::Hson)).await.unwrap_err();
    assert!(matches!(denied, Error::NotAuthorized(_)), "a stop grants nothing");
    assert_eq!(client.session.counters().sent, sent_before, "nothing is sent without a grant");
}

#[tokio::test(start_paused = true)]
async fn try_ask_returns_a_refusal_and_ask_fails_with_it() {
    let mut client = connected(Risk::Motion, "host = true\nservo = false\n", None).await;
    let home = Request::bare(Command::Home);
    assert_eq!(client.try_ask(&home).await.unwrap(), Err(Refusal(home.clone())));
    let refused = client.ask(&home).await.unwrap_err();
    assert_eq!(refused.to_string(), "the controller refused HOME (@NG)");
    assert_eq!(client.raw(&home).await.unwrap(), Answer::Refused);
    let point = client.ask(&letters_request()).await.unwrap();
    assert_eq!(point.word("ax1"), Some("X"), "the content, not the block");
}

#[tokio::test(start_paused = true)]
async fn silence_after_an_order_leaves_its_outcome_unknown() {
    let mut client = connected(Risk::Motion, "", Some("drop=100%")).await;
    let silent = client.read_position().await.unwrap_err();
    assert!(matches!(&silent, Error::NoAnswer(silent) if silent.counters.sent == 4), "{silent}");
    let unsent = client.ask(&counter(1, 2)).await.unwrap_err();
    assert!(matches!(unsent, Error::NoAnswer(_)), "the host state was not answered: {unsent}");
    client.keep_host();
    client.is_fenced = true;
    let unknown = client.ask(&counter(1, 2)).await.unwrap_err();
    assert!(matches!(&unknown, Error::OutcomeUnknown(open) if open.request == Some(counter(1, 2))), "{unknown}");
    assert!(matches!(client.stop(MotionKind::Program).await, Err(Error::StopUnconfirmed(_))));
}

#[tokio::test(start_paused = true)]
async fn a_dry_run_plans_orders_and_has_no_answers() {
    let mut client = Client::dry_run(Options::default().with_risk(Risk::Motion));
    client.ask(&counter(1, 2)).await.unwrap();
    assert!(matches!(client.status_of(&[3]).await, Err(Error::DryRun)));
    let plan = client.take_plan();
    let blocks: Vec<_> = plan.frames.iter().filter_map(|frame| frame["text"].as_str()).collect();
    assert_eq!(blocks, ["@STAS SNO=2", "@HSON", "@STAS SNO=0", "@MCST CN01=0002", "@STAS SNO=3", "@HSOF"]);
}

#[derive(Debug, Default)]
struct Keeper(Arc<Mutex<(String, Vec<Event>)>>);

impl Watcher<Event> for Keeper {
    fn frame(&mut self, direction: Direction, _: AddressPair, bytes: &[u8]) {
        if direction == Direction::Sent {
            self.0.lock().unwrap().0.push_str(&String::from_utf8_lossy(bytes));
        }
    }

    fn event(&mut self, event: Event) {
        self.0.lock().unwrap().1.push(event);
    }
}

#[tokio::test(start_paused = true)]
async fn a_watcher_gets_each_change_before_it_is_sent_and_close_undoes_it() {
    let mut client = connected(Risk::Write, "", None).await;
    let recorded = Arc::<Mutex<(String, Vec<Event>)>>::default();
    client.watch(Keeper(Arc::clone(&recorded)));
    let task = |number| Request::of(Command::Ctsk, [Value::Number(number)]);
    client.borrow(&task(2), task(1)).await.unwrap();
    let (totals, closed) = client.close().await;
    closed.unwrap();
    let (sent, events) = &*recorded.lock().unwrap();
    assert_eq!(
        sent,
        "@STAS SNO=2\r\n@HSON\r\n@STAS SNO=0\r\n@CTSK TASK=02\r\n@STAS SNO=0\r\n@CTSK TASK=01\r\n@STAS SNO=0\r\n@HSOF\r\n"
    );
    assert_eq!(totals.counters.sent, 8);
    let events: Vec<_> = events.iter().filter(|event| !matches!(event, Event::Host { .. })).collect();
    let [Event::TemporaryChange(back), Event::HostSwitch(true), Event::Undone(again), Event::HostSwitch(false)] =
        &events[..]
    else {
        panic!("{events:?}")
    };
    assert_eq!((back, again), (&task(1), &task(1)));
}

#[tokio::test(start_paused = true)]
async fn a_jog_moves_until_stop_and_stop_returns_the_final_position() {
    let mut client = connected(Risk::Motion, "", None).await;
    let before = client.read_position().await.unwrap();
    client.ask(&jog("RS", None)).await.unwrap();
    client.ask(&jog("+L", Some(0))).await.unwrap();
    assert_eq!(client.moving(), Some(MotionKind::Jog));
    tokio::time::sleep(Duration::from_secs(1)).await;
    let after = client.stop(MotionKind::Jog).await.unwrap();
    assert!(after.number("x") > before.number("x") && client.moving().is_none());
    assert_eq!(client.read_position().await.unwrap(), after);
}

#[tokio::test(start_paused = true)]
async fn refuses_a_request_whose_values_do_not_fit() {
    let mut client = connected(Risk::Motion, "host = true", None).await;
    client.status().await.unwrap();
    let before = client.totals().counters.sent;
    let wrong = [status_page(9), jog("XX", None), jog("+C", Some(4)), counter(1_000, -1), Request::bare(Command::Rpar)];
    for request in &wrong[..2] {
        let error = client.raw(request).await.unwrap_err();
        assert!(matches!(error, Error::InvalidRequest(_)), "{error}");
    }
    assert!(client.status_of(&[200]).await.is_err());
    for request in wrong {
        assert!(!request.text().is_empty());
        assert_eq!(
            request.check().is_err(),
            request != jog("+C", Some(4)),
            "no axis moves: a stop: {}",
            request.text()
        );
    }
    assert_eq!(client.totals().counters.sent, before, "nothing was sent");
}

#[tokio::test(start_paused = true)]
async fn accepts_the_longest_time_limit() {
    let options = Options { timeout: Duration::MAX, retries: u32::MAX, ..Options::default() };
    let mut client = Client::connect(Endpoint::simulator(), options.clone()).await.unwrap();
    assert!(client.status().await.unwrap().servo_on());
    client.stop(MotionKind::Jog).await.unwrap();
    client.close().await.1.unwrap();
    let line = Endpoint::simulator().open(Duration::MAX).await.unwrap();
    let mut client = Client::over(line, Duration::MAX, options);
    assert!(client.status().await.unwrap().servo_on());
}
