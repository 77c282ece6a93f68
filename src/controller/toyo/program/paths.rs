//! Checks along all execution paths: subroutines, arcs, points, MVM groups.
//!
//! The results of conditions are unknown, so the checks follow both branches. A problem that the checks find may never
//! occur at run time, so it is a warning.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};

use super::tags::Resolved;
use super::{Step, listing};
use crate::findings::{Findings, Rule, SourceLocation};
use crate::toyo::layout::Record;
use crate::toyo::table::Op;

/// Known data of a controller.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ControllerData {
    /// Existing points; `None` if unknown.
    pub points: Option<BTreeSet<i32>>,
}

/// Maximum nesting of subroutines in the simulator; the manual has no limit.
const DEPTH: usize = 16;
/// The last internal port that can be read (TO 2-8, MNIN; ambiguity R18).
const INTERNAL_PORTS: i32 = 4;

/// Reports problems on any path. If the text is a part of a program, the steps outside the part are unknown.
pub(super) fn check(resolved: &Resolved, is_part: bool, known: &ControllerData, findings: &mut Findings) {
    let steps = &resolved.program.steps;
    let mut finder = Finder { steps, places: &resolved.places, findings };
    finder.points(known);
    finder.ports();
    if !is_part {
        finder.arcs();
        finder.groups();
        finder.subroutines();
    }
}

struct Finder<'a> {
    steps: &'a [Step],
    places: &'a [SourceLocation],
    findings: &'a mut Findings,
}

/// Indexes of the steps that can follow a step: the next step, a jump target, and the first step of a subroutine.
#[derive(Default)]
struct Successors {
    next: bool,
    jumps: Vec<usize>,
    call: Option<usize>,
}

