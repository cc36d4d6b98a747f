//! `cargo xtask demo`: the main job on the built-in samples.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, bail};

use crate::steps::{self, Steps, cargo, output, root, target_folder};

/// What is made of the samples: a folder, and options of `neurotess mesh`.
const MESHES: &[(&str, &str)] = &[
    ("ply", "--format ply"),
    ("glb", "--format glb --max-error 0.05"),
    ("stl", "--format stl --level 2"),
    ("coarse", "--format obj --level 0"),
];

/// Runs the command.
pub(crate) fn run() -> anyhow::Result<()> {
    let mut steps = Steps::default();
    steps.step("build", build)?;
    steps.step("samples", || {
        steps::run(&mut neurotess("info samples")?).map(|()| "what is in samples/".into())
    })?;
    for (folder, options) in MESHES {
        steps.step("mesh", || {
            let arguments = format!("mesh samples -o out/{folder} --force {options}");
            steps::run(&mut neurotess(&arguments)?)?;
            Ok(format!("{} files in out/{folder}", count(folder)?))
        })?;
    }
    steps.step("check", || check(&mut neurotess("check out/ply --json")?))?;
    steps.step("draw", draw)?;
    steps.summary();
    println!(
        "\nLook at the pictures in out/pictures; at out/ply in MeshLab or ParaView, at out/glb in Blender or any viewer of glTF;"
    );
    println!(
        "out/stl is for printing and simulators, out/coarse holds the quads before refinement."
    );
    let program = shown(&program()?);
    println!("Your own cell: {program} mesh cell.swc -o cell.ply");
    if !has_display() {
        println!("On a desktop: cargo build --release, then {program} view samples");
        return Ok(());
    }
    println!("\nNow the window is built, then it opens on the samples; close it to end the demo.");
    build_all()?;
    steps::run(&mut neurotess("view samples")?)
}

/// Whether a window can be opened.
fn has_display() -> bool {
    let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    cfg!(any(target_os = "windows", target_os = "macos"))
        || set("DISPLAY")
        || set("WAYLAND_DISPLAY")
}

/// Builds the program without the window: half of what a cold build takes, and nothing but the window
/// needs it.
pub(crate) fn build() -> anyhow::Result<String> {
    let build =
        "build --release --locked --package neurotess-cli --no-default-features --features render";
    steps::run(&mut cargo(build)).map(|()| "the program neurotess, without its window".into())
}

/// Builds the whole program.
fn build_all() -> anyhow::Result<()> {
    steps::run(&mut cargo(
        "build --release --locked --package neurotess-cli",
    ))
}

/// The program with arguments, in the workspace.
pub(crate) fn neurotess(arguments: &str) -> anyhow::Result<Command> {
    let mut command = Command::new(program()?);
    command
        .args(arguments.split_whitespace())
        .current_dir(root());
    Ok(command)
}

/// A picture of each sample; where no adapter is, the word of the program on what to install.
fn draw() -> anyhow::Result<String> {
    let mut samples: Vec<PathBuf> = fs::read_dir(root().join("samples"))?
        .map(|entry| Ok(entry?.path()))
        .collect::<anyhow::Result<_>>()?;
    samples.retain(|path| path.extension().is_some_and(|e| e == "swc"));
    samples.sort();
    for sample in &samples {
        let name = sample.file_stem().unwrap_or_default().to_string_lossy();
        let arguments =
            format!("render samples/{name}.swc -o out/pictures/{name}.png --scale-bar --force -q");
        let mut command = neurotess(&arguments)?;
        let drawn = command.output().context("the program")?;
        if !drawn.status.success() {
            let words = String::from_utf8_lossy(&drawn.stderr);
            let words = words.lines().rfind(|line| line.starts_with("error: "));
            return Ok(format!(
                "no pictures: {}",
                words.unwrap_or("the program failed")
            ));
        }
    }
    Ok(format!("{} pictures in out/pictures", samples.len()))
}

fn check(command: &mut Command) -> anyhow::Result<String> {
    let verdicts: serde_json::Value = serde_json::from_str(&output(command)?)?;
    let verdicts = verdicts.as_array().context("a list of verdicts")?;
    let mut crossings = 0;
    for verdict in verdicts {
        let name = verdict["file"].as_str().unwrap_or_default();
        let pairs = verdict["self_intersections"].as_u64().unwrap_or(0);
        let sound = |key: &str| verdict[key] == true;
        println!(
            "   {name}: {} triangles, volume {:.0} µm³, {pairs} pairs of faces cross",
            verdict["triangles"],
            verdict["volume"].as_f64().unwrap_or(0.0)
        );
        if !["closed", "edge_manifold", "vertex_manifold", "oriented"]
            .map(sound)
            .contains(&false)
        {
            crossings += pairs;
        } else {
            bail!("{name} is not a closed, oriented 2-manifold");
        }
    }
    Ok(format!(
        "{} meshes are closed, oriented 2-manifolds; {crossings} pairs of faces cross",
        verdicts.len()
    ))
}

fn count(folder: &str) -> anyhow::Result<usize> {
    Ok(fs::read_dir(root().join("out").join(folder))?.count())
}

/// Where Cargo put the program.
fn program() -> anyhow::Result<PathBuf> {
    let name = format!("neurotess{}", std::env::consts::EXE_SUFFIX);
    Ok(target_folder()?.join("release").join(name))
}

fn shown(program: &Path) -> String {
    let root = fs::canonicalize(root()).unwrap_or_default();
    let relative = program.strip_prefix(&root).unwrap_or(program);
    relative.display().to_string()
}
