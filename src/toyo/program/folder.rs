//! Programs of a folder or of the controller, for commands that read whole programs.

use super::get::Get;
use crate::backup::Controller;
use crate::prelude::*;
use armctl_controller::names::Names;
use armctl_controller::references::ProgrammedSpeed;
use armctl_controller::toyo::program::{self, Checked, ControllerData, NOT_IN_MANUAL, Rows, Style};
use armctl_frame::programs::source::{FolderFilter, ProgramFile, ProgramSet, read_folder};
use armctl_frame::programs::{Line, Program};

const PROGRAMS: FolderFilter =
    FolderFilter { holds: "program", is_program, expected: "programs (program-N.txt or *.toyo)" };

fn is_program(name: &str) -> bool {
    let ending = Path::new(name).extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    ending.eq_ignore_ascii_case("toyo") || ending == "txt" && name.starts_with("program-")
}

/// Reads the programs in the folder of a backup, or in any folder with program files.
///
/// # Errors
/// A file cannot be read, or the folder has no programs.
pub fn programs_in(folder: &Path) -> Result<ProgramSet> {
    let (mut set, manifest) = read_folder::<Controller>(folder, PROGRAMS)?;
    for file in &mut set.files {
        file.name = file.name.trim_end_matches(".txt").to_owned();
    }
    // Without a manifest, it is unknown whether the other tasks have programs.
    set.is_partial |= manifest.is_none();
    Ok(set)
}

/// Reads the program of a task of the controller. Without a task, reads the program of the current task. The selection
/// of a task is a change.
///
/// # Errors
/// A step cannot be read. In a dry run, the requests are recorded.
pub async fn program_of(link: &mut Link, screen: &Screen, task: Option<u8>) -> Result<ProgramSet> {
    let get = Get::whole(task);
    if link.is_dry_run() {
        return get.dry_run(link).await.and_then(|_| Err(unknown()));
    }
    let outcome = get.read(link, screen).await;
    let (task, _, answers) = task_selection::restore_task(link, outcome).await?;
    let steps = answers.into_iter().collect::<Result<Vec<Record>>>()?;
    let style = Style { first: 1, is_whole: true, is_numbered: false };
    let bytes = program::listing(&steps, style, &Rows::new()).text.into_bytes();
    let name = format!("program-{task}");
    Ok(ProgramSet {
        files: vec![ProgramFile { file: name.clone(), name, bytes }],
        is_partial: true,
        ..ProgramSet::default()
    })
}

/// File with the points of the task of a program in a backup.
pub fn points_of(folder: &Path, name: &str) -> Option<PathBuf> {
    let task = Path::new(name).file_stem()?.to_str()?.strip_prefix("program-")?;
    Some(folder.join(format!("points-{task}.csv"))).filter(|path| path.exists())
}

/// Parses a program file, with steps that the manual does not list.
pub fn check_file(file: &ProgramFile, room: usize, names: &Names, known: &ControllerData) -> Checked {
    let is_kept = String::from_utf8_lossy(&file.bytes).contains(NOT_IN_MANUAL);
    if is_kept {
        return program::check_kept(&file.bytes, room);
    }
    program::check_known(&file.bytes, room, None, names, known)
}

/// Lines of a program file. If the file is a valid program, they have their references.
pub fn read_program(file: &ProgramFile, checked: &Checked) -> Program {
    let text = String::from_utf8_lossy(&file.bytes);
    let mut lines = Line::all(&text);
    for (number, mut references) in checked.program.iter().flat_map(program::Program::references) {
        if let Some(line) = lines.get_mut(number - 1) {
            line.references.append(&mut references);
        }
    }
    let findings = checked.findings.clone();
    Program { name: file.name.clone(), file: file.file.clone(), lines, findings, ..Program::default() }
}

/// File with the parameters and tables of a backup.
pub fn parameters_of(folder: &Path) -> Option<PathBuf> {
    Some(folder.join("parameters.csv")).filter(|path| path.exists())
}

/// Adds the speeds that the steps select in the speed table.
pub fn add_speeds(program: &mut Program, parsed: &program::Program, table: &BTreeMap<i32, f64>) {
    for step in &parsed.steps {
        let speed = step.record.number("speed").and_then(|row| table.get(&row)).copied();
        if let (Some(value), Some(line)) = (speed, program.lines.get_mut(step.line - 1)) {
            line.speeds.push(ProgrammedSpeed { value, unit: "mm/s", column: 1 });
        }
    }
}
