//! State, alarms, jobs, start states, console.

use super::*;

#[test]
fn each_state_refuses_with_its_own_code() {
    let cases = [
        ("remote off", 0x2100),
        ("mode teach", 0x2080),
        ("servo off", 0x2070),
        ("alarm 8000", 0x2060),
        ("hold pendant on", 0x2020),
        ("hold external on", 0x2040),
        ("edit on", 0x2130),
    ];
    for (line, expected) in cases {
        let mut bench = Bench::new("job = 'HOME'");
        bench.console(line);
        assert_eq!(bench.start(), refused(expected), "start after {line}");
        let order = five_seconds().emit();
        assert_eq!(bench.write(0x8A, 2, 1, 0x02, &order), refused(expected), "move after {line}");
    }
    let mut bench = Bench::default();
    assert_eq!(bench.start(), refused(0x4060));
    assert_eq!(bench.select(b"NOBODY", 0), refused(0x4040));
    assert_eq!(bench.select(b"TESTJOB", 10), Status::OK);
    assert_eq!(bench.select(b"TESTJOB", 1000), refused(0xB004));
    bench.console("remote off");
    assert_eq!(bench.set_word(0x83, 2, 1), refused(0x2100));
    assert_eq!(bench.write(0x7A, 0, 1, 0x10, &[1]), refused(0x2100));
    assert_eq!(bench.file_one(false, 0x09, 0, b"TESTJOB.JBI").0, refused(0x2100));
    let mut bench = Bench::new("play_write = false");
    assert_eq!(bench.write(0x7A, 0, 1, 0x10, &[1]), refused(0x2110));
}

#[test]
fn alarm_switches_power_off_until_a_reset() {
    let mut bench = Bench::default();
    assert_eq!(bench.read(0x70, 1), [0; 60]);
    bench.console("alarm 4315 3 1");
    let status = bench.status();
    assert!(status.alarm() && !status.servo_on());
    assert_eq!(&bench.read(0x70, 1)[28..44], b"COLLISION DETECT");
    assert_eq!(&bench.read(0x30A, 1)[60..66], b"[SV#1]");
    assert_eq!(&bench.read(0x71, 1001)[..2], [0xDB, 0x10]);
    assert_eq!(bench.set_word(0x83, 2, 1), refused(0x2060));
    assert_eq!(bench.set_word(0x82, 1, 1), Status::OK);
    assert_eq!(bench.set_word(0x83, 2, 1), Status::OK);
    assert_eq!(bench.status().words, [0xC2, 0x40]);
    bench.console("alarm 1300");
    assert_eq!(bench.set_word(0x82, 1, 1), refused(0x2060), "a major alarm needs a restart");
    bench.console("alarm clear");
    bench.console("estop");
    assert_eq!(bench.set_word(0x83, 2, 1), refused(0x3450));
}

#[test]
fn every_class_of_the_history_has_entries() {
    let mut bench = Bench::default();
    for first in [1, 1001, 2001, 3001, 4001] {
        assert_ne!(bench.read(0x71, first)[..4], [0; 4], "{first}");
    }
    assert_eq!(bench.read(0x71, 100), [0; 60]);
    let japanese = bench.read(0x71, 2001);
    let (name, _, broken) = encoding_rs::SHIFT_JIS.decode(&japanese[28..42]);
    assert_eq!((&*name, broken), ("エアー圧力低下", false));
}

#[test]
fn a_job_runs_line_by_line() {
    let mut bench = Bench::default();
    assert_eq!(bench.select(b"TESTJOB", 0), Status::OK);
    assert_eq!(bench.start(), Status::OK);
    assert_eq!(bench.start(), refused(0x2010));
    assert_eq!(bench.select(b"HOME", 0), refused(0x2010));
    assert!(bench.status().running());
    bench.wait(1000);
    let job = bench.job();
    assert_eq!((job.name.as_bytes(), job.line, job.speed_override), (&b"TESTJOB"[..], 5, 10_000));
    assert_eq!(job.step, 2);
    assert!(bench.pose(1)[2] < 0, "on its way down");
    bench.wait(60_000);
    assert!(!bench.status().running());
    assert_eq!((bench.job().line, bench.ask(0x7A, 0, 1, 0x0E, &[]).1), (0, vec![3]));
    assert_eq!(bench.pose(1), [68_000, 100_000, 0, 0, -30_000, 0]);
}

