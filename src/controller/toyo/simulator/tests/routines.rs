//! MVM groups, palletizing, easy programs, external points.

use super::{Bench, fails};

const GROUP: &str = "points.1 = { 1 = [10.0, 10.0, 0.0, 0.0], 2 = [30.0, 10.0, 0.0, 0.0], 3 = [10.0, 20.0, 0.0, 0.0] }\n\
    write = [\"WPAR T4 S1 GRP=02 ORG=001 P1=002 P2=003 P3=000\", \"WPAR T4 S2 GRP=02 P1=0003 P2=0002 P3=0000\", \
    \"WPAR T4 S3 GRP=02 P1=11 P2=12 P3=13\", \"WPAR T4 S4 GRP=02 i Z=+0050.00 R=+0001.00\", \"WPAR T4 S5 GRP=02 R=+0045.00\"]";

#[test]
fn groups_visit_every_position() {
    let steps = [
        "MINI GRP=02",
        "TAG TAG=001",
        "MVM S GRP=02 V=05 POST APPR",
        "MVM S GRP=02 V=05 POST DIST",
        "CNT+ CN01=0001",
        "STOP",
        "LOOP GRP=02 THEN=001 ELSE=002",
        "TAG TAG=002",
        "END",
    ];
    let mut bench = Bench::ran(&steps, GROUP);
    let mut places = Vec::new();
    while bench.sim.state().paused {
        places.push(bench.sim.state().position.map(f64::round));
        bench.resume();
    }
    assert_eq!(bench.error(), None);
    let place = |x, y| [x, y, 0.0, 45.0];
    assert_eq!(
        places,
        [
            place(10.0, 10.0),
            place(20.0, 10.0),
            place(30.0, 10.0),
            place(10.0, 20.0),
            place(20.0, 20.0),
            place(30.0, 20.0)
        ]
    );
    assert_eq!((bench.counter(11), bench.counter(12)), (1, 1), "the group is at its beginning again");
    let bench = Bench::ran(&["MINI GRP=02", "MVM S GRP=02 V=05 POST APPR", "END"], GROUP);
    bench.at([10.0, 10.0, 50.0, 46.0]);
    let bench = Bench::ran(&["MVM S GRP=02 V=05 POST DIST", "END"], GROUP);
    assert_eq!(bench.error(), Some(0xA7), "counters that were not set");
    fails(&["LOOP GRP=05 THEN=001 ELSE=002", "TAG TAG=001", "END"], 0xA1);
}

const PALLET: &str = "palletizing = true\nwrite = [\"WPLT 03 SNO=01 TAG=001 MOD=M-1\", \"WPLT 03 SNO=02 X=+0010.00 Y=+0000.00 Z=+0005.00\", \
    \"WPLT 03 SNO=03 X=+0020.00 Y=+0000.00 Z=+0005.00\", \"WPLT 03 SNO=06 P1=0002 P2=0000 P3=0000\", \
    \"WPLT 03 SNO=07 i S APR=-0005.00 V=05 POST R=+0000.00\", \"WPLT 03 SNO=08 R=+0001.00 TAG=002\", \
    \"WPLT 03 SNO=09 X=+0100.00 Y=+0050.00 Z=+0005.00\", \"WPLT 03 SNO=14 a T APR=+0000.00 V=05 PASS R=+0002.00\", \
    \"WPLT 03 SNO=15 R=+0003.00 TAG=003\", \"WPLT 03 SNO=16 TAG=004\"]";
const HANDS: [&str; 15] = [
    "TAG TAG=001",
    "CNT+ CN01=0001",
    "RET",
    "TAG TAG=002",
    "CNT+ CN02=0001",
    "TIM TM=010.0",
    "RET",
    "TAG TAG=003",
    "CNT+ CN03=0001",
    "TIM TM=010.0",
    "RET",
    "TAG TAG=004",
    "CNT+ CN04=0001",
    "TIM TM=010.0",
    "END",
];

