//! Tests of image links: sending, events, losses.

use std::collections::VecDeque;
use std::sync::Mutex;

use super::*;

/// Received images with their times; `None` means that the connection to the master has ended.
type ReceivedImages = Vec<(Duration, Option<Vec<u8>>)>;

/// Echo peer: returns each image 3 ms later. The peer is not reachable between the two times in `gone`.
#[derive(Debug, Default)]
struct Echo {
    pending_images: VecDeque<(Duration, Vec<u8>)>,
    shown: Vec<u8>,
    gone: Option<(Duration, Duration)>,
    received: Arc<Mutex<ReceivedImages>>,
}

impl ImagePeer for Echo {
    fn input(&mut self, now: Duration, image: Option<&[u8]>) {
        self.received.lock().unwrap().push((now, image.map(<[u8]>::to_vec)));
        self.pending_images.extend(image.map(|image| (now + Duration::from_millis(3), image.to_vec())));
    }

    fn output(&mut self, now: Duration) -> Option<Vec<u8>> {
        while let Some((_, image)) = self.pending_images.pop_front_if(|(at, _)| *at <= now) {
            self.shown = image;
        }
        let is_gone = self.gone.is_some_and(|(from, to)| (from..to).contains(&now));
        (!is_gone).then(|| self.shown.clone())
    }

    fn wake(&self) -> Option<Duration> {
        let gone = self.gone.into_iter().flat_map(|(from, to)| [from, to]);
        self.pending_images.iter().map(|(at, _)| *at).chain(gone).min()
    }
}

fn at(ms: u64) -> Duration {
    Duration::from_millis(ms)
}

async fn later(link: &mut ImageLink, ms: u64) -> Event {
    link.next(Instant::now() + at(ms)).await
}

fn image(bytes: &[u8]) -> Event {
    Event::Image(bytes.into())
}

#[test]
fn image_after_a_loss_switches_nothing_on() {
    assert_eq!(image_after_loss(&[0x41, 0], &[]), [0x41, 0], "before the first opening");
    assert_eq!(image_after_loss(&[0x41, 0], &[0xFF, 0xFF]), [0x41, 0]);
    assert_eq!(image_after_loss(&[0x41, 0], &[0x40, 0x12]), [0x40, 0]);
}

#[tokio::test(start_paused = true)]
async fn sends_images_at_the_interval_and_reports_changes_only() {
    let echo = Echo::default();
    let received = Arc::clone(&echo.received);
    let mut link = ImageLink::in_process(Box::new(echo));
    assert_eq!(later(&mut link, 10).await, image(&[]));
    link.set_output(b"a").unwrap();
    assert_eq!(later(&mut link, 10).await, Event::Sent);
    link.set_output(b"b").unwrap();
    link.set_output(b"c").unwrap();
    assert_eq!(later(&mut link, 10).await, image(b"a"));
    assert_eq!(later(&mut link, 10).await, Event::Sent);
    assert_eq!(later(&mut link, 10).await, image(b"c"));
    assert_eq!(later(&mut link, 10).await, Event::Timeout);
    link.close().await.unwrap();
    let received: Vec<(u64, Option<Vec<u8>>)> = received
        .lock()
        .unwrap()
        .iter()
        .map(|(at, image)| (u64::try_from(at.as_millis()).unwrap(), image.clone()))
        .collect();
    assert_eq!(received, [(0, Some(b"a".to_vec())), (5, Some(b"c".to_vec())), (18, None)], "b never left");
}

#[tokio::test(start_paused = true)]
async fn drops_unsent_images_at_a_loss() {
    let echo = Echo { gone: Some((at(4), at(20))), ..Echo::default() };
    let received = Arc::clone(&echo.received);
    let mut link = ImageLink::in_process(Box::new(echo));
    assert_eq!(later(&mut link, 1).await, image(&[]));
    link.set_output(b"a").unwrap();
    assert_eq!(later(&mut link, 1).await, Event::Sent);
    link.set_output(b"b").unwrap();
    assert_eq!(later(&mut link, 100).await, image(b"a"));
    let lost =
        LinkError::Lost { cause: Cause::new("the other side of the connection has ended"), outputs: Outputs::Released };
    assert_eq!(later(&mut link, 100).await, Event::Lost(lost));
    assert_eq!(later(&mut link, 10).await, Event::Timeout);
    assert_eq!(later(&mut link, 100).await, Event::Reopened);
    assert_eq!(later(&mut link, 100).await, image(b"a"), "shown again after every opening");
    assert_eq!(later(&mut link, 100).await, Event::Timeout);
    assert_eq!(received.lock().unwrap().len(), 1);
}
