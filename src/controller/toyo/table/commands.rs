//! The 62 commands (TO 2-1).

use super::fields::{
    AXIS, CC_LINK_RATES, COUNT, COUNTER, MASK, PORT, R, SPEED, STATION, STEP, TAG, TASK, TIME, TIMER, X, Y, Z, digits,
    fixed, word, words,
};
use super::palletizing::MODE;
use super::{ALL_MODELS, KCA, KCA20, Models};
use crate::Risk;
use crate::toyo::field::{Field, Form, Word};
use crate::toyo::layout::Layout;

/// A command of the host.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Row {
    /// Identifier.
    pub command: Command,
    /// Four-letter word.
    pub word: &'static str,
    /// What the command does.
    pub about: &'static str,
    /// Risk of the command. A JOG that moves no axis has a lower risk.
    pub risk: Risk,
    /// Whether the command requires that the host is ON (TO 2-1, note 1; ambiguities C13 and C14).
    pub needs_host: bool,
    /// Whether the command writes the EEPROM. Such a command is refused while a program runs, and it wears the EEPROM
    /// (TO 2-1, note 2).
    pub writes_eeprom: bool,
    /// Forms of the request, without `@`.
    pub requests: &'static [Layout],
    /// Forms of the answer; empty if the answer is `@OK`. The first form that fits is used.
    pub answers: &'static [Layout],
    /// Controllers that support the command; empty for all controllers.
    pub only_on: Models,
    /// Section of the manual.
    pub section: &'static str,
}

impl Row {
    /// The row of a command word. HTSK is another name of CTSK in the list of commands (ambiguity C1).
    pub fn named(word: &str) -> Option<&'static Self> {
        let word = if word == "HTSK" { "CTSK" } else { word };
        ROWS.iter().find(|row| row.word == word)
    }

    /// Whether the answer is `@OK`.
    pub const fn is_order(&self) -> bool {
        self.answers.is_empty()
    }

    const fn new(command: Command, word: &'static str, risk: Risk, section: &'static str, about: &'static str) -> Self {
        Self {
            command,
            word,
            about,
            risk,
            needs_host: false,
            writes_eeprom: false,
            requests: &[],
            answers: &[],
            only_on: ALL_MODELS,
            section,
        }
    }

    const fn asks(self, requests: &'static [Layout]) -> Self {
        Self { requests, ..self }
    }

    const fn answers(self, answers: &'static [Layout]) -> Self {
        Self { answers, ..self }
    }

    const fn host(self) -> Self {
        Self { needs_host: true, ..self }
    }

    const fn eeprom(self) -> Self {
        Self { writes_eeprom: true, ..self }
    }

    const fn on(self, only_on: Models) -> Self {
        Self { only_on, ..self }
    }
}

macro_rules! commands {
    ($($command:ident $word:literal $risk:ident $section:literal $about:literal $(.$method:ident($($argument:tt)*))*;)*) => {
        /// Identifier of a command.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[expect(missing_docs, reason = "each is explained in its row")]
        pub enum Command {
            $($command,)*
        }

        impl Command {
            /// Row of the table.
            pub fn row(self) -> &'static Row {
                &ROWS[self as usize]
            }
        }

        /// All commands, in the order of the manual.
        pub static ROWS: [Row; [$(Command::$command),*].len()] = [
            $({
                const ROW: Row = Row::new(Command::$command, $word, Risk::$risk, $section, $about);
                const ROW_WITH: Row = ROW$(.$method($($argument)*))*;
                const WORD: &[Layout] = &[Layout::words($word)];
                if ROW_WITH.requests.is_empty() { ROW_WITH.asks(WORD) } else { ROW_WITH }
            },)*
        ];
    };
}

const fn one(text: &'static str, fields: &'static [Field]) -> Layout {
    Layout::new(text, fields)
}

