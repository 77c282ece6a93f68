//! Tests of host and clients on a real socket, with an in-process peer.

use std::cell::Cell;
use std::collections::VecDeque;
use std::path::Path;
use std::pin::Pin;
use std::rc::Rc;
use std::time::Duration;

use tokio::io::AsyncReadExt as _;
use tokio::time::Instant;

use super::shared_link::{Datagrams, Images, Line, OpenResult, Rules, SharedLink};
use super::*;
use crate::image::{Event, ImageLink, ImagePeer};
use crate::session::client::{AttachResult, Attached, SessionBusy, attach_at, attach_in_process, status};
use crate::session::location::SessionPath;
use crate::sim;
use crate::stream::Stream;
use crate::tcp::Tcp;

/// Echo peer that exchanges images.
#[derive(Debug, Default)]
struct Mirror(Vec<u8>);

impl ImagePeer for Mirror {
    fn input(&mut self, _now: Duration, image: Option<&[u8]>) {
        self.0 = image.unwrap_or_default().to_vec();
    }

    fn output(&mut self, _now: Duration) -> Option<Vec<u8>> {
        Some(self.0.clone())
    }

    fn wake(&self) -> Option<Duration> {
        None
    }
}

/// Echo peer that exchanges datagrams.
#[derive(Debug, Default)]
struct Echo(VecDeque<(usize, Vec<u8>)>);

impl sim::Peer for Echo {
    fn receive(&mut self, _now: Duration, channel: usize, bytes: &[u8]) {
        self.0.push_back((channel, bytes.to_vec()));
    }

    fn transmit(&mut self, _now: Duration) -> Option<(usize, Vec<u8>)> {
        self.0.pop_front()
    }

    fn wake(&self) -> Option<Duration> {
        None
    }
}

/// Images with two exclusive bytes and one shared byte. The robot moves while the first byte is not 0.
fn images() -> SharedLink {
    let rules = Rules {
        is_owner: true,
        exclusive: 2,
        command: 2,
        resting: vec![0, 0, 0x41],
        is_moving: |_, seen| seen.first().is_some_and(|byte| *byte != 0),
    };
    SharedLink::Images(Images::new(ImageLink::in_process(Box::new(Mirror::default())), rules).unwrap())
}

fn info() -> Info {
    Info { pid: 1, ..Info::own("cell", "yrcx", "sim:", "armctl session open") }
}

fn host(folder: &Path, held: SharedLink) -> (Host, SessionPath) {
    let location = SessionPath::at(folder.join("key"));
    let claim = location.claim(&info()).unwrap().unwrap();
    (Host::new(claim, "key".to_owned(), info(), held, |_| {}).unwrap(), location)
}

async fn client(location: &SessionPath, name: &str) -> Box<Attached> {
    match attach_at(location, "key", name, Purpose::Any).await.unwrap() {
        AttachResult::Session(attached) => attached,
        found => panic!("{found:?}"),
    }
}

fn within_deadline() -> Instant {
    Instant::now() + Duration::from_secs(60)
}

/// Runs the host until `clients` ends.
async fn served<T>(host: &mut Host, clients: impl Future<Output = T>) -> T {
    tokio::select! {
        _ = host.serve() => panic!("nobody closed it"),
        done = clients => done,
    }
}

async fn assert_image(link: &mut ImageLink, image: &[u8]) {
    link.set_output(image).unwrap();
    while link.next(within_deadline()).await != Event::Sent {}
}

async fn assert_received(link: &mut ImageLink, wanted: &[u8]) {
    loop {
        if let Event::Image(image) = link.next(within_deadline()).await
            && image[..] == *wanted
        {
            return;
        }
    }
}

#[tokio::test]
async fn exclusive_words_have_one_owner_and_bits_are_shared() {
    let folder = tempfile::tempdir().unwrap();
    let (mut host, location) = host(folder.path(), images());
    served(&mut host, async {
        let mut mover = ImageLink::in_session(client(&location, "mover").await);
        let mut other = ImageLink::in_session(client(&location, "other").await);
        assert_eq!(mover.output().unwrap(), [0, 0, 0x41]);
        mover.acquire(within_deadline()).await.unwrap();
        assert_image(&mut mover, &[7, 8, 0x41]).await;
        // The client does not own the line, so only the bits that all clients share are changed.
        assert_image(&mut other, &[9, 9, 0x01]).await;
        assert_received(&mut mover, &[7, 8, 0x01]).await;
        assert_eq!(mover.output().unwrap(), [7, 8, 0x01], "it knows of the bit that went off");
        assert_image(&mut mover, &[0, 0, 0x01]).await;
        assert_received(&mut other, &[0, 0, 0x01]).await;
    })
    .await;
}

