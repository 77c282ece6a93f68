//! Named values of commands and answers.

use std::fmt;

use crate::units::{Millimetres, MillimetresPerSecond, Percent, Pulses};

/// Declares the keys with their names.
macro_rules! keys {
    ($($key:ident $name:literal,)*) => {
        /// Name of a field, unique within a command.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Key {
            $(#[doc = concat!("`", $name, "`")] $key,)*
        }

        impl Key {
            /// All keys.
            pub const ALL: &[Self] = &[$(Self::$key,)*];

            /// Name in JSON and error texts.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$key => $name,)*
                }
            }
        }
    };
}

keys! {
    Robot "robot",
    AxisFlag "axis_flag",
    SpeedMode "speed_mode",
    AccelFlag "accel_flag",
    DecelFlag "decel_flag",
    PushForceFlag "push_force_flag",
    PushTimeFlag "push_time_flag",
    Axes "axes",
    SpeedOfMax "speed_of_max_percent",
    SpeedPercent "speed_percent",
    SpeedMmS "speed_mm_s",
    Accel "accel_percent",
    Decel "decel_percent",
    Report "report",
    HandSystem "hand_system",
    Point "point",
    Point2 "point_2",
    Axis1 "axis_1",
    Axis2 "axis_2",
    Axis3 "axis_3",
    Axis4 "axis_4",
    Axis5 "axis_5",
    Axis6 "axis_6",
    Target "target",
    Distance "distance",
    ArchAxis "arch_axis",
    ArchUnit "arch_unit",
    ArchPosition "arch_position",
    ArchStart "arch_start",
    ArchEnd "arch_end",
    Pallet "pallet",
    WorkPosition "work_position",
    Direction "direction",
    InchingAmount "inching_amount",
    Unit "unit",
    OriginAxes "origin_axes",
    Shift "shift",
    Hand "hand",
    Arm "arm",
    Torque "torque_percent",
    PushForce "push_force_percent",
    PushTime "push_time_ms",
    PushResult "push_result",
    Comment "comment",
    CountX "nx",
    CountY "ny",
    CountZ "nz",
    FirstPoint "first_point",
    Owner "owner",
    Data1 "data_1",
    Data2 "data_2",
    Data3 "data_3",
    Data4 "data_4",
    Variable "variable",
    Variable2 "variable_2",
    Value "value",
    Parameter "parameter",
    Element "element",
    PortType "port_type",
    Port "port",
    PortBit "port_bit",
    Selection "selection",
    Program "program",
    Task "task",
    Priority "priority",
    ProgramName "program_name",
    Line "line",
    HostVersion "host_version",
    HostRevision "host_revision",
    FpgaVersion "fpga_version",
    DriverVersion1 "driver_version_1",
    DriverVersion2 "driver_version_2",
    DriverVersion3 "driver_version_3",
    DriverVersion4 "driver_version_4",
    RobotType "robot_type",
    Continuous "continuous",
    TaskRange "task_range",
    Task1 "task_1",
    Task2 "task_2",
    Task3 "task_3",
    Task4 "task_4",
    Task5 "task_5",
    Task6 "task_6",
    Task7 "task_7",
    Task8 "task_8",
    History "history",
    AlarmGroup "alarm_group",
    AlarmCategory "alarm_category",
    Place1 "place_1",
    Place1Number "place_1_number",
    Place2 "place_2",
    Place2Number "place_2_number",
    AutoSpeed "auto_speed_percent",
    ManualSpeed "manual_speed_percent",
    ProgramSpeed "program_speed_percent",
    MotorType "motor_type",
    System "system",
    Year "year",
    Month "month",
    Day "day",
    Hour "hour",
    Minute "minute",
    Second "second",
    Controller "controller",
    Slot1 "slot_1",
    Slot2 "slot_2",
    Slot3 "slot_3",
    Slot4 "slot_4",
}

