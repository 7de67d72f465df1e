//! `--watch`: a page in the browser that follows a run.

use std::sync::Mutex;
use std::time::{Duration, Instant};

use serde_json::Value;
use sir_pipeline::Watcher;
use sir_report::{LiveServer, View};

/// Longest time for which a run that has ended waits until the browser has its page.
const LAST_WAIT: Duration = Duration::from_secs(5);

/// Shortest time between two updates.
const PAUSE: Duration = Duration::from_secs(2);

/// Share of the time of a run that updates may take.
const SHARE: f64 = 0.2;

/// Passes the light of a run to a server.
#[derive(Debug)]
pub(crate) struct Page {
    server: LiveServer,
    next: Mutex<Next>,
}

/// When the next update is due.
#[derive(Debug)]
struct Next {
    /// When the last one began.
    begun: Instant,
    due: Instant,
}

impl Page {
    /// Starts the server, and returns it with the address of the page.
    ///
    /// # Errors
    ///
    /// If it cannot be started.
    pub(crate) fn start() -> std::io::Result<(Self, String)> {
        let server = LiveServer::start()?;
        let (url, now) = (server.url(), Instant::now());
        Ok((Self { server, next: Mutex::new(Next { begun: now, due: now }) }, url))
    }
}

impl Watcher for Page {
    fn wants_light(&self) -> bool {
        let Ok(mut next) = self.next.lock() else { return false };
        let now = Instant::now();
        let is_due = now >= next.due;
        if is_due {
            next.begun = now;
        }
        is_due
    }

    fn show(&self, title: &str, view: View, facts: Value, status: &str) {
        self.server.show(title, view, facts, status);
        if let Ok(mut next) = self.next.lock() {
            next.due = Instant::now() + PAUSE.max(next.begun.elapsed().div_f64(SHARE));
        }
    }

    fn end(&self, title: &str, view: Option<View>, facts: Value) {
        self.server.end(title, view, facts);
        self.server.wait_for_reader(LAST_WAIT);
    }

    fn wants_end(&self) -> bool {
        self.server.wants_end()
    }
}