#[tokio::test]
async fn the_line_and_motion_have_one_owner() {
    let folder = tempfile::tempdir().unwrap();
    let (mut host, location) = host(folder.path(), images());
    served(&mut host, async {
        let (mut first, mut second) = (client(&location, "first").await, client(&location, "second").await);
        first.acquire(within_deadline()).await.unwrap();
        first.claim_motion().await.unwrap();
        assert!(
            matches!(second.claim_motion().await, Err(SessionBusy::LocationChanged(peer)) if peer.command == "first")
        );
        let busy = second.acquire(Instant::now() + Duration::from_millis(20)).await;
        assert!(matches!(busy, Err(SessionBusy::Busy(Some(peer))) if peer.command == "first"));
        // The request that timed out was dropped. A new request gets the line.
        first.release();
        first.acquire(within_deadline()).await.unwrap();
        let waiting = status(&location).await.unwrap().unwrap();
        assert_eq!((waiting.clients.len(), waiting.motion.unwrap().command), (2, "first".to_owned()));
        drop(first);
        second.acquire(within_deadline()).await.unwrap();
        second.claim_motion().await.unwrap();
    })
    .await;
}

#[tokio::test]
async fn reports_bits_that_a_client_left_on() {
    let folder = tempfile::tempdir().unwrap();
    let (mut host, location) = host(folder.path(), images());
    served(&mut host, async {
        let mut mover = ImageLink::in_session(client(&location, "mover").await);
        mover.acquire(within_deadline()).await.unwrap();
        assert_image(&mut mover, &[7, 0, 0x41]).await;
        drop(mover);
        let mut next = client(&location, "next").await;
        while next.welcome.leftover.is_none() {
            next = client(&location, "next").await;
        }
        let leftover = next.welcome.leftover.clone().unwrap();
        assert_eq!((leftover.by.command.as_str(), leftover.died), ("mover", false));
        assert_eq!(next.output().unwrap(), [7, 0, 0x41]);
        let mut next = ImageLink::in_session(next);
        next.acquire(within_deadline()).await.unwrap();
        assert_image(&mut next, &[0, 0, 0x41]).await;
        assert_eq!(status(&location).await.unwrap().unwrap().leftover, None);
    })
    .await;
}

#[tokio::test]
async fn owner_of_the_line_gets_the_datagrams() {
    let folder = tempfile::tempdir().unwrap();
    let echo: Box<dyn sim::Peer + Send> = Box::new(Echo::default());
    let held = SharedLink::Datagrams(Datagrams::in_process(sim::InProcess::new(echo, None)));
    let (mut host, location) = host(folder.path(), held);
    served(&mut host, async {
        let (mut first, mut second) = (client(&location, "first").await, client(&location, "second").await);
        let mut buffer = [0; 16];
        first.acquire(within_deadline()).await.unwrap();
        // The client does not own the line, so nothing is sent.
        second.send(0, b"no").await.unwrap();
        first.send(1, b"yes").await.unwrap();
        assert_eq!(first.receive(1, &mut buffer, within_deadline()).await.unwrap(), Some(3));
        assert_eq!(&buffer[..3], b"yes");
        first.release();
        second.acquire(within_deadline()).await.unwrap();
        second.send(0, b"now").await.unwrap();
        assert_eq!(second.receive(0, &mut buffer, within_deadline()).await.unwrap(), Some(3));
        assert_eq!(&buffer[..3], b"now");
    })
    .await;
}

/// A host that clients of this process can bypass for bytes that begin with "r". After a write to `read_only`, the robot
/// is read-only.
fn direct_host(folder: &Path, read_only: &Rc<Cell<bool>>) -> (Host, SessionPath) {
    let echo: Box<dyn sim::Peer + Send> = Box::new(Echo::default());
    let held = SharedLink::Datagrams(Datagrams::in_process(sim::InProcess::new(echo, None)));
    let (host, location) = host(folder, held);
    let guard = Guard { is_harmless_data: |bytes| bytes.starts_with(b"r"), is_harmless_image: |_, _| false };
    let read_only = Rc::clone(read_only);
    (host.with_read_only_check(guard, move || Ok(read_only.get())), location)
}

async fn in_process(handle: &HostHandle, name: &str) -> Box<Attached> {
    match attach_in_process(handle, name, Purpose::Any).await.unwrap() {
        AttachResult::Session(attached) => attached,
        found => panic!("{found:?}"),
    }
}

