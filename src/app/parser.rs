//! From words to a command line.

use std::ffi::OsString;

use clap::{Command, CommandFactory as _, FromArgMatches as _, Subcommand};

use crate::cli::{Cli, OfToyo, OfYerc, OfYrcx, Top, Words};
use crate::settings::target::Family;

/// Reads command lines. To lay out all commands takes longer than all the rest of a short one, so a line that names a
/// family is tried on that family alone, and what was laid out serves the next line, too.
#[derive(Debug, Default)]
pub struct Parser {
    yerc: Option<Command>,
    yrcx: Option<Command>,
    toyo: Option<Command>,
    all: Option<Command>,
}

impl Parser {
    /// Reads a line, the program's name included. What does not parse as one of its family is left to the whole, which
    /// knows more to say about it.
    pub fn parse(&mut self, args: &[OsString]) -> Result<Cli, clap::Error> {
        let family = args.iter().skip(1).find_map(|word| word.to_str()?.parse::<Family>().ok());
        let tried = match family {
            Some(Family::Yerc) => words::<OfYerc>(&mut self.yerc, args).map(|words| words.into_top(Top::Yerc)),
            Some(Family::Yrcx) => words::<OfYrcx>(&mut self.yrcx, args).map(|words| words.into_top(Top::Yrcx)),
            Some(Family::Toyo) => words::<OfToyo>(&mut self.toyo, args).map(|words| words.into_top(Top::Toyo)),
            None => return words(&mut self.all, args),
        };
        tried.or_else(|_| words(&mut self.all, args))
    }

    /// Whose command a word is: of this family, of all (`None`), or of nobody.
    pub fn owner(&mut self, word: &str, family: Option<Family>) -> Option<Option<Family>> {
        let of_family = family.is_some_and(|family| {
            let all = match family {
                Family::Yerc => laid_out::<OfYerc>(&mut self.yerc),
                Family::Yrcx => laid_out::<OfYrcx>(&mut self.yrcx),
                Family::Toyo => laid_out::<OfToyo>(&mut self.toyo),
            };
            all.find_subcommand(family.name()).is_some_and(|own| own.find_subcommand(word).is_some())
        });
        if of_family {
            return Some(family);
        }
        laid_out::<Top>(&mut self.all).find_subcommand(word).is_some().then_some(None)
    }

    /// Goes without taking it all apart: it holds some thousand parts, the process is about to end, and to free them one
    /// by one would be a quarter of all the work that a short command is.
    pub fn abandon(self) {
        std::mem::forget(self);
    }
}

fn laid_out<C: Subcommand>(command: &mut Option<Command>) -> &mut Command {
    command.get_or_insert_with(Words::<C>::command)
}

fn words<C: Subcommand>(command: &mut Option<Command>, args: &[OsString]) -> Result<Words<C>, clap::Error> {
    let command = laid_out::<C>(command);
    let parsed = command.try_get_matches_from_mut(args);
    let words = parsed.and_then(|mut matches| Words::from_arg_matches_mut(&mut matches));
    words.map_err(|error| error.format(command))
}

impl<C: Subcommand> Words<C> {
    fn into_top(self, top: impl FnOnce(C) -> Top) -> Cli {
        Words { globals: self.globals, command: top(self.command) }
    }
}
