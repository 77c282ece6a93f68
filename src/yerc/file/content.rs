//! Content of a local file for an upload. The file is read in pieces. A job is checked, and its line endings can be
//! converted.

use std::fs::File;
use std::io::{ErrorKind, Read as _, Seek as _};

use crate::prelude::basics::*;
use armctl_frame::backup::manifest::Hash;

/// Size of a piece. It contains a few blocks.
const READ_SIZE: usize = 1 << 13;

/// A local file to send.
#[derive(Debug)]
pub struct Content {
    file: File,
    path: PathBuf,
    /// Number of bytes to send.
    len: u64,
    fixes: bool,
    /// Name in the line `//NAME` of a job that was checked.
    pub job_name: Option<Vec<u8>>,
}

/// What [`Content::check_job`] does with an invalid job.
#[derive(Debug, Clone, Copy, Default)]
pub struct JobRules {
    /// Sends CR LF for a line that ends in a bare LF.
    pub fix_line_endings: bool,
    /// Sends a file even if it does not look like a job.
    pub force: bool,
}

impl Content {
    /// Opens a file to send. The file must not be empty.
    pub fn open(path: &Path) -> Result<Self> {
        let content = Self::open_file(path)?;
        if content.len == 0 {
            return Err(Failure::usage(format!("{} is empty", path.display()))
                .hint("check the file: the protocol cannot transfer an empty file"));
        }
        Ok(content)
    }

    /// Opens a file for reading.
    pub fn open_file(path: &Path) -> Result<Self> {
        let place = || path.display().to_string();
        let file = match files::open(path) {
            Err(error) if matches!(error.kind(), ErrorKind::IsADirectory | ErrorKind::Unsupported) => {
                return Err(
                    Failure::usage(format!("{} is not a file", path.display())).hint("list the files individually")
                );
            }
            opened => opened.with_context(place)?,
        };
        let len = file.metadata().with_context(place)?.len();
        Ok(Self { file, path: path.to_owned(), len, fixes: false, job_name: None })
    }

    /// Path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Number of bytes to send.
    pub fn size(&self) -> u64 {
        self.len
    }

    /// Whether line endings are converted.
    pub fn fixes_line_endings(&self) -> bool {
        self.fixes
    }

    /// Checks a job before it is sent.
    pub fn check_job(&mut self, rules: JobRules) -> Result<()> {
        let mut scan = JobScan::default();
        let mut pieces = self.pieces()?;
        loop {
            let piece = pieces.next_piece()?;
            if piece.is_empty() {
                break;
            }
            scan.take(&piece);
        }
        scan.finish();
        let path = self.path.display();
        if let Some(line) = scan.first_bare.filter(|_| !rules.fix_line_endings) {
            let message =
                format!("{path}: line {line} ends in LF without CR ({} lines in total); jobs need CR LF", scan.bare);
            return Err(
                Failure::usage(message).hint(format!("add --fix-line-endings to send CR LF; {path} stays unchanged"))
            );
        }
        if let Some(missing) = scan.missing().filter(|_| !rules.force) {
            return Err(Failure::usage(format!("{path} is not in the form of a job: {missing}"))
                .hint("add --force to send the file anyway; the controller would refuse the file or raise an alarm"));
        }
        self.job_name = scan.name;
        self.fixes = scan.bare > 0;
        self.len = self.len.saturating_add(scan.bare);
        Ok(())
    }

    /// Reader for the pieces of the file, from its beginning.
    pub fn pieces(&mut self) -> Result<ContentReader<'_>> {
        self.file.rewind().with_context(|| self.path.display().to_string())?;
        let fixer = self.fixes.then(Fixer::default);
        Ok(ContentReader { file: &self.file, path: &self.path, fixer, hash: Hash::default() })
    }
}

/// Reader that returns a [`Content`] in pieces.
#[derive(Debug)]
pub struct ContentReader<'a> {
    file: &'a File,
    path: &'a Path,
    fixer: Option<Fixer>,
    /// Hash of the pieces that were read so far.
    pub hash: Hash,
}

