//! Effects of the instructions.

use super::{Bench, What, fails, ran};

/// Steps of task 1 in execution order.
fn order(bench: &mut Bench) -> Vec<usize> {
    bench.sim.record_trace(true);
    bench.run();
    let events = bench.sim.take_trace();
    events
        .iter()
        .filter_map(|event| match event.what {
            What::Step { task: 1, step } => Some(step),
            _ => None,
        })
        .collect()
}

#[test]
fn counter_instructions_change_counters() {
    let bench = ran(&["CNT CN01=0010", "CNT+ CN01=0005", "CNT- CN01=0002", "CNT CN02=0001", "END"]);
    assert_eq!((bench.counter(1), bench.counter(2)), (13, 1));
    assert_eq!(ran(&["CNT CN01=0010", "CNTC", "END"]).counter(1), 0);
    fails(&["CNT CN01=9999", "CNT+ CN01=0001", "END"], 0xA7);
    fails(&["CNT- CN01=0001", "END"], 0xA7);
}

#[test]
fn jumps_depend_on_their_conditions() {
    let steps = |jump| vec!["CNT CN01=0005", jump, "CNT CN02=0001", "TAG TAG=007", "END"];
    for (jump, jumps) in [
        ("JMP TAG=007", true),
        ("JMPC TAG=007 CN01= 0005", true),
        ("JMPC TAG=007 CN01= 0004", false),
        ("JMPC TAG=007 CN01< 0006", true),
        ("JMPC TAG=007 CN01< 0005", false),
        ("JMPC TAG=007 CN01> 0004", true),
        ("JMPC TAG=007 CN01<=0005", true),
        ("JMPC TAG=007 CN01>=0006", false),
        ("JMPI TAG=007 STN=0 PN01=......0.", true),
        ("JMPI TAG=007 STN=0 PN01=......1.", false),
        ("JMPT TAG=007 TN1= 000.0", true),
        ("JMPT TAG=007 TN1> 000.0", false),
        ("BRAC CN=01 OFS=002", true),
        ("BRAC CN=00 OFS=007", true),
        ("PSEL", false),
    ] {
        let bench = ran(&steps(jump));
        assert_eq!(bench.error(), None, "{jump}");
        assert_eq!(bench.counter(2), u16::from(!jumps), "{jump}");
    }
}

#[test]
fn each_tag_must_exist_exactly_once() {
    fails(&["JMP TAG=001", "END"], 0xA1);
    fails(&["JMP TAG=001", "TAG TAG=001", "TAG TAG=001", "END"], 0xA2);
    fails(&["BRAC CN=00 OFS=000", "END"], 0xB1);
    fails(&["CNT CN01=0900", "BRAC CN=01 OFS=100", "END"], 0xB1);
}

#[test]
fn subroutines_return() {
    let mut bench = Bench::with(
        &[
            "CAL TAG=001",
            "CALC TAG=001 CN01= 0001",
            "CALC TAG=001 CN01= 0001",
            "CALI TAG=001 STN=0 PN01=.......1",
            "CALT TAG=001 TN1<=000.0",
            "END",
            "TAG TAG=001",
            "CNT+ CN01=0001",
            "RET",
        ],
        "",
    );
    assert_eq!(order(&mut bench), [1, 7, 8, 9, 2, 7, 8, 9, 3, 4, 5, 7, 8, 9, 6]);
    assert_eq!(bench.counter(1), 3);
    fails(&["TAG TAG=001", "CAL TAG=001", "END"], 0xA3);
    fails(&["RET", "END"], 0xA4);
}

#[test]
fn a_program_needs_its_end() {
    let bench = Bench::ran(&["NOP", "NOP"], "write = [\"WPAR E22 TASK01=0002 TASK02=0000 TASK03=0000 TASK04=0000\"]");
    assert_eq!(bench.error(), Some(0xB0));
}

