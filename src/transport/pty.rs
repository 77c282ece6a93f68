//! Controlling end of a pseudo-terminal (Unix only). A program that opens the port of the pseudo-terminal is connected
//! to this end.

#[cfg(unix)]
pub(super) use unix::Pty;

#[cfg(not(unix))]
pub(super) use elsewhere::Pty;

#[cfg(unix)]
mod unix {
    use std::io::{self, Write as _};
    use std::time::Duration;

    use serialport::{SerialPort as _, TTYPort};
    use tokio::time::Instant;

    use super::super::port::{READ_TIMEOUT, Threaded};

    /// Bytes per write.
    const WRITE_SIZE: usize = 128;
    /// Maximum number of bytes that the program has not read yet. The limit is smaller than the buffer of the system
    /// (4096 bytes on Linux, 1024 elsewhere), so that a write never blocks.
    const MAX_UNREAD: u32 = if cfg!(target_os = "linux") { 3072 } else { 768 };
    /// Timeout of a read. After a timeout, the read is repeated, so the value is not important.
    const LONG: Duration = Duration::from_secs(3600);

    #[derive(Debug)]
    pub(crate) struct Pty {
        reader: Threaded,
        /// Second handle for writes while a thread uses the reader.
        writer: TTYPort,
        /// The port. This process keeps it open. Otherwise, a read at this end would return end of file while no
        /// program has the port open.
        port: TTYPort,
    }

    impl Pty {
        /// Creates a pseudo-terminal. Returns it with the path of its port.
        pub(crate) fn open() -> io::Result<(Self, String)> {
            let (mut writer, port) = TTYPort::pair()?;
            let mut reader = writer.try_clone_native()?;
            reader.set_timeout(READ_TIMEOUT)?;
            writer.set_timeout(Duration::ZERO)?;
            let path = port.name().ok_or_else(|| io::Error::other("the pseudo-terminal has no name"))?;
            Ok((Self { reader: Threaded::new(Box::new(reader)), writer, port }, path))
        }

        pub(crate) async fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            loop {
                if let Some(len) = self.reader.receive(buffer, Instant::now() + LONG).await? {
                    return Ok(len);
                }
            }
        }

        /// Writes bytes without waiting. If the program has left too many bytes unread, the new bytes are lost, as on a
        /// real line.
        pub(crate) fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
            for piece in bytes.chunks(WRITE_SIZE) {
                if self.port.bytes_to_read()? > MAX_UNREAD {
                    return Ok(());
                }
                match self.writer.write_all(piece) {
                    Err(error) if error.kind() == io::ErrorKind::TimedOut => return Ok(()),
                    written => written?,
                }
            }
            Ok(())
        }
    }
}

#[cfg(not(unix))]
mod elsewhere {
    use std::io;

    #[derive(Debug)]
    pub(crate) enum Pty {}

    impl Pty {
        pub(crate) fn open() -> io::Result<(Self, String)> {
            let why = "only Unix has pseudo-terminals; serve on TCP instead";
            Err(io::Error::new(io::ErrorKind::Unsupported, why))
        }

        pub(crate) async fn read(&mut self, _buffer: &mut [u8]) -> io::Result<usize> {
            match *self {}
        }

        pub(crate) fn write(&mut self, _bytes: &[u8]) -> io::Result<()> {
            match *self {}
        }
    }
}
