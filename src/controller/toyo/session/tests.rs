use super::*;
use crate::testing::{ms, waits};
use crate::toyo::field::{Form, Mask, Value};
use crate::toyo::table::commands::{ROWS, Row};

const SECOND: Duration = Duration::from_secs(1);
const POLICY: Policy = Policy { timeout: SECOND, retries: 2, character: Duration::from_micros(1146) };

fn request(text: &str) -> Request {
    Request::parse(text).unwrap()
}

/// A session that has just sent a request.
fn sent(text: &str, is_repeatable: bool) -> LineSession {
    let mut line = LineSession::new(POLICY);
    line.begin(&request(text), is_repeatable);
    assert_eq!(line.poll(Now::ZERO), Step::Send(format!("{text}\r\n").into_bytes()));
    line
}

fn answered(block: &str) -> Step<ExchangeResult> {
    Step::Done(ExchangeResult::Answered(block.to_owned()))
}

#[test]
fn an_answer_in_pieces_ends_the_exchange() {
    let mut line = sent("@STAS SNO=0", true);
    line.handle(ms(20), b"@STAS SNO=0 ST1=2");
    waits(&mut line, ms(20));
    line.handle(ms(25), b"2 ST2=00\r");
    assert_eq!(line.poll(ms(25)), answered("@STAS SNO=0 ST1=22 ST2=00"));
    line.handle(ms(26), b"\n");
    assert_eq!(line.counters(), Counters { sent: 1, received: 1, ..Counters::default() });
}

#[test]
fn the_time_for_an_answer_begins_after_the_last_character() {
    let mut line = sent("@HOME", false);
    // Transmission of seven characters of 1.146 ms each, then the timeout of one second.
    assert_eq!(line.poll(ms(1)), Step::Wait(Duration::from_micros(7 * 1146) + SECOND));
}

#[test]
fn reads_are_repeated_and_orders_are_not() {
    let mut line = sent("@MTSK", true);
    for _ in 0..2 {
        let deadline = waits(&mut line, ms(1));
        assert_eq!(line.poll(deadline), Step::Send(b"@MTSK\r\n".to_vec()));
    }
    let deadline = waits(&mut line, ms(1));
    assert_eq!(line.poll(deadline), Step::Done(ExchangeResult::NoAnswer));

    let mut line = sent("@HOME", false);
    let deadline = waits(&mut line, ms(1));
    assert_eq!(line.poll(deadline), Step::Done(ExchangeResult::NoAnswer));
    assert_eq!(line.counters().sent, 1);
}

#[test]
fn ok_and_ng_together_are_not_an_answer() {
    for answers in ["@OK\r\n@NG\r\n", "@NG\r\n@OK\r\n"] {
        let mut line = sent("@HOME", false);
        line.handle(ms(20), answers.as_bytes());
        let ended = line.poll(ms(20));
        assert!(
            matches!(&ended, Step::Done(ExchangeResult::InvalidAnswer { why, .. }) if why.contains("both")),
            "{ended:?}"
        );
    }
    let mut line = sent("@HOME", false);
    line.handle(ms(20), b"@OK\r\n@OK\r\n");
    assert_eq!(line.poll(ms(20) + QUIET_TIME), answered("@OK"));
}

#[test]
fn an_ng_during_the_next_read_refutes_an_ok() {
    for text in ["@HOME", "@SVON", "@MINT PR=0"] {
        let mut line = sent(text, false);
        line.handle(ms(20), b"@OK\r\n");
        assert_eq!(line.poll(ms(20)), Step::Wait(ms(20) + QUIET_TIME), "nothing is read back of {text}");
        line.handle(ms(60), b"@NG\r\n");
        let ended = line.poll(ms(60));
        assert!(
            matches!(&ended, Step::Done(ExchangeResult::InvalidAnswer { why, .. }) if why.contains("both")),
            "{ended:?}"
        );
    }
    // After a program start the status is read without delay.
    let mut line = sent("@SPST 0001", false);
    line.handle(ms(20), b"@OK\r\n");
    assert_eq!(line.poll(ms(20)), answered("@OK"));
    // An order whose value is read back needs no wait.
    let mut line = sent("@WOVR OV=050", false);
    line.handle(ms(20), b"@OK\r\n");
    assert_eq!(line.poll(ms(20)), answered("@OK"));
}

