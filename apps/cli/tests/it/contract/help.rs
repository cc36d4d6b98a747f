//! Help, version, usage, completions.

use crate::work::{BROKEN, SMALL, Work};

#[neurotess_testing::test]
fn help_is_as_agreed() {
    let work = Work::new();
    for command in [
        "",
        "info",
        "mesh",
        "neuroglancer",
        "render",
        "html",
        "check",
        "convert",
        "diff",
        "synth",
        "bench refinement",
        "bench exploration",
    ] {
        let help = work.run(&format!("{command} --help")).exits(0).stdout();
        // Windows adds `.exe`.
        let help = help.replace("neurotess.exe", "neurotess");
        let name = if command.is_empty() { "help" } else { command };
        insta::assert_snapshot!(format!("help_{}", name.replace(' ', "_")), help);
    }
}

#[neurotess_testing::test]
fn wrong_usage_exits_with_2() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    for wrong in [
        "",
        "nonsense",
        "info",
        "mesh cell.swc",
        "mesh cell.swc -o cell.ply --level 65",
        "mesh cell.swc -o cell.ply --level 4 --max-error 1",
        "mesh cell.swc -o cell.ply --max-error 0",
        "mesh cell.swc -o cell.ply --poisson 0.5",
        "mesh cell.swc -o cell.ply --soma-scale 0",
        "mesh cell.swc -o cell.ply --soma-level 99",
        "mesh cell.swc -o cell.ply --ring 1=3",
        "mesh cell.swc -o cell.ply --types branch",
        "mesh cell.swc -o cell.ply --shard 0/3",
        "mesh cell.swc -o cell.ply --threads 0",
        "mesh cell.swc -o cell.stl --quads",
        "mesh cell.swc -o cell.glb --quads",
        "mesh cell.swc -o cell.xyz",
        "mesh cell.swc -o cell.ply --format xyz",
        "mesh cell.swc cell.swc -o cell.ply",
        "info cell.swc -q -v",
        "synth nonsense -o cell.swc",
        "synth star -o cell.ply",
        "synth star -o cell.swc --count 2",
        "synth star -o cell.swc --points 5",
        "convert cell.swc -o cell.traces",
        "convert cell.swc -o cell",
        "neuroglancer cell.swc",
        "neuroglancer -o out",
        "neuroglancer cell.swc -o out --max-error 0",
        "neuroglancer cell.swc -o out --lods 13",
        "neuroglancer cell.swc -o out --shard 4/3",
        "neuroglancer cell.swc -o out --color-by layer",
        "neuroglancer - -o out",
    ] {
        let run = work.run(wrong).exits(2);
        assert!(run.stdout().is_empty(), "{wrong}");
        assert!(!run.stderr().is_empty(), "{wrong}");
    }
    assert_eq!(work.names("."), ["cell.swc"]);
}

#[neurotess_testing::test]
fn version_tells_features_on_request() {
    let work = Work::new();
    let short = work.run("--version").exits(0).stdout();
    assert_eq!(
        short.trim(),
        format!("neurotess {}", env!("CARGO_PKG_VERSION"))
    );
    let long = work.run("--version -v").exits(0).stdout();
    assert!(long.contains("adapter:") && long.contains("vtu"), "{long}");
    assert!(work.run("--version --json").exits(0).json()["version"].is_string());
}

#[neurotess_testing::test]
fn completions_of_all_shells() {
    let work = Work::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = work.run(&format!("completions {shell}")).exits(0).stdout();
        assert!(script.contains("max-error"), "{shell}");
    }
}

#[neurotess_testing::test]
fn quiet_says_nothing_but_errors() {
    let work = Work::new();
    work.file("cells/good.swc", SMALL);
    let run = work.run("mesh cells -o out -q").exits(0);
    assert_eq!(run.stdout() + &run.stderr(), "");
    work.file("cells/bad.swc", BROKEN);
    let run = work.run("mesh cells -o out -q --force").exits(1);
    assert_eq!(run.stdout(), "");
    assert_eq!(run.stderr().lines().count(), 1, "{}", run.stderr());
}

#[neurotess_testing::test]
fn color_is_asked_for_or_not() {
    let work = Work::new();
    let plain = work.run("info missing.swc").exits(1).stderr();
    assert!(plain.starts_with("error: missing.swc: "), "{plain}");
    let color = work
        .run("info missing.swc --color always")
        .exits(1)
        .stderr();
    assert!(color.starts_with("\x1b[1;31merror:\x1b[0m"), "{color}");
}
