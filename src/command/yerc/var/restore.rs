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

/// Writes variables back.
#[derive(Debug, Args)]
#[command(after_help = "The whole file is checked before anything is sent. Variables that are null in the file stay \
                        unchanged. If the command is interrupted or refused, the message lists the variables that were \
                        written and those that were not.\n\nA table has the columns name, value, text, and for \
                        positions type, x_mm and so on. Commas, semicolons or tabs separate cells. Decimal commas are \
                        allowed unless commas separate the cells. Fields of a position without a cell stay unchanged \
                        on the controller. Columns that begin with comment are free for your use.")]
pub struct Restore {
    /// File from `var dump`: JSON, or a table NAME.csv
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
    const INTENT: &'static str = "overwrite variables with those of the file";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Restored, Failure> {
        let Context { link, screen, authority, .. } = context;
        let shown = self.file.display().to_string();
        let wrong = |error: String| {
            Failure::usage(format!("{shown}: {error}")).hint("nothing was sent; correct the file or create a new dump")
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
            return Err(Failure::usage(format!("{shown} has no values of the selected kinds"))
                .hint("select other kinds with --only; null values in the file are skipped"));
        }
        if dump.model != model {
            screen.note(&format!("the dump is from a {}, this is a {model}", dump.model));
        }
        if dump.encoding != link.encoding {
            screen.note(&format!("strings are written in {}, the encoding of the dump", dump.encoding));
        }
        if !undefined.is_empty() {
            screen.note(&format!("skipped, undefined in the dump: {}", listed(undefined.iter().copied())));
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
                let reason = Reason::about(&about).depending_on("which values differ; only those are written");
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

/// Notes positions that the file defines in part.
fn plan_parts(link: &mut Link, values: &[(Reference, Kept)]) -> Result<(), Failure> {
    for (reference, kept) in values {
        let Some(fields) = kept.describe() else { continue };
        let about = format!("writes {reference} with {fields}, if they differ; the rest stays unchanged");
        let Some(ends) = kept.sketch(reference.kind) else {
            link.then(&about);
            continue;
        };
        let [one, other] = ends.map(|value| WriteVariable::new(reference.number, value).map_err(usage));
        link.plan_depending(
            &one?.request(),
            &other?.request(),
            Reason::about(&about).depending_on("the values that were read"),
        );
    }
    Ok(())
}

/// Complete values: positions are completed with the values on the controller. In a dry run these are unknown and
/// left out.
fn resolved(values: Vec<(Reference, Kept)>, known: &Answers, is_dry: bool) -> Result<Vec<(Reference, Value)>, String> {
    let values = values.into_iter().filter(|(_, kept)| !is_dry || kept.describe().is_none());
    let whole = |(reference, kept): (Reference, Kept)| {
        let old = match known.get(&reference) {
            Some(Ok(old)) => Some(old),
            // A position that could not be read cannot be completed.
            Some(Err(denied)) if kept.describe().is_some() && !is_undefined(denied) => {
                return Err(format!("{reference} could not be read: {}", Failure::from(denied.clone()).message));
            }
            _ => None,
        };
        Ok((reference, kept.over(reference.kind, old).map_err(|error| format!("{reference}: {error}"))?))
    };
    values.map(whole).collect()
}

/// Maximum file size: larger than a dump of every variable that a controller can have.
const MOST: u64 = 256 << 20;

impl Restore {
    fn wants(&self, reference: Reference) -> bool {
        // Kinds of the option use the 32-byte form of strings.
        self.only.is_empty() || self.only.iter().any(|kind| kind.letters() == reference.kind.letters())
    }

    fn read(&self) -> Result<String, Failure> {
        Ok(files::text(&self.file, MOST).with_context(|| self.file.display().to_string())?)
    }
}

/// A dump that is completely valid.
#[derive(Debug)]
struct Dump {
    model: Model,
    encoding: Encoding,
    variables: Vec<(Reference, Option<Kept>)>,
}

impl Dump {
    /// Reads a file for a robot of `model`. An error starts with the location in the JSON.
    fn parse(text: &str, model: Model) -> Result<Self, String> {
        let json: Json = serde_json::from_str(text).map_err(|error| format!("no JSON: {error}"))?;
        if json.get("format").and_then(Json::as_str) != Some(FORMAT) {
            return Err(format!("format: expected \"{FORMAT}\"; this is not a dump of variables"));
        }
        if json.get("version").and_then(Json::as_u64) != Some(VERSION) {
            return Err(format!("version: expected {VERSION}; the file may be from a newer armctl"));
        }
        if json.get("family").is_some_and(|family| family != "yerc") {
            return Err("family: the dump is not from a yerc robot".to_owned());
        }
        let text = |name: &str| json.get(name).and_then(Json::as_str).ok_or_else(|| format!("{name}: expected a name"));
        let taken_from: Model = text("model")?.parse().map_err(|error| format!("model: {error}"))?;
        let encoding: Encoding = text("encoding")?.parse().map_err(|error| format!("encoding: {error}"))?;
        let entries = ["variables", "items"].iter().find_map(|list| json.get(*list)?.as_array());
        let entries = entries.ok_or("variables: expected a list")?;
        let reading = Reading { model, encoding };
        let mut seen = HashMap::new();
        let mut variables = Vec::with_capacity(entries.len());
        for (index, entry) in entries.iter().enumerate() {
            let (reference, value) = reading.entry(entry).map_err(|error| format!("variables[{index}]{error}"))?;
            if let Some(first) = seen.insert(reference, index) {
                return Err(format!("variables[{index}].name: {reference} is already in variables[{first}]"));
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

/// Result of a restore.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Restored {
    file: String,
    /// Number of variables written.
    written: usize,
    /// Names of the variables written, as in `B0..B99, I0..I99`.
    written_names: String,
    /// Number of variables that already had this value.
    unchanged: usize,
    unchanged_names: String,
    /// Number of variables without a value in the dump.
    left_alone: usize,
    left_alone_names: String,
    /// Number of frames sent.
    requests: usize,
}

impl Report for Restored {
    fn view(&self) -> View {
        let names = |count: usize, names: &str| if count == 0 { "-".into() } else { Cell::from(names) };
        View::fields([
            ("written", names(self.written, &self.written_names)),
            ("unchanged", names(self.unchanged, &self.unchanged_names)),
            ("skipped", names(self.left_alone, &self.left_alone_names)),
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
        assert_eq!(entry(json!({"name": "B0", "value": 2})), "variables[1].name: B0 is already in variables[0]");
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
