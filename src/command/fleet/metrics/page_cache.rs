//! Pages that several scrapers share.

use std::cell::RefCell;
use std::rc::Rc;
use std::time::Duration;

use tokio::time::Instant;

use super::board::Board;
use super::catalogue;
use super::page::Form;
use armctl_transport::http::Body;

/// Time for which a page is kept. Within this time, scrapers get the same text, and armctl compresses it once. It also
/// limits the CPU time that scrapers can use. It is short compared with the interval of scrapes.
const MAX_AGE: Duration = Duration::from_millis(200);

/// The latest page in each format.
#[derive(Debug)]
pub struct PageCache<'a> {
    board: &'a RefCell<Board>,
    pages: RefCell<Vec<CachedPage>>,
}

#[derive(Debug)]
struct CachedPage {
    form: Form,
    rendered: Instant,
    body: Rc<Body>,
}

impl<'a> PageCache<'a> {
    /// An empty cache for pages of this data.
    pub fn new(board: &'a RefCell<Board>) -> Self {
        Self { board, pages: RefCell::default() }
    }

    /// The page in a format.
    pub fn body(&self, form: Form) -> Rc<Body> {
        let mut pages = self.pages.borrow_mut();
        pages.retain(|page| page.rendered.elapsed() < MAX_AGE);
        if let Some(page) = pages.iter().find(|page| page.form == form) {
            return Rc::clone(&page.body);
        }
        let body = Rc::new(Body::new(catalogue::page(&self.board.borrow(), form)));
        pages.push(CachedPage { form, rendered: Instant::now(), body: Rc::clone(&body) });
        body
    }
}

#[cfg(test)]
mod tests {
    use tokio::time::advance;

    use super::*;

    #[tokio::test(start_paused = true)]
    async fn scrapers_share_a_page_for_a_short_time() {
        let board = RefCell::default();
        let cache = PageCache::new(&board);
        let first = cache.body(Form::Text);
        assert!(!Rc::ptr_eq(&first, &cache.body(Form::OpenMetrics)));
        advance(MAX_AGE / 2).await;
        assert!(Rc::ptr_eq(&first, &cache.body(Form::Text)));
        advance(MAX_AGE / 2).await;
        assert!(!Rc::ptr_eq(&first, &cache.body(Form::Text)));
        assert_eq!(cache.pages.borrow().len(), 1, "the expired page of the other format is dropped");
    }
}
