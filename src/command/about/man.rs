//! `armctl man`: man pages, one per noun.

use std::io::{self, Write as _};

use clap::Command;

use super::{environment, page};
use crate::command::example_lines;
use armctl_frame::prelude::*;

/// Write the man pages into a folder, or print the man page of `armctl`.
#[derive(Debug, Args)]
pub struct Man {
    /// Folder, such as /usr/local/share/man/man1; it must exist
    #[arg(long, value_name = "DIR")]
    dir: Option<PathBuf>,
}

impl Man {
    /// Writes the pages; `root` creates the whole command line.
    pub fn run(self, run: &Run, root: fn() -> Command) -> Result<()> {
        let pages = pages(root())?;
        let Some(dir) = self.dir else {
            let first = pages.first().map(|(_, page)| page.as_slice()).unwrap_or_default();
            return run.screen.bytes(first);
        };
        for (name, page) in &pages {
            write(&dir.join(name), page)?;
        }
        run.screen.note(&format!("{} man pages written to {}", pages.len(), dir.display()));
        Ok(())
    }
}

fn write(path: &Path, page: &[u8]) -> Result<()> {
    Ok(std::fs::write(path, page).with_context(|| path.display().to_string())?)
}

/// File name and text of every man page: `armctl.1`, one for each noun (`armctl-toyo-counter.1`), and one for each
/// command without a noun (`armctl-status.1`). The page of a noun describes its verbs.
pub fn pages(mut root: Command) -> Result<Vec<(String, Vec<u8>)>> {
    root.build();
    let mut pages = Vec::new();
    pages_below(&root, &root, &[], &mut pages).map_err(|error| Failure::io("man pages", &error))?;
    Ok(pages)
}

fn pages_below(root: &Command, command: &Command, path: &[&str], pages: &mut Vec<(String, Vec<u8>)>) -> io::Result<()> {
    pages.push((format!("{}.1", name_of(path)), render_page(root, command, path)?));
    let below = verbs(command).filter(|verb| has_page(path, verb));
    below.into_iter().try_for_each(|verb| pages_below(root, verb, &[path, &[verb.get_name()]].concat(), pages))
}

/// Whether the command below `path` has its own page.
fn has_page(path: &[&str], command: &Command) -> bool {
    path.is_empty() || command.has_subcommands()
}

/// Page names have hyphens instead of blanks.
fn name_of(path: &[&str]) -> String {
    [&["armctl"], path].concat().join("-")
}

fn verbs(command: &Command) -> impl Iterator<Item = &Command> {
    command.get_subcommands().filter(|verb| !verb.is_hide_set())
}

fn render_page(root: &Command, command: &Command, path: &[&str]) -> io::Result<Vec<u8>> {
    let shared = page::global_options(root);
    // The page of `armctl` has the global options; all others refer to it.
    let left_out = if path.is_empty() { &BTreeSet::new() } else { &shared };
    let shown = with_own_options(command, left_out).name(name_of(path));
    let (described, listed): (Vec<&Command>, Vec<&Command>) = verbs(command).partition(|verb| !has_page(path, verb));
    let mut text = Vec::new();
    // No date, so that the committed pages depend only on the text.
    let man = clap_mangen::Man::new(shown.clone()).date("").source("armctl").manual("armctl manual");
    man.render_title(&mut text)?;
    man.render_name_section(&mut text)?;
    writeln!(text, ".SH SYNOPSIS")?;
    if described.is_empty() || path.is_empty() {
        writeln!(text, ".B {}", usage(command))?;
    }
    for verb in &described {
        writeln!(text, ".B {}\n.br", usage(verb))?;
    }
    man.render_description_section(&mut text)?;
    write_notes(&shown, &mut text)?;
    if path.is_empty() || !command.has_subcommands() {
        man.render_options_section(&mut text)?;
    }
    write_examples(path, command, ".SH EXAMPLES", &mut text)?;
    if !described.is_empty() {
        writeln!(text, ".SH COMMANDS")?;
    }
    for verb in described {
        write_verb(verb, &[path, &[verb.get_name()]].concat(), &shared, &mut text)?;
    }
    if !listed.is_empty() {
        writeln!(text, ".SH \"COMMANDS WITH A PAGE\"")?;
    }
    for verb in &listed {
        let about = verb.get_about().map(ToString::to_string).unwrap_or_default();
        let name = name_of(&[path, &[verb.get_name()]].concat());
        writeln!(text, ".TP\n\\fB{}\\fR(1)\n{}", escape(&name), escape(&about))?;
    }
    write_end(path, &listed, &mut text)?;
    Ok(text)
}

