//! What a controller would stop at that only shows when the steps are followed: subroutines, arcs, points, MVM groups.
//!
//! Whether a condition holds is not known, so both ways are followed, and what is found may never happen: a warning.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};

use super::tags::Resolved;
use super::{Step, listing};
use crate::findings::{Findings, SourceLocation};
use crate::toyo::layout::Record;
use crate::toyo::table::Op;

/// What is known of the controller that a program is for.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Known {
    /// The points that are there; `None` where they are not known.
    pub points: Option<BTreeSet<i32>>,
}

/// Subroutines that may be called in each other; the simulator has as many, and the manual has no number.
const DEPTH: usize = 16;
/// The last internal port that a controller shows (TO 2-8, MNIN; ambiguity R18).
const INTERNAL_PORTS: i32 = 4;

/// Tells what goes wrong on some way through the steps. Of a part, the steps around it are not known.
pub(super) fn check(resolved: &Resolved, is_part: bool, known: &Known, findings: &mut Findings) {
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

/// What runs after a step: the index of the next one, that of a jump, that of a call.
#[derive(Default)]
struct Ways {
    next: bool,
    jumps: Vec<usize>,
    call: Option<usize>,
}

impl Finder<'_> {
    fn warn(&mut self, step: usize, message: impl Into<String>, hint: &str) {
        if let Some(at) = self.places.get(step) {
            self.findings.warning(*at, message, Some(hint.to_owned()));
        }
    }

    fn op(&self, step: usize) -> Option<Op> {
        self.steps.get(step).map(|step| step.instruction.op)
    }

    /// Points that are not there, and rows that cannot be.
    fn points(&mut self, known: &Known) {
        for (index, record) in self.steps.iter().map(|step| &step.record).enumerate() {
            let (Some(point), Some(counter)) = (record.number("point"), record.number("counter")) else { continue };
            if counter == 0 && point == 0 {
                self.warn(index, "point 0 without a counter is no row of the coordinate table", STOPS_AT_TABLE);
            } else if counter == 0 && known.points.as_ref().is_some_and(|points| !points.contains(&point)) {
                self.warn(
                    index,
                    format!("point {point} is not among the points that are given"),
                    "teach it, or write it with `toyo point set`",
                );
            }
        }
    }

    /// Internal ports that a controller does not show.
    fn ports(&mut self) {
        for index in 0..self.steps.len() {
            let port = self.steps[index].record.number("port").filter(|port| *port > INTERNAL_PORTS);
            if let (Some(Op::Iout | Op::Insp), Some(port)) = (self.op(index), port) {
                self.warn(
                    index,
                    format!("there may be no internal port {port}: controllers show 1 to 4"),
                    "a controller stops with error B5",
                );
            }
        }
    }

    /// An arc takes two steps.
    fn arcs(&mut self) {
        let is_arc = |op: Option<Op>| matches!(op, Some(Op::Mvc | Op::Mvcp));
        let mut index = 0;
        while index < self.steps.len() {
            if is_arc(self.op(index)) {
                if is_arc(self.op(index + 1)) {
                    index += 1;
                } else {
                    self.warn(
                        index,
                        "an arc takes two steps, a place on the way and its end: the next step is no MVC or MVCP",
                        "a controller stops with error A5",
                    );
                }
            }
            index += 1;
        }
    }

    /// Groups that nothing begins: their counters stand at 0, which is no place.
    fn groups(&mut self) {
        let group = |step: &Step, op: Op| (step.instruction.op == op).then(|| step.record.number("group")).flatten();
        let begun: BTreeSet<i32> = self.steps.iter().filter_map(|step| group(step, Op::Mini)).collect();
        for index in 0..self.steps.len() {
            let Some(number) = group(&self.steps[index], Op::Mvm).filter(|number| !begun.contains(number)) else {
                continue;
            };
            self.warn(
                index,
                format!("nothing begins group {number}: without MINI GRP={number} its counters may be at no place"),
                "a controller stops with error A7",
            );
        }
    }

    /// A RET that no call leads to, subroutines that call themselves, and too many in each other.
    fn subroutines(&mut self) {
        let records: Vec<Record> = self.steps.iter().map(|step| step.record.clone()).collect();
        let tags: BTreeMap<i32, usize> = listing::tags(&records, 0);
        let main = self.reach(0, &tags);
        for index in main.steps.iter().copied().filter(|index| self.op(*index) == Some(Op::Ret)).collect::<Vec<_>>() {
            self.warn(
                index,
                "the program can come here without a call",
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
                    let message = format!("{depth} subroutines are called in each other from here");
                    self.warn(call, message, "a controller stops with error A3 where its stack is full");
                }
                Depth::Calls(_) => {}
                Depth::Endless(step) => {
                    let message = "this call leads back to the subroutine that it is in";
                    self.warn(step, message, "a controller stops with error A3 when its stack is full");
                    return;
                }
            }
        }
    }

    /// The steps that can be reached from a step without a call or a return, and the calls among them.
    fn reach(&self, from: usize, tags: &BTreeMap<i32, usize>) -> Reach {
        let mut reach = Reach::default();
        let mut open = vec![from];
        while let Some(index) = open.pop() {
            if index >= self.steps.len() || !reach.steps.insert(index) {
                continue;
            }
            let Ways { next, jumps, call } = self.ways(index, tags);
            open.extend(jumps);
            if next {
                open.push(index + 1);
            }
            reach.calls.extend(call.map(|entry| (index, entry)));
        }
        reach
    }

    fn ways(&self, index: usize, tags: &BTreeMap<i32, usize>) -> Ways {
        let step = &self.steps[index];
        let to = |name: &str| step.record.number(name).and_then(|tag| tags.get(&tag)).copied();
        match step.instruction.op {
            Op::Jmp => Ways { jumps: to("tag").into_iter().collect(), ..Ways::default() },
            Op::Jmpc | Op::Jmpi | Op::Jmpt => Ways { next: true, jumps: to("tag").into_iter().collect(), call: None },
            Op::Loop => Ways { jumps: to("then").into_iter().chain(to("else")).collect(), ..Ways::default() },
            Op::Cal | Op::Calc | Op::Cali | Op::Calt => Ways { next: true, jumps: Vec::new(), call: to("tag") },
            Op::End | Op::Ret | Op::Brac => Ways::default(),
            _ => Ways { next: true, ..Ways::default() },
        }
    }
}

const STOPS_AT_TABLE: &str = "a controller stops with error B6";

/// What can be reached.
#[derive(Default)]
struct Reach {
    steps: BTreeSet<usize>,
    /// Calls, with the steps that they call.
    calls: BTreeMap<usize, usize>,
}

/// How deep calls go.
#[derive(Clone, Copy)]
enum Depth {
    /// So many in each other.
    Calls(usize),
    /// Round and round, by this call.
    Endless(usize),
}

/// How many subroutines are called in each other from one on.
fn depth(
    entry: usize,
    bodies: &BTreeMap<usize, Reach>,
    known: &mut BTreeMap<usize, usize>,
    within: &mut Vec<usize>,
) -> Depth {
    if let Some(depth) = known.get(&entry) {
        return Depth::Calls(*depth);
    }
    within.push(entry);
    let mut most = 0;
    for (call, inner) in bodies.get(&entry).iter().flat_map(|body| &body.calls) {
        if within.contains(inner) {
            return Depth::Endless(*call);
        }
        match depth(*inner, bodies, known, within) {
            Depth::Calls(depth) => most = most.max(depth),
            endless @ Depth::Endless(_) => return endless,
        }
    }
    within.pop();
    known.insert(entry, most + 1);
    Depth::Calls(most + 1)
}
