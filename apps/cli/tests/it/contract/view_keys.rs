//! Keys in a real window, as a keyboard sends them: each shortcut runs its command and no other.
#![cfg(target_os = "linux")]

use std::io::{BufRead, BufReader};
use std::process::Child;
use std::sync::mpsc::{Receiver, channel};
use std::thread::{sleep, spawn};
use std::time::Duration;

use neurotess_viewer::Command;
use neurotess_viewer::command::{FilePurpose, Listed, Toggles, listed};

use super::display::{Display, display, ends, start, terminate, wait_for};
use crate::needs::gpu;
use crate::work::{SMALL, Work};

/// Lines of what the program says, as they come.
fn lines(child: &mut Child) -> Receiver<String> {
    let from = BufReader::new(child.stderr.take().expect("its errors"));
    let (sender, receiver) = channel();
    spawn(move || {
        for line in from.lines().map_while(Result::ok) {
            drop(sender.send(line));
        }
    });
    receiver
}

/// The commands that it says for a while; waits for one if `any`.
fn commands(lines: &Receiver<String>, any: bool) -> Vec<String> {
    let patience = Duration::from_secs(if any { 60 } else { 1 });
    let mut found = Vec::new();
    let mut next = lines.recv_timeout(patience);
    while let Ok(line) = next {
        if let Some(command) = line.strip_prefix("command: ") {
            found.push(command.to_owned());
        }
        let wait = if found.is_empty() { 60_000 } else { 400 };
        next = lines.recv_timeout(Duration::from_millis(wait));
    }
    found
}

/// As xdotool calls a key of a shortcut, such as `ctrl+shift+z`.
fn keysym(item: &Listed) -> Option<String> {
    let keys = item.keys?;
    let mut name = String::new();
    if keys.modifiers.command {
        name.push_str("ctrl+");
    }
    if keys.modifiers.shift {
        name.push_str("shift+");
    }
    let key = keys.logical_key;
    let one = key.symbol_or_name();
    name.push_str(&match one {
        "," => "comma".to_owned(),
        "." => "period".to_owned(),
        "?" => "question".to_owned(),
        letter if letter.len() == 1 => letter.to_lowercase(),
        "Space" => "space".to_owned(),
        _ => key.name().to_owned(),
    });
    Some(name)
}

fn opens_a_dialog(command: &Command) -> bool {
    matches!(
        command,
        Command::AskFiles(_) | Command::TogglePalette | Command::ToggleKeys
    )
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu, display))]
fn every_shortcut_of_a_real_window_runs_its_command() {
    let display = Display::open();
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let mut child = start(&display, &work, "view cell.swc -v");
    let lines = lines(&mut child);
    wait_for("a picture of the cell", &mut child, || {
        display.screenshot("keys") > 300
    });
    display.focus();
    let items = listed(&Toggles::default());
    for item in items.into_iter().flat_map(|(_, items)| items) {
        let (Some(name), false) = (keysym(&item), item.command == Command::Quit) else {
            continue;
        };
        display.xdotool(&format!("key {name}"));
        let ran = commands(&lines, true);
        assert_eq!(ran, [format!("{:?}", item.command)], "{name}");
        if opens_a_dialog(&item.command) {
            display.xdotool("key Escape");
            assert_eq!(commands(&lines, false), [""; 0], "Escape after {name}");
        }
    }
    // Typed as fast as it goes, into a dialog that is just opening.
    let path = work.path("cell.swc");
    display.xdotool("key ctrl+o");
    display.xdotool(&format!("type --delay 1 {}", path.display()));
    display.xdotool("key Return");
    let open = format!("{:?}", Command::Open(vec![path]));
    let ran = commands(&lines, true);
    let dialog = format!("{:?}", Command::AskFiles(FilePurpose::Open));
    assert!(
        ran == [dialog.clone(), open.clone()] || ran == [dialog],
        "{ran:?}"
    );
    if ran.len() == 1 {
        assert_eq!(commands(&lines, true), [open]);
    }
    sleep(Duration::from_millis(500));
    display.screenshot("typed");
    // Ctrl+Q would ask what becomes of all these edits.
    terminate(&child);
    assert_eq!(ends(&mut child).code(), Some(130));
}
