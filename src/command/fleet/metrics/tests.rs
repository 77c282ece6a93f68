//! Tests of the metrics, from events to the page.

use super::board::Board;
use super::catalogue::{METRICS, page};
use super::page::{Form, Kind};
use crate::command::fleet::also::AlsoArguments;
use crate::command::fleet::poll::{Event, PollResult};
use crate::command::fleet::top::testing::{fail, fleet, sample, with_alarm};
use armctl_frame::face::sample::{Sample, Traffic};
use armctl_frame::prelude::*;
use armctl_frame::robot::alarm::Alarm;
use armctl_frame::robot::state::Fault;

fn poll_event(robot: &Arc<Robot>, sample: Sample) -> Event {
    let traffic = Traffic { sent: 5, received: 4, disturbances: 1 };
    let look = PollResult::new(Arc::clone(robot), sample);
    Event::Polled(Arc::new(PollResult { took: Duration::from_millis(30), missed: 2, traffic, ..look }))
}

fn failure_event(robot: &Arc<Robot>, pause: u64) -> Event {
    let traffic = Traffic { sent: 3, received: 0, disturbances: 2 };
    Event::Failed { robot: Arc::clone(robot), failure: fail(), pause: Duration::from_secs(pause), traffic }
}

fn robots(count: usize) -> Vec<Arc<Robot>> {
    fleet(count).into_iter().map(Arc::new).collect()
}

fn page_after(events: &[Event]) -> Board {
    let mut board = Board::default();
    for event in events {
        board.record_event(event, 1000.5);
    }
    board
}

/// Samples of a metric, by the start of their lines.
fn samples(board: &Board, name: &str) -> Vec<String> {
    let page = page(board, Form::Text);
    let is_of = |line: &&str| line.strip_prefix(name).is_some_and(|rest| rest.starts_with(['{', ' ']));
    page.lines().filter(is_of).map(|line| line[name.len()..].to_owned()).collect()
}

const CELL1: &str = "robot=\"cell1\",family=\"yerc\"";

#[test]
fn shows_the_current_state_of_a_robot() {
    let robots = robots(1);
    let mut board = page_after(&[Event::Appeared(Arc::clone(&robots[0]))]);
    assert_eq!(samples(&board, "armctl_robot_up"), Vec::<String>::new(), "nobody knows yet");
    assert_eq!(samples(&board, "armctl_polls_total"), [format!("{{{CELL1}}} 0")]);
    let mut polled = sample(-400.0);
    let state = &mut polled.line.state;
    (state.homed, state.emergency_stop) = (Some(true), Some(false));
    (state.program, state.speed_override_percent) = (Some("WELD".to_owned()), Some(25.0));
    board.record_event(&poll_event(&robots[0], polled), 1000.5);
    for (name, value) in [
        ("armctl_robot_up", "} 1"),
        ("armctl_robot_servo_on", "} 1"),
        ("armctl_robot_running", "} 1"),
        ("armctl_robot_held", "} 0"),
        ("armctl_robot_homed", "} 1"),
        ("armctl_robot_emergency_stop", "} 0"),
        ("armctl_robot_speed_override_ratio", "} 0.25"),
        ("armctl_robot_alarms", "} 0"),
        ("armctl_robot_program_info", ",program=\"WELD\"} 1"),
        ("armctl_robot_faulted", "} 0"),
        ("armctl_robot_mode_info", ",mode=\"automatic\"} 1"),
        ("armctl_robot_last_answer_timestamp_seconds", "} 1000.5"),
        ("armctl_polls_total", "} 1"),
        ("armctl_polls_missed_total", "} 2"),
        ("armctl_poll_pause_seconds", "} 0"),
        ("armctl_session_open", "} 0"),
        ("armctl_poll_duration_seconds_count", "} 1"),
    ] {
        assert_eq!(samples(&board, name), [format!("{{{CELL1}{value}")], "{name}");
    }
    let of = |axis: &str, value: &str| format!("{{{CELL1},axis=\"{axis}\"}} {value}");
    assert_eq!(samples(&board, "armctl_axis_position_pulses"), [of("S", "-400"), of("L", "-90000")]);
    assert_eq!(samples(&board, "armctl_axis_position_meters"), [of("X", "1.0005"), of("Y", "-0.02025")]);
    assert_eq!(samples(&board, "armctl_axis_torque_raw"), [of("S", "12"), of("L", "-3")]);
    assert_eq!(samples(&board, "armctl_axis_torque_ratio"), Vec::<String>::new());
    board.record_event(&failure_event(&robots[0], 1), 1001.0);
    assert_eq!(samples(&board, "armctl_robot_up"), [format!("{{{CELL1}}} 0")]);
    for name in ["armctl_robot_servo_on", "armctl_axis_position_pulses", "armctl_robot_mode_info"] {
        assert_eq!(samples(&board, name), Vec::<String>::new(), "{name} is not known of one that is silent");
    }
    assert_eq!(samples(&board, "armctl_robot_last_answer_timestamp_seconds"), [format!("{{{CELL1}}} 1000.5")]);
    board.record_event(&Event::Gone(Arc::clone(&robots[0])), 1002.0);
    assert!(!page(&board, Form::Text).contains("cell1"));
}

