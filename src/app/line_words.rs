//! Splits a line into words, like a shell.

use armctl_frame::batch::is_name;

/// Splits a line into words, with quotes, backslashes and `#` as in a shell. The result is empty for an empty line or a
/// comment.
pub fn split(line: &str) -> Result<Vec<String>, String> {
    let words = shlex::split(line).ok_or("a closing quote, or the character after a backslash, is missing")?;
    // A line copied from the documentation starts with the program name.
    let has_program_name = words.first().is_some_and(|word| word == "armctl");
    Ok(words.into_iter().skip(usize::from(has_program_name)).collect())
}

/// Replaces `${NAME}` in a word by the value of the variable. `$${` stands for `${`.
pub fn expand_variables<'a>(word: &str, value: impl Fn(&str) -> Option<&'a str>) -> Result<String, String> {
    let mut expanded = String::new();
    let mut rest = word;
    while let Some(at) = rest.find("${") {
        let (before, after) = (&rest[..at], &rest[at + 2..]);
        if let Some(before) = before.strip_suffix('$') {
            expanded.push_str(before);
            expanded.push_str("${");
            rest = after;
            continue;
        }
        expanded.push_str(before);
        let (name, after) = after.split_once('}').ok_or_else(|| format!("'{rest}' has no closing }}"))?;
        if !is_name(name) {
            return Err(format!("'{name}' is not a variable name"));
        }
        expanded.push_str(value(name).ok_or_else(|| format!("${{{name}}} has no value: add --set {name}=VALUE"))?);
        rest = after;
    }
    expanded.push_str(rest);
    Ok(expanded)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn splits_lines_as_a_shell_does() {
        let words = |line: &str| split(line).unwrap().join("|");
        assert_eq!(words("yerc say 'BACK AT NOON' # later"), "yerc|say|BACK AT NOON");
        assert_eq!(words("  # nothing"), "");
        assert_eq!(words(r#"armctl yerc file get "A B.JBI" C\ D"#), "yerc|file|get|A B.JBI|C D");
        assert_eq!(words("yerc status --jq '.data|.mode#x'"), "yerc|status|--jq|.data|.mode#x");
        assert!(split("say 'open").is_err());
    }

    #[test]
    fn expands_variables_within_words() {
        let value = |name: &str| [("job", "WELD 1"), ("n", "3")].iter().find(|pair| pair.0 == name).map(|pair| pair.1);
        assert_eq!(expand_variables("${job}", value).unwrap(), "WELD 1");
        assert_eq!(expand_variables("B${n}=${n}", value).unwrap(), "B3=3");
        assert_eq!(expand_variables(".a as $x | $${n}", value).unwrap(), ".a as $x | ${n}");
        assert!(expand_variables("${job", value).unwrap_err().contains("no closing }"));
        assert!(expand_variables("${none}", value).unwrap_err().contains("--set none="));
        assert!(expand_variables("${a b}", value).is_err());
    }
}
