//! Checks of programs that are the same in all families: labels, calls, positions, variables, speeds.

use similar::DiffTag;

use super::calls::CallGraph;
use super::settings::CheckSettings;
use super::{Line, Position, Program};
use crate::ValueKind;
use crate::backup::tolerance::{Limit, Tolerance};
use crate::items::ItemError;
use crate::prelude::basics::*;
use armctl_controller::findings::{Finding, Rule, Severity};
use armctl_controller::references::{Reference, Role};

/// Maximum number of positions that a finding names.
const MAX_NAMES: usize = 20;

/// Maximum speed in one unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedLimit {
    value: f64,
    unit: &'static str,
}

impl SpeedLimit {
    /// Parses `250mm/s`, `50%` or `90deg/s`.
    ///
    /// # Errors
    /// If the text has another form.
    pub fn parse(text: &str) -> Result<Self, String> {
        let limit = ["mm/s", "%", "deg/s"].into_iter().find_map(|unit| {
            let value = text.strip_suffix(unit)?.trim().parse().ok()?;
            Some(Self { value, unit })
        });
        let limit = limit.filter(|limit| limit.value.is_finite() && limit.value > 0.0);
        limit.ok_or_else(|| format!("'{text}' is not a valid speed limit, such as 250mm/s, 50% or 90deg/s"))
    }
}

/// Limits of a check on the command line.
#[derive(Debug, Args)]
#[group(skip)]
pub struct CheckArguments {
    /// Speed limit: 250mm/s, 50% or 90deg/s (repeatable)
    #[arg(long, value_name = "SPEED", value_delimiter = ',', value_parser = SpeedLimit::parse)]
    max_speed: Vec<SpeedLimit>,
    /// Report positions that differ from the positions in this folder
    #[arg(long, value_name = "FOLDER", add = ValueKind::Backup)]
    pub compare: Option<PathBuf>,
    /// Tolerance of --compare, for example 0.05 (mm and degrees), or 0.1mm,0.05deg,5pulses
    #[arg(long, value_name = "LIMIT", value_delimiter = ',', value_parser = Limit::parse, requires = "compare")]
    tolerance: Vec<Limit>,
    /// Treat warnings as errors
    #[arg(long)]
    pub strict: bool,
}

impl CheckArguments {
    /// Reads the settings for a folder. The arguments have priority.
    ///
    /// # Errors
    /// The errors of [`CheckSettings::load`].
    pub fn settings(&self, folder: Option<&Path>) -> Result<CheckSettings> {
        let mut settings = CheckSettings::load(folder)?;
        settings.max_speed.extend(&self.max_speed);
        settings.tolerance.extend(&self.tolerance);
        Ok(settings)
    }
}

/// What a check compares the programs with.
#[derive(Debug, Default)]
pub struct CheckContext {
    /// Settings.
    pub settings: CheckSettings,
    /// Programs that exist but were not read.
    pub unread: Vec<ItemError>,
    /// Whether other programs may exist that were not read. In that case, calls and variables are not checked.
    pub is_partial: bool,
    /// Whether it is unknown that these are all programs of a robot, so that a missing program is not certain.
    pub is_loose: bool,
    /// Programs of another backup.
    pub compare: Option<Vec<Program>>,
}

/// Adds the findings of all rules to the findings of the programs, and removes the findings that the settings switch
/// off.
pub fn check(programs: &mut [Program], context: &CheckContext) {
    let is_whole = !context.is_partial && context.unread.is_empty();
    let graph = CallGraph::new(programs);
    let names: BTreeSet<String> = programs.iter().map(|program| program.name.clone()).collect();
    let read = names_read(programs);
    let mut written = BTreeSet::new();
    for program in programs.iter_mut() {
        let mut found = Vec::new();
        labels(program, &mut found);
        positions(program, &mut found);
        speeds(program, &context.settings, &mut found);
        calls(program, &graph, &names, context, &mut found);
        if is_whole {
            unused(program, &graph, &context.settings, &mut found);
            never_read(program, &read, &mut written, &mut found);
        }
        let other = context.compare.iter().flatten().find(|other| other.name == program.name);
        if let Some(other) = other {
            let found_moved = moved(&program.positions, &other.positions, &other.file, &context.settings);
            found.extend(found_moved.into_iter().map(|(_, finding)| finding));
        }
        program.findings.append(&mut found);
        let name = &program.name;
        program.findings.retain(|finding| context.settings.shows(name, finding));
        program.findings.sort_by_key(|finding| (finding.line, finding.column, finding.severity));
    }
}

