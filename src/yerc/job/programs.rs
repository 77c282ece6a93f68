//! Jobs of a controller or of a folder, for commands that read all jobs.

use super::without_suffix;
use crate::file::{Manifest, exact, fetch_listed, job_form, list, plan_all};
use crate::prelude::*;
use armctl_controller::findings::{Finding, Rule, Severity};
use armctl_controller::yerc::files;
use armctl_controller::yerc::job::{JobText, position, scan};
use armctl_frame::backup::continues_after;
use armctl_frame::items::{ItemError, describe_request};
use armctl_frame::programs::source::{FolderFilter, ProgramFile, ProgramSet, read_folder};
use armctl_frame::programs::{Line, Position, Program};

const JOBS: FolderFilter = FolderFilter { holds: "jbi", is_program: is_job, expected: "jobs (*.JBI)" };

/// Whether a file name has the ending of a job.
fn is_job(name: &str) -> bool {
    without_suffix(name) != name
}

/// Where the jobs come from.
#[derive(Debug, Args)]
#[group(skip)]
pub struct JobSource {
    /// Read the jobs in this folder, without a robot: a backup, or any folder with files *.JBI
    #[arg(long, value_name = "FOLDER", add = ValueKind::Backup)]
    pub from: Option<PathBuf>,
}

impl JobSource {
    /// Reads the jobs in the folder of `--from`.
    ///
    /// # Errors
    /// The errors of [`jobs_in`].
    pub fn folder(&self) -> Result<(&Path, ProgramSet, Encoding)> {
        let folder = self.from.as_deref().ok_or_else(|| Failure::local("internal error: no folder to read"))?;
        let (set, encoding) = jobs_in(folder)?;
        Ok((folder, set, encoding))
    }
}

/// Reads the jobs in the folder of a backup, or in any folder with files `*.JBI`. Also returns the encoding of the
/// texts. In a folder without a manifest, this is UTF-8 if all jobs are valid UTF-8, and otherwise `Shift_JIS`.
///
/// # Errors
/// A file cannot be read, or the folder has no jobs.
pub fn jobs_in(folder: &Path) -> Result<(ProgramSet, Encoding)> {
    let (set, manifest): (ProgramSet, Option<Manifest>) = read_folder(folder, JOBS)?;
    let is_utf8 = set.files.iter().all(|file| std::str::from_utf8(&file.bytes).is_ok());
    let otherwise = if is_utf8 { Encoding::Utf8 } else { Encoding::default() };
    let encoding = manifest.and_then(|manifest| manifest.controller.encoding.parse().ok()).unwrap_or(otherwise);
    Ok((set, encoding))
}

/// Parses the jobs.
pub fn parse(set: &ProgramSet, encoding: Encoding) -> Vec<Program> {
    set.files.iter().map(|file| parse_job(file, encoding)).collect()
}

fn parse_job(file: &ProgramFile, encoding: Encoding) -> Program {
    let text = encoding.decode(&file.bytes);
    let job = JobText::new(&text);
    let mut lines = Line::all(&text);
    for (number, instruction) in &job.instructions {
        if let Some(line) = lines.get_mut(number - 1) {
            (line.references, line.speeds) = scan(instruction);
        }
    }
    let positions = job.positions.iter().map(|one| Position {
        line: one.line,
        name: position(one.key).unwrap_or_default(),
        text: one.text.to_owned(),
    });
    let name = without_suffix(&file.name).to_owned();
    let findings = form_of(file, &name, job.name);
    Program { file: file.file.clone(), positions: positions.collect(), name, lines, findings }
}

/// Why a controller would refuse the file.
fn form_of(file: &ProgramFile, name: &str, name_in_file: Option<&str>) -> Vec<Finding> {
    let form = job_form(&file.bytes);
    let finding =
        |rule, severity, line, message: String| Finding { rule, severity, line, column: 1, message, hint: None };
    let error = |message| finding(Rule::Syntax, Severity::Error, 1, message);
    let missing = form.missing.map(|missing| error(format!("this file is not a job: {missing}")));
    let other_name = name_in_file.filter(|other| *other != name);
    let other_name =
        other_name.map(|other| error(format!("the file of the job {name} has the name {other} in //NAME")));
    let bare = form.bare_line.map(|line| {
        let message = "the line ends in LF without CR; jobs need CR LF".to_owned();
        let hint = Some("`yerc file put --fix-line-endings` sends CR LF".to_owned());
        Finding { hint, ..finding(Rule::LineEndings, Severity::Warning, usize::try_from(line).unwrap_or(1), message) }
    });
    missing.into_iter().chain(other_name).chain(bare).collect()
}

/// Reads all jobs of a controller, each once and in order. A job that the controller refuses is listed as unread. In a
/// dry run, records the request and returns `None`.
///
/// # Errors
/// The list of jobs cannot be read, or the connection is lost.
pub async fn jobs_of(link: &mut Link, screen: &Screen) -> Result<ProgramSet> {
    if link.is_dry_run() {
        plan_all(link, "the jobs of the controller", [files::list(FileType::Jbi)])?;
        link.then("armctl downloads every listed job, and acknowledges each block");
        return Err(unknown());
    }
    let looking = screen.spinner("looking for jobs");
    let names = list(link, FileType::Jbi).await?;
    drop(looking);
    let mut set = ProgramSet::default();
    let mut progress = screen.parts_progress("jobs read", names.len());
    for bytes in names {
        let name = link.encoding.decode(&bytes);
        let mut content = Vec::new();
        let read = async {
            let file = exact(bytes).map_err(|failure| Failure { kind: Kind::Malformed, ..failure })?;
            fetch_listed(link, &file, |block| {
                content.extend_from_slice(block);
                Ok(())
            })
            .await
        };
        match read.await {
            Ok(_) => set.files.push(ProgramFile { file: name.clone(), name, bytes: content }),
            Err(failure) if continues_after(&failure) => set.unread.push(ItemError::new(name, failure)),
            Err(failure) => return Err(describe_request(&name, failure)),
        }
        progress.advance(1);
    }
    Ok(set)
}
