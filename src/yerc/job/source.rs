//! Text of the current line of a job, from the job file (`job show --source`).
//!
//! The protocol has no dates, sizes or hashes of files, so a cached file could be outdated. For this reason the file is
//! downloaded each time. Its hash identifies the version.

use crate::file::{exact, fetch};
use crate::prelude::*;
use armctl_controller::yerc::payload::JobInfo;
use armctl_frame::backup::manifest::Hash;

/// A line of a job file.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Source {
    /// Name of the file on the controller.
    file: String,
    /// SHA-256 of the file, as in backups.
    sha256: String,
    /// Text of the line; null if the file does not have the line.
    pub text: Option<String>,
}

impl Source {
    /// Downloads the file of a job, and finds the current line in it.
    pub async fn read(link: &mut Link, job: &JobInfo) -> Result<Self> {
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
}

/// Line with this number of the controller. NOP, the first instruction, is line 0.
fn line(content: &[u8], number: u32) -> Option<&[u8]> {
    let lines = content.split(|byte| *byte == b'\n').map(<[u8]>::trim_ascii);
    lines.skip_while(|line| *line != b"NOP").nth(usize::try_from(number).ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_lines_from_nop() {
        let file = b"/JOB\r\n//NAME A\r\n//INST\r\nNOP\r\nMOVJ C00000 VJ=0.78\r\n'NOTE\r\nEND\r\n";
        assert_eq!(line(file, 0), Some(&b"NOP"[..]));
        assert_eq!(line(file, 1), Some(&b"MOVJ C00000 VJ=0.78"[..]));
        assert_eq!(line(file, 3), Some(&b"END"[..]));
        assert_eq!(line(file, 9), None);
        assert_eq!(line(b"/JOB\r\n", 0), None);
    }
}
