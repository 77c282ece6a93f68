//! `yerc job edit`: edits a job of the controller in the user's editor.

use super::content::{Content, JobRules};
use super::name::{self, ReportedName};
use super::transfer;
use super::upload::{Delivery, UploadOptions, upload};
use crate::prelude::*;
use armctl_controller::yerc::query::{Query as _, ReadJob, ReadStatus};
use armctl_frame::backup::job_date::align_files;
use armctl_frame::backup::text_diff::{self, Change as LineChange, DiffLine, Hunk, MAX_TEXT, TextDifference};
use armctl_frame::editor_session::EditedText;
use armctl_frame::local_names::local_name;

/// Edits a job of the controller.
#[derive(Debug, Args)]
#[command(
    after_help = "armctl reads the job, opens it in $VISUAL or $EDITOR, checks it (/JOB, //NAME, NOP, END) and shows \
                  the changes. After your confirmation, armctl writes the job and reads it back. It does not \
                  overwrite a running job, or a job that has changed on the controller. After a failure, armctl keeps \
                  your text in a file, and the message shows the path.\n\nIn the editor, the job is UTF-8 with line \
                  feeds. The controller gets its own encoding and CR LF. A job with bytes that are not text is edited \
                  unchanged."
)]
pub struct Edit {
    /// Job name, with or without .JBI
    #[arg(add = complete::JOB)]
    name: String,
}

const EXTENSION: &str = ".JBI";

impl Command for Edit {
    type Family = Yerc;
    type Report = EditedJob;
    const ID: &'static str = "yerc.job.edit";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite a job with the edited text";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, mut context: Context<'_, Yerc>) -> Result<EditedJob> {
        let encoding = context.link.encoding;
        if context.several {
            return Err(Failure::usage("job edit works on one job of one robot").hint("select the robot with -r"));
        }
        let is_whole = self.name.len() >= EXTENSION.len()
            && self.name.is_char_boundary(self.name.len() - EXTENSION.len())
            && self.name[self.name.len() - EXTENSION.len()..].eq_ignore_ascii_case(EXTENSION);
        let full = if is_whole { self.name.clone() } else { format!("{}{EXTENSION}", self.name) };
        let file = name::name_to_send(name::parse_name(encoding, &full)?)?;
        if context.link.is_dry_run() {
            return plan(context.link, &file);
        }
        let old = fetch(context.link, context.screen, &file).await?;
        let form = TextForm::of(encoding, &old);
        let local = local_name(encoding, file.as_bytes());
        let mut edited = EditedText::new(&local, &form.decode_text(&old), *context.screen)?;
        match self.write_back(&mut context, &file, (&old, form), &edited).await {
            Ok(report) => {
                edited.mark_stored();
                Ok(report)
            }
            Err(failure) => Err(edited.keep_file(failure, |path| {
                format!(
                    "use `yerc file put {path} --as {local} --replace --verify` to send your text, which is in {path}"
                )
            })),
        }
    }
}

impl Edit {
    async fn write_back(
        &self,
        context: &mut Context<'_, Yerc>,
        file: &FileName,
        (old, form): (&[u8], TextForm),
        edited: &EditedText,
    ) -> Result<EditedJob> {
        let (link, screen) = (&mut *context.link, context.screen);
        let shown = ReportedName::new(link.encoding, file.as_bytes());
        if !edited.is_changed()? {
            return Ok(EditedJob { name: shown, changed: false, bytes: old.len() as u64, hunks: Vec::new() });
        }
        let new = form.encode_text(&edited.text()?)?;
        // From now on, the file contains the bytes for the controller.
        edited.replace(&new)?;
        let mut delivery = Delivery { file: file.clone(), content: Content::open(edited.path())? };
        delivery.content.check_job(JobRules::default())?;
        if let Some((own, sent)) = delivery.name_in_job(link.encoding) {
            return Err(Failure::usage(format!("the job has //NAME {own}, but its name is {sent}"))
                .hint("rename a job on the pendant, or send it as a new job with `yerc file put`"));
        }
        if delivery.content.job_name.is_none() {
            return Err(Failure::usage("the line //NAME is missing").hint(
                "add the line //NAME with the name of the job; without it, the controller would refuse the job",
            ));
        }
        let difference = TextDifference::of(link.encoding, old, &new);
        let hunks = difference.map(|found| found.hunks).unwrap_or_default();
        for line in text_diff::unified(&shown.name, "edited", &hunks) {
            screen.note(&line.text);
        }
        check_idle(link, file).await?;
        let now = fetch(link, screen, file).await?;
        let ([before, after], _) = align_files(old.to_vec(), now);
        if before != after {
            return Err(Failure::new(
                Kind::Rejected,
                format!("{} has changed on the controller since armctl read it", shown.name),
            )
            .hint("edit the job again and merge both changes"));
        }
        let count = |change: LineChange| {
            let lines = hunks.iter().flat_map(|hunk| &hunk.lines);
            lines.filter(|line: &&DiffLine| line.change == change).count()
        };
        let (less, more) = (count(LineChange::Removed), count(LineChange::Added));
        let change = Change::new(format!("overwrite the job {}: -{less} +{more} lines", shown.name));
        context.confirmer.confirm(&change).await?;
        let manner = UploadOptions { verify: true, ignore_header: true, replace: true };
        let sent = upload(context.link, screen, &mut delivery, manner, &mut Vec::new()).await?;
        Ok(EditedJob { name: shown, changed: true, bytes: sent.bytes, hunks })
    }
}

/// Form of the job text in the editor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum TextForm {
    /// The bytes as they are on the controller.
    Bytes,
    /// UTF-8 text with LF line endings.
    Text(Encoding),
}

