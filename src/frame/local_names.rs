//! Local files: safe names for the files of a controller, and atomic writes.

use std::borrow::Cow;
use std::collections::HashMap;
use std::fmt::Write as _;
use std::io::{BufWriter, ErrorKind, Write};
use std::path::Component;

use tempfile::NamedTempFile;

use crate::output::escape;
use crate::prelude::basics::*;
pub use crate::settings::state_folder;
use armctl_controller::text::{EncodeError, Encoding, unhex};
pub use armctl_files::folder_of;

/// Maximum length of a name in common file systems.
const MAX_LOCAL_NAME: usize = 255;
/// Buffer size: the data of a few hundred blocks.
const MAX_BUFFER: usize = 1 << 17;
/// Device names that Windows reserves, with any extension.
const DEVICES: [&str; 6] = ["CON", "PRN", "AUX", "NUL", "CONIN$", "CONOUT$"];
/// Device names that Windows reserves if a digit follows.
const NUMBERED_DEVICES: [&str; 2] = ["COM", "LPT"];

/// Local name for a file of a controller. It is the decoded name, but each byte of a character that some file system,
/// shell or terminal could misinterpret is written as `%XX`. [`controller_name`] is the inverse function.
pub fn local_name(encoding: Encoding, name: &[u8]) -> String {
    let mut pieces = pieces(encoding, name);
    let last = pieces.len().saturating_sub(1);
    for (index, piece) in pieces.iter_mut().enumerate() {
        let odd_start = index == 0 && matches!(piece.plain, Some('.' | ' ' | '-'));
        let odd_end = index == last && matches!(piece.plain, Some('.' | ' '));
        if odd_start || odd_end {
            piece.plain = None;
        }
    }
    if is_device(&escape_piece(&pieces))
        && let Some(first) = pieces.first_mut()
    {
        first.plain = None;
    }
    escape_piece(&pieces)
}

/// Local name without capital letters, so that it differs from other names in more than upper and lower case.
fn caseless_name(encoding: Encoding, name: &[u8]) -> String {
    let mut pieces = pieces(encoding, name);
    for piece in &mut pieces {
        piece.plain = piece.plain.filter(|c| c.is_ascii_digit() || *c == '_');
    }
    escape_piece(&pieces)
}

/// Name on the controller for a local file. The escapes of [`local_name`] are decoded; any other name is unchanged.
pub fn controller_name(encoding: Encoding, local: &str) -> Result<Vec<u8>, EncodeError> {
    if let Some(name) = unescaped(encoding, local)
        && (local_name(encoding, &name) == local || caseless_name(encoding, &name) == local)
    {
        return Ok(name);
    }
    encoding.encode(local)
}

/// Whether a local name in a manifest is a plain file name, in the same folder as the manifest.
pub fn is_plain_file_name(local: &str) -> bool {
    let mut parts = Path::new(local).components();
    let dots = matches!((parts.next(), parts.next()), (Some(Component::Normal(part)), None) if part == local);
    dots && local.chars().all(is_plain_or_escape) && !is_device(local)
}

/// Assigns local names to the files of a controller. The names are unique even on file systems that ignore case.
#[derive(Debug)]
pub struct LocalNames {
    encoding: Encoding,
    taken: HashMap<String, Vec<u8>>,
}

impl LocalNames {
    /// Creates the assignment without any names.
    pub fn new(encoding: Encoding) -> Self {
        Self { encoding, taken: HashMap::new() }
    }

    /// Local name for `name`. Each call with the same name returns the same local name.
    pub fn assign(&mut self, name: &[u8]) -> Result<String> {
        for local in [local_name(self.encoding, name), caseless_name(self.encoding, name)] {
            if local.is_empty() || local.len() > MAX_LOCAL_NAME {
                return Err(Failure::local(format!("the name '{}' cannot be a local file name", name.escape_ascii()))
                    .hint("use `yerc file get NAME --dir -` to write the file to stdout"));
            }
            let owner = self.taken.entry(local.to_lowercase()).or_insert_with(|| name.to_vec());
            if owner == name {
                return Ok(local);
            }
        }
        Err(Failure::local(format!("the name '{}' conflicts with another name on this computer", name.escape_ascii())))
    }
}

