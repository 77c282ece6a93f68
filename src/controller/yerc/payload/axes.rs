//! Values and names of axes.

use crate::refuse_if;
use std::fmt;

use super::reader::{PayloadError, Reader, push_words};
use super::text::Text;

/// Maximum number of axes of a control group.
pub const MAX_AXES: usize = 8;

/// One signed word per axis in an answer. A controller sends only the words of fitted axes.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Axes {
    values: [i32; MAX_AXES],
    count: usize,
}

impl Axes {
    /// All eight axes.
    pub const fn full(values: [i32; MAX_AXES]) -> Self {
        Self { values, count: MAX_AXES }
    }

    /// The values of the first axes of a group; `None` for more than eight values.
    pub fn new(values: &[i32]) -> Option<Self> {
        let mut axes = Self { values: [0; MAX_AXES], count: values.len() };
        axes.values.get_mut(..values.len())?.copy_from_slice(values);
        Some(axes)
    }

    /// Parses all complete words, at most eight (torque 3.3.8, position error 3.3.7).
    pub fn parse(data: &[u8]) -> Result<Self, PayloadError> {
        refuse_if(data.len() < 4, PayloadError::Short { what: "axis values", needed: 4, found: data.len() })?;
        Ok(Self::take(data))
    }

    /// Takes all complete words of `data`. An answer without words is allowed.
    pub(super) fn take(data: &[u8]) -> Self {
        let mut axes = Self::default();
        let mut reader = Reader::new("axis values", data);
        while axes.count < MAX_AXES {
            let Ok(value) = reader.i32() else { break };
            axes.values[axes.count] = value;
            axes.count += 1;
        }
        axes
    }

    /// Encodes the words that exist.
    pub fn emit(&self) -> Vec<u8> {
        let mut out = Vec::with_capacity(4 * self.count);
        push_words(&mut out, self.as_slice().iter().copied());
        out
    }

    /// Values that the answer contains.
    pub fn as_slice(&self) -> &[i32] {
        &self.values[..self.count]
    }

    /// Eight values, with zeros for missing axes.
    pub const fn padded(&self) -> [i32; MAX_AXES] {
        self.values
    }
}

impl fmt::Debug for Axes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.as_slice().fmt(f)
    }
}

/// Axis names. Names of unused axes are empty (FS and DX 3.3.5).
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct AxisNames {
    /// Names of the axes, up to four bytes each.
    pub names: [Text<4>; MAX_AXES],
}

impl AxisNames {
    /// Parses eight names. Missing names are empty.
    pub fn parse(data: &[u8]) -> Result<Self, PayloadError> {
        refuse_if(data.len() < 4, PayloadError::Short { what: "axis names", needed: 4, found: data.len() })?;
        let mut names = Self::default();
        for (name, field) in names.names.iter_mut().zip(data.chunks_exact(4)) {
            *name = Text::cut(field);
        }
        Ok(names)
    }

    /// Encodes the 32 bytes of the eight names.
    pub fn emit(&self) -> Vec<u8> {
        self.names.iter().flat_map(Text::emit).collect()
    }
}
