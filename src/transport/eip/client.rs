//! Explicit messaging client without an I/O connection.

use std::net::{SocketAddr, SocketAddrV4};

use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio::time::{Duration, Instant, sleep_until, timeout_at};

use super::error::EipError;
use super::explicit::{Answer, Message};
use super::session::{Ask, Session, Step, Token};
use super::tap::Tap;
use super::wire::{Command, Identity, Services};

/// Token of the request in progress. There is only one request at a time.
const TOKEN: Token = Token(0);
/// Time for which the client waits until a busy device has a free session, in multiples of the timeout.
pub const SESSION_WAIT_TIMEOUTS: u32 = 4;
/// Bytes per read.
const BUFFER: usize = 4096;

/// A session with a device. The session opens at the first request.
#[derive(Debug)]
pub struct Client {
    target: SocketAddrV4,
    session: Session,
    stream: Option<TcpStream>,
    start: Instant,
    timeout: Duration,
    tap: Tap,
}

impl Client {
    /// Creates a client for the device at this TCP address. `timeout` is the time limit of the TCP connection and of
    /// each answer. If the device has no free session, the client retries for [`SESSION_WAIT_TIMEOUTS`] times the timeout.
    pub fn new(target: SocketAddrV4, timeout: Duration, tap: Tap) -> Self {
        let session = Session::new(timeout).is_waiting_for_session(timeout.saturating_mul(SESSION_WAIT_TIMEOUTS));
        Self { target, session, stream: None, start: Instant::now(), timeout, tap }
    }

    /// TCP address of the device.
    pub const fn target(&self) -> SocketAddrV4 {
        self.target
    }

    /// Sends a request to an object. A refusal is returned as an answer.
    pub async fn ask(&mut self, what: &'static str, message: &Message) -> Result<Answer, EipError> {
        Answer::parse(what, &self.send(what, Command::SEND_RR_DATA, message.emit()?).await?)
    }

    /// Sends ListIdentity.
    pub async fn identity(&mut self) -> Result<Option<Identity>, EipError> {
        let what = "ListIdentity";
        let data = self.send(what, Command::LIST_IDENTITY, Vec::new()).await?;
        Identity::parse(&data).map_err(|error| EipError::Malformed { what, error })
    }

    /// Sends ListServices.
    pub async fn services(&mut self) -> Result<Option<Services>, EipError> {
        let what = "ListServices";
        let data = self.send(what, Command::LIST_SERVICES, Vec::new()).await?;
        Services::parse(&data).map_err(|error| EipError::Malformed { what, error })
    }

    /// Closes the session.
    pub async fn close(mut self) {
        self.session.end();
        while let Some(step) = self.session.poll(self.start.elapsed()) {
            if let Step::Send(bytes) = step {
                // An error is ignored, because the closed TCP connection also ends the session.
                let _ = self.write(&bytes).await;
            }
        }
    }

    pub(super) async fn send(
        &mut self,
        what: &'static str,
        command: Command,
        data: Vec<u8>,
    ) -> Result<Vec<u8>, EipError> {
        self.session.ask(Ask { token: TOKEN, what, command, data });
        loop {
            match self.session.poll(self.start.elapsed()) {
                Some(Step::Connect) => self.connect().await,
                Some(Step::Send(bytes)) => {
                    if self.write(&bytes).await.is_err() {
                        self.stream = None;
                        self.session.lost(&EipError::Hangup(what));
                    }
                }
                Some(Step::Disconnect) => self.stream = None,
                Some(Step::Answer { result, .. }) => return result,
                None => self.read(what).await,
            }
        }
    }

    async fn connect(&mut self) {
        let until = Instant::now() + self.timeout;
        match timeout_at(until, TcpStream::connect(self.target)).await {
            Ok(Ok(stream)) => {
                // An error is ignored: the option only saves time. Without it, a request may wait for the
                // acknowledgement of the previous request.
                let _ = stream.set_nodelay(true);
                self.stream = Some(stream);
                self.session.connected(self.start.elapsed());
            }
            Ok(Err(error)) => self.session.lost(&EipError::unreachable(&error)),
            Err(_) => {
                self.session.lost(&EipError::NoAnswer { what: "the TCP connection", after: self.timeout });
            }
        }
    }

    async fn write(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        let Some(stream) = &mut self.stream else { return Err(std::io::ErrorKind::NotConnected.into()) };
        if let Ok(SocketAddr::V4(local_address)) = stream.local_addr() {
            self.tap.pass(true, local_address, self.target, bytes);
        }
        stream.write_all(bytes).await
    }

    /// Reads once from the TCP connection. Ends early if the session has work to do.
    async fn read(&mut self, what: &'static str) {
        let until = self.session.wake().map_or_else(|| Instant::now() + self.timeout, |wake| self.start + wake);
        let Some(stream) = &mut self.stream else { return sleep_until(until).await };
        let mut buffer = [0; BUFFER];
        match timeout_at(until, stream.read(&mut buffer)).await {
            Ok(Ok(len @ 1..)) => {
                if let Ok(SocketAddr::V4(local_address)) = stream.local_addr() {
                    self.tap.pass(true, self.target, local_address, &buffer[..len]);
                }
                self.session.received(self.start.elapsed(), &buffer[..len]);
            }
            Ok(Ok(0) | Err(_)) => {
                self.stream = None;
                self.session.lost(&EipError::Hangup(what));
            }
            Err(_) => {}
        }
    }
}
