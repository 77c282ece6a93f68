//! Parallel tasks, and start and stop of programs.

use super::{Bench, What};

#[test]
fn tasks_run_in_parallel() {
    let mut bench = Bench::with(
        &["TSTR TASK=02", "TSTR TASK=03", "TIM TM=001.0", "CNT CN01=0001", "END"],
        "steps.2 = [\"TIM TM=003.0\", \"CNT CN02=0002\", \"END\"]\nsteps.3 = [\"CNT CN03=0003\", \"END\"]",
    );
    bench.start(1500);
    assert_eq!((bench.counter(1), bench.counter(2), bench.counter(3)), (1, 0, 3));
    assert_eq!(bench.page(0) & 0b10, 0b10, "task 2 still runs");
    bench.rest();
    assert_eq!(bench.counter(2), 2);
    assert_eq!(bench.page(0) & 0b10, 0);
}

#[test]
fn tasks_move_their_own_axes() {
    let toml = "write = [\"WPAR E19 1210\"]\nsteps.2 = [\"MOV a X=+0009.00 Y=+0010.00 Z=+0020.00 R=+0009.00 S V=05 POST\", \"END\"]\n\
        steps.4 = [\"MVB S V=05 POST\", \"END\"]\npoints.1.1 = [7.0, 1.0, 1.0, 1.0]";
    let bench = Bench::ran(&["TSTR TASK=02", "MOVP a PT=001 CN=00 S V=05 POST", "END"], toml);
    assert_eq!(bench.error(), None);
    bench.at([7.0, 10.0, 20.0, 0.0]);
    let bench = Bench::ran(&["TSTR TASK=04", "TIM TM=001.0", "CNT CN01=0001", "END"], toml);
    assert_eq!((bench.error(), bench.counter(1)), (Some(0xA0), 0), "a task without axes does not move");
    assert_eq!(bench.sim.state().tasks[3], (false, 1));
}

#[test]
fn tasks_can_be_stopped_continued_and_cancelled() {
    let toml = "steps.2 = [\"TAG TAG=001\", \"CNT+ CN02=0001\", \"TIM TM=000.1\", \"JMP TAG=001\"]";
    let mut bench = Bench::with(
        &[
            "TSTR TASK=02",
            "TIM TM=001.0",
            "TSTO TASK=02",
            "TIM TM=010.0",
            "TRSA TASK=02",
            "TIM TM=001.0",
            "TCAN TASK=02",
            "END",
        ],
        toml,
    );
    bench.start(2000);
    let stopped = bench.counter(2);
    assert!((9..=11).contains(&stopped), "{stopped}");
    bench.pass(8000);
    assert_eq!(bench.counter(2), stopped);
    bench.rest();
    assert!((19..=21).contains(&bench.counter(2)), "{}", bench.counter(2));
    assert_eq!(bench.sim.state().tasks[1], (false, 1));
}

#[test]
fn a_running_task_is_not_started_again() {
    let toml = "steps.2 = [\"TIM TM=001.0\", \"END\"]";
    let bench = Bench::ran(&["TSTR TASK=02", "TSTR TASK=02", "END"], toml);
    assert_eq!(bench.error(), Some(0x63));
    let bench = Bench::ran(&["TSTR TASK=03", "END"], toml);
    assert_eq!(bench.error(), Some(0x63), "a task without steps");
}

#[test]
fn a_move_of_another_task_continues_after_a_stop() {
    let toml = "write = [\"WPAR E19 1100\"]\naxes = 2\n\
        steps.2 = [\"MOV i X=+0000.00 Y=+0100.00 Z=+0000.00 R=+0000.00 S V=05 POST\", \"CNT CN02=0001\", \"END\"]";
    let mut bench =
        Bench::with(&["TSTR TASK=02", "TIM TM=000.3", "TSTO TASK=02", "TIM TM=001.0", "TRSA TASK=02", "END"], toml);
    bench.start(1200);
    let y = bench.sim.state().position[1];
    assert!((50.0..65.0).contains(&y), "{y}");
    bench.rest();
    assert_eq!((bench.error(), bench.counter(2)), (None, 1));
    bench.at([0.0, 100.0, 0.0, 0.0]);
}

#[test]
fn a_stopped_return_to_origin_of_another_task_starts_again() {
    let toml = "write = [\"WPAR E19 1100\"]\naxes = 2\nposition = [0.0, 50.0, 0.0, 0.0]\nsteps.2 = [\"HOME\", \"CNT CN02=0001\", \"END\"]";
    let steps = ["TSTR TASK=02", "TIM TM=000.3", "TSTO TASK=02", "TIM TM=001.0", "TRSA TASK=02", "END"];
    let mut bench = Bench::with(&steps, toml);
    bench.start(1000);
    assert_eq!(bench.page(0) & 0b11000, 0, "it was left off");
    bench.rest();
    assert_eq!((bench.error(), bench.counter(2), bench.page(0)), (None, 1, 0b0011_0000));
    bench.at([0.0; 4]);
}

