//! `yrcx backup`.

use std::collections::BTreeSet;
use std::ops::Range;

use clap::Args;

use super::content::{self, Controller, GAP, Text, Wanted};
use super::parts::{POINTS, Part, THOUSAND};
use crate::command::backup::arguments::BackupOptions;
use crate::command::backup::manifest::Entry;
use crate::command::backup::save::{self, BackupWriter, Task, interrupted_failure};
use crate::command::backup::{BackedUp, Only, SaveOptions};
use crate::command::frame::dry_run::unknown;
use crate::command::robot::file::{FileItem, State};
use crate::command::yrcx::link::Link;
use crate::command::yrcx::link::Yrcx;
use crate::command::yrcx::numbers::{Numbers, runs};
use crate::command::{Command, Context};
use crate::failure::Failure;
use crate::output::Screen;
use crate::settings::Robot;

/// Saves points, pallets, shifts, hands, variables and parameters in a folder of text files.
#[derive(Debug, Args)]
#[command(after_help = "Remote commands cannot read programs. Save programs with the controller's own tools.\n\nEach \
                        point takes one remote command: 60 ms or more at an RPI of 20 ms. Without --points, armctl \
                        reads points from 0 until 100 consecutive points are not defined. armctl always reads the \
                        points of pallets. manifest.json lists the points that were read. A controller refuses \
                        undefined points, and may record the refusal in its alarm history.")]
pub struct Backup {
    #[command(flatten)]
    options: BackupOptions,
    /// Points, 0 to 29999: 0..999 or 0..99,500
    #[arg(long, value_name = "POINT", value_delimiter = ',', value_parser = points)]
    points: Vec<String>,
}

/// Points to read, as typed.
pub fn points(text: &str) -> Result<String, String> {
    POINTS.parse(text).map(|_| text.to_owned())
}

/// Prefix of the points in the scope of a backup.
const OF_POINTS: &str = "points ";

impl Command for Backup {
    type Family = Yrcx;
    type Report = BackedUp;
    const ID: &'static str = "yrcx.backup";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<BackedUp, Failure> {
        let points = self.points.iter().map(|range| format!("{OF_POINTS}{range}"));
        back_up(context, self.options.making(points)).await
    }
}

/// Makes a backup.
pub async fn back_up(context: Context<'_, Yrcx>, making: SaveOptions) -> Result<BackedUp, Failure> {
    let Context { link, screen, robot, several, .. } = context;
    link.no_unit("a backup contains the whole controller")?;
    let task = Task::new(making, robot, several)?;
    let asked = Asked::of(&task.scope)?;
    if link.is_dry() {
        return dry_run(link, &asked);
    }
    interrupted_failure(&task.folder, Box::pin(save(link, (screen, robot), &task, asked))).await
}

/// Requested points.
struct Asked {
    only: Only,
    /// Selected points; `None` searches until a gap.
    points: Option<BTreeSet<i32>>,
}

impl Asked {
    fn of(scope: &[String]) -> Result<Self, Failure> {
        let ranges = scope.iter().filter_map(|word| word.strip_prefix(OF_POINTS));
        let ranges = ranges.map(|range| POINTS.parse(range)).collect::<Result<Vec<Numbers>, _>>();
        let ranges = ranges.map_err(Failure::usage)?;
        let points = Some(Numbers::of(&ranges).into_iter().collect()).filter(|_| !ranges.is_empty());
        let only = Only::of_scope(scope);
        let names: Vec<String> = Part::all().map(|part| part.to_string()).collect();
        only.check(&names)?;
        Ok(Self { only, points })
    }

    fn has(&self, part: Part) -> bool {
        self.only.has(&part.to_string())
    }
}

fn dry_run(link: &mut Link, asked: &Asked) -> Result<BackedUp, Failure> {
    Controller::plan(link)?;
    let parts = Part::single().into_iter().chain([Part::Points(0)]);
    for part in parts.filter(|part| asked.has(*part)) {
        content::plan(link, part, asked.points.as_ref())?;
    }
    Err(unknown())
}

async fn save(
    link: &mut Link,
    (screen, robot): (&Screen, &Robot),
    task: &Task<Controller>,
    asked: Asked,
) -> Result<BackedUp, Failure> {
    let controller = Controller::ask(link).await?;
    let robots = controller.robots.clone();
    let list = task.begin((screen, robot), controller.clone(), |earlier, _| earlier.controller.robots == robots)?;
    let mut reading = Reading { link, screen, task, controller, asked, list };
    let goes_on = reading.all().await?;
    let Reading { asked, mut list, .. } = reading;
    let tried: Vec<String> = list.files().iter().map(|file| file.name.clone()).collect();
    let rest = Part::single().into_iter().chain([Part::Points(0), Part::Comments(0)]).filter(|_| !goes_on);
    let rest = rest.filter(|part| asked.has(*part) && !tried.contains(&part.to_string()));
    // Refusals appear only in the manifest.
    let kept = list.files().iter_mut().filter(|file| file.more.state == State::Kept);
    kept.for_each(|file| file.more.left_out.clear());
    list.end(rest.map(FileItem::pending))
}

