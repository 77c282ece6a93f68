//! The 55 instructions of sequential programs (TO 2-5).

use super::fields::{
    AIM, ARRIVAL, AXIS, COMPARE, COUNT, COUNTER, COUNTER_OR_NONE, COURSE, GROUP, MASK, POINT_OR_COUNTER, PORT, R, SIDE,
    SPEED, STATION, SWITCH, TAG, TASK, TIME, TIMER, X, Y, Z, digits, fixed, place, plain, word, words,
};
use super::{ALL_MODELS, KCA25, Models};
use crate::toyo::field::{Field, Form};
use crate::toyo::layout::Layout;

/// An instruction of a sequential program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Instruction {
    /// Identifier.
    pub op: Op,
    /// First word of the instruction.
    pub word: &'static str,
    /// Layout of the word and its operands.
    pub layout: Layout,
    /// What the instruction does.
    pub about: &'static str,
    /// Example in user notation.
    pub example: &'static str,
    /// Controllers that support the instruction; empty for all controllers.
    pub only_on: Models,
}

impl Instruction {
    /// The row of an instruction word.
    pub fn named(word: &str) -> Option<&'static Self> {
        INSTRUCTIONS.iter().find(|row| row.word == word)
    }

    /// Syntax for the user, for example `JMPC TAG=<tag> CN<counter><compare><count>`.
    pub fn form(&self) -> String {
        let mut fields = self.layout.fields.iter();
        let mut form = String::new();
        for (index, words) in self.layout.text.split("{}").enumerate() {
            if index > 0 {
                form.push_str(&fields.next().map_or(String::new(), |field| match field.form {
                    Form::Word([one, other]) => format!("{}|{}", one.text, other.text),
                    _ => format!("<{}>", field.name),
                }));
            }
            form.push_str(words);
        }
        form
    }

    /// Whether the instruction needs axes. A task without axes cannot run such an instruction (TO 2-4, E19).
    pub const fn moves(&self) -> bool {
        matches!(
            self.op,
            Op::Home | Op::Mov | Op::Movp | Op::Mvb | Op::Mvc | Op::Mvcp | Op::Mve | Op::Mvm | Op::Rsmv | Op::Tlmv
        )
    }
}

/// Section of the manual that contains all instructions.
pub const SECTION: &str = "2-5";

macro_rules! instructions {
    ($($op:ident $word:literal, $text:literal, $fields:expr, $about:literal, $example:literal $(, $only_on:expr)?;)*) => {
        /// Instruction identifier.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[expect(missing_docs, reason = "each is explained in its row")]
        pub enum Op {
            $($op,)*
        }

        impl Op {
            /// Row of the table.
            pub fn row(self) -> &'static Instruction {
                &INSTRUCTIONS[self as usize]
            }
        }

        /// All instructions, in the order of the manual.
        pub static INSTRUCTIONS: [Instruction; [$(Op::$op),*].len()] = [
            $(Instruction {
                op: Op::$op,
                word: $word,
                layout: Layout::new($text, $fields),
                about: $about,
                example: $example,
                only_on: { let models = ALL_MODELS; $(let models = { let _ = models; $only_on };)? models },
            },)*
        ];
    };
}

const AXES_OR_ALL: Field =
    words("axes", &[word("ALL", "all axes"), plain("X"), plain("Y"), plain("Z"), plain("R")], "which axes");
const LOGIC: Field = words("logic", &[plain("AND"), plain("OR")], "how bits and lines combine");
/// Internal port. The field has one digit (ambiguity R18).
const INTERNAL: Field = digits("port", 1, 1, 9, "internal port");
const OTHER_TASK: Field = digits("task", 2, 2, 4, "task");
/// Task number, which may be 0. The field has one digit, and its key is TA (ambiguity R3).
const ANY_TASK: Field = digits("task", 1, 0, 4, "task");
const RAMP: Field = digits("ramp", 2, 1, 20, "row of the acceleration table");
const AXIS_OF: Field = words("axis", AXIS, "axis");

