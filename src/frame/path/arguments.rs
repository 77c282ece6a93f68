//! Arguments of a command that draws a motion.

use std::marker::PhantomData;

use super::report::PathReport;
use super::{Drawing, html, svg};
use crate::command_set::CommandSet;
use crate::local_names::Target;
use crate::prelude::basics::*;
use crate::text_files;
use crate::{AnyCommand, Command, SchemaEntry, ValueKind};

/// A plane of a picture on the terminal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Plane {
    /// From above
    Xy,
    /// From the front
    Xz,
    /// From the side
    Yz,
}

impl Plane {
    /// All planes.
    pub const ALL: [Self; 3] = [Self::Xy, Self::Xz, Self::Yz];

    /// Indexes of the horizontal and of the vertical axis.
    pub const fn axes(self) -> (usize, usize) {
        match self {
            Self::Xy => (0, 1),
            Self::Xz => (0, 2),
            Self::Yz => (1, 2),
        }
    }
}

/// Options of a picture.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Picture of the motion")]
pub struct PathOptions {
    /// Draw the motion: a picture on the terminal, and each step with its line
    #[arg(long)]
    path: bool,
    /// Draw only this plane on the terminal [default: each plane in which the robot moves]
    #[arg(long, value_name = "PLANE", requires = "path")]
    plane: Option<Plane>,
    /// Also write the picture to an SVG file
    #[arg(long, value_name = "FILE", requires = "path")]
    svg: Option<PathBuf>,
    /// Also write a page with the picture and a slider through time. The page needs no network
    #[arg(long, value_name = "FILE", requires = "path")]
    html: Option<PathBuf>,
    /// Draw over the motion in this backup, and report which positions differ
    #[arg(long, value_name = "FOLDER", requires = "path", add = ValueKind::Backup)]
    pub compare: Option<PathBuf>,
    /// Read from this backup. Needs no robot
    #[arg(long, value_name = "FOLDER", requires = "path", add = ValueKind::Backup)]
    pub from: Option<PathBuf>,
    /// Replace the files of --svg and --html if they exist
    #[arg(long, requires = "path")]
    force: bool,
}

impl PathOptions {
    /// Checks the files to write, before anything is sent. With `several` robots, files are not possible.
    ///
    /// # Errors
    /// A file exists, or cannot be used.
    pub fn check(&self, several: bool) -> Result<()> {
        [&self.svg, &self.html].into_iter().try_for_each(|file| self.target(file.as_deref(), several).map(drop))
    }

    fn target(&self, file: Option<&Path>, several: bool) -> Result<Option<Target>> {
        text_files::target(file, self.force, several)
    }

    /// Writes the files, and returns the report of a drawing.
    ///
    /// # Errors
    /// There is nothing to draw, or a file cannot be written.
    pub fn report(&self, drawing: Drawing) -> Result<PathReport> {
        let mut files = Vec::new();
        if let Some(target) = self.target(self.svg.as_deref(), false)? {
            files.push(text_files::write(&target, &svg::document(&drawing))?);
        }
        if let Some(target) = self.target(self.html.as_deref(), false)? {
            files.push(text_files::write(&target, &html::page(&drawing))?);
        }
        Ok(PathReport::new(drawing, self.plane, files))
    }
}

/// A command with the option `--path`. With it, the command `P` runs, which has its own report.
#[derive(Debug, Args)]
pub struct Drawable<C: Args, P: Send + Sync> {
    #[command(flatten)]
    command: C,
    #[command(flatten)]
    options: PathOptions,
    #[arg(skip)]
    drawing: PhantomData<P>,
}

impl<C, P> CommandSet for Drawable<C, P>
where
    C: Command + Args + 'static,
    P: Command<Report = PathReport> + From<(C, PathOptions)> + Send + Sync + 'static,
{
    fn lay_out(command: clap::Command, _is_named: &dyn Fn(&str) -> bool) -> clap::Command {
        <Self as Args>::augment_args(command)
    }

    fn command(self) -> Box<dyn AnyCommand> {
        let Self { command, options, .. } = self;
        if options.path { Box::new(P::from((command, options))) } else { Box::new(command) }
    }

    fn schemas() -> Vec<SchemaEntry> {
        vec![SchemaEntry::of::<C::Report>(C::ID), SchemaEntry::of::<PathReport>(P::ID)]
    }
}
