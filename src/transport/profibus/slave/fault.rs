//! Deliberate faults of a simulated slave, for tests of masters.

/// A fault of the slave.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SlaveFault {
    /// Does not answer.
    Mute,
    /// Omits every fourth answer.
    Lose,
    /// Sends every fourth answer with a wrong checksum.
    BadFcs,
    /// Reports that another master has locked it.
    Locked,
    /// Reports another ident number.
    OtherIdent,
    /// Requires a configuration with other image sizes.
    OtherSize,
    /// Rejects every configuration.
    NoConfiguration,
    /// Rejects all parameters.
    NoParameters,
    /// Never becomes ready.
    NotReady,
    /// Sends images that are one byte short.
    WrongSize,
    /// Refuses every request: service not active.
    Inactive,
    /// Reports that it is a master.
    Master,
    /// Always reports a new diagnosis.
    Diagnosis,
    /// Sends a token.
    Token,
}

impl SlaveFault {
    /// All faults with their names.
    pub const ALL: [(&'static str, Self); 14] = [
        ("mute", Self::Mute),
        ("lose", Self::Lose),
        ("bad-fcs", Self::BadFcs),
        ("locked", Self::Locked),
        ("other-ident", Self::OtherIdent),
        ("other-size", Self::OtherSize),
        ("no-configuration", Self::NoConfiguration),
        ("no-parameters", Self::NoParameters),
        ("not-ready", Self::NotReady),
        ("wrong-size", Self::WrongSize),
        ("inactive", Self::Inactive),
        ("master", Self::Master),
        ("diagnosis", Self::Diagnosis),
        ("token", Self::Token),
    ];
}
