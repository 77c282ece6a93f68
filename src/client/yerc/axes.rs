//! Axes of a control group. Some controllers answer with a word for each possible axis, also for axes that do not
//! exist. For such an answer, the client reads the axis configuration (0x74), once per connection, to find out which
//! axes exist.

use armctl_controller::yerc::group::Group;
use armctl_controller::yerc::payload::{Axes, AxisNames, MAX_AXES};
use armctl_controller::yerc::query::{Coordinates, Query as _, ReadAxes};

use super::Client;
use crate::Reason;

/// Set of existing axes, one bit per axis.
///
/// ```
/// use armctl_client::yerc::{AxisSet, Client, Coordinates, Endpoint, Group, Model, Options, ReadPosition};
///
/// # #[tokio::main(flavor = "current_thread", start_paused = true)]
/// # async fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut robot = Client::connect(Endpoint::simulator(Model::Dx200), Options::auto()).await?;
/// let read = ReadPosition::new(Model::Dx200, Group::R1, Coordinates::Pulse)?;
/// let axes = robot.ask(&read).await?.axes;
/// let (axes, axis_set): (_, AxisSet) = robot.existing_axes(Group::R1, Coordinates::Pulse, axes).await;
/// assert!(axis_set.has(5));
/// assert!(axes.as_slice().len() >= 6);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AxisSet(u8);

/// Added status of a refusal: a certain screen is open on the pendant, and while it is open, the axis names cannot be
/// read (DX 3.3.5).
const CONVERTING: u32 = 0x2150;

impl AxisSet {
    /// Every axis in the answer exists.
    pub const ALL: Self = Self(u8::MAX);

    /// Returns the set of the axes that have a name, or [`Self::ALL`] if no axis has a name.
    fn from_names(names: &AxisNames) -> Self {
        let mask = names.names.iter().enumerate().fold(0, |mask, (axis, name)| {
            let is_blank = name.as_bytes().iter().all(u8::is_ascii_whitespace);
            if is_blank { mask } else { mask | 1 << axis }
        });
        if mask == 0 { Self::ALL } else { Self(mask) }
    }

    /// Whether this axis exists. Axes are counted from 0.
    pub const fn has(self, axis: usize) -> bool {
        axis < MAX_AXES && self.0 >> axis & 1 == 1
    }

    /// Returns the values up to the last existing axis. A missing axis among them has the value 0.
    fn trim(self, axes: Axes) -> Axes {
        let count = (0..axes.as_slice().len()).rev().find(|axis| self.has(*axis)).map_or(0, |last| last + 1);
        let values = axes.as_slice().iter().enumerate().take(count);
        let values: Vec<i32> = values.map(|(axis, value)| if self.has(axis) { *value } else { 0 }).collect();
        Axes::new(&values).unwrap_or(axes)
    }
}

impl Client {
    /// Removes the values of missing axes from the answer `axes` of a group. Reads the axis configuration if the answer
    /// can contain missing axes.
    pub async fn existing_axes(&mut self, group: Group, coordinates: Coordinates, axes: Axes) -> (Axes, AxisSet) {
        if axes.as_slice().len() < MAX_AXES {
            // No group has eight axes, so an answer with fewer than eight values contains only existing axes.
            return (axes, AxisSet::ALL);
        }
        let axis_set = self.read_axis_set(group, coordinates).await;
        (axis_set.trim(axes), axis_set)
    }

    /// Dry run: plans the read of the axis configuration that [`Client::existing_axes`] may send.
    pub fn plan_existing_axes(&mut self, group: Group, coordinates: Coordinates) {
        let is_planned = self.axis_sets.iter().any(|known| (known.0, known.1) == (group, coordinates));
        let Ok(query) = ReadAxes::new(self.model_for_display(), group, coordinates) else { return };
        if !is_planned {
            let reason = Reason::about("which axes exist; sent if the previous answer has all eight axes");
            self.plan_if(&query.request(), reason.depending_on("the number of axes in the previous answer"));
            self.axis_sets.push((group, coordinates, AxisSet::ALL));
        }
    }

    async fn read_axis_set(&mut self, group: Group, coordinates: Coordinates) -> AxisSet {
        let known = self.axis_sets.iter().find(|known| (known.0, known.1) == (group, coordinates));
        if let Some((.., axis_set)) = known {
            return *axis_set;
        }
        let Ok(query) = ReadAxes::new(self.model_for_display(), group, coordinates) else { return AxisSet::ALL };
        let axis_set = match self.try_ask(&query).await {
            Ok(Ok(names)) => AxisSet::from_names(&names),
            // The client does not store this result: the screen may be closed at the next read.
            Ok(Err(refusal)) if refusal.status.added == CONVERTING => return AxisSet::ALL,
            Ok(Err(_)) | Err(_) => AxisSet::ALL,
        };
        self.axis_sets.push((group, coordinates, axis_set));
        axis_set
    }
}

#[cfg(test)]
mod tests {
    use armctl_controller::yerc::payload::Text;

    use super::*;

    #[test]
    fn axes_without_a_name_do_not_exist() {
        let mut names = AxisNames::default();
        assert_eq!(AxisSet::from_names(&names), AxisSet::ALL);
        for (axis, name) in [(0, "S"), (1, "L"), (2, "U"), (5, "T"), (6, "  ")] {
            names.names[axis] = Text::cut(name.as_bytes());
        }
        let axis_set = AxisSet::from_names(&names);
        assert!(axis_set.has(5) && !axis_set.has(3) && !axis_set.has(6) && !axis_set.has(8));
        let axes = Axes::full([1, 2, 3, 4, 5, 6, 7, 8]);
        assert_eq!(axis_set.trim(axes).as_slice(), [1, 2, 3, 0, 0, 6]);
        assert_eq!(AxisSet::ALL.trim(axes), axes);
    }
}
