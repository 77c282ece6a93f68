//! `yerc var dump`.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use clap::Args;
use jiff::Timestamp;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::json;

use super::entry::{Entry, is_undefined};
use super::read::{once, read_all};
use super::{Choice, in_form, listed, sheet};
use crate::command::frame::local::{Draft, Target};
use crate::command::frame::sheet::{SheetManner, SheetTarget};
use crate::command::frame::text_files;
use crate::command::yerc::link::Yerc;
use crate::command::{Command, Context, Report};
use crate::controller::yerc::variables::Reference;
use crate::failure::Failure;
use crate::output::escape;
use crate::output::view::View;

/// Format name at the start of the files, to recognise them.
pub const FORMAT: &str = "armctl-variables";
/// Version of the file layout.
pub const VERSION: u64 = 1;

/// Saves variables.
#[derive(Debug, Args)]
#[command(
    after_help = "Only a complete dump is written. If the controller refuses a variable for any reason other than an \
                  undefined value, the dump fails and shows it. Undefined positions are null in the file. `var \
                  restore` writes a dump back.\n\nA name that ends in .csv creates a table for a spreadsheet. With \
                  --update, an existing table keeps its comments (columns whose names begin with comment), its order \
                  and the variables that are not read. An empty string is \"\", because an empty cell means no value."
)]
pub struct Dump {
    /// New file NAME.json or NAME.csv; - for stdout
    file: PathBuf,
    #[command(flatten)]
    choice: Choice,
    #[command(flatten)]
    manner: SheetManner,
    /// Robot whose variables are in the file, so that a second robot does not overwrite them.
    #[arg(skip)]
    taken: OnceLock<String>,
}

impl Command for Dump {
    type Family = Yerc;
    type Report = Dumped;
    const ID: &'static str = "yerc.var.dump";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Dumped, Failure> {
        let Context { robot, link, screen, .. } = context;
        let model = link.model().await?;
        let references = once(self.choice.references().map(|reference| in_form(reference, model, false)));
        let mut place = self.place(&robot.name, link.is_dry())?;
        let progress = screen.spinner("reading");
        let answers = read_all(link, &references, |wanted, known| {
            progress.say(&format!("reading {} ({known} of {})", listed(wanted.iter().copied()), references.len()));
        })
        .await?;
        drop(progress);
        let refused =
            |reference: &&Reference| matches!(answers.get(reference), Some(Err(denied)) if !is_undefined(denied));
        let missing: Vec<Reference> = references.iter().filter(refused).copied().collect();
        if let Some(Err(denied)) = missing.first().and_then(|reference| answers.get(reference)) {
            let failure = Failure::from(denied.clone());
            let message =
                format!("{}: {}; no dump was written", listed(missing), failure.message.trim_end_matches('.'));
            return Err(
                Failure { message, ..failure }.hint("name the variables without them, or their kinds with --kinds")
            );
        }
        let variables: Vec<Entry> = references
            .iter()
            .filter_map(|reference| Some(Entry::new(*reference, answers.get(reference)?, link.encoding).bare()))
            .collect();
        let (total, undefined) = (variables.len(), variables.iter().filter(|entry| !entry.has_value()).count());
        let taken_at = now();
        let file = self.file.display().to_string();
        let summary = Summary { file, variables: total, undefined, taken_at: taken_at.clone() };
        if let Place::Sheet(target) = &place {
            let (columns, rows) = sheet::rows(&variables);
            target.write(&columns, &rows, sheet::canonical)?;
            return Ok(Dumped::Summary(summary));
        }
        let document = Document {
            format: FORMAT,
            version: VERSION,
            family: "yerc",
            robot: robot.name.clone(),
            target: robot.target.value.url().to_owned(),
            simulated: robot.target.value.is_simulated(),
            model: model.name(),
            encoding: link.encoding.label(),
            taken_at,
            variables,
        };
        match &mut place {
            Place::Json(Some(draft)) => draft.write(document.text()?.as_bytes())?,
            _ => return Ok(Dumped::Document(document)),
        }
        if let Place::Json(Some(draft)) = place {
            draft.commit()?;
        }
        Ok(Dumped::Summary(summary))
    }
}