#[test]
fn waits_end_when_inputs_match() {
    let mut bench = Bench::with(
        &[
            "IN STN=0 PN02=......11 AND",
            "CNT CN01=0001",
            "IN STN=1 PN03=11...... OR",
            "CNT CN01=0002",
            "INSP PN9=1....... AND",
            "CNT CN01=0003",
            "END",
        ],
        "steps.2 = [\"IOUT PN9=1.......\", \"END\"]",
    );
    bench.start(1000);
    assert_eq!(bench.page(4) & 0b100, 0b100, "it waits for input");
    assert_eq!(bench.sim.wake(), None, "and nothing else happens");
    bench.console("input 0/02/1 on");
    bench.pass(10);
    assert_eq!(bench.counter(1), 0, "both are needed");
    bench.console("input 0/02/2 on");
    bench.pass(10);
    assert_eq!(bench.counter(1), 1);
    bench.console("input 1/03/8 on");
    bench.pass(10);
    assert_eq!(bench.counter(1), 2, "one is enough");
    bench.ok("@STOP");
    assert_eq!(bench.page(4) & 0b100, 0b100);
    bench.ok("@SPST 0000");
    bench.pass(10);
    assert_eq!(bench.counter(1), 2);
}

#[test]
fn a_task_waits_for_another_by_counters_and_internal_ports() {
    let mut bench = Bench::with(
        &["TSTR TASK=02", "INSP PN1=.......1 AND", "CWIT CN05>=0003", "OUT STN=0 PN01=1.......", "END"],
        "steps.2 = [\"TIM TM=001.0\", \"IOUT PN1=.......1\", \"TIM TM=001.0\", \"CNT CN05=0003\", \"END\"]",
    );
    bench.start(1500);
    bench.answers("@MNIN SNO=0 GN=1", "@MNIN SNO=0 GN=1 PN01=00000001 PN02=00000000 PN03=00000000 PN04=00000000");
    assert_eq!(bench.page(4) & 0b100, 0b100, "CWIT waits as well");
    assert_eq!(bench.port(1), 0);
    bench.rest();
    assert_eq!(bench.port(1), 0x80);
    assert_eq!(bench.error(), None);
}

#[test]
fn outputs_are_set_bit_by_bit() {
    let bench = ran(&["OUT STN=0 PN01=1111....", "OUT STN=0 PN01=.0.....1", "OUT STN=4 PN02=10000000", "END"]);
    assert_eq!((bench.port(1), bench.sim.output(4, 2)), (0b1011_0001, Some(0x80)));
    fails(&["OUT STN=0 PN19=.......1", "END"], 0xB5);
    fails(&["OUT STN=1 PN03=.......1", "END"], 0xB5);
    fails(&["JMPI TAG=001 STN=1 PN04=.......1", "END"], 0xB5);
}

#[test]
fn a_pulse_ends_by_itself() {
    let mut bench = Bench::with(&["OUTP STN=0 PN01=......01 TM=01.5", "CNT CN01=0001", "END"], "");
    bench.ok("@DOUT STN=0 PN01=......1.");
    bench.run();
    assert_eq!((bench.counter(1), bench.port(1)), (1, 1), "the program does not wait for it");
    bench.pass(1400);
    assert_eq!(bench.port(1), 1);
    bench.pass(200);
    assert_eq!(bench.port(1), 2, "every bit is inverted again");
}

#[test]
fn ports_and_counters_are_copied() {
    let bench = Bench::ran(
        &["INPC STN=0 PN01=01 CN=01", "OUTC STN=0 PN=02 CN=01", "END"]
            .map(|step| step.replace("PN01=01", "PN=01"))
            .iter()
            .map(String::as_str)
            .collect::<Vec<_>>(),
        "inputs = { \"0/01\" = \"10000001\" }",
    );
    assert_eq!((bench.counter(1), bench.port(2)), (129, 0x81));
    fails(&["CNT CN01=0256", "OUTC STN=0 PN=02 CN=01", "END"], 0xA7);
}

#[test]
fn timer_instructions_wait_for_their_time() {
    let mut bench = Bench::ran(
        &["TIMP TN1=001.0", "TIM TM=002.5", "JMPT TAG=001 TN1>=003.5", "END", "TAG TAG=001", "CNT CN01=0001", "END"],
        "",
    );
    assert_eq!(bench.counter(1), 1);
    let now = bench.now;
    assert!(now >= std::time::Duration::from_millis(2500), "{now:?}");
    bench.answers("@MTMR TN=1", "@MTMR TN1=003.5");
    bench.pass(2000);
    bench.answers("@MTMR TN=1", "@MTMR TN1=005.5");
    bench.pass(2_000_000);
    bench.answers("@MTMR TN=1", "@MTMR TN1=999.9");
    bench.answers("@MTMR TN=2", "@MTMR TN2=000.0");
}