fn finding(rule: Rule, severity: Severity, line: usize, column: usize, message: String) -> Finding {
    Finding { rule, severity, line, column, message, hint: None }
}

fn at(rule: Rule, severity: Severity, (line, reference): (&Line, &Reference), message: String) -> Finding {
    finding(rule, severity, line.number, reference.column, message)
}

/// Hint with the most similar name.
fn did_you_mean<'n>(name: &str, names: impl IntoIterator<Item = &'n str>) -> Option<String> {
    nearest(name, names).map(|near| format!("did you mean {near}?"))
}

fn labels(program: &Program, found: &mut Vec<Finding>) {
    let of = |role| program.references().filter(move |(_, reference)| reference.role == role);
    let labels: BTreeSet<&str> = of(Role::Label).map(|(_, label)| label.name.as_str()).collect();
    for place in of(Role::Jump).filter(|(_, jump)| !labels.contains(jump.name.as_str())) {
        let name = &place.1.name;
        let missing = at(Rule::MissingLabel, Severity::Error, place, format!("{} has no label {name}", program.name));
        found.push(Finding { hint: did_you_mean(name, labels.iter().copied()), ..missing });
    }
}

fn positions(program: &Program, found: &mut Vec<Finding>) {
    let known: BTreeSet<&str> = program.positions.iter().map(|position| position.name.as_str()).collect();
    let mut used = BTreeSet::new();
    for place in program.references().filter(|(_, reference)| reference.role == Role::Position) {
        let name = place.1.name.as_str();
        if !known.contains(name) && used.insert(name) {
            let message = format!("{} has no position {name}", program.name);
            found.push(at(Rule::MissingPosition, Severity::Error, place, message));
        }
        used.insert(name);
    }
    let unused: Vec<&Position> =
        program.positions.iter().filter(|position| !used.contains(position.name.as_str())).collect();
    let names: Vec<String> = unused.iter().map(|position| position.name.clone()).collect();
    found.extend(unused.first().and_then(|first| unused_positions(first.line, &names)));
}

/// Finding about positions that no instruction uses; `None` if there are none.
pub fn unused_positions(line: usize, names: &[String]) -> Option<Finding> {
    let shown = names.iter().take(MAX_NAMES).map(String::as_str).collect::<Vec<_>>().join(", ");
    let more = match names.len().saturating_sub(MAX_NAMES) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let message = format!("no instruction uses {shown}{more}");
    (!names.is_empty()).then(|| finding(Rule::UnusedPosition, Severity::Warning, line, 1, message))
}

fn speeds(program: &Program, settings: &CheckSettings, found: &mut Vec<Finding>) {
    for line in &program.lines {
        for speed in &line.speeds {
            // A limit on the command line comes after the limit in the file, and replaces it.
            let mut limits = settings.max_speed.iter().filter(|limit| limit.unit == speed.unit);
            let Some(limit) = limits.next_back().filter(|limit| speed.value > limit.value) else { continue };
            let message = format!("{}{} is above the limit {}{}", speed.value, speed.unit, limit.value, limit.unit);
            found.push(finding(Rule::SpeedLimit, Severity::Warning, line.number, speed.column, message));
        }
    }
}

fn calls(
    program: &Program,
    graph: &CallGraph,
    names: &BTreeSet<String>,
    context: &CheckContext,
    found: &mut Vec<Finding>,
) {
    let is_unread = |name: &str| context.is_partial || context.unread.iter().any(|one| stem(one) == name);
    for place in program.calls(|name| names.contains(name)) {
        let called = &place.1.name;
        if !names.contains(called) && !is_unread(called) {
            let severity = if context.is_loose { Severity::Warning } else { Severity::Error };
            let missing = at(Rule::MissingJob, severity, place, format!("{called} does not exist"));
            found.push(Finding { hint: did_you_mean(called, names.iter().map(String::as_str)), ..missing });
        } else if place.1.role != Role::Start && (*called == program.name || graph.reaches(called, &program.name)) {
            let message = format!("this call of {called} leads to another call of {}", program.name);
            let recursion = at(Rule::Recursion, Severity::Warning, place, message);
            let hint = "a controller stops with an alarm when its stack of calls is full".to_owned();
            found.push(Finding { hint: Some(hint), ..recursion });
        }
    }
}

