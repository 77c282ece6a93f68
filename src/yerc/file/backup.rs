//! `yerc backup`: saves all files of the controller in a folder, with a manifest.

use super::manifest::Controller;
use super::name::{self, ReportedName, type_word};
use super::transfer::{self, Download};
use crate::prelude::*;
use armctl_controller::text::hex;
use armctl_controller::yerc::files;
use armctl_controller::yerc::query::Query as _;
use armctl_frame::backup::manifest::Entry;
use armctl_frame::backup::save::{Content, SavedPart, Task, interrupted_failure};
use armctl_frame::backup::{BackupReport, Only, SaveOptions};
use armctl_frame::local_names::{LocalNames, Target};
use armctl_frame::robot::file::FileItem;

/// Makes a backup.
pub async fn back_up(context: Context<'_, Yerc>, making: SaveOptions) -> Result<BackupReport> {
    let Context { link, screen, robot, several, .. } = context;
    let task = Task::new(making, robot, several)?;
    if link.is_dry_run() {
        let question = Controller::question()?.request();
        link.plan_next(&question)?;
        transfer::plan_all(link, transfer::LISTS, FileType::ALL.iter().map(|kind| files::list(*kind)))?;
        link.then("armctl downloads every listed file (service 0x16) and acknowledges each block");
        return Ok(BackupReport::new(&task.folder, task.scope, false, Vec::new()));
    }
    interrupted_failure(&task.folder, Box::pin(save(link, (screen, robot), &task))).await
}

/// A file on the controller, and its local name.
struct Listed {
    kind: FileType,
    name: Vec<u8>,
    local: Result<String>,
}

async fn save(link: &mut Link, (screen, robot): (&Screen, &Robot), task: &Task<Controller>) -> Result<BackupReport> {
    let only = Only::of_scope(&task.scope);
    let controller = Controller::ask(link).await?;
    let (mut work, mut refused) = (Vec::new(), Vec::new());
    // The file service may still be busy with a transfer that another client aborted.
    let looking = screen.spinner("looking for files");
    for kind in FileType::ALL {
        match transfer::list(link, kind).await {
            Ok(names) => work.extend(names.into_iter().map(|name| (kind, name))),
            Err(failure) if failure.kind == Kind::Refused => {
                let mut list = FileItem::pending(kind.filter());
                list.fail(failure);
                refused.push(list);
            }
            Err(failure) => return Err(transfer::describe_request(&kind.filter(), failure)),
        }
    }
    drop(looking);
    let encoding = link.encoding;
    only.check(&work.iter().map(|(_, name)| encoding.decode(name)).collect::<Vec<_>>())?;
    work.retain(|(_, name)| only.has(&encoding.decode(name)));
    let mut names = LocalNames::new(encoding);
    let listed = |(kind, name): (FileType, Vec<u8>)| Listed { kind, local: names.assign(&name), name };
    let work: Vec<Listed> = work.into_iter().map(listed).collect();
    let is_copy = |entry: &Entry, Listed { name, local, .. }: &Listed| {
        let file = entry.copy.as_ref().map(|copy| &copy.file);
        entry.name_hex.as_deref() == Some(&*hex(name)) && file == local.as_ref().ok()
    };
    let is_kept = |_: &_, entry: &Entry| work.iter().any(|listed| is_copy(entry, listed));
    let mut saving = task.begin((screen, robot), controller, is_kept)?;
    let mut saved = screen.parts_progress("files saved", work.len());
    for (number, Listed { kind, name, local }) in work.iter().enumerate() {
        let shown = encoding.decode(name);
        let label = format!("{}/{} {shown}", number + 1, work.len());
        let holds = type_word(FileType::from_name(name).unwrap_or(*kind)).to_owned();
        let entry = Entry { name: shown, name_hex: Some(hex(name)), holds, ..Entry::default() };
        let fetched_file = async {
            // If the list contains a name that is not allowed, this is an error of the controller, and not of the user.
            let malformed = |failure| Failure { kind: Kind::Malformed, ..failure };
            let local = local.clone().map_err(malformed)?;
            let file = name::exact(name.clone()).map_err(malformed)?;
            let target = Target::new(task.folder.join(&local), true)?;
            let content = transfer::save(link, screen, &label, &target, Download::Listed(&file)).await?;
            let notes = if content.bytes == 0 { vec!["empty".to_owned()] } else { Vec::new() };
            Ok(SavedPart { notes, ..SavedPart::new(Content::File(content.saved(local))) })
        };
        if !saving.part(entry, fetched_file).await? {
            break;
        }
        saved.advance(1);
    }
    let files = saving.files();
    let attempted = files.len();
    files.extend(work[attempted..].iter().map(|listed| FileItem::pending(encoding.decode(&listed.name))));
    for (file, listed) in files.iter_mut().zip(&work) {
        file.more.name_hex = ReportedName::new(encoding, &listed.name).name_hex;
    }
    saving.end(refused)
}
