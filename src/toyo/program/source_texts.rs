//! Source texts of programs that were written. They are stored because a controller stores neither labels nor comments.
//!
//! The state folder of the user has one file per controller and task. A text is valid only for exactly the steps that
//! were made from it. If a text cannot be saved or read, labels and comments are lost, but nothing else.

use std::fmt::Write as _;

use jiff::Timestamp;
use serde::Deserialize;
use sha2::{Digest as _, Sha256};

use crate::prelude::basics::*;
use armctl_controller::toyo::program::{tags, used};
use armctl_controller::toyo::request::instruction;
use armctl_controller::toyo::table::Op;
use armctl_frame::local_names::state_folder;

/// First word of each file.
const FORMAT: &str = "armctl-toyo-source";
/// Maximum size of a file. 5000 steps with long comments need less.
const MAX_FILE_SIZE: u64 = 8 << 20;
/// Numbers of the tasks of a controller.
const TASKS: std::ops::RangeInclusive<u8> = 1..=4;

/// Source texts of a controller.
#[derive(Debug, Clone, Default)]
pub struct SourceTexts {
    /// Prefix of the paths of the files; `None` if nothing is saved.
    prefix: Option<PathBuf>,
    address: String,
    /// Whether the steps after the program may have changed.
    is_uncertain: bool,
}

/// A source text that was written, and the steps that were made from it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Source {
    format: String,
    /// Address of the controller.
    address: String,
    task: u8,
    /// Name of the file.
    pub file: String,
    /// Time at which the program was written.
    pub put_at: Timestamp,
    /// The text.
    pub text: String,
    /// Steps in the controller, up to the last step that is not a NOP.
    steps: Vec<String>,
    /// Number of steps of the task.
    room: u16,
    /// Whether all later steps were NOP, and no command of this user has changed them since then.
    rest_is_nop: bool,
}

impl Source {
    /// Number of steps.
    pub fn len(&self) -> usize {
        self.steps.len()
    }

    /// Whether the steps from the first step on are equal to the steps of the text.
    pub fn is(&self, steps: &[Record]) -> bool {
        self.differences(steps) == 0
    }

    /// Number of steps that differ from the steps of the text.
    pub fn differences(&self, steps: &[Record]) -> usize {
        let used = used(steps);
        let differing = steps[..used].iter().zip(&self.steps).filter(|(step, kept)| step.written() != **kept).count();
        differing + used.abs_diff(self.steps.len())
    }

    /// Whether the steps after the program need not be read before these steps are written. This is possible if the
    /// steps of the stored program are unchanged and all later steps were NOP. Someone may have edited the later steps
    /// on the pendant in the meantime, and this edit is not noticed. For this reason, the edit must not matter for the
    /// new program. The new program defines no tag that may exist twice, jumps only to its own tags, and does not run
    /// beyond its end.
    pub fn has_all_steps(&self, steps: &[Record], room: u16) -> bool {
        let known: Vec<Record> = self.steps.iter().filter_map(|step| instruction(step).ok()).collect();
        let known = tags(&known, 1);
        let is_closed = ends(steps) && !steps.iter().any(computes_jump);
        self.rest_is_nop && self.room == room && is_closed && tags(steps, 1).keys().all(|tag| known.contains_key(tag))
    }
}

/// Whether the program ends before the steps after it.
fn ends(steps: &[Record]) -> bool {
    let layouts = [Op::End, Op::Jmp, Op::Ret].map(|op| op.row().layout);
    steps[..used(steps)].last().is_some_and(|last| layouts.contains(&last.layout()))
}

/// Whether a step jumps to a tag that is computed at run time.
fn computes_jump(step: &Record) -> bool {
    [Op::Brac, Op::Psel].iter().any(|op| step.layout() == op.row().layout)
}

impl SourceTexts {
    /// Source texts of a robot. For a simulator in this process, nothing is saved.
    pub fn of(robot: &Robot) -> Self {
        let Some(address) = robot.target.value.address().key() else { return Self::default() };
        let hash = Sha256::digest(address.as_bytes()).iter().take(8).fold(String::new(), |mut text, byte| {
            // Writing to a string cannot fail.
            let _ = write!(text, "{byte:02x}");
            text
        });
        let prefix = state_folder().map(|folder| folder.join("toyo-programs").join(hash));
        Self { prefix, address, is_uncertain: false }
    }

