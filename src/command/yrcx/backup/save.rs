//! `yrcx backup`.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::{Path, PathBuf};

use clap::Args;

use super::content::{self, Controller, GAP, Text, Wanted};
use super::parts::{POINTS, Part, THOUSAND};
use crate::command::backup::manifest;
use crate::command::backup::manifest::{Entry, Reason, State};
use crate::command::backup::{BackedUp, Item, Items, Making, Only, cut_off, write_text};
use crate::command::frame::dry_run::unknown;
use crate::command::frame::interrupt::interruptible;
use crate::command::frame::local::{make_folder, own_folder};
use crate::command::yrcx::link::Link;
use crate::command::yrcx::link::Yrcx;
use crate::command::yrcx::numbers::{Numbers, runs};
use crate::command::{Command, Context};
use crate::failure::{Failure, Kind};
use crate::output::Screen;
use crate::settings::Robot;

/// Saves points, pallets, shifts, hands, variables, parameters in a folder of text files.
#[derive(Debug, Args)]
#[command(after_help = "Programs are out of reach of remote commands: keep them with the controller's own tools.\n\n\
                  A point takes as long as a remote command: 60 ms and more at an RPI of 20 ms. Without --points they \
                  are read from 0 on until 100 in a row are not defined; besides, the points of pallets. manifest.json \
                  says which were read. A controller refuses what is not defined, and may note that in its history of \
                  alarms.")]
pub struct Backup {
    /// Folder, made if it is not there
    folder: PathBuf,
    /// Points, 0 to 29999: 0..999 or 0..99,500
    #[arg(long, value_name = "POINT", value_delimiter = ',', value_parser = points)]
    points: Vec<String>,
    /// Parts whose names fit, such as variables or 'points*' (repeatable)
    #[arg(long, value_name = "PATTERN", value_delimiter = ',')]
    only: Vec<String>,
    /// Go on with a backup that is not whole; files that are there already are kept
    #[arg(long, conflicts_with = "force")]
    resume: bool,
    /// Make a new backup over the one in the folder
    #[arg(long)]
    force: bool,
    /// What is asked for, where that was said for all families
    #[arg(skip)]
    scope: Option<Vec<String>>,
}

/// Points that can be asked for, as typed.
pub fn points(text: &str) -> Result<String, String> {
    POINTS.parse(text).map(|_| text.to_owned())
}

/// Before numbers of points, in the scope of a backup.
const OF_POINTS: &str = "points ";

type Manifest = manifest::Manifest<Controller>;

impl Backup {
    /// Of what is asked for in any family.
    pub fn of(making: &Making) -> Self {
        let Making { folder, scope, resume, force } = making.clone();
        Self { folder, points: Vec::new(), only: Vec::new(), resume, force, scope }
    }

    /// What is asked for, as the list says it; `None` if nobody says.
    fn scope(&self) -> Option<Vec<String>> {
        if self.points.is_empty() && self.only.is_empty() {
            return self.scope.clone();
        }
        let points = self.points.iter().map(|range| format!("{OF_POINTS}{range}"));
        Some(points.chain(Only(self.only.clone()).scope()).collect())
    }
}

impl Command for Backup {
    type Family = Yrcx;
    type Report = BackedUp;
    const ID: &'static str = "yrcx.backup";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<BackedUp, Failure> {
        let Context { link, screen, robot, several, .. } = context;
        link.no_unit("a backup is of the whole controller")?;
        let folder = own_folder(&self.folder, &robot.name, several);
        let scope = self.scope();
        let earlier: Option<Manifest> = manifest::earlier(&folder, robot, scope.as_deref(), self.resume, self.force)?;
        let scope = scope.or_else(|| earlier.as_ref().map(|earlier| earlier.scope.clone())).unwrap_or_default();
        let asked = Asked::of(&scope)?;
        if link.is_dry() {
            return dry_run(link, &asked);
        }
        let saving = Saving { link, screen, folder: &folder, asked, items: Vec::new() };
        // The caller waits for Ctrl-C too, but asks this work first; so it ends here, with what was saved.
        let outcome = interruptible(saving.save(robot, scope, earlier)).await.and_then(|outcome| outcome);
        outcome.map_err(|failure| match manifest::read::<Controller>(&folder) {
            Ok(Some(list)) if failure.kind != Kind::Usage => {
                cut_off(failure, &folder, list.files.iter().filter(|entry| entry.copy.is_some()).count())
            }
            _ => failure,
        })
    }
}

/// What is asked for.
struct Asked {
    only: Only,
    /// These points; `None` for all up to a gap.
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

/// A backup under way.
struct Saving<'a> {
    link: &'a mut Link,
    screen: &'a Screen,
    folder: &'a Path,
    asked: Asked,
    items: Vec<Item>,
}

