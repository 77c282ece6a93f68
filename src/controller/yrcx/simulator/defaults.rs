//! Content of a new controller: four robots, and the data that the worked examples of the manual need.

/// The content as a start state.
pub(super) const STOCK: &str = r#"
[[robot]]                       # X, Y, Z, R
[[robot]]                       # two arms, height, rotation
kind = "scara"
methods = ["sensor", "sensor", "sensor", "sensor"]
position = [0, 9000, 0, 0]
[[robot]]                       # X, Y
axes = 2
motors = ["incremental", "incremental"]
methods = ["sensor", "sensor"]
[[robot]]                       # one axis
axes = 1
motors = ["incremental"]
methods = ["stroke"]

[points]
0 = { pulse = [0, 0, 0, 0] }
1 = { mm = [100.0, 100.0, 0.0, 0.0] }
2 = { mm = [200.0, 100.0, 20.0, 90.0] }
3 = { mm = [200.0, -100.0, 0.0, 0.0] }
19 = { mm = [150.0, 50.0, 10.0, 45.0] }
50 = { mm = [10.0, -20.0, 5.0, -18.0] }
100 = { mm = [12.345, -0.123, 5.0, 9.023] }
101 = { mm = [20.0, 10.0, 5.0, 0.0] }
110 = { mm = [0.0, 0.0, 2.0, 0.0] }
111 = { mm = [90.0, 0.0, 2.0, 0.0] }
112 = { mm = [0.0, 140.0, 2.0, 0.0] }
113 = { mm = [90.0, 140.0, 2.0, 0.0] }
114 = { mm = [0.0, 0.0, 12.0, 0.0] }

[comments]
50 = "WAIT ORG"

[pallets]
1 = { counts = [5, 5, 1], first = 110 }
2 = { counts = [10, 15, 1], first = 110 }
10 = { counts = [10, 15, 1], first = 110 }

[shifts]
4 = [10.0, 0.0, 0.0, 0.0]
5 = [10.0, -20.0, 5.0, -18.0]

[hands]
1 = { robot = 1, data = [10000, -2000, 5000, 0] }

[ports]
"DI2()" = 127
"DO12()" = 7

[[program]]
number = 1
name = "MAIN"
text = """
*LOOP:
SO(20)=1
MOVE P,P1
DELAY 500
SO(20)=0
MOVE P,P2
SGI0=SGI0+1
GOTO *LOOP"""

[[program]]
number = 2
name = "ABC_DE"
text = """
WAIT SI(20)=1
DO(30)=1
HALT"""

[[task]]
number = 1
program = 1

[[task]]
number = 2
program = 2
"#;

/// Default values of an axis, by the index of the axis in its robot.
#[derive(Debug, Clone, Copy)]
pub(super) struct AxisDefault {
    /// Pulses per mm or degree.
    pub(super) per_unit: f64,
    /// Soft limit in pulses. The range of the axis is symmetric about 0.
    pub(super) limit: i32,
    /// Full speed in mm or degrees per second.
    pub(super) speed: f64,
}

const fn axis(per_unit: f64, limit: i32, speed: f64) -> AxisDefault {
    AxisDefault { per_unit, limit, speed }
}

/// Axes of a Cartesian robot.
pub(super) const CARTESIAN: [AxisDefault; 4] = [
    axis(1000.0, 1_000_000, 1000.0),
    axis(1000.0, 1_000_000, 1000.0),
    axis(1000.0, 500_000, 500.0),
    axis(1000.0, 360_000, 720.0),
];
/// Axes of a SCARA.
pub(super) const SCARA: [AxisDefault; 4] =
    [axis(200.0, 26_000, 360.0), axis(200.0, 29_000, 360.0), axis(1000.0, 200_000, 500.0), axis(100.0, 36_000, 720.0)];
/// Arm lengths of a SCARA in mm.
pub(super) const ARMS: [f64; 2] = [225.0, 175.0];

/// Default values of the axis parameters (4.4.2).
pub(super) const PARAMETERS: [(u16, i32); 12] = [
    (257, 100),
    (258, 100),
    (259, 80),
    (260, 2000),
    (262, 0),
    (264, 2000),
    (265, 2000),
    (266, 100),
    (267, 100),
    (268, 0),
    (269, 0),
    (270, 100),
];

/// Words of the example in 4.7.1: V1.08 R0048, V1.001, and V1.01 four times.
pub(super) const VERSIONS: [u16; 7] = [0x0108, 48, 0x1001, 0x0101, 0x0101, 0x0101, 0x0101];
/// Slots of controller 1: EtherNet/IP, digital inputs and outputs (4.7.15).
pub(super) const SLOTS: [u16; 4] = [0x0401, 0x0101, 0x0000, 0x0000];
