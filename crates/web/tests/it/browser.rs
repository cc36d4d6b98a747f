//! A headless Chromium, spoken to by the DevTools protocol through two named pipes: no other program is needed.

use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use serde_json::{Value, json};

use crate::unpacked::base64;

/// WebGPU and WebGL by Chromium's own software, which is part of it.
const SOFTWARE: [&str; 6] = [
    "--enable-unsafe-webgpu",
    "--use-webgpu-adapter=swiftshader",
    "--enable-features=Vulkan",
    "--use-vulkan=swiftshader",
    "--use-angle=swiftshader",
    // Without it, WebGL says that it is by software.
    "--enable-unsafe-swiftshader",
];
/// Neither WebGPU nor WebGL.
const NO_GRAPHICS: [&str; 2] = ["--disable-gpu", "--disable-3d-apis"];
/// What it then says itself when a page asks for WebGPU.
const NO_ADAPTERS: &str = "No available adapters.";
/// What keeps it from asking others for anything.
const QUIET: [&str; 8] = [
    "--headless",
    "--no-sandbox",
    "--no-first-run",
    "--disable-quic",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--remote-debugging-pipe",
];
/// Time after which an answer will not come: software compiles shaders for half a minute on a busy machine.
const PATIENCE: Duration = Duration::from_secs(240);

/// The need of tests that open pages.
pub(crate) fn chromium() -> Result<(), String> {
    let there = Command::new("chromium").arg("--version").output();
    let there = there.is_ok_and(|output| output.status.success()) && cfg!(unix);
    there
        .then_some(())
        .ok_or_else(|| "no Chromium: cargo xtask setup --full installs it".into())
}

/// A page that is open.
pub(crate) struct Browser {
    child: Child,
    to: File,
    from: Receiver<Value>,
    session: Value,
    asked: u64,
    /// What was printed to the console, what failed, and addresses that were asked for.
    pub(crate) said: Vec<String>,
}

impl Browser {
    /// Opens a file in a window of this size. `folder`: for the pipes.
    pub(crate) fn open(folder: &Path, page: &Path, hash: &str, size: [u32; 2]) -> Self {
        Self::open_with(&SOFTWARE, folder, page, hash, size)
    }

    /// The same where there is neither WebGPU nor WebGL.
    pub(crate) fn open_without_graphics(folder: &Path, page: &Path, size: [u32; 2]) -> Self {
        Self::open_with(&NO_GRAPHICS, folder, page, "", size)
    }

    fn open_with(
        graphics: &[&str],
        folder: &Path,
        page: &Path,
        hash: &str,
        size: [u32; 2],
    ) -> Self {
        let [to, from] = ["to", "from"].map(|name| folder.join(name));
        let made = Command::new("mkfifo").args([&to, &from]).status();
        assert!(made.is_ok_and(|status| status.success()), "named pipes");
        let profile = format!("--user-data-dir={}", folder.join("profile").display());
        let child = Command::new("sh")
            .args([
                "-c",
                "exec chromium \"$@\" 3<\"$TO\" 4>\"$FROM\"",
                "chromium",
            ])
            .args(QUIET)
            .args(graphics)
            .arg(profile)
            .envs([("TO", &to), ("FROM", &from)])
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("Chromium");
        // In the order in which the shell opens them, since each waits for the other end.
        let to = OpenOptions::new().write(true).open(to).expect("a pipe");
        let from = File::open(from).expect("a pipe");
        let (send, receive) = channel();
        std::thread::spawn(move || {
            for message in BufReader::new(from).split(0).map_while(Result::ok) {
                let message = serde_json::from_slice(&message).expect("JSON");
                if send.send(message).is_err() {
                    return;
                }
            }
        });
        let mut browser = Self {
            child,
            to,
            from: receive,
            session: Value::Null,
            asked: 0,
            said: Vec::new(),
        };
        browser.begin(page, hash, size);
        browser
    }