/// Path of a file that will be written. The path is checked before anything is sent.
#[derive(Debug, Clone)]
pub struct Target {
    path: PathBuf,
    replace: bool,
}

impl Target {
    /// Creates a target. The file must not exist, unless `replace` is set.
    pub fn new(path: PathBuf, replace: bool) -> Result<Self> {
        match path.symlink_metadata() {
            Ok(found) if !found.is_file() && !found.is_symlink() => {
                return Err(Failure::local(format!("{} exists and is not a file", path.display()))
                    .hint("use another path for the file"));
            }
            Ok(_) if !replace => return Err(exists(&path)),
            Ok(_) => {}
            Err(error) if error.kind() == ErrorKind::NotFound => {}
            Err(error) => return Err(Failure::io(path.display(), &error)),
        }
        Ok(Self { path, replace })
    }

    /// The path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Starts to write the file. Until [`Draft::commit`], the target path does not change.
    pub fn begin(&self) -> Result<Draft> {
        let folder = folder_of(&self.path);
        let file = files::draft_in(&folder).with_context(|| folder.display().to_string())?;
        Ok(Draft { file: BufWriter::with_capacity(MAX_BUFFER, file), target: self.clone() })
    }
}

/// A file that is written next to its target path. If the draft is dropped, the file is removed.
#[derive(Debug)]
pub struct Draft {
    file: BufWriter<NamedTempFile>,
    target: Target,
}

impl Draft {
    /// Appends bytes.
    pub fn write(&mut self, bytes: &[u8]) -> Result<()> {
        Ok(self.file.write_all(bytes).with_context(|| self.target.path.display().to_string())?)
    }

    /// Syncs the complete file to disk and moves it to its target path.
    pub fn commit(self) -> Result<()> {
        let Target { path, replace } = self.target;
        let place = || path.display().to_string();
        let file = self.file.into_inner().map_err(std::io::IntoInnerError::into_error).with_context(place)?;
        // Some file systems report a full disk only when the file is synced.
        file.as_file().sync_data().with_context(place)?;
        let kept = if replace { file.persist(&path) } else { file.persist_noclobber(&path) };
        match kept {
            Err(error) if !replace && error.error.kind() == ErrorKind::AlreadyExists => Err(exists(&path)),
            kept => Ok(kept.map(drop).map_err(std::io::Error::from).with_context(place)?),
        }
    }
}

/// Path for robot `name` in the folder that the user gave. With several robots, it is a subfolder.
pub fn private_folder(folder: &Path, name: &str, several: bool) -> PathBuf {
    if several { folder.join(local_name(Encoding::Utf8, name.as_bytes())) } else { folder.to_owned() }
}

/// Creates a folder if it does not exist.
pub fn make_folder(folder: &Path) -> Result<()> {
    Ok(std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())?)
}

fn exists(path: &Path) -> Failure {
    Failure::local(format!("{} already exists and was not changed", path.display()))
        .hint("add --force to replace the file, or use another path")
}

/// A character of a name, or a byte that is not valid in the encoding.
struct Piece<'a> {
    /// The character; `None` if it needs an escape.
    plain: Option<char>,
    bytes: Cow<'a, [u8]>,
}

fn pieces(encoding: Encoding, name: &[u8]) -> Vec<Piece<'_>> {
    let shown = encoding.name(name);
    if shown.hex.is_some() {
        let plain = |byte: u8| Some(char::from(byte)).filter(|c| c.is_ascii() && is_plain(*c));
        return name.iter().map(|byte| Piece { plain: plain(*byte), bytes: vec![*byte].into() }).collect();
    }
    let mut buffer = [0; 4];
    let piece = |c: char| {
        // The text was decoded from these bytes, so each of its characters can be encoded.
        let bytes = encoding.encode(c.encode_utf8(&mut buffer)).unwrap_or_default();
        Piece { plain: Some(c).filter(|c| is_plain(*c)), bytes: bytes.into() }
    };
    shown.text.chars().map(piece).collect()
}

