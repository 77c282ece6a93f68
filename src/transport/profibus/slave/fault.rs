//! Deliberate faults of a simulated slave, for tests of masters.

/// A fault of the slave.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SlaveFault {
    /// The slave does not answer.
    Mute,
    /// The slave omits every fourth answer.
    Lose,
    /// The slave sends every fourth answer with a wrong checksum.
    BadFcs,
    /// The slave reports that another master has locked it.
    Locked,
    /// The slave reports another ident number.
    OtherIdent,
    /// The slave requires a configuration with other image sizes.
    OtherSize,
    /// The slave rejects every configuration.
    NoConfiguration,
    /// The slave rejects all parameters.
    NoParameters,
    /// The slave never becomes ready.
    NotReady,
    /// The slave sends images that are one byte too short.
    WrongSize,
    /// The slave refuses every request with the status "service not active".
    Inactive,
    /// The slave reports that it is a master.
    Master,
    /// The slave reports a new diagnosis in every data exchange.
    Diagnosis,
    /// The slave sends a token.
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
