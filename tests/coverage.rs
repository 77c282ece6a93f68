//! Named command lines reach every command and service of the manuals that armctl sends.
//!
//! Each line runs with `--dry-run`, and must show frames with the given command, instance, attribute and service. `raw`
//! is not in the list, because it can send every command by its number. It has its own test.

use std::collections::BTreeSet;
use std::process::Command;

use serde_json::Value;

/// Command, instance, attribute, service.
type Head = (u16, u16, u8, u8);

const GET: u8 = 0x0E;
const SET: u8 = 0x10;
const GET_ALL: u8 = 0x01;
const SET_ALL: u8 = 0x02;
const READ: u8 = 0x33;
const WRITE: u8 = 0x34;

const DX200: &str = "udp://127.0.0.1?model=dx200";
const FS100: &str = "udp://127.0.0.1?model=fs100";

/// Command lines for a DX200, each with the frames that it shows (sections 3.3.1 to 3.3.42 and 3.4.1 to 3.4.5).
#[rustfmt::skip]
const LINES: &[(&str, &[Head])] = &[
    ("alarm list --no-texts", &[(0x70, 1, 0, GET_ALL), (0x70, 4, 0, GET_ALL)]),
    ("alarm history --no-texts --limit 1", &[
        (0x71, 1, 0, GET_ALL), (0x71, 1001, 0, GET_ALL), (0x71, 2001, 0, GET_ALL), (0x71, 3001, 0, GET_ALL),
        (0x71, 4001, 0, GET_ALL),
    ]),
    ("alarm history --no-texts --class major --from 100 --limit 1", &[(0x71, 100, 0, GET_ALL)]),
    ("status", &[(0x72, 1, 0, GET_ALL)]),
    ("job show", &[(0x73, 1, 0, GET_ALL)]),
    ("job show --task 15", &[(0x73, 16, 0, GET_ALL)]),
    ("axes --group R8", &[(0x74, 8, 0, GET_ALL), (0x74, 108, 0, GET_ALL)]),
    ("axes --group B8", &[(0x74, 18, 0, GET_ALL), (0x74, 118, 0, GET_ALL)]),
    ("axes --group S24", &[(0x74, 44, 0, GET_ALL)]),
    ("position --group R2 --coordinates pulse", &[(0x75, 2, 0, GET_ALL)]),
    ("position --group R2 --coordinates base", &[(0x75, 102, 0, GET_ALL)]),
    ("position --group B1 --coordinates pulse", &[(0x75, 11, 0, GET_ALL)]),
    ("position --group S24 --coordinates pulse", &[(0x75, 44, 0, GET_ALL)]),
    ("position-error --group S24", &[(0x76, 44, 0, GET_ALL)]),
    ("position-error --group B1", &[(0x76, 11, 0, GET_ALL)]),
    ("torque --group R8", &[(0x77, 8, 0, GET_ALL)]),
    ("torque --group S1", &[(0x77, 21, 0, GET_ALL)]),
    ("io get 20010", &[(0x78, 2001, 1, GET)]),
    ("io get 82207", &[(0x78, 8220, 1, GET)]),
    ("io set --group 2701=0xA5", &[(0x78, 2701, 1, SET)]),
    ("register get 999", &[(0x79, 999, 1, GET)]),
    ("register set 559=1", &[(0x79, 559, 1, SET)]),
    ("var get B99", &[(0x7A, 99, 1, GET)]),
    ("var set B99=255", &[(0x7A, 99, 1, SET)]),
    ("var get I99", &[(0x7B, 99, 1, GET)]),
    ("var set I99=-1", &[(0x7B, 99, 1, SET)]),
    ("var get D99", &[(0x7C, 99, 1, GET)]),
    ("var set D99=-1", &[(0x7C, 99, 1, SET)]),
    ("var get R99", &[(0x7D, 99, 1, GET)]),
    ("var set R99=1.5", &[(0x7D, 99, 1, SET)]),
    ("var get S99 --s16", &[(0x7E, 99, 1, GET)]),
    ("var set S99=A --s16", &[(0x7E, 99, 1, SET)]),
    ("var get P127", &[(0x7F, 127, 0, GET_ALL)]),
    ("var set P127=pulse:s=1,l=2,u=3,r=4,b=5,t=6,tool=1", &[(0x7F, 127, 0, SET_ALL)]),
    ("var get BP127", &[(0x80, 127, 0, GET_ALL)]),
    ("var set BP127=base:1=1.5", &[(0x80, 127, 0, SET_ALL)]),
    ("var get EX127", &[(0x81, 127, 0, GET_ALL)]),
    ("var set EX127=pulse:1=1,2=2", &[(0x81, 127, 0, SET_ALL)]),
    ("alarm reset", &[(0x82, 1, 1, SET)]),
    ("alarm cancel", &[(0x82, 2, 1, SET)]),
    ("hold on", &[(0x83, 1, 1, SET)]),
    ("servo on", &[(0x83, 2, 1, SET)]),
    ("hlock off", &[(0x83, 3, 1, SET)]),
    ("cycle continuous", &[(0x84, 2, 1, SET)]),
    ("say HELLO", &[(0x85, 1, 1, SET)]),
    ("job start", &[(0x86, 1, 1, SET)]),
    ("job select A --line 9999", &[(0x87, 1, 0, SET_ALL)]),
    ("job select A --task 0", &[(0x87, 10, 0, SET_ALL)]),
    ("job select A --task 15", &[(0x87, 25, 0, SET_ALL)]),
    ("hours", &[(0x88, 1, 0, GET_ALL), (0x88, 10, 0, GET_ALL), (0x88, 110, 0, GET_ALL), (0x88, 210, 0, GET_ALL)]),
    ("hours --group R8", &[(0x88, 18, 0, GET_ALL), (0x88, 118, 0, GET_ALL), (0x88, 218, 0, GET_ALL)]),
    ("hours --group S24", &[(0x88, 44, 0, GET_ALL), (0x88, 144, 0, GET_ALL), (0x88, 244, 0, GET_ALL)]),
    ("hours --application 8", &[(0x88, 308, 0, GET_ALL)]),
    ("info --group R8", &[(0x89, 18, 0, GET_ALL)]),
    ("info --group S24", &[(0x89, 44, 0, GET_ALL)]),
    ("info --application 8", &[(0x89, 108, 0, GET_ALL)]),
    ("move joint --to 1,2,3,4,5,6 --speed 1%", &[(0x8A, 1, 1, SET_ALL)]),
    ("move linear --to 1,2,3,4,5,6 --speed 1mm/s", &[(0x8A, 2, 1, SET_ALL)]),
    ("move relative --z 1 --speed 1mm/s", &[(0x8A, 3, 1, SET_ALL)]),
    ("move pulse joint --pulses 1,2,3,4,5,6 --speed 1%", &[(0x8B, 1, 1, SET_ALL)]),
    ("move pulse linear --pulses 1,2,3,4,5,6 --speed 1mm/s", &[(0x8B, 2, 1, SET_ALL)]),
    ("var get S99", &[(0x8C, 99, 1, GET)]),
    ("var set S99=A", &[(0x8C, 99, 1, SET)]),
    ("io get 20010..20027", &[(0x300, 2001, 0, READ)]),
    ("io set --group 2701=1 --group 2702=2", &[(0x300, 2701, 0, WRITE)]),
    ("register get 1 2 3", &[(0x301, 1, 0, READ)]),
    ("register set 1=1 2=2", &[(0x301, 1, 0, WRITE)]),
    ("var get B0..B1", &[(0x302, 0, 0, READ)]),
    ("var set B0=1 B1=2", &[(0x302, 0, 0, WRITE)]),
    ("var get I0..I1", &[(0x303, 0, 0, READ)]),
    ("var set I0=1 I1=2", &[(0x303, 0, 0, WRITE)]),
    ("var get D0..D1", &[(0x304, 0, 0, READ)]),
    ("var set D0=1 D1=2", &[(0x304, 0, 0, WRITE)]),
    ("var get R0..R1", &[(0x305, 0, 0, READ)]),
    ("var set R0=1 R1=2", &[(0x305, 0, 0, WRITE)]),
    ("var get S0..S1 --s16", &[(0x306, 0, 0, READ)]),
    ("var set S0=A S1=B --s16", &[(0x306, 0, 0, WRITE)]),
    ("var get P0..P1", &[(0x307, 0, 0, READ)]),
    ("var set P0=pulse:s=1,l=2,u=3,r=4,b=5,t=6 P1=pulse:s=1,l=2,u=3,r=4,b=5,t=6", &[(0x307, 0, 0, WRITE)]),
    ("var get BP0..BP1", &[(0x308, 0, 0, READ)]),
    ("var set BP0=pulse:1=1 BP1=pulse:1=2", &[(0x308, 0, 0, WRITE)]),
    ("var get EX0..EX1", &[(0x309, 0, 0, READ)]),
    ("var set EX0=pulse:1=1 EX1=pulse:1=2", &[(0x309, 0, 0, WRITE)]),
    ("alarm list", &[(0x30A, 1, 0, GET_ALL), (0x30A, 4, 0, GET_ALL)]),
    ("alarm history --class offline --from 100", &[(0x30B, 4100, 0, GET_ALL)]),
    ("var get S0..S1", &[(0x30C, 0, 0, READ)]),
    ("var set S0=A S1=B", &[(0x30C, 0, 0, WRITE)]),
    ("file delete A.JBI", &[(0, 0, 0, 0x09)]),
    ("file get A.JBI --dir dry", &[(0, 0, 0, 0x16)]),
    ("file list --type all", &[(0, 0, 0, 0x32)]),
    ("file cmos --start-only", &[(0, 0, 0, 0x16)]),
];

