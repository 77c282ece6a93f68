//! Help of a command for `-h` and `--help`.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use clap::builder::StyledStr;
use clap::{Arg, Command};

use crate::command::example_lines;
use armctl_frame::face::family_command::Headings;
use armctl_frame::setting::Pair;

/// Line that replaces the options of every command.
const GLOBAL_NOTE: &str = "Options of every command (-r, -t, --sim, --json …): `armctl help options`.";

/// Help of the command at `path`. The short form has only the command's own options, so that it fits a small terminal
/// if possible.
pub fn page(root: &Command, path: &[&str], is_long: bool) -> StyledStr {
    let mut command = root;
    let mut names = Vec::new();
    for word in path {
        let Some(below) = command.find_subcommand(word) else { return StyledStr::new() };
        // `path` may contain an alias.
        names.push(below.get_name());
        command = below;
    }
    let mut command = command.clone();
    if !path.is_empty() {
        command = with_template(command, root, &names, is_long);
    }
    if is_long { command.render_long_help() } else { command.render_help() }
}

/// Options of every command.
pub fn options(root: &Command) -> StyledStr {
    let all = root.get_arguments().filter(|argument| argument.is_global_set()).cloned();
    Command::new("armctl")
        .disable_help_flag(true)
        .max_term_width(100)
        .args(all)
        .help_template("{options}\n")
        .render_long_help()
}

/// Names of the options of every command.
pub fn global_options(root: &Command) -> BTreeSet<&str> {
    root.get_arguments()
        .filter(|argument| argument.is_global_set())
        .map(|argument| argument.get_id().as_str())
        .collect()
}

/// Usage in two lines if it is too long for one line: the command's own part is on the second line.
fn needs_two_lines(usage: &StyledStr) -> Option<StyledStr> {
    const WIDTH: usize = 80;
    let is_long = usage.to_string().chars().count() > WIDTH;
    let styled = usage.ansi().to_string();
    let (_, typed) = styled.split_once("Usage:")?.1.split_once(' ')?;
    let (before, own) = typed.split_once("[OPTIONS] ").filter(|_| is_long)?;
    Some(format!("{before}[OPTIONS]\n       {own}").into())
}

/// Adds examples and headings; the short form omits common options and notes.
fn with_template(mut command: Command, root: &Command, path: &[&str], is_long: bool) -> Command {
    let style = *command.get_styles().get_header();
    if let Some(usage) = needs_two_lines(&command.render_usage()) {
        command = command.override_usage(usage);
    }
    let mut after = String::new();
    let notes = command.get_after_help().map(|notes| notes.ansi().to_string());
    if let (Some(notes), true) = (&notes, is_long || command.has_subcommands()) {
        let _ = writeln!(after, "{notes}\n");
    }
    if Pair::of(&command).is_some() {
        let _ = writeln!(after, "You can write a name and its value as one word: NAME=VALUE.\n");
    }
    let examples: Vec<String> =
        if command.has_subcommands() { Vec::new() } else { example_lines::examples(path).take(3).collect() };
    if !examples.is_empty() {
        let _ = writeln!(after, "{style}Examples:{style:#}");
        for example in examples {
            let _ = writeln!(after, "  armctl {example}");
        }
        after.push('\n');
    }
    if !is_long {
        let everywhere = global_options(root);
        let shared = |argument: &Arg| argument.is_global_set() && everywhere.contains(argument.get_id().as_str());
        command = command.mut_args(|argument| if shared(&argument) { argument.hide(true) } else { argument });
        after.push_str(GLOBAL_NOTE);
    }
    if let Some(Headings(headings)) = command.get::<Headings>().copied() {
        let template = with_groups(&mut command, &headings());
        command = command.mut_subcommands(|word| word.hide(true)).help_template(template);
    }
    command.after_help(after.trim_end().to_owned())
}

