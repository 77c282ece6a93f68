//! `armctl help environment`, and the section of the man page.

/// Environment variables and their meaning.
pub const VARIABLES: [(&str, &str); 13] = [
    ("ARMCTL_TARGET", "URL or address of the controller; same as -t"),
    ("ARMCTL_ROBOT", "robots of the inventory: NAME, or NAME,NAME; same as -r"),
    ("ARMCTL_CONFIG", "path of the inventory; same as --config"),
    ("ARMCTL_OUTPUT", "output format: table, json, jsonl, csv or value; same as -o"),
    ("ARMCTL_TIMEOUT", "maximum wait for an answer, for each try; same as --timeout"),
    ("ARMCTL_RETRIES", "retries of a read without an answer; same as --retries"),
    ("ARMCTL_ENCODING", "encoding of texts on the controller; same as --encoding"),
    ("NO_COLOR", "no color, unless --color is set"),
    ("CLICOLOR_FORCE", "color also in files, unless the value is 0 or NO_COLOR is set"),
    ("TERM", "`dumb` means no color, no pager and no full-screen display"),
    ("PAGER", "program for long help on a terminal; `cat` means no pager"),
    ("XDG_CONFIG_HOME", "folder that contains armctl/robots.toml, instead of ~/.config"),
    ("XDG_RUNTIME_DIR", "folder of the session sockets"),
];

/// Priority of the variables.
pub const ORDER: &str = "A flag has priority over the environment, the environment over robots.toml.
An empty variable has no effect. A wrong value is an error that names the
variable (exit code 2). ARMCTL_TARGET and ARMCTL_ROBOT together are an error,
unless a flag selects the robot. For several robots, commands that move, delete
or overwrite accept only -r.";

/// Text of the topic.
pub fn text() -> String {
    let line = |(name, what): &(&str, &str)| format!("  {name:<16} {what}\n");
    format!("Environment\n\n{}\n{ORDER}\n", VARIABLES.iter().map(line).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_every_variable_of_a_flag() {
        let help = crate::command::about::help::text(&["options".to_owned()], false, || {
            <crate::cli::Cli as clap::CommandFactory>::command()
        });
        let help = help.unwrap();
        let named: Vec<&str> = help.split(|c: char| !(c.is_ascii_uppercase() || c == '_')).collect();
        for name in named.into_iter().filter(|name| name.starts_with("ARMCTL_")) {
            assert!(VARIABLES.iter().any(|(known, _)| *known == name), "{name}");
        }
        assert!(text().lines().all(|line| line.chars().count() <= 80), "{}", text());
    }
}