#[test]
fn an_ng_before_the_next_answer_refutes_an_ok() {
    let accepted = || {
        let mut line = sent("@HOME", false);
        line.handle(ms(20), b"@OK\r\n");
        assert_eq!(line.poll(ms(70)), answered("@OK"));
        line.begin(&request("@STAS SNO=0"), true);
        assert_eq!(line.poll(ms(70)), Step::Send(b"@STAS SNO=0\r\n".to_vec()));
        line.handle(ms(80), b"@NG\r\n");
        assert_eq!(line.poll(ms(80)), Step::Wait(ms(80) + LATE_ANSWER_WAIT), "the question may still be answered");
        line
    };
    let mut line = accepted();
    line.handle(ms(100), b"@STAS SNO=0 ST1=22 ST2=00\r\n");
    assert_eq!(line.poll(ms(100)), answered("@STAS SNO=0 ST1=22 ST2=00"));
    let (order, ended) = line.take_refuted().unwrap();
    assert_eq!(order.text(), "@HOME");
    assert!(matches!(ended, ExchangeResult::InvalidAnswer { why, .. } if why.contains("both")));
    assert!(line.take_refuted().is_none(), "it is reported once");
    // No other block follows, so the `@NG` is the answer to the read. A busy controller refuses a read in this way.
    let mut line = accepted();
    assert_eq!(line.poll(ms(80) + LATE_ANSWER_WAIT), answered("@NG"));
    assert!(line.take_refuted().is_none());
}

#[test]
fn an_ok_after_an_ok_contradicts_nothing() {
    let mut line = sent("@SPST 0001", false);
    line.handle(ms(20), b"@OK\r\n");
    assert_eq!(line.poll(ms(20)), answered("@OK"));
    line.begin(&request("@STAS SNO=0"), true);
    assert!(matches!(line.poll(ms(30)), Step::Send(_)));
    // The same answer again, for example through a device server that repeats, is no contradiction.
    line.handle(ms(40), b"@OK\r\n@STAS SNO=0 ST1=22 ST2=00\r\n");
    assert_eq!(line.poll(ms(40)), answered("@STAS SNO=0 ST1=22 ST2=00"));
    assert!(line.take_refuted().is_none());
}

#[test]
fn an_order_is_open_for_a_limited_time() {
    let second_read = |at: Now| {
        let mut line = sent("@SPST 0001", false);
        line.handle(ms(20), b"@OK\r\n");
        assert_eq!(line.poll(ms(20)), answered("@OK"));
        let mut ask = |answers: &[u8]| {
            line.begin(&request("@STAS SNO=0"), true);
            assert!(matches!(line.poll(at), Step::Send(_)));
            line.handle(at, answers);
            line.poll(at)
        };
        assert_eq!(ask(b"@STAS SNO=0 ST1=22 ST2=00\r\n"), answered("@STAS SNO=0 ST1=22 ST2=00"));
        let second = ask(b"@NG\r\n@STAS SNO=0 ST1=22 ST2=00\r\n");
        (second, line.take_refuted().map(|(order, _)| order.text()))
    };
    let refuted = Some("@SPST 0001".to_owned());
    assert_eq!(second_read(ms(30)), (answered("@STAS SNO=0 ST1=22 ST2=00"), refuted));
    // Later, the `@NG` is the answer to the read.
    assert_eq!(second_read(ms(20) + CONTRADICTION_WINDOW), (answered("@NG"), None));
}

#[test]
fn an_order_is_open_until_a_read_is_answered() {
    for (first, other) in [("@OK", "@NG"), ("@NG", "@OK")] {
        for row in ROWS.iter().filter(|row| row.is_order()) {
            let order = example(row);
            let mut line = sent(&order, false);
            line.handle(ms(20), format!("{first}\r\n").as_bytes());
            let now = ms(20) + QUIET_TIME;
            assert_eq!(line.poll(now), answered(first), "{order}");
            assert!(line.is_open());
            // The order stays open even if the session is not polled for a long time.
            let now = now + SECOND;
            line.begin(&request("@STAS SNO=0"), true);
            assert!(matches!(line.poll(now), Step::Send(_)));
            line.handle(now, format!("{other}\r\n@STAS SNO=0 ST1=22 ST2=00\r\n").as_bytes());
            assert_eq!(line.poll(now), answered("@STAS SNO=0 ST1=22 ST2=00"));
            let refuted = line.take_refuted().map(|(order, _)| order.text());
            assert_eq!(refuted.as_deref(), Some(&order[..]));
            assert!(!line.is_open());
        }
    }
}

/// An order in the form of the manual, with minimum values.
fn example(row: &Row) -> String {
    let Some(layout) = row.requests.first() else { return format!("@{}", row.word) };
    let values = layout.fields.iter().map(|field| match field.form {
        Form::Number(number) => Value::Number(number.least),
        Form::Word(words) => Value::Word(words[0].text),
        Form::Mask => Value::Mask(Mask::default()),
        _ => Value::Text(match row.word {
            "WPAR" => "M01 0/01/0".to_owned(),
            "WPLT" => "END=0001".to_owned(),
            _ => "NOP".to_owned(),
        }),
    });
    format!("@{}", layout.record(values.collect()).unwrap().emit().unwrap())
}

