//! Splitting of a line into words, as a shell does.

use crate::command::frame::batch::is_name;

/// Splits a line: quotes, backslashes and `#` as in a shell. Empty for an empty line or a comment.
pub fn split(line: &str) -> Result<Vec<String>, String> {
    let words = shlex::split(line).ok_or("a closing quote, or the character after a backslash, is missing")?;
    // For lines copied from the documentation.
    let named = words.first().is_some_and(|word| word == "armctl");
    Ok(words.into_iter().skip(usize::from(named)).collect())
}

/// Replaces `${NAME}` in a word by its value; `$${` means `${`.
pub fn expanded<'a>(word: &str, value: impl Fn(&str) -> Option<&'a str>) -> Result<String, String> {
    let mut done = String::new();
    let mut rest = word;
    while let Some(at) = rest.find("${") {
        let (before, after) = (&rest[..at], &rest[at + 2..]);
        if let Some(before) = before.strip_suffix('$') {
            done.push_str(before);
            done.push_str("${");
            rest = after;
            continue;
        }
        done.push_str(before);
        let (name, after) = after.split_once('}').ok_or_else(|| format!("'{rest}' has no }}"))?;
        if !is_name(name) {
            return Err(format!("'{name}' is not a variable name"));
        }
        done.push_str(value(name).ok_or_else(|| format!("${{{name}}} has no value: add --set {name}=VALUE"))?);
        rest = after;
    }
    done.push_str(rest);
    Ok(done)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_split_as_a_shell_does() {
        let words = |line: &str| split(line).unwrap().join("|");
        assert_eq!(words("yerc say 'BACK AT NOON' # later"), "yerc|say|BACK AT NOON");
        assert_eq!(words("  # nothing"), "");
        assert_eq!(words(r#"armctl yerc file get "A B.JBI" C\ D"#), "yerc|file|get|A B.JBI|C D");
        assert_eq!(words("yerc status --jq '.data|.mode#x'"), "yerc|status|--jq|.data|.mode#x");
        assert!(split("say 'open").is_err());
    }

    #[test]
    fn variables_are_replaced_within_words() {
        let value = |name: &str| [("job", "WELD 1"), ("n", "3")].iter().find(|pair| pair.0 == name).map(|pair| pair.1);
        assert_eq!(expanded("${job}", value).unwrap(), "WELD 1");
        assert_eq!(expanded("B${n}=${n}", value).unwrap(), "B3=3");
        assert_eq!(expanded(".a as $x | $${n}", value).unwrap(), ".a as $x | ${n}");
        assert!(expanded("${job", value).unwrap_err().contains("no }"));
        assert!(expanded("${none}", value).unwrap_err().contains("--set none="));
        assert!(expanded("${a b}", value).is_err());
    }
}
