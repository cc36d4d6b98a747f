//! A real window on a virtual display, driven by synthetic input. Pictures of the screen are kept in the
//! target folder's `view-test`.
#![cfg(target_os = "linux")]

use std::fs;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::work::{SMALL, Work};

/// A display of its own that ends with the test.
struct Display {
    server: Child,
    name: String,
}

impl Drop for Display {
    fn drop(&mut self) {
        drop(self.server.kill());
        drop(self.server.wait());
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

/// The display, or nothing with a word about it.
#[expect(clippy::print_stdout, reason = "a test says what it skips")]
fn display() -> Option<Display> {
    for (program, argument) in [("Xvfb", "-help"), ("xdotool", "version")] {
        if !is_there(program, argument) {
            println!(
                "SKIPPED: {program} is not installed: cargo xtask setup installs it on Debian"
            );
            return None;
        }
    }
    if neurotess::render::adapters().is_empty() {
        println!("SKIPPED: no graphics adapter here");
        return None;
    }
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
        ])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("Xvfb starts");
    let mut line = String::new();
    let out = server.stdout.take().expect("its output");
    std::io::BufRead::read_line(&mut std::io::BufReader::new(out), &mut line).expect("a number");
    let name = format!(":{}", line.trim());
    Some(Display { server, name })
}

impl Display {
    fn xdotool(&self, arguments: &str) -> String {
        let mut command = Command::new("xdotool");
        command
            .args(arguments.split_whitespace())
            .env("DISPLAY", &self.name);
        let out = command.output().expect("xdotool starts");
        String::from_utf8_lossy(&out.stdout).trim().to_owned()
    }

    /// The picture of the screen, and the number of its colours: a blank window has few.
    fn screenshot(&self, name: &str) -> usize {
        let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("view-test");
        fs::create_dir_all(&folder).expect("made");
        let file = folder.join(format!("{name}.png"));
        if !is_there("import", "-version") {
            return usize::MAX;
        }
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
        let mut colours: Vec<&[u8]> = pixels.chunks_exact(step).collect();
        colours.sort_unstable();
        colours.dedup();
        colours.len()
    }
}

/// Waits for the program, but not for ever.
fn ends(child: &mut Child) -> std::process::ExitStatus {
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

fn wait_for(what: &str, mut until: impl FnMut() -> bool) {
    let clock = Instant::now();
    while !until() {
        assert!(clock.elapsed() < Duration::from_secs(90), "never: {what}");
        sleep(Duration::from_millis(200));
    }
}

#[test]
fn a_window_opens_a_file_is_driven_and_closes() {
    let Some(display) = display() else { return };
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let mut command = work.command("view cell.swc");
    command
        .env("DISPLAY", &display.name)
        .env_remove("WAYLAND_DISPLAY")
        .env("NODEVICE_SELECT", "1")
        .env("NEUROTESS_CONFIG", work.path("config"))
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    let mut child = command.spawn().expect("it starts");
    let mut window = String::new();
    wait_for("a window", || {
        window = display.xdotool("search --onlyvisible --name neurotess");
        !window.is_empty()
    });
    wait_for("a picture of the cell", || display.screenshot("open") > 300);
    let id = window.lines().next().unwrap_or_default().to_owned();
    display.xdotool(&format!("windowfocus {id}"));
    // Round, nearer, and a click in the middle.
    display.xdotool(
        "mousemove 560 400 mousedown 1 mousemove_relative 40 10 mousemove_relative 60 10 mouseup 1",
    );
    display.xdotool("mousemove 600 420 click --repeat 4 --delay 60 4");
    sleep(Duration::from_secs(2));
    assert!(display.screenshot("near") > 300);
    display.xdotool("mousemove 600 420 click 1");
    sleep(Duration::from_secs(1));
    display.screenshot("clicked");
    for key in ["1", "ctrl+a", "h", "ctrl+z", "question", "Escape"] {
        display.xdotool(&format!("key --delay 80 {key}"));
        sleep(Duration::from_millis(300));
        display.screenshot(&format!("key_{}", key.replace('+', "_")));
    }
    display.xdotool("key ctrl+q");
    let status = ends(&mut child);
    let mut said = String::new();
    let mut errors = child.stderr.take().expect("its errors");
    std::io::Read::read_to_string(&mut errors, &mut said).expect("text");
    assert!(status.success(), "{status}: {said}");
    let remembered =
        fs::read_to_string(work.path("config").join("viewer.toml")).expect("remembered");
    assert!(remembered.contains("cell.swc"), "{remembered}");
}

#[test]
fn a_lost_device_ends_the_window_with_a_word_and_a_session() {
    let Some(display) = display() else { return };
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let mut command = work.command("view cell.swc --ring 1=0.5");
    command
        .env("DISPLAY", &display.name)
        .env_remove("WAYLAND_DISPLAY")
        .env("NODEVICE_SELECT", "1")
        .env("NEUROTESS_CONFIG", work.path("config"))
        .env("NEUROTESS_TEST_LOSE_DEVICE", work.path("lose"))
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    let mut child = command.spawn().expect("it starts");
    wait_for("a picture of the cell", || {
        display.screenshot("before_loss") > 300
    });
    work.file("lose", "");
    display.xdotool("mousemove 560 400 mousedown 1 mousemove_relative 60 10 mouseup 1");
    let status = ends(&mut child);
    let mut said = String::new();
    let mut errors = child.stderr.take().expect("its errors");
    std::io::Read::read_to_string(&mut errors, &mut said).expect("text");
    assert_eq!(status.code(), Some(1), "{said}");
    assert!(said.contains("device was lost"), "{said}");
    assert!(said.contains("your session is in"), "{said}");
    let rescued = fs::read_to_string(work.path("config/rescued.neurotess")).expect("rescued");
    assert!(rescued.contains("cell.swc") && rescued.contains("position = 0.5"));
}

#[test]
fn without_a_display_there_is_a_word_and_a_way_out() {
    let work = Work::new();
    let mut command = work.command("view");
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
    let out = command.output().expect("it runs");
    let said = String::from_utf8_lossy(&out.stderr);
    assert_eq!(out.status.code(), Some(1), "{said}");
    assert!(
        said.contains("no display") && said.contains("neurotess render"),
        "{said}"
    );
}

#[test]
fn without_such_an_adapter_there_is_a_word_and_a_way_out() {
    let Some(display) = display() else { return };
    let work = Work::new();
    let mut command = work.command("view --adapter nonesuch");
    command
        .env("DISPLAY", &display.name)
        .env_remove("WAYLAND_DISPLAY");
    let out = command.output().expect("it runs");
    let said = String::from_utf8_lossy(&out.stderr);
    assert_eq!(out.status.code(), Some(1), "{said}");
    assert!(said.contains("nonesuch"), "{said}");
}
