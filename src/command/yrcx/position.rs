//! Positions, in millimetres or pulses.

use clap::ValueEnum;
use schemars::JsonSchema;
use serde::Serialize;

use crate::controller::yrcx::value::Values;
use crate::output::view::{Cell, Table};

/// What a position is measured in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Unit {
    /// Millimetres; degrees of what turns
    Mm,
    /// Pulses of the encoders
    Pulse,
}

impl Unit {
    /// The number of the position output that asks for it (bits 15 and 14 of WI1).
    pub fn report(self) -> i32 {
        match self {
            Self::Pulse => 1,
            Self::Mm => 2,
        }
    }

    /// As it stands behind a number.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Pulse => "pulses",
            Self::Mm => "mm",
        }
    }
}

/// Where a robot is.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema, Default)]
pub struct Position {
    /// Axes 1 to 4 in millimetres (degrees of what turns); null unless asked for.
    pub position_mm: Option<[f64; 4]>,
    /// Axes 1 to 4 in pulses; null unless asked for.
    pub position_pulses: Option<[i32; 4]>,
}

impl Position {
    /// Of the values of an answer in this unit; nothing where the answer has no position.
    pub fn of(values: &Values, unit: Option<Unit>) -> Self {
        let axes = values.axes();
        match unit {
            None => Self::default(),
            Some(Unit::Mm) => Self {
                position_mm: axes.map(|axes| axes.map(|steps| f64::from(steps) / 1000.0)),
                position_pulses: None,
            },
            Some(Unit::Pulse) => Self { position_mm: None, position_pulses: axes },
        }
    }

    /// Axes in a line with their unit.
    pub fn in_a_line(&self) -> String {
        let mm = self.position_mm.map(|axes| format!("{} mm", axes.map(|axis| format!("{axis:.3}")).join(", ")));
        let pulses =
            self.position_pulses.map(|axes| format!("{} pulses", axes.map(|axis| axis.to_string()).join(", ")));
        mm.or(pulses).unwrap_or_default()
    }

    /// A row an axis.
    pub fn table(&self) -> Option<Table> {
        let mut table = Table::new(&["axis", "position", "unit"], "");
        for at in 0..4_usize {
            if let Some(axes) = self.position_mm {
                table.row([(at + 1).into(), Cell::number(format!("{:.3}", axes[at])), "mm".into()]);
            }
            if let Some(axes) = self.position_pulses {
                table.row([(at + 1).into(), axes[at].into(), "pulses".into()]);
            }
        }
        (!table.rows.is_empty()).then_some(table)
    }
}
