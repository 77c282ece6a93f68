//! `armctl wait`: waits until robots of any family are in a state.

use super::common::line::{Reading, SharedLine};
use super::status::Overview;
use armctl_frame::condition::{Comparison, Condition};
use armctl_frame::face::overview::OverviewReport;
use armctl_frame::prelude::*;
use armctl_frame::run::{Repeat, as_value};
use armctl_frame::{AnyCommand, SchemaEntry};

const DEFAULT_INTERVAL: Duration = Duration::from_millis(200);
/// Nouns whose values can have names, in search order.
const NOUNS: [&str; 7] = ["io", "var", "counter", "timer", "register", "port", "param"];

/// Wait until a condition is true for all selected robots, and print their state
#[derive(Debug, Args)]
#[command(after_help = "A condition is one of idle, running, held, faulted, homed and servo-on, or NAME=VALUE, or a \
                        jq filter over the JSON of `armctl status`. NAME is a key of `armctl status`, or a signal, \
                        variable, counter or timer by name or label. A jq filter begins with a dot. If a robot cannot \
                        be reached, the wait ends with exit code 4, except with reachable=true.")]
pub struct Wait {
    /// The condition, for example idle, servo-on, clamp=on, 'B5>=3', fault_code=4315, or '.data.position.z_mm > 100'
    condition: String,
    /// Longest time to wait. After it, the exit code is 8, or 4 if the controller did not answer [default: no limit]
    #[arg(long = "for", value_name = "TIME", value_parser = duration::parse_some)]
    within: Option<Duration>,
}

impl Wait {
    /// Command that reads what the condition needs: the status, or a signal or variable.
    ///
    /// # Errors
    /// If no family has a value with this name.
    pub fn command(&self) -> Result<Box<dyn AnyCommand>> {
        Ok(match self.item()? {
            Some(comparison) => Box::new(SharedLine::reading("wait", &NOUNS, comparison.name)?),
            None => Box::new(Overview::default()),
        })
    }

    /// Repetition of the command for this condition.
    ///
    /// # Errors
    /// If the condition is not valid.
    pub fn repeat(&self, given: &Repeat) -> Result<Repeat> {
        let until = match self.item()? {
            Some(comparison) => Condition::item_of_noun(&self.condition, &comparison)?,
            None => Condition::new(&self.condition)?,
        };
        let every = given.every.or(Some(DEFAULT_INTERVAL));
        let until = Some(until);
        Ok(Repeat { every, count: given.count, until, within: self.within, is_quiet: true, ..Repeat::default() })
    }

    /// Comparison of a signal or variable; `None` if the condition needs only the status.
    fn item(&self) -> Result<Option<Comparison<'_>>> {
        let keys = as_value(&OverviewReport::default())?;
        Ok(Comparison::parse(&self.condition).filter(|comparison| keys.get(comparison.name).is_none()))
    }
}

/// Schema of the report about a signal or variable.
pub fn schema() -> SchemaEntry {
    SchemaEntry::of::<Reading>("wait")
}
