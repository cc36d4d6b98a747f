//! `cargo xtask pictures`: the pictures of the README and the page of docs/web.md, from the built-in samples.

use std::fs;

use anyhow::Context;

use crate::demo::neurotess;
use crate::steps::{self, Steps, cargo, root};

/// Name, and arguments of `neurotess render`. Small: all together stay below 700 kB.
const PICTURES: &[(&str, &str)] = &[
    ("types", "samples/pyramidal.swc --size 480x640 --scale-bar"),
    (
        "depth",
        "samples/purkinje.swc --size 480x640 --color-by depth --colormap magma --background 101014 --scale-bar",
    ),
    (
        "soma",
        "samples/pyramidal.swc --size 480x360 --eye 60,40,140 --target 0,0,0 --no-legend",
    ),
    (
        "wireframe",
        "samples/pyramidal.swc --size 400x300 --eye 30,20,70 --target 0,0,0 --wireframe --level 2 --no-legend",
    ),
    (
        "synapses",
        "target/pictures/circuit --nodes 0 --synapses --marker-color-by conductance --size 480x360 \
         --eye=-57,1010,200 --target=-57,990,-37 --scale-bar --marker-size 1.8",
    ),
    (
        "contacts",
        "target/pictures/circuit --nodes 0 --synapses --marker-shape contact --size 480x360 \
         --eye=-42,997,23 --target=-57,982,-37 --fov 30 --scale-bar --marker-size 2.2 --no-legend",
    ),
    (
        "spines",
        "target/pictures/spiny.swc --eye=-1.7,356.5,34.3 --target=-9.7,356.5,8.3 --size 480x360 --scale-bar --no-legend",
    ),
    (
        "meshes",
        "samples/pyramidal.swc --mesh=target/pictures/layer_1.obj,opacity=0.25,color=#70b080 \
         --mesh=target/pictures/layer_2-3.obj,opacity=0.25,color=#60a0c8 \
         --mesh=target/pictures/layer_5.obj,opacity=0.25,color=#d0a050 --mesh=target/pictures/pipette.obj,color=#808890 \
         --eye=900,590,2150 --target=-20,35,0 --size 480x560 --samples 64 --scale-bar",
    ),
    (
        "order",
        "samples/motor.swc --size 480x480 --color-by order --samples 16",
    ),
];

/// The page that docs/web.md holds, and arguments of `neurotess html`.
const PAGE: [&str; 2] = [
    "docs/web/pyramidal.html",
    "samples/pyramidal.swc --title pyramidal",
];

/// Runs the command; `golden`: renews the pictures that tests compare with, instead.
pub(crate) fn run(golden: bool) -> anyhow::Result<()> {
    let mut steps = Steps::default();
    if golden {
        steps.step("golden", || {
            let mut test = cargo("test --locked --package neurotess-render --test it -- golden::");
            steps::run(test.env("NEUROTESS_GOLDEN", "renew"))?;
            Ok("look at the changes in crates/render/tests/golden before committing them".into())
        })?;
        return Ok(());
    }
    steps.step("build", crate::demo::build)?;
    steps.step("circuit", || {
        let made =
            "synth circuit -o target/pictures/circuit --neurons 20 --morphologies 2 --synapses 600";
        steps::run(&mut neurotess(&format!("{made} --reported 1 --force -q"))?)?;
        Ok("in target/pictures".into())
    })?;
    steps.step("spines", || {
        let made = "convert samples/pyramidal.swc -o target/pictures/spiny.swc --spines 2";
        steps::run(&mut neurotess(&format!("{made} --force -q"))?)?;
        Ok("in target/pictures".into())
    })?;
    steps.step("meshes", || {
        crate::scenery::write(&root().join("target/pictures"))?;
        Ok("in target/pictures".into())
    })?;
    let mut bytes = 0;
    for (name, arguments) in PICTURES {
        steps.step("picture", || {
            let out = format!("docs/pictures/{name}.png");
            steps::run(&mut neurotess(&format!(
                "render {arguments} -o {out} --force -q"
            ))?)?;
            bytes += fs::metadata(root().join(&out)).context("a picture")?.len();
            Ok(out)
        })?;
    }
    steps.step("page", || {
        let [out, arguments] = PAGE;
        steps::run(&mut neurotess(&format!(
            "html {arguments} -o {out} --force -q"
        ))?)?;
        Ok(out.into())
    })?;
    steps.summary();
    println!("\n{} kB in docs/pictures", bytes / 1000);
    Ok(())
}
