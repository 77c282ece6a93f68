//! `armctl teach`: a panel that moves a robot by single steps and teaches points. Every key runs a command line, as if
//! the user had typed it; `crate::app` executes the line.
//!
//! | file | contents |
//! |---|---|
//! | `model` | selection, motion in progress, past commands; no terminal, no link, no clock |
//! | `keys` | key bindings and their help |
//! | `view` | screen: the robot as in `top`, with the panel below |

mod keys;
mod model;
mod screen_loop;
#[cfg(test)]
mod tests;
mod view;

pub use self::screen_loop::show;
use armctl_frame::gate::Intent;
use armctl_frame::prelude::*;
use armctl_frame::settings::target::Family;

/// Arguments of `teach`; `crate::app` runs it.
#[derive(Debug, Args)]
#[command(
    after_help = "Select one robot: -r NAME, -t URL, or --sim with the family. A key moves one axis by one step. The \
                  next key has an effect after the end of that step, so the motion ends even if the terminal is \
                  lost. This is not a dead man's switch, and does not replace the enabling device of the pendant: \
                  see `armctl help safety`. The screen shows the keys, `?` explains them, `q` ends."
)]
pub struct Teach {
    /// Family of the robot, if armctl cannot infer it
    #[arg(value_name = "FAMILY")]
    pub family: Option<Family>,
    /// Largest step of one key press, in mm, degrees, or the unit of the axes
    #[arg(long, value_name = "MM", default_value = "10", value_parser = parse_positive)]
    pub max_step: f64,
    /// Highest speed, in mm/s or percent
    #[arg(long, value_name = "SPEED", default_value = "10", value_parser = clap::value_parser!(u32).range(1..=250))]
    pub max_speed: u32,
}

fn parse_positive(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| format!("'{text}' is not a number"))?;
    if value.is_finite() && value > 0.0 { Ok(value) } else { Err("the number must be above 0".to_owned()) }
}

impl Teach {
    /// Intent for the gate: one confirmation for all steps of the panel.
    pub fn intent(&self) -> Intent {
        let Self { max_step, max_speed, .. } = self;
        Intent {
            risk: Risk::Motion,
            text: format!(
                "move the robot as you press keys, one axis by at most {max_step} mm or degrees (for joints, the step \
                 on the screen) at a time, at a speed of at most {max_speed} mm/s, deg/s or percent (Toyo: at the \
                 speed of the controller), and store points"
            ),
            confirmation: Confirmation::Question,
            is_stop: false,
        }
    }
}

/// Runs command lines of the panel.
#[expect(async_fn_in_trait, reason = "all code runs on one thread")]
pub trait CommandRunner {
    /// Runs a command line of the family, and returns the data of its report.
    async fn run(&self, words: &[String]) -> Result<Value, Failure>;
}
