//! What an adapter can be asked about: itself, and its assemblies.

use super::super::settings::MOST_IMAGE;
use super::super::wire::{Request, service};
use super::super::{ASSEMBLY, Now};
use super::{Adapter, Application, Mischief, Purpose, UNKNOWN_DESTINATION, UNKNOWN_SERVICE};

const IDENTITY: u32 = 1;
const NOT_SETTABLE: u8 = 0x0E;
const TOO_LARGE: u8 = 0x11;
const UNKNOWN_ATTRIBUTE: u8 = 0x14;
/// Revisions of the classes.
const IDENTITY_REVISION: u16 = 1;
const ASSEMBLY_REVISION: u16 = 2;

impl<A: Application> Adapter<A> {
    /// Carries out a service of an object, or says with which general status it is refused.
    pub(super) fn object(
        &mut self,
        now: Now,
        (class, instance, attribute): (u32, u32, Option<u32>),
        request: &Request<'_>,
    ) -> Result<Vec<u8>, u8> {
        let is_there = match class {
            IDENTITY => instance <= 1,
            ASSEMBLY => instance == 0 || self.images.contains_key(&instance),
            _ => false,
        };
        if !is_there {
            return Err(UNKNOWN_DESTINATION);
        }
        match (request.service, attribute) {
            (service::ATTRIBUTES_ALL, None) if class == IDENTITY && instance == 1 => Ok(self.identity().attributes()),
            (service::ATTRIBUTE_SINGLE, Some(attribute)) => match (class, instance) {
                (_, 0) => self.class_attribute(class, attribute),
                (IDENTITY, _) => self.identity_attribute(attribute),
                _ => self.assembly_attribute(now, instance, attribute),
            },
            (service::SET_ATTRIBUTE_SINGLE, Some(_)) => Err(NOT_SETTABLE),
            _ => Err(UNKNOWN_SERVICE),
        }
    }

    /// Revision, highest instance, number of instances.
    fn class_attribute(&self, class: u32, attribute: u32) -> Result<Vec<u8>, u8> {
        let instances = &self.setup.assemblies;
        let (revision, highest, count) = match class {
            IDENTITY => (IDENTITY_REVISION, 1, 1),
            _ => (ASSEMBLY_REVISION, instances.iter().map(|one| one.instance).max().unwrap_or(0), instances.len()),
        };
        let value = match attribute {
            1 => revision,
            2 => u16::try_from(highest).unwrap_or(u16::MAX),
            3 => u16::try_from(count).unwrap_or(u16::MAX),
            _ => return Err(UNKNOWN_ATTRIBUTE),
        };
        Ok(value.to_le_bytes().to_vec())
    }

    fn identity_attribute(&self, attribute: u32) -> Result<Vec<u8>, u8> {
        let identity = self.identity();
        Ok(match attribute {
            1 => identity.vendor.to_le_bytes().to_vec(),
            2 => identity.device_type.to_le_bytes().to_vec(),
            3 => identity.product.to_le_bytes().to_vec(),
            4 => vec![identity.revision.major, identity.revision.minor],
            5 => identity.status.to_le_bytes().to_vec(),
            6 => identity.serial.to_le_bytes().to_vec(),
            7 => identity.name_attribute(),
            _ => return Err(UNKNOWN_ATTRIBUTE),
        })
    }

    /// Data and size.
    fn assembly_attribute(&mut self, now: Now, instance: u32, attribute: u32) -> Result<Vec<u8>, u8> {
        if self.mischief == Some(Mischief::Unreadable) {
            return Err(UNKNOWN_ATTRIBUTE);
        }
        let is_input = self.setup.assembly(instance, Purpose::Input).is_some();
        let image = self.images.get_mut(&instance).ok_or(UNKNOWN_DESTINATION)?;
        match attribute {
            3 if image.len() > usize::from(MOST_IMAGE) => Err(TOO_LARGE),
            3 => {
                if is_input {
                    self.application.image_in(now, instance, image);
                }
                Ok(image.clone())
            }
            4 => Ok(u16::try_from(image.len()).unwrap_or(u16::MAX).to_le_bytes().to_vec()),
            _ => Err(UNKNOWN_ATTRIBUTE),
        }
    }
}