const LANGUAGE: Field = words("language", &[word("J", "Japanese"), word("E", "English")], "language of the pendant");
const VERSION: Field = fixed("version", (2, 2), 0, 9999, "version");
const ROBOT_TYPE: Field = digits("robot_type", 6, 0, 999_999, "robot type");
const AXIS_NUMBER: Field = digits("axis", 1, 1, 4, "axis");
const BODY: Field = Field::new("body", Form::Text, "the parameter, row or data, with its values");
const INSTRUCTION: Field = Field::new("text", Form::Text, "instruction");
/// Step 0 is the step in execution (ambiguity C4).
const STEP_OR_CURRENT: Field = digits("step", 4, 0, 5000, "step; 0 means the current step");
const PALLET: Field = digits("program", 2, 1, 16, "palletizing program");
const RECORD: Field = digits("record", 2, 1, 16, "record");
const EASY: Field = digits("program", 2, 1, 8, "easy program");
const ALWAYS_0: Field = digits("st", 3, 0, 0, "always 000");
const SCREEN: Field = digits("screen", 1, 1, 7, "screen");
const OUTPUT_SCREEN: Field = digits("screen", 1, 1, 5, "screen");
const SYSTEM: Field = bits("sy01", "system port");
const ALL_AXES: &[Field] = &[X, Y, Z, R];

/// Memory areas that MINT clears (TO 2-3); 5 is reserved and not included.
pub const CLEARS: &[Word] = &[
    word("0", "everything"),
    word("1", "sequential program of the current task"),
    word("2", "palletizing programs"),
    word("3", "sequential and palletizing programs"),
    word("4", "easy programs and coordinate table"),
    word("6", "coordinate table of the current task"),
];

/// Words of JGST for one axis.
pub const JOGS: &[Word] = &[
    word("RS", "reset"),
    word("SP", "stop"),
    word("-C", "inch in minus direction"),
    word("+C", "inch in plus direction"),
    word("-L", "minus, low speed"),
    word("+L", "plus, low speed"),
    word("-H", "minus, high speed"),
    word("+H", "plus, high speed"),
];

const STATES: &[Word] = &[
    word("START", "start program"),
    word("SOURCE", "source side"),
    word("DESTI", "destination side"),
    word("END", "end program"),
];

const fn bits(name: &'static str, about: &'static str) -> Field {
    Field::new(name, Form::Bits, about)
}

const fn port(name: &'static str) -> Field {
    digits(name, 2, 1, 99, "port")
}

const fn jog(name: &'static str) -> Field {
    words(name, JOGS, "jog action of the axis")
}

const fn letter(name: &'static str) -> Field {
    words(name, AXIS, "letter of the axis")
}

const fn pieces(name: &'static str, about: &'static str) -> Field {
    digits(name, 4, 0, 9999, about)
}

const fn starred(name: &'static str, width: u8, most: i32, about: &'static str) -> Field {
    digits(name, width, 0, most, about).starred()
}

/// In the answer, the ports have numbers, so the field names have the same numbers.
const P1: (Field, Field) = (port("port1"), bits("bits1", "bits 8 to 1"));
const P2: (Field, Field) = (port("port2"), bits("bits2", "bits 8 to 1"));
const P3: (Field, Field) = (port("port3"), bits("bits3", "bits 8 to 1"));
const P4: (Field, Field) = (port("port4"), bits("bits4", "bits 8 to 1"));

