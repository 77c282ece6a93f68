//! The controller families: one line each. Nothing else lists them.

use super::face::Face;
use super::{toyo, yerc, yrcx};
use crate::settings::target::Family;

/// Every family, in the order help texts list them.
pub static FAMILIES: [&dyn Face; 3] = [&yerc::face::Yerc, &yrcx::face::Yrcx, &toyo::face::Toyo];

/// A family by its name.
pub fn of(family: Family) -> &'static dyn Face {
    let face = FAMILIES.iter().find(|face| face.family() == family);
    *face.expect("each family has a line; a test holds that")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_family_has_its_line() {
        assert_eq!(FAMILIES.map(|face| face.family()), Family::ALL);
    }
}
