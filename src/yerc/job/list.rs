//! `yerc job list`.

use crate::file::{LISTS, ReportedName, list, plan_all};
use crate::prelude::*;
use crate::selected_job::SelectedJob;
use armctl_controller::yerc::files;

/// Lists the jobs of the controller (FS and DX 3.4.4), and marks the selected job.
#[derive(Debug, Args)]
pub struct List {}

impl Command for List {
    type Family = Yerc;
    type Report = Listing;
    const ID: &'static str = "yerc.job.list";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Listing> {
        let Context { link, screen, .. } = context;
        let selected = SelectedJob::ask(link).await?;
        if link.is_dry_run() {
            plan_all(link, LISTS, [files::list(FileType::Jbi)])?;
            return Ok(Listing::default());
        }
        let _looking = screen.spinner("looking for jobs");
        let jobs = list(link, FileType::Jbi).await?.into_iter().map(|file| {
            let name = super::stem(&file);
            Listed { name: ReportedName::new(link.encoding, name), selected: selected.is(name) }
        });
        Ok(Listing { jobs: jobs.collect() })
    }
}

/// Jobs on a controller.
#[derive(Debug, Default, Serialize, JsonSchema)]
pub struct Listing {
    /// Jobs in the order of the controller.
    jobs: Vec<Listed>,
}

/// A job.
#[derive(Debug, Serialize, JsonSchema)]
struct Listed {
    /// Job name without `.JBI`.
    #[serde(flatten)]
    name: ReportedName,
    /// Whether this job is selected, so that a start runs it.
    selected: bool,
}

impl Report for Listing {
    fn view(&self) -> View {
        let mut table = Table::new(&["job", "selected"], "no jobs");
        for Listed { name, selected } in &self.jobs {
            table.row([name.name.as_str().into(), Cell::from(if *selected { "yes" } else { "" })]);
        }
        View::table(table)
    }
}