instructions! {
    Acc "ACC", "ACC A={}", &[RAMP], "select acceleration and deceleration", "ACC A=3";
    Brac "BRAC", "BRAC CN={} OFS={}", &[COUNTER_OR_NONE, digits("offset", 3, 0, 999, "added to the counter")],
        "branch to the tag whose number is counter plus offset", "BRAC CN=1 OFS=100";
    Cal "CAL", "CAL TAG={}", &[TAG], "call the subroutine at a tag", "CAL TAG=20";
    Calc "CALC", "CALC TAG={} CN{}{}{}", &[TAG, COUNTER, COMPARE, COUNT],
        "call if the comparison of a counter is true", "CALC TAG=20 CN1>=5";
    Cali "CALI", "CALI TAG={} STN={} PN{}={}", &[TAG, STATION, PORT, MASK],
        "call if inputs match a bit pattern", "CALI TAG=20 STN=0 PN1=.......1";
    Calt "CALT", "CALT TAG={} TN{}{}{}", &[TAG, TIMER, COMPARE, TIME],
        "call if the comparison of a timer is true", "CALT TAG=20 TN1>=2.5";
    Cans "CANS", "CANS TA={}", &[ANY_TASK], "cancel the pending OUTS of a task", "CANS TA=0";
    Cnt "CNT", "CNT CN{}={}", &[COUNTER, COUNT], "set a counter", "CNT CN1=0";
    CntPlus "CNT+", "CNT+ CN{}={}", &[COUNTER, COUNT], "add to a counter", "CNT+ CN1=1";
    CntMinus "CNT-", "CNT- CN{}={}", &[COUNTER, COUNT], "subtract from a counter", "CNT- CN1=1";
    Cntc "CNTC", "CNTC", &[], "clear all counters", "CNTC";
    Cwit "CWIT", "CWIT CN{}{}{}", &[COUNTER, COMPARE, COUNT],
        "wait until the comparison of a counter is true", "CWIT CN1>=5";
    Dec "DEC", "DEC D={}", &[RAMP], "select deceleration", "DEC D=3", KCA25;
    End "END", "END", &[], "end of the program", "END";
    Home "HOME", "HOME", &[], "return to the origin", "HOME";
    In "IN", "IN STN={} PN{}={} {}", &[STATION, PORT, MASK, LOGIC],
        "wait until inputs match a bit pattern", "IN STN=0 PN1=......10 AND";
    Inpc "INPC", "INPC STN={} PN={} CN={}", &[STATION, PORT, COUNTER],
        "copy an input port to a counter", "INPC STN=0 PN=2 CN=1";
    Iout "IOUT", "IOUT PN{}={}", &[INTERNAL, MASK], "set bits of an internal port", "IOUT PN1=.......1";
    Insp "INSP", "INSP PN{}={} {}", &[INTERNAL, MASK, LOGIC],
        "wait until an internal port matches a bit pattern", "INSP PN1=.......1 AND";
    Jmp "JMP", "JMP TAG={}", &[TAG], "jump to a tag", "JMP TAG=1";
    Jmpc "JMPC", "JMPC TAG={} CN{}{}{}", &[TAG, COUNTER, COMPARE, COUNT],
        "jump if the comparison of a counter is true", "JMPC TAG=1 CN1<5";
    Jmpi "JMPI", "JMPI TAG={} STN={} PN{}={}", &[TAG, STATION, PORT, MASK],
        "jump if inputs match a bit pattern", "JMPI TAG=1 STN=0 PN1=.......1";
    Jmpt "JMPT", "JMPT TAG={} TN{}{}{}", &[TAG, TIMER, COMPARE, TIME],
        "jump if the comparison of a timer is true", "JMPT TAG=1 TN1>2.5";
    Loop "LOOP", "LOOP GRP={} THEN={} ELSE={}", &[GROUP, TAG.named("then"), TAG.named("else")],
        "count to the next position of an MVM group, then jump to THEN or ELSE",
        "LOOP GRP=1 THEN=1 ELSE=2";
    Mini "MINI", "MINI GRP={}", &[GROUP], "reset an MVM group to its first position", "MINI GRP=1";
    Mov "MOV", "MOV {} X={} Y={} Z={} R={} {} V={} {}", &[AIM, X, Y, Z, R, COURSE, SPEED, ARRIVAL],
        "move to coordinates", "MOV a X=100 Y=20.5 Z=0 R=0 S V=0 POST";
    Movp "MOVP", "MOVP {} PT={} CN={} {} V={} {}",
        &[AIM, POINT_OR_COUNTER, COUNTER_OR_NONE, COURSE, SPEED, ARRIVAL], "move to a row of the coordinate table", "MOVP a PT=1 CN=0 S V=0 POST";
    Mvb "MVB", "MVB {} V={} {}", &[COURSE, SPEED, ARRIVAL], "move back", "MVB S V=0 POST";
    Mvc "MVC", "MVC {} X={} Y={} Z={} R={} V={} {}", &[AIM, X, Y, Z, R, SPEED, ARRIVAL],
        "move on an arc through coordinates", "MVC a X=100 Y=20.5 Z=0 R=0 V=0 PASS";
    Mvcp "MVCP", "MVCP {} PT={} CN={} V={} {}", &[AIM, POINT_OR_COUNTER, COUNTER_OR_NONE, SPEED, ARRIVAL],
        "move on an arc through rows of the coordinate table", "MVCP a PT=1 CN=0 V=0 PASS";
    Mve "MVE", "MVE {} PT={} CN={} {} V={}", &[AIM, POINT_OR_COUNTER, COUNTER_OR_NONE, COURSE, SPEED],
        "move to a row of the coordinate table; the escape input ends the move", "MVE a PT=1 CN=0 S V=0";
    Mvm "MVM", "MVM {} GRP={} V={} {} {}",
        &[COURSE, GROUP, SPEED, ARRIVAL, words("target", &[word("DIST", "destination"), word("APPR", "approach")],
            "which point of the position")],
        "move to the current position of an MVM group", "MVM S GRP=1 V=0 POST DIST";
    Nop "NOP", "NOP", &[], "do nothing", "NOP";
    Ofs "OFS", "OFS X={} Y={} Z={} R={}", &[X, Y, Z, R], "offset the next moves by coordinates", "OFS X=10 Y=0 Z=0 R=0";
    Ofsp "OFSP", "OFSP PT={} CN={}", &[POINT_OR_COUNTER, COUNTER_OR_NONE],
        "offset the next moves by a row of the coordinate table", "OFSP PT=10 CN=0", KCA25;
    Out "OUT", "OUT STN={} PN{}={}", &[STATION, PORT, MASK], "set outputs", "OUT STN=0 PN1=......10";
    Outc "OUTC", "OUTC STN={} PN={} CN={}", &[STATION, PORT, COUNTER],
        "copy a counter to an output port", "OUTC STN=0 PN=2 CN=1";
    Outp "OUTP", "OUTP STN={} PN{}={} TM={}", &[STATION, PORT, MASK, fixed("time", (2, 1), 0, 999, "time").unit("s")],
        "set outputs for a time", "OUTP STN=0 PN1=.......1 TM=0.5";
    Outs "OUTS", "OUTS TA={} STN={} PN{}={} {}{}{}",
        &[ANY_TASK, STATION, PORT, MASK, AXIS_OF, SIDE, place("place", "coordinate")],
        "set outputs when an axis passes a position", "OUTS TA=0 STN=0 PN1=.......1 X>=150";
    Pass "PASS", "PASS PASS={}", &[fixed("percent", (3, 1), 1, 1000, "how close the axes pass a pass point").unit("%")],
        "select how close the axes pass pass points", "PASS PASS=50", KCA25;
    Psel "PSEL", "PSEL", &[], "jump as selected by the program selection inputs", "PSEL";
    Ret "RET", "RET", &[], "return from a subroutine", "RET";
    Rsmv "RSMV", "RSMV {} X={} Y={} Z={} R={} {} V={} {}", &[AIM, X, Y, Z, R, COURSE, SPEED, ARRIVAL],
        "move to coordinates that the host sends", "RSMV a X=0 Y=0 Z=0 R=0 S V=0 PASS";
    Spd "SPD", "SPD V={}", &[digits("speed", 2, 1, 10, "row of the speed table")], "select the speed", "SPD V=5";
    Stop "STOP", "STOP", &[], "stop until started again", "STOP";
    Svon "SVON", "SVON {}", &[AXES_OR_ALL], "switch servo power on", "SVON ALL";
    Svof "SVOF", "SVOF {}", &[AXES_OR_ALL], "switch servo power off", "SVOF R";
    Tag "TAG", "TAG TAG={}", &[TAG], "target of a jump", "TAG TAG=1";
    Tcan "TCAN", "TCAN TASK={}", &[OTHER_TASK], "end a task", "TCAN TASK=2";
    Tim "TIM", "TIM TM={}", &[TIME], "wait for a time", "TIM TM=1.5";
    Timp "TIMP", "TIMP TN{}={}", &[TIMER, TIME], "set and start a timer", "TIMP TN1=0";
    Tlmv "TLMV", "TLMV {} TT={} TM={} TE={} LE={} AE={} DD={}",
        &[
            AXIS_OF,
            digits("table", 2, 1, 8, "row of the torque limit table"),
            TIME,
            words("torque_end", SWITCH, "end at the torque limit"),
            words("lock_end", SWITCH, "end when locked"),
            words("arrival_end", SWITCH, "end on arrival"),
            words("overflow", SWITCH, "watch for overflow"),
        ],
        "move an axis with limited torque", "TLMV Z TT=1 TM=0.5 TE=ON LE=OFF AE=ON DD=OFF", KCA25;
    Trsa "TRSA", "TRSA TASK={}", &[TASK], "continue a stopped task", "TRSA TASK=2";
    Tsto "TSTO", "TSTO TASK={}", &[TASK], "stop a task", "TSTO TASK=2";
    Tstr "TSTR", "TSTR TASK={}", &[OTHER_TASK], "start a task", "TSTR TASK=2";
}