/// Section of a verb in the page of its noun.
fn write_verb(verb: &Command, path: &[&str], shared: &BTreeSet<&str>, text: &mut Vec<u8>) -> io::Result<()> {
    let shown = with_own_options(verb, shared).mut_args(|argument| {
        let is_hidden = argument.is_hide_set() || argument.get_long() == Some("help");
        argument.hide(is_hidden)
    });
    writeln!(text, ".SS {}", escape(verb.get_name()))?;
    let about = shown.get_long_about().or(shown.get_about()).map(ToString::to_string).unwrap_or_default();
    write_paragraphs(&about, text)?;
    write_notes(&shown, text)?;
    let mut options = Vec::new();
    clap_mangen::Man::new(shown).render_options_section(&mut options)?;
    let options = String::from_utf8_lossy(&options);
    // A verb is a part of a section, and so are its options.
    for line in options.lines().filter(|line| !line.starts_with(".ie") && !line.starts_with(".el")) {
        match line.strip_prefix(".SH ") {
            Some("OPTIONS") => {}
            Some(heading) => writeln!(text, ".PP\n{}:", heading.trim_matches('"'))?,
            None => writeln!(text, "{line}")?,
        }
    }
    write_examples(path, verb, ".PP\nExamples:", text)
}

fn write_notes(command: &Command, text: &mut Vec<u8>) -> io::Result<()> {
    let notes = command.get_after_help().map(ToString::to_string).unwrap_or_default();
    notes.lines().filter(|line| !line.is_empty()).try_for_each(|line| writeln!(text, ".PP\n{}", escape(line)))
}

fn write_paragraphs(about: &str, text: &mut Vec<u8>) -> io::Result<()> {
    about.lines().try_for_each(|line| match line.trim() {
        "" => writeln!(text, ".PP"),
        line => writeln!(text, "{}", escape(line)),
    })
}

fn write_examples(path: &[&str], command: &Command, heading: &str, text: &mut Vec<u8>) -> io::Result<()> {
    let examples: Vec<String> =
        if command.has_subcommands() { Vec::new() } else { example_lines::examples(path).collect() };
    if examples.is_empty() {
        return Ok(());
    }
    writeln!(text, "{heading}\n.RS\n.nf")?;
    for example in examples {
        writeln!(text, "armctl {}", escape(&example))?;
    }
    writeln!(text, ".fi\n.RE")
}

/// Sections that end each page.
fn write_end(path: &[&str], listed: &[&Command], text: &mut Vec<u8>) -> io::Result<()> {
    if path.is_empty() {
        writeln!(text, ".SH \"EXIT STATUS\"")?;
        for (_, exit, meaning) in Kind::TABLE {
            writeln!(text, ".TP\n{exit}\n{}", escape(meaning))?;
        }
        writeln!(text, ".SH ENVIRONMENT")?;
        for (name, what) in environment::VARIABLES {
            writeln!(text, ".TP\n{name}\n{}", escape(what))?;
        }
        writeln!(text, ".PP\n{}", escape(environment::ORDER))?;
    } else {
        writeln!(
            text,
            ".SH \"GLOBAL OPTIONS\"\nOptions of every command, such as \\-h, \\-r, \\-t, \\-\\-sim and \\-\\-json: see \
         \\fBarmctl\\fR(1)."
        )?;
        writeln!(
            text,
            ".SH \"EXIT STATUS\"\n0 for success, 2 for a wrong command line. See \\fBarmctl\\fR(1) for the others."
        )?;
    }
    let above = path.split_last().map(|(_, above)| name_of(above));
    let below = listed.iter().map(|verb| name_of(&[path, &[verb.get_name()]].concat()));
    let see = above.into_iter().chain(below).map(|name| format!("\\fB{}\\fR(1)", escape(&name)));
    writeln!(text, ".SH \"SEE ALSO\"\n{}", see.collect::<Vec<_>>().join(",\n"))
}

/// Words and arguments of a command line.
fn usage(command: &Command) -> String {
    let usage = command.clone().render_usage().to_string();
    escape(usage.trim_start_matches("Usage: "))
}

/// The command without the options of every command, and with the options that the short help omits.
fn with_own_options(command: &Command, shared: &BTreeSet<&str>) -> Command {
    command.clone().mut_args(|argument| {
        let is_shared = argument.is_global_set() && shared.contains(argument.get_id().as_str());
        let is_hidden = argument.is_hide_set() || is_shared;
        argument.hide_short_help(false).hide(is_hidden)
    })
}

/// Text with roff control characters escaped.
fn escape(text: &str) -> String {
    let text = text.replace('\\', "\\e").replace('-', "\\-").replace('\'', "\\(aq");
    if text.starts_with('.') { format!("\\&{text}") } else { text }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;
    use crate::cli::Cli;

    #[test]
    fn pages_describe_usage_and_every_option() {
        for (name, page) in pages(Cli::command()).unwrap() {
            let page = String::from_utf8(page).unwrap();
            for section in
                [".SH SYNOPSIS\n.B armctl", ".SH DESCRIPTION\n", ".SH \"EXIT STATUS\"\n", ".SH \"SEE ALSO\"\n"]
            {
                assert!(page.contains(section), "{name}: {section}");
            }
            assert_eq!(
                page.contains(".SH EXAMPLES"),
                !page.contains(".SH COMMANDS") && !page.contains(".SH \"COMMANDS"),
                "{name}"
            );
            let options = page.split(".TP\n").skip(1);
            let bare = options.filter(|option| option.lines().nth(1).is_none_or(|text| text.trim().is_empty()));
            assert_eq!(bare.collect::<Vec<_>>(), Vec::<&str>::new(), "{name}");
        }
    }
}
