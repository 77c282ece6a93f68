//! Yaskawa FS100 / DX200 high-speed Ethernet server ("YERC", after the identifier of every frame).
//!
//! UDP, little-endian, one frame a datagram. Sources, by short name in the docs of this folder: FS = FS100 manual
//! HW1481031, DX = DX200 manual HW1481977; section numbers are the same in both unless told otherwise.

pub mod describe;
pub mod files;
pub mod group;
pub mod names;
pub mod passing;
pub mod payload;
pub mod query;
pub mod request;
pub mod session;
pub mod signal;
pub mod simulator;
pub mod status;
pub mod subcode;
pub mod table;
pub mod variables;
pub mod wire;

/// The controller a robot hangs on: number ranges, string sizes and move layouts differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Model {
    /// FS100: 2 robots, 2 bases, 3 stations, 6 tasks, 16-byte strings.
    Fs100,
    /// DX200: 8 robots, 8 bases, 24 stations, 16 tasks, 32-byte strings.
    Dx200,
}

impl Model {
    /// Every model, in the order help texts list them.
    pub const ALL: [Self; 2] = [Self::Fs100, Self::Dx200];

    /// The name in target URLs, inventories and JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fs100 => "fs100",
            Self::Dx200 => "dx200",
        }
    }
}

impl std::str::FromStr for Model {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|model| model.name().eq_ignore_ascii_case(text))
            .ok_or_else(|| format!("unknown model '{text}'; there are fs100 and dx200"))
    }
}

impl std::fmt::Display for Model {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
