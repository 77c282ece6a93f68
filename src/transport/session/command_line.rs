//! Command lines of Windows: one text, which each program splits into its arguments.

/// Joins a program name and its arguments. Programs split the text with the rules of `CommandLineToArgvW`.
pub fn command_line(program: &str, arguments: &[String]) -> String {
    let mut line = program.to_owned();
    for argument in arguments {
        line.push(' ');
        quote(argument, &mut line);
    }
    line
}

/// Appends an argument in quotes. Backslashes are special only before a quote.
fn quote(argument: &str, line: &mut String) {
    line.push('"');
    let mut backslashes = 0;
    for character in argument.chars() {
        if character == '"' {
            line.extend(std::iter::repeat_n('\\', backslashes + 1));
        }
        backslashes = if character == '\\' { backslashes + 1 } else { 0 };
        line.push(character);
    }
    line.extend(std::iter::repeat_n('\\', backslashes));
    line.push('"');
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_survive_quotes_and_backslashes() {
        let line = |argument: &str| command_line("armctl", &[argument.to_owned()]);
        assert_eq!(line("status"), r#"armctl "status""#);
        assert_eq!(line(""), r#"armctl """#);
        assert_eq!(line(r"C:\my robots\robots.toml"), r#"armctl "C:\my robots\robots.toml""#);
        assert_eq!(line(r"C:\robots\"), r#"armctl "C:\robots\\""#);
        assert_eq!(line(r#"say "hi""#), r#"armctl "say \"hi\"""#);
        assert_eq!(line(r#"\""#), r#"armctl "\\\"""#);
    }
}
