//! List of the controller families, with one line per family. No other place lists them.

use clap::ArgMatches;
use clap::error::ErrorKind;

use armctl_frame::Driver;
use armctl_frame::face::Face;
use armctl_frame::settings::Robot;
use armctl_frame::settings::target::Family;

/// All families, in the order of the help texts.
pub static FAMILIES: [&Face; 3] = [&armctl_yerc::face::FACE, &armctl_yrcx::face::FACE, &armctl_toyo::face::FACE];

/// Returns the family with this name.
///
/// # Panics
///
/// If the family is missing in the list above, which a test excludes.
pub fn of(family: Family) -> &'static Face {
    let face = FAMILIES.iter().find(|face| face.family == family);
    face.expect("each family has a line; a test holds that")
}

/// Returns the driver of a robot's family.
pub fn driver(robot: &Robot) -> &'static Driver {
    of(robot.family).driver
}

/// Takes the family name from the parsed words. Returns the family and the arguments after its name.
pub fn by_name(matches: &mut ArgMatches) -> Result<(Family, ArgMatches), clap::Error> {
    let (name, behind) = matches.remove_subcommand().ok_or_else(|| clap::Error::new(ErrorKind::MissingSubcommand))?;
    let family = name.parse().map_err(|_| clap::Error::new(ErrorKind::InvalidSubcommand))?;
    Ok((family, behind))
}

#[cfg(test)]
mod tests {
    use armctl_frame::decode::capture::Selection;
    use armctl_frame::decode::capture::testing::message_count;

    use super::*;

    const VLAN: &[u8] = include_bytes!("../../tests/cli/files/vlan.pcap");
    const LINES: &[u8] = include_bytes!("../../tests/cli/files/lines.pcapng");
    const SPEED: &[u8] = include_bytes!("../../tests/cli/files/speed.pcapng");

    #[test]
    fn lists_every_family_once() {
        assert_eq!(FAMILIES.map(|face| face.family), Family::ALL);
    }

    /// Messages of each family in a capture, and packets without a message.
    fn message_counts(file: &[u8], selection: &Selection) -> [Option<(usize, u64)>; 3] {
        [
            message_count(file, selection, armctl_yerc::decode::FrameDecoder::default()),
            message_count(file, selection, armctl_toyo::decode::LineDecoder::default()),
            message_count(file, selection, armctl_yrcx::decode::ImageDecoder::new(true)),
        ]
    }

    #[test]
    fn finds_the_messages_of_each_family() {
        let all = Selection::default();
        assert_eq!(message_counts(VLAN, &all), [Some((3, 2)), Some((0, 5)), Some((0, 5))]);
        assert_eq!(message_counts(LINES, &all), [Some((0, 11)), Some((6, 3)), Some((0, 11))]);
        assert_eq!(message_counts(SPEED, &all), [Some((0, 18)), Some((0, 18)), Some((24, 0))]);
    }

    #[test]
    fn selects_hosts_and_ports() {
        let selection = |host: &str, port| Selection { frame: None, host: host.parse().ok(), port };
        assert_eq!(message_counts(VLAN, &selection("192.168.255.1", Some(10040)))[0], Some((3, 2)));
        assert_eq!(message_counts(VLAN, &selection("192.168.255.3", None))[0], Some((0, 5)));
        assert_eq!(message_counts(VLAN, &selection("", Some(10041)))[0], Some((0, 5)));
    }

    #[test]
    fn reports_cut_and_damaged_files() {
        let all = Selection::default();
        for file in [VLAN, LINES, SPEED] {
            for end in 0..file.len() {
                message_counts(&file[..end], &all);
                let mut damaged = file.to_vec();
                damaged[end] = !damaged[end];
                message_counts(&damaged, &all);
            }
        }
    }
}
