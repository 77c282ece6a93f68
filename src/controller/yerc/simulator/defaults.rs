//! Default content of a controller.

use super::alarms::{Class, alarm, sjis};
use super::memory::{Kind, Memory};
use super::storage::{Content, Storage};
use super::world::World;
use crate::yerc::Model;
use crate::yerc::names::written;
use crate::yerc::payload::{Axes, BasePosition, ExtendedForm, ExternalPosition, Form, Position, PositionKind};

/// System software, robot model, application and parameter version (examples of FS and DX 3.3.26).
/// [`Model::from_software`] recognizes the letters of the software version.
pub(super) const fn versions(model: Model) -> [&'static str; 4] {
    match model {
        Model::Fs100 => ["FS1.14.00A(JP/US)-00", "MPP0003-A0*", "GENERAL", "12.34"],
        Model::Dx100 => ["DS3.93.00A(JP/US)-14", "ES0165D-A0*", "ARC WELDING", "12.34"],
        Model::Dx200 => ["DN2.07.00A(JP/US)-00", "ES0165D-A0*", "ARC WELDING", "12.34"],
        Model::Yrc1000 => ["YAS2.80.00A(JP/US)-00", "ES0165D-A0*", "ARC WELDING", "12.34"],
    }
}

/// A job name with two bytes per character, as displayed on the pendant.
const JAPANESE_JOB: &str = "テスト";

/// Jobs: name, and instructions between NOP and END.
const JOBS: [(&str, &str); 7] = [
    (
        "TESTJOB",
        "'A PICK AND PLACE THAT ENDS WHERE IT BEGAN\nSET B000 0\n*AGAIN\nMOVJ C00000 VJ=25.00\nMOVL C00001 V=200.0\n\
DOUT OT#(1) ON\nTIMER T=0.50\nMOVL C00000 V=200.0\nMOVJ C00002 VJ=25.00\nDOUT OT#(1) OFF\nTIMER T=0.20\nINC B000\n\
JUMP *AGAIN IF B000<3",
    ),
    ("MAIN", "DOUT OT#(2) ON\nCALL JOB:COUNT\nCALL JOB:TESTJOB\nDOUT OT#(2) OFF"),
    ("COUNT", "INC D000\nADD I000 2\nRET"),
    ("WAITIN", "WAIT IN#(1)=ON\nSET B010 1\nTIMER T=1.00\nSET B010 2"),
    ("HOME", "MOVJ C00000 VJ=10.00"),
    ("JOB", "MOVJ C00000 VJ=25.00\nMOVL C00001 V=200.0\nMOVJ C00002 VJ=25.00\nMOVJ C00000 VJ=25.00"),
    (JAPANESE_JOB, "'日本語のコメント\nTIMER T=1.00"),
];

/// Taught positions of all jobs above.
const POSITIONS: &str = "C00000=0,0,0,0,0,0\nC00001=0,0,-300000,0,0,0\nC00002=68000,100000,0,0,-30000,0";

/// Data, parameter, system and list files. `VAR.DAT` and the lists of names are missing here, because they are
/// generated when a client reads them.
const FILES: [(&str, &str); 12] = [
    ("VAR.DAT", "//VAR"),
    ("POSITION.DAT", "//POSITION\n///ABSO"),
    ("HOME.DAT", "//HOME\n0,0,0,0,0,0"),
    ("SYSTEM.DAT", "//SYSTEM"),
    (
        "TOOL.CND",
        "//TOOL\n///NUM 0\n///NAME STANDARD\n0.000,0.000,150.000,0.0000,0.0000,0.0000\n0.000,0.000,0.000\n5.000",
    ),
    ("UFRAME.CND", "//UFRAME\n///NUM 1\n500.000,0.000,0.000,0.0000,0.0000,0.0000"),
    ("ALL.PRM", "///CMOS\nRC\nRS022=1\nRS029=1\nRS034=200\nRS035=200"),
    ("RC.PRM", "///CMOS\nRC"),
    ("SYSTEM.SYS", "//SYSTEM"),
    ("ALMHIST.SYS", "//ALMHIST"),
    ("IONAME.LST", "//IONAME"),
    ("VARNAME.LST", "//VARNAME"),
];

/// Number of lines in the signal sections. They contain the first 128 signals of each kind.
const SIGNAL_LINES: usize = 32;
/// Number of lines in the sections of variables and registers.
const LINES: usize = 100;

