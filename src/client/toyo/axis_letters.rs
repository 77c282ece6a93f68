//! Axis letters, as the teach pendant shows them (parameter E01). Axis 2 may be Y on one machine and Z on another.

use armctl_controller::toyo::field::Value;
use armctl_controller::toyo::layout::Record;
use armctl_controller::toyo::request::Request;
use armctl_controller::toyo::table::Command;

use super::{Client, Error, Refusal};

/// The letters that parameter E01 can contain (TO 2-4), in the axis order of a default machine.
const LETTERS: [&str; 4] = ["X", "Y", "Z", "R"];

/// The letter of each axis, in axis order; `None` if unknown.
///
/// ```
/// use armctl_client::toyo::{Client, Endpoint, Letters, Options};
///
/// # #[tokio::main(flavor = "current_thread", start_paused = true)]
/// # async fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut robot = Client::connect(Endpoint::simulator(), Options::default()).await?;
/// let letters: Letters = robot.letters().await?;
/// assert_eq!((letters.of(0), letters.axis("X"), letters.name(0)), ("X", Some(0), "x"));
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Letters([Option<&'static str>; 4]);

impl Letters {
    /// The default letters: X, Y, Z, R.
    pub const USUAL: Self = Self([Some("X"), Some("Y"), Some("Z"), Some("R")]);
    /// No letter is known: reports name the axes by number.
    pub const UNKNOWN: Self = Self([None; 4]);

    /// The letter of the axis with this index, 0 to 3. The string is empty if the letter is unknown.
    pub fn of(&self, index: usize) -> &'static str {
        self.0.get(index).copied().flatten().unwrap_or("")
    }

    /// The letters of all axes.
    pub fn all(&self) -> [String; 4] {
        [0, 1, 2, 3].map(|index| self.of(index).to_owned())
    }

    /// The index, 0 to 3, of the axis with this letter. `None` if no axis or more than one axis has this letter.
    pub fn axis(&self, letter: &str) -> Option<usize> {
        let mut matching_axes =
            (0..4).filter(|index| !letter.is_empty() && self.of(*index).eq_ignore_ascii_case(letter));
        let index = matching_axes.next()?;
        matching_axes.next().is_none().then_some(index)
    }

    /// Whether the letters are X, Y, Z, R in this order. The protocol has the coordinates in this order.
    pub fn are_usual(&self) -> bool {
        *self == Self::USUAL
    }

    /// Name of an axis (index 0 to 3) in settings and reports, for example `x`. If no letter identifies the axis, the
    /// name contains the axis number, for example `ax1`.
    pub fn name(&self, index: usize) -> &'static str {
        const NUMBERED: [&str; 4] = ["ax1", "ax2", "ax3", "ax4"];
        let lower = ["x", "y", "z", "r"].into_iter().find(|lower| self.axis(lower) == Some(index));
        lower.or(NUMBERED.get(index).copied()).unwrap_or("")
    }

    /// Parses letters, for example `X Z Y R`. A letter that is not in the manual counts as unknown.
    pub fn of_words(text: &str) -> Self {
        let words: Vec<&str> = text.split_whitespace().collect();
        Self([0, 1, 2, 3].map(|index| LETTERS.into_iter().find(|letter| words.get(index) == Some(letter))))
    }

    /// Reads the letters from an answer. A letter that is not in the manual counts as unknown.
    fn from(record: &Record, names: [&str; 4]) -> Self {
        let letter_of = |name: &str| record.word(name).or(record.text(name)).map(str::trim);
        Self(names.map(|name| LETTERS.into_iter().find(|letter| letter_of(name) == Some(letter))))
    }
}

impl Client {
    /// Reads the axis letters, once per connection. If the controller refuses, the letters are [`Letters::UNKNOWN`]. A
    /// dry run plans the request and continues with X, Y, Z and R.
    pub async fn letters(&mut self) -> Result<Letters, Error> {
        if let Some(letters) = self.letters {
            return Ok(letters);
        }
        let system = Request::bare(Command::Sysp);
        if self.is_dry_run() {
            self.plan(&system, "the letters of the axes; the following lines assume X, Y, Z and R");
            self.plan_if(&letters_request(), "whether the controller refuses the previous request");
            self.letters = Some(Letters::USUAL);
            return Ok(Letters::USUAL);
        }
        let letters = match unless_malformed(self.try_ask(&system).await)? {
            Some(record) => Letters::from(&record, ["arm1", "arm2", "arm3", "arm4"]),
            None => match unless_malformed(self.try_ask(&letters_request()).await)? {
                Some(record) => Letters::from(&record, ["ax1", "ax2", "ax3", "ax4"]),
                // The client does not store this result: a busy controller also refuses, and may answer the next
                // request.
                None => return Ok(Letters::UNKNOWN),
            },
        };
        self.letters = Some(letters);
        Ok(letters)
    }
}

/// The request that reads parameter E01, the axis letters.
#[doc(hidden)]
pub fn letters_request() -> Request {
    Request::of(Command::Rpar, [Value::Text("E01".to_owned())])
}

/// Returns `None` after a refusal or a malformed answer. An error of the line is returned as an error: the caller must
/// then send no further request on this line.
fn unless_malformed(asked: Result<Result<Record, Refusal>, Error>) -> Result<Option<Record>, Error> {
    match asked {
        Ok(answer) => Ok(answer.ok()),
        Err(Error::Malformed { .. }) => Ok(None),
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests {
    use armctl_controller::toyo::table::Parameter;

    use super::*;

    #[test]
    fn the_letters_are_a_parameter() {
        let parameter = Parameter::named("E01").unwrap();
        assert_eq!(letters_request(), Request::read_parameter(parameter, None).unwrap());
    }
}
