//! `toyo program diff`.

use super::get::Get;
use super::text;
use crate::files;
use crate::prelude::*;
use armctl_controller::text::Encoding;
use armctl_controller::toyo::program::{MAX_STEPS, check_named, used};
use armctl_frame::backup::compare::{Compared, State};
use armctl_frame::backup::manifest::Hash;
use armctl_frame::backup::text_diff::{self, TextDifference};
use armctl_frame::robot::file::{FILES, FileItem};

/// Compare a program in the controller with a text file. The exit code is 8 if they differ.
#[derive(Debug, Args)]
#[command(after_help = "The comparison ignores labels, comments, the form of numbers, and NOPs at the end. It reads \
                        all steps of the task, which takes about 35 ms per step at 9600 baud. If the task is not the \
                        current task, armctl selects the task temporarily. A read-only robot does not allow this \
                        change.")]
pub struct Diff {
    /// A program file; - means stdin
    file: PathBuf,
    /// Task, 1 to 4 [default: the current task]
    #[arg(value_name = "TASK", value_parser = clap::value_parser!(u8).range(1..=4))]
    number: Option<u8>,
    /// Task, as an option instead of an argument
    #[arg(long, value_name = "N", conflicts_with = "number", value_parser = clap::value_parser!(u8).range(1..=4))]
    task: Option<u8>,
}

impl Diff {
    fn task(&self) -> Option<u8> {
        self.number.or(self.task)
    }
}

impl Command for Diff {
    type Family = Toyo;
    type Report = Difference;
    const ID: &'static str = "toyo.program.diff";

    fn risk(&self) -> Risk {
        if self.task().is_some() { Risk::Write } else { Risk::Read }
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Difference> {
        let Context { robot, link, screen, .. } = context;
        let name = files::display_path(&self.file);
        let bytes = files::read(&self.file)?;
        let checked = check_named(&bytes, MAX_STEPS, None, names::of_robot(robot, screen));
        let program = text::program(&name, checked, &screen.silenced())?;
        let get = Get::whole(self.task());
        if link.is_dry_run() {
            get.dry_run(link).await?;
        }
        let outcome = get.read(link, screen).await;
        let (task, _, answers) = task_selection::restore_task(link, outcome).await?;
        let found: Vec<Record> = answers.into_iter().collect::<Result<_, _>>()?;
        let wanted: Vec<Record> = program.steps.into_iter().map(|step| step.record).collect();
        let difference = Difference::new(task, &found[..used(&found)], &wanted[..used(&wanted)]);
        let path = Some(self.file.display().to_string()).filter(|path| path != "-");
        let [file] = difference.files;
        Ok(Difference { files: [FileItem { path, ..file }.with_content(Hash::of(&bytes))], ..difference })
    }
}

/// Differences between a program in the controller and a file.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Difference {
    task: u8,
    /// Whether the steps are equal.
    equal: bool,
    /// Comparison with the file.
    files: [FileItem<Steps>; 1],
}

/// Comparison of the steps in the controller with the steps of a file.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct Steps {
    /// Changes from the controller (old) to the file (new). Each line is one step.
    #[serde(flatten)]
    compared: Compared,
    /// Number of steps in the controller, up to the last step that is not a NOP.
    controller_steps: usize,
    /// Number of steps in the file, up to the last step that is not a NOP.
    file_steps: usize,
}

impl Difference {
    fn new(task: u8, found: &[Record], wanted: &[Record]) -> Self {
        let lines = |steps: &[Record]| steps.iter().map(|step| format!("{}\n", step.written())).collect::<String>();
        let equal = found.len() == wanted.len() && found.iter().zip(wanted).all(|(one, other)| one == other);
        let difference = TextDifference::of(Encoding::Utf8, lines(found).as_bytes(), lines(wanted).as_bytes());
        let compared = if equal { Compared::new(State::Same) } else { Compared::texts(difference) };
        let steps = Steps { compared, controller_steps: found.len(), file_steps: wanted.len() };
        Self { task, equal, files: [FileItem::new(format!("program-{task}"), steps, Ok(()))] }
    }

    /// Name of the file.
    fn file(&self) -> &str {
        self.files[0].path.as_deref().unwrap_or("stdin")
    }

    fn summary(&self) -> String {
        let (Self { task, equal, .. }, file) = (self, self.file());
        let Steps { controller_steps, file_steps, .. } = &self.files[0].more;
        if *equal {
            format!("the program of task {task} and {file} are equal, {file_steps} steps")
        } else {
            format!("the program of task {task} ({controller_steps} steps) and {file} ({file_steps} steps) differ")
        }
    }
}

impl Report for Difference {
    fn view(&self) -> View {
        let Some(hunks) = self.files[0].more.compared.changes() else { return View::text(self.summary()) };
        let old = format!("task {} (controller)", self.task);
        View::default()
            .append(Section::Lines(text_diff::unified(&old, self.file(), hunks)))
            .append(Section::Text(self.summary()))
    }

    fn failure(&self) -> Option<Failure> {
        (!self.equal).then(|| Failure::difference(self.summary()))
    }

    fn rows(&self) -> RowsOf {
        FILES
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::{Bench, Fault, blocks};
    use armctl_frame::failure::Kind;

    #[test]
    fn steps_are_compared_and_not_their_form() {
        let state = "steps = { 1 = [\"SPD V=05\", \"TAG TAG=001\", \"JMP TAG=001\", \"END\"] }";
        let (mut bench, _) = Bench::with_faults(state, |_, _| Fault::None);
        let file = tempfile::NamedTempFile::new().unwrap();
        let path = file.path().to_str().unwrap();
        std::fs::write(path, "# the same\nspd v=5\nnext: JMP TAG=next\nEND\nNOP\n").unwrap();
        let (same, failure) = bench.run(&["program", "diff", path]).unwrap();
        assert!(failure.is_none() && same["equal"] == true && same["files"][0]["file_steps"] == 4, "{same}");
        std::fs::write(path, "SPD V=6\nnext: JMP TAG=next\nEND\n").unwrap();
        let (other, failure) = bench.run(&["program", "diff", path, "1"]).unwrap();
        assert_eq!(failure.map(|failure| (failure.kind, failure.kind.exit())), Some((Kind::ConditionNotMet, 8)));
        assert_eq!(
            other["files"][0]["hunks"][0]["lines"][0],
            serde_json::json!({ "change": "removed", "text": "SPD V=05", "ending": "lf" })
        );
        assert_eq!(blocks(&["program", "diff", path]).unwrap(), ["@MTSK", "@RPAR E22", "@RSTX 0001"]);
        std::fs::write(path, "EMD\n").unwrap();
        assert_eq!(bench.run(&["program", "diff", path]).unwrap_err().kind, Kind::Usage);
    }
}
