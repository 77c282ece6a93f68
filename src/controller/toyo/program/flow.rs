//! Control-flow checks of a program: missing end, unreachable steps, and jumps whose target is known only at run time.

use super::tags::Resolved;
use crate::findings::{Findings, Rule, SourceLocation};
use crate::toyo::table::{Instruction, Op};

/// Reports suspicious control flow of a valid program. If the text is a part of a program, the program may continue
/// after its last step.
pub(super) fn check(resolved: &Resolved, is_part: bool, findings: &mut Findings) {
    let steps = || resolved.program.steps.iter().zip(&resolved.places).map(|(step, at)| (step.instruction, *at));
    let mut previous: Option<Op> = None;
    for (row, at) in steps() {
        if let Some(jump) = previous.filter(|op| ends_flow(*op))
            && !matches!(row.op, Op::Tag | Op::Nop | Op::End)
        {
            let word = jump.row().word;
            findings.warning(
                Rule::Unreachable,
                at,
                format!("the program never reaches this step: it does not continue after {word}"),
                None,
            );
        }
        // NOPs after a jump are padding: the step after them is checked as if it came directly after the jump.
        if !(row.op == Op::Nop && previous.is_some_and(ends_flow)) {
            previous = Some(row.op);
        }
    }
    if !is_part
        && let Some((row, at)) = steps().rfind(|(row, _)| row.op != Op::Nop)
        && !ends_flow(row.op)
        && !has_computed_target(row.op)
    {
        findings.warning(
            Rule::Unreachable,
            at,
            format!("the program has no end: {} is its last instruction", row.word),
            Some("add END".to_owned()),
        );
    }
    let unknown: Vec<_> = steps().filter(|(row, _)| has_computed_target(row.op)).collect();
    if let Some((row, at)) = unknown.first() {
        let more = if unknown.len() > 1 { format!("; this applies to {} steps", unknown.len()) } else { String::new() };
        findings
            .note(*at, format!("the target of {} depends on counters and inputs, and is not checked{more}", row.word));
    }
    limits(steps(), findings);
}

/// Reports instructions that only some controllers have. Reports each of these instructions only once.
fn limits<'s>(steps: impl Iterator<Item = (&'s Instruction, SourceLocation)>, findings: &mut Findings) {
    let mut reported: Vec<Op> = Vec::new();
    for (row, at) in steps.filter(|(row, _)| !row.only_on.is_empty()) {
        if !reported.contains(&row.op) {
            reported.push(row.op);
            findings.note(at, format!("only {} have {}", row.only_on.join(", "), row.word));
        }
    }
}

/// Whether the next step never runs directly after this instruction.
const fn ends_flow(op: Op) -> bool {
    matches!(op, Op::Jmp | Op::Ret | Op::End | Op::Loop)
}

/// Whether the jump target is not written in the instruction.
const fn has_computed_target(op: Op) -> bool {
    matches!(op, Op::Brac | Op::Psel)
}
