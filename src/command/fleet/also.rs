//! Extra commands of `--also`, whose answers are published or served: `yerc var get B0..B9`, or
//! `parts=yerc var get B0..B9`.

use std::rc::Rc;

use super::poll::Extra;
use super::publish::topic;
use armctl_frame::prelude::*;

/// The flag for extra commands.
#[derive(Debug, Args)]
#[group(skip)]
pub struct AlsoArguments {
    /// A read command whose answer is also sent, such as 'yerc var get B0..B9' or 'parts=toyo counter get 1'
    /// (repeatable)
    #[arg(long, value_name = "LINE")]
    also: Vec<String>,
}

/// An extra command and its name.
#[derive(Debug)]
pub struct AlsoCommand {
    name: String,
    extra: Rc<Extra>,
}

impl AlsoArguments {
    /// Parses all lines. Each command must only read, and its name must be unique and not reserved.
    pub fn commands(&self, is_reserved: impl Fn(&str) -> bool) -> Result<Rc<[AlsoCommand]>> {
        let mut all: Vec<AlsoCommand> = Vec::with_capacity(self.also.len());
        for line in &self.also {
            let also = AlsoCommand::new(line)?;
            if is_reserved(&also.name) || all.iter().any(|other| other.name == also.name) {
                return Err(Failure::usage(format!("--also '{line}': another topic has the name '{}'", also.name))
                    .hint(format!("add a different name: --also 'NAME={}'", also.text())));
            }
            if let Some(other) = all.iter().find(|other| other.extra == also.extra) {
                return Err(Failure::usage(format!("--also '{line}' is a duplicate of '{}'", other.name))
                    .hint("remove one of them"));
            }
            all.push(also);
        }
        Ok(all.into())
    }
}

impl AlsoCommand {
    fn new(line: &str) -> Result<Self> {
        let (name, text) = match line.split_once('=') {
            Some((name, text)) if !name.is_empty() && !name.contains(char::is_whitespace) => (Some(name), text),
            _ => (None, line),
        };
        let extra = Extra::parse(text)
            .map_err(|failure| Failure { message: format!("--also: {}", failure.message), ..failure })?;
        let name = if let Some(name) = name {
            topic::level(name)?
        } else {
            let words: Vec<&str> = text.split_whitespace().skip(1).collect();
            topic::level(&words.join("-").replace(['"', '\''], "")).map_err(|failure| {
                Failure { message: format!("--also '{line}': {}", failure.message), ..failure }
                    .hint(format!("add a shorter name: --also 'NAME={text}'"))
            })?
        };
        Ok(Self { name, extra: Rc::new(extra) })
    }

    /// Name: a topic level, the prefix of metric names, or a label.
    pub fn name(&self) -> &str {
        &self.name
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
impl AlsoArguments {
    /// The flag with these lines.
    pub fn of(lines: &[&str]) -> Self {
        Self { also: lines.iter().map(|line| (*line).to_owned()).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(lines: &[&str]) -> Result<Vec<String>, String> {
        let all = AlsoArguments::of(lines).commands(|name| name == "status").map_err(|failure| failure.message)?;
        Ok(all.iter().map(|also| format!("{} {}", also.name, also.id())).collect())
    }

    #[test]
    fn each_command_line_has_its_own_name() {
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
