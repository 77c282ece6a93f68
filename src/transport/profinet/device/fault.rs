//! Deliberate faults of a simulated device, for tests of controllers.

/// A fault of the device.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Fault {
    /// Never calls ApplicationReady.
    NeverReady,
    /// Has another module in slot 1 than its layout, and runs anyway.
    WrongModule,
    /// Sends no cyclic frames.
    Stall,
    /// Repeats the cycle counter of the previous frame.
    Stale,
    /// Sends every cyclic frame twice.
    Double,
    /// Sends a bad provider status.
    BadProvider,
    /// Sends a bad consumer status.
    BadConsumer,
    /// Reports stop.
    Stop,
    /// Marks its data as invalid.
    Invalid,
    /// Answers no call.
    Mute,
    /// Answers calls with garbage.
    Garbage,
    /// Answers calls from another address.
    Foreign,
    /// Is already connected to another controller.
    Owned,
    /// Refuses an IP address.
    KeepsAddress,
    /// Raises a diagnosis some time after each connect.
    Diagnosis,
    /// Restarts some time after each connect.
    Restart,
    /// Aborts each connection after some time.
    Abort,
}

impl Fault {
    /// All faults with their names.
    pub const ALL: [(&'static str, Self); 17] = [
        ("never-ready", Self::NeverReady),
        ("wrong-module", Self::WrongModule),
        ("stall", Self::Stall),
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
