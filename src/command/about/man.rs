//! `armctl man`: man pages, one per command.

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use anyhow::Context as _;
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
    pub fn run(self, run: &Run, root: fn() -> Command) -> Result<(), Failure> {
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

fn write(path: &Path, page: &[u8]) -> Result<(), Failure> {
    Ok(std::fs::write(path, page).with_context(|| path.display().to_string())?)
}

/// File name and text of every man page: `armctl.1`, `armctl-yerc-status.1`, …
pub fn pages(mut root: Command) -> Result<Vec<(String, Vec<u8>)>, Failure> {
    root.build();
    let mut pages = Vec::new();
    pages_below(&root, &mut Vec::new(), &mut pages).map_err(|error| Failure::io("man pages", &error))?;
    Ok(pages)
}

fn pages_below<'a>(root: &'a Command, path: &mut Vec<&'a str>, pages: &mut Vec<(String, Vec<u8>)>) -> io::Result<()> {
    let Some(command) = path.iter().try_fold(root, |command, word| command.find_subcommand(word)) else {
        return Ok(());
    };
    pages.push((format!("{}.1", name_of(path)), render_page(root, command, path)?));
    for verb in verbs(command) {
        path.push(verb.get_name());
        pages_below(root, path, pages)?;
        path.pop();
    }
    Ok(())
}

/// Page names have hyphens.
fn name_of(path: &[&str]) -> String {
    [&["armctl"], path].concat().join("-")
}

fn verbs(command: &Command) -> impl Iterator<Item = &Command> {
    command.get_subcommands().filter(|verb| !verb.is_hide_set())
}

fn render_page(root: &Command, command: &Command, path: &[&str]) -> io::Result<Vec<u8>> {
    let everywhere = page::global_options(root);
    let mut own = command.clone().name(name_of(path)).mut_args(|argument| {
        let is_own = path.is_empty() || !argument.is_global_set() || !everywhere.contains(argument.get_id().as_str());
        // Man pages include options that the short help omits.
        argument.hide_short_help(false).hide(!is_own)
    });
    let usage = own.render_usage().to_string();
    let notes = own.get_after_help().map(ToString::to_string).unwrap_or_default();
    let mut text = Vec::new();
    // No date, so that the committed pages depend only on the text.
    let man = clap_mangen::Man::new(own).date("").source("armctl").manual("armctl manual");
    man.render_title(&mut text)?;
    man.render_name_section(&mut text)?;
    writeln!(text, ".SH SYNOPSIS\n.B {}", escape(usage.trim_start_matches("Usage: ")))?;
    man.render_description_section(&mut text)?;
    for paragraph in notes.lines().filter(|line| !line.is_empty()) {
        writeln!(text, ".PP\n{}", escape(paragraph))?;
    }
    man.render_options_section(&mut text)?;
    if command.has_subcommands() {
        man.render_subcommands_section(&mut text)?;
    }
    if !path.is_empty() {
        writeln!(
            text,
            ".SH \"GLOBAL OPTIONS\"\nOptions of every command, such as \\-r, \\-t, \\-\\-sim and \\-\\-json: see \
             \\fBarmctl\\fR(1)."
        )?;
    }
    let examples: Vec<String> =
        if command.has_subcommands() { Vec::new() } else { example_lines::examples(path).collect() };
    if !examples.is_empty() {
        writeln!(text, ".SH EXAMPLES\n.nf")?;
        for example in examples {
            writeln!(text, "armctl {}", escape(&example))?;
        }
        writeln!(text, ".fi")?;
    }
    writeln!(text, ".SH \"EXIT STATUS\"")?;
    if path.is_empty() {
        for (_, exit, meaning) in Kind::TABLE {
            writeln!(text, ".TP\n{exit}\n{}", escape(meaning))?;
        }
    } else {
        writeln!(text, "0 for success, 2 for a wrong command line. See \\fBarmctl\\fR(1) for the others.")?;
    }
    if path.is_empty() {
        writeln!(text, ".SH ENVIRONMENT")?;
        for (name, what) in environment::VARIABLES {
            writeln!(text, ".TP\n{name}\n{}", escape(what))?;
        }
        writeln!(text, ".PP\n{}", escape(environment::ORDER))?;
    }
    let see =
        see_also(root, command, path).iter().map(|name| format!("\\fB{}\\fR(1)", escape(name))).collect::<Vec<_>>();
    writeln!(text, ".SH \"SEE ALSO\"\n{}", see.join(",\n"))?;
    Ok(text)
}

/// Pages of the commands above and below this one, and of related verbs.
fn see_also(root: &Command, command: &Command, path: &[&str]) -> Vec<String> {
    let below = verbs(command).map(|verb| name_of(&[path, &[verb.get_name()]].concat()));
    let Some((last, above)) = path.split_last() else { return below.collect() };
    let noun = above.iter().try_fold(root, |command, word| command.find_subcommand(word));
    let related = noun.filter(|_| above.len() > 1).into_iter().flat_map(verbs).map(Command::get_name);
    let beside = related.filter(|name| name != last).map(|name| name_of(&[above, &[name]].concat()));
    std::iter::once(name_of(above)).chain(beside).chain(below).collect()
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
            assert_eq!(page.contains(".SH EXAMPLES"), !page.contains(".SH SUBCOMMANDS"), "{name}");
            let options = page.split(".TP\n").skip(1);
            let bare = options.filter(|option| option.lines().nth(1).is_none_or(|text| text.trim().is_empty()));
            assert_eq!(bare.collect::<Vec<_>>(), Vec::<&str>::new(), "{name}");
        }
    }
}
