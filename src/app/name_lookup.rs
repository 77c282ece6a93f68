//! Command lines that contain names instead of addresses.

use std::ffi::OsString;

use super::parser::{Parser, Refusal};
use super::prepare::{Need, sources};
use crate::cli::{Cli, Top};
use armctl_frame::flags::Globals;
use armctl_frame::names;

/// Parses a line that may contain names instead of addresses. `all` contains the global flags for all lines, if there
/// are several lines. `among` is `true` if this process also runs other lines; its simulators then stay alive between
/// lines.
pub fn parse(parser: &mut Parser, args: &[OsString], all: Option<&Globals>, among: bool) -> Result<Cli, Refusal> {
    let (parsed, is_named) = names::detect_names(|| parser.parse(args));
    if !is_named {
        return parsed;
    }
    let cli = parsed?;
    let Top::Family(word) = &cli.command else { return Ok(cli) };
    let globals = cli.globals.clone();
    let globals = match all {
        Some(all) => globals.within(all),
        None => globals,
    };
    let sources = sources(globals, Need::Inventory, among).map_err(Refusal::Failed)?;
    let robots = sources.robots(Some(word.family)).map_err(Refusal::Failed)?;
    names::with_names(word.family, &robots, || parser.parse(args))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(line: &str) -> Result<Cli, String> {
        let args: Vec<OsString> = line.split(' ').map(OsString::from).collect();
        parse(&mut Parser::default(), &args, None, false).map_err(|refusal| refusal.failure().message)
    }

    #[test]
    fn looks_names_up_after_the_robot_is_known() {
        for line in [
            "armctl --sim yerc io get gripper",
            "armctl --sim yerc io get 20010,GRIPPER",
            "armctl --sim yerc var get parts_done B0..B3",
            "armctl --sim yerc var set PARTS_DONE=7",
            "armctl --sim yerc register get LINE_SPEED",
        ] {
            assert!(parsed(line).is_ok(), "{line}: {:?}", parsed(line).err());
        }
        for (line, why) in [
            ("armctl --sim yerc io get griper", "did you mean 'GRIPPER'?"),
            ("armctl --sim yerc io get PARTS_DONE", "not a valid signal"),
            ("armctl --sim yerc io get 20018", "from 0 to 7"),
            ("armctl --sim yerc io set GRIPPER=maybe", "use on or off"),
            ("armctl --sim yerc var set PARTS_DONE=x", "not a number from 0 to 255"),
            ("armctl --sim yerc var set PARTS_DONE", "write a variable, '=' and a value"),
            ("armctl --sim yrcx io get GRIPPER", "not a valid signal"),
        ] {
            let failure_text = parsed(line).err().unwrap_or_default();
            assert!(failure_text.contains(why), "{line}: {failure_text}");
        }
    }
}
