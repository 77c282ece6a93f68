//! `toyo program edit`: edits the program of a task in the editor of the user and writes it back.

use super::and_mode;
use super::get::Get;
use super::put::{Put, Stored};
use crate::item_reads::Answers;
use crate::prelude::*;
use armctl_controller::text::Encoding;
use armctl_controller::toyo::program::{Rows, Style, listing_with};
use armctl_frame::backup::text_diff::{self, Hunk, TextDifference};
use armctl_frame::editor_session::EditedText;

/// Edit the program of a task.
#[derive(Debug, Args)]
#[command(after_help = and_mode(
    "armctl reads the program, opens it in $VISUAL or $EDITOR, and checks it. After a confirmation, armctl writes the \
     changed steps and reads them back. It does not overwrite a program that another client changed. After a failure, \
     armctl keeps your text in a file, and the message shows the path."
))]
pub struct Edit {
    /// Task, 1 to 4 [default: the current task]
    #[arg(value_name = "TASK", value_parser = clap::value_parser!(u8).range(1..=4))]
    task: Option<u8>,
}

impl Command for Edit {
    type Family = Toyo;
    type Report = EditedProgram;
    const ID: &'static str = "toyo.program.edit";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite steps of a program";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<EditedProgram> {
        let Context { robot, link, screen, several, confirmer } = context;
        if several {
            return Err(Failure::usage("the editor needs one robot").hint("select the robot with -r"));
        }
        let get = Get::whole(self.task);
        if link.is_dry_run() {
            let planned = get.dry_run(link).await;
            link.plan_overwriting(&steps::read_request(1), "@WSTX ?").await?;
            link.then("you edit the text, and armctl writes the changed steps and reads them back");
            return planned.map(|_| EditedProgram { changed: false, hunks: Vec::new(), stored: None });
        }
        let outcome = get.read(link, screen).await;
        let (task, _, answers): (u8, u16, Answers) = task_selection::restore_task(link, outcome).await?;
        let read: Vec<Record> = answers.into_iter().collect::<Result<_, _>>()?;
        let style = Style { first: 1, is_whole: true, is_numbered: false };
        let text = match link.sources.get(task).filter(|source| source.is(&read)) {
            Some(source) => source.text,
            None => listing_with(&read, &BTreeMap::new(), style, &Rows::new()).text,
        };
        let mut edited = EditedText::new("program.toyo", text.as_bytes(), *screen)?;
        if !edited.is_changed()? {
            return Ok(EditedProgram { changed: false, hunks: Vec::new(), stored: None });
        }
        let difference = TextDifference::of(Encoding::Utf8, text.as_bytes(), &edited.text()?);
        let hunks = difference.map(|found| found.hunks).unwrap_or_default();
        for line in text_diff::unified("program", "edited", &hunks) {
            screen.note(&line.text);
        }
        let put = Put::edited(edited.path().to_owned(), self.task, read);
        match put.run(Context { robot, link, screen, several, confirmer }).await {
            Ok(stored) => {
                edited.mark_stored();
                Ok(EditedProgram { changed: true, hunks, stored: Some(stored) })
            }
            Err(failure) => {
                let task = self.task.map_or_else(String::new, |task| format!(" --task {task}"));
                Err(edited.keep_file(failure, |path| {
                    format!("use `toyo program put {path}{task}` to write your text, which is in {path}")
                }))
            }
        }
    }
}

/// Report of an edited program.
#[derive(Debug, Serialize, JsonSchema)]
pub struct EditedProgram {
    /// Whether the user changed the text.
    changed: bool,
    /// Changes of the text, as diff hunks.
    hunks: Vec<Hunk>,
    /// Result of the write; null if the text was not changed.
    #[serde(skip_serializing_if = "Option::is_none")]
    stored: Option<Stored>,
}

impl Report for EditedProgram {
    fn view(&self) -> View {
        match &self.stored {
            Some(stored) => stored.view(),
            None => View::text("the program was not changed; nothing was sent"),
        }
    }
}