#[test]
fn a_late_ok_is_not_the_answer_to_the_next_order() {
    let mut line = sent("@MAUT", false);
    let deadline = waits(&mut line, ms(1));
    assert_eq!(line.poll(deadline), Step::Done(ExchangeResult::NoAnswer));
    line.begin(&request("@SVON"), false);
    let settled = waits(&mut line, deadline);
    assert_eq!(settled, deadline + SECOND);
    // The late answer is discarded. The next order is sent as soon as the line is quiet.
    line.handle(deadline + ms(300), b"@OK\r\n");
    assert_eq!(line.poll(deadline + ms(300)), Step::Wait(deadline + ms(350)));
    let now = deadline + ms(350);
    assert_eq!(line.poll(now), Step::Send(b"@SVON\r\n".to_vec()));
    waits(&mut line, now);
    line.handle(now + ms(20), b"@NG\r\n");
    assert_eq!(line.poll(now + ms(20)), answered("@NG"));
}

#[test]
fn the_answer_of_an_abandoned_exchange_is_discarded() {
    let mut line = sent("@SPST 0001", false);
    line.begin(&request("@STOP"), true);
    assert!(matches!(line.poll(ms(5)), Step::Wait(_)), "the line settles first");
    line.handle(ms(30), b"@OK\r\n");
    assert_eq!(line.poll(ms(30)), Step::Send(b"@STOP\r\n".to_vec()));
}

#[test]
fn an_urgent_stop_does_not_wait_for_pending_answers() {
    let mut line = sent("@SPST 0001", false);
    // The answer to the start is pending or lost. The stop is sent at once, and both answers are discarded.
    assert_eq!(line.begin_urgent(ms(5), &request("@STOP")), Some(b"@STOP\r\n".to_vec()));
    line.begin(&request("@STOP"), true);
    assert!(matches!(line.poll(ms(5)), Step::Wait(_)), "the line settles first");
    line.handle(ms(30), b"@OK\r\n");
    assert!(matches!(line.poll(ms(30)), Step::Wait(_)), "that was the start");
    line.handle(ms(40), b"@OK\r\n");
    assert_eq!(line.poll(ms(40)), Step::Send(b"@STOP\r\n".to_vec()));
    line.handle(ms(60), b"@NG\r\n");
    assert_eq!(line.poll(ms(60)), answered("@NG"));
}

#[test]
fn without_a_pending_answer_urgent_sends_nothing() {
    let mut line = LineSession::new(POLICY);
    assert_eq!(line.begin_urgent(Now::ZERO, &request("@STOP")), None);
    let mut line = sent("@SPST 0001", false);
    line.handle(ms(9), b"@OK\r\n");
    assert_eq!(line.begin_urgent(ms(10), &request("@STOP")), None, "nothing is pending_answers");
}

#[test]
fn an_answer_to_another_request_is_discarded() {
    let mut line = sent("@STAS SNO=1", true);
    line.handle(ms(10), b"@OK\r\n@STAS SNO=0 ST1=22 ST2=00\r\n@STAS SNO=1 ST1=00 ST2=00\r\n");
    assert_eq!(line.poll(ms(10)), answered("@STAS SNO=1 ST1=00 ST2=00"));
    assert_eq!(line.counters().foreign, 2);
}

#[test]
fn noise_around_an_answer_is_ignored() {
    let mut line = sent("@MTSK", true);
    line.handle(ms(10), b"\x00\xffx@MT\x80@MTSK TASK=01\r\n");
    assert_eq!(line.poll(ms(10)), answered("@MTSK TASK=01"));
    assert!(line.counters().noise > 0);
}

#[test]
fn a_garbled_read_is_repeated_on_a_quiet_line() {
    let mut line = sent("@MTSK", true);
    line.handle(ms(10), b"@MTSK TA\x80K=01\r\n");
    assert_eq!(line.poll(ms(10)), Step::Wait(ms(60)));
    line.handle(ms(40), b"\x80");
    line.handle(ms(50), b"");
    assert_eq!(line.poll(ms(60)), Step::Wait(ms(90)));
    assert_eq!(line.poll(ms(90)), Step::Send(b"@MTSK\r\n".to_vec()));
    line.handle(ms(110), b"@MTSK TASK=01\r\n");
    assert_eq!(line.poll(ms(110)), answered("@MTSK TASK=01"));
}

