//! Deliberate faults of a simulated device, for tests of controllers.

use crate::fault::device_faults;

device_faults! {
    /// A fault of the device.
    Fault {
        NeverReady "never-ready" "Never calls ApplicationReady.",
        WrongModule "wrong-module" "Has another module in slot 1 than its layout, and still runs.",
        Stall "stall" "Sends no cyclic frames.",
        Stale "stale" "Every cyclic frame has the cycle counter of the previous frame.",
        Double "double" "Sends every cyclic frame twice.",
        BadProvider "bad-provider" "Sends a bad provider status.",
        BadConsumer "bad-consumer" "Sends a bad consumer status.",
        Stop "stop" "Reports that it has stopped.",
        Invalid "invalid" "Marks its data as invalid.",
        Mute "mute" "Answers no call.",
        Garbage "garbage" "Answers calls with random bytes.",
        Foreign "foreign" "Answers calls from another address.",
        Owned "owned" "Is already connected to another controller.",
        KeepsAddress "keeps-address" "Refuses an IP address.",
        Diagnosis "diagnosis" "Raises a diagnosis some time after each Connect.",
        Restart "restart" "Restarts some time after each Connect.",
        Abort "abort" "Aborts each connection after some time.",
    }
}
