//! Minimal HTTP/1.1 server for short texts: one request per connection, no request bodies.
//!
//! All resources are limited: the time per connection (`WITHIN`), the bytes per request (`HEAD`) and the number of open
//! connections (`MOST`). The server always accepts a new connection. If the limit is reached, it closes the oldest
//! connection whose answer is not in progress.

use std::cell::Cell;
use std::collections::VecDeque;
use std::io;
use std::net::SocketAddr;
use std::rc::Rc;
use std::time::Duration;

use futures_util::StreamExt as _;
use futures_util::future::{AbortHandle, abortable};
use futures_util::stream::FuturesUnordered;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpListener, TcpStream};
use tokio::time::{sleep, timeout};

/// Maximum length of a request head in bytes.
const HEAD: usize = 8 << 10;
/// Maximum number of lines of a request head.
const LINES: usize = 64;
/// Time limit of a connection.
const CONNECTION_TIMEOUT: Duration = Duration::from_secs(10);
/// Maximum number of open connections.
const MAX_CONNECTIONS: usize = 32;
/// Pause before the next accept, if the process has too many open files.
const ACCEPT_PAUSE: Duration = Duration::from_millis(100);
/// Maximum number of bytes that the server reads after it has sent the answer. Without this read, a client that is
/// still sending could lose the answer.
const MAX_DISCARDED: u64 = 64 << 10;

/// A request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Request<'a> {
    /// Path without the query.
    pub path: &'a str,
    /// Value of the `Accept` header.
    pub accept: Option<&'a str>,
}

/// A response.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Answer {
    /// Status code.
    pub status: Status,
    /// Value of the `Content-Type` header.
    pub kind: &'static str,
    /// Response body.
    pub body: String,
}

/// Status code of a response.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// 200: success.
    Ok,
    /// 400: not a valid request.
    BadRequest,
    /// 404: no such path.
    NotFound,
    /// 405: only GET and HEAD are possible for this path.
    MethodNotAllowed,
    /// 431: the request head is too long.
    TooLong,
    /// 503: not available now.
    Unavailable,
}

impl Status {
    fn line(self) -> &'static str {
        match self {
            Self::Ok => "200 OK",
            Self::BadRequest => "400 Bad Request",
            Self::NotFound => "404 Not Found",
            Self::MethodNotAllowed => "405 Method Not Allowed",
            Self::TooLong => "431 Request Header Fields Too Large",
            Self::Unavailable => "503 Service Unavailable",
        }
    }
}

impl Answer {
    /// Creates a response with a one-line text.
    pub fn text(status: Status, text: &str) -> Self {
        Self { status, kind: "text/plain; charset=utf-8", body: format!("{text}\n") }
    }
}

/// An HTTP server.
#[derive(Debug)]
pub struct Server {
    listener: TcpListener,
}

impl Server {
    /// Listens at an address.
    pub async fn bind(address: SocketAddr) -> io::Result<Self> {
        Ok(Self { listener: TcpListener::bind(address).await? })
    }

    /// Local address.
    pub fn local(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }

