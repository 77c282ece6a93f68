//! Capture decoder that combines the decoders of all fieldbuses.

use super::images::{BusDecoder, Images};
use crate::buses::BUSES;
use crate::field_row::FieldRow;
use armctl_controller::yrcx::image::Image;
use armctl_frame::decode::capture::{CaptureDecoder, DecodedCapture};
use armctl_transport::capture::{Carrier, Message};

/// Decoder for the images of all fieldbuses.
#[derive(Debug)]
pub struct ImageDecoder {
    images: Images,
    buses: Vec<Box<dyn BusDecoder>>,
}

impl ImageDecoder {
    /// Creates a decoder; `all` lists every image.
    pub fn new(all: bool) -> Self {
        let images = Images::new(all);
        Self { images, buses: BUSES.iter().map(|bus| (bus.decoder)()).collect() }
    }
}

impl CaptureDecoder for ImageDecoder {
    type Field = FieldRow;

    fn take(&mut self, message: &Message<'_>) {
        if let Carrier::Line { direction, .. } = message.carrier
            && let Some(image) = Image::from_bytes(message.bytes)
        {
            self.images.count();
            let link = ("host".to_owned(), "simulator".to_owned());
            self.images.image(message, direction, &link, &image);
        }
        for bus in &mut self.buses {
            bus.take(message, &mut self.images);
        }
    }

    fn decoded(&mut self) -> &mut DecodedCapture<FieldRow> {
        self.images.decoded()
    }

    fn finish(&mut self) {
        for bus in &mut self.buses {
            bus.finish(&mut self.images);
        }
    }

    fn restart(self) -> Self {
        Self::new(self.images.lists_all())
    }
}