impl TextForm {
    /// Text, if its conversion is reversible; otherwise bytes.
    fn of(encoding: Encoding, bytes: &[u8]) -> Self {
        let text = Self::Text(encoding);
        if text.encode_text(&text.decode_text(bytes)).is_ok_and(|back| back == bytes) { text } else { Self::Bytes }
    }

    fn decode_text(self, bytes: &[u8]) -> Vec<u8> {
        match self {
            Self::Bytes => bytes.to_vec(),
            Self::Text(encoding) => encoding.decode(bytes).replace("\r\n", "\n").into_bytes(),
        }
    }

    fn encode_text(self, edited: &[u8]) -> Result<Vec<u8>> {
        let Self::Text(encoding) = self else { return Ok(edited.to_vec()) };
        let text = std::str::from_utf8(edited)
            .map_err(|_| Failure::usage("the edited job is not UTF-8").hint("save the job as UTF-8 in the editor"))?;
        let mut bytes = Vec::with_capacity(text.len());
        for (index, line) in text.split_inclusive('\n').enumerate() {
            let (line, ending) = line.strip_suffix('\n').map_or((line, ""), |line| (line, "\r\n"));
            let line = line.strip_suffix('\r').filter(|_| !ending.is_empty()).unwrap_or(line);
            let encoded = encoding.encode(line).map_err(|error| {
                Failure::usage(format!("line {}: {error}", index + 1))
                    .hint("set the encoding with --encoding or in the robot's entry in robots.toml")
            })?;
            bytes.extend(encoded);
            bytes.extend_from_slice(ending.as_bytes());
        }
        Ok(bytes)
    }
}

async fn fetch(link: &mut Link, screen: &Screen, file: &FileName) -> Result<Vec<u8>> {
    let name = link.encoding.decode(file.as_bytes());
    let mut progress = screen.bytes_progress(&name, None);
    let mut bytes = Vec::new();
    let fetched = transfer::fetch(link, file, |block| {
        progress.advance(block.len() as u64);
        bytes.extend_from_slice(block);
        if bytes.len() > MAX_TEXT {
            return Err(
                Failure::usage("the job is too large for this command").hint("download the job with `yerc file get`")
            );
        }
        Ok(())
    });
    fetched.await.map_err(|failure| transfer::describe_request(&name, failure))?;
    Ok(bytes)
}

/// Rejects the edit while a job runs. A running job must not be overwritten.
async fn check_idle(link: &mut Link, file: &FileName) -> Result<()> {
    if !link.ask(&ReadStatus).await?.running() {
        return Ok(());
    }
    let model = link.model().await?;
    let questions: Vec<ReadJob> = (0..=u8::MAX).map_while(|task| ReadJob::new(model, task).ok()).collect();
    let stem = file.as_bytes().len().saturating_sub(EXTENSION.len());
    let runs = link
        .ask_each(&questions)
        .await?
        .into_iter()
        .flatten()
        .any(|job| Some(job.name.as_bytes()) == file.as_bytes().get(..stem));
    if runs {
        return Err(Failure::new(Kind::Rejected, format!("{} is running", link.encoding.decode(file.as_bytes())))
            .hint("stop the job first, or hold the robot with `yerc hold on`"));
    }
    Ok(())
}

fn plan(link: &mut Link, file: &FileName) -> Result<EditedJob> {
    link.plan_download(&file.save(), Reason::about("content of the job, for the editor"))?;
    let if_changed = |about| Reason::about(about).depending_on("whether the job was changed in the editor");
    link.plan_if(&ReadStatus.request(), if_changed("whether a job runs"));
    link.plan_download(&file.save(), if_changed("whether the job has changed on the controller"))?;
    link.plan_if(&file.load(), if_changed("starts the transfer of the edited job"));
    link.then("armctl sends the job block by block, and reads the job back");
    Err(unknown())
}

/// Result of an edit.
#[derive(Debug, Serialize, JsonSchema)]
pub struct EditedJob {
    #[serde(flatten)]
    name: ReportedName,
    /// Whether the job was written and read back.
    changed: bool,
    bytes: u64,
    /// Changes in the text.
    hunks: Vec<Hunk>,
}

impl Report for EditedJob {
    fn view(&self) -> View {
        let Self { name: ReportedName { name, .. }, bytes, .. } = self;
        let text = if self.changed {
            format!("{name} written and read back, {bytes} bytes")
        } else {
            format!("{name} was not changed; nothing was sent")
        };
        View::default().append(Section::Text(text))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edited_text_encodes_to_the_original_bytes() {
        let sjis = TextForm::Text(Encoding::ShiftJis);
        for (bytes, form) in [
            (&b"/JOB\r\n'\x83\x65\x83\x58\r\nEND\r\n"[..], sjis),
            (b"/JOB\r\nEND", sjis),
            (b"/JOB\nEND\r\n", TextForm::Bytes),
            (b"/JOB\r\n'\xff\r\n", sjis),
        ] {
            let found = TextForm::of(Encoding::ShiftJis, bytes);
            assert_eq!(found.encode_text(&found.decode_text(bytes)).unwrap(), bytes);
            assert!(found == form || bytes.contains(&0xff), "{bytes:?}");
        }
        assert_eq!(sjis.encode_text("'テ\n".as_bytes()).unwrap(), b"'\x83\x65\r\n");
        assert_eq!(sjis.encode_text(b"a\r\n").unwrap(), b"a\r\n");
        assert!(sjis.encode_text("'한\n".as_bytes()).unwrap_err().message.starts_with("line 1"));
    }
}
