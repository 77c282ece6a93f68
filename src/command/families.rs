//! The controller families: one line each. Nothing else lists them.

use clap::ArgMatches;
use clap::error::ErrorKind;

use armctl_frame::face::Face;
use armctl_frame::face::registration::Registered;
use armctl_frame::settings::target::Family;
use armctl_toyo::link::Toyo;
use armctl_yerc::link::Yerc;
use armctl_yrcx::link::Yrcx;

/// Every family, in the order help texts list them.
pub static FAMILIES: [&dyn Face; 3] = [&Registered::<Yerc>::FACE, &Registered::<Yrcx>::FACE, &Registered::<Toyo>::FACE];

/// A family by its name.
///
/// # Panics
///
/// If a family has no line above, which a test rules out.
pub fn of(family: Family) -> &'static dyn Face {
    let face = FAMILIES.iter().find(|face| face.family() == family);
    *face.expect("each family has a line; a test holds that")
}

/// The family that words name, with what stands behind it.
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
