//! Moves over virtual time.

use super::*;

#[test]
fn linear_move_ends_exactly_in_time() {
    let mut bench = Bench::default();
    assert_eq!(bench.write(0x8A, 2, 1, 0x02, &five_seconds().emit()), Status::OK);
    assert!(bench.status().running());
    assert_eq!(bench.write(0x8A, 2, 1, 0x02, &five_seconds().emit()), refused(0x2010));
    bench.wait(2500);
    assert_eq!(bench.pose(101)[..3], [1_000_000, 250_000, 1_200_000]);
    assert_ne!(bench.read(0x76, 1), [0; 24]);
    bench.wait(2499);
    assert!(bench.status().running());
    bench.wait(1);
    assert!(!bench.status().running());
    assert_eq!(bench.pose(101), [1_000_000, 500_000, 1_200_000, 1_800_000, 0, 0]);
    assert_ne!(bench.pose(1)[0], 0, "pulses have followed");
    assert_eq!(bench.read(0x76, 1), [0; 32]);
}

#[test]
fn fs100_moves_have_25_words() {
    let mut order = cartesian((0, 10_000), 17, [700_000, -300_000, 900_000, -1_799_999, 100, -900_000]);
    order.layout = MoveLayout::Words25;
    let mut bench = Bench::default();
    assert_eq!(bench.write(0x8A, 1, 1, 0x02, &order.emit()), refused(0xB003));
    for layout in [MoveLayout::Words25, MoveLayout::Words26] {
        order.layout = layout;
        assert_eq!(Bench::new("model = 'fs100'").write(0x8A, 1, 1, 0x02, &order.emit()), Status::OK);
    }
}

#[test]
fn every_kind_of_move_reaches_its_target() {
    let mut bench = Bench::default();
    let link = cartesian((0, 10_000), 17, [700_000, -300_000, 900_000, -1_799_999, 100, -900_000]);
    assert_eq!(bench.write(0x8A, 1, 1, 0x02, &link.emit()), Status::OK);
    bench.wait(10_000);
    assert_eq!(bench.pose(101), link.target);
    let step = cartesian((1, 500), 16, [1000, -2000, 3000, 0, 0, 0]);
    assert_eq!(bench.write(0x8A, 3, 1, 0x02, &step.emit()), Status::OK);
    bench.wait(10_000);
    assert_eq!(bench.pose(101)[..3], [701_000, -302_000, 903_000]);
    let mut printed = cartesian((1, 15_000), 18, [0, 100_000, 1_000_000, 1_800_000, 0, 0]);
    printed.user = 1;
    assert_eq!(bench.write(0x8A, 2, 1, 0x02, &printed.emit()), Status::OK);
    bench.wait(10_000);
    assert_eq!(bench.pose(101)[..3], [500_000, 100_000, 1_000_000]);
    let pulses = PulseMove::parse(&hex(&format!("0100000000000000{}", "00".repeat(80)))).unwrap();
    let mut pulses = PulseMove { speed: 5000, ..pulses };
    pulses.axes = [1234, -5678, 91_011, 1213, -1415, 1617, 0, 0];
    pulses.base = [2000, 0, 0];
    assert_eq!(bench.write(0x8B, 1, 1, 0x02, &pulses.emit()), Status::OK);
    bench.wait(10_000);
    assert_eq!(bench.pose(1), [1234, -5678, 91_011, 1213, -1415, 1617]);
    assert_eq!(bench.pose(11), [2000]);
    let station = PulseMove {
        robot: 0,
        station: 1,
        axes: [0; 8],
        base: [0; 3],
        station_axes: [9000, -9000, 0, 0, 0, 0],
        ..pulses
    };
    assert_eq!(bench.write(0x8B, 1, 1, 0x02, &station.emit()), Status::OK);
    bench.wait(10_000);
    assert_eq!(bench.pose(21), [9000, -9000]);
}

#[test]
fn rejects_invalid_moves() {
    type Change = fn(&mut CartesianMove);
    let mut bench = Bench::default();
    let good = five_seconds();
    let cases: [(u16, Change, u16); 14] = [
        (2, |order| order.station = 1, 0xB008),
        (2, |order| order.robot = 0, 0xB008),
        (2, |order| order.robot = 2, 0xB008),
        (2, |order| order.speed = 0, 0xB009),
        (2, |order| order.speed = 15_001, 0xB009),
        (1, |_| (), 0xB009),
        (2, |order| order.coordinate = crate::yerc::payload::PositionKind::Tool, 0xB00B),
        (2, |order| order.coordinate = crate::yerc::payload::PositionKind::Pulse, 0xB00B),
        (2, |order| order.reserved[1] = 1, 0xB004),
        (2, |order| order.form.0 = 0x40, 0xB00C),
        (2, |order| order.tool = 64, 0xB00D),
        (2, |order| order.user = 64, 0xB00E),
        (2, |order| order.base[1] = 1, 0xB004),
        (2, |order| order.station_axes[0] = 1, 0xB004),
    ];
    for (instance, change, expected) in cases {
        let mut order = good;
        change(&mut order);
        assert_eq!(bench.write(0x8A, instance, 1, 0x02, &order.emit()), refused(expected), "{order:?}");
    }
    let user = |user| CartesianMove { coordinate: crate::yerc::payload::PositionKind::User, user, ..good };
    assert_eq!(bench.write(0x8A, 2, 1, 0x02, &user(0).emit()), refused(0xB00E));
    assert_eq!(bench.write(0x8A, 2, 1, 0x02, &user(9).emit()), refused(0x3350));
    assert_eq!(bench.write(0x8A, 2, 1, 0x02, &good.emit()[..96]), refused(0xB003));
    assert_eq!(bench.write(0x8A, 4, 1, 0x02, &good.emit()), plain(0x28));
    assert!(!bench.status().running());
}

#[test]
fn hold_ends_a_move() {
    let mut bench = Bench::default();
    bench.write(0x8A, 2, 1, 0x02, &five_seconds().emit());
    bench.wait(1000);
    assert_eq!(bench.set_word(0x83, 1, 1), Status::OK);
    assert!(bench.status().running(), "it still slows down");
    bench.wait(100);
    let status = bench.status();
    assert!(!status.running() && status.has(StatusBit::HoldCommand));
    assert_eq!(bench.pose(101)[1], 105_000, "100 mm, and 5 mm to stop");
    assert_eq!(bench.write(0x8A, 2, 1, 0x02, &five_seconds().emit()), refused(0x2050));
    assert_eq!(bench.set_word(0x83, 1, 2), Status::OK);
    bench.wait(10_000);
    assert_eq!(bench.pose(101)[1], 105_000);
    bench.write(0x8A, 2, 1, 0x02, &five_seconds().emit());
    bench.wait(500);
    assert_eq!(bench.set_word(0x83, 2, 2), Status::OK);
    let status = bench.status();
    assert!(!status.running() && !status.servo_on());
    assert_eq!(bench.pose(101)[1], 155_000, "without power it stops at once");
}

#[test]
fn a_soft_limit_raises_an_alarm() {
    let mut bench = Bench::default();
    let far = cartesian((1, 15_000), 16, [5_000_000, 0, 1_200_000, 1_800_000, 0, 0]);
    assert_eq!(bench.write(0x8A, 2, 1, 0x02, &far.emit()), Status::OK);
    bench.wait(10_000);
    assert!(bench.status().alarm());
    assert_eq!(bench.pose(101)[0], 3_000_000);
    assert_eq!(bench.read(0x70, 1)[..2], 4416u16.to_le_bytes());
}
