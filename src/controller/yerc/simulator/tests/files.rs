//! File server: content, checks, repeats, time limits.

use super::*;

#[test]
fn files_round_trip() {
    let mut bench = Bench::default();
    let any: Vec<u8> = (0..5000u32).map(|i| i.to_le_bytes()[0] ^ i.to_le_bytes()[1]).collect();
    for (size, len) in [(479, 5000), (400, 5000), (1, 7), (479, 479), (479, 958)] {
        assert_eq!(bench.load(b"ANY.DAT", &any[..len], size), Status::OK);
        assert_eq!(bench.fetch(0x16, b"ANY.DAT"), Ok(any[..len].to_vec()));
    }
    let list = bench.fetch(0x32, b"*.DAT").unwrap();
    assert!(list.starts_with(b"ANY.DAT\r\n") && list.ends_with(b"VARNAME.DAT\r\n"));
    assert_eq!(bench.file_one(false, 0x09, 0, b"ANY.DAT").0, Status::OK);
    assert_eq!(bench.file_one(false, 0x09, 0, b"ANY.DAT").0, refused(0xE2B3));
    assert_eq!(bench.file_one(false, 0x09, 0, b"VAR.DAT").0, refused(0xE2AF));
    assert_eq!(bench.file_one(false, 0x09, 0, b"NONE.JBI").0, refused(0x4040));
    let nothing = |added: u32| Err(Status { code: 0, added_size: 1, added });
    assert_eq!(bench.fetch(0x16, b"NONE.JBI"), nothing(0xE29C));
    let jobs = bench.fetch(0x32, b"").unwrap();
    assert_eq!(bench.fetch(0x32, b"*.*").unwrap(), jobs);
    assert!(jobs.windows(10).any(|name| name == b"\x83e\x83X\x83g.JBI"));
    assert_eq!(bench.fetch(0x32, b"*.TXT"), Err(refused(0xE2A0)));
    assert_eq!(bench.fetch(0x16, b"TESTJOB.JBI\0"), Err(refused(0xE49D)));
    for extension in ["JBI", "DAT", "CND", "PRM", "SYS", "LST"] {
        assert!(!bench.fetch(0x32, format!("*.{extension}").as_bytes()).unwrap().is_empty());
    }
}

#[test]
fn lists_of_names_follow_the_files_with_names() {
    let mut bench = Bench::default();
    let text = |bytes: Result<Vec<u8>, Status>| String::from_utf8(bytes.unwrap()).unwrap();
    let signals = "//IONAME\r\nIN#(1) PART_PRESENT\r\nIN#(2) DOOR_CLOSED\r\nOT#(1) GRIPPER\r\nOT#(2) BUSY\r\n";
    assert_eq!(text(bench.fetch(0x16, b"IONAME.LST")), signals);
    let variables = "//VARNAME\r\nB050 PARTS_DONE\r\nI050 PARTS_TODO\r\nP020 ABOVE_TABLE\r\n";
    assert_eq!(text(bench.fetch(0x16, b"VARNAME.LST")), variables);
    let renamed = text(bench.fetch(0x16, b"IONAME.DAT")).replace("GRIPPER", "TONGS");
    assert_eq!(bench.load(b"IONAME.DAT", renamed.as_bytes(), 479), Status::OK);
    assert_eq!(text(bench.fetch(0x16, b"IONAME.LST")), signals.replace("GRIPPER", "TONGS"));
}

#[test]
fn jobs_are_checked_when_they_are_loaded() {
    let mut bench = Bench::default();
    let job = bench.fetch(0x16, b"HOME.JBI").unwrap();
    let renamed = String::from_utf8(job.clone()).unwrap().replace("HOME", "NEW").into_bytes();
    assert_eq!(bench.load(b"HOME.JBI", &job, 479), refused(0x4030));
    assert_eq!(bench.load(b"NEW.JBI", &job, 479), refused(0x5390));
    let bare: Vec<u8> = renamed.iter().copied().filter(|&byte| byte != b'\r').collect();
    assert_eq!(bench.load(b"NEW.JBI", &bare, 479), refused(0x5130));
    assert_eq!(bench.fetch(0x16, b"NEW.JBI"), Err(Status { code: 0, added_size: 1, added: 0xE29C }));
    assert_eq!(bench.load(b"NEW.JBI", &renamed, 100), Status::OK);
    assert_eq!(bench.select(b"NEW", 0), Status::OK);
    assert_eq!(bench.load(b"SYSTEM.SYS", b"x", 479), refused(0xE28C));
    let mut bench = Bench::new("replace_jobs = true");
    assert_eq!(bench.load(b"HOME.JBI", &job, 479), Status::OK);
}

