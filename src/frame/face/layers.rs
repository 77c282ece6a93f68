//! Layers of `armctl robots check`, from the name of a robot to its alarms.

use super::overview::LeftOver;
use crate::failure::pasteable;
use crate::prelude::basics::*;

/// One layer.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Layer {
    /// Name of the layer.
    layer: &'static str,
    state: State,
    /// Finding; for a skipped layer, the reason.
    found: String,
    /// What to set or to do; null if the layer is ok.
    advice: Option<String>,
}

/// State of a layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// Ok.
    Ok,
    /// Works with a restriction.
    Warning,
    /// Failed.
    Failed,
    /// Not checked.
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
    /// Layers of the robot `label`; `names` are all layers.
    pub fn new(label: String, names: impl Into<Vec<&'static str>>) -> Self {
        Self { label, names: names.into(), found: Vec::new() }
    }

    /// Adds an ok layer.
    pub fn ok(&mut self, layer: &'static str, found: impl Into<String>) {
        self.add(layer, State::Ok, found.into(), None);
    }

    /// Adds a layer with a warning.
    pub fn warn(&mut self, layer: &'static str, found: impl Into<String>, advice: impl Into<String>) {
        self.add(layer, State::Warning, found.into(), Some(advice.into()));
    }

    /// Adds a failed layer.
    pub fn fail_with(&mut self, layer: &'static str, found: impl Into<String>, advice: impl Into<String>) {
        self.add(layer, State::Failed, found.into(), Some(advice.into()));
    }

    /// Adds a layer that could not be read.
    pub fn fail(&mut self, layer: &'static str, failure: &Failure) {
        let message = failure.message.strip_prefix(&format!("{}: ", self.label)).unwrap_or(&failure.message);
        self.add(layer, State::Failed, message.to_owned(), failure.hint.clone());
    }

    /// Adds an ok layer if `is_well` is true, otherwise a warning.
    pub fn judge(&mut self, layer: &'static str, is_well: bool, (well, ill): (&str, &str), advice: &str) {
        if is_well { self.ok(layer, well) } else { self.warn(layer, ill, advice) }
    }

    /// Adds state that an earlier client left; no layer if there is none.
    pub fn leftover_drafts(&mut self, left: &[LeftOver]) {
        let joined = |part: fn(&LeftOver) -> &str| left.iter().map(part).collect::<Vec<_>>().join("; ");
        if !left.is_empty() {
            self.warn("left over", joined(|left| &left.what), joined(|left| &left.undo));
        }
    }

    /// Whether no layer has failed so far.
    pub fn is_passed(&self) -> bool {
        self.found.iter().all(|layer| layer.state != State::Failed)
    }

    /// Layers in their order; skipped layers have the reason.
    pub fn finish(mut self) -> Vec<Layer> {
        let why = match self.found.iter().rev().find(|layer| layer.state == State::Failed) {
            Some(failed) => format!("{} failed", failed.layer),
            None => "could not be read".to_owned(),
        };
        let names = std::mem::take(&mut self.names);
        for name in &names {
            if !self.found.iter().any(|found| found.layer == *name) {
                self.add(name, State::Skipped, why.clone(), None);
            }
        }
        // Layers that are not in the list come last.
        self.found.sort_by_key(|found| names.iter().position(|name| *name == found.layer).unwrap_or(names.len()));
        self.found
    }

    /// Adds a finding. A later finding replaces an earlier finding of the same layer.
    fn add(&mut self, layer: &'static str, state: State, found: String, advice: Option<String>) {
        self.found.retain(|known| known.layer != layer);
        let advice = advice.map(|advice| pasteable(&advice));
        self.found.push(Layer { layer, state, found, advice });
    }
}

/// Removes partial files of killed commands from this folder; no layer if there are none.
pub fn drafts() -> Option<Layer> {
    let (removed, left) = files::sweep(Path::new("."));
    (removed + left > 0).then(|| Layer {
        layer: "partial files",
        state: if left > 0 { State::Warning } else { State::Ok },
        found: format!("partial files of killed commands (.armctl-*.part): {removed} removed, {left} not removed"),
        advice: (left > 0).then(|| "remove the files as a user with permission".to_owned()),
    })
}

/// Table of layers.
pub fn table(layers: &[Layer]) -> Table {
    let mut table = Table::new(&["layer", "state", "found"], "no layers");
    for Layer { layer, state, found, advice } in layers {
        let described = advice.as_ref().map_or_else(|| found.clone(), |advice| format!("{found}; {advice}"));
        table.row([Cell::from(*layer).whole(), Cell::from(state.name()).tone(state.tone()), described.into()]);
    }
    table
}

/// First failed layer.
pub fn first_failed(layers: &[Layer]) -> Option<(&'static str, &str)> {
    layers.iter().find(|layer| layer.state == State::Failed).map(|layer| (layer.layer, layer.found.as_str()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::render;

    #[test]
    fn skips_layers_after_a_failure() {
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