#[test]
fn step_mode_executes_one_step_at_each_start() {
    let mut bench = Bench::ran(&["CNT CN01=0001", "CNT CN01=0002", "END"], "mode = \"step\"");
    assert_eq!((bench.counter(1), bench.page(0), bench.page(2)), (1, 0b0011_0100, 0b1000_0100));
    bench.resume();
    assert_eq!(bench.counter(1), 2);
    bench.resume();
    assert_eq!(bench.page(0), 0b0011_0000);
    bench.ok("@MPRO");
    bench.ng("@SPST 0001", "program mode");
    assert_eq!(bench.page(2), 0b1000_1000);
}

#[test]
fn single_operation_stops_after_every_move() {
    let steps = [
        "MOV a X=+0001.00 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=05 PASS",
        "MOV a X=+0002.00 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=05 POST",
        "END",
    ];
    let mut bench = Bench::ran(&steps, "write = [\"WPAR M01 0/01/1\"]\ninputs = { \"0/01\" = \"00000001\" }");
    bench.at([1.0, 0.0, 0.0, 0.0]);
    assert_eq!((bench.page(0), bench.page(2)), (0b0011_0100, 0b1001_0000));
    bench.resume();
    bench.at([2.0, 0.0, 0.0, 0.0]);
}

#[test]
fn the_pause_input_holds_and_releases() {
    let steps = ["MOV a X=+0100.00 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=05 POST", "CNT CN01=0001", "END"];
    let mut bench = Bench::with(&steps, "write = [\"WPAR M04 0/01/1\", \"WPAR M07 0/02/1\", \"WPAR M13 0/02/2\"]");
    assert_eq!(bench.port(2), 0b10, "ready");
    bench.start(300);
    bench.console("input 0/01/1 on");
    bench.pass(5000);
    bench.at([60.0, 0.0, 0.0, 0.0]);
    assert_eq!((bench.page(0), bench.page(4), bench.port(2)), (0b0011_0110, 0b0001_1000, 0b11));
    bench.console("input 0/01/1 off");
    bench.rest();
    bench.at([100.0, 0.0, 0.0, 0.0]);
    assert_eq!((bench.counter(1), bench.port(2)), (1, 0b10));
}

#[test]
fn the_continuous_input_restarts_the_program() {
    let mut bench = Bench::with(
        &["CNT+ CN01=0001", "TIM TM=001.0", "END"],
        "write = [\"WPAR M02 0/01/1\"]\ninputs = { \"0/01\" = \"00000001\" }",
    );
    bench.start(3500);
    assert_eq!((bench.counter(1), bench.page(4) & 0b10), (4, 0b10));
    bench.console("input 0/01/1 off");
    bench.rest();
    assert_eq!(bench.counter(1), 4);
}

#[test]
fn after_an_error_the_first_task_can_continue() {
    let mut bench = Bench::ran(&["CNT CN01=0001", "JMP TAG=001", "END"], "steps.2 = [\"TIM TM=100.0\", \"END\"]");
    assert_eq!((bench.error(), bench.page(0), bench.page(1)), (Some(0xA1), 0b0011_0001, 0xA1));
    bench.answers("@RSTX 0000", "@RSTX 0002 JMP TAG=001");
    bench.ok("@WSTX 0002 CNT CN01=0002");
    bench.ng("@SPST 0000", "error");
    bench.ok("@CERR");
    assert_eq!(bench.page(1), 0);
    bench.resume();
    assert_eq!((bench.counter(1), bench.error()), (2, None));
}

#[test]
fn reset_returns_to_the_first_step() {
    let mut bench = Bench::ran(&["OUT STN=0 PN01=.......1", "STOP", "END"], "write = [\"WPAR M11 E\"]");
    assert_eq!(bench.port(1), 1);
    bench.ok("@REST");
    assert_eq!((bench.page(0), bench.port(1)), (0b0011_0000, 0));
    bench.answers("@RSTX 0000", "@RSTX 0001 OUT STN=0 PN01=.......1");
    bench.ok("@WSTX 0002 TIM TM=100.0");
    bench.ok("@SPST 0000");
    bench.ng("@REST", "or jog runs");
    bench.ng("@WSTX 0001 NOP", "or jog runs");
    bench.ng("@MSTP", "or jog runs");
    bench.ng("@HOME", "or jog runs");
}

#[test]
fn a_tag_search_changes_the_current_step() {
    let mut bench = Bench::with(&["END", "NOP", "TAG TAG=020", "CNT CN01=0001", "END"], "");
    bench.ok("@SSTG TAG=020");
    bench.answers("@RSTX 0000", "@RSTX 0003 TAG TAG=020");
    bench.ng("@SSTG TAG=021", "no such tag");
    bench.resume();
    assert_eq!(bench.counter(1), 1);
}

#[test]
fn the_trace_contains_all_events() {
    let mut bench = Bench::with(
        &["OUT STN=0 PN01=......1.", "MOV a X=+0010.00 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=05 POST", "END"],
        "",
    );
    bench.sim.record_trace(true);
    bench.run();
    let events: Vec<_> = bench.sim.take_trace().into_iter().map(|event| event.what).collect();
    let output = What::Output { station: 0, port: 1, bits: 2 };
    let step = |step| What::Step { task: 1, step };
    assert_eq!(events, [step(1), output, step(2), step(3), What::Ended(1)]);
    assert!(bench.sim.take_trace().is_empty());
}
