//! `yerc var restore`.

use std::collections::HashMap;
use std::path::PathBuf;

use anyhow::Context as _;
use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value as Json;

use super::super::orders::usage;
use super::super::writes::{WriteOrder, write_all};
use super::dump::{FORMAT, VERSION, is_sheet};
use super::entry::{Reading, is_undefined};
use super::overwrite::{overwritten, same};
use super::read::{Answers, read_whatever};
use super::sheet::{self, Kept};
use super::{listed, parse_kind};
use crate::command::frame::dry_run::{Known as _, Reason, unknown};
use crate::command::frame::text_files;
use crate::command::yerc::link::{Link, Yerc};
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::controller::text::Encoding;
use crate::controller::yerc::Model;
use crate::controller::yerc::query::{Query as _, WriteVariable};
use crate::controller::yerc::variables::{Reference, Value, VariableKind, WriteStep, plan_writes};
use crate::failure::Failure;
use crate::files;
use crate::gate::Confirmation;
use crate::output::view::{Cell, View};

/// What to write back.
#[derive(Debug, Args)]
#[command(after_help = "The whole file is checked before anything is sent. What is null in it is left alone on the \
                        controller. If the work is interrupted or refused, the message says which variables were \
                        written and which were not.\n\nA table has columns name, value, text, and for positions type, x_mm \
                        and the like; cells are parted by commas, semicolons or tabs, and numbers may have a decimal comma \
                        unless commas part the cells. What a position has no cell for stays as it is on the \
                        controller. Columns beginning with comment are yours.")]
pub struct Restore {
    /// What `var dump` wrote: JSON, or a table NAME.csv
    file: PathBuf,
    /// Only these kinds: B,I,D,R,S,P,BP,EX
    #[arg(long, value_name = "KINDS", value_delimiter = ',', value_parser = parse_kind)]
    only: Vec<VariableKind>,
}

impl Command for Restore {
    type Family = Yerc;
    type Report = Restored;
    const ID: &'static str = "yerc.var.restore";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite variables by those of the file";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Restored, Failure> {
        let Context { link, screen, authority, .. } = context;
        let shown = self.file.display().to_string();
        let wrong = |error: String| {
            Failure::usage(format!("{shown}: {error}")).hint("nothing was sent; correct the file, or take a new dump")
        };
        let model = link.model().await?;
        let dump = if is_sheet(&self.file) {
            let reading = Reading { model, encoding: link.encoding };
            let variables = sheet::read(&text_files::read(&self.file)?, reading);
            let variables = variables.map_err(|errors| text_files::faulty(&shown, &errors))?;
            Dump { model, encoding: link.encoding, variables }
        } else {
            Dump::parse(&self.read()?, model).map_err(wrong)?
        };
        let kept: Vec<(Reference, Option<Kept>)> =
            dump.variables.into_iter().filter(|(reference, _)| self.wants(*reference)).collect();
        let undefined: Vec<Reference> =
            kept.iter().filter(|(_, value)| value.is_none()).map(|(reference, _)| *reference).collect();
        let values: Vec<(Reference, Kept)> =
            kept.into_iter().filter_map(|(reference, value)| Some((reference, value?))).collect();
        if values.is_empty() {
            return Err(Failure::usage(format!("{shown} holds no values of the kinds wanted"))
                .hint("--only chooses the kinds; what is null in the file is left alone"));
        }
        if dump.model != model {
            screen.note(&format!("the dump was taken from a {}, this is a {model}", dump.model));
        }
        if dump.encoding != link.encoding {
            screen.note(&format!("strings are written in {}, as the dump says", dump.encoding));
        }
        if !undefined.is_empty() {
            screen.note(&format!("left alone, undefined in the dump: {}", listed(undefined.iter().copied())));
        }
        let references: Vec<Reference> = values.iter().map(|(reference, _)| *reference).collect();
        let known = read_whatever(link, &references).await.known()?;
        let is_dry = known.is_none();
        let known = known.unwrap_or_default();
        if is_dry {
            plan_parts(link, &values)?;
        }
        let values = resolved(values, &known, is_dry).map_err(wrong)?;
        let is_same = |(reference, value): &(Reference, Value)| {
            known.get(reference).is_some_and(|old| old.as_ref().is_ok_and(|old| same(old, value)))
        };
        let (unchanged, differing): (Vec<_>, Vec<_>) = values.into_iter().partition(is_same);
        authority.confirm(&overwritten(&known, &differing, dump.encoding)).await?;
        let numbered: Vec<(u16, Value)> =
            differing.iter().map(|(reference, value)| (reference.number, value.clone())).collect();
        let steps = plan_writes(&numbered).map_err(usage)?;
        if is_dry {
            for step in &steps {
                let about = format!("writes {}", listed(step.written().iter().copied()));
                let reason = Reason::about(&about).depending_on("which values differ: only those are written");
                link.plan_if(&step.request(), reason);
            }
            return Err(unknown());
        }
        write_all(link, screen, &steps).await?;
        let unchanged: Vec<Reference> = unchanged.into_iter().map(|(reference, _)| reference).collect();
        let written: Vec<Reference> = steps.iter().flat_map(WriteStep::written).copied().collect();
        Ok(Restored {
            file: shown,
            written: written.len(),
            written_names: listed(written),
            unchanged: unchanged.len(),
            unchanged_names: listed(unchanged),
            left_alone: undefined.len(),
            left_alone_names: listed(undefined),
            requests: steps.len(),
        })
    }
}

