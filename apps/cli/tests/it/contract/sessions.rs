//! `neurotess render SESSION.neurotess`: sessions of the window, without a window.
#![cfg(target_os = "linux")]

use super::render::Picture;
use crate::needs::gpu;
use crate::work::{Run, SMALL, Work};

const SESSION: &str =
    "version = 1\n[[file]]\npath = \"cell.swc\"\n[[neuron]]\nname = \"cell\"\nfile = 0\n";

/// Drivers are hidden by the variables of the loaders that Linux has.
#[neurotess_testing::test]
fn sessions_are_drawn_without_a_driver() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    work.file("mine.neurotess", SESSION);
    let run = |arguments: &str| {
        let mut command = work.command(arguments);
        for variable in [
            "VK_DRIVER_FILES",
            "VK_ICD_FILENAMES",
            "__EGL_VENDOR_LIBRARY_FILENAMES",
            "LIBGL_DRIVERS_PATH",
        ] {
            command.env(variable, "/nonexistent");
        }
        Run(command.output().expect("it runs"))
    };
    let run_to = |name: &str, more: &str| {
        run(&format!(
            "render mine.neurotess -o {name} --size 120x90 {more}"
        ))
    };
    run_to("a.png", "").exits(0);
    let hues = Picture::read(&work, "a.png").hues().len();
    assert!(hues > 3, "{hues}");
    // What a session does not take is not left aside silently.
    let other = run_to("x.png", "--color-by depth").exits(2);
    assert!(other.stderr().contains("leave out --color-by"));
    run_to("b.png", "--adapter CPU").exits(0);
    assert_eq!(
        Picture::read(&work, "a.png").pixels,
        Picture::read(&work, "b.png").pixels
    );
    let named = run_to("c.png", "--adapter llvmpipe").exits(1);
    assert!(named.errors()[0].contains("install"), "{}", named.stderr());
    assert!(!work.path("c.png").exists());
}

#[neurotess_testing::test(needs(gpu))]
fn sessions_are_drawn_by_the_adapter_that_is_named() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    work.file("mine.neurotess", SESSION);
    let draw = "render mine.neurotess --size 120x90 --samples 4";
    let unknown = work.run(&format!("{draw} -o a.png --adapter nonsense"));
    let unknown = unknown.exits(1);
    let said = &unknown.errors()[0];
    assert!(said.contains("no adapter is called 'nonsense'"), "{said}");
    let mut command = work.command(&format!("{draw} -o a.png"));
    command.env("NEUROTESS_ADAPTER", "nonsense");
    Run(command.output().expect("it runs")).exits(1);
    let mut command = work.command(&format!("{draw} -o a.png --adapter cpu"));
    command.env("NEUROTESS_ADAPTER", "nonsense");
    Run(command.output().expect("it runs")).exits(0);
}
