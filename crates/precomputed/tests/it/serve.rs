//! What browsers get.

use std::fs;
use std::io::{Read, Write};
use std::net::TcpStream;

use neurotess_precomputed::Server;

/// The answer to a request: status line and headers, and the body.
fn answer(url: &str, request: &str) -> (String, Vec<u8>) {
    let address = url.strip_prefix("http://").expect("an address");
    let mut stream = TcpStream::connect(address).expect("connected");
    write!(stream, "{request}\r\nHost: x\r\nConnection: close\r\n\r\n").expect("sent");
    let mut bytes = Vec::new();
    stream.read_to_end(&mut bytes).expect("read");
    let end = bytes
        .windows(4)
        .position(|four| four == b"\r\n\r\n")
        .expect("headers");
    let head = String::from_utf8_lossy(&bytes[..end]).into_owned();
    (head, bytes.split_off(end + 4))
}

#[neurotess_testing::test]
fn parts_of_files_are_served_to_any_page() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("served")).expect("made");
    fs::write(folder.path().join("secret"), "no").expect("written");
    fs::write(folder.path().join("served/a b"), "0123456789").expect("written");
    fs::write(folder.path().join("served/long"), vec![7; 100_000]).expect("written");
    #[cfg(unix)]
    std::os::unix::fs::symlink(
        folder.path().join("secret"),
        folder.path().join("served/link"),
    )
    .expect("linked");
    let server = Server::new(&folder.path().join("served"), 0).expect("begun");
    let url = server.url();
    assert!(url.starts_with("http://127.0.0.1:"));
    std::thread::scope(|scope| {
        scope.spawn(|| server.run());
        let (head, body) = answer(&url, "GET /a%20b HTTP/1.1\r\nRange: bytes=2-4");
        assert!(head.starts_with("HTTP/1.1 206"), "{head}");
        assert!(head.contains("Access-Control-Allow-Origin: *"), "{head}");
        assert!(head.contains("Content-Range: bytes 2-4/10"), "{head}");
        assert!(head.contains("Content-Length: 3"), "{head}");
        assert_eq!(body, b"234");
        let (head, body) = answer(&url, "GET /a%20b?x=1 HTTP/1.1");
        assert!(head.starts_with("HTTP/1.1 200"), "{head}");
        assert_eq!(body, b"0123456789");
        let (head, body) = answer(&url, "GET /a%20b HTTP/1.1\r\nRange: bytes=-3");
        assert!(head.contains("Content-Range: bytes 7-9/10"), "{head}");
        assert_eq!(body, b"789");
        // Without the bytes, and what browsers ask before.
        let (head, body) = answer(&url, "HEAD /a%20b HTTP/1.1");
        assert!(head.starts_with("HTTP/1.1 200"), "{head}");
        assert!(head.contains("Content-Length: 10"), "{head}");
        assert!(body.is_empty());
        let (head, _) = answer(&url, "OPTIONS /a%20b HTTP/1.1");
        assert!(head.starts_with("HTTP/1.1 204"), "{head}");
        assert!(
            head.contains("Access-Control-Allow-Headers: Range"),
            "{head}"
        );
        // Long ones too have their length.
        let (head, body) = answer(&url, "GET /long HTTP/1.1\r\nRange: bytes=1-99999");
        assert!(head.contains("Content-Length: 99999"), "{head}");
        assert_eq!(body.len(), 99_999);
        let status = |request: &str| {
            let (head, _) = answer(&url, request);
            assert!(head.contains("Access-Control-Allow-Origin: *"), "{head}");
            head.split(' ').nth(1).unwrap_or_default().to_owned()
        };
        assert_eq!(status("GET /a%20b HTTP/1.1\r\nRange: bytes=10-12"), "416");
        for hidden in [
            "/",
            "/no",
            "/../secret",
            "/%2e%2e/secret",
            "//etc/passwd",
            "/link",
        ] {
            assert_eq!(status(&format!("GET {hidden} HTTP/1.1")), "404", "{hidden}");
        }
        assert_eq!(status("POST /a%20b HTTP/1.1\r\nContent-Length: 0"), "405");
        server.end();
    });
}
