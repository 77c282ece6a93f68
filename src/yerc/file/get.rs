//! `yerc file get` (FS and DX 3.4.3).

use super::name;
use super::pattern::{self, FilePattern, is_pattern};
use super::transfer::{self, Download};
use crate::prelude::*;
use armctl_frame::local_names::{LocalNames, Target, make_folder, private_folder};
use armctl_frame::output::escape;
use armctl_frame::robot::file::{FileItem, Files};

/// Downloads files from the controller.
#[derive(Debug, Args)]
pub struct Get {
    /// Names, such as TESTJOB.JBI, or patterns, such as '*.JBI'. '*' means all files
    #[arg(required = true, value_name = "NAME", add = complete::FILE)]
    names: Vec<String>,
    /// Target folder, or - to write one file to stdout
    #[arg(long, value_name = "DIR", default_value = ".")]
    dir: PathBuf,
    /// Replace local files that exist
    #[arg(long)]
    force: bool,
}

impl Command for Get {
    type Family = Yerc;
    type Report = Files;
    const ID: &'static str = "yerc.file.get";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Files> {
        let Context { link, screen, robot, several, .. } = context;
        let to_stdout = self.dir == Path::new("-");
        if to_stdout {
            self.check_stdout(*screen, several)?;
        }
        // A path without a leading `./` is easier to read.
        let dir = if self.dir == Path::new(".") { Path::new("") } else { &self.dir };
        let folder = private_folder(dir, &robot.name, several);
        // All checks for which no list is needed are made before the first request.
        let parsed: Vec<String> = self.names.iter().filter(|name| !is_pattern(name)).cloned().collect();
        let typed = name::parse_names(link.encoding, &parsed)?;
        if !to_stdout {
            targets(link.encoding, &typed, &folder, self.force)?;
        }
        let looking = screen.spinner("looking for files");
        let Some(wanted) = pattern::find(link, &self.names).await? else {
            return Err(unknown());
        };
        drop(looking);
        if let ([file], true) = (&typed[..], to_stdout) {
            print(link, screen, file).await?;
            // Stdout contains the file itself, so there is no report.
            return Ok(Files::new(Vec::new(), |_| View::default()));
        }
        let mut names = LocalNames::new(link.encoding);
        let (mut work, mut results) = (Vec::with_capacity(wanted.len()), Vec::with_capacity(wanted.len()));
        for FilePattern { name, file } in wanted {
            let targets_of_files = match file.and_then(|file| Ok((names.assign(file.as_bytes())?, file))) {
                Ok((local, file)) => Ok((file, Target::new(folder.join(local), self.force)?)),
                Err(failure) => Err(failure),
            };
            let file = name.pending();
            results.push(match &targets_of_files {
                Ok((_, target)) => file.with_path(target.path()),
                Err(_) => file,
            });
            work.push(targets_of_files);
        }
        if !to_stdout && folder != Path::new("") && work.iter().any(Result::is_ok) {
            make_folder(&folder)?;
        }
        for (work, result) in work.into_iter().zip(&mut results) {
            let outcome = match work {
                Ok((file, target)) => {
                    let label = link.encoding.decode(file.as_bytes());
                    transfer::save(link, screen, &label, &target, Download::Named(&file)).await
                }
                Err(failure) => Err(failure),
            };
            if !result.finish(outcome.map(Some)) {
                break;
            }
        }
        Files::new(results, |files| FileItem::transfers(files, "saved")).single_failure()
    }
}

impl Get {
    fn check_stdout(&self, screen: Screen, several: bool) -> Result<()> {
        if self.names.len() > 1 || self.names.iter().any(|name| is_pattern(name)) || several {
            return Err(Failure::usage("--dir - writes one file of one robot").hint("use a folder for several files"));
        }
        if screen.is_json() {
            return Err(Failure::usage("--dir - writes the bytes of the file, not JSON")
                .hint("remove --json, --jq and -o, or use a folder"));
        }
        Ok(())
    }
}

/// Target path of each file. All paths are checked before the first download.
fn targets(encoding: Encoding, files: &[FileName], folder: &Path, force: bool) -> Result<Vec<Target>> {
    let mut names = LocalNames::new(encoding);
    let target = |file: &FileName| Target::new(folder.join(names.assign(file.as_bytes())?), force);
    files.iter().map(target).collect()
}

async fn print(link: &mut Link, screen: &Screen, file: &FileName) -> Result<()> {
    let mut out = Printer::new(screen, link.encoding);
    let name = link.encoding.decode(file.as_bytes());
    let result = transfer::fetch(link, file, |block| out.take(block)).await;
    // The bytes that were received are written even after a failure. The exit code reports the failure.
    out.flush()?;
    result.map(|_| ()).map_err(|failure| transfer::describe_request(&name, failure))
}

/// Writes a file to stdout. On a terminal, it writes escaped text, which cannot control the terminal.
struct Printer<'a> {
    screen: &'a Screen,
    encoding: Encoding,
    is_text: bool,
    pending: Vec<u8>,
}

/// Number of bytes that are collected before a write.
const BATCH: usize = 1 << 16;

impl<'a> Printer<'a> {
    fn new(screen: &'a Screen, encoding: Encoding) -> Self {
        Self { screen, encoding, is_text: screen.is_stdout_terminal(), pending: Vec::new() }
    }

    fn take(&mut self, block: &[u8]) -> Result<()> {
        self.pending.extend_from_slice(block);
        if self.pending.len() < BATCH {
            return Ok(());
        }
        let rest = match self.pending.iter().rposition(|byte| *byte == b'\n') {
            // A line feed is never part of a multi-byte character, so the text can be cut there.
            Some(end) if self.is_text => self.pending.split_off(end + 1),
            _ => Vec::new(),
        };
        self.flush()?;
        self.pending = rest;
        Ok(())
    }

    fn flush(&mut self) -> Result<()> {
        let bytes = std::mem::take(&mut self.pending);
        if !self.is_text {
            return self.screen.bytes(&bytes);
        }
        let text = self.encoding.decode(&bytes).replace("\r\n", "\n");
        self.screen.data(&escape::lines(&text))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_existing_files_before_any_request() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("B.JBI"), "x").unwrap();
        let files = [FileName::new(*b"A.JBI").unwrap(), FileName::new(*b"B.JBI").unwrap()];
        let failure = targets(Encoding::ShiftJis, &files, folder.path(), false).unwrap_err();
        assert_eq!(failure.kind.exit(), 1);
        assert!(failure.hint.unwrap().contains("--force"));
        let targets = targets(Encoding::ShiftJis, &files, folder.path(), true).unwrap();
        assert_eq!(targets[1].path(), folder.path().join("B.JBI"));
    }
}
