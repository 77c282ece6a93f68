//! Deliberate faults of a simulated device, for tests of controllers.

/// A fault of the device.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Fault {
    /// The device never calls ApplicationReady.
    NeverReady,
    /// The device has another module in slot 1 than its layout, and still runs.
    WrongModule,
    /// The device sends no cyclic frames.
    Stall,
    /// Every cyclic frame has the cycle counter of the previous frame.
    Stale,
    /// The device sends every cyclic frame twice.
    Double,
    /// The device sends a bad provider status.
    BadProvider,
    /// The device sends a bad consumer status.
    BadConsumer,
    /// The device reports that it has stopped.
    Stop,
    /// The device marks its data as invalid.
    Invalid,
    /// The device answers no call.
    Mute,
    /// The device answers calls with random bytes.
    Garbage,
    /// The device answers calls from another address.
    Foreign,
    /// The device is already connected to another controller.
    Owned,
    /// The device refuses an IP address.
    KeepsAddress,
    /// The device raises a diagnosis some time after each Connect.
    Diagnosis,
    /// The device restarts some time after each Connect.
    Restart,
    /// The device aborts each connection after some time.
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
