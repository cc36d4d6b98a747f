//! A folder served to browsers of this machine, as neuroglancer needs it: parts of files, for pages of any origin.
//!
//! Only reading (`GET`, `HEAD`, and `OPTIONS` that browsers ask before), one range at a time, no listing of folders, and
//! nothing but the loopback interface. What is asked for is a regular file below the folder, or not found.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::path::{Component, Path, PathBuf};

use tiny_http::{Header, Method, Request, Response, StatusCode};

/// Requests that are answered at once: browsers ask for six.
const THREADS: usize = 6;

/// Why a folder is not served.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ServeError {
    /// There is no such folder.
    #[error("{} cannot be served ({source}): give a folder", folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The port is taken, or may not be used.
    #[error("port {port} cannot be used ({reason}): choose another one")]
    Port {
        /// The port.
        port: u16,
        /// What the system says.
        reason: String,
    },
}

/// A server of one folder.
pub struct Server {
    server: tiny_http::Server,
    folder: PathBuf,
    address: SocketAddr,
}

impl Server {
    /// Begins to listen; port 0 is any that is free.
    ///
    /// # Errors
    /// There is no such folder, or the port is taken.
    pub fn new(folder: &Path, port: u16) -> Result<Self, ServeError> {
        let root = folder.canonicalize().map_err(|source| ServeError::Folder {
            folder: folder.to_path_buf(),
            source,
        })?;
        let refused = |reason: String| ServeError::Port { port, reason };
        let server = tiny_http::Server::http((Ipv4Addr::LOCALHOST, port))
            .map_err(|error| refused(error.to_string()))?;
        let address = server.server_addr().to_ip();
        let address = address.ok_or_else(|| refused("no address".into()))?;
        Ok(Self {
            server,
            folder: root,
            address,
        })
    }

    /// Whether a port can be listened to.
    ///
    /// # Errors
    /// It is taken.
    pub fn check(port: u16) -> Result<(), ServeError> {
        let bound = TcpListener::bind((Ipv4Addr::LOCALHOST, port));
        let reason = bound.err().map(|error| error.to_string());
        reason.map_or(Ok(()), |reason| Err(ServeError::Port { port, reason }))
    }

    /// Where browsers find it.
    pub fn url(&self) -> String {
        format!("http://{}", self.address)
    }

    /// Answers until [`Server::end`] is called by another thread.
    pub fn run(&self) {
        std::thread::scope(|scope| {
            for _ in 0..THREADS {
                scope.spawn(|| {
                    while let Ok(request) = self.server.recv() {
                        // A browser that has gone away is no error.
                        let _gone = self.answer(request);
                    }
                });
            }
        });
    }

    /// Ends [`Server::run`].
    pub fn end(&self) {
        for _ in 0..THREADS {
            self.server.unblock();
        }
    }

    fn answer(&self, request: Request) -> io::Result<()> {
        match request.method() {
            // The server leaves the bytes out of answers to `HEAD` by itself.
            Method::Get | Method::Head => {}
            Method::Options => {
                let mut response = empty(204);
                response.add_header(header("Access-Control-Allow-Methods", "GET, HEAD"));
                response.add_header(header("Access-Control-Allow-Headers", "Range"));
                return request.respond(response);
            }
            _ => return request.respond(empty(405)),
        }
        let Some((mut file, bytes)) = self.open(request.url()) else {
            return request.respond(empty(404));
        };
        let asked = request
            .headers()
            .iter()
            .find(|header| header.field.equiv("Range"));
        let Some(asked) = asked else {
            let response = Response::new(StatusCode(200), shared(), file, length(bytes), None);
            return request.respond(response.with_chunked_threshold(usize::MAX));
        };
        let Some((first, last)) = range(asked.value.as_str(), bytes) else {
            let mut response = empty(416);
            response.add_header(header("Content-Range", &format!("bytes */{bytes}")));
            return request.respond(response);
        };
        file.seek(SeekFrom::Start(first))?;
        let count = last - first + 1;
        let mut headers = shared();
        let part = format!("bytes {first}-{last}/{bytes}");
        headers.push(header("Content-Range", &part));
        let part = file.take(count);
        let response = Response::new(StatusCode(206), headers, part, length(count), None);
        // With its length, however long.
        request.respond(response.with_chunked_threshold(usize::MAX))
    }

