//! `yerc axes`, `yerc position-error`, `yerc torque`: data per axis.

use std::str::FromStr;

use super::item_requests::ask_existing;
use super::position::ByAxis;
use crate::prelude::*;
use armctl_controller::yerc::payload::AxisNames;
use armctl_controller::yerc::query::{Coordinates, ReadAxes, ReadPositionError, ReadTorque};
use armctl_frame::items;
use armctl_frame::items::ItemError;

/// One control group, or all groups of the controller.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Groups {
    /// One group.
    One(Group),
    /// All existing groups.
    All,
}

impl FromStr for Groups {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.eq_ignore_ascii_case("all") {
            return Ok(Self::All);
        }
        text.parse().map(Self::One).map_err(|error: String| format!("{error}, or all"))
    }
}

impl fmt::Display for Groups {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::One(group) => group.fmt(f),
            Self::All => f.write_str("all"),
        }
    }
}

/// Every control group that a model can have, robots first.
pub(super) fn groups_of(model: Model) -> impl Iterator<Item = Group> {
    let (robots, bases, stations) = Group::counts(model);
    (1..=robots).map(Group::Robot).chain((1..=bases).map(Group::Base)).chain((1..=stations).map(Group::Station))
}

/// Reads the names of the axes (FS and DX 3.3.5).
#[derive(Debug, Args)]
pub struct AxesOf {
    /// Control group: a robot (R1 …), a base (B1 …) or a station (S1 …), or `all`
    #[arg(long, default_value_t = Groups::All)]
    group: Groups,
}

impl Command for AxesOf {
    type Family = Yerc;
    type Report = Configuration;
    const ID: &'static str = "yerc.axes";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Configuration> {
        let link = context.link;
        let model = match self.group {
            Groups::One(group) => link.model_for(|model| ReadAxes::new(model, group, Coordinates::Pulse)).await?,
            Groups::All => link.model().await?,
        };
        let encoding = link.encoding;
        let groups: Vec<Group> = match self.group {
            Groups::One(group) => vec![group],
            Groups::All => groups_of(model).collect(),
        };
        let mut questions = Vec::new();
        for group in groups {
            let pulse = ReadAxes::new(model, group, Coordinates::Pulse).map_err(usage)?;
            questions.push(((group, Coordinates::Pulse), pulse));
            // Stations have only pulses, and no cartesian coordinates.
            if let Ok(base) = ReadAxes::new(model, group, Coordinates::Base) {
                questions.push(((group, Coordinates::Base), base));
            }
        }
        let is_all = self.group == Groups::All;
        let mut found: Vec<GroupAxes> = Vec::new();
        for ((group, coordinates), outcome) in ask_existing(link, questions).await? {
            let names = outcome.map(|names| names_of(&names, encoding));
            if is_all && names.as_ref().is_ok_and(Vec::is_empty) {
                continue;
            }
            let name = group.to_string();
            if found.last().is_none_or(|entry| entry.group != name) {
                found.push(GroupAxes { group: name, pulse: None, base: None, errors: Vec::new() });
            }
            let entry = found.last_mut().expect("a group has its entry by now");
            let is_pulse = coordinates == Coordinates::Pulse;
            match names {
                Ok(names) if is_pulse => entry.pulse = Some(names),
                Ok(names) => entry.base = Some(names),
                Err(denied) => {
                    let asked = format!("{} axes of {group}", if is_pulse { "pulse" } else { "cartesian" });
                    entry.errors.push(ItemError::new(asked, read_failure(denied)));
                }
            }
        }
        Ok(Configuration { groups: found })
    }
}

/// Names of the axes. The names of unused axes are empty.
fn names_of(names: &AxisNames, encoding: Encoding) -> Vec<String> {
    let used_axes = names.names.iter().filter(|name| !name.is_empty());
    used_axes.map(|name| encoding.decode(name.as_bytes())).collect()
}

/// Names of the axes of control groups.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Configuration {
    groups: Vec<GroupAxes>,
}

#[derive(Debug, Serialize, JsonSchema)]
struct GroupAxes {
    /// Control group, such as `R1`.
    group: String,
    /// Axis names in pulse coordinates; null if the controller refused.
    pulse: Option<Vec<String>>,
    /// Axis names in cartesian coordinates; null for stations, or if the controller refused.
    base: Option<Vec<String>>,
    /// Refusals for another reason than a missing group.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    errors: Vec<ItemError>,
}

impl Report for Configuration {
    fn view(&self) -> View {
        let mut table = Table::new(&["group", "pulse axes", "cartesian axes"], "no control group");
        let names = |names: &Option<Vec<String>>| Cell::optional(names.as_ref().map(|names| names.join(" ")));
        for group in &self.groups {
            table.row([group.group.as_str().into(), names(&group.pulse), names(&group.base)]);
        }
        View::table(table)
    }

    fn failure(&self) -> Option<Failure> {
        let answered: usize = self
            .groups
            .iter()
            .map(|group| usize::from(group.pulse.is_some()) + usize::from(group.base.is_some()))
            .sum();
        let errors = || self.groups.iter().flat_map(|group| &group.errors);
        items::verdict(answered + errors().count(), errors())
    }
}

