//! `cargo xtask setup`: what tests need beside Rust. A software Vulkan driver where no other is, for
//! pictures and their tests; OpenGL, whose pictures are compared with those; a virtual display and what
//! types on it, for the window's test; and the Python environment.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::lane::Lane;
use crate::{python, steps, wasm};

/// Folders in which the Vulkan loader looks for drivers on Linux.
const VULKAN_DRIVERS: &[&str] = &[
    "/usr/share/vulkan/icd.d",
    "/usr/local/share/vulkan/icd.d",
    "/etc/vulkan/icd.d",
];

/// Folders in which libEGL looks for drivers on Linux.
const OPENGL_DRIVERS: &[&str] = &["/usr/share/glvnd/egl_vendor.d", "/etc/glvnd/egl_vendor.d"];

/// Programs that the window's test runs.
const PROGRAMS: [&str; 4] = ["Xvfb", "xdotool", "openbox", "import"];

/// What Debian's packages install.
struct Installed {
    what: &'static str,
    /// What cannot be done without it.
    needed_to: &'static str,
    packages: &'static [&'static str],
    is_there: fn() -> bool,
}

/// Mesa's Vulkan drivers, lavapipe among them, and the loader.
const VULKAN: Installed = Installed {
    what: "a Vulkan driver",
    needed_to: "draw; tests of pictures are skipped",
    packages: &["mesa-vulkan-drivers", "libvulkan1"],
    is_there: has_vulkan,
};

/// OpenGL without a display: the loader, and Mesa's drivers, llvmpipe among them.
const OPENGL: Installed = Installed {
    what: "OpenGL",
    needed_to: "draw with it; its tests are skipped",
    packages: &["libegl1", "libegl-mesa0", "libgl1-mesa-dri"],
    is_there: has_opengl,
};

/// A virtual display, what moves the mouse on it, who gives a window the keyboard, what takes pictures of
/// it, and the libraries that a window loads on X11.
const DISPLAY: Installed = Installed {
    what: "a virtual display",
    needed_to: "test the window; its test is skipped",
    packages: &[
        "xvfb",
        "xdotool",
        "openbox",
        "imagemagick",
        "libxkbcommon-x11-0",
        "libxcursor1",
        "libxi6",
        "libxrandr2",
    ],
    is_there: has_display,
};

/// What counts the instructions of work.
const VALGRIND: Installed = Installed {
    what: "Valgrind",
    needed_to: "count instructions; tests of growth are skipped",
    packages: &["valgrind"],
    is_there: || starts("valgrind", "--version"),
};

/// What opens pages.
const CHROMIUM: Installed = Installed {
    what: "Chromium",
    needed_to: "open pages; their tests are skipped",
    packages: &["chromium"],
    is_there: || starts("chromium", "--version"),
};

/// Sets up all that the tests of a lane need. Returns a line about each.
pub(crate) fn run(lane: Lane) -> anyhow::Result<String> {
    let mut parts = vec![VULKAN, OPENGL, DISPLAY];
    if lane == Lane::Full {
        parts.extend([VALGRIND, CHROMIUM]);
    }
    let graphics = match cfg!(target_os = "linux") {
        true => {
            let parts: Vec<String> = parts.iter().map(Installed::set_up).collect();
            parts.join("; ")
        }
        false => "this system has graphics of its own; the window's test runs on Linux only".into(),
    };
    let python = python::set_up(python::of_tests(lane))?;
    let web = match lane {
        Lane::Full => format!("; {}", wasm::set_up()),
        Lane::Quick => String::new(),
    };
    Ok(format!("{python}; {graphics}{web}"))
}

impl Installed {
    /// Installs it where it is not, on Debian and its kin; says how it is. Never fails: without it all
    /// else works, and the tests that need it are skipped.
    fn set_up(&self) -> String {
        let what = self.what;
        if (self.is_there)() {
            return format!("{what} is there");
        }
        let by_hand = format!("install {} to {}", self.packages.join(" "), self.needed_to);
        if !starts("apt-get", "--version") {
            return format!("{what} is missing: {by_hand}");
        }
        let mut install = vec!["install", "-y", "-qq", "--no-install-recommends"];
        install.extend(self.packages);
        match apt(&["update", "-qq"]).and_then(|()| apt(&install)) {
            Ok(()) if (self.is_there)() => format!("installed {what}"),
            Ok(()) => format!("{what} is missing even so: {by_hand}"),
            Err(e) => {
                println!("   {e:#}");
                format!("{what} is missing: {by_hand}")
            }
        }
    }
}

fn has_vulkan() -> bool {
    let named = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"];
    named.iter().any(|name| std::env::var_os(name).is_some()) || any_has_files(VULKAN_DRIVERS)
}

fn has_opengl() -> bool {
    any_has_files(OPENGL_DRIVERS)
}

fn has_display() -> bool {
    PROGRAMS.into_iter().all(is_installed)
}

fn any_has_files(folders: &[&str]) -> bool {
    let has_files = |folder: &&str| {
        let entries = std::fs::read_dir(Path::new(folder));
        entries.is_ok_and(|mut entries| entries.next().is_some())
    };
    folders.iter().any(has_files)
}

/// `apt-get` as the administrator, who is not asked for a password.
pub(crate) fn apt(arguments: &[&str]) -> anyhow::Result<()> {
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
