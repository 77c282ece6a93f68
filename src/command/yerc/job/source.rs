//! The text of the line that a job is at, from the job's file (`job show --source`).
//!
//! The protocol tells neither dates nor sizes nor hashes of files, so nothing that was kept could be known to be current:
//! the file is got each time, and its hash says which one it was.

use schemars::JsonSchema;
use serde::Serialize;

use crate::command::backup::manifest::Hash;
use crate::command::yerc::file::{exact, fetch};
use crate::command::yerc::link::Link;
use crate::controller::yerc::payload::JobInfo;
use crate::failure::Failure;

/// A line of a job file.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Source {
    /// The file on the controller.
    file: String,
    /// Its hash, as backups have it.
    sha256: String,
    /// The text of the line; null where the file has no such line.
    text: Option<String>,
}

impl Source {
    /// Gets the file of a job and takes the line from it.
    pub async fn read(link: &mut Link, job: &JobInfo) -> Result<Self, Failure> {
        let name = [job.name.as_bytes(), b".JBI"].concat();
        let (mut hash, mut content) = (Hash::default(), Vec::new());
        fetch(link, &exact(name.clone())?, |piece| {
            hash.take(piece);
            content.extend_from_slice(piece);
            Ok(())
        })
        .await?;
        let text = line(&content, job.line).map(|line| link.encoding.decode(line));
        Ok(Self { file: link.encoding.decode(&name), sha256: hash.hex(), text })
    }

    /// The text of the line.
    pub fn text(&self) -> Option<&str> {
        self.text.as_deref()
    }
}

/// A line by the number that the controller gives it: NOP, the first instruction, is 0.
fn line(content: &[u8], number: u32) -> Option<&[u8]> {
    let lines = content.split(|byte| *byte == b'\n').map(<[u8]>::trim_ascii);
    lines.skip_while(|line| *line != b"NOP").nth(usize::try_from(number).ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_count_from_nop() {
        let file = b"/JOB\r\n//NAME A\r\n//INST\r\nNOP\r\nMOVJ C00000 VJ=0.78\r\n'NOTE\r\nEND\r\n";
        assert_eq!(line(file, 0), Some(&b"NOP"[..]));
        assert_eq!(line(file, 1), Some(&b"MOVJ C00000 VJ=0.78"[..]));
        assert_eq!(line(file, 3), Some(&b"END"[..]));
        assert_eq!(line(file, 9), None);
        assert_eq!(line(b"/JOB\r\n", 0), None);
    }
}
