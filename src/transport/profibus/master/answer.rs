//! Checks of the answers of a slave.

use super::super::error::ProfibusError;
use super::super::request::Answer;
use super::super::wire::{Control, Frame, Status};

/// Returns the data of an answer.
pub(super) fn data(
    station: u8,
    request_name: &'static str,
    answer: Answer,
) -> Result<(Status, Vec<u8>), ProfibusError> {
    let why = match answer {
        Answer::Short => "it is only an acknowledgement".to_owned(),
        Answer::Frame(Frame { control: Control::Answer(_, status), data, .. }) => match status {
            Status::Data | Status::DataHigh | Status::DataNoResource | Status::DataHighNoResource => {
                return Ok((status, data));
            }
            status => return Err(ProfibusError::Refused { station, request_name, status }),
        },
        Answer::Frame(_) => "it is a request".to_owned(),
    };
    Err(ProfibusError::Malformed { station, request_name, why })
}

/// Checks that an answer is positive.
pub(super) fn acknowledged(station: u8, request_name: &'static str, answer: &Answer) -> Result<(), ProfibusError> {
    match answer {
        Answer::Frame(Frame { control: Control::Answer(_, status), .. }) => match status {
            Status::Ok | Status::NoData | Status::Data | Status::DataHigh => Ok(()),
            status => Err(ProfibusError::Refused { station, request_name, status: *status }),
        },
        Answer::Short | Answer::Frame(_) => Ok(()),
    }
}
