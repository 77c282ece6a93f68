//! Minimal HTTP/1.1 server for short texts: one request per connection, no request bodies.
//!
//! All resources are limited: the time per connection (`CONNECTION_TIMEOUT`), the bytes per request (`HEAD`), the number
//! of open connections (`MAX_CONNECTIONS`), and the number of responses in progress (`MAX_ANSWERS`). At a limit, the
//! server closes the oldest connection in favor of the new one. No client can keep others out: not by silence, not by
//! slow requests or slow reading, and not by new connections without end.

use std::cell::{OnceCell, RefCell};
use std::collections::VecDeque;
use std::io::{self, Read as _};
use std::net::SocketAddr;
use std::rc::Rc;
use std::time::Duration;

use flate2::Compression;
use flate2::bufread::GzEncoder;
use futures_util::StreamExt as _;
use futures_util::future::{AbortHandle, abortable};
use futures_util::stream::FuturesUnordered;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpListener, TcpStream};
use tokio::time::{Instant, sleep_until, timeout};

/// Maximum length of a request head in bytes.
const HEAD: usize = 8 << 10;
/// Maximum number of lines of a request head.
const LINES: usize = 64;
/// Time limit of a connection, from its start to its end.
const CONNECTION_TIMEOUT: Duration = Duration::from_secs(10);
/// Maximum number of open connections. All request heads together need at most 1 MB.
const MAX_CONNECTIONS: usize = 128;
/// Maximum number of responses in progress. Each of them can hold a page in memory.
const MAX_ANSWERS: usize = 16;
/// Time that each client has to send its request. Only after this time, the server closes its connection in favor of a
/// new one. Until then, new connections wait in the queue of the system.
const GRACE: Duration = Duration::from_millis(500);
/// Pause before the next accept, if the process has too many open files.
const ACCEPT_PAUSE: Duration = Duration::from_millis(100);
/// Maximum number of bytes that the server reads after it has sent the answer. Without this read, a client that is
/// still sending could lose the answer.
const MAX_DISCARDED: u64 = 64 << 10;
/// Minimum length of a body that the server compresses. A shorter body fits into one packet.
const MIN_COMPRESSED: usize = 1 << 10;
/// Compression level. Higher levels make a page of metrics only 1 % smaller, and take up to twice the time.
const LEVEL: Compression = Compression::new(4);

/// A request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Request<'a> {
    /// Path without the query.
    pub path: &'a str,
    /// Value of the `Accept` header.
    pub accept: Option<&'a str>,
}

/// A response.
#[derive(Debug, Clone)]
pub struct Answer {
    /// Status code.
    pub status: Status,
    /// Value of the `Content-Type` header.
    pub kind: &'static str,
    /// Response body.
    pub body: Rc<Body>,
}

/// A response body. Several responses can share it. It is compressed at most once.
#[derive(Debug)]
pub struct Body {
    text: String,
    /// `None` inside if the compression has failed.
    gzip: OnceCell<Option<Vec<u8>>>,
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

impl Body {
    /// Creates a body.
    pub fn new(text: String) -> Self {
        Self { text, gzip: OnceCell::new() }
    }

    /// Compressed form, if it is worth the time.
    fn gzip(&self) -> Option<&[u8]> {
        if self.text.len() < MIN_COMPRESSED {
            return None;
        }
        let compress = || {
            let mut compressed = Vec::new();
            GzEncoder::new(self.text.as_bytes(), LEVEL).read_to_end(&mut compressed).ok().map(|_| compressed)
        };
        self.gzip.get_or_init(compress).as_deref()
    }
}

impl Answer {
    /// Creates a response with a one-line text.
    pub fn text(status: Status, text: &str) -> Self {
        Self { status, kind: "text/plain; charset=utf-8", body: Rc::new(Body::new(format!("{text}\n"))) }
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
        let connections = RefCell::new(Connections::default());
        let mut peers = FuturesUnordered::new();
        let mut paused_until = Instant::now();
        loop {
            let accept_at = paused_until.max(connections.borrow().next_accept());
            tokio::select! {
                biased;
                // Because of `biased`, the server first reads the requests that have arrived. Otherwise, a new
                // connection could close these connections.
                Some(ended) = peers.next() => {
                    if let Ok(number) = ended {
                        connections.borrow_mut().remove(number);
                    }
                }
                accepted = async {
                    sleep_until(accept_at).await;
                    self.listener.accept().await
                } => match accepted {
                    Ok((stream, _)) => {
                        let number = connections.borrow().next;
                        let served = serve(stream, &answer, &connections, number);
                        let (served, close) = abortable(async move {
                            // An error of one connection concerns only its client.
                            let _served = timeout(CONNECTION_TIMEOUT, served).await;
                            number
                        });
                        connections.borrow_mut().add(close);
                        peers.push(served);
                    }
                    Err(error) if is_sending(&error) => {}
                    Err(error) if is_full(&error) => {
                        connections.borrow_mut().evict();
                        paused_until = Instant::now() + ACCEPT_PAUSE;
                    }
                    Err(error) => return Err(error),
                },
            }
        }
    }
}

struct Connection {
    number: u64,
    start: Instant,
    stage: Stage,
    close: AbortHandle,
}

/// Progress of a connection.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stage {
    /// The request is not complete.
    Request,
    /// The response is in progress.
    Answer,
    /// The response is sent. The client has not closed the connection yet.
    End,
}

