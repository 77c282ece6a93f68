//! Forward and inverse kinematics. Both are exact, so that the controller reports a target in mm exactly as it was
//! commanded.

/// Values of four axes or coordinates: pulses, axis positions, or X, Y, Z in mm with R in degrees.
pub(super) type FourValues = [f64; 4];

/// Protocol steps per mm or degree.
pub(super) const STEPS: f64 = 1000.0;

/// Kinematics of a robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    // Axes 1 to 4 are X, Y, Z, R.
    Cartesian,
    // Two arms with vertical axes and these lengths in mm, a height axis, and a rotation axis.
    Scara { first: f64, second: f64 },
}

/// Arm side of a SCARA.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Arm {
    #[default]
    Right,
    Left,
}

impl Arm {
    /// The arm side for the code of 4.2.19: 0 is right, 1 is left.
    pub(super) fn from_code(code: i32) -> Self {
        if code == 1 { Self::Left } else { Self::Right }
    }

    pub(super) fn code(self) -> i32 {
        i32::from(self == Self::Left)
    }

    /// The arm side for a hand system: 1 is right, 2 is left, other values have no side. This code differs from the
    /// code of [`Arm::from_code`] (4.2.1, 4.3.1).
    pub(super) fn of_hand_system(code: i32) -> Option<Self> {
        match code {
            1 => Some(Self::Right),
            2 => Some(Self::Left),
            _ => None,
        }
    }

    pub(super) fn hand_system(self) -> i32 {
        self.code() + 1
    }
}

/// Kinematics of a robot with its hand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Geometry {
    pub(super) kind: Kind,
    /// Pulses per mm or degree, for each axis.
    pub(super) per_unit: FourValues,
    /// Data of the selected hand (4.3.5); `None` without a hand.
    pub(super) hand: Option<[i32; 4]>,
}

impl Geometry {
    /// Converts pulses to mm or degrees.
    pub(super) fn units(&self, pulses: &FourValues) -> FourValues {
        std::array::from_fn(|axis| pulses[axis] / self.per_unit[axis])
    }

    /// Converts mm or degrees to pulses.
    pub(super) fn of_units(&self, units: &FourValues) -> FourValues {
        std::array::from_fn(|axis| units[axis] * self.per_unit[axis])
    }

    /// Tool position.
    pub(super) fn pose(&self, pulses: &FourValues) -> FourValues {
        let [one, two, height, last] = self.units(pulses);
        match self.kind {
            Kind::Cartesian => {
                let tool = self.tool(last);
                [one + tool[0], two + tool[1], height + tool[2], last]
            }
            Kind::Scara { first, .. } => {
                let (bend, second) = self.second_arm(two);
                let turn = one + two + last;
                let (elbow, wrist) = (rotated(first, 0.0, one), rotated(second, 0.0, one + bend));
                let tool = self.tool(turn);
                [elbow.0 + wrist.0 + tool[0], elbow.1 + wrist.1 + tool[1], height + tool[2], turn]
            }
        }
    }

    /// Pulses for a tool position; `None` if the robot cannot reach it.
    pub(super) fn pulses(&self, pose: &FourValues, arm: Arm) -> Option<FourValues> {
        let turn = pose[3];
        let tool = self.tool(turn);
        let [x, y, height] = [pose[0] - tool[0], pose[1] - tool[1], pose[2] - tool[2]];
        let Kind::Scara { first, .. } = self.kind else { return Some(self.of_units(&[x, y, height, turn])) };
        let (offset, second) = self.second_arm(0.0);
        let cos = (x * x + y * y - first * first - second * second) / (2.0 * first * second);
        if !cos.is_finite() || cos.abs() > 1.0 + 1e-9 {
            return None;
        }
        let bend = cos.clamp(-1.0, 1.0).acos() * if arm == Arm::Right { 1.0 } else { -1.0 };
        let towards = y.atan2(x) - (second * bend.sin()).atan2(first + second * bend.cos());
        let (one, two) = (half_turns(towards.to_degrees()), bend.to_degrees() - offset);
        Some(self.of_units(&[one, two, height, turn - one - two]))
    }

    /// Arm side at a position; `None` for a Cartesian robot.
    pub(super) fn arm(&self, pulses: &FourValues) -> Option<Arm> {
        match self.kind {
            Kind::Cartesian => None,
            Kind::Scara { .. } => {
                let (bend, _) = self.second_arm(self.units(pulses)[1]);
                Some(if bend < 0.0 { Arm::Left } else { Arm::Right })
            }
        }
    }

    /// Angle and length of the second arm. A hand that is not on the R axis changes both: data 1 is an offset in
    /// pulses, and data 2 is added to the length.
    fn second_arm(&self, angle: f64) -> (f64, f64) {
        match (self.kind, self.hand) {
            (Kind::Scara { second, .. }, Some([offset, longer, _, 0])) => {
                (angle + f64::from(offset) / self.per_unit[1], second + f64::from(longer) / STEPS)
            }
            (Kind::Scara { second, .. }, _) => (angle, second),
            (Kind::Cartesian, _) => (angle, 0.0),
        }
    }

