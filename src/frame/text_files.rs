//! Input and output files that the user names.

use std::io::ErrorKind;

use super::local_names::Target;
use crate::prelude::basics::*;
use armctl_controller::findings::Finding;

/// Maximum file size. It is larger than all data of a controller.
const SIZE_LIMIT: u64 = 16 << 20;

/// Reads a file, or stdin for `-`.
pub fn read(path: &Path) -> Result<Vec<u8>> {
    files::input(path, SIZE_LIMIT).map_err(|error| match error.kind() {
        ErrorKind::FileTooLarge => {
            Failure::usage(format!("{} is larger than the memory of a controller", display_path(path)))
                .hint("check whether this is the right file")
        }
        _ => Failure::io(display_path(path), &error),
    })
}

/// Name of a file in reports.
pub fn display_path(path: &Path) -> String {
    if path == Path::new("-") { "stdin".to_owned() } else { path.display().to_string() }
}

/// Target for one robot of an optional file. It is checked before any request to the controller.
pub fn target(file: Option<&Path>, force: bool, several: bool) -> Result<Option<Target>> {
    let Some(file) = file else { return Ok(None) };
    if several {
        return Err(of_one_robot(file));
    }
    Target::new(file.to_owned(), force).map(Some)
}

/// Failure: the file cannot be used with several robots.
pub fn of_one_robot(file: &Path) -> Failure {
    Failure::usage(format!("{} is a file for one robot", file.display()))
        .hint("run the command once for each robot, each time with the file of that robot")
}

/// Writes a file atomically and returns its path.
pub fn write(target: &Target, text: &str) -> Result<String> {
    let mut draft = target.begin()?;
    draft.write(text.as_bytes())?;
    draft.commit()?;
    Ok(target.path().display().to_string())
}

/// Failure with all errors of a file, one line each.
pub fn file_failure(name: &str, errors: &[Finding]) -> Failure {
    let lines: Vec<String> = errors
        .iter()
        .map(|Finding { line, column, message, hint, .. }| {
            let hint = hint.as_ref().map(|hint| format!(" ({hint})")).unwrap_or_default();
            format!("{name}:{line}:{column}: {message}{hint}")
        })
        .collect();
    Failure::usage(lines.join("\n")).hint("correct the file; nothing was written")
}
