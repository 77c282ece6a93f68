//! `yrcx backup`.

use std::ops::Range;

use super::content::{self, Controller, Text};
use super::parts::{Part, THOUSAND};
use crate::data::PointSheet;
use crate::prelude::*;
use armctl_frame::backup::arguments::BackupOptions;
use armctl_frame::backup::manifest::{Entry, LeftOut};
use armctl_frame::backup::save::{self, BackupWriter, Task, interrupted_failure};
use armctl_frame::backup::{BackupReport, Only, SaveOptions};
use armctl_frame::robot::file::{FileItem, State};
use armctl_frame::store::{self, Store as _};

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
    /// Points to save (0 to 29999), for example 0..999 or 0..99,500
    #[arg(long, value_name = "POINT", value_delimiter = ',', value_parser = points)]
    points: Vec<String>,
}

/// Checks the points that the user typed, and returns the text unchanged.
pub fn points(text: &str) -> Result<String, String> {
    PointSheet::keys(text).map(|_| text.to_owned())
}

/// Prefix that marks a selection of points in the scope of a backup.
const OF_POINTS: &str = "points ";

impl Command for Backup {
    type Family = Yrcx;
    type Report = BackupReport;
    const ID: &'static str = "yrcx.backup";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<BackupReport> {
        let points = self.points.iter().map(|range| format!("{OF_POINTS}{range}"));
        back_up(context, self.options.making(points)).await
    }
}

/// Makes a backup.
pub async fn back_up(context: Context<'_, Yrcx>, making: SaveOptions) -> Result<BackupReport> {
    let Context { link, screen, robot, several, .. } = context;
    link.reject_unit("a backup contains the whole controller")?;
    let task = Task::new(making, robot, several)?;
    let selection = Selection::of(&task.scope)?;
    if link.is_dry_run() {
        return dry_run(link, screen, &selection).await;
    }
    interrupted_failure(&task.folder, Box::pin(save(link, (screen, robot), &task, selection))).await
}

/// Selected parts and points.
struct Selection {
    only: Only,
    /// Selected points; `None` means that armctl reads points until it finds a gap.
    points: Option<BTreeSet<i32>>,
}

impl Selection {
    fn of(scope: &[String]) -> Result<Self> {
        let ranges = scope.iter().filter_map(|word| word.strip_prefix(OF_POINTS));
        let ranges = ranges.map(PointSheet::keys).collect::<Result<Vec<_>, _>>().map_err(Failure::usage)?;
        let points = (!ranges.is_empty()).then(|| ranges.concat().into_iter().collect());
        let only = Only::of_scope(scope);
        only.check(&Part::all().flat_map(Part::names).collect::<Vec<_>>())?;
        Ok(Self { only, points })
    }

    fn has(&self, part: Part) -> bool {
        self.only.has_any(&part.names())
    }
}

async fn dry_run(link: &mut Link, screen: &Screen, selection: &Selection) -> Result<BackupReport> {
    Controller::plan(link)?;
    let parts = Part::without_points(1..=4).chain([Part::Points(0)]);
    for part in parts.filter(|part| selection.has(*part)) {
        content::plan(link, screen, part, selection.points.as_ref()).await?;
    }
    Err(unknown())
}

async fn save(
    link: &mut Link,
    (screen, robot): (&Screen, &Robot),
    task: &Task<Controller>,
    selection: Selection,
) -> Result<BackupReport> {
    let controller = Controller::ask(link).await?;
    let robots = controller.robots.clone();
    let list = task.begin((screen, robot), controller.clone(), |earlier, _| earlier.controller.robots == robots)?;
    let numbers = robots.iter().map(|robot| robot.robot);
    let parts: Vec<Part> = Part::without_points(numbers).filter(|part| selection.has(*part)).collect();
    let mut reading = Reading { link, screen, task, controller, selection, list };
    let goes_on = reading.all(&parts).await?;
    let Reading { selection, mut list, .. } = reading;
    let tried: Vec<String> = list.files().iter().map(|file| file.name.clone()).collect();
    let rest = parts.into_iter().chain(Some(Part::Points(0)).filter(|part| selection.has(*part))).filter(|_| !goes_on);
    let rest = rest.filter(|part| !tried.contains(&part.to_string()));
    // The refusals of a file that was kept are only in the manifest, and not in the report.
    let kept = list.files().iter_mut().filter(|file| file.more.state == State::Kept);
    kept.for_each(|file| file.more.left_out.clear());
    list.end(rest.map(FileItem::pending))
}

