//! Checks cycles of modules. The modules of a cycle can be understood only together, so no cycle may have more modules
//! than the largest simulator.

use std::collections::{BTreeMap, BTreeSet};

use super::source::{Source, sources};

/// Maximum number of modules in a cycle: the size of the largest simulator.
const MAX_CYCLE_SIZE: usize = 15;

/// For each module, the modules that it uses, by path.
type ModuleUses = BTreeMap<String, BTreeSet<String>>;

#[test]
fn limits_the_size_of_module_cycles() {
    let largest = circles(&uses(&sources())).into_iter().next().unwrap_or_default();
    println!("largest circle, {} modules: {}", largest.len(), largest.join(" "));
    assert!(largest.len() <= MAX_CYCLE_SIZE, "{} modules know each other: {}", largest.len(), largest.join(" "));
}

#[test]
fn finds_module_cycles() {
    let file = |name: &str, text: &str| Source::new(name, text);
    let sources = [
        file("a/mod.rs", "mod b; use self::b::B; pub struct A;"),
        file("a/b.rs", "use super::c::C; pub struct B;"),
        file("a/c.rs", "pub fn c() -> crate::a::A { todo() }"),
        file("d.rs", "use crate::a::A;\n#[cfg(test)]\nmod tests { use crate::e::E; }"),
        file("e.rs", "use crate::d::D;"),
    ];
    assert_eq!(circles(&uses(&sources)), [["crate::a", "crate::a::b", "crate::a::c"]]);
}

/// The modules that each module uses. Tests are left out, because they may use every module. A declaration (`mod x;`)
/// is not a use.
fn uses(sources: &[Source]) -> ModuleUses {
    let sources = sources.iter().filter(|source| !source.name.contains("test"));
    let without_tests = sources.map(|source| {
        let code = source.code.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
        Source { name: source.name.clone(), text: String::new(), code: code.to_owned() }
    });
    let sources: Vec<Source> = without_tests.collect();
    let modules: BTreeSet<String> = sources.iter().map(|source| source.module().join("::")).collect();
    let used = |source: &Source| {
        let itself = source.module().join("::");
        let paths = source.paths().into_iter().map(|(_, path)| {
            let child = format!("{itself}::{}", path.split("::").next().unwrap_or_default());
            if modules.contains(&child) { format!("{itself}::{path}") } else { path }
        });
        let found: BTreeSet<String> = paths.filter_map(|path| module_of(&path, &modules)).collect();
        (itself.clone(), found.into_iter().filter(|module| *module != itself).collect())
    };
    sources.iter().map(used).collect()
}

/// Returns the module of an item, which is the longest prefix of its path that is a module.
fn module_of(path: &str, modules: &BTreeSet<String>) -> Option<String> {
    let mut path = path.strip_suffix("::self").unwrap_or(path);
    while !modules.contains(path) {
        path = path.rsplit_once("::")?.0;
    }
    Some(path.to_owned())
}

/// Returns the strongly connected groups of modules (Tarjan), the largest group first.
fn circles(uses: &ModuleUses) -> Vec<Vec<String>> {
    let mut search = Search::new(uses);
    for module in uses.keys() {
        if !search.order.contains_key(module.as_str()) {
            search.visit(module);
        }
    }
    search.found.sort_by_key(|circle| std::cmp::Reverse(circle.len()));
    search.found
}

struct Search<'a> {
    uses: &'a ModuleUses,
    /// Visit number of each module.
    order: BTreeMap<&'a str, usize>,
    /// Visited modules whose group is not complete yet.
    open: Vec<&'a str>,
    found: Vec<Vec<String>>,
}

impl<'a> Search<'a> {
    fn new(uses: &'a ModuleUses) -> Self {
        Self { uses, order: BTreeMap::new(), open: Vec::new(), found: Vec::new() }
    }

    /// Visits a module. Returns the number of the earliest open module that it reaches.
    fn visit(&mut self, module: &'a str) -> usize {
        let met = self.order.len();
        self.order.insert(module, met);
        self.open.push(module);
        let mut earliest = met;
        for next in self.uses.get(module).into_iter().flatten() {
            let reached = match self.order.get(next.as_str()) {
                None => self.visit(next),
                Some(when) if self.open.contains(&next.as_str()) => *when,
                Some(_) => continue,
            };
            earliest = earliest.min(reached);
        }
        if earliest == met {
            let start = self.open.iter().position(|open| *open == module).expect("it was pushed above");
            let mut circle: Vec<String> = self.open.drain(start..).map(str::to_owned).collect();
            if circle.len() > 1 {
                circle.sort();
                self.found.push(circle);
            }
        }
        earliest
    }
}
