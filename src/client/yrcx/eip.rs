//! Connection over EtherNet/IP with the usual numbers.

use armctl_controller::yrcx::image::Image;
use armctl_controller::yrcx::signal::resting;
pub use armctl_transport::eip::PORT as EIP_PORT;
use armctl_transport::eip::link::Class1;
use armctl_transport::eip::settings::Settings;
use armctl_transport::eip::tap::Tap;
use armctl_transport::image::{ImageLink, LinkError};

/// Size of an image in bytes.
const SIZE: u16 = 48;

/// Opens an EtherNet/IP connection that controls a YRCX: assemblies 150 (output), 100 (input) and 1 (configuration), an
/// interval of 20 ms in both directions. The threads of the connection exchange images also between the calls of a client.
/// For other numbers and other fieldbuses, see `armctl_client::unstable::transport`.
///
/// # Errors
/// [`LinkError`], for example if there is no answer, or if another device controls the YRCX.
///
/// # Example
/// ```no_run
/// use armctl_client::yrcx::{Client, EIP_PORT, Options, open_eip};
///
/// # #[tokio::main(flavor = "current_thread")]
/// # async fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let link = open_eip("192.0.2.10", EIP_PORT).await?;
/// let mut robot = Client::connect(link, Options::default()).await?;
/// println!("{:?}", robot.input_image().await?);
/// # Ok(())
/// # }
/// ```
pub async fn open_eip(host: &str, port: u16) -> Result<ImageLink, LinkError> {
    let resting = resting().to_link(Image::BYTES);
    let settings = Settings { output_size: SIZE, input_size: SIZE, resting, ..Settings::default() };
    Ok(ImageLink::over(Class1::open(host, port, settings, Tap::default()).await?))
}