#[test]
fn hold_pauses_a_job_and_start_continues_it() {
    let mut bench = Bench::default();
    bench.select(b"TESTJOB", 0);
    bench.start();
    bench.wait(2000);
    bench.set_word(0x83, 1, 1);
    bench.wait(1000);
    let (line, pose) = (bench.job().line, bench.pose(1));
    assert!(!bench.status().running());
    assert_eq!(bench.start(), refused(0x2050));
    bench.set_word(0x83, 1, 2);
    bench.wait(1000);
    assert_eq!((bench.job().line, bench.pose(1)), (line, pose));
    assert_eq!(bench.start(), Status::OK);
    bench.wait(60_000);
    assert_eq!((bench.status().running(), bench.ask(0x7A, 0, 1, 0x0E, &[]).1), (false, vec![3]));
}

#[test]
fn jobs_use_calls_inputs_and_the_cycle() {
    let mut bench = Bench::default();
    bench.select(b"MAIN", 0);
    bench.start();
    bench.wait(100);
    assert_eq!(bench.job().name.as_bytes(), b"TESTJOB");
    assert_eq!(bench.ask(0x7C, 0, 1, 0x0E, &[]).1, [1, 0, 0, 0]);
    assert_eq!(bench.ask(0x78, 1001, 1, 0x0E, &[]).1, [0b10]);
    bench.wait(60_000);
    assert_eq!(bench.job().name.as_bytes(), b"MAIN");
    assert_eq!(bench.ask(0x78, 1001, 1, 0x0E, &[]).1, [0]);

    bench.console("io 10 off");
    bench.select(b"WAITIN", 0);
    bench.start();
    bench.wait(5000);
    assert_eq!((bench.status().running(), bench.job().line), (true, 1));
    bench.console("io 10 on");
    bench.wait(100);
    assert_eq!(bench.ask(0x7A, 10, 1, 0x0E, &[]).1, [1]);
    bench.wait(2000);
    assert_eq!(bench.ask(0x7A, 10, 1, 0x0E, &[]).1, [2]);

    assert_eq!(bench.set_word(0x84, 2, 1), Status::OK);
    bench.select(b"COUNT", 0);
    for line in 1..=3 {
        bench.start();
        bench.wait(100);
        assert_eq!((bench.status().running(), bench.job().line), (false, line));
    }
    assert_eq!(bench.set_word(0x84, 2, 3), Status::OK);
    bench.select(b"COUNT", 0);
    bench.start();
    bench.wait(1000);
    assert!(bench.status().running(), "continuous");
    assert_eq!(bench.set_word(0x84, 2, 2), Status::OK);
    bench.wait(1000);
    assert!(!bench.status().running(), "to the end of the cycle");
}

#[test]
fn management_times_advance() {
    let mut bench = Bench::default();
    let elapsed = |data: Vec<u8>| String::from_utf8(data[16..].to_vec()).unwrap();
    assert_eq!(elapsed(bench.read(0x88, 1)), "002345:00'00");
    bench.wait(3_661_000);
    assert_eq!(elapsed(bench.read(0x88, 1)), "002346:01'01");
    assert_eq!(elapsed(bench.read(0x88, 211)), "000987:00'00");
    bench.write(0x8A, 2, 1, 0x02, &five_seconds().emit());
    bench.wait(60_000);
    assert_eq!(elapsed(bench.read(0x88, 211)), "000987:00'05");
    assert_eq!(bench.ask(0x88, 12, 0, 0x01, &[]).0, refused(0xA001));
}