impl ContentReader<'_> {
    /// Returns the next piece, which is empty at the end.
    pub fn next_piece(&mut self) -> Result<Vec<u8>> {
        let mut piece = Vec::with_capacity(READ_SIZE);
        let read = self.file.take(READ_SIZE as u64).read_to_end(&mut piece);
        read.with_context(|| self.path.display().to_string())?;
        if let Some(fixer) = &mut self.fixer {
            piece = fixer.fix_line_endings_of(&piece);
        }
        self.hash.take(&piece);
        Ok(piece)
    }
}

/// Inserts a CR before each LF that has none.
#[derive(Debug, Default)]
struct Fixer {
    previous: u8,
}

impl Fixer {
    fn fix_line_endings_of(&mut self, piece: &[u8]) -> Vec<u8> {
        let mut fixed = Vec::with_capacity(piece.len() + piece.len() / 16);
        for &byte in piece {
            if byte == b'\n' && self.previous != b'\r' {
                fixed.push(b'\r');
            }
            fixed.push(byte);
            self.previous = byte;
        }
        fixed
    }
}

/// Form of a job file.
#[derive(Debug, Clone, Copy)]
pub struct JobForm {
    /// What the file lacks to be a job.
    pub missing: Option<&'static str>,
    /// First line that ends in LF without CR.
    pub bare_line: Option<u64>,
}

/// Returns the form of a job file.
pub fn job_form(bytes: &[u8]) -> JobForm {
    let mut scan = JobScan::default();
    scan.take(bytes);
    scan.finish();
    JobForm { missing: scan.missing(), bare_line: scan.first_bare }
}

/// Maximum number of bytes of a line that the scan keeps. The longest relevant line contains a job name.
const HEAD: usize = 48;

/// Scan for the requirements of a job file (JBI): `/JOB` in the first line, lines `NOP` and `END`, CR LF line endings.
/// In all encodings of a pendant, CR and LF are never part of a multi-byte character.
#[derive(Debug, Default)]
struct JobScan {
    head: Vec<u8>,
    line_len: usize,
    line: u64,
    previous: u8,
    bare: u64,
    first_bare: Option<u64>,
    has_header: bool,
    has_nop: bool,
    has_end: bool,
    name: Option<Vec<u8>>,
}

impl JobScan {
    fn take(&mut self, piece: &[u8]) {
        for &byte in piece {
            if byte == b'\n' {
                if self.previous != b'\r' {
                    self.bare = self.bare.saturating_add(1);
                    self.first_bare = self.first_bare.or(Some(self.line + 1));
                }
                self.end_line();
            } else {
                self.line_len = self.line_len.saturating_add(1);
                if self.head.len() < HEAD {
                    self.head.push(byte);
                }
            }
            self.previous = byte;
        }
    }

    fn finish(&mut self) {
        if self.line_len > 0 {
            self.end_line();
        }
    }

    fn end_line(&mut self) {
        if self.line_len <= HEAD {
            let word = self.head.trim_ascii();
            self.has_header |= self.line == 0 && word == b"/JOB";
            self.has_nop |= word == b"NOP";
            self.has_end |= word == b"END";
            if let (None, Some(name)) = (&self.name, word.strip_prefix(b"//NAME ")) {
                self.name = Some(name.trim_ascii().to_vec());
            }
        }
        self.line = self.line.saturating_add(1);
        self.line_len = 0;
        self.head.clear();
    }

