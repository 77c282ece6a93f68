//! The 55 instructions of sequential programs (TO 2-5).

use super::fields::{
    AIM, ARRIVAL, AXIS, COMPARE, COUNT, COUNTER, COUNTER_OR_NONE, COURSE, GROUP, MASK, POINT_OR_COUNTER, PORT, R, SIDE,
    SPEED, STATION, SWITCH, TAG, TASK, TIME, TIMER, X, Y, Z, digits, fixed, place, plain, word, words,
};
use super::{EVERY, KCA25, Models};
use crate::toyo::field::Field;
use crate::toyo::layout::Layout;

/// An instruction of a sequential program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Instruction {
    /// Which.
    pub op: Op,
    /// Its first word.
    pub word: &'static str,
    /// Word and operands.
    pub layout: Layout,
    /// What it does.
    pub about: &'static str,
    /// Controllers that have it; empty for all.
    pub only_on: Models,
}

impl Instruction {
    /// By its word.
    pub fn named(word: &str) -> Option<&'static Self> {
        INSTRUCTIONS.iter().find(|row| row.word == word)
    }

    /// Whether it needs axes: an axisless task cannot do it (TO 2-4, E19).
    pub const fn moves(&self) -> bool {
        matches!(
            self.op,
            Op::Home | Op::Mov | Op::Movp | Op::Mvb | Op::Mvc | Op::Mvcp | Op::Mve | Op::Mvm | Op::Rsmv | Op::Tlmv
        )
    }
}

macro_rules! instructions {
    ($($op:ident $word:literal, $text:literal, $fields:expr, $about:literal $(, $only_on:expr)?;)*) => {
        /// Which instruction.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[expect(missing_docs, reason = "each is explained in its row")]
        pub enum Op {
            $($op,)*
        }

        impl Op {
            /// Its row.
            pub fn row(self) -> &'static Instruction {
                &INSTRUCTIONS[self as usize]
            }
        }

        /// All of them, in the manual's order.
        pub static INSTRUCTIONS: [Instruction; [$(Op::$op),*].len()] = [
            $(Instruction {
                op: Op::$op,
                word: $word,
                layout: Layout::new($text, $fields),
                about: $about,
                only_on: { let models = EVERY; $(let models = { let _ = models; $only_on };)? models },
            },)*
        ];
    };
}

const AXES_OR_ALL: Field =
    words("axes", &[word("ALL", "all axes"), plain("X"), plain("Y"), plain("Z"), plain("R")], "which axes");
const LOGIC: Field = words("logic", &[plain("AND"), plain("OR")], "how bits and lines combine");
/// One digit (ambiguity R18).
const INTERNAL: Field = digits("port", 1, 1, 9, "internal port");
const OTHER_TASK: Field = digits("task", 2, 2, 4, "task");
/// One digit, 0 included: the key is TA (ambiguity R3).
const ANY_TASK: Field = digits("task", 1, 0, 4, "task");
const RAMP: Field = digits("ramp", 2, 1, 20, "row of the acceleration table");
const AXIS_OF: Field = words("axis", AXIS, "axis");