    /// The file of a URL, if it is a regular one below the folder, and its bytes.
    fn open(&self, url: &str) -> Option<(File, u64)> {
        let path = decoded(url.split(['?', '#']).next().unwrap_or_default())?;
        let relative = Path::new(path.trim_start_matches('/'));
        let is_name = |part: Component<'_>| matches!(part, Component::Normal(_));
        if !relative.components().all(is_name) {
            return None;
        }
        // Links may lead elsewhere.
        let path = self.folder.join(relative).canonicalize().ok()?;
        if !path.starts_with(&self.folder) || !path.is_file() {
            return None;
        }
        let file = File::open(path).ok()?;
        let bytes = file.metadata().ok()?.len();
        Some((file, bytes))
    }
}

fn empty(status: u16) -> Response<io::Empty> {
    Response::new(StatusCode(status), shared(), io::empty(), Some(0), None)
}

/// Headers of all answers: pages of any origin may read them, and files may change while one works on them.
fn shared() -> Vec<Header> {
    vec![
        header("Access-Control-Allow-Origin", "*"),
        header(
            "Access-Control-Expose-Headers",
            "Content-Range, Content-Length",
        ),
        header("Accept-Ranges", "bytes"),
        header("Cache-Control", "no-cache"),
        header("Content-Type", "application/octet-stream"),
    ]
}

fn header(name: &str, value: &str) -> Header {
    Header::from_bytes(name, value).expect("names and values of ours are ASCII")
}

fn length(bytes: u64) -> Option<usize> {
    usize::try_from(bytes).ok()
}

/// First and last byte of a range, `bytes=FIRST-LAST`, `bytes=FIRST-` or `bytes=-COUNT`, the last so many; none if the file
/// has no such bytes.
fn range(text: &str, bytes: u64) -> Option<(u64, u64)> {
    let (first, last) = text.trim().strip_prefix("bytes=")?.split_once('-')?;
    if first.is_empty() {
        let count: u64 = last.parse().ok()?;
        return (count > 0 && bytes > 0).then(|| (bytes.saturating_sub(count), bytes - 1));
    }
    let first: u64 = first.parse().ok()?;
    let last = match last {
        "" => bytes.checked_sub(1)?,
        last => last.parse::<u64>().ok()?.min(bytes.checked_sub(1)?),
    };
    (first <= last).then_some((first, last))
}

/// The text of a URL's path, with `%20` and its like resolved.
fn decoded(path: &str) -> Option<String> {
    let mut bytes = Vec::new();
    let mut rest = path.bytes();
    while let Some(byte) = rest.next() {
        if byte != b'%' {
            bytes.push(byte);
            continue;
        }
        let digits = [rest.next()?, rest.next()?].map(|digit| char::from(digit).to_digit(16));
        let [Some(high), Some(low)] = digits else {
            return None;
        };
        bytes.push((16 * high + low) as u8);
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_single_and_within_the_file() {
        assert_eq!(range("bytes=0-3", 10), Some((0, 3)));
        assert_eq!(range("bytes=4-", 10), Some((4, 9)));
        assert_eq!(range("bytes=8-99", 10), Some((8, 9)));
        assert_eq!(range("bytes=-3", 10), Some((7, 9)));
        assert_eq!(range("bytes=-30", 10), Some((0, 9)));
        for wrong in [
            "bytes=10-12",
            "bytes=3-2",
            "bytes=0-1,4-5",
            "lines=0-1",
            "bytes=-0",
        ] {
            assert_eq!(range(wrong, 10), None, "{wrong}");
        }
        assert_eq!(range("bytes=0-", 0), None);
    }

    #[test]
    fn paths_are_decoded() {
        assert_eq!(decoded("/a%20b/%C3%A9").as_deref(), Some("/a b/é"));
        assert_eq!(decoded("/%2"), None);
        assert_eq!(decoded("/%zz"), None);
    }
}
