//! Plan of a dry run: the frames that would be sent.

use serde_json::{Value, json};

/// The frames of a dry run, in the order of sending.
///
/// ```
/// use armctl_client::yerc::{Client, Model, Options, Query, ReadStatus, Servo};
/// use armctl_client::{Plan, Reason, Risk};
///
/// # #[tokio::main(flavor = "current_thread", start_paused = true)]
/// # async fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut robot = Client::dry_run(Options::new(Model::Dx200).with_risk(Risk::Motion));
/// robot.ask(&Servo(true)).await?;
/// robot.plan_if(&ReadStatus.request(), Reason::about("check the servo power"));
/// let Plan { frames, .. } = robot.take_plan();
/// assert!(frames[0]["hex"].as_str().is_some_and(|hex| hex.starts_with("59455243")));
/// assert_eq!(frames[1]["about"], "check the servo power");
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Plan {
    /// One JSON object per frame. The key that contains the bytes of the frame depends on the controller family (`hex`,
    /// `wi`, `bits` or `text`). If the frame has a [`Reason`], the object also has `about` and `depends_on`.
    pub frames: Vec<Value>,
    /// The planned action for each file or part of a long task. The command that plans the task defines the format.
    pub items: Vec<Value>,
    /// A description of later steps whose frames are not known yet.
    pub then: Option<String>,
}

/// Why a frame of a plan is sent.
///
/// Example: [`Plan`]
#[derive(Debug, Clone, Copy, Default)]
pub struct Reason<'a> {
    /// Purpose of the frame.
    pub about: Option<&'a str>,
    /// The earlier answer that decides the content of the frame, or whether the frame is sent.
    pub depends_on: Option<&'a str>,
}

impl<'a> Reason<'a> {
    /// Returns a reason with this purpose and without a dependency.
    pub fn about(about: &'a str) -> Self {
        Self { about: Some(about), depends_on: None }
    }

    /// Adds the earlier answer that decides the content of the frame, or whether the frame is sent.
    #[must_use]
    pub fn depending_on(self, what: &'a str) -> Self {
        Self { depends_on: Some(what), ..self }
    }
}

/// Name and readable value of a field of a motion request, for example `("speed", "50.0 mm/s")`.
pub(crate) type ReadableField = (String, String);

/// Adds the readable fields to a frame. Without fields, the frame stays as it is.
pub(crate) fn with_fields(mut frame: Value, fields: &[ReadableField]) -> Value {
    if let Some(frame) = frame.as_object_mut().filter(|_| !fields.is_empty()) {
        let field = |(name, value): &ReadableField| json!({ "name": name, "value": value });
        frame.insert("fields".to_owned(), fields.iter().map(field).collect());
    }
    frame
}

/// Merges the fields of two variants of a request. If the values of a field differ, the merged value is `?`.
pub(crate) fn merge_fields(one: Vec<ReadableField>, other: &[ReadableField]) -> Vec<ReadableField> {
    let of = |(index, (name, value)): (usize, ReadableField)| {
        let is_same = other.get(index).is_some_and(|(_, other)| *other == value);
        (name, if is_same { value } else { "?".to_owned() })
    };
    one.into_iter().enumerate().map(of).collect()
}

impl Plan {
    /// Records a frame. The caller has already stored the bytes of the frame under the key of the controller family.
    pub fn note(&mut self, mut frame: Value, reason: Reason<'_>) {
        if let Some(frame) = frame.as_object_mut() {
            for (key, text) in [("about", reason.about), ("depends_on", reason.depends_on)] {
                if let Some(text) = text {
                    frame.insert(key.to_owned(), json!(text));
                }
            }
        }
        self.frames.push(frame);
    }

    /// Adds a description of later steps whose frames are not known yet.
    pub fn then(&mut self, what: &str) {
        let what = match self.then.take() {
            Some(before) => format!("{before}; {what}"),
            None => what.to_owned(),
        };
        self.then = Some(what);
    }
}
