//! Report of a drawn motion.

use super::model::{Difference, Drawing, Interpolation, Motion, NotDrawn};
use super::{Plane, terminal};
use crate::prelude::basics::*;

/// Maximum number of steps, and of lines that are not drawn, that are listed for people.
const MAX_LISTED: usize = 30;
const MAX_OMISSIONS: usize = 20;
/// Maximum number of axes in the list of steps.
const MAX_AXES: usize = 6;

/// Motion of a program, with its picture.
#[derive(Debug, Serialize, JsonSchema)]
pub struct PathReport {
    /// Name of the program.
    program: String,
    /// Frame of the coordinates with its tool; `joint` if there are only axes.
    frame: String,
    /// Names of the axes.
    axes: Vec<&'static str>,
    /// Unit of the coordinates.
    unit: &'static str,
    /// Duration of the motion; null if a duration is not known. The steps then take the same time in pictures.
    duration_s: Option<f64>,
    /// Steps that are drawn.
    steps: Vec<DrawnStep>,
    /// Lines that are not drawn.
    not_drawn: Vec<NotDrawn>,
    /// Difference to the older motion; null without one.
    difference: Option<Difference>,
    /// Files that were written.
    files: Vec<String>,
    #[serde(skip)]
    picture: Vec<Vec<Cell>>,
    #[serde(skip)]
    notes: Vec<String>,
    #[serde(skip)]
    omissions: Vec<String>,
    #[serde(skip)]
    noun: &'static str,
}

/// A step of a motion.
#[derive(Debug, Serialize, JsonSchema)]
struct DrawnStep {
    /// Name of the target.
    name: String,
    /// Line of the program, from 1; the number of the point if there is no program.
    line: usize,
    /// Text of the line.
    text: String,
    /// How the robot gets to the target.
    interpolation: Interpolation,
    /// Time of the target; null if the times are not known.
    time_s: Option<f64>,
    /// Coordinates of the target, in the order of the axes.
    target: Vec<f64>,
}

impl PathReport {
    /// Report of a drawing. The picture for the terminal has only one plane, if the user selected one.
    pub fn new(drawing: Drawing, plane: Option<Plane>, files: Vec<String>) -> Self {
        let picture = terminal::picture(&drawing, plane);
        let (notes, omissions, noun) = (notes(&drawing), omissions(&drawing.motion), drawing.motion.noun());
        let Drawing { motion, difference, .. } = drawing;
        let (is_timed, end) = (motion.is_timed, motion.end());
        let steps = motion.steps.into_iter().map(|step| DrawnStep {
            time_s: step.track.last().map(|moment| moment.time).filter(|_| is_timed),
            target: step.target().unwrap_or_default().to_vec(),
            name: step.name,
            line: step.line,
            text: step.text,
            interpolation: step.interpolation,
        });
        Self {
            program: motion.program,
            frame: motion.frame,
            axes: motion.axes,
            unit: motion.unit,
            duration_s: is_timed.then_some(end),
            steps: steps.collect(),
            not_drawn: motion.not_drawn,
            difference,
            files,
            picture,
            notes,
            omissions,
            noun,
        }
    }

    fn table(&self) -> Section {
        let mut columns = vec!["#", self.noun, "text"];
        columns.extend(self.duration_s.map(|_| "time (s)"));
        let decimals = if self.unit == "mm" { 2 } else { 0 };
        let shown = self.axes.len().min(MAX_AXES);
        columns.extend(&self.axes[..shown]);
        let rows = self.steps.iter().take(MAX_LISTED).zip(1_usize..).map(|(step, number)| {
            let mut row = vec![Cell::from(number), Cell::from(step.line), Cell::from(step.text.as_str())];
            row.extend(step.time_s.map(|time| Cell::number(format!("{time:.2}"))));
            row.extend(step.target.iter().take(shown).map(|value| Cell::number(format!("{value:.decimals$}"))));
            row
        });
        Section::Table(Table { columns, rows: rows.collect(), empty: "no line of the program can be drawn" })
    }
}

impl Report for PathReport {
    const ROWS: RowsOf = RowsOf::List("steps");

    fn view(&self) -> View {
        let mut view = View::default();
        if !self.picture.is_empty() {
            view = view.append(Section::Picture(self.picture.clone()));
        }
        view = view.append(self.table());
        let mut lines: Vec<Cell> = Vec::new();
        if let Some(more) = self.steps.len().checked_sub(MAX_LISTED).filter(|more| *more > 0) {
            lines.push(format!("{more} more steps: see --json, --svg or --html").into());
        }
        lines.extend(self.notes.iter().map(|note| note.as_str().into()));
        lines.extend(self.omissions.iter().map(|one| Cell::from(one.as_str()).tone(Tone::Warning)));
        lines.extend(self.files.iter().map(|file| format!("written: {file}").into()));
        view.append(Section::Lines(lines))
    }
}

/// Sentences below a picture: the difference, what the times are, and what the program assumes.
pub fn notes(drawing: &Drawing) -> Vec<String> {
    let Drawing { motion, difference, .. } = drawing;
    let mut notes: Vec<String> = difference.iter().map(Difference::in_a_line).collect();
    if !motion.is_timed && !motion.is_points && !motion.steps.is_empty() {
        notes.push("The times are not known: each step takes the same time.".to_owned());
    }
    notes.extend(motion.notes.iter().cloned());
    notes
}

/// Sentences about the lines that are not drawn.
pub fn omissions(motion: &Motion) -> Vec<String> {
    let sentence = |one: &NotDrawn| format!("Not drawn: {} {}, {}: {}", motion.noun(), one.line, one.text, one.reason);
    let mut sentences: Vec<String> = motion.not_drawn.iter().take(MAX_OMISSIONS).map(sentence).collect();
    let more = motion.not_drawn.len().checked_sub(MAX_OMISSIONS).filter(|more| *more > 0);
    sentences.extend(more.map(|more| format!("Not drawn: {more} more, see --json")));
    sentences
}

impl Difference {
    /// Describes the difference in a sentence.
    pub fn in_a_line(&self) -> String {
        if !self.is_same_frame {
            return "The old positions have another frame, and are not compared.".to_owned();
        }
        let list = |names: &[String]| match names {
            [first @ .., last] if names.len() <= 5 && !first.is_empty() => format!("{} and {last}", first.join(", ")),
            [one] => one.clone(),
            names => format!("{} and {} more", names[..4].join(", "), names.len() - 4),
        };
        let mut parts = vec![match (self.changed.len(), self.compared) {
            (0, 1) => "The position is the same".to_owned(),
            (0, all) => format!("All {all} positions are the same"),
            (changed, all) => format!("{changed} of {all} positions differ ({})", list(&self.changed)),
        }];
        if !self.changed.is_empty() {
            let decimals = if self.unit == "mm" { 3 } else { 0 };
            let rotation = format!(", and by {:.3} in the other axes", self.maximum_rotation);
            let rotation = if self.maximum_rotation > 0.0 { rotation } else { String::new() };
            parts.push(format!("by {:.decimals$} {} at most{rotation}", self.maximum, self.unit));
        }
        for (names, what) in [(&self.added, "new"), (&self.removed, "removed")] {
            parts.extend((!names.is_empty()).then(|| format!("{what}: {}", list(names))));
        }
        format!("{}.", parts.join(", "))
    }
}
