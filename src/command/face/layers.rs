//! What `armctl robots check` finds out about a robot, layer by layer, from its name to its alarms.

use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;

use super::overview::LeftOver;
use crate::failure::Failure;
use crate::files;
use crate::output::view::{Cell, Table, Tone};

/// One layer.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Layer {
    /// What was looked at.
    layer: &'static str,
    state: State,
    /// What was found; for a layer that was skipped, why.
    found: String,
    /// What to set or to do; null where all is well.
    advice: Option<String>,
}

/// How a layer is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// As it should be.
    Ok,
    /// It works, but something does not, or may not, for this.
    Warning,
    /// It does not work.
    Failed,
    /// Not looked at.
    Skipped,
}

impl State {
    const fn name(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::Warning => "warning",
            Self::Failed => "failed",
            Self::Skipped => "skipped",
        }
    }

    const fn tone(self) -> Tone {
        match self {
            Self::Ok => Tone::Good,
            Self::Warning => Tone::Warning,
            Self::Failed => Tone::Bad,
            Self::Skipped => Tone::Plain,
        }
    }
}

/// All layers of a robot, in order.
#[derive(Debug)]
pub struct Layers {
    label: String,
    names: Vec<&'static str>,
    found: Vec<Layer>,
}

impl Layers {
    /// Of the robot that messages name so; these are the layers there are.
    pub fn new(label: String, names: impl Into<Vec<&'static str>>) -> Self {
        Self { label, names: names.into(), found: Vec::new() }
    }

    /// As it should be.
    pub fn ok(&mut self, layer: &'static str, found: impl Into<String>) {
        self.add(layer, State::Ok, found.into(), None);
    }

    /// It works, but.
    pub fn warn(&mut self, layer: &'static str, found: impl Into<String>, advice: impl Into<String>) {
        self.add(layer, State::Warning, found.into(), Some(advice.into()));
    }

    /// It is not as it should be.
    pub fn wrong(&mut self, layer: &'static str, found: impl Into<String>, advice: impl Into<String>) {
        self.add(layer, State::Failed, found.into(), Some(advice.into()));
    }

    /// It could not be asked.
    pub fn fail(&mut self, layer: &'static str, failure: &Failure) {
        let message = failure.message.strip_prefix(&format!("{}: ", self.label)).unwrap_or(&failure.message);
        self.add(layer, State::Failed, message.to_owned(), failure.hint.clone());
    }

    /// Well, or a warning.
    pub fn judge(&mut self, layer: &'static str, is_well: bool, (well, ill): (&str, &str), advice: &str) {
        if is_well { self.ok(layer, well) } else { self.warn(layer, ill, advice) }
    }

    /// What somebody left behind; no layer where there is nothing.
    pub fn left_over(&mut self, left: &[LeftOver]) {
        let joined = |part: fn(&LeftOver) -> &str| left.iter().map(part).collect::<Vec<_>>().join("; ");
        if !left.is_empty() {
            self.warn("left over", joined(|left| &left.what), joined(|left| &left.undo));
        }
    }

    /// Whether none has failed so far.
    pub fn is_well(&self) -> bool {
        self.found.iter().all(|layer| layer.state != State::Failed)
    }

    /// The layers, in their order; those that were not reached say why.
    pub fn finish(mut self) -> Vec<Layer> {
        let why = match self.found.iter().rev().find(|layer| layer.state == State::Failed) {
            Some(failed) => format!("{} failed", failed.layer),
            None => "it could not be asked".to_owned(),
        };
        let names = std::mem::take(&mut self.names);
        for name in &names {
            if !self.found.iter().any(|found| found.layer == *name) {
                self.add(name, State::Skipped, why.clone(), None);
            }
        }
        // What has no place of its own comes last.
        self.found.sort_by_key(|found| names.iter().position(|name| *name == found.layer).unwrap_or(names.len()));
        self.found
    }

    /// What is found of a layer later counts.
    fn add(&mut self, layer: &'static str, state: State, found: String, advice: Option<String>) {
        self.found.retain(|known| known.layer != layer);
        self.found.push(Layer { layer, state, found, advice });
    }
}

/// Removes half-written files of commands that were killed from this folder; no layer where there are none.
pub fn drafts() -> Option<Layer> {
    let (removed, left) = files::sweep(Path::new("."));
    (removed + left > 0).then(|| Layer {
        layer: "left over here",
        state: if left > 0 { State::Warning } else { State::Ok },
        found: format!(
            "half-written files of commands that were killed (.armctl-*.part): {removed} removed, {left} not"
        ),
        advice: (left > 0).then(|| "remove them as a user who may".to_owned()),
    })
}

/// Layers as a table.
pub fn table(layers: &[Layer]) -> Table {
    let mut table = Table::new(&["layer", "state", "found"], "nothing to look at");
    for Layer { layer, state, found, advice } in layers {
        let told = advice.as_ref().map_or_else(|| found.clone(), |advice| format!("{found}; {advice}"));
        table.row([Cell::from(*layer).whole(), Cell::from(state.name()).tone(state.tone()), told.into()]);
    }
    table
}

/// The first layer that failed.
pub fn first_failed(layers: &[Layer]) -> Option<(&'static str, &str)> {
    layers.iter().find(|layer| layer.state == State::Failed).map(|layer| (layer.layer, layer.found.as_str()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::failure::Kind;
    use crate::output::render;
    use crate::output::view::View;

    #[test]
    fn what_comes_after_a_failure_is_skipped() {
        let mut layers = Layers::new("cell1 (udp://h)".to_owned(), ["name", "answer", "mode"]);
        layers.ok("name", "h is 10.0.0.2");
        layers.fail("answer", &Failure::new(Kind::NoAnswer, "cell1 (udp://h): no answer").hint("check the cable"));
        let layers = layers.finish();
        assert_eq!(first_failed(&layers), Some(("answer", "no answer")));
        let csv = render::csv(&View::table(table(&layers)));
        assert_eq!(
            csv,
            "layer,state,found\nname,ok,h is 10.0.0.2\nanswer,failed,no answer; check the cable\n\
             mode,skipped,answer failed\n"
        );
    }
}
