//! Memory: limits, wear, clearing, copies, card.

use super::super::Cell;
use super::Bench;

#[test]
fn tasks_have_their_own_points_and_steps() {
    let mut bench = Bench::ready("steps.2 = [\"NOP\", \"END\"]");
    bench.ok("@WPAR T1 PT=999 X=+0001.00 Y=+0000.00 Z=+0000.00 R=+0000.00");
    bench.ok("@CTSK TASK=02");
    bench.answers("@MTSK", "@MTSK TASK=02");
    bench.answers("@RPAR T1 PT=999", "@RPAR T1 PT=999 X=+0000.00 Y=+0000.00 Z=+0000.00 R=+0000.00");
    bench.answers("@RSTX 0002", "@RSTX 0002 END");
    bench.ng("@RSTX 0003", "no step 3");
    bench.ng("@WSTX 0003 NOP", "task 2 has 2 steps");
    bench.ok("@CTSK TASK=01");
    bench.answers("@RPAR T1 PT=999", "@RPAR T1 PT=999 X=+0001.00 Y=+0000.00 Z=+0000.00 R=+0000.00");
    bench.answers("@RSTX 1998", "@RSTX 1998 NOP");
    bench.ok("@CTSK TASK=04");
    bench.ng("@RSTX 0000", "no step");
}

#[test]
fn parameter_e22_divides_the_steps_among_tasks() {
    let mut bench = Bench::ready(
        "steps.1 = [\"NOP\", \"NOP\", \"END\"]\nwrite = [\"WESY PNO=01 ST=000 START=001 LOOP=0002 END=003\"]",
    );
    bench.ng("@WPAR E22 TASK01=5000 TASK02=0001 TASK03=0000 TASK04=0000", "5000 steps");
    assert_eq!(bench.page(0) & 0x80, 0, "that was no change");
    bench.ok("@WPAR E22 TASK01=0002 TASK02=1998 TASK03=0000 TASK04=0000");
    bench.answers("@RESY PNO=01 ST=000", "@RESY PNO=01 ST=000 START=001 LOOP=0002 END=003");
    bench.ok("@WPAR E22 TASK01=5000 TASK02=0000 TASK03=0000 TASK04=0000");
    assert_eq!(bench.ask("@RSTX 0003"), "@RSTX 0003 NOP", "what was cut off is gone");
    bench.answers("@RSTX 5000", "@RSTX 5000 NOP");
    bench.answers("@RESY PNO=01 ST=000", "@RESY PNO=01 ST=000 START=000 LOOP=0000 END=000");
    bench.ng("@WESY PNO=01 ST=000 START=001 LOOP=0002 END=003", "no such memory address");
}

#[test]
fn steps_are_inserted_deleted_and_copied() {
    let mut bench = Bench::ready(
        "steps.1 = [\"SPD V=01\", \"SPD V=02\", \"SPD V=03\"]\nsteps.2 = [\"NOP\", \"NOP\", \"NOP\", \"END\"]",
    );
    let list = |bench: &mut Bench| -> Vec<String> {
        (1..=5)
            .map(|step| bench.ask(&format!("@RSTX {step:04}")).split(' ').skip(2).collect::<Vec<_>>().join(" "))
            .collect()
    };
    bench.ok("@ISTX 0002");
    assert_eq!(list(&mut bench), ["SPD V=01", "NOP", "SPD V=02", "SPD V=03", "NOP"]);
    bench.ok("@DSTX 0002");
    assert_eq!(list(&mut bench), ["SPD V=01", "SPD V=02", "SPD V=03", "NOP", "NOP"]);
    bench.ok("@CPSS TASK=01 STA=0001 END=0003 TASK=01 TOP=0002");
    assert_eq!(list(&mut bench), ["SPD V=01", "SPD V=01", "SPD V=02", "SPD V=03", "NOP"]);
    bench.ok("@DSTL STA=0001 END=0003");
    assert_eq!(list(&mut bench), ["SPD V=03", "NOP", "NOP", "NOP", "NOP"]);
    bench.ok("@CPSS TASK=01 STA=0001 END=0001 TASK=02 TOP=0003");
    assert_eq!(bench.sim.step(2, 3).unwrap().written(), "SPD V=03");
    bench.ng("@CPSS TASK=01 STA=0001 END=0005 TASK=02 TOP=0003", "no such memory address");
    bench.ng("@DSTL STA=0003 END=0001", "no such memory address");
    bench.ok("@CTSK TASK=02");
    bench.ng("@ISTX 0001", "no such memory address");
}

#[test]
fn writes_are_counted_by_cell() {
    let mut bench = Bench::ready("");
    assert_eq!(bench.sim.wear().total(), 0);
    bench.ok("@WPAR P01 AX1=+0500.00 AX2=+0500.00 AX3=+0500.00 AX4=+0500.00");
    bench.ok("@WPAR P01 AX1=+0500.00 AX2=+0500.00 AX3=+0500.00 AX4=+0500.00");
    bench.ok("@WPAR T1 PT=007 X=+0001.00 Y=+0000.00 Z=+0000.00 R=+0000.00");
    bench.ok("@WPAR T2 V03=0100.0");
    bench.ok("@WSTX 0004 END");
    bench.ok("@WPLT 02 SNO=16 TAG=009");
    bench.ok("@WESY PNO=03 ST=000 START=000 LOOP=0000 END=000");
    bench.ok("@WOVR OV=050");
    bench.ok("@DSTX 0001");
    bench.ng("@WPAR P01 AX1=+9000.00 AX2=+0500.00 AX3=+0500.00 AX4=+0500.00", "range");
    let cells: Vec<(Cell, u64)> = bench.sim.wear().cells().iter().map(|(cell, count)| (*cell, *count)).collect();
    assert_eq!(
        cells,
        [
            (Cell::Parameter("P01"), 2),
            (Cell::Row("T2", 3), 1),
            (Cell::Point { task: 1, row: 7 }, 1),
            (Cell::Step { task: 1, step: 3 }, 1),
            (Cell::Step { task: 1, step: 4 }, 2),
            (Cell::Pallet { program: 2, record: 16 }, 1),
            (Cell::Easy(3), 1),
            (Cell::Override, 1),
        ]
    );
    assert_eq!(bench.sim.wear().total(), 10);
}