    fn begin(&mut self, page: &Path, hash: &str, [width, height]: [u32; 2]) {
        let target = self.ask("Target.createTarget", &json!({"url": "about:blank"}));
        let attach = json!({"targetId": target["targetId"], "flatten": true});
        self.session = self.ask("Target.attachToTarget", &attach)["sessionId"].clone();
        for domain in [
            "Runtime.enable",
            "Log.enable",
            "Network.enable",
            "Page.enable",
        ] {
            self.ask(domain, &json!({}));
        }
        let size =
            json!({"width": width, "height": height, "deviceScaleFactor": 1, "mobile": false});
        self.ask("Emulation.setDeviceMetricsOverride", &size);
        let address = format!("file://{}{hash}", page.display());
        self.ask("Page.navigate", &json!({"url": address}));
        self.evaluate(
            "(async () => {
               while (!window.neurotess?.ready) await new Promise((r) => setTimeout(r, 20));
               await neurotess.ready;
             })()",
        );
    }

    /// The pixels of a canvas, four bytes each. `canvas`: an expression for it, or for a promise of it.
    pub(crate) fn pixels(&mut self, canvas: &str) -> Vec<u8> {
        let text = self.evaluate(&format!(
            "Promise.resolve({canvas}).then((canvas) => {{
               const copy = new OffscreenCanvas(canvas.width, canvas.height), context = copy.getContext('2d');
               context.drawImage(canvas, 0, 0);
               const {{ data }} = context.getImageData(0, 0, copy.width, copy.height);
               return btoa(Array.from(data, (byte) => String.fromCharCode(byte)).join(''));
             }})"
        ));
        base64(text.as_str().expect("text"))
    }

    /// The value of an expression, or of what it promises.
    pub(crate) fn evaluate(&mut self, expression: &str) -> Value {
        let asked = json!({"expression": expression, "awaitPromise": true, "returnByValue": true});
        let answer = self.ask("Runtime.evaluate", &asked);
        let fault = &answer["exceptionDetails"];
        assert!(fault.is_null(), "{expression}: {fault}");
        answer["result"]["value"].clone()
    }

    /// Chooses a file, as a dialog does.
    pub(crate) fn choose(&mut self, input: &str, file: &Path) {
        let document = self.ask("DOM.getDocument", &json!({}));
        let of = json!({"nodeId": document["root"]["nodeId"], "selector": input});
        let node = self.ask("DOM.querySelector", &of)["nodeId"].clone();
        let files = json!({"nodeId": node, "files": [file]});
        self.ask("DOM.setFileInputFiles", &files);
    }

    /// Lets the page save files into a folder.
    pub(crate) fn save_into(&mut self, folder: &Path) {
        let allow = json!({"behavior": "allow", "downloadPath": folder});
        self.ask("Browser.setDownloadBehavior", &allow);
    }

    /// Drags a file to a place of the page (pixels), and drops it there.
    pub(crate) fn drop_file(&mut self, [x, y]: [u32; 2], file: &Path) {
        let data = json!({"items": [], "files": [file], "dragOperationsMask": 1});
        for kind in ["dragEnter", "dragOver", "drop"] {
            let event = json!({"type": kind, "x": x, "y": y, "data": data});
            self.ask("Input.dispatchDragEvent", &event);
        }
    }

    /// Presses a key as a keyboard does.
    pub(crate) fn press(&mut self, key: &str) {
        for kind in ["keyDown", "keyUp"] {
            self.ask("Input.dispatchKeyEvent", &json!({"type": kind, "key": key, "code": key, "windowsVirtualKeyCode": if key == "Tab" { 9 } else { 13 }}));
        }
    }

    /// The answer to a command. What happens meanwhile is noted.
    fn ask(&mut self, method: &str, params: &Value) -> Value {
        self.asked += 1;
        let mut message = json!({"id": self.asked, "method": method, "params": params});
        if !self.session.is_null() {
            message["sessionId"] = self.session.clone();
        }
        let mut bytes = serde_json::to_vec(&message).expect("JSON");
        bytes.push(0);
        self.to.write_all(&bytes).expect("Chromium listens");
        loop {
            let answer = self.from.recv_timeout(PATIENCE);
            let answer = answer.unwrap_or_else(|e| panic!("{method}: no answer: {e}"));
            if answer["id"] == self.asked {
                assert!(answer["error"].is_null(), "{method}: {}", answer["error"]);
                return answer["result"].clone();
            }
            self.note(&answer);
        }
    }

    fn note(&mut self, event: &Value) {
        let params = &event["params"];
        let said = match event["method"].as_str() {
            Some("Runtime.consoleAPICalled") => &params["args"],
            Some("Log.entryAdded") if params["entry"]["text"] == NO_ADAPTERS => return,
            Some("Log.entryAdded") => &params["entry"],
            Some("Runtime.exceptionThrown") => &params["exceptionDetails"],
            Some("Network.requestWillBeSent") => {
                let address = &params["request"]["url"];
                // A worker's script and a page in a page are of the page.
                let is_own = |a: &str| {
                    let own = ["file:", "blob:", "about:"];
                    own.iter().any(|start| a.starts_with(start))
                };
                let own = address.as_str().is_some_and(is_own);
                if own {
                    return;
                }
                address
            }
            _ => return,
        };
        self.said.push(said.to_string());
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // It ends its own processes when it is told; a kill alone would leave them.
        let _ = self
            .to
            .write_all(b"{\"id\":0,\"method\":\"Browser.close\"}\0");
        for _ in 0..100 {
            if matches!(self.child.try_wait(), Ok(Some(_))) {
                return;
            }
            std::thread::sleep(Duration::from_millis(50));
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