#[test]
fn selection_inputs_select_a_tag() {
    let steps = ["PSEL", "CNT CN01=0001", "END", "TAG TAG=005", "CNT CN01=0002", "END"];
    let mut bench = Bench::ran(&steps, "write = [\"WPAR M05 0/01/5\"]\ninputs = { \"0/01\" = \"00001111\" }");
    assert_eq!(bench.counter(1), 1, "0 goes on");
    bench.console("input 0/01 01010000");
    bench.run();
    assert_eq!(bench.counter(1), 2);
    bench.console("input 0/01 01100000");
    bench.run();
    assert_eq!(bench.error(), Some(0xA1));
}

#[test]
fn a_stop_instruction_waits_for_the_next_start() {
    let mut bench = ran(&["CNT CN01=0001", "STOP", "CNT CN01=0002", "END"]);
    assert_eq!((bench.counter(1), bench.page(0)), (1, 0b0011_0100), "paused");
    bench.answers("@RSTX 0000", "@RSTX 0003 CNT CN01=0002");
    bench.resume();
    assert_eq!((bench.counter(1), bench.page(0)), (2, 0b0011_0000));
}

#[test]
fn servo_power_is_switched_by_axis() {
    let mut bench = ran(&["SVOF X", "MOV a X=+0001.00 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=05 POST", "END"]);
    assert_eq!((bench.error(), bench.sim.state().servo), (Some(0x62), false));
    assert_eq!(bench.page(3) & 1, 0);
    let bench = Bench::ran(
        &["SVON ALL", "MOV a X=+0001.00 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=05 POST", "END"],
        "servo = false",
    );
    assert_eq!((bench.error(), bench.sim.state().servo), (None, true));
    bench.at([1.0, 0.0, 0.0, 0.0]);
}

#[test]
fn a_million_instructions_are_executed() {
    let mut bench = Bench::with(
        &[
            "TAG TAG=001",
            "CNT+ CN01=0001",
            "JMPC TAG=001 CN01< 9999",
            "CNT CN01=0000",
            "CNT+ CN02=0001",
            "JMPC TAG=001 CN02< 0034",
            "END",
        ],
        "instruction_us = 100",
    );
    bench.run();
    assert_eq!(bench.counter(2), 34);
    // 34 times 9999 rounds of three instructions, and some more instructions. Each instruction takes 0.1 ms.
    assert!(bench.now > std::time::Duration::from_secs(100), "{:?}", bench.now);
    assert_eq!(bench.error(), None);
}

#[test]
fn a_controller_without_an_instruction_refuses_it() {
    let mut bench = Bench::ready("model = \"other\"");
    bench.ng("@WSTX 0001 PASS PASS=050.0", "does not have PASS");
    bench.ng("@WPAR T5 LIM01 T=3.00 L=3.00", "does not have T5");
    bench.ng("@EHTR NO=01", "does not have this command");
    bench.ok("@WSTX 0001 ACC A=01");
}

#[test]
fn a_loop_schedules_the_same_pulse_once() {
    let steps = [
        "TAG TAG=001",
        "OUTP STN=0 PN01=.......1 TM=00.5",
        "OUTS TA=0 STN=0 PN02=.......1 X>=+0900.00",
        "CNT+ CN01=0001",
        "JMPC TAG=001 CN01< 1000",
        "END",
    ];
    let mut bench = Bench::with(&steps, "write = [\"WPAR M11 I\"]");
    bench.start(3900);
    assert_eq!(bench.port(1), 1, "every time it begins anew");
    bench.pass(600);
    bench.rest();
    bench.ok("@REST");
    bench.pass(600);
    assert_eq!(bench.port(1), 0);
}

#[test]
fn an_instruction_for_a_missing_axis_is_an_error() {
    let mut bench = Bench::new("axes = 2\nwrite = [\"WPAR E19 4000\"]");
    assert_eq!(bench.page(1), 0xA8);
}
