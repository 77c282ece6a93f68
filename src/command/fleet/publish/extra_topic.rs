//! Extra commands of `--also`, whose results are published: `yerc var get B0..B9`, or `parts=yerc var get B0..B9`.

use std::rc::Rc;

use super::Kind;
use super::topic;
use crate::command::fleet::poll::Extra;
use armctl_frame::failure::Failure;
use armctl_frame::settings::target::Family;

/// An extra command and its topic level.
#[derive(Debug)]
pub struct ExtraTopic {
    level: String,
    extra: Rc<Extra>,
}

impl ExtraTopic {
    /// Parses all lines. Each command must only read, and its level must be unique.
    pub fn all(lines: &[String]) -> Result<Rc<[Self]>, Failure> {
        let mut all: Vec<Self> = Vec::with_capacity(lines.len());
        for line in lines {
            let also = Self::new(line)?;
            let is_kind = Kind::ALL.iter().any(|kind| kind.name() == also.level);
            if is_kind || also.level == "state" || all.iter().any(|other| other.level == also.level) {
                return Err(Failure::usage(format!("--also '{line}': another topic has the name '{}'", also.level))
                    .hint(format!("add a different name: --also 'NAME={}'", also.text())));
            }
            if let Some(other) = all.iter().find(|other| other.extra == also.extra) {
                return Err(Failure::usage(format!("--also '{line}' is a duplicate of '{}'", other.level))
                    .hint("remove one of them"));
            }
            all.push(also);
        }
        Ok(all.into())
    }

    fn new(line: &str) -> Result<Self, Failure> {
        let (name, text) = match line.split_once('=') {
            Some((name, text)) if !name.is_empty() && !name.contains(char::is_whitespace) => (Some(name), text),
            _ => (None, line),
        };
        let extra = Extra::parse(text)
            .map_err(|failure| Failure { message: format!("--also: {}", failure.message), ..failure })?;
        let level = if let Some(name) = name {
            topic::level(name)?
        } else {
            let words: Vec<&str> = text.split_whitespace().skip(1).collect();
            topic::level(&words.join("-").replace(['"', '\''], "")).map_err(|failure| {
                Failure { message: format!("--also '{line}': {}", failure.message), ..failure }
                    .hint(format!("add a shorter name: --also 'NAME={text}'"))
            })?
        };
        Ok(Self { level, extra: Rc::new(extra) })
    }

    /// Topic level, or prefix of the metric names.
    pub fn level(&self) -> &str {
        &self.level
    }

    /// Text of the command, as the poller uses it.
    pub fn text(&self) -> &str {
        self.extra.text()
    }

    /// Id of the command.
    pub fn id(&self) -> &'static str {
        self.extra.command().id()
    }

    /// Family of the robots.
    pub fn family(&self) -> Family {
        self.extra.family()
    }

    /// The command for the poller.
    pub fn extra(&self) -> Rc<Extra> {
        Rc::clone(&self.extra)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(lines: &[&str]) -> Result<Vec<String>, String> {
        let lines: Vec<String> = lines.iter().map(|line| (*line).to_owned()).collect();
        let all = ExtraTopic::all(&lines).map_err(|failure| failure.message)?;
        Ok(all.iter().map(|also| format!("{} {}", also.level, also.id())).collect())
    }

    #[test]
    fn each_command_line_has_its_own_level() {
        assert_eq!(
            all(&["yerc var get B0..B9", "parts=toyo counter get 1"]).unwrap(),
            ["var-get-B0..B9 yerc.var.get", "parts toyo.counter.get"]
        );
        assert!(all(&["a=yerc var get B0", "a=yerc var get B1"]).unwrap_err().contains("another topic has the name"));
        assert!(all(&["status=yerc var get B0"]).unwrap_err().contains("another topic has the name"));
        assert!(all(&["a=yerc var get B0", "b=yerc var get B0"]).unwrap_err().contains("is a duplicate"));
    }

    #[test]
    fn rejects_commands_that_do_more_than_read() {
        for line in ["yerc var set B0=1", "x=yerc job start", "yrcx servo on", "toyo home"] {
            assert!(all(&[line]).unwrap_err().contains("does more than read"), "{line}");
        }
        assert!(all(&["status"]).is_err());
    }
}
