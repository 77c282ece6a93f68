//! The letters of the axes, as the teach pendant shows them (E01): axis 2 may be Y on one machine and Z on another.

use armctl_controller::toyo::layout::Record;
use armctl_controller::toyo::request::Request;
use armctl_controller::toyo::table::{Command, Parameter};

use super::{Client, Error, Refusal};

/// The letters there can be (TO 2-4, E01); of a machine with the usual ones, in the order of its axes.
const LETTERS: [&str; 4] = ["X", "Y", "Z", "R"];

/// A letter for each axis, in their order; none where the controller does not tell it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Letters([Option<&'static str>; 4]);

impl Letters {
    /// X, Y, Z and R.
    pub const USUAL: Self = Self([Some("X"), Some("Y"), Some("Z"), Some("R")]);
    /// Of a machine that does not tell them: axes have numbers only.
    pub const UNKNOWN: Self = Self([None; 4]);

    /// The letter of an axis, 0 to 3; nothing where it is not known.
    pub fn of(&self, index: usize) -> &'static str {
        self.0.get(index).copied().flatten().unwrap_or("")
    }

    /// All of them.
    pub fn all(&self) -> [String; 4] {
        [0, 1, 2, 3].map(|index| self.of(index).to_owned())
    }

    /// The axis that has a letter, 0 to 3; `None` if none has it, or several.
    pub fn axis(&self, letter: &str) -> Option<usize> {
        let mut found = (0..4).filter(|index| !letter.is_empty() && self.of(*index).eq_ignore_ascii_case(letter));
        let index = found.next()?;
        found.next().is_none().then_some(index)
    }

    /// Whether they are X, Y, Z and R in this order, as coordinates have them on the line.
    pub fn are_usual(&self) -> bool {
        *self == Self::USUAL
    }

    /// The name of an axis (0 to 3) in settings and reports: its letter, `x`, or `ax1` where no letter means it alone.
    pub fn name(&self, index: usize) -> &'static str {
        const NUMBERED: [&str; 4] = ["ax1", "ax2", "ax3", "ax4"];
        let lower = ["x", "y", "z", "r"].into_iter().find(|lower| self.axis(lower) == Some(index));
        lower.or(NUMBERED.get(index).copied()).unwrap_or("")
    }

    /// From letters in a line, as `X Z Y R`; what is no letter of the manual is none.
    pub fn of_words(text: &str) -> Self {
        let words: Vec<&str> = text.split_whitespace().collect();
        Self([0, 1, 2, 3].map(|index| LETTERS.into_iter().find(|letter| words.get(index) == Some(letter))))
    }

    /// From the fields of an answer; a letter that is not in the manual is none.
    fn from(record: &Record, names: [&str; 4]) -> Self {
        let told = |name: &str| record.word(name).or(record.text(name)).map(str::trim);
        Self(names.map(|name| LETTERS.into_iter().find(|letter| told(name) == Some(letter))))
    }
}

impl Client {
    /// Asks for the letters of the axes, once. Of a controller that refuses to tell they are unknown. A dry run notes the
    /// question, and shows what follows for X, Y, Z and R.
    pub async fn letters(&mut self) -> Result<Letters, Error> {
        if let Some(letters) = self.letters {
            return Ok(letters);
        }
        let system = Request::bare(Command::Sysp);
        if self.is_dry() {
            self.plan(&system, "the letters of the axes; what follows is for X, Y, Z and R");
            self.plan_if(&letters_request(), "whether that is refused");
            self.letters = Some(Letters::USUAL);
            return Ok(Letters::USUAL);
        }
        let letters = match unless_malformed(self.try_ask(&system).await)? {
            Some(record) => Letters::from(&record, ["arm1", "arm2", "arm3", "arm4"]),
            None => match unless_malformed(self.try_ask(&letters_request()).await)? {
                Some(record) => Letters::from(&record, ["ax1", "ax2", "ax3", "ax4"]),
                // It may tell later: one that is busy refuses, too.
                None => return Ok(Letters::UNKNOWN),
            },
        };
        self.letters = Some(letters);
        Ok(letters)
    }
}

/// Asks for E01.
///
/// # Panics
/// If the table of parameters lacks it, which any test of the caller shows.
pub fn letters_request() -> Request {
    let parameter = Parameter::named("E01").expect("the table has E01");
    Request::read_parameter(parameter, None).expect("E01 has no rows")
}

/// A refusal, and an answer that makes no sense, tell no letters. A line on which something else comes than answers has
/// been asked often enough: there is no second question.
fn unless_malformed(asked: Result<Result<Record, Refusal>, Error>) -> Result<Option<Record>, Error> {
    match asked {
        Ok(answer) => Ok(answer.ok()),
        Err(Error::Malformed { .. }) => Ok(None),
        Err(error) => Err(error),
    }
}
