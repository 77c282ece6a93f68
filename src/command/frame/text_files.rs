//! Files that an operator hands over, or wants.

use std::io::ErrorKind;
use std::path::Path;

use super::local::Target;
use crate::controller::findings::Finding;
use crate::failure::Failure;
use crate::files;

/// Most that is read of a file: all that a controller can hold is smaller.
const MOST: u64 = 16 << 20;

/// The bytes of a file, or of stdin for `-`.
pub fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    files::input(path, MOST).map_err(|error| match error.kind() {
        ErrorKind::FileTooLarge => {
            Failure::usage(format!("{} is larger than all that a controller can hold", shown(path)))
                .hint("check that it is the file that was meant")
        }
        _ => Failure::io(shown(path), &error),
    })
}

/// How a file is called in reports.
pub fn shown(path: &Path) -> String {
    if path == Path::new("-") { "stdin".to_owned() } else { path.display().to_string() }
}

/// Where a file of one robot goes, if somebody wants one; known before anything is asked.
pub fn target(file: Option<&Path>, force: bool, several: bool) -> Result<Option<Target>, Failure> {
    let Some(file) = file else { return Ok(None) };
    if several {
        return Err(of_one_robot(file));
    }
    Target::new(file.to_owned(), force).map(Some)
}

/// A file cannot take what several robots have.
pub fn of_one_robot(file: &Path) -> Failure {
    Failure::usage(format!("{} is for one robot", file.display()))
        .hint("run the command once for each robot, with a file each")
}

/// Writes a file, whole or not at all, and says where.
pub fn write(target: &Target, text: &str) -> Result<String, Failure> {
    let mut draft = target.begin()?;
    draft.write(text.as_bytes())?;
    draft.commit()?;
    Ok(target.path().display().to_string())
}

/// Every mistake of a file, a line each.
pub fn faulty(name: &str, errors: &[Finding]) -> Failure {
    let lines: Vec<String> = errors
        .iter()
        .map(|Finding { line, column, message, hint, .. }| {
            let hint = hint.as_ref().map(|hint| format!(" ({hint})")).unwrap_or_default();
            format!("{name}:{line}:{column}: {message}{hint}")
        })
        .collect();
    Failure::usage(lines.join("\n")).hint("nothing was written; correct the file")
}