#[test]
fn serves_numbers_of_extra_commands() {
    let robots = robots(1);
    let text = "yerc var get B0..B2";
    let also = AlsoArguments::of(&[&format!("parts={text}")]).commands(|_| false).unwrap();
    let mut board = Board { also, ..Board::default() };
    board.record_event(&Event::Appeared(Arc::clone(&robots[0])), 1000.0);
    let item = |name: &str, value: Value| json!({"name": name, "label": "x", "ok": !value.is_null(), "value": value});
    let items = [item("B0", json!(7)), item("B1", json!(true)), item("B2", Value::Null), item("B0", json!(8))];
    let extras = vec![(Arc::from(text), Ok(json!({"items": items, "text": "no number"})))];
    let polled = PollResult { extras, ..PollResult::new(Arc::clone(&robots[0]), sample(0.0)) };
    board.record_event(&Event::Polled(Arc::new(polled)), 1000.0);
    let of = |value: &str, number: u8| format!("{{{CELL1},command=\"parts\",value=\"items/{value}\"}} {number}");
    assert_eq!(samples(&board, "armctl_command_value"), [of("B0", 7), of("B1", 1)]);
}

#[test]
fn counts_backoffs_failures_and_times() {
    let robots = robots(1);
    let appeared = Event::Appeared(Arc::clone(&robots[0]));
    let failures: Vec<Event> = [1, 2, 4, 4].into_iter().map(|pause| failure_event(&robots[0], pause)).collect();
    let board = page_after(&[&[appeared][..], &failures].concat());
    assert_eq!(samples(&board, "armctl_poll_backoffs_total"), [format!("{{{CELL1}}} 2")]);
    assert_eq!(samples(&board, "armctl_poll_pause_seconds"), [format!("{{{CELL1}}} 4")]);
    let of = |kind: &str, count: u64| format!("{{{CELL1},kind=\"{kind}\"}} {count}");
    let counts = [of("malformed", 0), of("no_answer", 4), of("refused", 0)];
    assert_eq!(samples(&board, "armctl_poll_failures_total"), counts);
    assert_eq!(samples(&board, "armctl_polls_total"), [format!("{{{CELL1}}} 4")]);
    let board = page_after(&[Event::Appeared(Arc::clone(&robots[0])), poll_event(&robots[0], sample(0.0))]);
    let buckets = samples(&board, "armctl_poll_duration_seconds_bucket");
    let counts: Vec<&str> = buckets.iter().filter_map(|line| line.rsplit(' ').next()).collect();
    assert_eq!(counts, ["0", "0", "0", "1", "1", "1", "1", "1", "1", "1"], "30 ms are in 0.05 and above");
}

#[test]
fn sums_traffic_of_successful_and_failed_polls() {
    let robots = robots(1);
    let appeared = Event::Appeared(Arc::clone(&robots[0]));
    let board = page_after(&[appeared, poll_event(&robots[0], sample(0.0)), failure_event(&robots[0], 1)]);
    for (name, sum) in [("sent", 8), ("received", 4), ("disturbances", 3)] {
        assert_eq!(samples(&board, &format!("armctl_link_{name}_total")), [format!("{{{CELL1}}} {sum}")]);
    }
}