#[test]
fn a_garbled_answer_leaves_an_order_open() {
    let mut line = sent("@SVON", false);
    line.handle(ms(10), b"@O\x80\r\n");
    let deadline = waits(&mut line, ms(10));
    assert!(matches!(line.poll(deadline), Step::Done(ExchangeResult::InvalidAnswer { .. })));
}

#[test]
fn an_echo_is_not_an_answer() {
    let mut line = sent("@STAS SNO=0", true);
    line.handle(ms(5), b"@STAS SNO=0\r\n@STAS SNO=0 ST1=00 ST2=00\r\n");
    assert_eq!(line.poll(ms(5)), answered("@STAS SNO=0 ST1=00 ST2=00"));
    assert!(line.echoes());
    // The session knows now that the line echoes, so it recognizes an answer that equals its request.
    line.begin(&request("@TYPE AX1 RTYP=000001"), false);
    assert!(matches!(line.poll(ms(6)), Step::Send(_)));
    line.handle(ms(7), b"@TYPE AX1 RTYP=000001\r\n");
    let deadline = waits(&mut line, ms(7));
    assert_eq!(line.poll(deadline), Step::Done(ExchangeResult::NoAnswer));
}

#[test]
fn an_answer_equal_to_its_request_counts_after_the_timeout() {
    let mut line = sent("@TYPE AX1 RTYP=000001", false);
    line.handle(ms(20), b"@TYPE AX1 RTYP=000001\r\n");
    let deadline = waits(&mut line, ms(20));
    assert_eq!(line.poll(deadline), answered("@TYPE AX1 RTYP=000001"));
}

#[test]
fn ten_thousand_characters_without_line_end_use_bounded_memory() {
    let mut line = sent("@MTSK", false);
    line.handle(ms(10), &[b'A'; 10_000]);
    line.handle(ms(10), b"@");
    line.handle(ms(10), &[b'A'; 10_000]);
    let deadline = waits(&mut line, ms(10));
    assert_eq!(line.poll(deadline), Step::Done(ExchangeResult::NoAnswer));
    assert!(line.counters().noise >= 10_000);
}

#[test]
fn any_block_answers_a_raw_block() {
    let mut line = LineSession::new(POLICY);
    line.begin_raw("@ABCD");
    assert_eq!(line.poll(Now::ZERO), Step::Send(b"@ABCD\r\n".to_vec()));
    line.handle(ms(9), b"@ABCD\r\n@ABCD X=1\r\n");
    assert_eq!(line.poll(ms(9)), answered("@ABCD X=1"));
}

#[test]
fn an_order_waits_a_limited_time_for_a_quiet_line_and_a_stop_does_not_wait() {
    let mut line = LineSession::new(POLICY);
    line.handle(ms(0), b"@OK\r\n");
    line.begin(&request("@SVON"), false);
    assert_eq!(line.poll(ms(10)), Step::Wait(ms(50)));
    // Blocks of another client arrive continually.
    for at in (40..500).step_by(40) {
        line.handle(ms(at), b"@OK\r\n");
        assert!(matches!(line.poll(ms(at)), Step::Wait(_)), "{at}");
    }
    line.handle(ms(500), b"x");
    assert_eq!(line.poll(ms(510)), Step::Send(b"@SVON\r\n".to_vec()));

    let mut line = LineSession::new(POLICY);
    line.handle(ms(0), b"@OK\r\n");
    line.begin(&request("@STOP"), true);
    assert_eq!(line.poll(ms(10)), Step::Send(b"@STOP\r\n".to_vec()));
}

#[test]
fn an_answer_outside_the_manual_is_accepted_when_it_repeats() {
    let mut line = sent("@RPAR E17", true);
    line.handle(ms(10), b"@RPAR E17 E=I\r\n");
    let again = waits(&mut line, ms(10));
    assert_eq!(line.poll(again), Step::Send(b"@RPAR E17\r\n".to_vec()));
    line.handle(again + ms(10), b"@RPAR E17 E=I\r\n");
    assert_eq!(line.poll(again + ms(10)), answered("@RPAR E17 E=I"));

    // The damage is different each time.
    let mut line = sent("@RPAR E17", true);
    line.handle(ms(10), b"@RPAR E17 E=I\r\n");
    let again = waits(&mut line, ms(10));
    assert_eq!(line.poll(again), Step::Send(b"@RPAR E17\r\n".to_vec()));
    line.handle(again + ms(10), b"@RPAR E17 E=i\r\n");
    assert_eq!(line.poll(again + ms(10)), answered("@RPAR E17 E=i"));
}