/// Reads a backup into its folder.
struct Reading<'a> {
    link: &'a mut Link,
    screen: &'a Screen,
    task: &'a Task<Controller>,
    controller: Controller,
    selection: Selection,
    list: BackupWriter<'a, Controller>,
}

impl Reading<'_> {
    /// Reads these parts, then the points; `false` if the work ended early.
    async fn all(&mut self, parts: &[Part]) -> Result<bool> {
        for part in parts {
            let Self { link, screen, controller, list, .. } = self;
            let read = async {
                let table = content::read(link, screen, *part, controller).await?;
                Ok(saved(*part, Text { table, points: None }))
            };
            if !list.part(entry(*part), read).await? {
                return Ok(false);
            }
        }
        let folder = self.task.folder.as_path();
        let of_pallets =
            if self.is_saved(Part::Pallets) { content::points_of_pallets(folder)? } else { BTreeSet::new() };
        let mut gap = 0;
        for thousand in 0..30 {
            let part = Part::Points(thousand);
            let first = i32::from(thousand * THOUSAND);
            let within = first..first + i32::from(THOUSAND);
            let is_open = self.selection.points.is_none() && gap < MAX_UNDEFINED_RUN;
            let given = self.selection.points.as_ref().map(|points| points.range(within.clone()).copied().collect());
            let given: Vec<i32> = given.unwrap_or_else(|| if is_open { within.clone().collect() } else { Vec::new() });
            let always: BTreeSet<i32> = of_pallets.range(within.clone()).copied().collect();
            let numbers: BTreeSet<i32> = given.into_iter().chain(always.iter().copied()).collect();
            if numbers.is_empty() || !self.selection.has(part) {
                continue;
            }
            let numbers: Vec<i32> = numbers.into_iter().collect();
            let Self { link, screen, list, .. } = self;
            let read = async {
                let text = content::read_points(link, screen, &numbers, &always, is_open.then_some(gap)).await?;
                Ok(saved(part, text))
            };
            if !list.part(entry(part), read).await? {
                return Ok(false);
            }
            let defined = if self.is_saved(part) { content::defined(part, folder)? } else { Vec::new() };
            gap = gap_after(gap, within, &defined);
        }
        if self.selection.points.is_none() && gap >= MAX_UNDEFINED_RUN {
            self.screen.note(&format!(
                "{}: the search for points ended after {MAX_UNDEFINED_RUN} undefined points in a row; use --points \
                 0..29999 to read all points",
                self.link.label
            ));
        }
        Ok(true)
    }

    fn is_saved(&self, part: Part) -> bool {
        self.list.entry(&part.to_string()).is_some_and(|entry| entry.copy.is_some())
    }
}

fn entry(part: Part) -> Entry {
    Entry { name: part.to_string(), holds: part.kind().to_owned(), ..Entry::default() }
}

/// A part that was read, for the manifest.
fn saved(part: Part, Text { table, points }: Text) -> save::SavedPart {
    let rows = table.text.lines().count().saturating_sub(1);
    let of_rows = |rows: Vec<store::LeftOut>| rows.into_iter().map(LeftOut::from).collect();
    save::SavedPart {
        holds: points.as_ref().map(|points| format!("{} {points}", part.kind())),
        notes: points.map(|points| format!("{rows} defined in {points}")).into_iter().collect(),
        content: save::Content::Text(part.file(), table.text),
        left_out: of_rows(table.left_out),
        is_absent: of_rows(table.undefined),
    }
}

/// Number of consecutive undefined points that ends the search, if the user gives no range.
pub const MAX_UNDEFINED_RUN: usize = 100;

/// Counts the consecutive undefined points at the end of a range. `gap` is the number of undefined points directly
/// before the range. Returns at least [`MAX_UNDEFINED_RUN`] if so many undefined points were found in a row inside the range.
pub fn gap_after(gap: usize, within: Range<i32>, defined: &[i32]) -> usize {
    let mut next = within.start;
    let mut gap = gap;
    for number in defined {
        gap += usize::try_from(number - next).unwrap_or(0);
        if gap >= MAX_UNDEFINED_RUN {
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
    fn gap_continues_across_ranges() {
        assert_eq!(gap_after(0, 0..1000, &[]), 1000);
        assert_eq!(gap_after(0, 0..300, &[0, 100, 200, 250]), 49);
        assert_eq!(gap_after(49, 300..400, &[351]), 100, "it ended before 351, which a pallet named");
        assert_eq!(gap_after(49, 300..400, &[350]), 49);
    }
}
