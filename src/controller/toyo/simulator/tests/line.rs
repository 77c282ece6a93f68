//! Blocks on the line: pieces, noise, length, format.

use std::time::Duration;

use super::Bench;

fn sent(bench: &mut Bench, bytes: &[u8]) -> Vec<u8> {
    bench.sim.receive(bench.now, bytes);
    let mut all = Vec::new();
    while let Some(answer) = bench.sim.transmit(bench.now) {
        all.extend(answer);
    }
    all
}

#[test]
fn a_block_ends_with_cr_or_crlf() {
    let mut bench = Bench::new("");
    assert_eq!(sent(&mut bench, b"@HSON\r"), b"@OK\r\n");
    assert_eq!(sent(&mut bench, b"\n@HSOF\r\n"), b"@OK\r\n");
    assert_eq!(sent(&mut bench, b"@MT"), b"");
    assert_eq!(sent(&mut bench, b"SK"), b"");
    assert_eq!(sent(&mut bench, b"\r\n@MTSK\r\n"), b"@MTSK TASK=01\r\n@MTSK TASK=01\r\n");
    assert_eq!(sent(&mut bench, b"\r\n\r\n"), b"");
}

#[test]
fn noise_before_a_block_is_ignored() {
    let mut bench = Bench::new("");
    assert_eq!(sent(&mut bench, b"\x00\xFFxx@MTSK\r\n"), b"@MTSK TASK=01\r\n");
    assert_eq!(sent(&mut bench, b"@MT@MTSK\r\n"), b"@MTSK TASK=01\r\n", "a block that was cut off");
}

#[test]
fn a_damaged_block_has_no_answer() {
    let mut bench = Bench::new("");
    assert_eq!(sent(&mut bench, b"@MT\xC1K\r\n"), b"");
    sent(&mut bench, b"@HS");
    bench.sim.damaged(bench.now);
    assert_eq!(sent(&mut bench, b"ON\r\n"), b"");
    assert!(!bench.sim.state().host, "nothing was done");
    assert_eq!(sent(&mut bench, b"no block\r\n"), b"");
    assert_eq!(sent(&mut bench, b"@HSON\r\n"), b"@OK\r\n");
}

#[test]
fn an_unknown_command_is_refused() {
    let mut bench = Bench::ready("");
    bench.ng("@XXXX", "unknown command");
    bench.ng("@stas SNO=0", "unknown command");
    bench.ng("@STAS SNO=5", "out of range");
    bench.ng("@STAS  SNO=0", "wrong format");
    bench.ng("@WSTX 0001 SPD V=5", "is not a number");
    bench.ng("@WPAR M01 0/1/1", "is not a number");
    bench.ng("@MINT PR=5", "PR=");
    bench.ng("@WSTX 0001 JUMP TAG=001", "unknown instruction");
    assert_eq!(bench.ask("@HTSK TASK=02"), "@OK", "as the list of commands has it");
    let long = [b"@WSTX 0001 NOP".as_slice(), &[b' '; 200], b"\r"].concat();
    assert_eq!(sent(&mut bench, &long), b"@NG\r\n");
    assert_eq!(sent(&mut bench, b"@MTSK\r"), b"@MTSK TASK=02\r\n");
}

#[test]
fn answers_can_be_delayed() {
    let mut bench = Bench::new("answer_delay_ms = 15");
    bench.sim.receive(bench.now, b"@MTSK\r");
    assert_eq!(bench.sim.transmit(bench.now), None);
    assert_eq!(bench.sim.wake(), Some(Duration::from_millis(15)));
    bench.pass(15);
    assert_eq!(bench.sim.transmit(bench.now).unwrap(), b"@MTSK TASK=01\r\n");
}

#[test]
fn busy_refuses_the_same_requests_with_the_same_seed() {
    let count = |seed: u64| -> Vec<bool> {
        let mut bench = Bench::new(&format!("busy = 0.3\nseed = {seed}"));
        (0..200).map(|_| bench.ask("@MTSK") == "@NG").collect()
    };
    let refused = count(7).iter().filter(|refused| **refused).count();
    assert!((40..80).contains(&refused), "{refused}");
    assert_eq!(count(7), count(7));
    assert_ne!(count(7), count(8));
}

#[test]
fn random_bytes_cause_no_panic() {
    let mut bench = Bench::ready("");
    let mut random = fastrand::Rng::with_seed(3);
    let words = ["@", "WPAR ", "T1 PT=", "999", "JGST X=", "\r", "\n", "é", "=", "000000000000", "@WSTX 0001 ", "MVM "];
    for _ in 0..5000 {
        let text: String = (0..random.usize(1..8)).map(|_| words[random.usize(..words.len())]).collect();
        sent(&mut bench, text.as_bytes());
    }
    sent(&mut bench, b"\r");
    bench.answers("@CVER NO=0", "@CVER NO=0 VER=04.00");
}
