//! Programs and tasks (4.6, and chapter 1).

use super::*;

const BLINK: &str = "[[program]]\nnumber = 5\nname = \"A_NAME_LONGER_THAN_16_CHARACTERS\"\ntext = \"\"\"
SO(21)=1
DELAY 500
SO(21)=0
GOSUB *SUB
GOSUB *SHARED
SGI2=SGI2+1
HALT
*SUB:
SGI1=7
RETURN\"\"\"
[[program]]\nnumber = 6\nname = \"COMMON\"\ntext = \"\"\"
HALT
*SHARED:
WAIT DI(27)=1
RETURN\"\"\"
";

fn of_program(command: Command, number: i32) -> Draft {
    command.order().with(Key::Program, number)
}

impl Bench {
    fn variable(&mut self, name: &str) -> Option<i32> {
        self.done(Command::VarGet.order().with(Key::Variable, name)).int(Key::Value)
    }

    /// States and lines of tasks 1 to 8.
    fn tasks(&mut self) -> ([i32; 4], [i32; 4]) {
        let keys = [Key::Task1, Key::Task2, Key::Task3, Key::Task4];
        let states = self.done(Command::TaskStatus.order().with(Key::TaskRange, 0));
        let lines = self.done(Command::TaskLines.order().with(Key::TaskRange, 0));
        (keys.map(|key| states.int(key).unwrap()), keys.map(|key| lines.int(key).unwrap()))
    }
}

#[test]
fn a_program_is_registered_runs_and_ends() {
    let mut bench = Bench::new(&format!("stock = false\n{BLINK}"));
    assert_eq!(bench.refused(of_program(Command::ProgramRun, 5)), "6.903", "not registered");
    assert_eq!(bench.refused(of_program(Command::ProgramRun, 9)), "3.901", "not there");
    let select = Command::ProgramSelect.order().with(Key::ProgramName, "A_NAME_LONGER_TH").with(Key::Priority, 40);
    bench.done(select.with(Key::Task, 0));
    bench.done(of_program(Command::ProgramRun, 5));
    assert!(bench.is_on(output::PROGRAM_RUNNING) && !bench.is_on(output::PROGRAM_RESET));
    assert_eq!(bench.refused(of_program(Command::ProgramShow, 5)), "6.904", "only while it is stopped");
    let lamp = Signal::new(Side::Output, 21).unwrap();
    bench.wait(50);
    assert!(bench.is_on(lamp));
    assert_eq!(bench.tasks(), ([1, 9, 9, 9], [2, 0, 0, 0]));
    bench.wait(1000);
    assert!(!bench.is_on(lamp));
    assert_eq!(bench.tasks(), ([3, 9, 9, 9], [10_003, 0, 0, 0]), "it waits in COMMON");
    assert_eq!((bench.variable("SGI1"), bench.variable("SGI2")), (Some(7), Some(0)));
    bench.console("DI(27)=1");
    bench.wait(100);
    assert!(!bench.is_on(output::PROGRAM_RUNNING));
    assert_eq!(bench.variable("SGI2"), Some(1));
    assert_eq!(bench.tasks(), ([0, 9, 9, 9], [1, 0, 0, 0]));
}

#[test]
fn executes_lines_step_by_step() {
    let mut bench = Bench::new(&format!("stock = false\n{BLINK}[[task]]\nnumber = 1\nprogram = 5\n"));
    let line = |bench: &mut Bench, draft: Draft| {
        bench.done(draft);
        bench.wait(600);
        assert!(!bench.is_on(output::PROGRAM_RUNNING));
        bench.done(of_program(Command::ProgramShow, 5)).int(Key::Line).unwrap()
    };
    assert_eq!(line(&mut bench, of_program(Command::ProgramStep, 5)), 2);
    assert_eq!(line(&mut bench, Command::ProgramSkip.order().with(Key::Task, 1)), 3);
    assert_eq!(line(&mut bench, of_program(Command::ProgramStep, 5)), 4);
    assert_eq!(line(&mut bench, of_program(Command::ProgramNext, 5)), 5, "with the subroutine");
    assert_eq!(bench.variable("SGI1"), Some(7));
    assert_eq!(line(&mut bench, of_program(Command::ProgramStep, 5)), 10_002, "into the subroutine of COMMON");
    bench.done(Command::ProgramReset.order().with(Key::Task, 1));
    bench.wait(5);
    assert!(bench.is_on(output::PROGRAM_RESET));
    assert_eq!(bench.done(of_program(Command::ProgramShow, 5)).int(Key::Line), Some(1));
}

