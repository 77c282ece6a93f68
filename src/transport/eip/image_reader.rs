//! Image of a device, read with explicit messages at an interval.
//!
//! The reader opens no I/O connection, so its end has no effect on the device. It also works if another originator owns
//! the outputs of the device.

use std::sync::Arc;
use std::time::Duration;

use tokio::sync::watch;
use tokio::task::JoinHandle;

use super::ASSEMBLY;
use super::client::Client;
use super::error::EipError;
use super::explicit::Message;

/// Attribute 3 of an assembly: its data.
const IMAGE: u32 = 3;
/// Pause after a failed read.
const PAUSE: Duration = Duration::from_millis(500);

/// The assembly to read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Assembly {
    /// Instance number.
    pub instance: u32,
    /// Size in bytes.
    pub size: u16,
}

/// The newest image, or the error of the last read.
pub type Reading = Result<Arc<[u8]>, EipError>;

/// Reader of an assembly. It reads until it is closed or dropped.
#[derive(Debug)]
pub struct Reader {
    readings: watch::Receiver<Reading>,
    task: JoinHandle<()>,
}

impl Reader {
    /// Reads the assembly once, then again after each pause.
    ///
    /// # Errors
    /// The first read failed. The error of a later read is returned as a reading.
    pub async fn open(mut client: Client, assembly: Assembly, pause: Duration) -> Result<Self, EipError> {
        let first = read(&mut client, assembly).await?;
        let (sender, readings) = watch::channel(Ok(first));
        let task = tokio::spawn(read_repeatedly(client, assembly, pause, sender));
        Ok(Self { readings, task })
    }

    /// The newest reading.
    pub fn reading(&self) -> Reading {
        self.readings.borrow().clone()
    }

    /// Waits for the next reading.
    pub async fn changed(&mut self) {
        if self.readings.changed().await.is_err() {
            // The task has ended, so no more readings follow. This wait never ends.
            std::future::pending::<()>().await;
        }
    }

    /// Stops the reads, and closes the session.
    pub async fn close(self) {
        drop(self.readings);
        // An error means that the task panicked. The task has then ended too.
        let _ = self.task.await;
    }
}

async fn read_repeatedly(mut client: Client, assembly: Assembly, pause: Duration, readings: watch::Sender<Reading>) {
    let mut wait = pause;
    loop {
        let reading = tokio::select! {
            () = readings.closed() => break,
            reading = async {
                tokio::time::sleep(wait).await;
                read(&mut client, assembly).await
            } => reading,
        };
        wait = if reading.is_ok() { pause } else { PAUSE };
        readings.send_if_modified(|last| {
            let is_new = *last != reading;
            *last = reading;
            is_new
        });
    }
    client.close().await;
}

async fn read(client: &mut Client, Assembly { instance, size }: Assembly) -> Reading {
    let what = "Get_Attribute_Single of the input assembly";
    let image = client.ask(what, &Message::get(ASSEMBLY, instance, IMAGE)).await?.done(what)?;
    if image.len() == usize::from(size) {
        Ok(image.into())
    } else {
        Err(EipError::WrongSize { found: image.len(), expected: size })
    }
}
