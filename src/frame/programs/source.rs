//! Source of programs: a backup, or another folder with program files. A family reads the programs of a controller into
//! the same [`ProgramSet`].

use crate::backup::manifest::{self, About, Manifest};
use crate::items::ItemError;
use crate::prelude::basics::*;
use crate::text_files;
use armctl_controller::names::Name;

/// A program file: a job, or a sequential program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ProgramFile {
    /// Name of the file on the controller, such as `COUNT.JBI`, or name of the part of the backup, such as `program-1`.
    pub name: String,
    /// File in messages: its path, or its name on the controller.
    pub file: String,
    /// Content of the file.
    pub bytes: Vec<u8>,
}

/// The programs of a robot or of a folder.
#[derive(Debug, Clone, Default)]
pub struct ProgramSet {
    /// Programs that were read, in the order of their source.
    pub files: Vec<ProgramFile>,
    /// Programs that exist but could not be read, each with its name and the reason.
    pub unread: Vec<ItemError>,
    /// Whether the source contains only some of the programs of a robot, such as a backup with `--only`.
    pub is_partial: bool,
    /// Whether the source is a folder without a manifest, so that it is unknown whether the robot has more programs.
    pub is_loose: bool,
    /// Names that the inventory entry of the robot gives to its objects. A backup has a copy of the entry.
    pub names: Vec<Name>,
}

/// Which files of a folder are programs.
#[derive(Debug, Clone, Copy)]
pub struct FolderFilter {
    /// `holds` of a program in the manifest of a backup, such as `jbi`.
    pub holds: &'static str,
    /// Whether a file in a folder without a manifest is a program, by the name of the file.
    pub is_program: fn(&str) -> bool,
    /// What the folder should contain, such as `jobs (*.JBI)`.
    pub expected: &'static str,
}

/// Reads the programs in a folder, and the manifest if the folder is a backup. The files can differ from the manifest,
/// because people edit the programs of a backup.
///
/// # Errors
/// The folder or a file cannot be read, the backup is of another family, or the folder contains no program.
pub fn read_folder<C: About>(folder: &Path, filter: FolderFilter) -> Result<(ProgramSet, Option<Manifest<C>>)> {
    let manifest = manifest::read::<C>(folder)?;
    let set = match &manifest {
        Some(manifest) => of_backup(folder, filter, manifest)?,
        None => of_folder(folder, filter)?,
    };
    if set.files.is_empty() && set.unread.is_empty() {
        let otherwise = "use the folder of a backup, or a folder with program files";
        return Err(Failure::usage(format!("{} contains no {}", folder.display(), filter.expected))
            .hint(manifest::subfolder_hint::<C>(folder, otherwise)));
    }
    Ok((set, manifest))
}

fn of_backup<C: About>(folder: &Path, filter: FolderFilter, manifest: &Manifest<C>) -> Result<ProgramSet> {
    let mut set =
        ProgramSet { is_partial: !manifest.scope.is_empty(), names: manifest.names(), ..ProgramSet::default() };
    for entry in manifest.files.iter().filter(|entry| entry.holds == filter.holds) {
        match (&entry.copy, &entry.error) {
            (Some(copy), _) => set.files.push(read_file(&folder.join(&copy.file), entry.name.clone())?),
            (None, error) => {
                let why = error.as_ref().map_or("the backup has no copy", |error| error.message.as_str());
                set.unread.push(ItemError::new(&entry.name, Failure::new(Kind::Refused, why)));
            }
        }
    }
    Ok(set)
}

fn of_folder(folder: &Path, filter: FolderFilter) -> Result<ProgramSet> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let entry = entry.with_context(|| folder.display().to_string())?;
        names.extend(entry.file_name().into_string().ok().filter(|name| (filter.is_program)(name)));
    }
    names.sort();
    let read = |name: &String| read_file(&folder.join(name), name.clone());
    Ok(ProgramSet { files: names.iter().map(read).collect::<Result<_, _>>()?, is_loose: true, ..ProgramSet::default() })
}

fn read_file(path: &Path, name: String) -> Result<ProgramFile> {
    Ok(ProgramFile { name, file: text_files::display_path(path), bytes: text_files::read(path)? })
}

/// Checks that each of these names is the name of a program. Names of programs are case-sensitive.
///
/// # Errors
/// The first name without a program.
pub fn check_names<'a>(names: &[String], known: impl Iterator<Item = &'a str> + Clone) -> Result<()> {
    let Some(missing) = names.iter().find(|name| !known.clone().any(|known| known == name.as_str())) else {
        return Ok(());
    };
    let failure = Failure::usage(format!("there is no program {missing}"));
    Err(match nearest(missing, known) {
        Some(near) => failure.hint(format!("did you mean {near}?")),
        None => failure.hint("use a name without the ending of the file"),
    })
}