/// The open connections, oldest first.
#[derive(Default)]
struct Connections {
    open: VecDeque<Connection>,
    /// Number that the next connection gets.
    next: u64,
}

impl Connections {
    /// Adds a connection. At the limit, closes another one.
    fn add(&mut self, close: AbortHandle) {
        if self.open.len() >= MAX_CONNECTIONS {
            self.evict();
        }
        self.open.push_back(Connection { number: self.next, start: Instant::now(), stage: Stage::Request, close });
        self.next += 1;
    }

    fn remove(&mut self, number: u64) {
        self.open.retain(|connection| connection.number != number);
    }

    fn start_answer(&mut self, number: u64) {
        if self.open.iter().filter(|connection| connection.stage == Stage::Answer).count() >= MAX_ANSWERS {
            // The oldest connection has had the most time to read its response.
            let oldest = self.oldest(Stage::Answer);
            self.close(oldest);
        }
        self.set_stage(number, Stage::Answer);
    }

    fn end_answer(&mut self, number: u64) {
        self.set_stage(number, Stage::End);
    }

    fn set_stage(&mut self, number: u64, stage: Stage) {
        if let Some(connection) = self.open.iter_mut().find(|connection| connection.number == number) {
            connection.stage = stage;
        }
    }

    /// Earliest time of the next accept.
    fn next_accept(&self) -> Instant {
        let now = Instant::now();
        if self.open.len() < MAX_CONNECTIONS {
            return now;
        }
        match self.evictable().and_then(|at| self.open.get(at)) {
            Some(connection) if connection.stage == Stage::Request => connection.start + GRACE,
            _ => now,
        }
    }

    /// Closes the connection that is needed least.
    fn evict(&mut self) {
        let evictable = self.evictable();
        self.close(evictable);
    }

    /// The oldest connection whose response is sent. If there is none, the oldest connection without a request. If
    /// there is none either, the oldest connection.
    fn evictable(&self) -> Option<usize> {
        [Stage::End, Stage::Request, Stage::Answer].into_iter().find_map(|stage| self.oldest(stage))
    }

    fn oldest(&self, stage: Stage) -> Option<usize> {
        self.open.iter().position(|connection| connection.stage == stage)
    }