/// Notes positions that a file has in part.
fn plan_parts(link: &mut Link, values: &[(Reference, Kept)]) -> Result<(), Failure> {
    for (reference, kept) in values {
        let Some(fields) = kept.describe() else { continue };
        let about = format!("writes {reference} with {fields}, unless it is so; the rest of it stays as it is");
        let Some(ends) = kept.sketch(reference.kind) else {
            link.then(&about);
            continue;
        };
        let [one, other] = ends.map(|value| WriteVariable::new(reference.number, value).map_err(usage));
        link.plan_depending(&one?.request(), &other?.request(), Reason::about(&about).depending_on("what was read"));
    }
    Ok(())
}

/// Whole values: positions with what they keep. Those are not known in a dry run, and left out.
fn resolved(values: Vec<(Reference, Kept)>, known: &Answers, is_dry: bool) -> Result<Vec<(Reference, Value)>, String> {
    let values = values.into_iter().filter(|(_, kept)| !is_dry || kept.describe().is_none());
    let whole = |(reference, kept): (Reference, Kept)| {
        let old = match known.get(&reference) {
            Some(Ok(old)) => Some(old),
            // What was not told cannot be kept.
            Some(Err(denied)) if kept.describe().is_some() && !is_undefined(denied) => {
                return Err(format!("{reference}: it could not be read: {}", Failure::from(denied.clone()).message));
            }
            _ => None,
        };
        Ok((reference, kept.over(reference.kind, old).map_err(|error| format!("{reference}: {error}"))?))
    };
    values.map(whole).collect()
}

/// A dump of every variable that a controller can have is smaller.
const MOST: u64 = 256 << 20;

impl Restore {
    fn wants(&self, reference: Reference) -> bool {
        // Kinds of the flag name strings by their 32-byte form.
        self.only.is_empty() || self.only.iter().any(|kind| kind.letters() == reference.kind.letters())
    }

    fn read(&self) -> Result<String, Failure> {
        Ok(files::text(&self.file, MOST).with_context(|| self.file.display().to_string())?)
    }
}

/// A dump that is right from the first byte to the last.
#[derive(Debug)]
struct Dump {
    model: Model,
    encoding: Encoding,
    variables: Vec<(Reference, Option<Kept>)>,
}