#[test]
fn empty_list_answer_depends_on_the_model() {
    let mut bench = Bench::new("stock = false");
    assert_eq!(bench.fetch(0x32, b"*.JBI"), Err(Status { code: 0, added_size: 1, added: 0xE2A7 }));
    let mut bench = Bench::new("stock = false\nmodel = 'fs100'");
    assert_eq!(bench.fetch(0x32, b"*.JBI"), Err(refused(0xE2B3)));
    assert_eq!(bench.fetch(0x16, b"A.JBI"), Err(refused(0x4040)));
}

#[test]
fn repeated_frames_of_a_save_are_answered_once_and_again_after_a_pause() {
    let mut bench = Bench::new("[[file]]\nname = 'BIG.DAT'\nsize = 1000");
    let first = bench.file(PEER, 1, false, 0x16, 0, b"BIG.DAT");
    assert!(bench.file(PEER, 1, false, 0x16, 0, b"BIG.DAT").is_empty(), "an echo");
    bench.wait(100);
    assert_eq!(bench.file(PEER, 1, false, 0x16, 0, b"BIG.DAT"), first);
    let second = bench.file(PEER, 1, true, 0x16, 1, &[]);
    assert!(bench.file(PEER, 1, true, 0x16, 1, &[]).is_empty());
    bench.wait(100);
    assert_eq!(bench.file(PEER, 1, true, 0x16, 1, &[]), second);
    assert_eq!(bench.file(PEER, 1, false, 0x16, 0, b"BIG.DAT").len(), 0, "a late copy of the request");
    let last = bench.file(PEER, 1, true, 0x16, 2, &[]);
    assert_eq!(AnswerFrame::parse(&last[0]).unwrap().block, LAST_BLOCK | 3);
    assert!(bench.file(PEER, 1, true, 0x16, LAST_BLOCK | 3, &[]).is_empty());
    assert!(bench.file(PEER, 1, true, 0x16, LAST_BLOCK | 3, &[]).is_empty());
}

#[test]
fn repeated_blocks_of_a_load_are_stored_once() {
    let mut bench = Bench::default();
    bench.file(PEER, 1, false, 0x15, 0, b"A.DAT");
    let ack = bench.file(PEER, 1, true, 0x15, 1, b"one");
    bench.wait(100);
    assert_eq!(bench.file(PEER, 1, true, 0x15, 1, b"one"), ack);
    let ack = bench.file(PEER, 1, true, 0x15, LAST_BLOCK | 2, b"two");
    bench.wait(100);
    assert_eq!(bench.file(PEER, 1, true, 0x15, LAST_BLOCK | 2, b"two"), ack);
    assert!(bench.file(PEER, 1, false, 0x15, 0, b"A.DAT").is_empty(), "a late copy of the request");
    assert_eq!(bench.fetch(0x16, b"A.DAT"), Ok(b"onetwo".to_vec()));
    bench.file(PEER, 3, false, 0x15, 0, b"B.DAT");
    assert_eq!(bench.file_one(true, 0x15, 2, b"gap").0, refused(0xE4A1));
    assert_eq!(bench.file_one(true, 0x15, 1, b"late").0, refused(0xE4A2));
}

