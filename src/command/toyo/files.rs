//! Files that an operator hands over.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use crate::controller::toyo::findings::Finding;
use crate::failure::Failure;

/// Most that is read of a file: all that a controller can hold is smaller.
const MOST: u64 = 16 << 20;

/// The bytes of a file, or of stdin for `-`.
pub fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    let failed = |error| Failure::io(shown(path), &error);
    if path == Path::new("-") {
        std::io::stdin().lock().take(MOST).read_to_end(&mut bytes).map_err(failed)?;
    } else {
        File::open(path).map_err(failed)?.take(MOST).read_to_end(&mut bytes).map_err(failed)?;
    }
    if bytes.len() as u64 == MOST {
        return Err(Failure::usage(format!("{} is larger than all that a controller can hold", shown(path))));
    }
    Ok(bytes)
}

/// How a file is called in reports.
pub fn shown(path: &Path) -> String {
    if path == Path::new("-") { "stdin".to_owned() } else { path.display().to_string() }
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
    Failure::usage(lines.join("\n")).hint("nothing was sent; correct the file")
}
