//! Deliberate faults of a simulated slave, for tests of masters.

use crate::fault::device_faults;

device_faults! {
    /// A fault of the slave.
    SlaveFault {
        Mute "mute" "Does not answer.",
        Lose "lose" "Omits every fourth answer.",
        BadFcs "bad-fcs" "Sends every fourth answer with a wrong checksum.",
        Locked "locked" "Reports that another master has locked it.",
        OtherIdent "other-ident" "Reports another ident number.",
        OtherSize "other-size" "Requires a configuration with other image sizes.",
        NoConfiguration "no-configuration" "Rejects every configuration.",
        NoParameters "no-parameters" "Rejects all parameters.",
        NotReady "not-ready" "Never becomes ready.",
        WrongSize "wrong-size" "Sends images that are one byte too short.",
        Inactive "inactive" "Refuses every request with the status 'service not active'.",
        Master "master" "Reports that it is a master.",
        Diagnosis "diagnosis" "Reports a new diagnosis in every data exchange.",
        Token "token" "Sends a token.",
    }
}
