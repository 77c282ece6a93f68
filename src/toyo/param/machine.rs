//! Special rules for parameters 2 (E, machine) and parameters 3 (U, special).

use crate::prelude::*;
use armctl_controller::toyo::table::Group;

/// Maximum number of steps of all tasks together (TO 2-4, parameter E22).
const MAX_STEPS: i32 = 5000;
/// Maximum number of steps if there are easy programs.
const BESIDE_EASY: i32 = 2000;

/// Remedy after a change of a machine parameter.
pub const POWER_CYCLE: &str = "switch the controller's power off and on; until then the controller executes no \
                               command";

/// Describes the consequence of a change of these machine parameters.
pub fn consequence_of(parameters: &[&Parameter]) -> String {
    let names: Vec<String> =
        parameters.iter().map(|parameter| format!("{} ({})", parameter.id, parameter.name)).collect();
    let what = if names.len() > 3 { format!("{} machine parameters", names.len()) } else { names.join(", ") };
    of_machine(&what, parameters.iter().any(|parameter| is_task_steps(parameter)))
}

/// Consequence of a change of machine parameters. `has_steps` is whether the number of steps of the tasks changes.
fn of_machine(what: &str, has_steps: bool) -> String {
    let lost = if has_steps {
        "; a task with fewer steps loses its last steps, and with more than 2000 steps in total all easy programs are \
         lost"
    } else {
        ""
    };
    format!("after a change of {what}, the controller executes no command until a restart{lost}")
}

/// Returns the warnings to print before a parameter changes.
pub fn warnings(parameter: &Parameter, stored: Option<&Record>, values: &[Value]) -> Vec<String> {
    if parameter.group() == Group::Special {
        return vec![format!("warning: {} ({}) is not for normal use", parameter.id, parameter.name)];
    }
    match stored {
        Some(stored) if is_task_steps(parameter) => lost_steps(stored, values),
        _ => Vec::new(),
    }
}

/// Checks that the new values are consistent.
pub fn check(parameter: &Parameter, values: &[Value]) -> Result<()> {
    let steps = total(values);
    if is_task_steps(parameter) && steps > MAX_STEPS {
        return Err(Failure::usage(format!("all tasks together would have {steps} steps; the limit is {MAX_STEPS}"))
            .hint("reduce the steps of another task: `toyo param get task-steps`"));
    }
    Ok(())
}

/// Whether a parameter defines the number of steps of each task.
pub fn is_task_steps(parameter: &Parameter) -> bool {
    parameter.id == "E22"
}

fn lost_steps(stored: &Record, values: &[Value]) -> Vec<String> {
    let mut lost = Vec::new();
    for (task, (old, new)) in stored.values().iter().zip(values).enumerate() {
        if let (Value::Number(old), Value::Number(new)) = (old, new)
            && new < old
        {
            lost.push(format!("warning: steps {} to {old} of task {} become NOP", new + 1, task + 1));
        }
    }
    if total(values) > BESIDE_EASY && total(stored.values()) <= BESIDE_EASY {
        lost.push(format!("warning: with more than {BESIDE_EASY} steps, all easy programs are erased"));
    }
    lost
}

fn total(values: &[Value]) -> i32 {
    values.iter().map(|value| if let Value::Number(steps) = value { *steps } else { 0 }).sum()
}