/// Reports a program without a caller. If the settings name no master job, each job can be one.
fn unused(program: &Program, graph: &CallGraph, settings: &CheckSettings, found: &mut Vec<Finding>) {
    let Program { name, lines, .. } = program;
    let is_used = settings.is_master(name) || graph.callers(name).next().is_some();
    if is_used || settings.master.is_empty() || graph.has_computed_calls {
        return;
    }
    let line = lines.iter().find(|line| line.text.contains(name.as_str())).map_or(1, |line| line.number);
    let unused = finding(Rule::UnusedJob, Severity::Warning, line, 1, format!("no job calls {name}"));
    let hint = format!("if a person or a PLC starts {name}, add it to master in {}", super::settings::FILE);
    found.push(Finding { hint: Some(hint), ..unused });
}

/// Name of a variable in the whole robot. A local variable has the name of its program before it.
fn scoped(program: &str, name: &str) -> String {
    let is_local = name.len() > 1 && name.starts_with('L') && !name.contains('#');
    if is_local { format!("{program}:{name}") } else { name.to_owned() }
}

/// Names whose values are used.
fn names_read(programs: &[Program]) -> BTreeSet<String> {
    let reads = |program: &Program| -> Vec<String> {
        let read = program.references().filter(|(_, one)| matches!(one.role, Role::Read | Role::Update));
        read.map(|(_, one)| scoped(&program.name, &one.name)).collect()
    };
    programs.iter().flat_map(reads).collect()
}

/// Reports each variable once, at its first write. Outputs are not variables.
fn never_read(program: &Program, read: &BTreeSet<String>, written: &mut BTreeSet<String>, found: &mut Vec<Finding>) {
    for place in program.references().filter(|(_, one)| one.role == Role::Write && !one.name.contains('#')) {
        let name = scoped(&program.name, &place.1.name);
        let any = format!("{}*", name.trim_end_matches(|c: char| c.is_ascii_digit()));
        if !read.contains(&name) && !read.contains(&any) && !name.ends_with('*') && written.insert(name) {
            let message = format!("no instruction reads {}", place.1.name);
            let never = at(Rule::NeverRead, Severity::Warning, place, message);
            let hint = "if a person or a PLC reads the variable, switch the rule off".to_owned();
            found.push(Finding { hint: Some(hint), ..never });
        }
    }
}

/// Positions that differ from other positions of `source`, each with its name. Controllers number the positions of a job
/// in their order, so the order decides which position was which.
pub fn moved(new: &[Position], old: &[Position], source: &str, settings: &CheckSettings) -> Vec<(String, Finding)> {
    let tolerance = Tolerance::of(&settings.tolerance);
    let values = |positions: &[Position]| -> Vec<String> {
        positions.iter().map(|position| value(&position.text).to_owned()).collect()
    };
    let mut found = Vec::new();
    for change in similar::capture_diff_slices(similar::Algorithm::Myers, &values(old), &values(new)) {
        if change.tag() != DiffTag::Replace {
            continue;
        }
        for (was, is) in change.old_range().zip(change.new_range()) {
            let (was, is) = (&old[was], &new[is]);
            if !tolerance.allows_position(&was.text, &is.text) {
                let message = format!("{} is {}, and was {} in {source}", is.name, value(&is.text), value(&was.text));
                let finding = finding(Rule::MovedPosition, Severity::Warning, is.line, 1, message);
                found.push((is.name.clone(), finding));
            }
        }
    }
    found
}

fn value(text: &str) -> &str {
    text.split_once('=').map_or(text, |(_, value)| value)
}

/// Name of a program that was not read.
pub(super) fn stem(unread: &ItemError) -> &str {
    unread.asked().rsplit_once('.').map_or(unread.asked(), |(stem, _)| stem)
}
