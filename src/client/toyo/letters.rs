//! The letters of the axes, as the teach pendant shows them (E01): axis 2 may be Y on one machine and Z on another.

use armctl_controller::toyo::layout::Record;
use armctl_controller::toyo::request::Request;
use armctl_controller::toyo::table::{Command, Parameter};

use super::{Client, Error, Refusal};

/// A letter for each axis, in their order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Letters([String; 4]);

impl Letters {
    /// The letter of an axis, 0 to 3.
    pub fn of(&self, index: usize) -> &str {
        self.0.get(index).map_or("", String::as_str)
    }

    /// All of them.
    pub fn all(&self) -> [String; 4] {
        self.0.clone()
    }

    /// The axis that has a letter, 0 to 3; `None` if none has it, or several.
    pub fn axis(&self, letter: &str) -> Option<usize> {
        let mut found = self.0.iter().enumerate().filter(|(_, other)| other.eq_ignore_ascii_case(letter));
        let (index, _) = found.next()?;
        found.next().is_none().then_some(index)
    }

    /// From the fields of an answer; what is missing there has the letter that is usual.
    fn from(record: &Record, names: [&str; 4]) -> Self {
        let usual = Self::default();
        let letter = |index: usize| {
            let told = record.value(names[index]).and_then(|_| record.word(names[index]).or(record.text(names[index])));
            told.map(str::trim).filter(|told| !told.is_empty()).unwrap_or(usual.of(index)).to_owned()
        };
        Self([0, 1, 2, 3].map(letter))
    }
}

impl Default for Letters {
    fn default() -> Self {
        Self(["X", "Y", "Z", "R"].map(str::to_owned))
    }
}

impl Client {
    /// Asks for the letters of the axes, once. A controller that does not tell has those that are usual. A dry run notes
    /// the question.
    pub async fn letters(&mut self) -> Result<Letters, Error> {
        if let Some(letters) = &self.letters {
            return Ok(letters.clone());
        }
        let system = Request::bare(Command::Sysp);
        if self.is_dry() {
            self.plan(&system, "the letters of the axes");
            self.plan_if(&letters_request(), "whether that is refused");
            return Ok(Letters::default());
        }
        let letters = match unless_malformed(self.try_ask(&system).await)? {
            Some(record) => Letters::from(&record, ["arm1", "arm2", "arm3", "arm4"]),
            None => match unless_malformed(self.try_ask(&letters_request()).await)? {
                Some(record) => Letters::from(&record, ["ax1", "ax2", "ax3", "ax4"]),
                None => Letters::default(),
            },
        };
        self.letters = Some(letters.clone());
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

/// A refusal, and an answer that makes no sense, tell no letters.
fn unless_malformed(asked: Result<Result<Record, Refusal>, Error>) -> Result<Option<Record>, Error> {
    match asked {
        Ok(answer) => Ok(answer.ok()),
        Err(error) if error.is_malformed() => Ok(None),
        Err(error) => Err(error),
    }
}
