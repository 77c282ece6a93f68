//! Log of EEPROM writes, to detect a loop of writes to one cell within a connection or in a script.
//!
//! A cell lasts for about a million writes (TO 2-1, note 2). A loop with ten writes per second reaches this number in a
//! day. The log is in the state folder of the user and covers ten minutes. If it cannot be saved, there is no warning,
//! but no other effect.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use armctl_files as files;
use armctl_frame::local_names::state_folder;

/// Number of writes to one cell over one link at which a warning is printed.
const LOOP: u32 = 3;
/// The same number for several links. A person can be the reason for such writes, so this number is larger.
const LOOP_OF_COMMANDS: u32 = 10;
/// Period that the log covers.
const WINDOW: Duration = Duration::from_secs(600);
/// If the log is longer than this, it is written again without old lines.
const SIZE: u64 = 64 * 1024;
/// Maximum size of the log.
const MAX_LOG_SIZE: u64 = 16 << 20;

/// Counter of the writes to each cell.
#[derive(Debug, Default)]
pub struct WriteLog {
    log: Option<LogFile>,
    /// Writes of this link.
    own: HashMap<String, u32>,
    /// Writes of other links in the period. They are read at the first write.
    counts_of_others: Option<HashMap<String, u32>>,
}

#[derive(Debug)]
struct LogFile {
    path: PathBuf,
    /// Target URL of the robot.
    robot: String,
}

impl WriteLog {
    /// Counts for a robot. The log is in the state folder of the user, if there is such a folder.
    pub fn of(robot: &str) -> Self {
        let log = |folder: PathBuf| LogFile { path: folder.join("eeprom-writes"), robot: robot.to_owned() };
        Self { log: state_folder().map(log), ..Self::default() }
    }

    /// Creates a counter without a log, for a simulator in this process.
    pub fn without_file() -> Self {
        Self::default()
    }

    /// Counts a write to a cell. Returns a warning if there are too many writes.
    pub fn written(&mut self, cell: &str) -> Option<String> {
        let log = self.log.as_ref();
        let counts_of_others =
            self.counts_of_others.get_or_insert_with(|| log.map(|log| log.read(now())).unwrap_or_default());
        let counts_of_others = counts_of_others.get(cell).copied().unwrap_or_default();
        let own = self.own.entry(cell.to_owned()).or_default();
        *own += 1;
        let total = *own + counts_of_others;
        let warning = if *own == LOOP {
            format!("{cell} was written {LOOP} times in a row")
        } else if *own == 1 && total >= LOOP_OF_COMMANDS {
            format!("{cell} was written {total} times in {} minutes", WINDOW.as_secs() / 60)
        } else {
            return None;
        };
        Some(format!("{warning}; an EEPROM cell wears out after about a million writes"))
    }

    /// Adds the writes of this link to the log.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn keep(&mut self) -> std::io::Result<()> {
        let own = std::mem::take(&mut self.own);
        match &self.log {
            Some(log) if !own.is_empty() => log.write(&own, now()),
            _ => Ok(()),
        }
    }
}

/// Seconds since 1970.
fn now() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs())
}

/// Parses a line of the log: time, count, robot, cell.
fn entry(line: &str) -> Option<(u64, u32, &str, &str)> {
    let mut parts = line.splitn(4, '\t');
    Some((parts.next()?.parse().ok()?, parts.next()?.parse().ok()?, parts.next()?, parts.next()?))
}

impl LogFile {
    /// Returns the number of recent writes to each cell of the robot.
    fn read(&self, now: u64) -> HashMap<String, u32> {
        let mut counts = HashMap::new();
        for (_, count, robot, cell) in recent_lines(&content(&self.path), now).filter_map(entry) {
            if robot == self.robot {
                let sum: &mut u32 = counts.entry(cell.to_owned()).or_default();
                *sum = sum.saturating_add(count);
            }
        }
        counts
    }

    fn write(&self, cells: &HashMap<String, u32>, now: u64) -> std::io::Result<()> {
        if let Some(folder) = self.path.parent() {
            fs::create_dir_all(folder)?;
        }
        if fs::metadata(&self.path).is_ok_and(|metadata| metadata.len() > SIZE) {
            self.shorten(now)?;
        }
        let mut lines = String::new();
        for (cell, count) in cells {
            // Writing to a string cannot fail.
            let _ = writeln!(lines, "{now}\t{count}\t{}\t{cell}", self.robot.replace(['\t', '\n'], " "));
        }
        // All lines are appended in one write, so that the lines of concurrent commands do not mix.
        fs::OpenOptions::new().create(true).append(true).open(&self.path)?.write_all(lines.as_bytes())
    }

    /// Removes the lines that are older than the period.
    fn shorten(&self, now: u64) -> std::io::Result<()> {
        let text = content(&self.path);
        let mut draft = files::draft_in(&files::folder_of(&self.path))?;
        for line in recent_lines(&text, now) {
            writeln!(draft, "{line}")?;
        }
        draft.persist(&self.path)?;
        Ok(())
    }
}

/// Reads the text of the log; empty if it cannot be read.
fn content(path: &Path) -> String {
    files::text(path, MAX_LOG_SIZE).unwrap_or_default()
}

/// Lines that are within the period.
fn recent_lines(text: &str, now: u64) -> impl Iterator<Item = &str> {
    let since = now.saturating_sub(WINDOW.as_secs());
    text.lines().filter(move |line| entry(line).is_some_and(|(time, ..)| (since..=now).contains(&time)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn writes(folder: &Path, robot: &str) -> WriteLog {
        let path = folder.join("armctl").join("eeprom-writes");
        WriteLog { log: Some(LogFile { path, robot: robot.to_owned() }), ..WriteLog::default() }
    }

    #[test]
    fn three_writes_of_one_cell_in_one_link_give_one_warning() {
        let mut writes = WriteLog::without_file();
        let has_warning: Vec<bool> = (0..5).map(|_| writes.written("@RPAR P01").is_some()).collect();
        assert_eq!(has_warning, [false, false, true, false, false]);
        assert_eq!(writes.written("@RPAR P02"), None);
    }

    #[test]
    fn separate_commands_are_warned_from_the_tenth_write_of_a_cell() {
        let folder = tempfile::tempdir().unwrap();
        for count in 1..=11 {
            let mut other = writes(folder.path(), "press");
            assert_eq!(other.written("@RPNT 001"), None, "another robot's");
            let mut writes = writes(folder.path(), "cell 1");
            let warning = writes.written("@RPNT 001");
            assert_eq!(warning.is_some(), count >= 10, "{warning:?}");
            writes.keep().unwrap();
        }
    }

    #[test]
    fn old_and_invalid_entries_do_not_count_and_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        let log = writes(folder.path(), "cell").log.unwrap();
        let cells = HashMap::from([("@RPNT 001".to_owned(), 4)]);
        log.write(&cells, 1_000).unwrap();
        fs::OpenOptions::new().append(true).open(&log.path).unwrap().write_all(b"nonsense\n\n\t\t\t\n").unwrap();
        log.write(&cells, 1_500).unwrap();
        assert_eq!(log.read(1_500), HashMap::from([("@RPNT 001".to_owned(), 8)]));
        assert_eq!(log.read(1_700), cells);
        log.shorten(1_700).unwrap();
        assert_eq!(content(&log.path), "1500\t4\tcell\t@RPNT 001\n");
    }
}
