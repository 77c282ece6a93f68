//! Other spellings of `teach`. `yerc position teach P5`, `yerc var set P5=here`, `toyo point set 5 here`, `toyo point
//! teach 5` and `yrcx point set 19 here` mean `teach`. `yrcx point set 19 @FILE` means `--position FILE`. `explain
//! 12.600` means `explain yrcx 12.600`.

use std::ffi::OsString;

use clap::Command;

use super::typed_line::TypedLine;
use crate::command::families::FAMILIES;
use armctl_frame::face::Face;
use armctl_frame::settings::target::Family;

/// Word that means the current position of the robot.
const CURRENT_POSITION: &str = "here";

/// Converts a line to the usual spelling of its command. Returns `None` if the line has the usual spelling already.
pub fn rewrite_spelling(args: &[OsString], whole: &Command) -> Option<Vec<OsString>> {
    rewrite_teach(args, whole).or_else(|| rewrite_explain(args, whole))
}

/// Returns the families that have a code. If no family has the code, returns the families whose codes have this form.
pub fn families_with(code: &str) -> Vec<Family> {
    let bare = |code: &str| {
        let code = code.to_ascii_lowercase();
        code.strip_prefix("0x").unwrap_or(&code).trim_start_matches('0').to_owned()
    };
    let knows = |face: &&&Face| (face.codes)().iter().any(|(known, _)| bare(known) == bare(code));
    let with: Vec<Family> = FAMILIES.iter().filter(knows).map(|face| face.family).collect();
    if !with.is_empty() || !code.contains(|one: char| one.is_ascii_digit()) {
        return with;
    }
    FAMILIES.iter().filter(|face| (face.explains)(code)).map(|face| face.family).collect()
}

/// Adds the family to `explain CODE`, if only one family has the code.
fn rewrite_explain(args: &[OsString], whole: &Command) -> Option<Vec<OsString>> {
    let typed = TypedLine::new(args, whole);
    let (["explain"], [code], [at]) = (&typed.path[..], &typed.rest[..], &typed.rest_positions[..]) else {
        return None;
    };
    let [family] = families_with(code)[..] else { return None };
    let mut line = args.to_vec();
    line.insert(*at, family.name().into());
    Some(line)
}

/// Converts a command line that means `teach`.
fn rewrite_teach(args: &[OsString], whole: &Command) -> Option<Vec<OsString>> {
    let typed = TypedLine::new(args, whole);
    let (family, path) = typed.path.split_first()?;
    let replacements = match (path, &typed.rest[..]) {
        (["position" | "point"], ["teach", ..]) => [Some("teach".to_owned())].into(),
        (["var" | "point", "set"], [one]) => vec![Some(one.strip_suffix(&format!("={CURRENT_POSITION}"))?.to_owned())],
        (["point", "set"], [point, CURRENT_POSITION]) => vec![Some((*point).to_owned()), None],
        (["point", "set"], [point, file]) if *family == "yrcx" => {
            vec![Some((*point).to_owned()), Some(format!("--position={}", file.strip_prefix('@')?))]
        }
        _ => return None,
    };
    let is_file = replacements.iter().flatten().any(|word| word.starts_with("--position"));
    let mut line: Vec<Option<OsString>> = args.iter().cloned().map(Some).collect();
    for (at, word) in typed.rest_positions.iter().zip(replacements) {
        *line.get_mut(*at)? = word.map(OsString::from);
    }
    // In `position teach` and `point teach`, the noun is removed. In `var set` and `point set`, both words are replaced
    // by `teach`.
    let path: &[Option<&str>] = if is_file {
        &[]
    } else if typed.path.len() == 2 {
        &[None]
    } else {
        &[Some("teach"), None]
    };
    for (at, word) in typed.path_positions.iter().skip(1).zip(path) {
        *line.get_mut(*at)? = word.map(OsString::from);
    }
    Some(line.into_iter().flatten().collect())
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;
    use crate::cli::Cli;

    #[test]
    fn rewrites_every_spelling_to_its_command() {
        let whole = Cli::command();
        let line = |text: &str| {
            let args: Vec<OsString> = text.split(' ').map(Into::into).collect();
            let line = rewrite_spelling(&args, &whole)?;
            Some(line.join(std::ffi::OsStr::new(" ")).into_string().unwrap())
        };
        for (spelled, own) in [
            ("armctl yerc position teach P5", "armctl yerc teach P5"),
            ("armctl -r position yerc position --json teach P5 --yes", "armctl -r position yerc --json teach P5 --yes"),
            ("armctl yerc var set P5=here", "armctl yerc teach P5"),
            ("armctl toyo point set 5 here --task 2", "armctl toyo teach 5 --task 2"),
            ("armctl toyo point set 5=here", "armctl toyo teach 5"),
            ("armctl toyo point teach 5", "armctl toyo teach 5"),
            ("armctl yrcx point set 19 here", "armctl yrcx teach 19"),
            ("armctl yrcx point set 19 @-", "armctl yrcx point set 19 --position=-"),
            ("armctl explain 12.600", "armctl explain yrcx 12.600"),
            ("armctl explain -r cell3 4315", "armctl explain -r cell3 yerc 4315"),
            ("armctl explain 0x2060 --json", "armctl explain yerc 0x2060 --json"),
        ] {
            assert_eq!(line(spelled).as_deref(), Some(own), "{spelled}");
        }
        for other in [
            "armctl yerc position",
            "armctl yerc var set P5=here B0=1",
            "armctl toyo point set 5 @here",
            "armctl explain 28",
            "armctl explain x",
        ] {
            assert_eq!(line(other), None, "{other}");
        }
    }
}
