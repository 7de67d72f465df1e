//! The page of a run that has not ended, served on this computer only.
//!
//! The server listens on the loopback interface, on a port that the system chooses. Every path begins with a random token, and
//! the `Host` of a request must be the address, so that neither other users of the computer nor pages of other sites reach it.

use std::io;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tiny_http::{Header, Method, Request, Response, Server};

use crate::page::served_page;
use crate::view::View;

/// Page that is shown until there is light.
const WAITING: &str = "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><link rel=\"icon\" href=\"data:,\"><title>SIR</title></head>\
    <body><p>The page appears after the first repeat.</p>\
    <script>setTimeout(() => location.reload(), 1000);</script></body></html>";

/// Serves a page that is updated while a run goes on.
#[derive(Debug)]
pub struct LiveServer {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

struct Shared {
    server: Server,
    /// Address with the port, as in the header `Host`.
    host: String,
    token: String,
    content: Mutex<Content>,
    /// Newest version that a browser has.
    seen: AtomicU64,
    wants_end: AtomicBool,
    is_closed: AtomicBool,
}

impl std::fmt::Debug for Shared {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Shared").field("host", &self.host).finish_non_exhaustive()
    }
}

/// What the page shows at present.
#[derive(Clone, Debug, Default)]
struct Content {
    title: String,
    facts: Arc<Value>,
    view: Option<Arc<View>>,
    status: String,
    /// Number of changes of the light.
    version: u64,
    is_final: bool,
}

impl LiveServer {
    /// Starts a server.
    ///
    /// # Errors
    ///
    /// If no port can be opened, or the system has no random numbers.
    pub fn start() -> io::Result<Self> {
        let server = Server::http("127.0.0.1:0").map_err(io::Error::other)?;
        let address = server.server_addr().to_ip().ok_or_else(|| io::Error::other("no IP address"))?;
        let mut random = [0; 16];
        getrandom::fill(&mut random).map_err(io::Error::other)?;
        let shared = Arc::new(Shared {
            server,
            host: address.to_string(),
            token: random.iter().map(|byte| format!("{byte:02x}")).collect(),
            content: Mutex::default(),
            seen: AtomicU64::new(0),
            wants_end: AtomicBool::new(false),
            is_closed: AtomicBool::new(false),
        });
        let of_thread = Arc::clone(&shared);
        let thread = thread::Builder::new().name("page".into()).spawn(move || of_thread.serve())?;
        Ok(Self { shared, thread: Some(thread) })
    }

    /// Returns the address of the page.
    #[must_use]
    pub fn url(&self) -> String {
        format!("http://{}/{}/", self.shared.host, self.shared.token)
    }

    /// Shows light and facts. `status` says how far the run is.
    pub fn show(&self, title: &str, view: View, facts: Value, status: &str) {
        let mut content = self.shared.content();
        let version = content.version + 1;
        let (title, status, facts, view) =
            (title.into(), status.into(), Arc::new(facts), Some(Arc::new(view)));
        *content = Content { title, facts, view, status, version, is_final: false };
    }

    /// Shows the final facts, and the light that was shown last, or `view`.
    pub fn end(&self, title: &str, view: Option<View>, facts: Value) {
        let mut content = self.shared.content();
        content.view = view.map(Arc::new).or(content.view.take());
        (content.title, content.facts) = (title.into(), Arc::new(facts));
        content.version += 1;
        content.is_final = true;
    }

    /// True if the reader of the page wants no further repeats.
    #[must_use]
    pub fn wants_end(&self) -> bool {
        self.shared.wants_end.load(Relaxed)
    }

    /// Waits until a browser has what is shown, if one has asked before, or until the time is over.
    pub fn wait_for_reader(&self, most: Duration) {
        let since = Instant::now();
        let version = self.shared.content().version;
        while (1..version).contains(&self.shared.seen.load(Relaxed)) && since.elapsed() < most {
            thread::sleep(Duration::from_millis(50));
        }
    }
}

impl Drop for LiveServer {
    fn drop(&mut self) {
        self.shared.is_closed.store(true, Relaxed);
        self.shared.server.unblock();
        if let Some(thread) = self.thread.take() {
            // Only a bug lets it panic, and then there is nothing left to do.
            let _ = thread.join();
        }
    }
}

impl Shared {
    /// Returns what is shown. No thread panics while it holds the lock, and whole values are written.
    fn content(&self) -> MutexGuard<'_, Content> {
        self.content.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn serve(&self) {
        while !self.is_closed.load(Relaxed) {
            // `unblock` ends the wait without a request.
            if let Ok(Some(request)) = self.server.recv_timeout(Duration::from_secs(1)) {
                let response = self.response(&request);
                // The browser may have gone.
                let _ = request.respond(response);
            }
        }
    }

    fn response(&self, request: &Request) -> Response<io::Cursor<Vec<u8>>> {
        let host = request.headers().iter().find(|header| header.field.equiv("Host"));
        let is_local = host.is_some_and(|header| header.value.as_str() == self.host);
        let path = request.url().strip_prefix('/').and_then(|path| path.strip_prefix(self.token.as_str()));
        let Some(path) = path.filter(|_| is_local) else { return not_found() };
        let content = self.content().clone();
        let Content { title, facts, view, status, version, is_final } = &content;
        match (request.method(), path, view) {
            (Method::Get, "/", None) => text("text/html", WAITING.into()),
            (Method::Get, "/", Some(view)) => {
                self.seen.fetch_max(*version, Relaxed);
                let live = (!is_final).then_some(*version);
                text("text/html", served_page(title, view, facts, live))
            }
            (Method::Get, "/mesh", Some(view)) => {
                self.seen.fetch_max(*version, Relaxed);
                text("text/plain", view.coded.clone())
            }
            (Method::Get, "/version", _) => {
                let state = json!({ "version": version, "status": status, "final": is_final });
                text("application/json", state.to_string())
            }
            (Method::Post, "/end", _) => {
                self.wants_end.store(true, Relaxed);
                text("text/plain", String::new())
            }
            _ => not_found(),
        }
    }
}

fn not_found() -> Response<io::Cursor<Vec<u8>>> {
    text("text/plain", "not found".into()).with_status_code(404)
}

fn text(kind: &str, content: String) -> Response<io::Cursor<Vec<u8>>> {
    let mut response = Response::from_string(content);
    let headers = [
        ("Content-Type", format!("{kind}; charset=utf-8")),
        ("Cache-Control", "no-store".into()),
        ("X-Content-Type-Options", "nosniff".into()),
        ("Referrer-Policy", "no-referrer".into()),
    ];
    for (field, value) in headers {
        if let Ok(header) = Header::from_bytes(field, value) {
            response.add_header(header);
        }
    }
    response
}