instructions! {
    Acc "ACC", "ACC A={}", &[RAMP], "choose acceleration and deceleration";
    Brac "BRAC", "BRAC CN={} OFS={}", &[COUNTER_OR_NONE, digits("offset", 3, 0, 999, "added to the counter")],
        "branch to the tag that counter and offset add up to";
    Cal "CAL", "CAL TAG={}", &[TAG], "call the subroutine at a tag";
    Calc "CALC", "CALC TAG={} CN{}{}{}", &[TAG, COUNTER, COMPARE, COUNT], "call if a counter compares";
    Cali "CALI", "CALI TAG={} STN={} PN{}={}", &[TAG, STATION, PORT, MASK], "call if inputs are as given";
    Calt "CALT", "CALT TAG={} TN{}{}{}", &[TAG, TIMER, COMPARE, TIME], "call if a timer compares";
    Cans "CANS", "CANS TA={}", &[ANY_TASK], "cancel what OUTS of a task has pending";
    Cnt "CNT", "CNT CN{}={}", &[COUNTER, COUNT], "set a counter";
    CntPlus "CNT+", "CNT+ CN{}={}", &[COUNTER, COUNT], "add to a counter";
    CntMinus "CNT-", "CNT- CN{}={}", &[COUNTER, COUNT], "subtract from a counter";
    Cntc "CNTC", "CNTC", &[], "clear all counters";
    Cwit "CWIT", "CWIT CN{}{}{}", &[COUNTER, COMPARE, COUNT], "wait until a counter compares";
    Dec "DEC", "DEC D={}", &[RAMP], "choose deceleration", KCA25;
    End "END", "END", &[], "end of the program";
    Home "HOME", "HOME", &[], "return to the origin";
    In "IN", "IN STN={} PN{}={} {}", &[STATION, PORT, MASK, LOGIC], "wait until inputs are as given";
    Inpc "INPC", "INPC STN={} PN={} CN={}", &[STATION, PORT, COUNTER], "copy an input port to a counter";
    Iout "IOUT", "IOUT PN{}={}", &[INTERNAL, MASK], "set bits of an internal port";
    Insp "INSP", "INSP PN{}={} {}", &[INTERNAL, MASK, LOGIC], "wait until an internal port is as given";
    Jmp "JMP", "JMP TAG={}", &[TAG], "jump to a tag";
    Jmpc "JMPC", "JMPC TAG={} CN{}{}{}", &[TAG, COUNTER, COMPARE, COUNT], "jump if a counter compares";
    Jmpi "JMPI", "JMPI TAG={} STN={} PN{}={}", &[TAG, STATION, PORT, MASK], "jump if inputs are as given";
    Jmpt "JMPT", "JMPT TAG={} TN{}{}{}", &[TAG, TIMER, COMPARE, TIME], "jump if a timer compares";
    Loop "LOOP", "LOOP GRP={} THEN={} ELSE={}", &[GROUP, TAG.named("then"), TAG.named("else")],
        "count on in an MVM group, and jump by whether there is more";
    Mini "MINI", "MINI GRP={}", &[GROUP], "begin an MVM group anew";
    Mov "MOV", "MOV {} X={} Y={} Z={} R={} {} V={} {}", &[AIM, X, Y, Z, R, COURSE, SPEED, ARRIVAL],
        "move to coordinates";
    Movp "MOVP", "MOVP {} PT={} CN={} {} V={} {}",
        &[AIM, POINT_OR_COUNTER, COUNTER_OR_NONE, COURSE, SPEED, ARRIVAL], "move to a row of the coordinate table";
    Mvb "MVB", "MVB {} V={} {}", &[COURSE, SPEED, ARRIVAL], "move back";
    Mvc "MVC", "MVC {} X={} Y={} Z={} R={} V={} {}", &[AIM, X, Y, Z, R, SPEED, ARRIVAL],
        "move on an arc through coordinates";
    Mvcp "MVCP", "MVCP {} PT={} CN={} V={} {}", &[AIM, POINT_OR_COUNTER, COUNTER_OR_NONE, SPEED, ARRIVAL],
        "move on an arc through rows of the coordinate table";
    Mve "MVE", "MVE {} PT={} CN={} {} V={}", &[AIM, POINT_OR_COUNTER, COUNTER_OR_NONE, COURSE, SPEED],
        "move to a row of the coordinate table, and leave off at the escape input";
    Mvm "MVM", "MVM {} GRP={} V={} {} {}",
        &[COURSE, GROUP, SPEED, ARRIVAL, words("target", &[word("DIST", "destination"), word("APPR", "approach")],
            "which point of the place")],
        "move to the present place of an MVM group";
    Nop "NOP", "NOP", &[], "do nothing";
    Ofs "OFS", "OFS X={} Y={} Z={} R={}", &[X, Y, Z, R], "offset what follows by coordinates";
    Ofsp "OFSP", "OFSP PT={} CN={}", &[POINT_OR_COUNTER, COUNTER_OR_NONE],
        "offset what follows by a row of the coordinate table", KCA25;
    Out "OUT", "OUT STN={} PN{}={}", &[STATION, PORT, MASK], "set outputs";
    Outc "OUTC", "OUTC STN={} PN={} CN={}", &[STATION, PORT, COUNTER], "copy a counter to an output port";
    Outp "OUTP", "OUTP STN={} PN{}={} TM={}", &[STATION, PORT, MASK, fixed("time", (2, 1), 0, 999, "time").unit("s")],
        "set outputs for a time";
    Outs "OUTS", "OUTS TA={} STN={} PN{}={} {}{}{}",
        &[ANY_TASK, STATION, PORT, MASK, AXIS_OF, SIDE, place("place", "coordinate")],
        "set outputs when an axis passes a place";
    Pass "PASS", "PASS PASS={}", &[fixed("percent", (3, 1), 1, 1000, "how near a pass point is passed").unit("%")],
        "choose how near pass points are passed", KCA25;
    Psel "PSEL", "PSEL", &[], "jump by the program selection inputs";
    Ret "RET", "RET", &[], "return from a subroutine";
    Rsmv "RSMV", "RSMV {} X={} Y={} Z={} R={} {} V={} {}", &[AIM, X, Y, Z, R, COURSE, SPEED, ARRIVAL],
        "move to coordinates that the host supplies";
    Spd "SPD", "SPD V={}", &[digits("speed", 2, 1, 10, "row of the speed table")], "choose the speed";
    Stop "STOP", "STOP", &[], "stop until started again";
    Svon "SVON", "SVON {}", &[AXES_OR_ALL], "switch servo power on";
    Svof "SVOF", "SVOF {}", &[AXES_OR_ALL], "switch servo power off";
    Tag "TAG", "TAG TAG={}", &[TAG], "a place to jump to";
    Tcan "TCAN", "TCAN TASK={}", &[OTHER_TASK], "end a task";
    Tim "TIM", "TIM TM={}", &[TIME], "wait for a time";
    Timp "TIMP", "TIMP TN{}={}", &[TIMER, TIME], "set a timer going";
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
        "move an axis with limited torque", KCA25;
    Trsa "TRSA", "TRSA TASK={}", &[TASK], "let a stopped task go on";
    Tsto "TSTO", "TSTO TASK={}", &[TASK], "stop a task";
    Tstr "TSTR", "TSTR TASK={}", &[OTHER_TASK], "start a task";
}
