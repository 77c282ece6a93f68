//! Replays of recorded answers, and the state that follows them.

use super::*;
use crate::simulator::recording::{Answers, Recording, Replayable as _, Sample};
use crate::yerc::recording::answer_text;

const SERVO: u16 = 2;

/// Reads requests: command, instance, service and data. Returns the exchanges.
fn read(start: &str, requests: &[(u16, u16, u8, &[u8])]) -> Answers {
    let mut bench = Bench::new(start);
    let exchange = |&(command, instance, service, data): &(u16, u16, u8, &[u8])| {
        let (status, answer) = bench.ask(command, instance, 0, service, data);
        let request = Request { command, instance, attribute: 0, service, data: data.to_vec() };
        (request_text(&request), answer_text(status, &answer))
    };
    requests.iter().map(exchange).collect()
}

/// A simulator that replays a sample each second.
fn replay(samples: impl IntoIterator<Item = Option<Answers>>) -> Bench {
    let samples = (0..).zip(samples).map(|(seconds, answers)| Sample { at: Duration::from_secs(seconds), answers });
    let start = Start::parse("job = \"TESTJOB\"", |_| Err(String::new()))
        .unwrap()
        .with_recording(Recording::new(samples.collect(), None));
    Bench { simulator: Simulator::new(start), now: Now::ZERO }
}

#[test]
fn changes_are_checked_in_the_recorded_state() {
    const STATUS: &[(u16, u16, u8, &[u8])] = &[(0x72, 1, 1, &[])];
    let states = ["", "mode = \"teach\"", "remote = false", "servo = false\nalarm = [{ code = 4315 }]", ""];
    let mut bench = replay(states.map(|state| Some(read(state, STATUS))));
    let refusals = [None, Some(code::MODE), Some(code::NOT_REMOTE), Some(code::ALARM), None];
    for (state, refusal) in states.into_iter().zip(refusals) {
        let expected = refusal.map_or(Status::OK, Status::refused);
        assert_eq!(bench.set_word(0x86, 1, 1), expected, "start of a job: {state}");
        assert_eq!(bench.status(), Bench::new(state).status(), "{state}");
        // A change does not change what was recorded.
        bench.set_word(0x83, SERVO, 2);
        bench.console("alarm clear");
        assert_eq!(bench.status(), Bench::new(state).status(), "{state}");
        bench.wait(1000);
    }
}

#[test]
fn alarm_has_the_recorded_data_while_it_is_active() {
    let reads: [(u16, u16, u8, &[u8]); 3] = [(0x72, 1, 1, &[]), (0x70, 1, 1, &[]), (0x70, 2, 1, &[])];
    let active = read("alarm = [{ code = 4511, data = 7, type = 3 }]", &reads);
    let alarm = unhex_answer(&active, 0x70);
    let mut bench = replay([Some(active), Some(read("", &reads[..1]))]);
    assert_eq!(bench.read(0x70, 1), alarm);
    let history = bench.read(0x71, 1001);
    assert_eq!(history[..4], alarm[..4], "the history has the alarm");
    bench.wait(1000);
    assert_eq!(bench.read(0x70, 1)[..4], [0; 4], "the earlier answer is old");
}

fn unhex_answer(answers: &Answers, command: u16) -> Vec<u8> {
    let request = Request { command, instance: 1, attribute: 0, service: 1, data: Vec::new() };
    parse_answer(&answers[&request_text(&request)]).unwrap().1
}

#[test]
fn recorded_elements_are_read_in_another_form() {
    let two = 2_u32.to_le_bytes();
    let start = "variables = { B0 = 9, B1 = 8 }\nio = { 10017 = true }\nregisters = { 5 = 700 }";
    let reads: [(u16, u16, u8, &[u8]); 3] = [(0x302, 0, 0x33, &two), (0x300, 1001, 0x33, &two), (0x301, 4, 0x33, &two)];
    let mut bench = replay([Some(read(start, &reads))]);
    assert_eq!(bench.ask(0x7A, 1, 1, 0x0E, &[]), (Status::OK, vec![8]));
    assert_eq!(bench.ask(0x78, 1001, 1, 0x0E, &[]), (Status::OK, vec![0x80]));
    assert_eq!(bench.ask(0x79, 5, 1, 0x0E, &[]), (Status::OK, 700_u16.to_le_bytes().to_vec()));
}

#[test]
fn recorded_refusal_is_repeated() {
    let request = Request { command: 0x7A, instance: 0, attribute: 1, service: 0x0E, data: Vec::new() };
    let answer = answer_text(Status::refused(code::BUSY), &[]);
    let mut bench = replay([Some(Answers::from([(request_text(&request), answer)]))]);
    assert_eq!(bench.ask(0x7A, 0, 1, 0x0E, &[]).0, Status::refused(code::BUSY));
}

#[test]
fn silent_controller_answers_nothing() {
    let mut bench = replay([Some(Answers::new()), None, Some(Answers::new())]);
    let request = RequestFrame { id: 1, ..RequestFrame::from(&read_status()) }.emit();
    for answers in [1, 0, 1] {
        assert_eq!(bench.exchange(Division::Robot, PEER, &request).len(), answers);
        bench.wait(1000);
    }
}

fn read_status() -> Request {
    Request { command: 0x72, instance: 1, attribute: 0, service: 1, data: Vec::new() }
}