async fn assert_echo(client: &mut Attached, bytes: &[u8]) {
    let mut buffer = [0; 16];
    client.acquire(within_deadline()).await.unwrap();
    client.send(0, bytes).await.unwrap();
    let received = client.receive(0, &mut buffer, within_deadline()).await.unwrap();
    assert_eq!(received, Some(bytes.len()));
    assert_eq!(&buffer[..bytes.len()], bytes);
}

#[tokio::test]
async fn reads_of_this_process_do_not_need_the_host() {
    let folder = tempfile::tempdir().unwrap();
    let (mut host, _) = direct_host(folder.path(), &Rc::default());
    let handle = host.handle();
    // The host is not served.
    let mut reader = in_process(&handle, "reader").await;
    assert_echo(&mut reader, b"read").await;
    reader.release();
    assert_echo(&mut reader, b"read again").await;
    assert_eq!(host.status().clients[0].command, "reader");
    drop(reader);
    assert!(host.status().clients.is_empty() && host.clients.is_empty());
}

#[tokio::test]
async fn this_process_takes_turns_with_other_processes() {
    let folder = tempfile::tempdir().unwrap();
    let (mut host, location) = direct_host(folder.path(), &Rc::default());
    let handle = host.handle();
    served(&mut host, async {
        let (mut own, mut other) = (in_process(&handle, "own").await, client(&location, "other").await);
        assert_echo(&mut own, b"read").await;
        // The exchange of this process is not over.
        let soon = || Instant::now() + Duration::from_millis(20);
        let busy = other.acquire(soon()).await.unwrap_err();
        let SessionBusy::Busy(Some(holder)) = busy else { panic!("{busy:?}") };
        assert_eq!((holder.pid, holder.command.as_str()), (std::process::id(), "own"));
        let (taken, ()) = tokio::join!(other.acquire(within_deadline()), async {
            tokio::time::sleep(Duration::from_millis(20)).await;
            own.release();
        });
        taken.unwrap();
        let busy = own.acquire(soon()).await.unwrap_err();
        let SessionBusy::Busy(Some(holder)) = busy else { panic!("{busy:?}") };
        assert_eq!(holder.command, "other");
        assert_echo(&mut other, b"change").await;
        other.release();
        assert_echo(&mut own, b"read").await;
    })
    .await;
}

#[tokio::test]
async fn host_passes_on_the_changes_and_motions_of_this_process() {
    let folder = tempfile::tempdir().unwrap();
    let read_only = Rc::default();
    let (mut host, location) = direct_host(folder.path(), &read_only);
    let handle = host.handle();
    served(&mut host, async {
        let (mut own, mut other) = (in_process(&handle, "own").await, client(&location, "other").await);
        own.claim_motion().await.unwrap();
        assert_echo(&mut own, b"go").await;
        own.release();
        let refused = other.claim_motion().await.unwrap_err();
        let SessionBusy::LocationChanged(mover) = refused else { panic!("{refused:?}") };
        assert_eq!((mover.pid, mover.command.as_str()), (std::process::id(), "own"));
        let clients = status(&location).await.unwrap().unwrap().clients;
        assert_eq!(clients.iter().filter(|client| client.command == "own").count(), 1, "{clients:?}");
        // From now on, only reads pass.
        read_only.set(true);
        own.acquire(within_deadline()).await.unwrap();
        own.send(0, b"write").await.unwrap();
        let refused = own.receive(0, &mut [0; 16], within_deadline()).await.unwrap_err();
        assert_eq!(SessionBusy::of(&refused), Some(SessionBusy::ReadOnly));
        own.release();
        assert_echo(&mut own, b"read").await;
        drop(own);
        while other.claim_motion().await.is_err() {}
    })
    .await;
}

