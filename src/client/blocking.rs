//! Clients in programs without async.

use std::io;

use tokio::runtime::{Builder, Runtime};

/// Waits for the calls of clients, in a program without async. One value serves any number of clients.
///
/// A client works only during its calls. Between two calls, a motion goes on, but nothing is received.
///
/// ```
/// use armctl_client::Blocking;
/// use armctl_client::yerc::{Client, Endpoint, Model, Options, ReadStatus};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let blocking = Blocking::new()?;
/// let mut robot = blocking.run(Client::connect(Endpoint::simulator(Model::Dx200), Options::auto()))?;
/// let status = blocking.run(robot.ask(&ReadStatus))?;
/// assert!(status.servo_on());
/// blocking.run(robot.close())?;
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Blocking(Runtime);

impl Blocking {
    /// Creates a tokio runtime for this thread. It starts no other thread.
    ///
    /// # Errors
    /// The operating system has no resources left.
    pub fn new() -> io::Result<Self> {
        Builder::new_current_thread().enable_all().build().map(Self)
    }

    /// Waits until a future is complete: a call, or several calls in an `async` block.
    ///
    /// # Panics
    /// In async code. Write `.await` there.
    pub fn run<F: Future>(&self, future: F) -> F::Output {
        self.0.block_on(future)
    }
}
