//! Upload of a local file with its options: verification, and replacement of an existing job. During a replacement,
//! there is always at least one copy of the job.

use std::fs;

use super::compare::{Comparer, Comparison};
use super::content::Content;
use super::existence::{Existence, Lists};
use super::transfer::{self, Download};
use crate::prelude::*;
use armctl_frame::backup::manifest::Hash;
use armctl_frame::local_names::{Target, folder_of, local_name};

/// A file to upload.
#[derive(Debug)]
pub struct Delivery {
    /// Name on the controller.
    pub file: FileName,
    /// Content to send.
    pub content: Content,
}

/// Upload options.
#[derive(Debug, Clone, Copy, Default)]
pub struct UploadOptions {
    /// Whether to read the file back and compare it.
    pub verify: bool,
    /// Whether the comparison ignores the line that controllers rewrite.
    pub ignore_header: bool,
    /// Whether to delete an existing job that the controller refuses to overwrite.
    pub replace: bool,
}

/// Asks for confirmation if files will be overwritten: files that are in a list, and files of a type without a list.
pub async fn confirm_uploads<'a>(
    confirmer: &Confirmer<'_>,
    encoding: Encoding,
    lists: Option<&Lists>,
    deliveries: impl IntoIterator<Item = &'a Delivery>,
) -> Result<()> {
    let mut replaced = Vec::new();
    let mut has_machine_data = false;
    for Delivery { file, content } in deliveries {
        let unlisted_count = match lists.map_or(Existence::No, |lists| lists.existence(file)) {
            Existence::Yes => "",
            Existence::Unlisted => " (armctl could not check whether the file exists)",
            Existence::No => continue,
        };
        let (name, path) = (encoding.decode(file.as_bytes()), content.path().display());
        has_machine_data |= matches!(file.file_type(), Some(FileType::Prm | FileType::Sys));
        replaced.push(format!("{name}, with the {} bytes of {path}{unlisted_count}", content.size()));
    }
    if replaced.is_empty() {
        return confirmer.confirm(&Change::none()).await;
    }
    let plural = if replaced.len() == 1 { "" } else { "s" };
    let change = Change::new(format!("overwrite {} file{plural} on the controller", replaced.len()));
    let change = replaced.into_iter().fold(change, Change::item);
    let change =
        if has_machine_data { change.note("Parameters and system data change the controller itself.") } else { change };
    confirmer.confirm(&change).await
}

/// In a dry run, records the requests of [`upload`].
pub fn plan(link: &mut Link, delivery: &mut Delivery, manner: UploadOptions, reason: Reason<'_>) -> Result<()> {
    let Delivery { file, content } = delivery;
    transfer::plan_send(link, file, content, reason)?;
    if manner.replace && file.file_type() == Some(FileType::Jbi) {
        let if_refused = |about| Reason::about(about).depending_on("whether the controller overwrites the job");
        link.plan_download(
            &file.save(),
            if_refused("if the controller does not overwrite the job: copy of the old job"),
        )?;
        link.plan_if(&file.delete(), if_refused("if the controller does not overwrite the job: deletes the old job"));
        transfer::plan_send(
            link,
            file,
            content,
            if_refused("if the controller does not overwrite the job: sends the new job"),
        )?;
    }
    if manner.verify {
        link.plan_download(&file.save(), Reason { about: Some("content of the file after the write"), ..reason })?;
    }
    Ok(())
}

/// Uploads a file, and adds the completed steps to `notes`. Returns the content that was sent.
pub async fn upload(
    link: &mut Link,
    screen: &Screen,
    delivery: &mut Delivery,
    manner: UploadOptions,
    notes: &mut Vec<String>,
) -> Result<Hash> {
    let sent = match send(link, screen, delivery).await {
        Err(failure) if transfer::is_job_exists(&failure) => {
            if !manner.replace {
                return Err(failure.hint(
                    "add --replace to delete the old job and send the new job; if the transfer fails, armctl restores \
                     the old job. `yerc file diff` shows the differences",
                ));
            }
            let sent = replace(link, screen, delivery).await?;
            notes.push("replaced".to_owned());
            sent
        }
        Err(failure) if failure.kind == Kind::Refused => return Err(check_job_name(link, delivery, failure)),
        sent => sent?,
    };
    if delivery.content.fixes_line_endings() {
        notes.push("line_endings_fixed".to_owned());
    }
    if manner.verify {
        verify(link, screen, delivery, manner.ignore_header).await?;
        notes.push("verified".to_owned());
    }
    Ok(sent)
}

impl Delivery {
    /// Name in the job, and name of the upload; `None` if they are equal.
    pub fn name_in_job(&self, encoding: Encoding) -> Option<(String, String)> {
        let file = self.file.as_bytes();
        let stem = file.get(..file.len().saturating_sub(4)).unwrap_or(file);
        let own = self.content.job_name.as_deref().filter(|own| *own != stem)?;
        Some((encoding.decode(own), encoding.decode(stem)))
    }
}

/// Adds a hint to the failure if the name in the job differs from its file name. This is a likely cause of a refusal.
fn check_job_name(link: &Link, delivery: &Delivery, failure: Failure) -> Failure {
    match delivery.name_in_job(link.encoding) {
        Some((own, stem)) => {
            failure.hint(format!("use the same name: the job has //NAME {own}, but armctl sends it as {stem}"))
        }
        None => failure,
    }
}