/// A backup in progress.
struct Reading<'a> {
    link: &'a mut Link,
    screen: &'a Screen,
    task: &'a Task<Controller>,
    controller: Controller,
    asked: Asked,
    list: BackupWriter<'a, Controller>,
}

impl Reading<'_> {
    /// Reads all parts; `false` if the work ended early.
    async fn all(&mut self) -> Result<bool, Failure> {
        for part in Part::single() {
            if self.asked.has(part) && !self.part(part, None).await? {
                return Ok(false);
            }
        }
        let folder = self.task.folder.as_path();
        let pallets = Part::Records(&super::parts::PALLETS);
        let of_pallets =
            if self.is_saved(pallets) { content::points_of_pallets(pallets, folder)? } else { BTreeSet::new() };
        let mut gap = 0;
        for thousand in 0..30 {
            let part = Part::Points(thousand);
            let first = i32::from(thousand * THOUSAND);
            let within = first..first + i32::from(THOUSAND);
            let is_open = self.asked.points.is_none() && gap < GAP;
            let given = self.asked.points.as_ref().map(|points| points.range(within.clone()).copied().collect());
            let given: Vec<i32> = given.unwrap_or_else(|| if is_open { within.clone().collect() } else { Vec::new() });
            let always: BTreeSet<i32> = of_pallets.range(within.clone()).copied().collect();
            let numbers: BTreeSet<i32> = given.into_iter().chain(always.iter().copied()).collect();
            if numbers.is_empty() {
                continue;
            }
            if self.asked.has(part) {
                let numbers = numbers.into_iter().collect();
                let wanted = Wanted { numbers, always, gap: is_open.then_some(GAP), gap_before: gap };
                if !self.part(part, Some(wanted)).await? {
                    return Ok(false);
                }
            }
            let defined = if self.is_saved(part) { content::defined(part, folder)? } else { Vec::new() };
            gap = gap_after(gap, within, &defined);
            let comments = Part::Comments(thousand);
            let is_wanted = !defined.is_empty() && self.asked.has(comments);
            if is_wanted && !self.part(comments, Some(Wanted::all(defined))).await? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    fn is_saved(&self, part: Part) -> bool {
        self.list.entry(&part.to_string()).is_some_and(|entry| entry.copy.is_some())
    }

    /// Reads a part into its file, unless the file exists; `false` if the next part cannot be read.
    async fn part(&mut self, part: Part, wanted: Option<Wanted>) -> Result<bool, Failure> {
        let Self { link, screen, controller, list, .. } = self;
        let entry = Entry { name: part.to_string(), holds: part.kind().to_owned(), ..Entry::default() };
        let read = async {
            let text = read(link, screen, controller, part, wanted).await?;
            let notes = match part {
                Part::Points(_) => {
                    vec![format!("{} defined in {}", text.text.lines().count() - 1, runs(&text.numbers))]
                }
                _ => Vec::new(),
            };
            let (holds, absent) = (Some(text.holds(part)), text.refusals());
            let Text { text, left_out, .. } = text;
            Ok(save::SavedPart {
                content: save::Content::Text(part.file(), text),
                holds,
                left_out,
                is_absent: absent,
                notes,
            })
        };
        list.part(entry, read).await
    }
}

async fn read(
    link: &mut Link,
    screen: &Screen,
    controller: &Controller,
    part: Part,
    wanted: Option<Wanted>,
) -> Result<Text, Failure> {
    let Some(records) = part.records() else {
        return content::read(link, screen, part, controller).await;
    };
    let wanted = match wanted {
        Some(wanted) => wanted,
        None => Wanted::all(records.all()?),
    };
    content::read_records(link, screen, records, &wanted).await
}

/// Number of consecutive undefined points at the end of a range, with `gap` before it; at least [`GAP`] if that many
/// occurred inside the range.
fn gap_after(gap: usize, within: Range<i32>, defined: &[i32]) -> usize {
    let mut next = within.start;
    let mut gap = gap;
    for number in defined {
        gap += usize::try_from(number - next).unwrap_or(0);
        if gap >= GAP {
            return gap;
        }
        (gap, next) = (0, number + 1);
    }
    gap + usize::try_from(within.end - next).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_goes_on_from_range_to_range() {
        assert_eq!(gap_after(0, 0..1000, &[]), 1000);
        assert_eq!(gap_after(0, 0..300, &[0, 100, 200, 250]), 49);
        assert_eq!(gap_after(49, 300..400, &[351]), 100, "it ended before 351, which a pallet named");
        assert_eq!(gap_after(49, 300..400, &[350]), 49);
    }
}
