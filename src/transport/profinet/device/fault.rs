//! What a device can be made to do wrong, for tests of the other end.

/// A thing to do wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Fault {
    /// Never calls ApplicationReady.
    NeverReady,
    /// Has another module in slot 1 than its layout says, and runs all the same.
    WrongModule,
    /// Sends no cyclic frames.
    Silent,
    /// Sends every cyclic frame with the count of the one before.
    Stale,
    /// Sends every cyclic frame twice.
    Double,
    /// Marks its data as bad.
    BadProvider,
    /// Marks what it is sent as not taken.
    BadConsumer,
    /// Is in stop.
    Stop,
    /// Marks its data as invalid.
    Invalid,
    /// Answers no call.
    Mute,
    /// Answers calls with noise.
    Garbage,
    /// Answers calls from another address.
    Foreign,
    /// Has a controller already.
    Owned,
    /// Takes no address.
    KeepsAddress,
    /// Raises a diagnosis after a while, in every connection.
    Diagnosis,
    /// Is switched off and on after a while, in every connection.
    Restart,
    /// Ends every connection after a while.
    Abort,
}

impl Fault {
    /// All there are, with the names they are asked for by.
    pub const ALL: [(&'static str, Self); 17] = [
        ("never-ready", Self::NeverReady),
        ("wrong-module", Self::WrongModule),
        ("silent", Self::Silent),
        ("stale", Self::Stale),
        ("double", Self::Double),
        ("bad-provider", Self::BadProvider),
        ("bad-consumer", Self::BadConsumer),
        ("stop", Self::Stop),
        ("invalid", Self::Invalid),
        ("mute", Self::Mute),
        ("garbage", Self::Garbage),
        ("foreign", Self::Foreign),
        ("owned", Self::Owned),
        ("keeps-address", Self::KeepsAddress),
        ("diagnosis", Self::Diagnosis),
        ("restart", Self::Restart),
        ("abort", Self::Abort),
    ];
}
