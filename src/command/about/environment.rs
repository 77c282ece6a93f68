//! `armctl help environment`, and the section of the man page.

/// Environment variables and their meaning.
pub const VARIABLES: [(&str, &str); 13] = [
    ("ARMCTL_TARGET", "URL or address of the controller, as -t"),
    ("ARMCTL_ROBOT", "robots of the inventory, as -r: NAME, or NAME,NAME"),
    ("ARMCTL_CONFIG", "the inventory, as --config"),
    ("ARMCTL_OUTPUT", "output format, as -o: table, json, jsonl, csv or value"),
    ("ARMCTL_TIMEOUT", "maximum wait for an answer, for each try, as --timeout"),
    ("ARMCTL_RETRIES", "more tries of a read without an answer, as --retries"),
    ("ARMCTL_ENCODING", "encoding of names and texts on the controller, as --encoding"),
    ("NO_COLOR", "no color, unless --color is given"),
    ("CLICOLOR_FORCE", "color also in files, unless it is 0 or NO_COLOR is set"),
    ("TERM", "dumb: no color, no pager, no full-screen display"),
    ("PAGER", "program that shows long help on a terminal; cat for none"),
    ("XDG_CONFIG_HOME", "folder of armctl/robots.toml, instead of ~/.config"),
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
