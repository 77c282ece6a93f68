//! What runs after what: ends that are missing, steps that nothing reaches, jumps that only the controller knows.

use super::tags::Resolved;
use crate::findings::{Findings, SourceLocation};
use crate::toyo::table::{Instruction, Op};

/// Tells what looks wrong in a program without errors. A part of one may go on behind its last step.
pub(super) fn check(resolved: &Resolved, is_part: bool, findings: &mut Findings) {
    let steps = || resolved.program.steps.iter().zip(&resolved.places).map(|(step, at)| (step.instruction, *at));
    let mut before: Option<Op> = None;
    for (row, at) in steps() {
        if let Some(jump) = before.filter(|op| never_goes_on(*op))
            && !matches!(row.op, Op::Tag | Op::Nop | Op::End)
        {
            let word = jump.row().word;
            findings.warning(at, format!("nothing reaches this step: {word} before it never goes on here"), None);
        }
        // NOPs behind a jump are padding, and so is an END.
        if !(row.op == Op::Nop && before.is_some_and(never_goes_on)) {
            before = Some(row.op);
        }
    }
    if !is_part
        && let Some((row, at)) = steps().rfind(|(row, _)| row.op != Op::Nop)
        && !never_goes_on(row.op)
        && !jumps_somewhere(row.op)
    {
        findings.warning(
            at,
            format!("the program does not end: {} is its last instruction", row.word),
            Some("add END".to_owned()),
        );
    }
    let unknown: Vec<_> = steps().filter(|(row, _)| jumps_somewhere(row.op)).collect();
    if let Some((row, at)) = unknown.first() {
        let more = if unknown.len() > 1 { format!("; {} steps do so", unknown.len()) } else { String::new() };
        findings
            .note(*at, format!("where {} jumps to depends on counters and inputs, and is not checked{more}", row.word));
    }
    limits(steps(), findings);
}

/// Instructions that not every controller has, each told once.
fn limits<'s>(steps: impl Iterator<Item = (&'s Instruction, SourceLocation)>, findings: &mut Findings) {
    let mut told: Vec<Op> = Vec::new();
    for (row, at) in steps.filter(|(row, _)| !row.only_on.is_empty()) {
        if !told.contains(&row.op) {
            told.push(row.op);
            findings.note(at, format!("only {} have {}", row.only_on.join(", "), row.word));
        }
    }
}

/// Whether the next step is never what runs next.
const fn never_goes_on(op: Op) -> bool {
    matches!(op, Op::Jmp | Op::Ret | Op::End | Op::Loop)
}

/// Whether the tag that it jumps to is not written in it.
const fn jumps_somewhere(op: Op) -> bool {
    matches!(op, Op::Brac | Op::Psel)
}
