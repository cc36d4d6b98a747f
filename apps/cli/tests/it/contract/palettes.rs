//! Colors of one's own: palettes in files, single colors, and whether they can be told apart.

use std::fs;

use serde_json::Value;

use super::render::Picture;
use crate::needs::gpu;
use crate::work::{Run, SMALL, Work};

const MINE: &str = "base = 'okabe-ito'\nbackground = '#102030'\n\n[types]\naxon = '#ff8800'\n\
                    dendrite = '#00aa66'\n\n[categories]\n'neurite 1' = '#fe00fe'\n";

/// Draws the small cell in plain colors.
fn drawn(arguments: &str) -> (Work, Run) {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    work.file("mine.toml", MINE);
    let run = work
        .run(&format!(
            "render cell.swc -o cell.png --size 160x120 --light flat --ao 0 --no-legend {arguments}"
        ))
        .exits(0);
    (work, run)
}

/// Whether pixels have exactly this color.
fn shows(arguments: &str, color: [u8; 3]) -> bool {
    let picture = Picture::read(&drawn(arguments).0, "cell.png");
    picture.pixels().filter(|pixel| pixel[..3] == color).count() > 5
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn files_and_options_set_colors() {
    let (axon, dendrite) = ([255, 136, 0], [0, 170, 102]);
    assert!(!shows("", axon));
    let file = "--palette mine.toml";
    assert!(shows(file, axon) && shows(file, dendrite));
    assert!(shows(file, [16, 32, 48]), "its background");
    let white = format!("{file} --background white");
    assert!(shows(&white, [255; 3]) && !shows(&white, [16, 32, 48]));
    // An option counts more than the file.
    let both = format!("{file} --set-color axon=#123456 --set-color soma=fed");
    assert!(shows(&both, [18, 52, 86]) && !shows(&both, axon) && shows(&both, dendrite));
    assert!(shows(&both, [255, 238, 221]));
    // By the name in the legend, whatever neurons are colored by.
    let neurites = format!("{file} --color-by neurite");
    assert!(shows(&neurites, [254, 0, 254]) && !shows(&neurites, axon));
    assert!(shows(
        "--color-by neuron --set-color cell=010203",
        [1, 2, 3]
    ));
    // Numbers keep their color map; somata may have a color.
    assert!(shows(
        "--color-by depth --set-color soma=#010203",
        [1, 2, 3]
    ));
}

#[neurotess_testing::test]
fn faults_of_palettes_have_a_line_and_a_remedy() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    work.file("bad.toml", "base = 'neurom'\n[types]\naxon = 'reddish'\n");
    for (arguments, says) in [
        ("--palette bad.toml", "bad.toml:3: 'reddish' is no color"),
        ("--palette missing.toml", "missing.toml: cannot be read"),
        ("--palette mine", "or a palette's file, as in mine.toml"),
        ("--palette cell.swc", "cell.swc:2: "),
        ("--set-color axon", "as in axon=#ff8800"),
        ("--set-color axon=reddish", "RRGGBB"),
    ] {
        let run = work.run(&format!("render cell.swc -o cell.png {arguments}"));
        let told = run.exits(2).stderr();
        assert!(told.contains(says), "{arguments}: {told}");
    }
    assert_eq!(work.names("."), ["bad.toml", "cell.swc"]);
}

#[neurotess_testing::test]
fn colors_that_look_alike_are_told_once() {
    let stats = |work: &Work| -> Value {
        let stats = fs::read_to_string(work.path("stats.json")).expect("stats");
        serde_json::from_str(&stats).expect("JSON")
    };
    let (work, run) = drawn("--stats stats.json");
    assert_eq!(run.stderr().matches("alike").count(), 0, "{}", run.stderr());
    assert_eq!(stats(&work)["colors"]["alike"], 0);
    let own = "--set-color axon=#d04248 --set-color basal=#48923e --turntable --frames 2";
    let (work, run) = drawn(&format!("--stats stats.json {own}"));
    let told = "'axon' and 'basal dendrite' look alike with deuteranopia: choose others by \
                --set-color, or --palette okabe-ito";
    assert_eq!(run.stderr().matches(told).count(), 1, "{}", run.stderr());
    let colors = &stats(&work)["colors"];
    assert_eq!(colors["alike"], 1);
    assert_eq!(colors["vision"], "deuteranopia");
    assert!(colors["difference"].as_f64().expect("a number") < 0.01);
    // Numbers have no list of colors.
    let (work, _) = drawn("--stats stats.json --color-by depth");
    assert!(stats(&work)["colors"].is_null());
}

#[neurotess_testing::test]
fn names_that_nothing_has_are_told() {
    let (_, run) = drawn("--set-color apical=f00 --set-color axon=00f");
    let told = "nothing in the picture is called 'apical': there are soma, axon, basal dendrite";
    assert!(run.stderr().contains(told), "{}", run.stderr());
    assert!(!run.stderr().contains("'axon'"), "{}", run.stderr());
}

#[neurotess_testing::test]
fn cells_of_a_circuit_have_own_colors() {
    let work = Work::new();
    work.run("synth circuit -o circuit --neurons 12 --morphologies 2 --seed 5")
        .exits(0);
    let shows = |arguments: &str, color: [u8; 3]| {
        let plain = "--force --size 480x360 --samples 1 --light flat --ao 0 --no-legend";
        work.run(&format!("render circuit -o c.png {plain} {arguments}"))
            .exits(0);
        let picture = Picture::read(&work, "c.png");
        picture.pixels().filter(|pixel| pixel[..3] == color).count() > 5
    };
    let own = "--set-color cortex=#010203";
    let by = "--color-by-attribute population";
    assert!(shows(&format!("{by} {own}"), [1, 2, 3]) && !shows(by, [1, 2, 3]));
}
