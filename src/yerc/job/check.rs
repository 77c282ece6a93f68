//! `yerc job check`.

use super::programs::{JobSource, jobs_in, jobs_of, parse};
use crate::prelude::*;
use armctl_frame::programs::check::{CheckArguments, CheckContext, check};
use armctl_frame::programs::settings;
use armctl_frame::programs::source::{ProgramSet, check_names};
use armctl_frame::programs::verdict::{self, FileVerdict, Summary};

/// Check jobs without running them: labels, calls, positions, variables, speeds.
#[derive(Debug, Args)]
#[command(after_help = help())]
pub struct Check {
    /// Show only the findings of these jobs. armctl reads all jobs, because jobs depend on each other
    #[arg(add = complete::JOB)]
    names: Vec<String>,
    #[command(flatten)]
    source: JobSource,
    #[command(flatten)]
    limits: CheckArguments,
}

fn help() -> String {
    format!(
        "An error is something that a controller refuses, or at which it stops; the exit code is then 8. A warning is \
         suspicious. V= is compared in mm/s, the unit in the factory state.\n\n{}",
        settings::help()
    )
}

impl Command for Check {
    type Family = Yerc;
    type Report = Verdict;
    const ID: &'static str = "yerc.job.check";

    fn takes_robot(&self) -> bool {
        self.source.from.is_none()
    }

    fn run_alone(&self) -> Result<Verdict> {
        let (folder, set, encoding) = self.source.folder()?;
        self.check(set, encoding, self.limits.settings(Some(folder))?)
    }

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Verdict> {
        let Context { link, screen, .. } = context;
        let settings = self.limits.settings(None)?;
        let set = jobs_of(link, screen).await?;
        self.check(set, link.encoding, settings)
    }
}

impl Check {
    fn check(&self, set: ProgramSet, encoding: Encoding, settings: settings::CheckSettings) -> Result<Verdict> {
        let mut programs = parse(&set, encoding);
        let selected: Vec<String> = self.names.iter().map(|name| super::without_suffix(name).to_owned()).collect();
        check_names(&selected, programs.iter().map(|program| program.name.as_str()))?;
        let other = self.limits.compare.as_deref().map(jobs_in).transpose()?;
        let compare = other.map(|(set, encoding)| parse(&set, encoding));
        let context =
            CheckContext { settings, unread: set.unread, is_partial: set.is_partial, is_loose: set.is_loose, compare };
        check(&mut programs, &context);
        programs.retain(|program| selected.is_empty() || selected.contains(&program.name));
        let verdicts = programs.iter().map(|program| {
            let steps = program.lines.iter().filter(|line| !line.references.is_empty()).count();
            let contents = Contents { instruction_count: steps, position_count: program.positions.len() };
            FileVerdict::new(program, contents)
        });
        Ok(Verdict::new(verdicts.collect(), context.unread, self.limits.strict))
    }
}

/// Verdict of a check.
pub type Verdict = verdict::Verdict<Contents>;

/// What a job contains.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "JobVerdict")]
pub struct Contents {
    /// Number of instructions, without comments and labels.
    instruction_count: usize,
    position_count: usize,
}

impl Summary for Contents {
    fn counts(&self) -> Vec<(usize, &'static str)> {
        vec![(self.instruction_count, "instruction"), (self.position_count, "position")]
    }
}