#[test]
fn palletizing_moves_all_pieces() {
    let mut bench = Bench::with(&HANDS, PALLET);
    assert_eq!(bench.page(2) & 0b11, 0b01);
    bench.ng("@SPST 0001", "sequential mode");
    bench.ok("@SPLN PR=03");
    bench.answers(
        "@RPLD",
        "@RPLD M-1 START PR=03 PC1=0000 PN1=0002 PC2=0000 PN2=0000 PC3=0000 PN3=0000 TAG=000 STP=0000",
    );
    bench.ok("@PPST");
    bench.pass(5000);
    bench.at([10.0, 0.0, 5.0, 1.0]);
    bench.answers(
        "@RPLD",
        "@RPLD M-1 SOURCE PR=03 PC1=0001 PN1=0002 PC2=0001 PN2=0000 PC3=0001 PN3=0000 TAG=002 STP=0006",
    );
    bench.pass(10_000);
    bench.at([100.0, 50.0, 5.0, 3.0]);
    bench.answers(
        "@RPLD",
        "@RPLD M-1 DESTI PR=03 PC1=0001 PN1=0000 PC2=0001 PN2=0000 PC3=0001 PN3=0000 TAG=003 STP=0010",
    );
    bench.pass(10_000);
    bench.at([20.0, 0.0, 5.0, 1.0]);
    bench.ok("@STOP");
    assert!(bench.ask("@RPLD").contains("SOURCE PR=03 PC1=0002"));
    bench.ok("@PPST");
    bench.pass(22_000);
    assert!(bench.ask("@RPLD").contains("END PR=03"), "{}", bench.ask("@RPLD"));
    bench.rest();
    assert_eq!(bench.error(), None);
    assert_eq!([1, 2, 3, 4].map(|counter| bench.counter(counter)), [1, 2, 2, 1]);
    assert_eq!(bench.page(0), 0b0011_0000);
}

#[test]
fn inputs_select_the_pallet() {
    let toml = PALLET.replace("write = [", "inputs = { \"0/01\" = \"00110000\" }\nwrite = [\"WPAR M06 0/01/5\", ");
    let mut bench = Bench::with(&HANDS, &toml);
    bench.ok("@PPST");
    bench.pass(1000);
    assert!(bench.ask("@RPLD").contains("PR=03"));
    let toml = PALLET.replace("write = [", "inputs = { \"0/01\" = \"00010001\" }\nwrite = [\"WPAR M06 0/01/1\", ");
    let mut bench = Bench::with(&HANDS, &toml);
    bench.ok("@PPST");
    assert_eq!(bench.error(), Some(0xB2));
}

#[test]
fn easy_programs_repeat() {
    let steps = [
        "TAG TAG=005",
        "CNT+ CN01=0001",
        "TIM TM=001.0",
        "RET",
        "TAG TAG=006",
        "CNT+ CN02=0001",
        "TIM TM=001.0",
        "RET",
    ];
    let toml = "write = [\"WPAR M10 E\", \"WESY PNO=02 ST=000 START=005 LOOP=0003 END=006\"]";
    let mut bench = Bench::with(&steps, toml);
    assert_eq!(bench.page(2) & 0b11, 0b11);
    bench.ng("@MSEQ", "M10");
    bench.ok("@SESY");
    assert_eq!(bench.error(), Some(0xB9), "the first one is empty");
    bench.ok("@CERR");
    bench.ok("@SESN PR=02");
    bench.ok("@SESY");
    bench.pass(1500);
    bench.answers("@RESD", "@RESD PR=02 ST=000 SQS=0003 SUB=005 LOOP=0002");
    bench.rest();
    assert_eq!((bench.error(), bench.counter(1), bench.counter(2)), (None, 3, 1));
    bench.answers("@RESD", "@RESD PR=02 ST=000 SQS=0000 SUB=000 LOOP=0000");
}

#[test]
fn external_point_mode_moves_to_the_point() {
    let toml = "points = { 1 = { 7 = [70.0, 7.0, 0.0, 0.0], 8 = [9999.0, 0.0, 0.0, 0.0] } }\nwrite = [\"WPAR M10 P\"]";
    let toml = toml.replace("9999.0", "7999.0");
    let mut bench = Bench::ready(&toml);
    assert_eq!(bench.page(2) & 0b11, 0b10);
    bench.ok("@EXTP PT=007");
    bench.ng("@EXTP PT=007", "or jog runs");
    bench.rest();
    bench.at([70.0, 7.0, 0.0, 0.0]);
    bench.ok("@EXTP PT=008");
    bench.rest();
    assert_eq!(bench.error(), Some(0xC0));
    let mut bench = Bench::new("host = true\nwrite = [\"WPAR M10 P\"]");
    bench.ok("@EXTP PT=001");
    assert_eq!(bench.error(), Some(0x61));
    let mut bench = Bench::ready("");
    bench.ng("@EXTP PT=001", "M10");
    bench.ng("@SESY", "M10");
    bench.ng("@PPST", "palletizing mode");
}
