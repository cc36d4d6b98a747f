//! `cargo xtask setup`: what tests need beside Rust. A software Vulkan driver where no other is, for
//! pictures and their tests; a virtual display and what types on it, for the window's test; and the
//! Python environment.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::{python, steps};

/// Folders in which the Vulkan loader looks for drivers on Linux.
const DRIVERS: &[&str] = &[
    "/usr/share/vulkan/icd.d",
    "/usr/local/share/vulkan/icd.d",
    "/etc/vulkan/icd.d",
];

/// Debian's packages: Mesa's drivers, lavapipe among them, and the loader.
const PACKAGES: [&str; 2] = ["mesa-vulkan-drivers", "libvulkan1"];

/// A virtual display, what moves the mouse on it, who gives a window the keyboard, what takes pictures of
/// it, and the libraries that a window loads on X11.
const DISPLAY_PACKAGES: [&str; 8] = [
    "xvfb",
    "xdotool",
    "openbox",
    "imagemagick",
    "libxkbcommon-x11-0",
    "libxcursor1",
    "libxi6",
    "libxrandr2",
];

/// Sets up all that tests need. Returns a line about each.
pub(crate) fn run() -> anyhow::Result<String> {
    let (adapter, display) = (adapter(), display());
    let python = python::set_up(&python::TESTS)?;
    Ok(format!("{python}; {adapter}; {display}"))
}

/// Installs a virtual display where there is none, on Debian and its kin; says how it is. Never fails.
fn display() -> String {
    if !cfg!(target_os = "linux") {
        return "the window's test runs on Linux only".into();
    }
    let programs = ["Xvfb", "xdotool", "openbox", "import"];
    let is_there = || programs.into_iter().all(is_installed);
    if is_there() {
        return "a virtual display is there".into();
    }
    let by_hand = format!(
        "install {} to test the window; its test is skipped",
        DISPLAY_PACKAGES.join(" ")
    );
    if !starts("apt-get", "--version") {
        return format!("no virtual display: {by_hand}");
    }
    let mut install = vec!["install", "-y", "-qq", "--no-install-recommends"];
    install.extend(DISPLAY_PACKAGES);
    match apt(&["update", "-qq"]).and_then(|()| apt(&install)) {
        Ok(()) if is_there() => "installed a virtual display".into(),
        Ok(()) => format!("no virtual display even so: {by_hand}"),
        Err(e) => {
            println!("   {e:#}");
            format!("no virtual display: {by_hand}")
        }
    }
}

/// Installs lavapipe where no Vulkan driver is, on Debian and its kin; says how it is. Never fails:
/// without a driver all but pictures works, and their tests are skipped.
fn adapter() -> String {
    if !cfg!(target_os = "linux") {
        return "this system has graphics of its own".into();
    }
    if has_driver() {
        return "a Vulkan driver is there".into();
    }
    let by_hand = format!(
        "install {} to draw; tests of pictures are skipped",
        PACKAGES.join(" ")
    );
    if !starts("apt-get", "--version") {
        return format!("no Vulkan driver: {by_hand}");
    }
    let installed = apt(&["update", "-qq"]).and_then(|()| {
        apt(&[
            "install",
            "-y",
            "-qq",
            "--no-install-recommends",
            PACKAGES[0],
            PACKAGES[1],
        ])
    });
    match installed {
        Ok(()) if has_driver() => "installed lavapipe, a Vulkan driver in software".into(),
        Ok(()) => format!("no Vulkan driver even so: {by_hand}"),
        Err(e) => {
            println!("   {e:#}");
            format!("no Vulkan driver: {by_hand}")
        }
    }
}

fn has_driver() -> bool {
    let named = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"];
    let has_files = |folder: &&str| {
        let entries = std::fs::read_dir(Path::new(folder));
        entries.is_ok_and(|mut entries| entries.next().is_some())
    };
    named.iter().any(|name| std::env::var_os(name).is_some()) || DRIVERS.iter().any(has_files)
}

/// `apt-get` as the administrator, who is not asked for a password.
fn apt(arguments: &[&str]) -> anyhow::Result<()> {
    let mut command = if starts("sudo", "--version") {
        let mut sudo = Command::new("sudo");
        sudo.args(["-n", "apt-get"]);
        sudo
    } else {
        Command::new("apt-get")
    };
    steps::run(
        command
            .args(arguments)
            .env("DEBIAN_FRONTEND", "noninteractive"),
    )
}

fn starts(program: &str, argument: &str) -> bool {
    let mut command = Command::new(program);
    let status = command
        .arg(argument)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    status.is_ok_and(|status| status.success())
}

/// Whether a program is there, whatever it says of having no display.
fn is_installed(program: &str) -> bool {
    let mut command = Command::new(program);
    command
        .arg("-help")
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command.status().is_ok()
}
