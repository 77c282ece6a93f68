//! The report.

use std::fmt;

/// What a figure is held against.
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
            Self::AtMost(goal, unit) => write!(f, "<= {goal:.0} {unit}"),
        }
    }
}

/// A contender.
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

    /// How many times as fast as the bare contender it is.
    pub fn against(self, ratio: f64, goal: Goal) -> Self {
        Self { ratio: format!("{ratio:.2} of bare"), ..self }.goal(ratio, goal)
    }

    /// How many times as fast as it armctl is.
    pub fn against_ours(self, ratio: f64, goal: Goal) -> Self {
        Self { ratio: format!("armctl {ratio:.2} x"), ..self }.goal(ratio, goal)
    }

    pub fn goal(self, figure: f64, goal: Goal) -> Self {
        Self { goal: Some((goal, goal.is_met(figure))), ..self }
    }
}

/// Sections of rows.
pub struct Table(String);

impl Table {
    pub fn new() -> Self {
        Self(format!("{:<48}{:>16}  {:<14}goal", "", "median", "ratio"))
    }

    pub fn section(&mut self, title: &str) -> Section<'_> {
        self.0 += &format!("\n{title}\n");
        Section(&mut self.0)
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// A comparison.
pub struct Section<'a>(&'a mut String);

impl Section<'_> {
    pub fn row(&mut self, Row { name, figure, ratio, goal }: Row) {
        let goal =
            goal.map_or(String::new(), |(goal, is_met)| format!("{goal} {}", if is_met { "met" } else { "MISSED" }));
        let line = format!("  {name:<46}{figure:>16}  {ratio:<14}{goal}");
        *self.0 += line.trim_end();
        self.0.push('\n');
    }
}
