//! Host control, and refusals by state.

use super::Bench;
use crate::toyo::request::Request;
use crate::toyo::table::commands::ROWS;

#[test]
fn commands_that_need_the_host_are_refused_without_it() {
    let sample = |word: &str| -> String {
        let tail = match word {
            "WPAR" => " M09 J",
            "MINT" => " PR=2",
            "CPSS" => " TASK=01 STA=0001 END=0001 TASK=01 TOP=0002",
            "ISTX" | "DSTX" | "SPST" => " 0001",
            "SSTG" => " TAG=001",
            "DSTL" => " STA=0001 END=0001",
            "CPPL" => " STA=01 TOP=02",
            "WSTX" => " 0001 NOP",
            "WPLT" => " 01 SNO=16 TAG=000",
            "SPLN" => " PR=01",
            "JGST" => " X=RS Y=RS Z=RS R=RS",
            "DOUT" => " STN=0 PN01=........",
            "WOVR" => " OV=100",
            "EXTP" => " PT=001",
            "SORG" => " 1",
            _ => "",
        };
        format!("@{word}{tail}")
    };
    let mut refused = Vec::new();
    for row in ROWS.iter().filter(|row| row.needs_host) {
        let mut bench = Bench::new("");
        bench.ng(&sample(row.word), "host is off");
        refused.push(row.word);
    }
    // The commands that the list of the manual marks as refused without host control (TO 2-1).
    assert_eq!(
        refused,
        "MPRO MSTP MAUT MSEQ MPLE WPAR MINT CPSS ISTX DSTX SSTG DSTL CPPL WSTX WPLT HOME SPST SPLN PPST JGST DOUT WOVR EXTP \
         SVON SVOF SORG"
            .split_whitespace()
            .collect::<Vec<_>>()
    );
}

#[test]
fn everything_else_is_answered_without_the_host() {
    for row in ROWS.iter().filter(|row| !row.needs_host && row.requests[0].fields.is_empty() && row.requests.len() == 1)
    {
        let mut bench = Bench::new("card = \"written\"\nwrite = [\"WPAR M10 E\"]");
        let answer = bench.ask(&format!("@{}", row.word));
        assert!(Request::bare(row.command).answer(&answer).is_ok(), "{}: {answer}", row.word);
        assert_eq!(bench.console("why"), "no command was refused", "{}", row.word);
    }
}

#[test]
fn the_pendant_disables_the_host() {
    let mut bench = Bench::new("");
    bench.ok("@HSON");
    assert_eq!(bench.page(2), 0b1000_0000);
    bench.console("pendant on");
    assert_eq!(bench.page(2), 0b0100_0000, "the host is off by itself");
    bench.ng("@HSON", "pendant");
    bench.console("pendant off");
    bench.ok("@HSON");
    bench.ok("@HSOF");
    assert_eq!(bench.page(2), 0);
}

#[test]
fn the_start_input_works_only_with_the_host_off() {
    let mut bench = Bench::with(&["CNT+ CN01=0001", "END"], "");
    assert!(bench.sim.console(bench.now, "start").unwrap_err().contains("host is ON"));
    bench.console("input 0/SY/2 on");
    bench.rest();
    assert_eq!(bench.counter(1), 0);
    bench.ok("@HSOF");
    bench.console("input 0/SY/2 off");
    bench.console("input 0/SY/2 on");
    bench.rest();
    assert_eq!(bench.counter(1), 1);
    bench.answers("@MINP SNO=0 GN=1", "@MINP SNO=0 GN=1 SY01=00000010 PN01=00000000 PN02=00000000 PN03=00000000");
    bench.answers("@MOUT SNO=0 GN=1", "@MOUT SNO=0 GN=1 SY01=00001110 PN01=00000000 PN02=00000000 PN03=00000000");
}

#[test]
fn the_servo_input_switches_servo_power() {
    let mut bench = Bench::ready("write = [\"WPAR M21 1/01/1\"]");
    bench.console("input 1/01/1 on");
    assert_eq!(bench.page(3), 0b0001_0001);
    bench.console("input 1/01/1 off");
    assert_eq!(bench.page(3), 0b0001_0000);
    bench.console("slave off");
    assert_eq!(bench.page(3), 0);
}

#[test]
fn a_change_of_parameter_2_needs_a_power_cycle() {
    let mut bench =
        Bench::ready("steps.1 = [\"MOV a X=+0100.00 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=05 POST\", \"END\"]");
    bench.ok("@WPAR E06 AX1=0050 AX2=1000 AX3=1000 AX4=1000");
    assert_eq!(bench.page(0), 0b1011_0000);
    bench.console("error 62");
    for block in ["@SPST 0001", "@HOME", "@CERR", "@SVOF", "@JGST X=-C Y=SP Z=SP R=SP", "@DOUT STN=0 PN01=.......1"] {
        bench.ng(block, "(parameter 2) was changed");
    }
    assert_eq!(bench.ask("@RPAR E06"), "@RPAR E06 AX1=0050 AX2=1000 AX3=1000 AX4=1000", "it still communicates");
    bench.console("power cycle");
    assert_eq!((bench.page(0), bench.page(1)), (0b0010_0000, 0), "the origin is gone with incremental encoders");
    bench.ng("@HOME", "host is off");
    bench.ok("@HSON");
    bench.ok("@HOME");
    bench.rest();
    let before = bench.now.as_secs_f64();
    bench.run();
    assert!(bench.now.as_secs_f64() > before + 2.0, "at 50 mm/s");
}