    /// Serves requests until an error occurs.
    ///
    /// # Errors
    /// The server can accept no more connections.
    pub async fn run(&self, answer: impl Fn(&Request<'_>) -> Answer) -> io::Result<()> {
        let mut peers = FuturesUnordered::new();
        let mut connections = Connections::default();
        loop {
            tokio::select! {
                biased;
                // Because of `biased`, the server first reads the requests that have arrived. Otherwise, a new
                // connection could close these connections.
                Some(ended) = peers.next() => {
                    if let Ok(number) = ended {
                        connections.release_connection(number);
                    }
                }
                accepted = self.listener.accept() => match accepted {
                    Ok((stream, _)) => {
                        let (number, is_answered) = (connections.next, Rc::new(Cell::new(false)));
                        let served = serve(stream, &answer, Rc::clone(&is_answered));
                        let (served, close) = abortable(async move {
                            // An error of one connection concerns only its client.
                            let _served = timeout(CONNECTION_TIMEOUT, served).await;
                            number
                        });
                        connections.take(Connection { number, is_answered, close });
                        peers.push(served);
                    }
                    Err(error) if is_sending(&error) => {}
                    Err(error) if is_full(&error) => {
                        connections.evict();
                        sleep(ACCEPT_PAUSE).await;
                    }
                    Err(error) => return Err(error),
                },
            }
        }
    }
}

struct Connection {
    number: u64,
    /// Whether the request is complete, so that the answer is in progress.
    is_answered: Rc<Cell<bool>>,
    close: AbortHandle,
}

/// The open connections, oldest first.
#[derive(Default)]
struct Connections {
    taken: VecDeque<Connection>,
    /// Number that the next connection gets.
    next: u64,
}

impl Connections {
    fn take(&mut self, connection: Connection) {
        if self.taken.len() >= MAX_CONNECTIONS {
            self.evict();
        }
        self.next += 1;
        self.taken.push_back(connection);
    }

    fn release_connection(&mut self, number: u64) {
        self.taken.retain(|connection| connection.number != number);
    }