/// Command lines for an FS100. On this model, these commands have another address.
#[rustfmt::skip]
const ON_FS100: &[(&str, &[Head])] = &[
    ("job show --task 5", &[(0x73, 6, 0, GET_ALL)]),
    ("var get S99", &[(0x7E, 99, 1, GET)]),
    ("var get S0..S1", &[(0x306, 0, 0, READ)]),
    ("var set S0=A S1=B", &[(0x306, 0, 0, WRITE)]),
    ("io set --group 2501=1", &[(0x78, 2501, 1, SET)]),
    ("job select A --task 5", &[(0x87, 15, 0, SET_ALL)]),
];

/// Frames that a dry run shows.
fn frames(target: &str, line: &str) -> Vec<Vec<u8>> {
    let words = ["--json", "--dry-run", "-t", target, "yerc"].into_iter().chain(line.split_ascii_whitespace());
    let output = Command::new(env!("CARGO_BIN_EXE_armctl")).args(words).output().expect("armctl starts");
    assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
    let envelope: Value = serde_json::from_slice(&output.stdout).expect("an envelope");
    let frames = envelope["data"]["frames"].as_array().expect("a list of frames");
    frames.iter().map(|frame| bytes(frame["hex"].as_str().expect("hexadecimal"))).collect()
}

