//! Report of a benchmark.

use std::fmt;

/// Goal for a figure.
#[derive(Clone, Copy)]
pub enum Goal {
    AtLeast(f64),
    MoreThan(f64),
    AtMost(f64, &'static str),
}

impl Goal {
    fn is_met(self, figure: f64) -> bool {
        match self {
            Self::AtLeast(goal) => figure >= goal,
            Self::MoreThan(goal) => figure > goal,
            Self::AtMost(goal, _) => figure <= goal,
        }
    }
}

impl fmt::Display for Goal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::AtLeast(goal) => write!(f, ">= {goal:.1}"),
            Self::MoreThan(goal) => write!(f, "> {goal:.1}"),
            Self::AtMost(goal, unit) => write!(f, "<= {goal} {unit}"),
        }
    }
}

/// A row of the report: one contender.
pub struct Row {
    name: &'static str,
    figure: String,
    ratio: String,
    goal: Option<(Goal, bool)>,
}

impl Row {
    pub fn new(name: &'static str, figure: String) -> Self {
        Self { name, figure, ratio: String::new(), goal: None }
    }

    /// Adds the speed relative to the minimal contender.
    pub fn compared_with(self, ratio: f64, goal: Goal) -> Self {
        Self { ratio: format!("{ratio:.2} of bare"), ..self }.goal(ratio, goal)
    }

    /// Adds the speed of armctl relative to this contender.
    pub fn compared_with_armctl(self, ratio: f64, goal: Goal) -> Self {
        Self { ratio: format!("armctl {ratio:.2} x"), ..self }.goal(ratio, goal)
    }

    /// Adds the ratio to another figure, without a goal.
    pub fn times(self, ratio: f64, what: &str) -> Self {
        Self { ratio: format!("{ratio:.2} x {what}"), ..self }
    }

    /// Adds the ratio to the theoretical minimum.
    pub fn with_comparison(self, ratio: f64, what: &str, goal: Goal) -> Self {
        Self { ratio: format!("{ratio:.3} of {what}"), ..self }.goal(ratio, goal)
    }

    pub fn goal(self, figure: f64, goal: Goal) -> Self {
        Self { goal: Some((goal, goal.is_met(figure))), ..self }
    }
}

/// Table of one comparison.
pub struct Table {
    title: String,
    rows: Vec<Row>,
}

/// Headings of every table.
pub const HEADER: &str = "                                                          median  ratio             goal";

impl Table {
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), rows: Vec::new() }
    }

    pub fn row(&mut self, row: Row) {
        self.rows.push(row);
    }
}

/// `{:#}` is Markdown.
impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if f.alternate() {
            writeln!(f, "### {}\n\n| what | median | ratio | goal |\n|---|---|---|---|", self.title)?;
            for Row { name, figure, ratio, goal } in &self.rows {
                let verdict = |is_met| if is_met { "met" } else { "missed" };
                let goal = goal.map(|(goal, is_met)| format!("{goal}: {}", verdict(is_met))).unwrap_or_default();
                writeln!(f, "| {name} | {figure} | {ratio} | {goal} |")?;
            }
            return Ok(());
        }
        writeln!(f, "{}", self.title)?;
        for Row { name, figure, ratio, goal } in &self.rows {
            write!(f, "  {name:<46}{figure:>16}  {ratio:<18}")?;
            if let Some((goal, is_met)) = goal {
                write!(f, "{goal} {}", if *is_met { "met" } else { "MISSED" })?;
            }
            writeln!(f)?;
        }
        Ok(())
    }
}