/// A part that was read, or was there already.
#[derive(PartialEq, Eq)]
enum Had {
    There,
    /// The next one can be tried.
    Failed,
    /// It cannot.
    End,
}

impl Saving<'_> {
    async fn save(mut self, robot: &Robot, scope: Vec<String>, earlier: Option<Manifest>) -> Result<BackedUp, Failure> {
        let controller = Controller::ask(self.link).await?;
        make_folder(self.folder)?;
        let mut manifest = Manifest::new(robot, controller, scope);
        // What was saved before stays in the list until it is saved anew, so that it is kept whenever this is cut off.
        let earlier = earlier.filter(|earlier| earlier.controller.robots == manifest.controller.robots);
        let is_there = |entry: &&Entry| entry.copy.as_ref().is_some_and(|copy| copy.check(self.folder).is_ok());
        manifest.files = earlier.iter().flat_map(|list| &list.files).filter(is_there).cloned().collect();
        manifest.write(self.folder)?;
        let goes_on = self.all(&mut manifest).await?;
        if !goes_on {
            let tried = |part: &Part| self.items.iter().any(|item| item.name == part.to_string());
            let rest = Part::single().into_iter().chain([Part::Points(0), Part::Comments(0)]);
            let rest = rest.filter(|part| self.asked.has(*part) && !tried(part)).map(Item::pending);
            self.items.extend(rest.collect::<Vec<_>>());
        }
        let items = Items::new(self.items);
        manifest.complete = items.is_complete();
        manifest.write(self.folder)?;
        Ok(BackedUp::new(self.folder, manifest.scope, manifest.complete, items))
    }

    /// Reads all parts; `false` if the work ended early.
    async fn all(&mut self, manifest: &mut Manifest) -> Result<bool, Failure> {
        for part in Part::single() {
            if self.asked.has(part) && self.part(manifest, part, None).await? == Had::End {
                return Ok(false);
            }
        }
        let pallets = Part::Records(&super::parts::PALLETS);
        let of_pallets = match manifest.entry(pallets.kind()).map(|entry| &entry.copy) {
            Some(Some(_)) => content::points_of_pallets(pallets, self.folder)?,
            _ => BTreeSet::new(),
        };
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
                if self.part(manifest, part, Some(wanted)).await? == Had::End {
                    return Ok(false);
                }
            }
            let is_saved = manifest.entry(&part.to_string()).is_some_and(|entry| entry.copy.is_some());
            let defined = if is_saved { content::defined(part, self.folder)? } else { Vec::new() };
            gap = gap_after(gap, within, &defined);
            let comments = Part::Comments(thousand);
            let is_wanted = !defined.is_empty() && self.asked.has(comments);
            if is_wanted && self.part(manifest, comments, Some(Wanted::all(defined))).await? == Had::End {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Reads a part into its file, unless it is there.
    async fn part(&mut self, manifest: &mut Manifest, part: Part, wanted: Option<Wanted>) -> Result<Had, Failure> {
        let mut item = Item::pending(part);
        if let Some(Entry { copy: Some(copy), .. }) = manifest.entry(&item.name) {
            item.saved(State::Kept, copy, &[]);
            self.items.push(item);
            return Ok(Had::There);
        }
        self.screen.step(&item.name);
        let read = self.read(&manifest.controller, part, wanted).await;
        let mut entry = Entry { name: item.name.clone(), holds: part.kind().to_owned(), ..Entry::default() };
        let had = match read {
            Ok(text) => {
                let copy = write_text(self.folder, part.file(), &text.text)?;
                item.saved(State::Done, &copy, &text.left_out);
                entry.holds = text.holds(part);
                entry.left_out = text.left_out.iter().cloned().chain(text.refusals()).collect();
                if let Part::Points(_) = part {
                    item.notes.push(format!("{} defined in {}", text.text.lines().count() - 1, runs(&text.numbers)));
                }
                entry.copy = Some(copy);
                Had::There
            }
            Err(failure) => {
                entry.error = Some(Reason::from(&failure));
                if item.fail(failure) { Had::Failed } else { Had::End }
            }
        };
        self.items.push(item);
        manifest.files.push(entry);
        manifest.write(self.folder)?;
        Ok(had)
    }

    async fn read(&mut self, controller: &Controller, part: Part, wanted: Option<Wanted>) -> Result<Text, Failure> {
        let Some(records) = part.records() else {
            return content::read(self.link, self.screen, part, controller).await;
        };
        let wanted = match wanted {
            Some(wanted) => wanted,
            None => Wanted::all(records.all()?),
        };
        content::read_records(self.link, self.screen, records, &wanted).await
    }
}

/// How many in a row are not defined at the end of a range, after `gap` before it; at least [`GAP`] if so many came in it.
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