#[test]
fn escapes_the_text_of_a_fault() {
    let robots = robots(2);
    let mut injection = with_alarm();
    let text = format!("\"}} 1\n{}", "x".repeat(5000));
    let alarm = Alarm { code: Some("\\".to_owned()), text: Some(text), ..Alarm::default() };
    injection.line.state.fault = Fault::new(true, Some(&alarm));
    let appeared = robots.iter().map(|robot| Event::Appeared(Arc::clone(robot)));
    let looks = [poll_event(&robots[0], with_alarm()), poll_event(&robots[1], injection)];
    let board = page_after(&appeared.chain(looks).collect::<Vec<_>>());
    let [plain, evil] = &samples(&board, "armctl_robot_fault_info")[..] else { panic!("one each") };
    assert_eq!(plain, &format!("{{{CELL1},code=\"4315\",text=\"COLLISION DETECT [SLURBT]\"}} 1"));
    assert!(evil.contains("code=\"\\\\\"") && evil.ends_with("xxx\"} 1") && evil.len() < 250, "{evil}");
}

#[test]
fn handles_axes_with_the_same_name() {
    let robots = robots(1);
    let mut twice = sample(1.0);
    if let Some(whole) = &mut twice.full {
        whole.axes.iter_mut().for_each(|axis| axis.name = "A".to_owned());
    }
    let board = page_after(&[Event::Appeared(Arc::clone(&robots[0])), poll_event(&robots[0], twice)]);
    let lines = samples(&board, "armctl_axis_position_pulses");
    assert!(lines[0].contains("axis=\"A\"") && lines[1].contains("axis=\"A'\""), "{lines:?}");
}

#[test]
fn reports_a_broken_inventory() {
    let broken = page_after(&[Event::Inventory(Err(fail()))]);
    assert_eq!(samples(&broken, "armctl_inventory_last_reload_successful"), [" 0"]);
    let repaired = page_after(&[Event::Inventory(Err(fail())), Event::Inventory(Ok(()))]);
    assert_eq!(samples(&repaired, "armctl_inventory_last_reload_successful"), [" 1"]);
}

/// The limit that `docs/monitoring/README.md` states.
#[test]
fn limits_the_series_of_a_robot() {
    let robots = robots(3);
    let looks = robots.iter().map(|robot| poll_event(robot, with_alarm()));
    let appeared = robots.iter().map(|robot| Event::Appeared(Arc::clone(robot)));
    let board = page_after(&appeared.chain(looks).collect::<Vec<_>>());
    let page = page(&board, Form::Text);
    let without_axes = page.lines().filter(|line| line.contains("robot=\"cell1\"") && !line.contains("axis="));
    assert!(without_axes.count() <= 35);
}

#[test]
fn documents_each_metric() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/monitoring/README.md");
    let page = std::fs::read_to_string(path).unwrap();
    let rows = page.lines().filter_map(|line| line.strip_prefix("| `armctl_")?.split('`').next());
    let mut rows: Vec<String> = rows.map(|row| format!("armctl_{row}")).collect();
    let name = |metric: &super::catalogue::Metric| match metric.kind {
        Kind::Counter => format!("{}_total", metric.name),
        Kind::Info => format!("{}_info", metric.name),
        Kind::Gauge | Kind::Histogram => metric.name.to_owned(),
    };
    let mut names: Vec<String> = METRICS.iter().map(name).collect();
    rows.sort();
    names.sort();
    assert_eq!(rows, names);
}

#[test]
fn metric_names_follow_the_conventions() {
    for metric in METRICS {
        let name = metric.name;
        assert!(name.starts_with("armctl_") && name.bytes().all(|byte| byte.is_ascii_lowercase() || byte == b'_'));
        assert!(!name.ends_with("_total") && !name.ends_with("_info"), "{name}: its kind says so");
        assert!(metric.unit.is_empty() || name.ends_with(&format!("_{}", metric.unit)), "{name}: OpenMetrics wants it");
        assert!(metric.kind != Kind::Info || metric.unit.is_empty(), "{name}");
        assert!(metric.help.ends_with('.') && !metric.help.contains(['\n', '\\', '"']), "{name}");
    }
}