#[tokio::test]
async fn stop_takes_the_line_from_this_process() {
    let folder = tempfile::tempdir().unwrap();
    let (host, location) = direct_host(folder.path(), &Rc::default());
    let (ordered, mut orders) = mpsc::unbounded_channel();
    let mut host = host.with_stop(move |why| ordered.send(why.to_owned()).unwrap());
    let handle = host.handle();
    served(&mut host, async {
        let mut own = in_process(&handle, "own").await;
        assert_echo(&mut own, b"read").await;
        let hello = Hello {
            version: VERSION,
            key: "key".to_owned(),
            pid: 1,
            command: "mover".to_owned(),
            purpose: Purpose::Any,
        };
        let mut buffer = [0; 16];
        let killed = async {
            use tokio::io::AsyncWriteExt as _;

            let (read, mut write) = crate::session::socket::connect(&location.socket()).await.unwrap().unwrap();
            let mut bytes = Vec::new();
            Frame::Control(Control::Hello(hello)).emit(&mut bytes);
            Frame::Control(Control::Motion).emit(&mut bytes);
            write.write_all(&bytes).await.unwrap();
            let mut reader = crate::session::wire::Reader::new(read);
            while reader.next().await.unwrap() != Some(Frame::Control(Control::Granted)) {}
        };
        // The client of this process waits for an answer that does not come.
        let (lost, ()) = tokio::join!(own.receive(0, &mut buffer, within_deadline()), killed);
        assert_eq!(lost.unwrap_err().to_string(), STOP_FIRST);
        assert!(orders.recv().await.unwrap().contains("has died"));
        own.release();
        let busy = own.acquire(Instant::now() + Duration::from_millis(20)).await;
        assert!(matches!(busy, Err(SessionBusy::Busy(_))), "only the stop gets the line: {busy:?}");
        let AttachResult::Session(mut stop) = attach_at(&location, "key", "stop", Purpose::Stop).await.unwrap() else {
            panic!("the session is there")
        };
        assert_echo(&mut stop, b"read").await;
        stop.leave().await;
        assert_echo(&mut own, b"read").await;
    })
    .await;
}

#[tokio::test]
async fn this_process_learns_of_the_end_of_its_session() {
    let folder = tempfile::tempdir().unwrap();
    let (mut host, _) = direct_host(folder.path(), &Rc::default());
    let handle = host.handle();
    let (mut busy, mut idle) = (in_process(&handle, "busy").await, in_process(&handle, "idle").await);
    busy.acquire(within_deadline()).await.unwrap();
    let mut buffer = [0; 16];
    let (lost, ended) =
        tokio::join!(busy.receive(0, &mut buffer, within_deadline()), host.end("the session was closed"));
    ended.unwrap();
    assert_eq!(lost.unwrap_err().to_string(), "the session was closed");
    let ended = SessionBusy::Ended("the session was closed".to_owned());
    assert_eq!(idle.acquire(within_deadline()).await, Err(ended));
    assert!(handle.has_ended());
    assert!(matches!(attach_in_process(&handle, "late", Purpose::Any).await.unwrap(), AttachResult::Nothing));
}

#[tokio::test]
async fn images_reach_a_client_of_this_process() {
    let folder = tempfile::tempdir().unwrap();
    let (mut host, _) = host(folder.path(), images());
    let handle = host.handle();
    served(&mut host, async {
        let mut link = ImageLink::in_session(in_process(&handle, "own").await);
        assert_eq!(link.output().unwrap(), [0, 0, 0x41]);
        link.acquire(within_deadline()).await.unwrap();
        assert_image(&mut link, &[0, 3, 0x01]).await;
        assert_received(&mut link, &[0, 3, 0x01]).await;
    })
    .await;
}

#[tokio::test]
async fn notifies_all_clients_of_the_end() {
    let folder = tempfile::tempdir().unwrap();
    let (mut host, location) = host(folder.path(), images());
    let mut link = served(&mut host, async { ImageLink::in_session(client(&location, "first").await) }).await;
    host.end("the session was closed").await.unwrap();
    let lost = loop {
        match link.next(within_deadline()).await {
            Event::Lost(why) => break why,
            Event::Timeout => panic!("it was never told"),
            _ => {}
        }
    };
    assert_eq!((lost.to_string().as_str(), link.ended()), ("the session was closed", Some("the session was closed")));
    assert!(matches!(link.acquire(within_deadline()).await, Err(SessionBusy::Ended(_))));
    assert!(matches!(attach_at(&location, "key", "late", Purpose::Any).await.unwrap(), AttachResult::Nothing));
}

#[tokio::test]
async fn rejects_a_client_for_another_device() {
    let folder = tempfile::tempdir().unwrap();
    let (mut host, location) = host(folder.path(), images());
    let refused = served(&mut host, attach_at(&location, "other", "wrong", Purpose::Any)).await;
    assert!(refused.unwrap_err().to_string().contains("another device"));
}

/// Sends frames to the host. Returns all frames of the host until the connection is closed.
async fn exchange_control(location: &SessionPath, frames: &[Control]) -> Vec<Frame> {
    use tokio::io::AsyncWriteExt as _;

    let (read, mut write) = crate::session::socket::connect(&location.socket()).await.unwrap().unwrap();
    let mut bytes = Vec::new();
    for control in frames {
        Frame::Control(control.clone()).emit(&mut bytes);
    }
    // The host may close the connection of a refused client early.
    if write.write_all(&bytes).await.is_err() {
        return Vec::new();
    }
    let mut reader = crate::session::wire::Reader::new(read);
    let mut exchange_control = Vec::new();
    while let Ok(Some(frame)) = reader.next().await {
        exchange_control.push(frame);
    }
    exchange_control
}