#[test]
fn stop_input_stops_and_start_continues() {
    let mut bench = Bench::default();
    bench.pulse(input::PROGRAM_RESET);
    assert!(bench.is_on(output::PROGRAM_RESET));
    bench.pulse(input::AUTO_START);
    assert!(bench.is_on(output::PROGRAM_RUNNING) && !bench.is_on(output::PROGRAM_RESET));
    bench.pulse(input::PROGRAM_RESET);
    assert!(!bench.is_on(output::PROGRAM_RESET), "not while it runs");
    bench.set(input::STOP, false);
    assert!(!bench.is_on(output::PROGRAM_RUNNING));
    let (states, lines) = bench.tasks();
    assert_eq!(states[..2], [0, 0]);
    let there = bench.pulses(1);
    bench.pulse(input::AUTO_START);
    assert!(!bench.is_on(output::PROGRAM_RUNNING), "not while SI(06) is off");
    bench.set(input::STOP, true);
    assert_eq!(bench.pulses(1), there);
    assert_eq!(bench.tasks().1, lines);
    bench.pulse(input::AUTO_START);
    bench.wait(10_000);
    assert!(bench.is_on(output::PROGRAM_RUNNING));
    assert!(bench.variable("SGI0").unwrap() > 3);
    bench.console("mode manual");
    bench.wait(200);
    assert!(!bench.is_on(output::PROGRAM_RUNNING) && !bench.is_on(output::AUTO_MODE));
    assert_eq!(bench.refused(Command::ProgramRun.order().with(Key::Selection, "all")), "6.902");
}

#[test]
fn a_relative_move_of_a_program_keeps_its_target_as_well() {
    let text = "[points]\n1 = { mm = [300, 0, 0, 0] }\n[[program]]\nnumber = 7\nname = \"REL\"\n\
                text = \"MOVEI P,P1\"\n[[task]]\nnumber = 7\nprogram = 7\n";
    let mut bench = Bench::new(text);
    bench.done(of_program(Command::ProgramRun, 7));
    bench.wait(200);
    bench.set(input::STOP, false);
    assert!((1..300_000).contains(&bench.pulses(1)[0]));
    bench.set(input::STOP, true);
    bench.done(of_program(Command::ProgramRun, 7));
    bench.wait(2000);
    assert_eq!(bench.pulses(1)[0], 300_000);
}

#[test]
fn an_error_stops_every_program_and_is_remembered() {
    let text = "[[program]]\nnumber = 7\nname = \"BAD\"\ntext = \"MOVE P,P29999\"\n[[task]]\nnumber = 7\nprogram = 7\n";
    let mut bench = Bench::new(text);
    bench.done(Command::ProgramRun.order().with(Key::Selection, "all"));
    bench.wait(100);
    assert!(!bench.is_on(output::PROGRAM_RUNNING));
    let entry = bench.done(Command::AlarmHistory.order().with(Key::History, 1));
    let keys = [Key::AlarmGroup, Key::AlarmCategory, Key::Place1, Key::Place2, Key::Place2Number];
    assert_eq!(keys.map(|key| entry.int(key).unwrap()), [2, 904, 2, 4, 7]);
    for (text, why) in [
        ("GOTO *NOWHERE", "no label"),
        ("RETURN", "RETURN without GOSUB"),
        ("*A:\nGOSUB *A", "too many nested calls"),
        ("SGI1=1/0", "division by zero"),
    ] {
        let mut bench = Bench::new(&format!(
            "[[program]]\nnumber = 7\nname = \"BAD\"\ntext = \"\"\"{text}\"\"\"\n[[task]]\nnumber = 7\nprogram = 7\n"
        ));
        bench.done(of_program(Command::ProgramRun, 7));
        bench.wait(500);
        assert!(bench.console("why").contains(why), "{text}");
    }
}

#[test]
fn a_robot_that_a_program_moves_is_not_moved_by_a_command() {
    let mut bench = Bench::new("stock = true\n[[robot]]\nprogram_speed = 1\n[[robot]]\n");
    bench.done(of_program(Command::ProgramRun, 1));
    bench.wait(100);
    assert_eq!(bench.refused(Command::MovePtp.order().with(Key::Point, 0)), "2.903");
    bench.done(Command::MovePtp.order().with(Key::Point, 0).with(Key::Robot, 2));
    assert_eq!(bench.refused(Command::ProgramReset.order().with(Key::Selection, "all")), "6.904");
    assert_eq!(
        bench.refused(Command::ProgramSelect.order().with(Key::Program, 2).with(Key::Task, 1).with(Key::Priority, 1,)),
        "6.904"
    );
}
