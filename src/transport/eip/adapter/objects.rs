//! Objects of an adapter: identity and assemblies.

use std::cmp::Ordering;

use super::super::settings::MAX_IMAGE_SIZE;
use super::super::wire::{Request, service};
use super::super::{ASSEMBLY, Now};
use super::{Adapter, AdapterFault, Application, NOT_ENOUGH_DATA, Purpose, UNKNOWN_DESTINATION, UNKNOWN_SERVICE};
use crate::refuse_if;

const IDENTITY: u32 = 1;
/// Attribute 3 of an assembly: its data.
const DATA: u32 = 3;
const STATE_CONFLICT: u8 = 0x0C;
const NOT_SETTABLE: u8 = 0x0E;
const TOO_LARGE: u8 = 0x11;
const UNKNOWN_ATTRIBUTE: u8 = 0x14;
const TOO_MUCH_DATA: u8 = 0x15;
/// Revisions of the classes.
const IDENTITY_REVISION: u16 = 1;
const ASSEMBLY_REVISION: u16 = 2;

impl<A: Application> Adapter<A> {
    /// Executes a service. The error is a general status.
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
        refuse_if(!is_there, UNKNOWN_DESTINATION)?;
        match (request.service, attribute) {
            (service::ATTRIBUTES_ALL, None) if class == IDENTITY && instance == 1 => Ok(self.identity().attributes()),
            (service::ATTRIBUTE_SINGLE, Some(attribute)) => match (class, instance) {
                (_, 0) => self.class_attribute(class, attribute),
                (IDENTITY, _) => self.identity_attribute(attribute),
                _ => self.assembly_attribute(now, instance, attribute),
            },
            (service::SET_ATTRIBUTE_SINGLE, Some(DATA)) if class == ASSEMBLY => {
                self.set_image(now, instance, request.data)
            }
            (service::SET_ATTRIBUTE_SINGLE, Some(_)) => Err(NOT_SETTABLE),
            _ => Err(UNKNOWN_SERVICE),
        }
    }

    /// Returns a class attribute: revision, highest instance, or number of instances.
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

    /// Sets the data of an output assembly with a message, if no connection owns the assembly.
    fn set_image(&mut self, now: Now, instance: u32, image: &[u8]) -> Result<Vec<u8>, u8> {
        refuse_if(self.setup.assembly(instance, Purpose::Output).is_none(), NOT_SETTABLE)?;
        refuse_if(
            self.connections.iter().any(|connections| connections.peer.output == Some(instance)),
            STATE_CONFLICT,
        )?;
        let kept = self.images.get_mut(&instance).ok_or(UNKNOWN_DESTINATION)?;
        match image.len().cmp(&kept.len()) {
            Ordering::Less => return Err(NOT_ENOUGH_DATA),
            Ordering::Greater => return Err(TOO_MUCH_DATA),
            Ordering::Equal => kept.copy_from_slice(image),
        }
        self.application.image_out(now, instance, image, true);
        Ok(Vec::new())
    }

    /// Returns an instance attribute of an assembly: data or size.
    fn assembly_attribute(&mut self, now: Now, instance: u32, attribute: u32) -> Result<Vec<u8>, u8> {
        refuse_if(self.fault == Some(AdapterFault::Unreadable), UNKNOWN_ATTRIBUTE)?;
        let is_input = self.setup.assembly(instance, Purpose::Input).is_some();
        let image = self.images.get_mut(&instance).ok_or(UNKNOWN_DESTINATION)?;
        match attribute {
            DATA if image.len() > usize::from(MAX_IMAGE_SIZE) => Err(TOO_LARGE),
            DATA => {
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