async fn send(link: &mut Link, screen: &Screen, delivery: &mut Delivery) -> Result<Hash> {
    let name = link.encoding.decode(delivery.file.as_bytes());
    let mut progress = screen.bytes_progress(&name, Some(delivery.content.size()));
    transfer::send(link, &delivery.file, &mut delivery.content, &mut progress).await
}

/// Reads the file back and compares all bytes.
async fn verify(link: &mut Link, screen: &Screen, delivery: &mut Delivery, ignore_header: bool) -> Result<()> {
    let name = link.encoding.decode(delivery.file.as_bytes());
    let mut progress = screen.bytes_progress(&format!("{name} (reading back)"), Some(delivery.content.size()));
    let path = delivery.content.path().display().to_string();
    let mut comparer = Comparer::new(delivery.content.pieces()?, ignore_header);
    transfer::fetch(link, &delivery.file, |block| {
        progress.advance(block.len() as u64);
        comparer.take(block)
    })
    .await
    .map_err(|failure| Failure {
        message: format!("the file was sent, but could not be read back: {}", failure.message),
        ..failure
    })?;
    match comparer.finish()?.0 {
        Comparison { first_difference: None, .. } => Ok(()),
        Comparison { controller_bytes, local_bytes, first_difference: Some(at), .. } => Err(Failure::new(
            Kind::Malformed,
            format!(
                "the controller returned other bytes than armctl sent: {controller_bytes} bytes instead of \
                 {local_bytes}, first difference at byte {at}"
            ),
        )
        .hint(format!(
            "use `yerc file diff {name} {path} --exact` to see the differences; add --ignore-header to ignore the \
             line ///DATE, which a controller may rewrite"
        ))),
    }
}

/// Replaces an existing job. A local copy of the existing job is kept from before its deletion until the new job is on
/// the controller.
async fn replace(link: &mut Link, screen: &Screen, delivery: &mut Delivery) -> Result<Hash> {
    let mut old = OldCopy::fetch(link, screen, delivery).await?;
    old.is_needed = true;
    if let Err(failure) = transfer::remove(link, &delivery.file).await {
        old.is_needed = failure.kind == Kind::OutcomeUnknown;
        return Err(old.failure_with_path(failure));
    }
    let failure = match send(link, screen, delivery).await {
        Ok(sent) => {
            old.is_needed = false;
            return Ok(sent);
        }
        Err(failure) => failure,
    };
    if failure.kind != Kind::Refused {
        return Err(old.failure_with_path(failure));
    }
    let mut restored = Delivery { file: delivery.file.clone(), content: Content::open(&old.path)? };
    match send(link, screen, &mut restored).await {
        Ok(_) => {
            old.is_needed = false;
            Err(Failure { message: format!("{} The old job was restored", failure.message), ..failure })
        }
        Err(second) => {
            let message = format!("{} The old job could not be restored: {}", failure.message, second.message);
            Err(old.failure_with_path(Failure { message, ..failure }))
        }
    }
}

/// Local copy of a job that will be deleted. The copy is removed at the end, unless it is the only copy of the job.
#[derive(Debug)]
struct OldCopy {
    path: PathBuf,
    screen: Screen,
    is_needed: bool,
    is_path_reported: bool,
}

impl OldCopy {
    async fn fetch(link: &mut Link, screen: &Screen, delivery: &Delivery) -> Result<Self> {
        let name = link.encoding.decode(delivery.file.as_bytes());
        let label = format!("{name} (copy of the old job)");
        let local = local_name(link.encoding, delivery.file.as_bytes());
        let target = Self::local_folder(&folder_of(delivery.content.path()), &local)?;
        let path = target.path().to_owned();
        transfer::save(link, screen, &label, &target, Download::Named(&delivery.file)).await?;
        Ok(Self { path, screen: *screen, is_needed: false, is_path_reported: false })
    }

    /// First free name for the copy: `A.JBI.replaced`, `A.JBI.replaced-2`.
    fn local_folder(folder: &Path, local: &str) -> Result<Target> {
        let free = |path: &PathBuf| path.symlink_metadata().is_err();
        let numbered = (2..1000).map(|number| folder.join(format!("{local}.replaced-{number}")));
        let path = std::iter::once(folder.join(format!("{local}.replaced"))).chain(numbered).find(free);
        let path = path.ok_or_else(|| {
            Failure::local(format!("{}: too many copies of replaced jobs", folder.display()))
                .hint("delete or move these copies")
        })?;
        Target::new(path, false)
    }

    /// Adds the path of the copy to a failure.
    fn failure_with_path(&mut self, failure: Failure) -> Failure {
        if !self.is_needed {
            return failure;
        }
        self.is_path_reported = true;
        Failure { message: format!("{}. The old job is saved in {}", failure.message, self.path.display()), ..failure }
    }
}

impl Drop for OldCopy {
    fn drop(&mut self) {
        if self.is_needed {
            if !self.is_path_reported {
                self.screen.note(&format!("the old job is saved in {}", self.path.display()));
            }
        } else if let Err(error) = fs::remove_file(&self.path) {
            self.screen.note(&format!("{} could not be deleted: {error}", self.path.display()));
        }
    }
}
