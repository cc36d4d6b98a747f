//! `neurotess render --like`, scale bars that do not fit, and what PNG files tell.

use std::fs;

use super::render::Picture;
use crate::work::{SMALL, Work, long_cell};

#[neurotess_testing::test]
fn a_picture_tells_how_it_was_made_and_others_are_drawn_like_it() {
    let work = Work::new();
    let cells = [
        ("cell.swc", SMALL.to_owned()),
        ("other.swc", long_cell(300)),
    ];
    for (name, content) in cells {
        work.file(name, content);
    }
    work.file("colors/mine.csv", "x,y,z\n1,2,3\n");
    let options = "--size 120x90 --samples 1 --view iso --color-by depth --colormap magma --axes --background black \
                   --points colors/mine.csv --least-width 0";
    work.run(&format!("render cell.swc -o figure.png {options}"))
        .exits(0);
    let told = work.files(".")[&work.path("figure.png")].clone();
    let told = String::from_utf8_lossy(&told).into_owned();
    assert!(
        told.contains("\"points\":\"mine.csv\"") && !told.contains("colors/"),
        "names, no folders"
    );
    // Points are files of one's own: they are named again. Of the colors, only one is another.
    let again = "--like figure.png --points colors/mine.csv --colormap viridis";
    work.run(&format!("render other.swc -o like.png {again}"))
        .exits(0);
    let direct = format!("{options} --colormap viridis").replace("--colormap magma", "");
    work.run(&format!("render other.swc -o direct.png {direct}"))
        .exits(0);
    let [like, direct] =
        ["like.png", "direct.png"].map(|name| work.files(".")[&work.path(name)].clone());
    assert!(like == direct, "with the same text, too");
    work.run("render cell.swc -o plain.png --no-recipe --size 40x30")
        .exits(0);
    let run = work
        .run("render cell.swc -o x.png --like plain.png")
        .exits(1);
    assert!(
        run.stderr()
            .contains("plain.png: does not tell how it was made"),
        "{}",
        run.stderr()
    );
    let run = work
        .run("render cell.swc -o x.png --like cell.swc")
        .exits(1);
    assert!(
        run.stderr().contains("cell.swc: no PNG file"),
        "{}",
        run.stderr()
    );
}

#[neurotess_testing::test]
fn a_bar_that_does_not_fit_is_left_out_and_a_frame_is_one_picture() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let small = "--size 80x60 --samples 1 --no-legend --no-recipe";
    work.run(&format!("render cell.swc -o plain.png {small}"))
        .exits(0);
    for length in ["1e12", "1e-9"] {
        let run = work.run(&format!(
            "render cell.swc -o x.png --force --scale-bar {length} {small}"
        ));
        assert!(run.exits(0).stderr().contains("the scale bar is left out"));
        let files = work.files(".");
        assert!(files[&work.path("x.png")] == files[&work.path("plain.png")]);
    }
    let small = "--size 80x60 --samples 1 --no-legend";
    work.run(&format!(
        "render cell.swc -o turn.png --turntable --frames 3 {small}"
    ))
    .exits(0);
    work.run("render cell.swc -o one.png --like turn_0001.png")
        .exits(0);
    let [one, frame] = ["one.png", "turn_0001.png"].map(|name| Picture::read(&work, name));
    assert!(one.pixels == frame.pixels);
}

#[neurotess_testing::test]
fn the_colors_of_a_palette_s_file_are_in_the_picture() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    work.file(
        "mine.toml",
        "base = \"okabe-ito\"\n[types]\naxon = \"#ff8800\"\n",
    );
    let small = "--size 40x30 --samples 1 --no-legend";
    work.run(&format!(
        "render cell.swc -o own.png --palette mine.toml {small}"
    ))
    .exits(0);
    fs::remove_file(work.path("mine.toml")).expect("removed");
    work.run("render cell.swc -o again.png --like own.png")
        .exits(0);
    work.run(&format!("render cell.swc -o usual.png {small}"))
        .exits(0);
    let [own, again, usual] =
        ["own.png", "again.png", "usual.png"].map(|name| Picture::read(&work, name));
    assert!(own.pixels == again.pixels && own.pixels != usual.pixels);
}