    fn close(&mut self, at: Option<usize>) {
        if let Some(connection) = at.and_then(|at| self.open.remove(at)) {
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

/// A response to one request.
#[derive(Debug)]
pub struct Response {
    answer: Answer,
    /// Whether the client requested only the head.
    is_head: bool,
    /// Whether the client accepts gzip.
    is_gzip: bool,
}

impl Response {
    /// A response to something that is not a valid request.
    fn refusal(status: Status, text: &str) -> Self {
        Self { answer: Answer::text(status, text), is_head: false, is_gzip: false }
    }

    /// Head and body, as they are sent.
    pub fn parts(&self) -> (String, &[u8]) {
        let Self { answer: Answer { status, kind, body }, is_head, is_gzip } = self;
        let (body, encoding) = match is_gzip.then(|| body.gzip()).flatten() {
            Some(compressed) => (compressed, "Content-Encoding: gzip\r\n"),
            None => (body.text.as_bytes(), ""),
        };
        let allow = if *status == Status::MethodNotAllowed { "Allow: GET, HEAD\r\n" } else { "" };
        let head = format!(
            "HTTP/1.1 {}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\n{encoding}{allow}Cache-Control: no-store\r\n\
             Vary: Accept, Accept-Encoding\r\nX-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n",
            status.line(),
            body.len()
        );
        (head, if *is_head { &[] } else { body })
    }
}

async fn serve(
    mut stream: TcpStream,
    answer: &impl Fn(&Request<'_>) -> Answer,
    connections: &RefCell<Connections>,
    number: u64,
) -> io::Result<()> {
    let Some(response) = read_request(&mut stream, answer).await? else { return Ok(()) };
    connections.borrow_mut().start_answer(number);
    let (head, body) = response.parts();
    stream.write_all(head.as_bytes()).await?;
    stream.write_all(body).await?;
    stream.shutdown().await?;
    connections.borrow_mut().end_answer(number);
    // The server first reads the remaining bytes. If bytes arrived after the close, the system would discard the
    // answer.
    tokio::io::copy(&mut stream.take(MAX_DISCARDED), &mut tokio::io::sink()).await.map(|_| ())
}

/// Reads a request and creates the response. Returns `None` if the client has disconnected.
async fn read_request(
    stream: &mut TcpStream,
    answer: &impl Fn(&Request<'_>) -> Answer,
) -> io::Result<Option<Response>> {
    let mut head = Vec::with_capacity(1 << 10);
    loop {
        let length = head.len();
        let read = (&mut *stream).take(u64::try_from(HEAD - length).unwrap_or(0)).read_buf(&mut head).await?;
        if read == 0 && length < HEAD {
            return Ok(None);
        }
        if let Some(response) = respond(&head, answer) {
            return Ok(Some(response));
        }
    }
}

/// The response to the bytes of a request so far; `None` if more bytes are needed.
pub fn respond(head: &[u8], answer: &impl Fn(&Request<'_>) -> Answer) -> Option<Response> {
    let mut lines = [httparse::EMPTY_HEADER; LINES];
    let mut request = httparse::Request::new(&mut lines);
    match request.parse(head) {
        Ok(httparse::Status::Complete(_)) => Some(answered(&request, answer)),
        Ok(httparse::Status::Partial) if head.len() < HEAD => None,
        Ok(httparse::Status::Partial) | Err(httparse::Error::TooManyHeaders) => {
            Some(Response::refusal(Status::TooLong, "the request is too long"))
        }
        Err(_) => Some(Response::refusal(Status::BadRequest, "this is not an HTTP request")),
    }
}

fn answered(request: &httparse::Request<'_, '_>, answer: &impl Fn(&Request<'_>) -> Answer) -> Response {
    let is_head = request.method == Some("HEAD");
    let path = request.path.unwrap_or_default();
    let path = path.split('?').next().unwrap_or_default();
    let accept = header_values(request, "accept").next();
    let answer = answer(&Request { path, accept });
    if answer.status == Status::Ok && !is_head && request.method != Some("GET") {
        return Response::refusal(Status::MethodNotAllowed, "only GET and HEAD are possible");
    }
    let is_gzip = header_values(request, "accept-encoding").flat_map(|value| value.split(',')).any(is_gzip);
    Response { answer, is_head, is_gzip }
}

fn header_values<'a>(request: &'a httparse::Request<'_, '_>, name: &'a str) -> impl Iterator<Item = &'a str> {
    let lines = request.headers.iter().filter(move |line| line.name.eq_ignore_ascii_case(name));
    lines.filter_map(|line| std::str::from_utf8(line.value).ok())
}

/// Whether an entry of `Accept-Encoding` accepts gzip, such as `gzip` or `gzip;q=0.5` (RFC 9110, section 12.5.3).
fn is_gzip(coding: &str) -> bool {
    let mut parts = coding.split(';').map(str::trim);
    let is_gzip = parts.next().is_some_and(|name| name.eq_ignore_ascii_case("gzip"));
    let weight = parts.find_map(|part| part.strip_prefix("q=").or_else(|| part.strip_prefix("Q=")));
    is_gzip && weight.is_none_or(|weight| weight.trim().parse::<f64>().is_ok_and(|weight| weight > 0.0))
}

#[cfg(test)]
mod tests {
    use std::net::Ipv4Addr;

    use futures_util::FutureExt as _;
    use tokio::time::sleep;

    use super::*;

    fn long_text() -> String {
        "armctl_robot_up{robot=\"cell3\"} 1\n".repeat(100)
    }

    fn response_texts(request: &Request<'_>) -> Answer {
        match request.path {
            "/long" => Answer { body: Rc::new(Body::new(long_text())), ..Answer::text(Status::Ok, "") },
            "/a" => Answer::text(Status::Ok, request.accept.unwrap_or("anything")),
            _ => Answer::text(Status::NotFound, "there is no such page"),
        }
    }

    async fn response_text(pieces: &[&[u8]]) -> String {
        String::from_utf8(request(pieces).await).unwrap()
    }

    fn split(response: &[u8]) -> (&str, &[u8]) {
        let end = response.windows(4).position(|bytes| bytes == b"\r\n\r\n").unwrap() + 4;
        (std::str::from_utf8(&response[..end]).unwrap(), &response[end..])
    }

    /// Sends the pieces to a server in real time, and returns the response of the server.
    async fn request(pieces: &[&[u8]]) -> Vec<u8> {
        let server = Server::bind((Ipv4Addr::LOCALHOST, 0).into()).await.unwrap();
        let read_request = async {
            let mut stream = TcpStream::connect(server.local().unwrap()).await.unwrap();
            for piece in pieces {
                stream.write_all(piece).await.unwrap();
                tokio::task::yield_now().await;
            }
            let mut response_text = Vec::new();
            stream.read_to_end(&mut response_text).await.unwrap();
            response_text
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
    async fn compresses_long_bodies_for_clients_that_accept_gzip() {
        let gzip = request(&[b"GET /long HTTP/1.1\r\nAccept-Encoding: br, gzip;q=0.8\r\n\r\n"]).await;
        let (head, body) = split(&gzip);
        assert!(head.contains(&format!("Content-Length: {}\r\nContent-Encoding: gzip\r\n", body.len())), "{head}");
        assert!(head.contains("Vary: Accept, Accept-Encoding\r\n"), "{head}");
        let mut text = String::new();
        flate2::read::GzDecoder::new(body).read_to_string(&mut text).unwrap();
        assert_eq!(text, long_text());
        let without_body = request(&[b"HEAD /long HTTP/1.1\r\nAccept-Encoding: gzip\r\n\r\n"]).await;
        let (only_head, no_body) = split(&without_body);
        assert_eq!((only_head, no_body), (head, &b""[..]));
        for plain in [
            &b"GET /long HTTP/1.1\r\n\r\n"[..],
            b"GET /long HTTP/1.1\r\nAccept-Encoding: gzip;q=0\r\n\r\n",
            b"GET /long HTTP/1.1\r\nAccept-Encoding: identity, xgzip\r\n\r\n",
        ] {
            let response = response_text(&[plain]).await;
            assert!(!response.contains("Content-Encoding") && response.ends_with(&long_text()), "{response}");
        }
        let short = response_text(&[b"GET /a HTTP/1.1\r\nAccept-Encoding: gzip\r\n\r\n"]).await;
        assert!(!short.contains("Content-Encoding") && short.ends_with("anything\n"), "{short}");
    }

    #[test]
    fn compresses_a_body_once() {
        let body = Body::new(long_text());
        assert_eq!(body.gzip().unwrap().as_ptr(), body.gzip().unwrap().as_ptr());
    }

    /// Connects, waits, and then sends a request. Returns the response.
    async fn get(address: SocketAddr, wait: Duration) -> String {
        let mut stream = TcpStream::connect(address).await.unwrap();
        sleep(wait).await;
        stream.write_all(b"GET /a HTTP/1.1\r\n\r\n").await.unwrap();
        let mut response = String::new();
        stream.read_to_string(&mut response).await.unwrap();
        response
    }

    /// Runs a test against a server.
    async fn with_server<T, F: Future<Output = T>>(test: impl FnOnce(SocketAddr) -> F) -> T {
        let server = Server::bind((Ipv4Addr::LOCALHOST, 0).into()).await.unwrap();
        let address = server.local().unwrap();
        tokio::select! {
            result = test(address) => result,
            ended = server.run(response_texts) => panic!("{ended:?}"),
        }
    }

    /// Opens connections without a complete request. Every second one has sent half a request.
    async fn open_silent(address: SocketAddr, count: usize) -> Vec<TcpStream> {
        let mut silent = Vec::new();
        for number in 0..count {
            let mut stream = TcpStream::connect(address).await.unwrap();
            if number % 2 == 0 {
                stream.write_all(b"GET /a HTTP/1.1\r\nX").await.unwrap();
            }
            silent.push(stream);
        }
        silent
    }

    fn is_open(stream: &mut TcpStream) -> bool {
        stream.read(&mut [0; 1]).now_or_never().is_none()
    }

    #[tokio::test(start_paused = true)]
    async fn answers_beside_silent_connections() {
        with_server(async |address| {
            let start = Instant::now();
            let mut silent = open_silent(address, 32).await;
            assert!(get(address, Duration::ZERO).await.ends_with("anything\n"));
            assert_eq!(start.elapsed(), Duration::ZERO);
            assert!(silent.iter_mut().all(is_open));
        })
        .await;
    }

    #[tokio::test(start_paused = true)]
    async fn closes_the_oldest_silent_connections_in_favor_of_new_ones() {
        with_server(async |address| {
            let start = Instant::now();
            let mut silent = open_silent(address, MAX_CONNECTIONS + 4).await;
            assert!(get(address, Duration::ZERO).await.ends_with("anything\n"));
            // The clients have had their time.
            assert_eq!(start.elapsed().as_millis(), GRACE.as_millis());
            // The server has closed the oldest five connections. The other connections are still within their time
            // limit.
            for stream in &mut silent[..5] {
                assert!(stream.read(&mut [0; 1]).await.map_or(true, |read| read == 0));
            }
            assert!(silent[5..].iter_mut().all(is_open));
        })
        .await;
    }

    #[tokio::test(start_paused = true)]
    async fn slow_client_gets_its_response_beside_clients_that_reconnect_without_end() {
        with_server(async |address| {
            let reconnect = async || {
                loop {
                    let mut stream = TcpStream::connect(address).await.unwrap();
                    let _closed = stream.read(&mut [0; 1]).await;
                }
            };
            let storm = futures_util::future::join_all((0..3 * MAX_CONNECTIONS).map(|_| reconnect()));
            tokio::select! {
                _ = storm => unreachable!("it has no end"),
                () = async {
                    sleep(Duration::from_secs(1)).await;
                    for _ in 0..3 {
                        let start = Instant::now();
                        assert!(get(address, GRACE / 2).await.ends_with("anything\n"));
                        assert!(start.elapsed() < 5 * GRACE, "{:?}", start.elapsed());
                    }
                } => {}
            }
        })
        .await;
    }

    #[tokio::test(start_paused = true)]
    async fn clients_that_do_not_read_keep_few_responses_in_memory() {
        let pages = RefCell::new(Vec::new());
        let server = Server::bind((Ipv4Addr::LOCALHOST, 0).into()).await.unwrap();
        let address = server.local().unwrap();
        let huge = |_: &Request<'_>| {
            let body = Rc::new(Body::new("x".repeat(16 << 20)));
            pages.borrow_mut().push(Rc::downgrade(&body));
            Answer { body, ..Answer::text(Status::Ok, "") }
        };
        let test = async {
            let mut unread = Vec::new();
            for _ in 0..MAX_ANSWERS + 4 {
                let mut stream = TcpStream::connect(address).await.unwrap();
                stream.write_all(b"GET / HTTP/1.1\r\n\r\n").await.unwrap();
                unread.push(stream);
                sleep(Duration::from_millis(1)).await;
            }
            let kept = pages.borrow().iter().filter(|page| page.strong_count() > 0).count();
            assert_eq!(kept, MAX_ANSWERS);
            sleep(CONNECTION_TIMEOUT).await;
            assert!(pages.borrow().iter().all(|page| page.strong_count() == 0));
        };
        tokio::select! {
            () = test => {}
            ended = server.run(huge) => panic!("{ended:?}"),
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
    fn evicts_connections_that_need_no_answer_first() {
        let mut connections = Connections::default();
        for stage in [Stage::Answer, Stage::Answer, Stage::Request, Stage::Request, Stage::End] {
            connections.add(AbortHandle::new_pair().0);
            connections.set_stage(connections.next - 1, stage);
        }
        let mut order = Vec::new();
        while !connections.open.is_empty() {
            let before: Vec<u64> = connections.open.iter().map(|connection| connection.number).collect();
            connections.evict();
            let remains = |number: &u64| connections.open.iter().any(|connection| connection.number == *number);
            order.extend(before.into_iter().filter(|number| !remains(number)));
        }
        assert_eq!(order, [4, 2, 3, 0, 1]);
    }
}