impl Dump {
    /// Reads a file for a robot of `model`. The error begins with the place in the JSON.
    fn parse(text: &str, model: Model) -> Result<Self, String> {
        let json: Json = serde_json::from_str(text).map_err(|error| format!("no JSON: {error}"))?;
        if json.get("format").and_then(Json::as_str) != Some(FORMAT) {
            return Err(format!("format: \"{FORMAT}\" is expected; this is not a dump of variables"));
        }
        if json.get("version").and_then(Json::as_u64) != Some(VERSION) {
            return Err(format!("version: {VERSION} is expected; a newer armctl may have written it"));
        }
        if json.get("family").is_some_and(|family| family != "yerc") {
            return Err("family: the dump is of another family than yerc".to_owned());
        }
        let text =
            |name: &str| json.get(name).and_then(Json::as_str).ok_or_else(|| format!("{name}: a name is expected"));
        let taken_from: Model = text("model")?.parse().map_err(|error| format!("model: {error}"))?;
        let encoding: Encoding = text("encoding")?.parse().map_err(|error| format!("encoding: {error}"))?;
        let entries = ["variables", "items"].iter().find_map(|list| json.get(*list)?.as_array());
        let entries = entries.ok_or("variables: a list is expected")?;
        let reading = Reading { model, encoding };
        let mut seen = HashMap::new();
        let mut variables = Vec::with_capacity(entries.len());
        for (index, entry) in entries.iter().enumerate() {
            let (reference, value) = reading.entry(entry).map_err(|error| format!("variables[{index}]{error}"))?;
            if let Some(first) = seen.insert(reference, index) {
                return Err(format!("variables[{index}].name: {reference} is in variables[{first}] already"));
            }
            variables.push((reference, value.map(Kept::Whole)));
        }
        Ok(Self { model: taken_from, encoding, variables })
    }
}

impl WriteOrder for WriteStep {
    type Item = Reference;

    fn items(&self) -> Vec<Reference> {
        self.written().to_vec()
    }

    fn listed(items: Vec<Reference>) -> String {
        listed(items)
    }
}

/// What was written back.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Restored {
    file: String,
    /// How many variables.
    written: usize,
    /// Which, as in `B0..B99, I0..I99`.
    written_names: String,
    /// How many the controller held like this already.
    unchanged: usize,
    unchanged_names: String,
    /// How many the dump has no value for.
    left_alone: usize,
    left_alone_names: String,
    /// Frames it took.
    requests: usize,
}

impl Report for Restored {
    fn view(&self) -> View {
        let names = |count: usize, names: &str| if count == 0 { "-".into() } else { Cell::from(names) };
        View::fields([
            ("written", names(self.written, &self.written_names)),
            ("unchanged", names(self.unchanged, &self.unchanged_names)),
            ("left alone", names(self.left_alone, &self.left_alone_names)),
            ("variables", self.written.into()),
            ("requests", self.requests.into()),
        ])
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn dump(variables: &Json) -> String {
        json!({"format": FORMAT, "version": 1, "model": "dx200", "encoding": "shift_jis", "variables": variables})
            .to_string()
    }

    #[test]
    fn the_error_names_the_place() {
        let error = |text: &str| Dump::parse(text, Model::Dx200).unwrap_err();
        let entry = |entry: Json| error(&dump(&json!([{"name": "B0", "value": 1}, entry])));
        assert_eq!(
            entry(json!({"name": "B1", "value": 256})),
            "variables[1].value: '256' is not a number from 0 to 255"
        );
        assert_eq!(entry(json!({"name": "B0", "value": 2})), "variables[1].name: B0 is in variables[0] already");
        assert!(error("{").starts_with("no JSON: "));
        assert!(error("{}").starts_with("format: "));
        assert!(error(&dump(&json!([])).replace("\"version\":1", "\"version\":2")).starts_with("version: "));
        assert!(error(&dump(&json!({}))).starts_with("variables: "));
        assert!(error(&dump(&json!([])).replace("shift_jis", "klingon")).starts_with("encoding: "));
    }

    #[test]
    fn strings_must_fit_the_robot() {
        let text = dump(&json!([{"name": "S0", "value": "12345678901234567"}]));
        assert!(Dump::parse(&text, Model::Dx200).is_ok());
        let error = Dump::parse(&text, Model::Fs100).unwrap_err();
        assert!(error.starts_with("variables[0].value: the text has 17 bytes"), "{error}");
    }
}
