//! `yerc job search`.

use super::programs::{JobSource, jobs_of, parse};
use crate::prelude::*;
use armctl_controller::names::{Kind as NameKind, Name, NameMatch, Names};
use armctl_controller::yerc::job::names_of;
use armctl_controller::yerc::names::{FILES, read};
use armctl_frame::programs::search::{Matches, SearchArguments};
use armctl_frame::programs::source::ProgramSet;
use armctl_frame::text_files;

/// Find lines of jobs: a text, a variable, a signal, a position, or the calls of a job.
#[derive(Debug, Args)]
#[command(
    after_help = "PATTERN has the notation of grep: . * [] ^ $ are special, \\ makes them plain text, and upper and \
                  lower case differ without -i. With several conditions, a line must meet all of them. If nothing is \
                  found, the exit code is also 0.\n\n--uses accepts B5, P12, LB0, C1, OUT3, IN#(12), OG#(1), \
                  #10010, UF#(1), and a name of the robot. A signal is also found in its group: OUT3 in OG#(1). In a \
                  backup, the names come from its inventory entry and its name files (IONAME.DAT, VARNAME.DAT). \
                  An indirect variable or signal, such as B[I000], is found only by a text search.\n\nWithout --from, \
                  armctl reads every job of the controller first."
)]
pub struct Search {
    #[command(flatten)]
    search: SearchArguments,
    #[command(flatten)]
    source: JobSource,
}

impl Command for Search {
    type Family = Yerc;
    type Report = Matches;
    const ID: &'static str = "yerc.job.search";

    fn takes_robot(&self) -> bool {
        self.source.from.is_none()
    }

    fn run_alone(&self) -> Result<Matches> {
        let (folder, mut set, encoding) = self.source.folder()?;
        set.names.extend(names_in(folder, encoding));
        let names = Names::new(std::mem::take(&mut set.names));
        self.find(set, encoding, &names)
    }

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Matches> {
        let Context { link, screen, robot, .. } = context;
        let names = names::of_robot(robot, screen);
        // A wrong object is reported before the jobs are read.
        self.objects(names)?;
        let set = jobs_of(link, screen).await?;
        self.find(set, link.encoding, names)
    }
}

/// Kinds of names that instructions can refer to.
const KINDS: [NameKind; 2] = [NameKind::Variable, NameKind::Signal];

impl Search {
    fn find(&self, set: ProgramSet, encoding: Encoding, names: &Names) -> Result<Matches> {
        self.search.search(&parse(&set, encoding), &self.objects(names)?, set.unread)
    }

    /// Names in instructions of the object of `--uses`.
    fn objects(&self, names: &Names) -> Result<Vec<String>> {
        let Some(text) = &self.search.uses else { return Ok(Vec::new()) };
        let objects = names_of(text);
        if !objects.is_empty() {
            return Ok(objects);
        }
        match names.find(&KINDS, text) {
            NameMatch::One(name) => Ok(names_of(&name.address)),
            NameMatch::Several(several) => Ok(several.iter().flat_map(|name| names_of(&name.address)).collect()),
            NameMatch::None => {
                let near = nearest(text, names.iter().map(|name| name.name.as_str()));
                let near = near.map_or(String::new(), |near| format!("did you mean {near}? "));
                Err(Failure::usage(format!("'{text}' is neither an object of jobs nor a known name"))
                    .hint(format!("{near}use B5, P12, C1, OUT3, IN#(12) or #10010, or search for the text")))
            }
        }
    }
}

/// Names in the name files of a backup. A file that is missing or damaged has no names.
fn names_in(folder: &Path, encoding: Encoding) -> Vec<Name> {
    let names = |file: &str| -> Vec<Name> {
        let bytes = text_files::read(&folder.join(file)).unwrap_or_default();
        read(file, &bytes, encoding).map(|found| found.names).unwrap_or_default()
    };
    FILES.into_iter().flat_map(names).collect()
}