#[test]
fn allows_one_transfer_with_a_time_limit() {
    let mut bench = Bench::new("[[file]]\nname = 'BIG.DAT'\nsize = 1000");
    bench.file(1, 1, false, 0x16, 0, b"BIG.DAT");
    let busy = bench.file(2, 1, false, 0x32, 0, b"");
    assert_eq!(AnswerFrame::parse(&busy[0]).unwrap().status, refused(0xE444));
    assert_eq!(bench.simulator.wake(), Some(Duration::from_secs(5)));
    bench.wait(5000);
    let dropped = bench.file(1, 1, true, 0x16, 1, &[]);
    assert_eq!(AnswerFrame::parse(&dropped[0]).unwrap().status, refused(0xE28B));
    bench.file(1, 1, false, 0x16, 0, b"BIG.DAT");
    bench.console("remote off");
    let dropped = bench.file(1, 1, true, 0x16, 1, &[]);
    assert_eq!(AnswerFrame::parse(&dropped[0]).unwrap().status, refused(0xFFFE));
    assert_eq!(bench.file(2, 1, false, 0x32, 0, b"").len(), 1);
}

#[test]
fn batch_backup_takes_time_and_creates_a_file() {
    const PATH: &[u8] = b"/SPDRV/CMOSBK.BIN";
    let mut bench = Bench::new("backup_seconds = 600\nbackup_size = 2000");
    assert!(bench.file(PEER, 1, false, 0x16, 0, PATH).is_empty());
    bench.wait(599_000);
    assert!(bench.waiting().is_empty());
    assert!(bench.file(PEER, 2, false, 0x16, 0, PATH).is_empty(), "asked again");
    bench.wait(1000);
    let frames = bench.waiting();
    let answer = AnswerFrame::parse(&frames[0]).unwrap();
    assert_eq!((frames.len(), answer.id, answer.block, answer.data.len()), (1, 2, LAST_BLOCK, 0));
    assert_eq!(bench.fetch(0x16, PATH).unwrap().len(), 2000);
    assert!(bench.file(PEER, 3, false, 0x16, 0, PATH).is_empty(), "the next one is made anew");
    let mut bench = Bench::new("remote = false");
    assert_eq!(bench.file_one(false, 0x16, 0, PATH).0, refused(0xE250));
    let mut bench = Bench::new("model = 'fs100'\nsoftware = 'FS1.13.00A(JP/US)-00'");
    assert_eq!(bench.file_one(false, 0x16, 0, PATH).0, refused(0xE2A0));
}

#[test]
fn large_file_is_generated_when_read() {
    let mut bench = Bench::new("[[file]]\nname = 'BIG.DAT'\nsize = 67108864");
    let (_, block, data) = bench.file_one(false, 0x16, 0, b"BIG.DAT");
    assert_eq!((block, data.len()), (1, 479));
}

#[test]
fn ignores_late_copies_of_the_previous_transfer() {
    let mut bench = Bench::default();
    bench.file(PEER, 1, false, 0x15, 0, b"A.DAT");
    bench.file(PEER, 1, true, 0x15, LAST_BLOCK | 1, b"old");
    bench.file(PEER, 2, false, 0x15, 0, b"B.DAT");
    assert!(bench.file(PEER, 1, true, 0x15, LAST_BLOCK | 1, b"old").is_empty());
    assert_eq!(bench.file(PEER, 2, true, 0x15, LAST_BLOCK | 1, b"new").len(), 1);
    assert_eq!(bench.fetch(0x16, b"B.DAT"), Ok(b"new".to_vec()));
}

#[test]
fn variable_file_contains_the_current_variables() {
    let mut bench = Bench::new("");
    let before = bench.fetch(0x16, b"VAR.DAT").unwrap();
    let row = |file: &[u8]| String::from_utf8_lossy(file).lines().nth(3).map(ToOwned::to_owned);
    assert_eq!(row(&before).as_deref(), Some("0,0,0,0,0,0,0,7,0,0"));
    assert_eq!(bench.ask(0x7A, 7, 1, 0x10, &[99]).0, Status::OK);
    let after = bench.fetch(0x16, b"VAR.DAT").unwrap();
    assert_eq!(row(&after).as_deref(), Some("0,0,0,0,0,0,0,99,0,0"));
    assert_eq!(bench.load(b"VAR.DAT", &before, 479), Status::OK);
    assert_eq!(bench.ask(0x7A, 7, 1, 0x0E, &[]), (Status::OK, vec![7]));
    // Each load needs a new controller. On the same controller, a second load with the same name would look like a
    // repeated frame.
    assert_ne!(Bench::new("").load(b"VAR.DAT", b"//OTHER\r\n", 479), Status::OK);
}
