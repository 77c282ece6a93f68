//! Text of the findings in program files.

use crate::files;
use crate::prelude::*;
use armctl_controller::names::Name;
use armctl_controller::toyo::program::{Checked, Finding, Program, Severity};
use armctl_frame::settings::inventory;

/// Parses a name with its address on a command line, for example `pick=PT1`.
pub fn name(text: &str) -> Result<Name, String> {
    let (name, address) = text.split_once('=').ok_or("type a name with its address, such as pick=PT1")?;
    inventory::named(Family::Toyo, name, address).map_err(|failure| failure.message)
}

/// Program of a text that was checked. Warnings are printed on stderr. If there are errors, fails.
pub fn program(name: &str, checked: Checked, screen: &Screen) -> Result<Program> {
    valid(name, &checked)?;
    for finding in checked.findings.iter().filter(|finding| finding.severity == Severity::Warning) {
        screen.note(&in_a_line(name, finding));
    }
    checked.program.ok_or_else(|| files::file_failure(name, &[]))
}

/// Fails with all errors of a text that is not a valid program.
pub fn valid(name: &str, checked: &Checked) -> Result<()> {
    let errors: Vec<Finding> = checked.errors().cloned().collect();
    if errors.is_empty() { Ok(()) } else { Err(files::file_failure(name, &errors)) }
}

/// Formats a finding, for example `pick.txt:3:9: error: there is no label 'pikc' (did you mean pick?)`.
fn in_a_line(name: &str, finding: &Finding) -> String {
    let Finding { severity, line, column, message, hint, .. } = finding;
    let hint = hint.as_ref().map(|hint| format!(" ({hint})")).unwrap_or_default();
    format!("{name}:{line}:{column}: {}: {message}{hint}", severity.name())
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_controller::toyo::program::{MAX_STEPS, check};

    fn screen() -> Screen {
        Screen::new(armctl_frame::output::Format::Json, armctl_frame::output::ColorChoice::Never, true, 0)
    }

    #[test]
    fn a_faulty_file_fails_with_all_its_errors() {
        let checked = check(b"EMD\nJMP TAG=no\nSPD V=1\n", MAX_STEPS);
        let failed = program("pick.txt", checked, &screen()).unwrap_err();
        assert_eq!(failed.kind, Kind::Usage);
        assert_eq!(
            failed.message,
            "pick.txt:1:1: unknown instruction 'EMD' (did you mean END?)\npick.txt:2:9: unknown label 'no'"
        );
    }
}
