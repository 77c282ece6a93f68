//! List of the controller families, with one line per family. No other place lists them.

use clap::ArgMatches;
use clap::error::ErrorKind;

use super::face::Face;
use super::face::registration::Registered;
use super::toyo::link::Toyo;
use super::yerc::link::Yerc;
use super::yrcx::link::Yrcx;
use crate::settings::target::Family;

/// All families, in the order of the help texts.
pub static FAMILIES: [&dyn Face; 3] = [&Registered::<Yerc>::FACE, &Registered::<Yrcx>::FACE, &Registered::<Toyo>::FACE];

/// Returns the family with this name.
///
/// # Panics
///
/// If the family is missing in the list above, which a test excludes.
pub fn of(family: Family) -> &'static dyn Face {
    let face = FAMILIES.iter().find(|face| face.family() == family);
    *face.expect("each family has a line; a test holds that")
}

/// Takes the family name from the parsed words. Returns the family and the arguments after its name.
pub fn by_name(matches: &mut ArgMatches) -> Result<(Family, ArgMatches), clap::Error> {
    let (name, behind) = matches.remove_subcommand().ok_or_else(|| clap::Error::new(ErrorKind::MissingSubcommand))?;
    let family = name.parse().map_err(|_| clap::Error::new(ErrorKind::InvalidSubcommand))?;
    Ok((family, behind))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_every_family_once() {
        assert_eq!(FAMILIES.map(<dyn Face>::family), Family::ALL);
    }
}
