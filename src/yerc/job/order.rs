//! The order in which a controller executes the lines of a job and of the jobs that it calls, as far as the texts show
//! it. Conditions are not evaluated.

use std::collections::{BTreeMap, BTreeSet};

use armctl_controller::references::{Reference, Role};
use armctl_controller::yerc::job::{JobText, scan};

/// Maximum number of lines.
const MAX_LINES: usize = 20_000;
/// Maximum depth of calls. A controller allows 12.
const MAX_CALLS: usize = 12;
/// Words of lines that depend on a condition.
const CONDITIONS: [&str; 5] = ["IF", "IFTHEN", "WHILE", "SWITCH", "FOR"];

/// A line in the order of execution.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Executed<'t> {
    /// Name of the job.
    pub job: &'t str,
    /// Whether another job called the job.
    pub is_called: bool,
    /// Line of the file, from 1.
    pub line: usize,
    /// Instruction, without blanks at its ends.
    pub text: &'t str,
    /// Whether the line begins a branch: the robot gets here only from a jump with a condition.
    pub begins_branch: bool,
    /// Whether the line calls a job whose lines do not follow, because the job is missing or calls itself.
    pub is_open_call: bool,
}

impl Executed<'_> {
    /// Text with the name of the job before it, if another job called the job.
    pub fn named(&self, text: &str) -> String {
        if self.is_called { format!("{}: {text}", self.job) } else { text.to_owned() }
    }
}

/// The lines of a job in the order of execution.
#[derive(Debug, Default)]
pub struct RunOrder<'t> {
    /// The lines. First the path without any jump that has a condition, then the branches.
    pub lines: Vec<Executed<'t>>,
    /// Whether a jump or a call has a condition, or lines are in a block with a condition.
    pub has_conditions: bool,
    /// Whether a jump goes back to lines that were executed before.
    pub repeats: bool,
}

impl<'t> RunOrder<'t> {
    /// Follows a job from its first line.
    pub fn new(name: &'t str, texts: &'t BTreeMap<String, String>) -> Self {
        let mut follower =
            Follower { texts, order: Self::default(), stack: Vec::new(), seen: Vec::new(), branches: Vec::new() };
        follower.call(name);
        while let Some(branch) = follower.branches.pop() {
            let first = follower.order.lines.len();
            follower.stack = branch.callers;
            follower.follow(branch.run, branch.job, branch.first);
            if let Some(line) = follower.order.lines.get_mut(first) {
                line.begins_branch = true;
            }
        }
        follower.order
    }

    /// Whether there were more lines.
    pub fn is_cut(&self) -> bool {
        self.lines.len() >= MAX_LINES
    }
}

/// Lines that are executed only after a jump that has a condition.
struct Branch<'t> {
    run: usize,
    job: &'t str,
    /// Index of the first line.
    first: usize,
    callers: Vec<&'t str>,
}

struct Follower<'t> {
    texts: &'t BTreeMap<String, String>,
    order: RunOrder<'t>,
    /// Jobs that are executed, the current job last.
    stack: Vec<&'t str>,
    /// Lines that each run of a job executed, by their index.
    seen: Vec<BTreeSet<usize>>,
    branches: Vec<Branch<'t>>,
}

impl<'t> Follower<'t> {
    /// Executes a job. Returns `false` if it is missing, or if it is executed already.
    fn call(&mut self, name: &str) -> bool {
        let Some((name, _)) = self.texts.get_key_value(name) else { return false };
        if self.stack.contains(&name.as_str()) || self.stack.len() > MAX_CALLS {
            return false;
        }
        self.stack.push(name);
        self.seen.push(BTreeSet::new());
        self.follow(self.seen.len() - 1, name, 0);
        self.stack.pop();
        true
    }

