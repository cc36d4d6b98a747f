//! A real window on a virtual display, driven by synthetic input. Pictures of the screen are kept in the
//! target folder's `view-test`.
#![cfg(target_os = "linux")]

use std::fs;
use std::io::BufRead;
use std::process::Stdio;
use std::thread::sleep;
use std::time::Duration;

use super::display::{Display, display, ends, start, terminate, wait_for};
use crate::needs::gpu;
use crate::work::{SMALL, Work};

#[neurotess_testing::test(needs(gpu, display))]
fn a_window_opens_a_file_is_driven_and_closes() {
    let display = Display::open();
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let mut child = start(&display, &work, "view cell.swc");
    let mut window = String::new();
    wait_for("a window", &mut child, || {
        window = display.xdotool("search --onlyvisible --name neurotess");
        !window.is_empty()
    });
    wait_for("a picture of the cell", &mut child, || {
        display.screenshot("open") > 300
    });
    display.focus();
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
    // The last of them is an edit that is not undone.
    for key in ["1", "ctrl+a", "h", "ctrl+z", "question", "Escape", "g"] {
        display.xdotool(&format!("key --delay 80 {key}"));
        sleep(Duration::from_millis(300));
        display.screenshot(&format!("key_{}", key.replace('+', "_")));
    }
    // There are edits: it asks, and stays where the answer is no.
    display.xdotool("key ctrl+q");
    sleep(Duration::from_secs(2));
    display.screenshot("asked");
    display.xdotool("key Escape");
    sleep(Duration::from_secs(1));
    assert!(display.screenshot("stays") > 300);
    assert!(
        child.try_wait().expect("a child").is_none(),
        "it asks before it quits"
    );
    terminate(&child);
    assert_eq!(ends(&mut child).code(), Some(130));
    let remembered =
        fs::read_to_string(work.path("config").join("viewer.toml")).expect("remembered");
    assert!(remembered.contains("cell.swc"), "{remembered}");
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu, display))]
fn a_window_without_edits_quits_without_a_question() {
    let display = Display::open();
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let mut child = start(&display, &work, "view cell.swc");
    wait_for("a picture of the cell", &mut child, || {
        display.screenshot("unedited") > 300
    });
    display.focus();
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

#[neurotess_testing::test(needs(neurotess_testing::full, gpu, display))]
fn a_window_that_is_terminated_remembers_its_settings() {
    let display = Display::open();
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let mut child = start(&display, &work, "view cell.swc -v");
    wait_for("a picture of the cell", &mut child, || {
        display.screenshot("ended") > 300
    });
    display.focus();
    let mut errors = std::io::BufReader::new(child.stderr.take().expect("its errors"));
    let mut line = String::new();
    // A command is printed before it runs, and the next one after that.
    let keys = [
        ("key y", "SetYDown(true)"),
        ("key l", "SetLasso(true)"),
        ("key o", "SetOrthographic"),
    ];
    for (key, command) in keys {
        display.xdotool(key);
        while !line.contains(command) {
            line.clear();
            assert!(errors.read_line(&mut line).expect("text") > 0, "it goes on");
        }
    }
    terminate(&child);
    assert_eq!(ends(&mut child).code(), Some(130));
    let file = work.path("config").join("viewer.toml");
    let remembered = fs::read_to_string(file).expect("remembered");
    assert!(remembered.contains("cell.swc"), "{remembered}");
    assert!(remembered.contains("lasso = true"), "{remembered}");
    // What changes what is seen is the document's, and ends with it.
    assert!(!remembered.contains("y_down"), "{remembered}");
}

#[neurotess_testing::test(needs(gpu, display))]
fn a_lost_device_ends_the_window_with_an_error_and_a_session() {
    let display = Display::open();
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
    wait_for("a picture of the cell", &mut child, || {
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
    let rescued = work.text("config/rescued.neurotess");
    assert!(rescued.contains("cell.swc") && rescued.contains("position = 0.5"));
}

#[neurotess_testing::test]
fn without_a_display_the_error_names_a_way_out() {
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

#[neurotess_testing::test(needs(gpu, display))]
fn an_unknown_adapter_is_an_error() {
    let display = Display::open();
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
