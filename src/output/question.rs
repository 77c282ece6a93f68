//! Questions with an answer of their own: a line, a number of a list, yes or no. As in `prompt`, the terminal stays as
//! it is.

use super::Screen;
use crate::failure::Failure;

impl Screen {
    /// Asks for a line. An empty one is `usual`; where there is none, it is asked again.
    pub fn ask_line(&self, question: &str, usual: Option<&str>) -> Result<String, Failure> {
        let shown = usual.map(|usual| format!(" [{usual}]")).unwrap_or_default();
        loop {
            let answer = Self::ask(&format!("{question}{shown}:"))?;
            let answer = String::from_utf8_lossy(&answer).trim().to_owned();
            match (answer.is_empty(), usual) {
                (false, _) => return Ok(answer),
                (true, Some(usual)) => return Ok(usual.to_owned()),
                (true, None) => {}
            }
        }
    }

    /// Asks for one of a list, the first unless another is chosen; its place comes back.
    pub fn ask_choice(&self, question: &str, options: &[String]) -> Result<usize, Failure> {
        let numbered = options.iter().zip(1..).map(|(option, number)| format!("\n  {number}  {option}"));
        self.ask_note(&format!("\n{question}{}", numbered.collect::<String>()));
        loop {
            let answer = self.ask_line("Number", Some("1"))?;
            match answer.parse::<usize>().ok().and_then(|number| number.checked_sub(1)) {
                Some(at) if at < options.len() => return Ok(at),
                _ => self.ask_note(&format!("type a number from 1 to {}", options.len())),
            }
        }
    }

    /// Asks for yes or no; an empty answer is `usual`.
    pub fn ask_yes(&self, question: &str, usual: bool) -> Result<bool, Failure> {
        loop {
            let answer = Self::ask(&format!("{question} [{}]", if usual { "Y/n" } else { "y/N" }))?;
            match answer.trim_ascii().to_ascii_lowercase().as_slice() {
                b"" => return Ok(usual),
                b"y" | b"yes" => return Ok(true),
                b"n" | b"no" => return Ok(false),
                _ => self.ask_note("type y or n"),
            }
        }
    }
}
