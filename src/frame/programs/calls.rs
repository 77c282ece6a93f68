//! Call tree of programs.

use super::Program;
use crate::items::{self, ItemError};
use crate::prelude::basics::*;
use armctl_controller::references::Role;

/// Which programs call which.
#[derive(Debug, Clone, Default)]
pub struct CallGraph {
    /// Each program with the programs that it calls, in the order of the text.
    calls: BTreeMap<String, Vec<String>>,
    /// Each program with the programs that it calls and that return.
    nested: BTreeMap<String, Vec<String>>,
    /// Programs in the order of their source.
    order: Vec<String>,
    /// Whether a call has a target that is known only at run time.
    pub has_computed_calls: bool,
}

impl CallGraph {
    /// Reads the calls of programs.
    pub fn new(programs: &[Program]) -> Self {
        let names: BTreeSet<&str> = programs.iter().map(|program| program.name.as_str()).collect();
        let mut graph =
            Self { order: programs.iter().map(|program| program.name.clone()).collect(), ..Self::default() };
        for program in programs {
            let called = graph.calls.entry(program.name.clone()).or_default();
            for (_, reference) in program.calls(|name| names.contains(name)) {
                if !called.contains(&reference.name) {
                    called.push(reference.name.clone());
                }
                if reference.role != Role::Start {
                    graph.nested.entry(program.name.clone()).or_default().push(reference.name.clone());
                }
            }
            let is_computed = program.references().any(|(_, reference)| reference.role == Role::ComputedCall);
            graph.has_computed_calls |= is_computed;
        }
        graph
    }

    /// Programs that a program calls.
    fn called(&self, name: &str) -> &[String] {
        self.calls.get(name).map(Vec::as_slice).unwrap_or_default()
    }

    /// Programs that call a program, without the program itself.
    pub fn callers<'g>(&'g self, name: &'g str) -> impl Iterator<Item = &'g str> {
        let calls =
            self.calls.iter().filter(move |(caller, called)| *caller != name && called.iter().any(|one| one == name));
        calls.map(|(caller, _)| caller.as_str())
    }

    /// Whether a call of the program `from` can lead to a call of the program `to`.
    pub fn reaches(&self, from: &str, to: &str) -> bool {
        let mut seen = BTreeSet::new();
        let mut open = vec![from];
        while let Some(next) = open.pop() {
            for called in self.nested.get(next).into_iter().flatten() {
                if called == to {
                    return true;
                }
                if seen.insert(called) {
                    open.push(called);
                }
            }
        }
        false
    }

    /// Lines of the tree below a program.
    fn tree(&self, name: &str, path: &mut Vec<String>, shown: &mut BTreeSet<String>, lines: &mut Vec<Cell>) {
        let indent = "  ".repeat(path.len());
        let is_repeated = !self.called(name).is_empty() && shown.contains(name);
        let (mark, tone) = match () {
            () if path.iter().any(|one| one == name) && self.reaches(name, name) => ("  (recursive)", Tone::Warning),
            () if !self.calls.contains_key(name) => ("  (missing)", Tone::Bad),
            () if is_repeated => ("  (see above)", Tone::Plain),
            () => ("", Tone::Plain),
        };
        lines.push(Cell::from(format!("{indent}{name}{mark}")).tone(tone));
        if !mark.is_empty() {
            return;
        }
        shown.insert(name.to_owned());
        path.push(name.to_owned());
        for called in self.called(name) {
            self.tree(called, path, shown, lines);
        }
        path.pop();
    }
}

/// Calls between programs.
#[derive(Debug, Serialize, JsonSchema)]
pub struct CallReport {
    /// Programs in the order of their source, then called programs that do not exist.
    programs: Vec<CalledProgram>,
    /// Whether a call has a target that is known only at run time. In that case, unused programs are unknown.
    computed_calls: bool,
    /// Programs that could not be read.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    unread: Vec<ItemError>,
    #[serde(skip)]
    tree: Vec<Cell>,
    /// Whether the tree contains all programs.
    #[serde(skip)]
    is_whole: bool,
}

#[derive(Debug, Serialize, JsonSchema)]
struct CalledProgram {
    name: String,
    /// File in the folder, or on the controller; null if the program does not exist.
    file: Option<String>,
    /// Whether the program exists.
    exists: bool,
    /// Programs that it calls.
    calls: Vec<String>,
    /// Programs that call it.
    called_by: Vec<String>,
    /// Whether no program calls it, and it is not a master job; null if the target of a call is unknown.
    unused: Option<bool>,
    /// Whether it can call itself, also through other programs.
    recursive: bool,
}

impl CallReport {
    /// The calls of all programs, or of the program `root` and the programs below it.
    pub fn new(programs: &[Program], root: Option<&str>, masters: &[&str], unread: Vec<ItemError>) -> Self {
        let graph = CallGraph::new(programs);
        let exists =
            |name: &str| graph.calls.contains_key(name) || unread.iter().any(|one| super::check::stem(one) == name);
        let mut order = graph.order.clone();
        for called in graph.calls.values().flatten() {
            if !order.contains(called) {
                order.push(called.clone());
            }
        }
        let (mut tree, mut shown) = (Vec::new(), BTreeSet::new());
        if let Some(root) = root {
            graph.tree(root, &mut Vec::new(), &mut shown, &mut tree);
            order.retain(|name| {
                shown.contains(name)
                    || graph.calls.iter().any(|(one, called)| shown.contains(one) && called.contains(name))
            });
        } else {
            let is_root = |name: &&String| masters.contains(&name.as_str()) || graph.callers(name).next().is_none();
            let roots = graph.order.iter().filter(is_root);
            // The programs of a cycle without an outside caller have no root.
            for name in roots.chain(&graph.order) {
                if !shown.contains(name) {
                    graph.tree(name, &mut Vec::new(), &mut shown, &mut tree);
                }
            }
        }
        let listed = order.iter().map(|name| {
            let called_by: Vec<String> = graph.callers(name).map(ToOwned::to_owned).collect();
            let is_unused = called_by.is_empty() && !masters.contains(&name.as_str());
            CalledProgram {
                name: name.clone(),
                file: programs.iter().find(|program| program.name == *name).map(|program| program.file.clone()),
                exists: exists(name),
                calls: graph.called(name).to_vec(),
                called_by,
                unused: (!is_unused || !graph.has_computed_calls).then_some(is_unused),
                recursive: graph.reaches(name, name),
            }
        });
        Self {
            programs: listed.collect(),
            computed_calls: graph.has_computed_calls,
            unread,
            tree,
            is_whole: root.is_none(),
        }
    }
}

impl Report for CallReport {
    const ROWS: RowsOf = RowsOf::List("programs");

    fn view(&self) -> View {
        let view = View { sections: vec![Section::Lines(self.tree.clone())] };
        let unused = self.programs.iter().filter(|program| program.unused == Some(true));
        let unused: Vec<&str> = unused.map(|program| program.name.as_str()).collect();
        let note = match (&unused[..], self.computed_calls) {
            _ if !self.is_whole => return view,
            (_, true) => {
                "a call has a target that is known only at run time, so unused programs are unknown".to_owned()
            }
            ([], false) => return view,
            (names, false) => format!("called by no program: {}", names.join(", ")),
        };
        view.append(Section::Lines(vec![note.into()]))
    }

    fn failure(&self) -> Option<Failure> {
        items::verdict(self.programs.len() + self.unread.len(), self.unread.iter())
    }
}