impl Finder<'_> {
    fn warn(&mut self, rule: Rule, step: usize, message: impl Into<String>, hint: &str) {
        if let Some(at) = self.places.get(step) {
            self.findings.warning(rule, *at, message, Some(hint.to_owned()));
        }
    }

    fn op(&self, step: usize) -> Option<Op> {
        self.steps.get(step).map(|step| step.instruction.op)
    }

    /// Reports points that do not exist, and row 0 without a counter.
    fn points(&mut self, known: &ControllerData) {
        for (index, record) in self.steps.iter().map(|step| &step.record).enumerate() {
            let (Some(point), Some(counter)) = (record.number("point"), record.number("counter")) else { continue };
            if counter == 0 && point == 0 {
                self.warn(
                    Rule::MissingPosition,
                    index,
                    "point 0 without a counter is not a row of the coordinate table",
                    STOPS_AT_TABLE,
                );
            } else if counter == 0 && known.points.as_ref().is_some_and(|points| !points.contains(&point)) {
                self.warn(
                    Rule::MissingPosition,
                    index,
                    format!("point {point} is not in the points file"),
                    "teach the point, or write it with `toyo point set`",
                );
            }
        }
    }

    /// Reports internal ports that may not exist.
    fn ports(&mut self) {
        for index in 0..self.steps.len() {
            let port = self.steps[index].record.number("port").filter(|port| *port > INTERNAL_PORTS);
            if let (Some(Op::Iout | Op::Insp), Some(port)) = (self.op(index), port) {
                self.warn(
                    Rule::Stops,
                    index,
                    format!("internal port {port} may not exist: controllers have 1 to 4"),
                    "a controller stops with error B5",
                );
            }
        }
    }

    /// Reports incomplete arcs. An arc consists of two steps.
    fn arcs(&mut self) {
        let is_arc = |op: Option<Op>| matches!(op, Some(Op::Mvc | Op::Mvcp));
        let mut index = 0;
        while index < self.steps.len() {
            if is_arc(self.op(index)) {
                if is_arc(self.op(index + 1)) {
                    index += 1;
                } else {
                    self.warn(
                        Rule::Stops,
                        index,
                        "an arc needs two steps (a point on the arc, and its end), but the next step is not MVC or \
                         MVCP",
                        "a controller stops with error A5",
                    );
                }
            }
            index += 1;
        }
    }

    /// Reports MVM groups without MINI. The counters of such a group are 0, which is not a position.
    fn groups(&mut self) {
        let group = |step: &Step, op: Op| (step.instruction.op == op).then(|| step.record.number("group")).flatten();
        let begun: BTreeSet<i32> = self.steps.iter().filter_map(|step| group(step, Op::Mini)).collect();
        for index in 0..self.steps.len() {
            let Some(number) = group(&self.steps[index], Op::Mvm).filter(|number| !begun.contains(number)) else {
                continue;
            };
            self.warn(
                Rule::Stops,
                index,
                format!(
                    "no step starts group {number}: without MINI GRP={number}, its counters may have no valid position"
                ),
                "a controller stops with error A7",
            );
        }
    }

    /// Reports RET without a call, recursion, and calls that are nested too deep.
    fn subroutines(&mut self) {
        let records: Vec<Record> = self.steps.iter().map(|step| step.record.clone()).collect();
        let tags: BTreeMap<i32, usize> = listing::tags(&records, 0);
        let main = self.reach(0, &tags);
        for index in main.steps.iter().copied().filter(|index| self.op(*index) == Some(Op::Ret)).collect::<Vec<_>>() {
            self.warn(
                Rule::Stops,
                index,
                "the program can reach this step without a call",
                "a controller stops with error A4 at a RET without a call",
            );
        }
        let mut bodies: BTreeMap<usize, Reach> = BTreeMap::new();
        let mut open: Vec<usize> = main.calls.values().copied().collect();
        while let Some(entry) = open.pop() {
            if let Entry::Vacant(place) = bodies.entry(entry) {
                let body = place.insert(self.reach(entry, &tags));
                open.extend(body.calls.values());
            }
        }
        let mut depths = BTreeMap::new();
        for (call, entry) in main.calls {
            match depth(entry, &bodies, &mut depths, &mut Vec::new()) {
                Depth::Calls(depth) if depth > DEPTH => {
                    let message = format!("{depth} nested subroutine calls start here");
                    self.warn(Rule::Stops, call, message, "a controller stops with error A3 when its stack is full");
                }
                Depth::Calls(_) => {}
                Depth::Endless(step) => {
                    let message = "this call is recursive: it calls its own subroutine";
                    self.warn(
                        Rule::Recursion,
                        step,
                        message,
                        "a controller stops with error A3 when its stack is full",
                    );
                    return;
                }
            }
        }
    }

    /// Steps that are reachable without a call or return, and the calls among them.
    fn reach(&self, from: usize, tags: &BTreeMap<i32, usize>) -> Reach {
        let mut reach = Reach::default();
        let mut open = vec![from];
        while let Some(index) = open.pop() {
            if index >= self.steps.len() || !reach.steps.insert(index) {
                continue;
            }
            let Successors { next, jumps, call } = self.successors(index, tags);
            open.extend(jumps);
            if next {
                open.push(index + 1);
            }
            reach.calls.extend(call.map(|entry| (index, entry)));
        }
        reach
    }

    fn successors(&self, index: usize, tags: &BTreeMap<i32, usize>) -> Successors {
        let step = &self.steps[index];
        let to = |name: &str| step.record.number(name).and_then(|tag| tags.get(&tag)).copied();
        match step.instruction.op {
            Op::Jmp => Successors { jumps: to("tag").into_iter().collect(), ..Successors::default() },
            Op::Jmpc | Op::Jmpi | Op::Jmpt => {
                Successors { next: true, jumps: to("tag").into_iter().collect(), call: None }
            }
            Op::Loop => {
                Successors { jumps: to("then").into_iter().chain(to("else")).collect(), ..Successors::default() }
            }
            Op::Cal | Op::Calc | Op::Cali | Op::Calt => Successors { next: true, jumps: Vec::new(), call: to("tag") },
            Op::End | Op::Ret | Op::Brac => Successors::default(),
            _ => Successors { next: true, ..Successors::default() },
        }
    }
}

const STOPS_AT_TABLE: &str = "a controller stops with error B6";

/// Result of a reachability search.
#[derive(Default)]
struct Reach {
    steps: BTreeSet<usize>,
    /// Calls, each with the first step of its subroutine.
    calls: BTreeMap<usize, usize>,
}

/// Nesting of calls.
#[derive(Clone, Copy)]
enum Depth {
    /// Number of levels.
    Calls(usize),
    /// Recursion through this call.
    Endless(usize),
}

/// Returns the depth of nested calls, starting at a subroutine.
fn depth(
    entry: usize,
    bodies: &BTreeMap<usize, Reach>,
    known: &mut BTreeMap<usize, usize>,
    call_stack: &mut Vec<usize>,
) -> Depth {
    if let Some(depth) = known.get(&entry) {
        return Depth::Calls(*depth);
    }
    call_stack.push(entry);
    let mut most = 0;
    for (call, inner) in bodies.get(&entry).iter().flat_map(|body| &body.calls) {
        if call_stack.contains(inner) {
            return Depth::Endless(*call);
        }
        match depth(*inner, bodies, known, call_stack) {
            Depth::Calls(depth) => most = most.max(depth),
            endless @ Depth::Endless(_) => return endless,
        }
    }
    call_stack.pop();
    known.insert(entry, most + 1);
    Depth::Calls(most + 1)
}