/// Template with the subcommands below their headings. A subcommand without a heading follows the previous subcommand.
fn with_groups(command: &mut Command, headings: &[(Option<&'static str>, String)]) -> String {
    let (style, literal) = (*command.get_styles().get_header(), *command.get_styles().get_literal());
    let widest = command.get_subcommands().map(|word| word.get_name().len()).max().unwrap_or_default();
    let mut text = format!("{{about-with-newline}}\n{}", command.render_usage().ansi());
    let mut line = |heading: Option<&str>, word: &Command| {
        if let Some(heading) = heading {
            let _ = write!(text, "\n\n{style}{heading}:{style:#}");
        }
        let about = word.get_about().map(ToString::to_string).unwrap_or_default();
        let _ = write!(text, "\n  {literal}{:widest$}{literal:#}  {about}", word.get_name());
    };
    for (heading, name) in headings {
        if let Some(word) = command.find_subcommand(name) {
            line(*heading, word);
        }
    }
    let is_named = |word: &&Command| headings.iter().any(|(_, name)| name == word.get_name());
    command.get_subcommands().filter(|word| !is_named(word)).for_each(|word| line(None, word));
    text + "\n\n{all-args}{after-help}"
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;
    use crate::cli::Cli;

    /// Number of lines of a small terminal.
    const ROWS: usize = 24;
    /// If a command's own options need more lines than this, its help may be longer than a small terminal.
    const MAX_SHORT_OPTION_LINES: usize = 7;

    fn whole() -> Command {
        let mut whole = Cli::command().term_width(80);
        whole.build();
        whole
    }

    fn option_lines(command: &Command, path: &mut Vec<String>, look: &mut dyn FnMut(&Command, &[&str])) {
        look(command, &path.iter().map(String::as_str).collect::<Vec<_>>());
        for verb in command.get_subcommands() {
            path.push(verb.get_name().to_owned());
            option_lines(verb, path, look);
            path.pop();
        }
    }

    #[test]
    fn help_fits_a_small_terminal() {
        let whole = whole();
        let mut wrong = Vec::new();
        option_lines(&whole, &mut Vec::new(), &mut |command, path| {
            let text = page(&whole, path, false).to_string();
            let name = path.join(" ");
            wrong.extend(text.lines().filter(|line| line.chars().count() > 80).map(|line| format!("{name}: {line}")));
            if command.has_subcommands() {
                return;
            }
            let own = text
                .lines()
                .filter(|line| line.starts_with("      ") || line.starts_with("  <") || line.starts_with("  ["));
            let (own, lines) = (own.count(), text.lines().count());
            if lines > ROWS && own <= MAX_SHORT_OPTION_LINES {
                wrong.push(format!("{name}: {lines} lines, {own} of them its own options"));
            }
            if !text.contains("\nExamples:\n  armctl ")
                || !text.trim_end().ends_with(GLOBAL_NOTE)
                || text.contains("--dry-run  ")
            {
                wrong.push(format!("{name}:\n{text}"));
            }
        });
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    }

    #[test]
    fn lists_commands_below_headings() {
        let whole = whole();
        for family in ["yerc", "yrcx", "toyo"] {
            for is_long in [false, true] {
                let text = page(&whole, &[family], is_long).to_string();
                let command = whole.find_subcommand(family).unwrap();
                for word in command.get_subcommands() {
                    assert_eq!(
                        text.matches(&format!("\n  {} ", word.get_name())).count(),
                        1,
                        "{}: {text}",
                        word.get_name()
                    );
                }
                for heading in ["Status and diagnosis:", "Motion:", "Programs:", "Data:", "Signals:", "Link:"] {
                    assert!(text.contains(&format!("\n\n{heading}\n  ")), "{heading}: {text}");
                }
            }
        }
    }

    #[test]
    fn describes_every_option() {
        let whole = whole();
        let text = options(&whole).to_string();
        for argument in whole.get_arguments().filter(|argument| argument.is_global_set()) {
            assert!(text.contains(&argument.get_help().unwrap().to_string()[..6]), "{argument}: {text}");
        }
    }
}