#[test]
fn parses_a_start_state() {
    let mut bench = Bench::new(
        r#"
        model = "fs100"
        cycle = "continuous"
        answer_delay_ms = 20
        variables = { B0 = 9, S1 = "テスト", P5 = { type = "base", axes = [1, 2, 3] } }
        io = { "25010" = true }
        registers = { "600" = 5 }
        positions = { R1 = [1, 2, 3, 4, 5, 6] }
        [[alarm]]
        code = 4315
        [[event]]
        at_ms = 1000
        do = "alarm clear"
        [[event]]
        at_ms = 1500
        do = "servo on"
        "#,
    );
    bench.simulator.answers = DelayedAnswers::new(Duration::ZERO, MAX_WAITING);
    assert_eq!(bench.ask(0x7A, 0, 1, 0x0E, &[]).1, [9]);
    assert_eq!(bench.ask(0x7E, 1, 1, 0x0E, &[]).1[..6], *b"\x83e\x83X\x83g");
    assert_eq!(bench.ask(0x78, 2501, 1, 0x0E, &[]).1, [1]);
    assert_eq!(bench.ask(0x79, 600, 1, 0x0E, &[]).1, [5, 0]);
    assert_eq!(bench.pose(1), [1, 2, 3, 4, 5, 6]);
    assert_eq!(bench.status().words, [0xC4, 0x10]);
    assert_eq!(bench.simulator.wake(), Some(Duration::from_secs(1)));
    bench.wait(2000);
    assert_eq!(bench.status().words, [0xC4, 0x40]);
}

#[test]
fn start_state_errors_have_a_line_number() {
    let cases = [
        ("\nmodel = 'dx300'", "line 2"),
        ("\n\nspeed = 5", "line 3"),
        ("variables = { B0 = 256 }", "line 1: B0: the value must be 0 to 255"),
        ("variables = { Q0 = 1 }", "'Q0' is not a valid variable"),
        ("\nio = { 10018 = true }", "line 2: '10018' is not a signal"),
        ("\n[[event]]\nat_ms = 0\ndo = 'alrm 1'", "unknown command: 'alrm 1'"),
        ("[[file]]\nname = 'A.JBI'\ntext = 'x'", "'A.JBI' does not contain a job"),
        ("[[file]]\nname = 'A.DAT'\npath = 'nowhere'", "nowhere: no nowhere here"),
        ("job = 'NOBODY'", "no job 'NOBODY'"),
        ("groups = ['R1', 'R9']", "'R9' is not a group"),
    ];
    for (text, expected) in cases {
        let error = Start::parse(text, |path| Err(format!("no {path} here"))).unwrap_err();
        assert!(error.contains(expected), "{text}: {error}");
    }
}

#[test]
fn console_reports_errors() {
    let mut bench = Bench::default();
    let mut wrong = |line: &str| bench.simulator.console(Now::ZERO, line).unwrap_err();
    assert_eq!(wrong("servo maybe"), "'maybe' is not on or off");
    assert_eq!(wrong("io 10018 on"), "#10018: robot user output signals end in 0 to 7");
    assert_eq!(wrong("alarm 0"), "'0' is not a number from 1 to 9999");
    assert!(wrong("dance").starts_with("unknown command: 'dance'"));
    bench.set_word(0x83, 3, 1);
    assert_eq!(bench.simulator.console(Now::ZERO, "mode teach"), Err("the pendant is locked by HLOCK".into()));
    assert!(bench.console("robot").contains("play mode, command remote, servo on, one cycle, hlock"));
}

#[test]
fn delays_answers_and_seeds_busy() {
    let start = Start::parse("answer_delay_ms = 20", |_| Err(String::new())).unwrap();
    let mut simulator = Simulator::new(start);
    let request = hex("5945524320000000030100000000000039393939393939397200010000010000");
    simulator.receive(Now::ZERO, Division::Robot, PEER, &request);
    assert_eq!(simulator.transmit(Duration::from_millis(19)), None);
    assert_eq!(simulator.wake(), Some(Duration::from_millis(20)));
    assert!(simulator.transmit(Duration::from_millis(20)).is_some());
    let busy = |seed| {
        let mut bench =
            Bench { simulator: Simulator::new(Start::default().with_seed(seed).with_busy(0.5)), now: Now::ZERO };
        (0..32).map(|_| bench.ask(0x72, 1, 0, 1, &[]).0 == refused(0xD8FA)).collect::<Vec<_>>()
    };
    assert_eq!(busy(1), busy(1));
    assert_ne!(busy(1), busy(2));
    assert_eq!(Start::for_model(Model::Fs100).model(), Model::Fs100);
}

#[test]
fn the_example_names_every_key() {
    let mut bench = Bench::new(EXAMPLE);
    assert_eq!(bench.status().words, [0xC2, 0x10]);
    assert_eq!(bench.job().name.as_bytes(), b"TESTJOB");
    assert_eq!(bench.select(b"BLINK", 0), Status::OK);
    assert!(Bench::new("stock = false").read(0x71, 1).iter().all(|&byte| byte == 0));
}