/// Bytes of a frame. A byte that depends on an answer is shown as `??`; here it is 0. The header has no such bytes.
fn bytes(hex: &str) -> Vec<u8> {
    let byte = |digits| if digits == "??" { 0 } else { u8::from_str_radix(digits, 16).expect("hexadecimal") };
    (0..hex.len()).step_by(2).map(|at| byte(&hex[at..at + 2])).collect()
}

/// Division and header of a frame. Division 1 is for robot commands, division 2 is for files.
fn head(frame: &[u8]) -> (u8, Head) {
    assert_eq!(&frame[..4], b"YERC");
    let word = |at: usize| u16::from_le_bytes([frame[at], frame[at + 1]]);
    (frame[9], (word(24), word(26), frame[28], frame[29]))
}

fn check(target: &str, lines: &[(&str, &[Head])]) -> BTreeSet<(u16, u8)> {
    let mut reached_services = BTreeSet::new();
    for (line, expected) in lines {
        let sent: Vec<(u8, Head)> = frames(target, line).iter().map(|frame| head(frame)).collect();
        for expected in *expected {
            let division = if expected.0 == 0 { 2 } else { 1 };
            assert!(sent.contains(&(division, *expected)), "{line}: {expected:x?} is not in {sent:x?}");
            reached_services.insert((expected.0, expected.3));
        }
    }
    reached_services
}