    /// Offset of the tool from its mount, with the R axis at `r`. Data 4 of the hand says whether the tool rotates with
    /// the R axis.
    fn tool(&self, r: f64) -> [f64; 3] {
        let Some([one, two, three, on_r]) = self.hand else { return [0.0; 3] };
        let height = f64::from(three) / STEPS;
        let (x, y) = match (self.kind, on_r) {
            (Kind::Cartesian, 0) => (f64::from(one) / STEPS, f64::from(two) / STEPS),
            (Kind::Cartesian, _) => rotated(f64::from(one) / STEPS, f64::from(two) / STEPS, r),
            (Kind::Scara { .. }, 0) => (0.0, 0.0),
            (Kind::Scara { .. }, _) => rotated(f64::from(two) / STEPS, 0.0, r + f64::from(one) / self.per_unit[3]),
        };
        [x, y, height]
    }
}

/// Normalizes an angle to the range from -180 to 180 degrees.
fn half_turns(angle: f64) -> f64 {
    if angle > 180.0 {
        angle - 360.0
    } else if angle < -180.0 {
        angle + 360.0
    } else {
        angle
    }
}

fn rotated(x: f64, y: f64, degrees: f64) -> (f64, f64) {
    let (sin, cos) = degrees.to_radians().sin_cos();
    (x * cos - y * sin, x * sin + y * cos)
}

/// Converts coordinates in a shift to coordinates of the robot. A shift is a coordinate system that is moved and
/// rotated by R.
pub(super) fn from_shift(shift: &[i32; 4], pose: &FourValues) -> FourValues {
    let [x, y, z, r] = shift.map(|step| f64::from(step) / STEPS);
    let (turned_x, turned_y) = rotated(pose[0], pose[1], r);
    [turned_x + x, turned_y + y, pose[2] + z, pose[3] + r]
}

/// Converts coordinates of the robot to coordinates in a shift.
pub(super) fn to_shift(shift: &[i32; 4], pose: &FourValues) -> FourValues {
    let [x, y, z, r] = shift.map(|step| f64::from(step) / STEPS);
    let (turned_x, turned_y) = rotated(pose[0] - x, pose[1] - y, -r);
    [turned_x, turned_y, pose[2] - z, pose[3] - r]
}

/// Moves a pose by `by` in tool coordinates. Tool coordinates rotate with R.
pub(super) fn along_tool(pose: &FourValues, by: &FourValues) -> FourValues {
    let (x, y) = rotated(by[0], by[1], pose[3]);
    [pose[0] + x, pose[1] + y, pose[2] + by[2], pose[3] + by[3]]
}

/// Rounds to the nearest integer that fits the result type.
#[expect(clippy::cast_possible_truncation, reason = "a number out of range becomes the nearest limit")]
pub(super) fn whole(number: f64) -> i32 {
    number.round() as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCARA: Geometry = Geometry {
        kind: Kind::Scara { first: 125.0, second: 125.0 },
        per_unit: [200.0, 200.0, 1000.0, 100.0],
        hand: None,
    };

    fn near(found: &FourValues, wanted: &FourValues) -> bool {
        found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-6)
    }

    #[test]
    fn kinematics_round_trip_with_every_hand() {
        for hand in [None, Some([1000, 20_000, -5000, 0]), Some([500, 30_000, 7000, 1])] {
            let geometry = Geometry { hand, ..SCARA };
            for pulses in [[2000.0, 9000.0, 4000.0, 300.0], [-4000.0, -12_000.0, 0.0, -900.0]] {
                let pose = geometry.pose(&pulses);
                let arm = geometry.arm(&pulses).unwrap();
                assert!(near(&geometry.pulses(&pose, arm).unwrap(), &pulses), "{hand:?} {pulses:?}");
            }
            let cartesian = Geometry { kind: Kind::Cartesian, ..geometry };
            let pulses = [1.0, -2.0, 3.0, -4.0];
            assert!(near(&cartesian.pulses(&cartesian.pose(&pulses), Arm::Left).unwrap(), &pulses));
        }
    }

    #[test]
    fn both_hand_systems_reach_the_same_position() {
        let pose = [100.0, 50.0, 0.0, 30.0];
        let [right, left] = [Arm::Right, Arm::Left].map(|arm| SCARA.pulses(&pose, arm).unwrap());
        assert!(near(&SCARA.pose(&right), &pose) && near(&SCARA.pose(&left), &pose));
        assert!(right[1] > 0.0 && left[1] < 0.0);
        assert_eq!(SCARA.pulses(&[251.0, 0.0, 0.0, 0.0], Arm::Right), None);
    }

    #[test]
    fn shifts_and_tools_turn() {
        let shift = [10_000, -20_000, 5000, 90_000];
        let pose = [1.0, 2.0, 3.0, 4.0];
        assert!(near(&from_shift(&shift, &pose), &[8.0, -19.0, 8.0, 94.0]));
        assert!(near(&to_shift(&shift, &from_shift(&shift, &pose)), &pose));
        assert!(near(&along_tool(&[0.0, 0.0, 0.0, 90.0], &[1.0, 0.0, 2.0, 3.0]), &[0.0, 1.0, 2.0, 93.0]));
    }
}
