//! `yerc job calls`.

use super::programs::{JobSource, jobs_of, parse};
use crate::prelude::*;
use crate::selected_job::SelectedJob;
use armctl_frame::programs::calls::CallReport;
use armctl_frame::programs::settings::CheckSettings;
use armctl_frame::programs::source::{ProgramSet, check_names};

/// Show which job calls which: the call tree, unused jobs, recursion, and missing jobs.
#[derive(Debug, Args)]
#[command(
    after_help = "CALL, JUMP JOB: and PSTART are calls, and macro jobs that are used as an instruction. A job without \
                  a caller is unused, unless it is a master job: the selected job of the controller, or a job in \
                  `master` of .armctl-check.toml (see `yerc job check -h`)."
)]
pub struct Calls {
    /// Show only the tree below this job
    #[arg(add = complete::JOB)]
    name: Option<String>,
    #[command(flatten)]
    source: JobSource,
}

impl Command for Calls {
    type Family = Yerc;
    type Report = CallReport;
    const ID: &'static str = "yerc.job.calls";

    fn takes_robot(&self) -> bool {
        self.source.from.is_none()
    }

    fn run_alone(&self) -> Result<CallReport> {
        let (folder, set, encoding) = self.source.folder()?;
        self.tree(set, encoding, &CheckSettings::load(Some(folder))?)
    }

    async fn run(&self, context: Context<'_, Yerc>) -> Result<CallReport> {
        let Context { link, screen, .. } = context;
        let mut settings = CheckSettings::load(None)?;
        settings.master.extend(SelectedJob::ask(link).await?.name(link.encoding));
        let set = jobs_of(link, screen).await?;
        self.tree(set, link.encoding, &settings)
    }
}

impl Calls {
    fn tree(&self, set: ProgramSet, encoding: Encoding, settings: &CheckSettings) -> Result<CallReport> {
        let programs = parse(&set, encoding);
        let names = programs.iter().map(|program| program.name.as_str());
        let root = self.name.as_deref().map(super::without_suffix);
        check_names(root.map(ToOwned::to_owned).as_slice(), names.clone())?;
        let masters: Vec<&str> = names.filter(|name| settings.is_master(name)).collect();
        Ok(CallReport::new(&programs, root, &masters, set.unread))
    }
}
