//! A virtual display with a window manager, what types and clicks on it, and pictures of it.
#![cfg(target_os = "linux")]

use std::fs;
use std::io::Read;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::work::Work;

/// A display of its own with a window manager; both end with the test.
pub(crate) struct Display {
    server: Child,
    manager: Child,
    pub(crate) name: String,
}

impl Drop for Display {
    fn drop(&mut self) {
        for child in [&mut self.manager, &mut self.server] {
            drop(child.kill());
            drop(child.wait());
        }
    }
}

/// Whether a program can be started.
fn is_there(program: &str, argument: &str) -> bool {
    let mut command = Command::new(program);
    command
        .arg(argument)
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command.status().is_ok()
}

/// The need of tests on a display.
pub(crate) fn display() -> Result<(), String> {
    for (program, argument) in [
        ("Xvfb", "-help"),
        ("xdotool", "version"),
        ("openbox", "--version"),
        ("import", "-version"),
    ] {
        if !is_there(program, argument) {
            return Err(format!(
                "{program} is not installed: cargo xtask setup installs it on Debian"
            ));
        }
    }
    Ok(())
}

impl Display {
    /// Starts both, on a free number.
    pub(crate) fn open() -> Self {
        // The server chooses a free number and says it on its standard output.
        let mut server = Command::new("Xvfb")
            .args([
                "-displayfd",
                "1",
                "-screen",
                "0",
                "1280x860x24",
                "-nolisten",
                "tcp",
                // A server that is left by its first client begins anew, and drops those that come meanwhile.
                "-noreset",
            ])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb starts");
        let mut line = String::new();
        let out = server.stdout.take().expect("its output");
        std::io::BufRead::read_line(&mut std::io::BufReader::new(out), &mut line)
            .expect("a number");
        let name = format!(":{}", line.trim());
        // Without one nobody has the keyboard.
        let manager = Command::new("openbox")
            .env("DISPLAY", &name)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("openbox starts");
        Self {
            server,
            manager,
            name,
        }
    }

    pub(crate) fn xdotool(&self, arguments: &str) -> String {
        let mut command = Command::new("xdotool");
        command
            .args(arguments.split_whitespace())
            .env("DISPLAY", &self.name);
        let out = command.output().expect("xdotool starts");
        String::from_utf8_lossy(&out.stdout).trim().to_owned()
    }

    /// Gives the window the keyboard.
    pub(crate) fn focus(&self) {
        let windows = self.xdotool("search --onlyvisible --name neurotess");
        let id = windows.lines().next().unwrap_or_default();
        self.xdotool(&format!("windowactivate --sync {id}"));
    }

    /// The picture of the screen, and the number of its colors: a blank window has few.
    pub(crate) fn screenshot(&self, name: &str) -> usize {
        let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("view-test");
        fs::create_dir_all(&folder).expect("made");
        let file = folder.join(format!("{name}.png"));
        let mut command = Command::new("import");
        command
            .args(["-window", "root"])
            .arg(&file)
            .env("DISPLAY", &self.name);
        assert!(command.status().expect("import starts").success());
        let file = std::io::BufReader::new(fs::File::open(&file).expect("there"));
        let mut decoder = png::Decoder::new(file);
        // A black screen has one bit a pixel.
        decoder.set_transformations(png::Transformations::normalize_to_color8());
        let mut reader = decoder.read_info().expect("a PNG");
        let mut pixels = vec![0; reader.output_buffer_size().expect("small")];
        let info = reader.next_frame(&mut pixels).expect("decoded");
        let step = info.line_size / info.width as usize;
        let mut colors: Vec<&[u8]> = pixels.chunks_exact(step).collect();
        colors.sort_unstable();
        colors.dedup();
        colors.len()
    }
}

/// The window on a display, with settings of its own, and what it says.
pub(crate) fn start(display: &Display, work: &Work, line: &str) -> Child {
    let mut command = work.command(line);
    command
        .env("DISPLAY", &display.name)
        .env_remove("WAYLAND_DISPLAY")
        .env("NODEVICE_SELECT", "1")
        .env("NEUROTESS_CONFIG", work.path("config"))
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    command.spawn().expect("it starts")
}

/// Waits for the program, but not for ever.
pub(crate) fn ends(child: &mut Child) -> std::process::ExitStatus {
    let clock = Instant::now();
    loop {
        if let Some(status) = child.try_wait().expect("a child") {
            return status;
        }
        if clock.elapsed() > Duration::from_secs(60) {
            drop(child.kill());
            panic!("the window does not close");
        }
        sleep(Duration::from_millis(50));
    }
}

/// Waits for something that the program does. The limit is far beyond what it takes on a machine with other
/// work (13 s for a first picture on two idle cores, over 90 s among compilers): it is for what hangs.
pub(crate) fn wait_for(what: &str, child: &mut Child, mut until: impl FnMut() -> bool) {
    let clock = Instant::now();
    while !until() {
        if let Some(status) = child.try_wait().expect("a child") {
            panic!("{status} before {what}: {}", said(child));
        }
        if clock.elapsed() > Duration::from_secs(300) {
            drop(child.kill());
            panic!("never: {what}; it said: {}", said(child));
        }
        sleep(Duration::from_millis(200));
    }
}

/// What the program wrote to its standard error, if nobody else reads it.
fn said(child: &mut Child) -> String {
    let mut text = String::new();
    if let Some(mut errors) = child.stderr.take() {
        drop(errors.read_to_string(&mut text));
    }
    text
}

/// Asks a program to end.
pub(super) fn terminate(child: &Child) {
    let id = child.id().to_string();
    let mut kill = Command::new("kill");
    assert!(
        kill.args(["-TERM", &id])
            .status()
            .expect("kill starts")
            .success()
    );
}
