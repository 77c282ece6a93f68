//! What a slave can be made to do wrong, for tests of the other end.

/// A thing to do wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SlaveFault {
    /// Answers nothing.
    Mute,
    /// Loses every fourth answer.
    Lose,
    /// Damages the check sum of every fourth answer.
    BadFcs,
    /// Says that it belongs to another master.
    Locked,
    /// Says that it is of another kind.
    OtherIdent,
    /// Wants another configuration, with images of another size.
    OtherSize,
    /// Takes no configuration.
    NoConfiguration,
    /// Takes no parameters.
    NoParameters,
    /// Never gets ready.
    NotReady,
    /// Sends images that are a byte short.
    WrongSize,
    /// Answers that the service is not active, whatever is asked.
    Inactive,
    /// Says that it is a master.
    Master,
    /// Has always something new in the diagnosis.
    Diagnosis,
    /// Passes a token of its own.
    Token,
}

impl SlaveFault {
    /// All there are, with the names they are asked for by.
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
