//! `yerc file cmos` (FS and DX 3.4.5): the batch backup.
//!
//! The same request creates the backup and downloads it, and the manuals do not say how a controller distinguishes the
//! two requests. For this reason, the first answer decides. If it has no data, the backup has been created, and the
//! request is sent once more. If it has data, this is already the file. The request is never repeated automatically,
//! because that could create a second backup.

use super::transfer;
use crate::prelude::*;
use armctl_controller::yerc::files;
use armctl_frame::backup::manifest::Hash;
use armctl_frame::local_names::{Target, folder_of, make_folder, private_folder};
use armctl_frame::output::progress::Progress;
use armctl_frame::robot::file::{FileItem, Files, State};

/// Creates and downloads the batch backup.
#[derive(Debug, Args)]
pub struct Cmos {
    /// Local file for the backup
    #[arg(required_unless_present = "start_only")]
    file: Option<PathBuf>,
    /// Download the existing backup of the controller
    #[arg(long, conflicts_with = "start_only")]
    download_only: bool,
    /// Create the backup and leave it on the controller
    #[arg(long)]
    start_only: bool,
    /// Maximum wait for the first answer of the controller
    #[arg(long, value_name = "TIME", value_parser = duration::parse_some, default_value = "15m")]
    wait: Duration,
    /// Replace the local file if it exists
    #[arg(long)]
    force: bool,
}

impl Command for Cmos {
    type Family = Yerc;
    type Report = Files;
    const ID: &'static str = "yerc.file.cmos";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Files> {
        let Context { link, screen, robot, several, .. } = context;
        let Some(file) = self.file.as_deref().filter(|_| !self.start_only) else {
            return self.start(link, screen).await;
        };
        let name = file.file_name().ok_or_else(|| {
            Failure::usage(format!("{} is not a file name", file.display())).hint("use a file name such as cmos.bin")
        })?;
        let folder = private_folder(&folder_of(file), &robot.name, several);
        let path = if several { folder.join(name) } else { file.to_owned() };
        let target = Target::new(path, self.force)?;
        if link.is_dry_run() {
            link.plan_download(&files::batch_backup(), Reason::default())?;
            if !self.download_only {
                let reason = Reason::about("after the controller has created the backup");
                let reason =
                    reason.depending_on("whether the controller creates the backup first, or sends a backup at once");
                link.plan_download(&files::batch_backup(), reason)?;
            }
            return Err(unknown());
        }
        if several {
            make_folder(&folder)?;
        }
        self.make_and_fetch(link, screen, &target).await
    }
}

impl Cmos {
    async fn start(&self, link: &mut Link, screen: &Screen) -> Result<Files> {
        let _waiting = Waiting::new(screen, CREATE_TIMEOUT);
        // The transfer is ended at its first block, so that the controller keeps the backup that exists.
        let existed = |_: &[u8]| {
            Err(Failure::new(Kind::Malformed, "the controller already has a backup, so it created no new backup")
                .hint("download the existing backup with --download-only"))
        };
        self.ask(link, existed).await?;
        Ok(created_files(FileItem::pending(NAME)))
    }

    async fn make_and_fetch(&self, link: &mut Link, screen: &Screen, target: &Target) -> Result<Files> {
        let (mut draft, mut hash) = (target.begin()?, Hash::default());
        let requests = if self.download_only { &[FETCHING][..] } else { &[CREATE_TIMEOUT, FETCHING] };
        for what in requests {
            let mut waiting = Waiting::new(screen, what);
            let received = self.ask(link, |block| {
                waiting.advance(block);
                hash.take(block);
                draft.write(block)
            });
            if received.await?.is_some() {
                draft.commit()?;
                return Ok(created_files(FileItem::pending(NAME).with_path(target.path()).with_content(hash)));
            }
        }
        Err(Failure::new(Kind::Malformed, "the controller created a backup instead of sending the existing one").hint(
            "download the backup with --download-only; if that also creates a backup, save the backup on the pendant \
             and report the problem",
        ))
    }

    async fn ask(&self, link: &mut Link, handle_block: impl FnMut(&[u8]) -> Result<()>) -> Result<Option<u64>> {
        transfer::fetch_backup(link, self.wait, handle_block).await.map_err(|failure| match failure.kind {
            Kind::OutcomeUnknown => failure.hint(
                "wait, because the controller may still be busy; then use --download-only, or set a longer --wait",
            ),
            _ => failure,
        })
    }
}

/// Name of the batch backup on the controller.
const NAME: &str = "CMOSBK.BIN";
const CREATE_TIMEOUT: &str = "the controller creates its backup (about ten minutes)";
const FETCHING: &str = "waiting for the backup";

/// Progress display: first the wait for the controller, and then the number of received bytes.
struct Waiting<'a> {
    screen: &'a Screen,
    progress: Progress,
    has_begun: bool,
}

impl<'a> Waiting<'a> {
    fn new(screen: &'a Screen, what: &str) -> Self {
        screen.step(what);
        Self { screen, progress: screen.spinner(what), has_begun: false }
    }

    fn advance(&mut self, block: &[u8]) {
        if !self.has_begun {
            self.has_begun = true;
            self.progress = self.screen.bytes_progress(NAME, None);
        }
        self.progress.advance(block.len() as u64);
    }
}

/// Report of the batch backup. It has a path, unless the backup was left on the controller.
fn created_files(mut file: FileItem) -> Files {
    file.succeed(State::Done);
    Files::new(vec![file], |files| match files {
        [FileItem { path: Some(path), bytes: Some(bytes), .. }] => {
            View::text(format!("batch backup saved in {path}, {bytes} bytes"))
        }
        _ => View::text("the controller has created the batch backup; use --download-only to download it"),
    })
}
