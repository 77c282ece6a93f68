//! `yerc file put` (FS and DX 3.4.2).

use super::content::{Content, JobRules};
use super::existence::{Existence, Lists};
use super::name::{self, ReportedName};
use super::upload::{self, Delivery, UploadOptions, upload};
use crate::prelude::*;
use armctl_frame::local_names::controller_name;
use armctl_frame::robot::file::{FileItem, Files};

/// Uploads files to the controller.
#[derive(Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "flags of a command line")]
pub struct Put {
    /// Local files
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Name on the controller [default: the local name]
    #[arg(long = "as", value_name = "NAME")]
    name: Option<String>,
    /// Send CR LF for job lines that end only in LF
    #[arg(long)]
    fix_line_endings: bool,
    /// Read each file back and compare it
    #[arg(long)]
    verify: bool,
    /// In the comparison of --verify, ignore the line ///DATE, because controllers rewrite this line
    #[arg(long, requires = "verify")]
    ignore_header: bool,
    /// If the controller does not overwrite a job, delete the old job first
    #[arg(long)]
    replace: bool,
    /// Send a job even if /JOB, NOP or END is missing
    #[arg(long)]
    force: bool,
}

/// Report of the uploads.
fn report(files: Vec<FileItem>) -> Files {
    Files::new(files, |files| FileItem::transfers(files, "sent"))
}

impl Command for Put {
    type Family = Yerc;
    type Report = Files;
    const ID: &'static str = "yerc.file.put";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite files of the same name";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Files> {
        let Context { link, screen, confirmer, .. } = context;
        let mut deliveries = self.deliveries(link.encoding)?;
        let mut results: Vec<FileItem> = Vec::with_capacity(deliveries.len());
        for delivery in &deliveries {
            let Delivery { file, content } = delivery;
            let mut result = ReportedName::new(link.encoding, file.as_bytes()).pending().with_path(content.path());
            if let Some((own, sent)) = delivery.name_in_job(link.encoding) {
                screen.note(&format!(
                    "warning: {} has //NAME {own}, but armctl sends it as {sent}: a controller may refuse the job, or \
                     store it as {own}",
                    content.path().display()
                ));
                result.more.notes.push("name_differs".to_owned());
            }
            results.push(result);
        }
        let manner = UploadOptions { verify: self.verify, ignore_header: self.ignore_header, replace: self.replace };
        let lists = Lists::ask(link, deliveries.iter().map(|delivery| &delivery.file)).await?;
        upload::confirm_uploads(&confirmer, link.encoding, lists.as_ref(), &deliveries).await?;
        let Some(lists) = lists else {
            for delivery in &mut deliveries {
                upload::plan(link, delivery, manner, Reason::default())?;
            }
            return Ok(report(results));
        };
        for (delivery, result) in deliveries.iter_mut().zip(&mut results) {
            // A file that was not in a list was not confirmed, so it is not deleted.
            let replace = manner.replace && lists.existence(&delivery.file) != Existence::No;
            let outcome =
                upload(link, screen, delivery, UploadOptions { replace, ..manner }, &mut result.more.notes).await;
            if !result.finish(outcome.map(Some)) {
                break;
            }
        }
        report(results).single_failure()
    }
}

impl Put {
    /// All files to upload. They are checked before the first upload.
    fn deliveries(&self, encoding: Encoding) -> Result<Vec<Delivery>> {
        if self.name.is_some() && self.files.len() > 1 {
            return Err(Failure::usage("--as needs exactly one file").hint("send the files one by one"));
        }
        let rules = JobRules { fix_line_endings: self.fix_line_endings, force: self.force };
        let mut deliveries: Vec<Delivery> = Vec::with_capacity(self.files.len());
        for path in &self.files {
            let file = match &self.name {
                Some(name) => name::parse_name(encoding, name)?,
                None => named_after(encoding, path)?,
            };
            let file = name::name_to_send(file)?;
            if deliveries.iter().any(|other| other.file == file) {
                return Err(Failure::usage(format!(
                    "{}: another file has the same name on the controller",
                    path.display()
                ))
                .hint("send one of the files separately with another name (--as)"));
            }
            let mut content = Content::open(path)?;
            if file.file_type() == Some(FileType::Jbi) {
                content.check_job(rules)?;
            }
            deliveries.push(Delivery { file, content });
        }
        Ok(deliveries)
    }
}

/// File name on the controller for a local file.
fn named_after(encoding: Encoding, path: &Path) -> Result<FileName> {
    let invalid = |why: String| {
        Failure::usage(format!("{}: {why}", path.display())).hint("set the name on the controller with --as")
    };
    let local = path.file_name().and_then(|name| name.to_str());
    let local = local.ok_or_else(|| invalid("the file name cannot be sent".to_owned()))?;
    let bytes = controller_name(encoding, local).map_err(|error| invalid(error.to_string()))?;
    name::exact(bytes).map_err(|failure| invalid(failure.message))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn put(files: &[&Path]) -> Put {
        Put {
            files: files.iter().map(|path| (*path).to_owned()).collect(),
            name: None,
            fix_line_endings: false,
            verify: false,
            ignore_header: false,
            replace: false,
            force: false,
        }
    }

    #[test]
    fn checks_everything_before_sending() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, bytes: &[u8]| {
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).unwrap();
            path
        };
        let good = write("A.JBI", b"/JOB\r\nNOP\r\nEND\r\n");
        let bare = write("B.JBI", b"/JOB\nNOP\nEND\n");
        let long = write(&format!("{}.JBI", "A".repeat(33)), b"/JOB\r\nNOP\r\nEND\r\n");
        let text = write("A.TXT", b"x");
        let refused = |put: &Put| put.deliveries(Encoding::ShiftJis).unwrap_err().kind.exit();
        assert_eq!(put(&[&good]).deliveries(Encoding::ShiftJis).unwrap()[0].file.as_bytes(), b"A.JBI");
        for wrong in [vec![&good, &bare], vec![&long], vec![&text], vec![&good, &good]] {
            let paths: Vec<&Path> = wrong.iter().map(|path| path.as_path()).collect();
            assert_eq!(refused(&put(&paths)), 2, "{paths:?}");
        }
        assert_eq!(refused(&put(&[&folder.path().join("C.JBI")])), 1);
        let renamed = Put { name: Some("てすと.JBI".to_owned()), ..put(&[&good]) };
        let deliveries = renamed.deliveries(Encoding::ShiftJis).unwrap();
        assert_eq!(deliveries[0].file.as_bytes(), b"\x82\xC4\x82\xB7\x82\xC6.JBI");
        assert_eq!(refused(&Put { name: Some("B.JBI".to_owned()), ..put(&[&good, &bare]) }), 2);
    }

    #[test]
    fn unescapes_local_names() {
        let file = named_after(Encoding::ShiftJis, Path::new("x/%43ON.JBI")).unwrap();
        assert_eq!(file.as_bytes(), b"CON.JBI");
    }
}