#[test]
fn a_worn_cell_answers_ok_and_keeps_its_old_value() {
    let mut bench =
        Bench::ready("eeprom_limit = 2\nsteps = { 1 = [\"NOP\"], 2 = [\"NOP\"], 3 = [\"NOP\"], 4 = [\"END\"] }");
    assert!(bench.sim.step(4, 1).is_some(), "what was there at the start wore nothing");
    for language in ["J", "E", "J", "J"] {
        bench.ok(&format!("@WPAR M09 {language}"));
    }
    bench.answers("@RPAR M09", "@RPAR M09 E");
    bench.ok("@WPAR M11 E");
    bench.answers("@RPAR M11", "@RPAR M11 E");
}

const FULL: &str = "steps = { 1 = [\"END\"], 2 = [\"END\"] }\npoints = { 1 = { 1 = [1.0, 0.0, 0.0, 0.0] }, 2 = { 1 = [2.0, 0.0, 0.0, 0.0] } }\n\
    write = [\"WPLT 01 SNO=16 TAG=009\", \"WESY PNO=01 ST=000 START=001 LOOP=0002 END=003\", \"WPAR M09 J\", \"WPAR T2 V01=0123.0\"]";

/// Which content is not cleared: step and point of tasks 1 and 2, pallet, easy program, parameter, table.
fn left(bench: &mut Bench) -> [bool; 8] {
    let step = |bench: &Bench, task| bench.sim.step(task, 1).is_some_and(|step| step.written() == "END");
    let (one, two) = (step(bench, 1), step(bench, 2));
    bench.ok("@CTSK TASK=02");
    let second = bench.ask("@RPAR T1 PT=001").contains("X=+0002.00");
    bench.ok("@CTSK TASK=01");
    [
        one,
        two,
        bench.ask("@RPAR T1 PT=001").contains("X=+0001.00"),
        second,
        bench.ask("@RPLT 01 SNO=16").contains("TAG=009"),
        bench.ask("@RESY PNO=01 ST=000").contains("START=001"),
        bench.ask("@RPAR M09").ends_with('J'),
        bench.ask("@RPAR T2 V01").ends_with("0123.0"),
    ]
}

#[test]
fn memory_is_cleared_in_part_or_completely() {
    assert_eq!(left(&mut Bench::ready(FULL)), [true; 8]);
    for (what, erased) in [
        ("0", vec![0, 1, 2, 3, 4, 5, 6, 7]),
        ("1", vec![0]),
        ("2", vec![4]),
        ("3", vec![0, 4]),
        ("4", vec![2, 5]),
        ("6", vec![2]),
    ] {
        let mut bench = Bench::ready(FULL);
        bench.ok(&format!("@MINT PR={what}"));
        let expected: [bool; 8] = std::array::from_fn(|place| !erased.contains(&place));
        // Clearing everything also resets E22, so task 2 has no steps.
        assert_eq!(left(&mut bench), expected, "PR={what}");
    }
}

#[test]
fn a_card_transfer_takes_time_and_restores_everything() {
    let mut bench = Bench::ready(&format!("card = \"empty\"\n{FULL}"));
    assert_eq!(bench.page(3), 0b0011_0001);
    bench.ng("@RMCA", "no memory card with data");
    bench.ok("@WMCA");
    assert_eq!(bench.page(3), 0b1011_0001);
    bench.ng("@WPAR M09 E", "in use");
    bench.ng("@SPST 0001", "in use");
    bench.answers("@RPAR M09", "@RPAR M09 J");
    bench.pass(2000);
    assert_eq!(bench.page(3), 0b0011_0001);
    bench.ok("@MINT PR=3");
    bench.ok("@WPAR M09 E");
    bench.ok("@RMCA");
    assert_eq!(bench.page(3), 0b0111_0001);
    bench.pass(2000);
    assert_eq!(left(&mut bench), [true; 8]);
    assert_eq!(bench.page(0) & 0x80, 0);
    bench.ok("@WPAR E02 AX1=00.10 AX2=00.05 AX3=00.05 AX4=00.05");
    bench.console("power cycle");
    assert_eq!(bench.page(0) & 0x80, 0);
    bench.ok("@RMCA");
    bench.pass(2000);
    assert_eq!(bench.page(0) & 0x80, 0x80, "parameter 2 is another one now");
}

#[test]
fn a_removed_card_is_an_error() {
    let mut bench = Bench::ready("card = \"empty\"");
    bench.ok("@WMCA");
    bench.pass(500);
    bench.console("card out");
    assert_eq!((bench.page(1), bench.page(3) & 0xE0), (0xE0, 0));
    bench.ng("@WMCA", "no memory card");
    bench.console("card in");
    bench.ok("@CERR");
    bench.ng("@RMCA", "no memory card with data");
}

#[test]
fn programs_and_records_are_copied() {
    let mut bench = Bench::ready(FULL);
    bench.ok("@CPPL STA=01 TOP=16");
    bench.answers("@RPLT 16 SNO=16", "@RPLT 16 SNO=16 TAG=009");
    bench.ok("@CESY STA=01 TOP=08");
    bench.answers("@RESY PNO=08 ST=000", "@RESY PNO=08 ST=000 START=001 LOOP=0002 END=003");
}