macro_rules! by_axis {
    (
        $(#[$doc:meta])* $name:ident, $id:literal, $query:ident,
        $(#[$report_doc:meta])* $report:ident { $(#[$field_doc:meta])* $field:ident }, $column:literal
    ) => {
        $(#[$doc])*
        #[derive(Debug, Args)]
        pub struct $name {
            /// Control group: a robot (R1 …), a base (B1 …) or a station (S1 …)
            #[arg(long, default_value = "R1")]
            group: Group,
        }

        impl Command for $name {
            type Family = Yerc;
            type Report = $report;
            const ID: &'static str = $id;

            async fn run(&self, context: Context<'_, Yerc>) -> Result<$report> {
                let link = context.link;
                let question = link.by_model(|model| $query::new(model, self.group)).await?;
                let Some(axes) = link.ask(&question).await.known()? else {
                    link.plan_existing_axes(self.group, Coordinates::Pulse);
                    return Err(unknown());
                };
                let (axes, fitted) = link.existing_axes(self.group, Coordinates::Pulse, axes).await;
                let is_robot = matches!(self.group, Group::Robot(_));
                Ok($report { group: self.group.to_string(), $field: ByAxis::new(axes, is_robot, fitted) })
            }
        }

        $(#[$report_doc])*
        #[derive(Debug, Serialize, JsonSchema)]
        pub struct $report {
            /// Control group, such as `R1`.
            group: String,
            $(#[$field_doc])*
            $field: ByAxis,
        }

        impl Report for $report {
            fn view(&self) -> View {
                let mut table = Table::new(&["axis", $column], "no axes");
                for (name, value) in self.$field.rows() {
                    table.row([name.into(), value.into()]);
                }
                View::table(table)
            }
        }
    };
}

by_axis! {
    /// Position deviation (following error) of the axes (FS and DX 3.3.7).
    PositionError, "yerc.position-error", ReadPositionError,
    /// Position deviation (following error) of the axes.
    PositionErrors {
        /// Deviation for each axis: `s`, `l`, `u`, `r`, `b`, `t`, `e` of a robot, `axis_1` and so on of other groups.
        error_pulses
    }, "error (pulses)"
}
by_axis! {
    /// Torque of the axes (FS and DX 3.3.8).
    Torque, "yerc.torque", ReadTorque,
    /// Torque of the axes.
    Torques {
        /// Raw value for each axis, as in `yerc.position`. The manuals define no unit.
        torque_raw
    }, "torque (raw)"
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::testing::{frames, frames_on, golden, reports};
    use armctl_client::yerc::AxisSet;
    use armctl_controller::yerc::payload::{Axes, Text};
    use armctl_frame::output::render;

    #[test]
    fn parses_one_group_or_all() {
        assert_eq!(frames("axes --group R1").unwrap(), [golden("R11"), "7400650000010000".to_owned()]);
        assert_eq!(frames("axes --group S24").unwrap(), ["74002c0000010000"]);
        assert_eq!(frames("axes").unwrap().len(), 8 * 2 + 8 * 2 + 24);
        assert_eq!(frames_on("udp://h?model=fs100", "axes --group all").unwrap().len(), 2 * 2 + 2 * 2 + 3);
        assert_eq!(frames_on("udp://h?model=fs100", "axes --group R3").unwrap_err().kind, Kind::Usage);
    }

    #[test]
    fn reads_error_and_torque_of_a_group() {
        let axes = "7400010000010000".to_owned();
        assert_eq!(frames("position-error").unwrap(), [golden("R15"), axes]);
        assert_eq!(frames("torque --group B8").unwrap(), ["7700120000010000", "7400120000010000"]);
    }

    #[test]
    fn omits_unused_axes() {
        let mut names = AxisNames::default();
        for (slot, name) in names.names.iter_mut().zip(["S", "L", "U"]) {
            *slot = Text::cut(name.as_bytes());
        }
        assert_eq!(names_of(&names, Encoding::Utf8), ["S", "L", "U"]);
    }

    #[test]
    fn labels_torque_as_raw() {
        let axes = Axes::new(&[-3, 7]).unwrap();
        let report = Torques { group: "R1".into(), torque_raw: ByAxis::new(axes, true, AxisSet::ALL) };
        assert_eq!(render::csv(&report.view()), "axis,torque_raw\nS,-3\nL,7\n");
        assert_eq!(serde_json::to_string(&report).unwrap(), r#"{"group":"R1","torque_raw":{"s":-3,"l":7}}"#);
    }

    #[tokio::test(start_paused = true)]
    async fn asks_the_controller_for_its_groups() {
        let [axes] = reports("groups = [\"R1\", \"S1\"]", &["axes"]).await.try_into().unwrap();
        let groups = axes.unwrap();
        assert_eq!(groups["groups"].as_array().map(Vec::len), Some(2), "{groups}");
        assert_eq!(groups["groups"][0]["base"], json!(["X", "Y", "Z", "Rx", "Ry", "Rz"]));
        assert_eq!(groups["groups"][1]["group"], "S1");
        assert_eq!(groups["groups"][1]["base"], json!(null));
    }
}
