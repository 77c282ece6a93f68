//! Interactive selection of a missing name. The choices are the completion candidates.

use std::ffi::OsString;

use clap::CommandFactory as _;
use clap::error::{ContextKind, ContextValue, ErrorKind};

use super::parser::Refusal;
use super::typed_line::TypedLine;
use super::{complete, on_this_thread, wants_json};
use crate::cli::Cli;
use crate::command::example_lines::preselects;
use armctl_frame::Candidate;
use armctl_frame::interrupt::catch_interrupts;
use armctl_frame::output::{ColorChoice, Format};
use armctl_frame::prelude::*;
use armctl_frame::prompt::ask;

/// Time limit for reading the choices from a controller.
const LIST_TIMEOUT: Duration = Duration::from_secs(3);
/// Flag that disables questions.
const NO_INPUT: &str = "--no-input";

/// Returns the line with the value that the user selected. Returns `None` without candidates or without a terminal.
pub fn complete_line(args: &[OsString], refusal: &Refusal) -> Option<Result<Vec<OsString>, RunError>> {
    let Refusal::Mistake(error) = refusal else { return None };
    if !can_choose(args) {
        return None;
    }
    let whole = Cli::command();
    let what = missing_argument(error, args)?;
    let line = [args, &[OsString::new()]].concat();
    let found = complete::complete_within(&line, args.len(), false, LIST_TIMEOUT, true);
    let found: Vec<Candidate> = found.into_iter().filter(is_value).collect();
    if found.is_empty() {
        return None;
    }
    let has_first = preselects(&TypedLine::new(args, &whole).path);
    Some(ask_value(args, &what, &found, has_first))
}

/// Whether the user can select a value: the output is not JSON, and neither the line nor the environment forbids
/// questions.
fn can_choose(args: &[OsString]) -> bool {
    let is_json = wants_json(args).unwrap_or_else(super::prepare::wants_json);
    let format = if is_json { Format::Json } else { Format::Table };
    let screen = Screen::new(format, ColorChoice::Never, false, 0);
    screen.with_questions(args.iter().all(|word| word != NO_INPUT)).can_choose()
}

/// Returns the name of the argument or flag value that is missing at the end of a line.
fn missing_argument(error: &clap::Error, args: &[OsString]) -> Option<String> {
    match (error.kind(), error.get(ContextKind::InvalidArg)?) {
        (ErrorKind::MissingRequiredArgument, ContextValue::Strings(missing)) => {
            let first = missing.first().filter(|first| first.starts_with('<'))?;
            Some(first.trim_end_matches('.').trim_matches(['<', '>']).to_owned())
        }
        (ErrorKind::InvalidValue, ContextValue::String(flag)) => {
            let has_value =
                matches!(error.get(ContextKind::InvalidValue), Some(ContextValue::String(value)) if !value.is_empty());
            let last = args.last()?.to_str()?;
            let is_last = last.len() > 1 && last.starts_with('-') && !has_value;
            is_last.then(|| flag.split(['<', '>']).nth(1).unwrap_or(flag).to_owned())
        }
        _ => None,
    }
}

/// Whether a candidate is a complete value and not a flag.
fn is_value(candidate: &Candidate) -> bool {
    !candidate.is_incomplete && !candidate.value.starts_with('-')
}

fn ask_value(args: &[OsString], what: &str, found: &[Candidate], has_first: bool) -> Result<Vec<OsString>, RunError> {
    let screen = Screen::new(Format::Table, ColorChoice::Auto, false, 0);
    let options: Vec<String> = found
        .iter()
        .map(|Candidate { value, help, .. }| match help {
            Some(help) => format!("{value}  {help}"),
            None => value.clone(),
        })
        .collect();
    let question = format!("{what} (type to search, Enter to select, Esc to cancel)");
    let asked = move || screen.ask_one_of(&question, &options, has_first);
    let mut selected = None;
    on_this_thread(async {
        catch_interrupts();
        selected = Some(ask(screen, asked).await?);
        Ok(())
    })?;
    let value = selected.and_then(|at| found.get(at)).map(|candidate| candidate.value.clone());
    let value = value.ok_or_else(|| Failure::local("internal error: nothing was selected"))?;
    let line: Vec<OsString> = [args, &[value.into()]].concat();
    let words: Vec<&str> = line.iter().skip(1).filter_map(|word| word.to_str()).collect();
    if let Ok(words) = shlex::try_join(words) {
        screen.note_command("the same command without this list:", &format!("armctl {words}"));
    }
    Ok(line)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn missing_in_line(line: &str) -> Option<String> {
        let args: Vec<OsString> = line.split(' ').map(Into::into).collect();
        let error = Cli::command().try_get_matches_from(&args).unwrap_err();
        missing_argument(&error, &args)
    }

    #[test]
    fn finds_the_missing_name_or_flag_value() {
        assert_eq!(missing_in_line("armctl yerc job select").as_deref(), Some("NAME"));
        assert_eq!(missing_in_line("armctl robots remove").as_deref(), Some("NAME"));
        assert_eq!(missing_in_line("armctl status -r").as_deref(), Some("NAME"));
        assert_eq!(missing_in_line("armctl yerc move linear"), None, "its flags");
        assert_eq!(missing_in_line("armctl yerc status --color blue"), None);
    }
}