/// Output of a dump.
enum Place {
    Screen,
    /// Draft file; `None` in a dry run.
    Json(Option<Draft>),
    Sheet(SheetTarget),
}

impl Dump {
    /// Creates the draft of the output file before the controller is asked, so that an unwritable file is reported at
    /// once.
    fn place(&self, robot: &str, dry: bool) -> Result<Place, Failure> {
        let is_sheet = is_sheet(&self.file);
        if !is_sheet && self.manner.is_of_tables() {
            return Err(Failure::usage("--update and --decimal-comma need a table").hint("use a file NAME.csv"));
        }
        if self.file == Path::new("-") {
            return Ok(Place::Screen);
        }
        if self.taken.get_or_init(|| robot.to_owned()) != robot {
            return Err(text_files::of_one_robot(&self.file));
        }
        if is_sheet {
            return self.manner.target(self.file.clone(), false).map(Place::Sheet);
        }
        let target = Target::new(self.file.clone(), self.manner.force)?;
        Ok(Place::Json(if dry { None } else { Some(target.begin()?) }))
    }
}

/// Whether a file is a table, by its name.
pub fn is_sheet(file: &Path) -> bool {
    file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv"))
}

/// Time to the second; a read takes longer than that.
fn now() -> String {
    let now = Timestamp::now();
    now.round(jiff::Unit::Second).unwrap_or(now).to_string()
}

/// A dump, or its summary.
#[derive(Debug, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Dumped {
    /// Output to stdout.
    Document(Document),
    /// Output to a file.
    Summary(Summary),
}

/// Content of a dump file.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Document {
    /// `armctl-variables`.
    format: &'static str,
    version: u64,
    family: &'static str,
    robot: String,
    target: String,
    simulated: bool,
    model: &'static str,
    /// Encoding of the decoded strings.
    encoding: &'static str,
    taken_at: String,
    variables: Vec<Entry>,
}

/// Summary of a dump.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Summary {
    file: String,
    /// Number of variables.
    variables: usize,
    /// Number of undefined variables.
    undefined: usize,
    taken_at: String,
}

impl Document {
    /// Text of the file: one variable per line, so that two dumps can be compared line by line.
    fn text(&self) -> Result<String, Failure> {
        let head = json!({
            "format": self.format, "version": self.version, "family": self.family, "robot": self.robot,
            "target": self.target, "simulated": self.simulated, "model": self.model, "encoding": self.encoding,
            "taken_at": self.taken_at,
        });
        let mut text = String::from("{\n");
        for (name, value) in head.as_object().into_iter().flatten() {
            text.extend(["  ", &line(name)?, ": ", &line(value)?, ",\n"]);
        }
        text.push_str("  \"variables\": [");
        let mut separator = "\n";
        for entry in &self.variables {
            text.extend([separator, "    ", &line(entry)?]);
            separator = ",\n";
        }
        text.push_str("\n  ]\n}\n");
        Ok(text)
    }
}

fn line<T: Serialize + ?Sized>(value: &T) -> Result<String, Failure> {
    escape::json_line(value).map_err(|error| Failure::local(format!("dump as JSON: {error}")))
}

impl Report for Dumped {
    fn view(&self) -> View {
        match self {
            Self::Document(document) => View::text(document.text().unwrap_or_else(|failure| failure.message)),
            Self::Summary(summary) => View::fields([
                ("file", summary.file.as_str().into()),
                ("variables", summary.variables.into()),
                ("undefined", summary.undefined.into()),
                ("taken at", summary.taken_at.as_str().into()),
            ]),
        }
    }
}