commands! {
    Sysp "SYSP" Read "2-2" "robot type, version, language and letters of the axes"
        .answers(&[one(
            "SYSP RTYP={} VER={} {} ARM1={} ARM2={} ARM3={} ARM4={} {}",
            &[
                ROBOT_TYPE, VERSION, LANGUAGE, letter("arm1"), letter("arm2"), letter("arm3"), letter("arm4"),
                Field::new("tail", Form::Text, "undocumented (ambiguity C11)"),
            ],
        )]);
    Hson "HSON" Write "2-2" "host ON: the host has control, and the start input is disabled";
    Hsof "HSOF" Write "2-2" "host OFF: the start input is enabled again";
    Mpro "MPRO" Write "2-2" "program mode".host();
    Mstp "MSTP" Write "2-2" "step mode".host();
    Maut "MAUT" Write "2-2" "automatic mode".host();
    Mseq "MSEQ" Write "2-2" "sequential mode".host();
    Mple "MPLE" Write "2-2" "palletizing mode".host();
    Stas "STAS" Read "2-2" "a page of the status"
        .asks(&[one("STAS SNO={}", &[digits("page", 1, 0, 4, "page")])])
        .answers(&[one(
            "STAS SNO={} ST1={} ST2={}",
            &[
                digits("page", 1, 0, 4, "page"),
                Field::new("st1", Form::Hex, "status bits, or an error code"),
                Field::new("st2", Form::Hex, "normally 00"),
            ],
        )]);
    Cver "CVER" Read "2-2" "version of a station"
        .asks(&[one("CVER NO={}", &[STATION])])
        .answers(&[one("CVER NO={} VER={}", &[STATION, VERSION])]);
    Type "TYPE" Destroy "2-2" "set the robot type of an axis; the answer contains the active type"
        .asks(&[one("TYPE AX{} RTYP={}", &[AXIS_NUMBER, ROBOT_TYPE])])
        .answers(&[one("TYPE AX{} RTYP={}", &[AXIS_NUMBER, ROBOT_TYPE.named("in_force")])]);
    Wpar "WPAR" Destroy "2-4" "write a parameter or a row of a table".asks(&[one("WPAR {}", &[BODY])]).host().eeprom();
    Rpar "RPAR" Read "2-4" "read a parameter or a row of a table"
        .asks(&[one("RPAR {}", &[BODY.named("key")])]).answers(&[one("RPAR {}", &[BODY])]);
    Mint "MINT" Destroy "2-3" "clear memory"
        .asks(&[one("MINT PR={}", &[words("what", CLEARS, "the data to clear")])]).host().eeprom();
    Cpss "CPSS" Destroy "2-3" "copy steps of a sequential program, also between tasks"
        .asks(&[one(
            "CPSS TASK={} STA={} END={} TASK={} TOP={}",
            &[TASK.named("from_task"), STEP.named("first"), STEP.named("last"), TASK.named("to_task"), STEP.named("top")],
        )])
        .host().eeprom();
    Istx "ISTX" Destroy "2-3" "insert a step".asks(&[one("ISTX {}", &[STEP])]).host().eeprom();
    Dstx "DSTX" Destroy "2-3" "delete a step".asks(&[one("DSTX {}", &[STEP])]).host().eeprom();
    Sstg "SSTG" Write "2-3" "search for a tag, and make its step the current step"
        .asks(&[one("SSTG TAG={}", &[TAG])]).host();
    Dstl "DSTL" Destroy "2-3" "delete steps"
        .asks(&[one("DSTL STA={} END={}", &[STEP.named("first"), STEP.named("last")])]).host().eeprom();
    Cppl "CPPL" Destroy "2-3" "copy a palletizing program"
        .asks(&[one("CPPL STA={} TOP={}", &[PALLET.named("from"), PALLET.named("to")])]).host().eeprom();
    Cesy "CESY" Destroy "2-3" "copy an easy program"
        .asks(&[one("CESY STA={} TOP={}", &[EASY.named("from"), EASY.named("to")])]).eeprom();
    Wmca "WMCA" Destroy "2-3" "write all data to the memory card";
    Rmca "RMCA" Destroy "2-3" "read all data from the memory card; this overwrites the stored data";
    Wesy "WESY" Destroy "2-3" "write an easy program"
        .asks(&[one(
            "WESY PNO={} ST={} START={} LOOP={} END={}",
            &[
                EASY, ALWAYS_0, digits("start", 3, 0, 999, "start tag"), digits("loop", 4, 0, 9999, "repetitions"),
                digits("end", 3, 0, 999, "end tag"),
            ],
        )])
        .eeprom();
    Resy "RESY" Read "2-3" "read an easy program"
        .asks(&[one("RESY PNO={} ST={}", &[EASY, ALWAYS_0])])
        .answers(&[one(
            "RESY PNO={} ST={} START={} LOOP={} END={}",
            &[
                EASY, ALWAYS_0, digits("start", 3, 0, 999, "start tag"), digits("loop", 4, 0, 9999, "repetitions"),
                digits("end", 3, 0, 999, "end tag"),
            ],
        )]);
    Wstx "WSTX" Destroy "2-5" "write a step of the sequential program"
        .asks(&[one("WSTX {} {}", &[STEP, INSTRUCTION])]).host().eeprom();
    Rstx "RSTX" Read "2-5" "read a step of the sequential program; 0000 is the current step"
        .asks(&[one("RSTX {}", &[STEP_OR_CURRENT])]).answers(&[one("RSTX {} {}", &[STEP, INSTRUCTION])]);
    Wplt "WPLT" Destroy "2-6" "write a record of a palletizing program"
        .asks(&[one("WPLT {} SNO={} {}", &[PALLET, RECORD, BODY])]).host().eeprom();
    Rplt "RPLT" Read "2-6" "read a record of a palletizing program"
        .asks(&[one("RPLT {} SNO={}", &[PALLET, RECORD])]).answers(&[one("RPLT {} SNO={} {}", &[PALLET, RECORD, BODY])]);
    Home "HOME" Motion "2-7" "return to the origin".host();
    Spst "SPST" Motion "2-7" "start the sequential program; 0000 continues at the current step"
        .asks(&[one("SPST {}", &[STEP_OR_CURRENT])]).host();
    Spln "SPLN" Write "2-7" "select the palletizing program".asks(&[one("SPLN PR={}", &[PALLET])]).host();
    Ppst "PPST" Motion "2-7" "start palletizing".host();
    Sesy "SESY" Motion "2-7" "start the easy program";
    Rpld "RPLD" Read "2-7" "progress of palletizing"
        .answers(&[one(
            "RPLD {} {} PR={} PC1={} PN1={} PC2={} PN2={} PC3={} PN3={} TAG={} STP={}",
            &[
                MODE, words("state", STATES, "the part that is executed"), PALLET,
                pieces("done1", "current piece in direction 1"), pieces("pieces1", "pieces in direction 1"),
                pieces("done2", "current piece in direction 2"), pieces("pieces2", "pieces in direction 2"),
                pieces("done3", "current piece in direction 3"), pieces("pieces3", "pieces in direction 3"),
                digits("tag", 3, 0, 999, "tag of the hand program"), digits("step", 4, 0, 5000, "step being executed"),
            ],
        )]);
    Stop "STOP" Write "2-7" "stop the running program or jog";
    Jgst "JGST" Motion "2-7" "JOG one axis"
        .asks(&[one("JGST X={} Y={} Z={} R={}", &[jog("x"), jog("y"), jog("z"), jog("r")])]).host();
    Dout "DOUT" Write "2-7" "set outputs directly"
        .asks(&[
            one("DOUT STN={} PN{}={}", &[STATION, PORT, MASK]),
            one("DOUT {}", &[digits("direct", 1, 1, 4, "direct output F1 to F4")]),
        ])
        .host();
    Wovr "WOVR" Write "2-7" "write the override; it has no effect on a running program"
        .asks(&[one("WOVR OV={}", &[digits("override", 3, 1, 100, "override").unit("%")])]).host().eeprom();
    Rovr "ROVR" Read "2-7" "read the override"
        .answers(&[one("ROVR OV={}", &[digits("override", 3, 1, 100, "override").unit("%")])]);
    Rest "REST" Write "2-7" "reset";
    Cerr "CERR" Write "2-7" "cancel an error";
    Extp "EXTP" Motion "2-7" "move to a row of the coordinate table"
        .asks(&[one("EXTP PT={}", &[digits("point", 3, 1, 999, "row of the coordinate table")])]).host();
    Svon "SVON" Motion "2-7" "servo power on".host();
    Svof "SVOF" Motion "2-7" "servo power off".host();
    Sesn "SESN" Write "2-7" "select the easy program".asks(&[one("SESN PR={}", &[EASY])]);
    Resd "RESD" Read "2-7" "progress of the easy program"
        .answers(&[one(
            "RESD PR={} ST={} SQS={} SUB={} LOOP={}",
            &[
                EASY, digits("step", 3, 0, 999, "step being executed"),
                digits("sequential", 4, 0, 9999, "step of the sequential program being executed"),
                digits("tag", 3, 0, 999, "tag of the hand program"), digits("loop", 4, 0, 9999, "repetitions"),
            ],
        )]);
    Ctsk "CTSK" Write "2-7" "select the current task".asks(&[one("CTSK TASK={}", &[TASK])]);
    Sorg "SORG" Motion "2-7" "search the origin of synchronized axes"
        .asks(&[one("SORG {}", &[digits("axis", 1, 1, 3, "drive axis")])]).host().on(KCA20);
    Minp "MINP" Read "2-8" "a screen of input ports"
        .asks(&[one("MINP SNO={} GN={}", &[STATION, SCREEN])])
        .answers(&[
            one("MINP SNO={} GN={} SY01={} PN{}={} PN{}={} PN{}={}", &[STATION, SCREEN, SYSTEM, P1.0, P1.1, P2.0, P2.1, P3.0, P3.1]),
            one("MINP SNO={} GN={} PN{}={} PN{}={} PN{}={} PN{}={}", &[STATION, SCREEN, P1.0, P1.1, P2.0, P2.1, P3.0, P3.1, P4.0, P4.1]),
            one("MINP SNO={} PN{}={} PN{}={} PN{}={}", &[STATION, P1.0, P1.1, P2.0, P2.1, P3.0, P3.1]),
        ]);
    Mout "MOUT" Read "2-8" "a screen of output ports"
        .asks(&[one("MOUT SNO={} GN={}", &[STATION, OUTPUT_SCREEN])])
        .answers(&[
            one("MOUT SNO={} GN={} SY01={} PN{}={} PN{}={} PN{}={}", &[STATION, OUTPUT_SCREEN, SYSTEM, P1.0, P1.1, P2.0, P2.1, P3.0, P3.1]),
            one("MOUT SNO={} GN={} PN{}={} PN{}={} PN{}={} PN{}={}", &[STATION, OUTPUT_SCREEN, P1.0, P1.1, P2.0, P2.1, P3.0, P3.1, P4.0, P4.1]),
            one("MOUT SNO={} GN={} PN{}={} PN{}={} PN{}={}", &[STATION, OUTPUT_SCREEN, P1.0, P1.1, P2.0, P2.1, P3.0, P3.1]),
            one("MOUT SNO={} PN{}={} PN{}={}", &[STATION, P1.0, P1.1, P2.0, P2.1]),
        ]);
    Mnin "MNIN" Read "2-8" "the internal ports"
        .asks(&[one("MNIN SNO={} GN={}", &[digits("station", 1, 0, 0, "always 0"), digits("screen", 1, 1, 1, "always 1")])])
        .answers(&[one("MNIN SNO={} GN={} PN{}={} PN{}={} PN{}={} PN{}={}", &[STATION, SCREEN, P1.0, P1.1, P2.0, P2.1, P3.0, P3.1, P4.0, P4.1])]);
    Mpst "MPST" Read "2-8" "the current position".answers(&[one("MPST X={} Y={} Z={} R={}", ALL_AXES)]);
    Moff "MOFF" Read "2-8" "the current offset".answers(&[one("MOFF X={} Y={} Z={} R={}", ALL_AXES)]);
    Mrss "MRSS" Motion "2-8" "send coordinates to a waiting RSMV step"
        .asks(&[one("MRSS TASK={} X={} Y={} Z={} R={} V={}", &[TASK, X, Y, Z, R, SPEED])]);
    Mcnt "MCNT" Read "2-8" "a counter"
        .asks(&[one("MCNT CN={}", &[COUNTER])]).answers(&[one("MCNT CN{}={}", &[COUNTER, COUNT])]);
    Mtmr "MTMR" Read "2-8" "a timer"
        .asks(&[one("MTMR TN={}", &[TIMER])]).answers(&[one("MTMR TN{}={}", &[TIMER, TIME])]);
    Mcst "MCST" Write "2-8" "set a counter".asks(&[one("MCST CN{}={}", &[COUNTER, COUNT])]);
    Merp "MERP" Read "2-8" "the point where the error occurred"
        .answers(&[one("MERP{}", &[Field::new("point", Form::Text, "opaque (ambiguity C5)")])]);
    Mtsk "MTSK" Read "2-8" "the current task".answers(&[one("MTSK TASK={}", &[TASK])]);
    Mbus "MBUS" Read "2-8" "CC-Link"
        .asks(&[one("MBUS C1", &[]), one("MBUS C2", &[])])
        .answers(&[
            one(
                "MBUS C1 STN={} BRT={} VER={}",
                &[
                    digits("station", 2, 0, 99, "station"), words("rate", CC_LINK_RATES, "baud rate"),
                    digits("version", 2, 0, 99, "hardware version"),
                ],
            ),
            one(
                "MBUS C2 ER1={} ER2={} ER3={} MS1={} MS2={}",
                &[
                    Field::new("error1", Form::Hex, "error 1"), Field::new("error2", Form::Hex, "error 2"),
                    Field::new("error3", Form::Hex, "error 3"), Field::new("status1", Form::Hex, "main status 1"),
                    Field::new("status2", Form::Hex, "main status 2"),
                ],
            ),
        ])
        .on(KCA);
    Ehtr "EHTR" Read "2-8" "an entry of the error history"
        .asks(&[one("EHTR NO={}", &[digits("number", 2, 1, 99, "entry")])])
        .answers(&[one(
            "EHTR NO={} ER={} AL={} H={} M={} S={}",
            &[
                digits("number", 2, 1, 99, "entry"), Field::new("error", Form::Hex, "error code").starred(),
                Field::new("alarm", Form::Hex, "normally 00").starred(),
                starred("hours", 3, 999, "hours"), starred("minutes", 2, 59, "minutes"), starred("seconds", 2, 59, "seconds"),
            ],
        )])
        .on(KCA);
}