    /// Executes lines of a job until its end, or until a line that this run of the job executed before.
    fn follow(&mut self, run: usize, job: &'t str, first: usize) {
        let lines = self.texts.get(job).map(|text| JobText::new(text).instructions).unwrap_or_default();
        let mut next = first;
        while let Some(&(line, text)) = lines.get(next).filter(|_| !self.order.is_cut()) {
            if !self.seen.get_mut(run).is_some_and(|seen| seen.insert(next)) {
                return;
            }
            let text = text.trim();
            let (references, _) = scan(text);
            let named = |role: Role| references.iter().find(|one| one.role == role).map(|one: &Reference| &*one.name);
            let words: Vec<&str> = text.split_whitespace().collect();
            let has_condition = words.contains(&"IF");
            self.order.has_conditions |= CONDITIONS.iter().any(|word| words.contains(word));
            self.order.lines.push(Executed {
                job,
                is_called: self.stack.len() > 1,
                line,
                text,
                begins_branch: false,
                is_open_call: false,
            });
            let index = self.order.lines.len() - 1;
            next += 1;
            match named(Role::Word) {
                Some("END" | "RET") if !has_condition => return,
                Some("CALL") => {
                    self.order.lines[index].is_open_call = named(Role::Call).is_some_and(|name| !self.call(name));
                }
                Some("JUMP") => {
                    if let Some(name) = named(Role::Start) {
                        self.order.lines[index].is_open_call = !self.call(name);
                        if !has_condition {
                            return;
                        }
                    }
                    let label = |text: &str| {
                        scan(text)
                            .0
                            .first()
                            .is_some_and(|one| one.role == Role::Label && Some(&*one.name) == named(Role::Jump))
                    };
                    let Some(target) = lines.iter().position(|(_, text)| label(text)) else { continue };
                    self.order.repeats |=
                        target < next && self.seen.get(run).is_some_and(|seen| seen.contains(&target));
                    if has_condition {
                        self.branches.push(Branch { run, job, first: target, callers: self.stack.clone() });
                    } else {
                        next = target;
                    }
                }
                _ => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Order of a job as `LINE` or `JOB:LINE`; `|` is the begin of a branch, `!` an open call.
    fn order(jobs: &[(&str, &str)]) -> (String, bool, bool) {
        let text = |lines: &str| format!("/JOB\nNOP\n{lines}\nEND\n");
        let texts = jobs.iter().map(|(name, lines)| ((*name).to_owned(), text(lines))).collect();
        let order = RunOrder::new(jobs[0].0, &texts);
        let lines = order.lines.iter().map(|line| {
            let branch = if line.begins_branch { "| " } else { "" };
            let open = if line.is_open_call { "!" } else { "" };
            format!("{branch}{}{open}", line.named(&line.line.to_string()).replace(": ", ":"))
        });
        (lines.collect::<Vec<_>>().join(" "), order.has_conditions, order.repeats)
    }

    #[test]
    fn follows_jumps_and_calls() {
        let told = |lines: &str| (lines.to_owned(), false, false);
        assert_eq!(order(&[("A", "MOVJ C0\nJUMP *X\nMOVJ C1\n*X\nMOVJ C2")]), told("2 3 4 6 7 8"));
        assert_eq!(
            order(&[("A", "CALL JOB:B\nCALL JOB:B\nCALL JOB:C"), ("B", "MOVJ C0\nRET\nMOVJ C1")]),
            told("2 3 B:2 B:3 B:4 4 B:2 B:3 B:4 5! 6")
        );
        assert_eq!(order(&[("A", "JUMP JOB:B\nMOVJ C0"), ("B", "CALL JOB:A")]), told("2 3 B:2 B:3! B:4"));
        assert_eq!(order(&[("A", "*X\nMOVJ C0\n'JUMP *X\n//JUMP *X")]), told("2 3 4 5 6 7"));
    }

    #[test]
    fn lines_after_a_condition_are_branches() {
        let jobs = [("A", "*X\nJUMP *Y IF B000=1\nMOVJ C0\nJUMP *X\nMOVJ C1\n*Y\nMOVJ C2\nCALL JOB:B IF B000=2")];
        assert_eq!(order(&jobs), ("2 3 4 5 6 | 8 9 10! 11".to_owned(), true, true));
    }

    #[test]
    fn number_of_lines_is_limited() {
        let calls = |name: &str| format!("CALL JOB:{name}\n").repeat(100);
        let texts: BTreeMap<String, String> = [("A", calls("B")), ("B", calls("C")), ("C", calls("D"))]
            .map(|(name, lines)| (name.to_owned(), format!("NOP\n{lines}END")))
            .into();
        let order = RunOrder::new("A", &texts);
        assert!(order.is_cut() && order.lines.len() == MAX_LINES);
    }
}