/// Files with user-defined names; see [`crate::yerc::names`].
pub(super) fn name_files() -> Vec<(&'static str, Vec<u8>)> {
    let signals = |lines: &[(usize, &str)]| section(SIGNAL_LINES, ",,,", lines);
    let variables = |number: usize, name: &str| section(LINES, "", &[(0, &format!("{number:04} 1,0,{name}"))]);
    let none = || section(LINES, "", &[]);
    let variables = [
        ("///SHARE 100,100,100,100,100,128,128,128", Vec::new()),
        ("///B", variables(50, "PARTS_DONE")),
        ("///I", variables(50, "PARTS_TODO")),
        ("///D", none()),
        ("///R", none()),
        ("///S", none()),
        ("///P", variables(20, "ABOVE_TABLE")),
        ("///BP", none()),
        ("///EX", none()),
    ];
    let registers = [("//NAME", section(1000, "", &[(100, "LINE_SPEED")]))];
    [
        (
            "IONAME.DAT",
            written(
                "/IONAME",
                &[
                    ("//IN", signals(&[(0, "PART_PRESENT,DOOR_CLOSED,,")])),
                    ("//OUT", signals(&[(0, "GRIPPER,BUSY,,")])),
                ],
            ),
        ),
        (
            "EXIONAME.DAT",
            written(
                "/EXIONAME",
                &[("//EXIN", signals(&[(4, "START_REQUEST,,,")])), ("//EXOUT", signals(&[(0, "CYCLE_DONE,,,")]))],
            ),
        ),
        ("VARNAME.DAT", written("//VARNAME", &variables)),
        ("IOMNAME.DAT", written("/IOMMAME", &registers)),
    ]
    .map(|(file, text)| (file, sjis(&text)))
    .into()
}

/// Lines of a section. All lines are empty except the lines with names.
fn section(lines: usize, nothing: &str, named: &[(usize, &str)]) -> Vec<String> {
    let line = |at| named.iter().find(|(line, _)| *line == at).map_or(nothing, |(_, text)| text).to_owned();
    (0..lines).map(line).collect()
}

/// Adds the default content, so that every list and every read returns data.
pub(super) fn fill(world: &mut World) {
    files(&mut world.files);
    variables(&mut world.memory);
    history(world);
}

fn files(files: &mut Storage) {
    for (name, body) in JOBS {
        files.install(&sjis(&format!("{name}.JBI")), job(name, body).into());
    }
    for (name, text) in FILES {
        files.install(name.as_bytes(), Content::from(sjis(&format!("{text}\n").replace('\n', "\r\n"))));
    }
    for (name, bytes) in name_files() {
        files.install(name.as_bytes(), Content::from(bytes));
    }
}

/// A job file in the format of a controller.
pub(super) fn job(name: &str, body: &str) -> Vec<u8> {
    let text = format!(
        "/JOB\n//NAME {name}\n//POS\n///NPOS 3,0,0,0,0,0\n///TOOL 0\n///POSTYPE PULSE\n///PULSE\n{POSITIONS}\n//INST\n\
///DATE 2026/03/14 08:00\n///ATTR SC,RW\n///GROUP1 RB1\nNOP\n{body}\nEND\n"
    );
    sjis(&text.replace('\n', "\r\n"))
}

fn variables(memory: &mut Memory) {
    memory.store(Kind::B, 7, &[7]);
    memory.store(Kind::I, 5, &(-2i16).to_le_bytes());
    memory.store(Kind::D, 9, &(-123_456i32).to_le_bytes());
    memory.store(Kind::R, 3, &1.5f32.to_le_bytes());
    memory.store(Kind::S, 7, b"HELLO");
    memory.store(Kind::S, 8, &sjis("こんにちは"));
    let pulse = Position {
        kind: PositionKind::Pulse,
        form: Form(0),
        tool: 0,
        user: 0,
        extended: ExtendedForm(0),
        axes: Axes::full([1000, -2000, 3000, -4000, 5000, -6000, 0, 0]),
    };
    let base = Position {
        kind: PositionKind::Base,
        axes: Axes::full([1_000_000, 0, 1_200_000, 1_800_000, 0, 0, 0, 0]),
        ..pulse
    };
    memory.store(Kind::P, 0, &Position { axes: Axes::full([0; 8]), ..pulse }.emit());
    memory.store(Kind::P, 1, &pulse.emit());
    memory.store(Kind::P, 2, &base.emit());
    memory.store(Kind::Bp, 5, &BasePosition { kind: PositionKind::Pulse, axes: Axes::full([0; 8]) }.emit());
    let external = ExternalPosition { kind: PositionKind::Pulse, axes: Axes::full([100, 200, 0, 0, 0, 0, 0, 0]) };
    memory.store(Kind::Ex, 10, &external.emit());
    memory.set_io(1, 0b0000_0001);
}

fn history(world: &mut World) {
    let entries = [
        (Class::Major, 1300, 2, 1, "2025/11/02 06:12", None),
        (Class::Monitor, 4107, 0b1000, 3, "2025/11/02 06:15", None),
        (Class::Monitor, 4328, 0b10, 3, "2026/01/20 14:03", None),
        (Class::Monitor, 4315, 3, 1, "2026/02/11 09:41", None),
        (Class::System, 8000, 0b0000_0101, 2, "2026/02/11 09:44", Some("エアー圧力低下")),
        (Class::User, 9001, 0xFFFB, 9, "2026/02/28 17:30", Some("PART MISSING")),
        (Class::User, 9002, 0x8001, 10, "2026/03/13 11:00", Some("ワークなし")),
        (Class::Offline, 4511, 12, 6, "2025/12/24 10:10", None),
    ];
    for (class, code, data, kind, time, name) in entries {
        world.alarms.record(class, alarm(code, data, kind, time, name));
    }
}