#[tokio::test(start_paused = true)]
async fn disconnects_clients_without_a_hello() {
    let folder = tempfile::tempdir().unwrap();
    let (mut host, location) = host(folder.path(), images());
    served(&mut host, async {
        let silent: Vec<_> = (0..MAX_CLIENTS).map(|_| exchange_control(&location, &[])).collect();
        let asking = exchange_control(&location, &[Control::Ask]);
        // The host accepts the first clients, and later removes them because they send no Hello. After that, there is a
        // free place.
        let (all, _) = tokio::join!(join_all(silent), async {
            tokio::time::sleep(Duration::from_secs(1)).await;
            asking.await
        });
        assert!(all.iter().all(Vec::is_empty));
        client(&location, "new").await;
        let asked = exchange_control(&location, &[Control::Ask]).await;
        assert!(matches!(asked[..], [Frame::Control(Control::Status(_))]), "{asked:?}");
    })
    .await;
    assert!(host.clients.len() <= 1);
}

#[tokio::test(start_paused = true)]
async fn keeps_silent_clients_after_a_hello() {
    let folder = tempfile::tempdir().unwrap();
    let (mut host, location) = host(folder.path(), images());
    served(&mut host, async {
        let mut link = ImageLink::in_session(client(&location, "patient").await);
        tokio::time::sleep(Duration::from_secs(3600)).await;
        assert_image(&mut link, &[0, 0, 0x01]).await;
    })
    .await;
}

#[tokio::test]
async fn refuses_a_client_of_another_version_with_a_reason() {
    let folder = tempfile::tempdir().unwrap();
    let (mut host, location) = host(folder.path(), images());
    served(&mut host, async {
        let hello = Hello {
            version: VERSION + 1,
            key: "key".to_owned(),
            pid: 1,
            command: "armctl".to_owned(),
            purpose: Purpose::Any,
        };
        let exchange_control = exchange_control(&location, &[Control::Hello(hello)]).await;
        let [Frame::Control(Control::Refused(why))] = &exchange_control[..] else { panic!("{exchange_control:?}") };
        assert!(why.contains("another version"), "{why}");
    })
    .await;
}

#[tokio::test]
async fn stop_precedes_other_frames_after_a_loss_in_motion() {
    let folder = tempfile::tempdir().unwrap();
    let device = tokio::net::TcpListener::bind("127.0.0.1:0").await.unwrap();
    let port = device.local_addr().unwrap().port();
    let open = move || -> Pin<Box<dyn Future<Output = OpenResult>>> {
        Box::pin(async move {
            let opened = Tcp::open("127.0.0.1", port, within_deadline()).await;
            opened.map(Stream::Tcp).map_err(|error| error.to_string())
        })
    };
    let stream = open().await.unwrap();
    let (mut line, _) = device.accept().await.unwrap();
    let (host, location) = host(folder.path(), SharedLink::Stream(Line::new(stream, open)));
    let (ordered, mut orders) = mpsc::unbounded_channel();
    let mut host = host.with_stop(move |why| ordered.send(why.to_owned()).unwrap());
    served(&mut host, async {
        let (mut mover, mut reader) = (client(&location, "mover").await, client(&location, "reader").await);
        mover.claim_motion().await.unwrap();
        mover.acquire(within_deadline()).await.unwrap();
        mover.send(0, b"go").await.unwrap();
        line.read_exact(&mut [0; 2]).await.unwrap();
        // Another client waits for the line when the link is lost. The client that stops the robot comes to the queue
        // last.
        let read = async {
            reader.acquire(within_deadline()).await.unwrap();
            reader.send(0, b"read").await.unwrap();
        };
        let stop = async {
            drop(line);
            let (mut line, _) = device.accept().await.unwrap();
            assert!(orders.recv().await.unwrap().contains("the connection was lost"));
            mover.release();
            let AttachResult::Session(mut stop) = attach_at(&location, "key", "stop", Purpose::Stop).await.unwrap()
            else {
                panic!("the session is there")
            };
            stop.acquire(within_deadline()).await.unwrap();
            stop.send(0, b"stop").await.unwrap();
            stop.leave().await;
            let mut heard = [0; 8];
            line.read_exact(&mut heard).await.unwrap();
            assert_eq!(&heard, b"stopread");
        };
        tokio::join!(read, stop);
    })
    .await;
}