impl Key {
    /// The four axes, in order.
    pub const AXES: [Self; 4] = [Self::Axis1, Self::Axis2, Self::Axis3, Self::Axis4];

    /// The key with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|key| key.name() == name)
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Value of a field.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// An integer: a number in raw units (for example 0.001 mm or 0.01 %), the number of a choice, or a set of axes as
    /// bits. In a set, bit 0 is axis 1.
    Int(i32),
    /// A single-precision number, the value of a real static variable.
    Real(f32),
    /// A comment or a program name. Other fields parse text with [`Field::parse`].
    ///
    /// [`Field::parse`]: super::table::Field::parse
    Text(String),
}

impl From<i32> for Value {
    fn from(number: i32) -> Self {
        Self::Int(number)
    }
}

impl From<u16> for Value {
    fn from(number: u16) -> Self {
        Self::Int(number.into())
    }
}

impl From<bool> for Value {
    fn from(on: bool) -> Self {
        Self::Int(on.into())
    }
}

impl From<f32> for Value {
    fn from(number: f32) -> Self {
        Self::Real(number)
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Value {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

/// Declares conversions of quantities. The text has the unit, so that a field with another unit refuses it.
macro_rules! from_quantities {
    ($($quantity:ident)*) => {$(
        impl From<$quantity> for Value {
            fn from(quantity: $quantity) -> Self {
                Self::Text(quantity.short())
            }
        }
    )*};
}

from_quantities! { Millimetres MillimetresPerSecond Percent Pulses }

/// Values by key, in word order. Numbers are raw. Pulses, percent and mm/s are integers; mm and degrees are in
/// thousandths; percent of the maximum is in hundredths. [`Field::show`](super::table::Field::show) formats them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Values(Vec<(Key, Value)>);

impl Values {
    /// The value of a key.
    pub fn value(&self, key: Key) -> Option<&Value> {
        self.0.iter().find(|(known, _)| *known == key).map(|(_, value)| value)
    }

    /// The integer of a key.
    pub fn int(&self, key: Key) -> Option<i32> {
        match self.value(key)? {
            Value::Int(number) => Some(*number),
            Value::Real(_) | Value::Text(_) => None,
        }
    }

    /// A length, for example a linear axis; `None` in a position in pulses.
    pub fn millimetres(&self, key: Key) -> Option<Millimetres> {
        let is_in_pulses = self.int(Key::Unit) == Some(0);
        self.int(key).filter(|_| !is_in_pulses).map(Millimetres::from_steps)
    }

    /// The text of a key.
    pub fn text(&self, key: Key) -> Option<&str> {
        match self.value(key)? {
            Value::Text(text) => Some(text),
            Value::Int(_) | Value::Real(_) => None,
        }
    }

    /// Numbers for all four axes, for example a position or the state of each axis.
    pub fn axes(&self) -> Option<[i32; 4]> {
        let [first, second, third, fourth] = Key::AXES.map(|key| self.int(key));
        Some([first?, second?, third?, fourth?])
    }

    /// Sets a value. An earlier value of the key is replaced.
    pub fn set(&mut self, key: Key, value: impl Into<Value>) {
        let value = value.into();
        match self.0.iter_mut().find(|(known, _)| *known == key) {
            Some((_, known)) => *known = value,
            None => self.0.push((key, value)),
        }
    }

    /// All keys with their values, in order.
    pub fn iter(&self) -> impl Iterator<Item = (Key, &Value)> {
        self.0.iter().map(|(key, value)| (*key, value))
    }
}

impl<V: Into<Value>> FromIterator<(Key, V)> for Values {
    fn from_iter<I: IntoIterator<Item = (Key, V)>>(pairs: I) -> Self {
        let mut values = Self::default();
        for (key, value) in pairs {
            values.set(key, value);
        }
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique() {
        for key in Key::ALL {
            assert_eq!(Key::from_name(key.name()), Some(*key));
        }
    }
}