    /// Closes the oldest connection whose answer is not in progress. If there is no such connection, closes the oldest
    /// connection.
    fn evict(&mut self) {
        let idle = self.taken.iter().position(|connection| !connection.is_answered.get());
        if let Some(connection) = self.taken.remove(idle.unwrap_or(0)) {
            connection.close.abort();
        }
    }
}

/// Whether an error of `accept(2)` concerns only the client that tried to connect, or the network of this client.
fn is_sending(error: &io::Error) -> bool {
    use io::ErrorKind::{
        ConnectionAborted, ConnectionReset, HostUnreachable, Interrupted, NetworkDown, NetworkUnreachable, TimedOut,
        WouldBlock,
    };

    let kinds = [
        ConnectionAborted,
        ConnectionReset,
        HostUnreachable,
        Interrupted,
        NetworkDown,
        NetworkUnreachable,
        TimedOut,
        WouldBlock,
    ];
    kinds.contains(&error.kind())
}

/// Whether the process or the system has no resources for another connection (EMFILE, ENFILE, ENOBUFS).
fn is_full(error: &io::Error) -> bool {
    error.kind() == io::ErrorKind::OutOfMemory || matches!(error.raw_os_error(), Some(23 | 24 | 55 | 105))
}

enum RequestResult {
    /// A response. The flag says whether the client requested only the head.
    Text(Answer, bool),
    /// The client has disconnected.
    Nothing,
}

async fn serve(
    mut stream: TcpStream,
    answer: &impl Fn(&Request<'_>) -> Answer,
    is_answered: Rc<Cell<bool>>,
) -> io::Result<()> {
    let RequestResult::Text(Answer { status, kind, body }, is_head) = read_request(&mut stream, answer).await? else {
        return Ok(());
    };
    is_answered.set(true);
    let allow = if status == Status::MethodNotAllowed { "Allow: GET, HEAD\r\n" } else { "" };
    let head = format!(
        "HTTP/1.1 {}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\n{allow}Cache-Control: no-store\r\n\
         X-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n",
        status.line(),
        body.len()
    );
    stream.write_all(head.as_bytes()).await?;
    if !is_head {
        stream.write_all(body.as_bytes()).await?;
    }
    stream.shutdown().await?;
    is_answered.set(false);
    // The server first reads the remaining bytes. If bytes arrived after the close, the system would discard the
    // answer.
    tokio::io::copy(&mut stream.take(MAX_DISCARDED), &mut tokio::io::sink()).await.map(|_| ())
}

/// Reads a request and creates the response.
async fn read_request(stream: &mut TcpStream, answer: &impl Fn(&Request<'_>) -> Answer) -> io::Result<RequestResult> {
    let mut head = Vec::with_capacity(1 << 10);
    loop {
        let length = head.len();
        let read = (&mut *stream).take(u64::try_from(HEAD - length).unwrap_or(0)).read_buf(&mut head).await?;
        if read == 0 && length < HEAD {
            return Ok(RequestResult::Nothing);
        }
        let mut lines = [httparse::EMPTY_HEADER; LINES];
        let mut request = httparse::Request::new(&mut lines);
        return Ok(match request.parse(&head) {
            Ok(httparse::Status::Complete(_)) => answered(&request, answer),
            Ok(httparse::Status::Partial) if head.len() < HEAD => continue,
            Ok(httparse::Status::Partial) | Err(httparse::Error::TooManyHeaders) => {
                RequestResult::Text(Answer::text(Status::TooLong, "the request is too long"), false)
            }
            Err(_) => RequestResult::Text(Answer::text(Status::BadRequest, "this is not an HTTP request"), false),
        });
    }
}

fn answered(request: &httparse::Request<'_, '_>, answer: &impl Fn(&Request<'_>) -> Answer) -> RequestResult {
    let is_head = request.method == Some("HEAD");
    let path = request.path.unwrap_or_default();
    let path = path.split('?').next().unwrap_or_default();
    let accept = request.headers.iter().find(|line| line.name.eq_ignore_ascii_case("accept"));
    let accept = accept.and_then(|line| std::str::from_utf8(line.value).ok());
    let answer = answer(&Request { path, accept });
    if answer.status == Status::Ok && !is_head && request.method != Some("GET") {
        return RequestResult::Text(Answer::text(Status::MethodNotAllowed, "only GET and HEAD are possible"), false);
    }
    RequestResult::Text(answer, is_head)
}

#[cfg(test)]
mod tests {
    use std::net::Ipv4Addr;

    use futures_util::FutureExt as _;

    use super::*;

    fn response_texts(request: &Request<'_>) -> Answer {
        match request.path {
            "/a" => Answer::text(Status::Ok, request.accept.unwrap_or("anything")),
            _ => Answer::text(Status::NotFound, "there is no such page"),
        }
    }

    /// Sends the pieces to a server in real time, and returns the response of the server.
    async fn response_text(pieces: &[&[u8]]) -> String {
        let server = Server::bind((Ipv4Addr::LOCALHOST, 0).into()).await.unwrap();
        let read_request = async {
            let mut stream = TcpStream::connect(server.local().unwrap()).await.unwrap();
            for piece in pieces {
                stream.write_all(piece).await.unwrap();
                tokio::task::yield_now().await;
            }
            let mut response_text = Vec::new();
            stream.read_to_end(&mut response_text).await.unwrap();
            String::from_utf8(response_text).unwrap()
        };
        tokio::select! {
            response_text = read_request => response_text,
            ended = server.run(response_texts) => panic!("{ended:?}"),
        }
    }

    #[tokio::test]
    async fn sends_the_body_or_the_head_only() {
        let said_to_get = response_text(&[b"GET /a?x=1 HTTP/1.1\r\nHost: x\r\nACCEPT: text/plain\r\n\r\n"]).await;
        assert!(said_to_get.starts_with("HTTP/1.1 200 OK\r\n"), "{said_to_get}");
        assert!(said_to_get.ends_with("Connection: close\r\n\r\ntext/plain\n"), "{said_to_get}");
        let said_to_head = response_text(&[b"HEAD /a HTTP/1.1\r\n\r\n"]).await;
        assert!(said_to_head.contains("Content-Length: 9\r\n") && said_to_head.ends_with("\r\n\r\n"), "{said_to_head}");
        let in_pieces = response_text(&[b"GE", b"T /a HT", b"TP/1.0\r\n", b"\r\n"]).await;
        assert!(in_pieces.ends_with("anything\n"), "{in_pieces}");
    }

    #[tokio::test]
    async fn refuses_unknown_paths_and_invalid_requests() {
        let long = [&b"GET /a HTTP/1.1\r\nX: "[..], &[b'x'; HEAD]].concat();
        let many = [&b"GET /a HTTP/1.1\r\n"[..], &b"X: y\r\n".repeat(LINES + 1), b"\r\n"].concat();
        for (read_request, status) in [
            (&b"GET /b HTTP/1.1\r\n\r\n"[..], "404"),
            (b"POST /b HTTP/1.1\r\nContent-Length: 3\r\n\r\nabc", "404"),
            (b"POST /a HTTP/1.1\r\nContent-Length: 3\r\n\r\nabc", "405"),
            (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", "400"),
            (b"GET\r\n\r\n", "400"),
            (&long, "431"),
            (&many, "431"),
        ] {
            let response_text = response_text(&[read_request]).await;
            assert!(response_text.starts_with(&format!("HTTP/1.1 {status} ")), "{status}: {response_text}");
            assert_eq!(response_text.contains("Allow: GET, HEAD"), status == "405");
        }
    }

    #[tokio::test]
    async fn silent_connections_do_not_block_new_ones() {
        let server = Server::bind((Ipv4Addr::LOCALHOST, 0).into()).await.unwrap();
        let address = server.local().unwrap();
        let read_request = async {
            // Opens more connections than the limit. Some of them have sent half a request.
            let mut silent = Vec::new();
            for number in 0..MAX_CONNECTIONS + 4 {
                let mut stream = TcpStream::connect(address).await.unwrap();
                if number % 2 == 0 {
                    stream.write_all(b"GET /a HTTP/1.1\r\nX").await.unwrap();
                }
                silent.push(stream);
            }
            let mut stream = TcpStream::connect(address).await.unwrap();
            stream.write_all(b"GET /a HTTP/1.1\r\n\r\n").await.unwrap();
            let mut response_text = String::new();
            stream.read_to_string(&mut response_text).await.unwrap();
            assert!(response_text.ends_with("anything\n"), "{response_text}");
            // The server has closed the oldest five connections. The other connections are still within their time
            // limit.
            let mut byte = [0; 1];
            for stream in &mut silent[..5] {
                assert!(stream.read(&mut byte).await.map_or(true, |read| read == 0));
            }
            for stream in &mut silent[5..] {
                assert!(stream.read(&mut byte).now_or_never().is_none(), "it is open");
            }
        };
        tokio::select! {
            () = read_request => {}
            ended = server.run(response_texts) => panic!("{ended:?}"),
        }
    }

    #[tokio::test(start_paused = true)]
    async fn closes_a_silent_connection_after_its_timeout() {
        let server = Server::bind((Ipv4Addr::LOCALHOST, 0).into()).await.unwrap();
        let address = server.local().unwrap();
        let silent = async {
            let mut stream = TcpStream::connect(address).await.unwrap();
            stream.read(&mut [0; 1]).await.map_or(true, |read| read == 0)
        };
        tokio::select! {
            is_closed = silent => assert!(is_closed),
            ended = server.run(response_texts) => panic!("{ended:?}"),
        }
    }

    #[test]
    fn evicts_connections_without_an_answer_first() {
        let mut connections = Connections::default();
        for number in 0..3 {
            let (close, _) = AbortHandle::new_pair();
            connections.take(Connection { number, is_answered: Rc::new(Cell::new(number != 1)), close });
        }
        let numbers = |connections: &Connections| {
            connections.taken.iter().map(|connection| connection.number).collect::<Vec<_>>()
        };
        connections.evict();
        assert_eq!(numbers(&connections), [0, 2]);
        connections.evict();
        assert_eq!(numbers(&connections), [2], "the oldest has had the most time");
        connections.release_connection(2);
        connections.evict();
        assert!(connections.taken.is_empty());
    }
}