    fn path(&self, task: u8) -> Option<PathBuf> {
        let mut path = self.prefix.clone()?.into_os_string();
        path.push(format!("-{task}.json"));
        Some(path.into())
    }

    /// The text that was last written as the whole program of a task; `None` if there is none, or if it cannot be read.
    pub fn get(&self, task: u8) -> Option<Source> {
        let text = files::text(&self.path(task)?, MAX_FILE_SIZE).ok()?;
        let source: Source = serde_json::from_str(&text).ok()?;
        (source.format == FORMAT && source.address == self.address && source.task == task).then_some(source)
    }

    /// Saves a text that was written, together with all steps of its task.
    pub fn keep(&mut self, task: u8, (file, text): (&str, &str), steps: &[Record], room: u16) -> std::io::Result<()> {
        let steps = steps[..used(steps)].iter().map(Record::written).collect();
        let now = Timestamp::now();
        self.write(&Source {
            format: FORMAT.to_owned(),
            address: self.address.clone(),
            task,
            file: file.to_owned(),
            put_at: now.round(jiff::Unit::Second).unwrap_or(now),
            text: text.to_owned(),
            steps,
            room,
            rest_is_nop: true,
        })
    }

    fn write(&self, source: &Source) -> std::io::Result<()> {
        let Some(path) = self.path(source.task) else { return Ok(()) };
        std::fs::create_dir_all(files::folder_of(&path))?;
        files::replace(&path, &serde_json::to_vec(source)?)
    }

    /// Marks the steps after the programs as unknown. This is done before a command changes steps.
    pub fn mark_uncertain(&mut self) {
        if std::mem::replace(&mut self.is_uncertain, true) {
            return;
        }
        for source in TASKS.filter_map(|task| self.get(task)).filter(|source| source.rest_is_nop) {
            // If the file cannot be written, it is deleted. Otherwise, a later `put` would read too few steps.
            if self.write(&Source { rest_is_nop: false, ..source.clone() }).is_err()
                && let Some(path) = self.path(source.task)
            {
                std::fs::remove_file(path).unwrap_or_default();
            }
        }
    }

    /// Marks the steps after the programs as known again.
    pub fn mark_certain(&mut self) {
        self.is_uncertain = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps(texts: &[&str]) -> Vec<Record> {
        texts.iter().map(|text| instruction(text).unwrap()).collect()
    }

    #[test]
    fn source_text_belongs_to_its_steps() {
        let folder = tempfile::tempdir().unwrap();
        let mut sources = SourceTexts {
            prefix: Some(folder.path().join("programs").join("x")),
            address: "tcp 127.0.0.1 1".to_owned(),
            is_uncertain: false,
        };
        assert_eq!(sources.get(1), None);
        let put = steps(&["SPD V=05", "END", "NOP", "NOP"]);
        sources.keep(1, ("pick.toyo", "# text\nSPD V=5\nEND\n"), &put, 4).unwrap();
        let source = sources.get(1).unwrap();
        assert!(
            source.is(&put) && source.len() == 2 && source.has_all_steps(&put, 4) && !source.has_all_steps(&put, 5)
        );
        let tagged = steps(&["TAG TAG=001", "END"]);
        assert!(!source.has_all_steps(&tagged, 4), "the tag may be behind them already");
        assert!(!source.has_all_steps(&steps(&["SPD V=05"]), 4), "it runs on into what is behind it");
        assert_eq!(source.differences(&steps(&["SPD V=06", "END", "TAG TAG=001"])), 2);
        sources.mark_uncertain();
        let source = sources.get(1).unwrap();
        assert!(source.is(&put) && !source.has_all_steps(&put, 4), "the text stays, what is behind it is unknown");
        let other = SourceTexts { address: "tcp 127.0.0.1 2".to_owned(), ..sources };
        assert_eq!(other.get(1), None, "another controller");
    }
}