fn escape_piece(pieces: &[Piece<'_>]) -> String {
    let mut local = String::new();
    for piece in pieces {
        match piece.plain {
            Some(c) => local.push(c),
            None => {
                for byte in piece.bytes.iter() {
                    write!(local, "%{byte:02X}").expect("writing to a String does not fail");
                }
            }
        }
    }
    local
}

/// Bytes of a local name; `None` if [`escape_piece`] cannot produce this name.
fn unescaped(encoding: Encoding, local: &str) -> Option<Vec<u8>> {
    let mut name = Vec::with_capacity(local.len());
    let mut rest = local;
    while let Some(c) = rest.chars().next() {
        let (_, tail) = rest.split_at(c.len_utf8());
        rest = tail;
        if c == '%' {
            let digits = rest.get(..2)?;
            name.extend(unhex(digits)?);
            rest = rest.get(2..)?;
        } else {
            name.extend(encoding.encode(c.encode_utf8(&mut [0; 4])).ok()?);
        }
    }
    Some(name)
}

fn is_plain(c: char) -> bool {
    c != '%' && is_plain_or_escape(c)
}

fn is_plain_or_escape(c: char) -> bool {
    let mut buffer = [0; 4];
    let text: &str = c.encode_utf8(&mut buffer);
    !r#"/\:*?"<>|"#.contains(c) && matches!(escape::line(text), Cow::Borrowed(_))
}

fn is_device(local: &str) -> bool {
    let stem = local.split('.').next().unwrap_or_default().trim_end().to_uppercase();
    let mut before_digit = stem.chars();
    let digit = before_digit.next_back().is_some_and(|c| matches!(c, '0'..='9' | '¹' | '²' | '³'));
    DEVICES.contains(&stem.as_str()) || digit && NUMBERED_DEVICES.contains(&before_digit.as_str())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const SJIS: Encoding = Encoding::ShiftJis;

    #[test]
    fn keeps_plain_names() {
        for (name, local) in
            [(&b"TESTJOB.JBI"[..], "TESTJOB.JBI"), (b"\x83\x5c\x83t.JBI", "ソフ.JBI"), (b"A B.CND", "A B.CND")]
        {
            assert_eq!(local_name(SJIS, name), local);
        }
    }

    #[test]
    fn escapes_names_that_other_systems_reserve() {
        for (name, local) in [
            (&b"../A.JBI"[..], "%2E.%2FA.JBI"),
            (b"..", "%2E%2E"),
            (b"C:\\A.JBI", "C%3A%5CA.JBI"),
            (b"con.JBI", "%63on.JBI"),
            (b"COM1.JBI", "%43OM1.JBI"),
            (b"NUL", "%4EUL"),
            (b"COMET.JBI", "COMET.JBI"),
            (b"50%.JBI", "50%25.JBI"),
            (b"-rf.JBI", "%2Drf.JBI"),
            (b"A\x1b[0m.JBI", "A%1B[0m.JBI"),
            (b"A\xff.JBI", "A%FF.JBI"),
            (b"A.JBI ", "A.JBI%20"),
            (b"A.", "A%2E"),
        ] {
            assert_eq!(local_name(SJIS, name), local);
            assert_eq!(controller_name(SJIS, local).unwrap(), name);
        }
    }

    #[test]
    fn keeps_percent_signs_of_local_files() {
        assert_eq!(controller_name(SJIS, "A%20B.JBI").unwrap(), b"A%20B.JBI");
        assert_eq!(controller_name(SJIS, "50%.JBI").unwrap(), b"50%.JBI");
    }

    #[test]
    fn separates_names_that_differ_in_case_only() {
        let mut names = LocalNames::new(SJIS);
        assert_eq!(names.assign(b"Job.JBI").unwrap(), "Job.JBI");
        assert_eq!(names.assign(b"JOB.JBI").unwrap(), "%4A%4F%42%2E%4A%42%49");
        assert_eq!(names.assign(b"job.JBI").unwrap(), "%6A%6F%62%2E%4A%42%49");
        assert_eq!(names.assign(b"Job.JBI").unwrap(), "Job.JBI");
        assert_eq!(controller_name(SJIS, "%6A%6F%62%2E%4A%42%49").unwrap(), b"job.JBI");
        assert!(names.assign(b"").is_err());
        assert!(names.assign(&[b'A'; 300]).is_err());
    }

    #[test]
    fn manifests_cannot_name_files_outside_their_folder() {
        for local in ["TESTJOB.JBI", "ソフ.JBI", "%2E.%2FA.JBI"] {
            assert!(is_plain_file_name(local), "{local}");
        }
        for local in ["", ".", "..", "../A.JBI", "a/A.JBI", "/etc/passwd", "C:\\A", "A.JBI/", "NUL", "./A.JBI", "A\n"] {
            assert!(!is_plain_file_name(local), "{local}");
        }
    }

    #[test]
    fn keeps_an_existing_file_and_removes_a_dropped_draft() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("A.JBI");
        let target = Target::new(path.clone(), false).unwrap();
        let mut draft = target.begin().unwrap();
        draft.write(b"half").unwrap();
        drop(draft);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);

        let mut draft = target.begin().unwrap();
        draft.write(b"whole").unwrap();
        draft.commit().unwrap();
        assert_eq!(Target::new(path.clone(), false).unwrap_err().kind, Kind::Local);
        // The target file appears during the transfer and must not be replaced.
        let late = target.begin().unwrap();
        assert_eq!(late.commit().unwrap_err().kind, Kind::Local);
        assert_eq!(std::fs::read(&path).unwrap(), b"whole");

        let mut draft = Target::new(path.clone(), true).unwrap().begin().unwrap();
        draft.write(b"new").unwrap();
        draft.commit().unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"new");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        assert_eq!(Target::new(folder.path().to_owned(), true).unwrap_err().kind, Kind::Local);
        assert_eq!(Target::new(folder.path().join("no/A.JBI"), true).unwrap().begin().unwrap_err().kind, Kind::Local);
    }

    fn any_name() -> impl Strategy<Value = Vec<u8>> {
        let byte = prop_oneof![any::<u8>(), prop::sample::select(b"./\\:%~-CONcon1 \0\x83\x5c\xe3\x81".to_vec())];
        prop::collection::vec(byte, 1..60)
    }

    proptest! {
        #[test]
        fn any_name_round_trips_within_its_folder(name in any_name(), encoding in prop::sample::select(vec![
            SJIS, Encoding::EucJp, Encoding::Gbk, Encoding::Big5, Encoding::EucKr, Encoding::Latin1,
            Encoding::Windows1252, Encoding::Utf8,
        ])) {
            for local in [local_name(encoding, &name), caseless_name(encoding, &name)] {
                prop_assert!(is_plain_file_name(&local), "{}", local);
                prop_assert!(!local.starts_with(['.', '-', ' ']) && !local.ends_with(['.', ' ']), "{}", local);
                prop_assert_eq!(escape::line(&local), local.as_str());
                let path = Path::new("folder").join(&local);
                prop_assert_eq!(path.parent(), Some(Path::new("folder")));
                prop_assert_eq!(&controller_name(encoding, &local).unwrap(), &name);
            }
        }

        #[test]
        fn two_names_never_share_a_file(names in prop::collection::hash_set(prop::collection::vec(
            prop::sample::select(b"aAbB%.4126\x82\x60\x81".to_vec()), 1..5), 1..40)) {
            let mut local_names = LocalNames::new(SJIS);
            let mut folded: Vec<String> =
                names.iter().map(|name| local_names.assign(name).unwrap().to_lowercase()).collect();
            folded.sort();
            folded.dedup();
            prop_assert_eq!(folded.len(), names.len());
        }
    }
}