    fn missing(&self) -> Option<&'static str> {
        match (self.has_header, self.has_nop, self.has_end) {
            (false, ..) => Some("the first line is not /JOB"),
            (_, false, _) => Some("the line NOP is missing"),
            (.., false) => Some("the line END is missing"),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use proptest::prelude::*;

    use super::*;

    fn content(bytes: &[u8]) -> (tempfile::NamedTempFile, Content) {
        let mut file = tempfile::NamedTempFile::new().unwrap();
        file.write_all(bytes).unwrap();
        let content = Content::open(file.path()).unwrap();
        (file, content)
    }

    fn read(content: &mut Content) -> Vec<u8> {
        let mut pieces = content.pieces().unwrap();
        std::iter::from_fn(|| Some(pieces.next_piece().unwrap()).filter(|piece| !piece.is_empty())).flatten().collect()
    }

    fn check(bytes: &[u8], rules: JobRules) -> Result<Vec<u8>> {
        let (_file, mut content) = content(bytes);
        content.check_job(rules)?;
        let sent = read(&mut content);
        assert_eq!(sent.len() as u64, content.size());
        Ok(sent)
    }

    const JOB: &[u8] = b"/JOB\r\n//NAME A\r\nNOP\r\n'\x83\x5c\0\r\n   END\r\n";
    const FIX: JobRules = JobRules { fix_line_endings: true, force: false };

    #[test]
    fn sends_a_job_unchanged() {
        assert_eq!(check(JOB, JobRules::default()).unwrap(), JOB);
        assert_eq!(check(JOB, FIX).unwrap(), JOB);
        assert_eq!(check(b"/JOB\r\nNOP\r\nEND", JobRules::default()).unwrap(), b"/JOB\r\nNOP\r\nEND");
    }

    #[test]
    fn reads_the_name_of_a_job() {
        let (_file, mut content) = content(b"/JOB\r\n//NAME A B\r\nNOP\r\nEND\r\n//NAME C\r\n");
        content.check_job(JobRules::default()).unwrap();
        assert_eq!(content.job_name.as_deref(), Some(&b"A B"[..]));
    }

    #[test]
    fn refuses_or_fixes_a_bare_line_feed() {
        let job = b"/JOB\r\nNOP\n\r\nEND\n";
        let failure = check(job, JobRules { force: true, ..JobRules::default() }).unwrap_err();
        assert_eq!(failure.kind.exit(), 2);
        assert!(
            failure.message.ends_with("line 2 ends in LF without CR (2 lines in total); jobs need CR LF"),
            "{failure}"
        );
        assert!(failure.hint.unwrap().starts_with("add --fix-line-endings"));
        assert_eq!(check(job, FIX).unwrap(), b"/JOB\r\nNOP\r\n\r\nEND\r\n");
    }

    #[test]
    fn names_the_missing_part_of_a_job() {
        for (bytes, missing) in [
            (&b"NOP\r\nEND\r\n"[..], "/JOB"),
            (b"\xef\xbb\xbf/JOB\r\nNOP\r\nEND\r\n", "/JOB"),
            (b"/JOB\r\nEND\r\n", "NOP"),
            (b"/JOB\r\nNOPE\r\nNOP\r\nENDE\r\n", "END"),
            (b"/JOB\rNOP\rEND\r", "/JOB"),
        ] {
            let failure = check(bytes, JobRules::default()).unwrap_err();
            assert!(failure.message.contains(missing), "{failure}");
            assert_eq!(check(bytes, JobRules { force: true, ..JobRules::default() }).unwrap(), bytes);
        }
    }

    #[test]
    fn rejects_empty_and_missing_files() {
        let file = tempfile::NamedTempFile::new().unwrap();
        assert_eq!(Content::open(file.path()).unwrap_err().kind.exit(), 2);
        assert_eq!(Content::open(Path::new(".")).unwrap_err().kind.exit(), 2);
        assert_eq!(Content::open(Path::new("/nowhere/a.jbi")).unwrap_err().kind.exit(), 1);
    }

    proptest! {
        #[test]
        fn fix_adds_only_missing_bytes(bytes in prop::collection::vec(
            prop::sample::select(b"\r\n\nA\0\x83".to_vec()), 0..60), cut in 0usize..60)
        {
            let (head, tail) = bytes.split_at(cut.min(bytes.len()));
            let mut fixer = Fixer::default();
            let fixed = [fixer.fix_line_endings_of(head), fixer.fix_line_endings_of(tail)].concat();
            let mut scan = JobScan::default();
            scan.take(&fixed);
            prop_assert_eq!(scan.bare, 0);
            prop_assert_eq!(&Fixer::default().fix_line_endings_of(&fixed), &fixed);
            let mut scan = JobScan::default();
            scan.take(&bytes);
            prop_assert_eq!(fixed.len() as u64, bytes.len() as u64 + scan.bare);
            // Without the CR before each LF, both texts must be equal.
            let plain = |text: &[u8]| text.iter().enumerate()
                .filter(|(at, byte)| !(**byte == b'\r' && text.get(at + 1) == Some(&b'\n')))
                .map(|(_, byte)| *byte).collect::<Vec<_>>();
            prop_assert_eq!(plain(&fixed), plain(&bytes));
        }
    }
}