#[test]
fn absolute_encoders_keep_the_origin() {
    let mut bench = Bench::ready("position = [12.0, 0.0, 0.0, 0.0]\nwrite = [\"WPAR E17 E=a\"]");
    bench.console("power cycle");
    assert_eq!(bench.page(0), 0b0011_0000);
    bench.at([12.0, 0.0, 0.0, 0.0]);
    bench.console("error 26");
    assert_eq!(bench.page(0), 0b0010_0001, "an encoder error takes it");
}

#[test]
fn errors_are_stored_in_the_history() {
    let mut bench =
        Bench::ready("hours = 999\nhistory = [{ code = \"28\", after_seconds = 3661 }, { power_cut = true }]");
    bench.answers("@EHTR NO=01", "@EHTR NO=01 ER=28 AL=00 H=001 M=01 S=01");
    bench.answers("@EHTR NO=02", "@EHTR NO=02 ER=** AL=** H=*** M=** S=**");
    bench.answers("@EHTR NO=03", "@EHTR NO=03 ER=00 AL=00 H=000 M=00 S=00");
    bench.pass(125_000);
    bench.console("error 13");
    bench.console("error A1");
    assert_eq!(bench.page(1), 0x13, "the first one stays");
    bench.answers("@EHTR NO=01", "@EHTR NO=01 ER=A1 AL=00 H=999 M=02 S=05");
    bench.console("power cycle");
    bench.answers("@EHTR NO=01", "@EHTR NO=01 ER=** AL=** H=*** M=** S=**");
    bench.answers("@EHTR NO=03", "@EHTR NO=03 ER=13 AL=00 H=999 M=02 S=05");
    for _ in 0..120 {
        bench.console("error 60");
    }
    assert!(bench.ask("@EHTR NO=99").contains("ER=60"));
    bench.answers("@MERP", "@MERP         ");
}

#[test]
fn every_error_code_can_be_raised_and_cancelled() {
    let mut bench = Bench::ready("");
    for code in 1..=0xFF {
        bench.console(&format!("error {code:02X}"));
        assert_eq!(bench.page(1), code);
        bench.ok("@CERR");
        assert_eq!((bench.page(1), bench.page(0) & 1), (0, 0));
    }
    bench.ok("@CERR");
}

#[test]
fn ports_are_shown_by_screens() {
    let mut bench = Bench::ready(
        "inputs = { \"0/04\" = \"00000001\", \"0/23\" = \"10000000\", \"4/03\" = \"11111111\" }\noutputs = { \"0/18\" = \"00010000\", \"2/02\" = \"00000010\" }",
    );
    bench.answers("@MINP SNO=0 GN=2", "@MINP SNO=0 GN=2 PN04=00000001 PN05=00000000 PN06=00000000 PN07=00000000");
    bench.answers("@MINP SNO=0 GN=6", "@MINP SNO=0 GN=6 PN20=00000000 PN21=00000000 PN22=00000000 PN23=10000000");
    bench.ng("@MINP SNO=0 GN=7", "no such screen");
    bench.answers("@MINP SNO=4 GN=1", "@MINP SNO=4 PN01=00000000 PN02=00000000 PN03=11111111");
    bench.ng("@MINP SNO=4 GN=2", "no such screen");
    bench.answers("@MOUT SNO=0 GN=5", "@MOUT SNO=0 GN=5 PN16=00000000 PN17=00000000 PN18=00010000");
    bench.answers("@MOUT SNO=2 GN=1", "@MOUT SNO=2 PN01=00000000 PN02=00000010");
}

#[test]
fn outputs_are_set_directly() {
    let mut bench = Bench::ready("write = [\"WPAR M12 PN1=0/03/4 PN2=0/01/0 PN3=0/01/0 PN4=1/02/8\"]");
    bench.ok("@DOUT STN=0 PN18=1.1.....");
    bench.ok("@DOUT 1");
    bench.ok("@DOUT 4");
    bench.ng("@DOUT 2", "M12");
    bench.ng("@DOUT STN=1 PN03=.......1", "no such port");
    assert_eq!((bench.port(18), bench.port(3), bench.sim.output(1, 2)), (0xA0, 0b1000, Some(0x80)));
}

#[test]
fn sysp_reports_the_controller_type() {
    let mut bench = Bench::ready(
        "version = \"3.40\"\nrobot_types = [120000, 120100]\nwrite = [\"WPAR M09 J\", \"WPAR E01 AX1=Y AX2=X AX3=Z AX4=R\"]",
    );
    bench.answers("@SYSP", "@SYSP RTYP=120000 VER=03.40 J ARM1=Y ARM2=X ARM3=Z ARM4=R N");
    bench.answers("@CVER NO=4", "@CVER NO=4 VER=03.40");
    assert_eq!(bench.ask("@TYPE AX1 RTYP=777777"), "@TYPE AX1 RTYP=120000", "one that it does not know");
    assert_eq!(bench.page(0) & 0x80, 0);
    bench.answers("@TYPE AX1 RTYP=120100", "@TYPE AX1 RTYP=120100");
    assert_eq!(bench.page(0) & 0x80, 0x80);
    assert_eq!(bench.ask("@RPAR E01"), "@RPAR E01 AX1=X AX2=Y AX3=Z AX4=R", "parameter 2 is as at first");
    bench.answers("@MBUS C1", "@MBUS C1 STN=01 BRT=156K VER=01");
    bench.answers("@MBUS C2", "@MBUS C2 ER1=00 ER2=00 ER3=00 MS1=00 MS2=00");
}

#[test]
fn an_old_version_refuses_newer_commands() {
    let mut bench = Bench::ready("version = \"3.35\"");
    bench.ng("@WPAR E23 E", "does not have E23");
    Bench::ready("version = \"3.36\"").ok("@WPAR E23 E");
}