#[test]
fn every_command_and_service_is_reachable() {
    let mut reached = check(DX200, LINES);
    check(FS100, ON_FS100);

    let job = tempfile::Builder::new().suffix(".JBI").tempfile().expect("a temporary file");
    std::fs::write(job.path(), "/JOB\r\n//NAME A\r\n//POS\r\n///NPOS 0,0,0,0,0,0\r\n//INST\r\nNOP\r\nEND\r\n").unwrap();
    let sent = frames(DX200, &format!("file put {} --as A.JBI", job.path().display()));
    // The list and its acknowledgement, and the request and the only block of the file. The list and its
    // acknowledgement follow again, for a controller whose last acknowledgement has no block number.
    let services: Vec<u8> = sent.iter().map(|frame| head(frame).1.3).collect();
    assert_eq!(services, [0x32, 0x32, 0x15, 0x15, 0x32, 0x32], "file put");
    reached.insert((0, 0x15));

    let commands: BTreeSet<u16> = reached.iter().map(|(command, _)| *command).collect();
    let printed: BTreeSet<u16> = std::iter::once(0).chain(0x70..=0x8C).chain(0x300..=0x30C).collect();
    assert_eq!(commands, printed);
    let files: Vec<u8> = reached.iter().filter(|(command, _)| *command == 0).map(|(_, service)| *service).collect();
    assert_eq!(files, [0x09, 0x15, 0x16, 0x32]);
    // Everything that can be read and written, as single elements and as several elements.
    for command in (0x78..=0x81).chain([0x8C]) {
        let services: Vec<u8> = reached.iter().filter(|(c, _)| *c == command).map(|(_, service)| *service).collect();
        assert_eq!(services.len(), 2, "{command:#x}: {services:x?}");
    }
    for command in (0x300..=0x309).chain([0x30C]) {
        assert!(reached.contains(&(command, READ)) && reached.contains(&(command, WRITE)), "{command:#x}");
    }
}

#[test]
fn fetches_the_batch_backup_by_its_path() {
    let sent = frames(DX200, "file cmos --start-only");
    assert_eq!(&sent[0][32..], b"/SPDRV/CMOSBK.BIN");
}

/// Attributes without a named command line are read by their numbers.
#[test]
fn raw_reads_a_single_field() {
    for (line, expected) in [
        ("raw --command 0x72 --instance 1 --attribute 2 --service 0x0E --strict", (0x72, 1, 2, GET)),
        ("raw --command 0x7F --instance 5 --attribute 13 --service 0x10 --data 01000000 --strict", (0x7F, 5, 13, SET)),
        ("raw --command 0x79 --instance 5 --attribute 0 --service 0x02 --data 0100 --strict", (0x79, 5, 0, SET_ALL)),
        ("raw --command 0x30A --instance 1 --attribute 8 --service 0x0E --strict", (0x30A, 1, 8, GET)),
    ] {
        let sent = frames(DX200, line);
        let (request, before) = sent.split_last().expect("the request");
        assert_eq!(head(request), (1, expected), "{line}");
        // A position is read before it is overwritten, so all frames before the last frame are reads.
        assert!(before.iter().all(|frame| head(frame).1.3 == GET_ALL), "{line}");
    }
}

/// FS 3.3.39 has 25 words, and DX 3.3.39 has 26. In the FS manual, the reserved words come before the form, so the
/// words after them move by one word.
#[test]
fn cartesian_move_of_25_words_matches_the_fs100_manual() {
    let line = "move linear --to 1,-2,3,-4,5,-0 --speed 70mm/s --coordinate user --user 63 --tool 62 --form back,lower \
                --extended-form w-ge180 --base-axes -1.5,2,3 --group R2";
    let words = |target: &str| -> Vec<i32> {
        let sent = frames(target, line);
        let order = sent.iter().find(|frame| head(frame).1.0 == 0x8A).expect("the order");
        order[32..].chunks_exact(4).map(|word| i32::from_le_bytes(word.try_into().unwrap())).collect()
    };
    let head = [2, 0, 1, 700, 18, 1000, -2000, 3000, -40_000, 50_000, 0];
    let tail = [0b11, 0b1_0000, 62, 63, -1500, 2000, 3000, 0, 0, 0, 0, 0, 0];
    assert_eq!(words("udp://127.0.0.1?model=fs100&move_words=25"), [&head[..], &[0], &tail].concat());
    assert_eq!(words("udp://127.0.0.1?model=fs100"), [&head[..], &[0, 0], &tail].concat());
    assert_eq!(words("udp://127.0.0.1?model=dx200"), [&head[..], &[0, 0], &tail].concat());
}
