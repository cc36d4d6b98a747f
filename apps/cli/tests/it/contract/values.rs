//! `neurotess render --report`: values of a simulation on the membrane.

use super::render::Picture;
use crate::needs::gpu;
use crate::work::Work;

const CIRCUIT: &str = "synth circuit -o c --neurons 12 --morphologies 3 --seed 4";

/// The brightest pixel of a picture: bare colors on black, so that it is a color of the scale.
fn brightest(work: &Work, options: &str) -> u32 {
    let look = "--background black --light flat --ao 0 --no-legend --colormap magma";
    work.run(&format!(
        "render c -o p.png --force --size 200x300 {look} {options}"
    ))
    .exits(0);
    let picture = Picture::read(work, "p.png");
    let sum = |pixel: &[u8]| pixel[..3].iter().map(|&c| u32::from(c)).sum();
    picture.pixels().map(sum).max().unwrap_or(0)
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn an_action_potential_is_seen_when_it_comes() {
    let work = Work::new();
    work.run(CIRCUIT).exits(0);
    // The only cell to fire in the first 20 ms does so at 14.2 ms: its soma is the brightest thing.
    let report = "--report c/reports/voltage.h5 --range=-70,30";
    let rest = brightest(&work, &format!("{report} --time 14"));
    let fires = brightest(&work, &format!("{report} --time 14.5"));
    let over = brightest(&work, &format!("{report} --time 40"));
    assert!(rest < 250 && over < 250, "{rest}, {over}");
    assert!(fires > 400, "{fires}");
    let spikes = "--report c/reports/spikes.h5";
    let before = brightest(&work, &format!("{spikes} --time 14"));
    let flash = brightest(&work, &format!("{spikes} --time 14.3"));
    let faded = brightest(&work, &format!("{spikes} --time 24.3"));
    assert!(before < 250, "{before}");
    assert!(
        flash > 600 && faded > before + 30 && faded < flash / 2,
        "{flash}, {faded}"
    );
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_series_runs_through_time_in_one_start() {
    let work = Work::new();
    work.run(CIRCUIT).exits(0);
    let look = "--size 160x200 --samples 4 --no-legend --background black --light flat --ao 0";
    let report = "--report c/reports/voltage.h5 --range=-70,30";
    let run = work
        .run(&format!(
            "render c -o f.png {look} {report} --time 14:15.5:0.5 --json"
        ))
        .exits(0);
    let files = ["f_0000.png", "f_0001.png", "f_0002.png"];
    assert_eq!(run.json()["files"], serde_json::json!(files));
    let film = &run.json()["film"];
    let [shown, read] = ["visible_keys", "compartments_read"].map(|key| film[key].as_u64());
    assert!(read > Some(0) && read <= shown, "{film}");
    // Each is the picture of its time alone. Not to the bit: a film adds up colors times weights of
    // 16 bits, a single picture adds up its samples.
    for (file, time) in files.iter().zip([14.0, 14.5, 15.0]) {
        work.run(&format!(
            "render c -o one.png --force {look} {report} --time {time}"
        ))
        .exits(0);
        let [own, alone] = [file, "one.png"].map(|name| Picture::read(&work, name).pixels);
        let apart: Vec<u8> = own
            .iter()
            .zip(&alone)
            .map(|(a, b)| a.abs_diff(*b))
            .collect();
        let above = apart.iter().filter(|&&d| d > 1).count();
        assert!(apart.iter().all(|&d| d <= 3), "{file}");
        assert!(
            above * 10_000 <= own.len(),
            "{file}: {above} of {}",
            own.len()
        );
    }
    let [a, b] = [files[0], files[1]].map(|name| Picture::read(&work, name).pixels);
    assert!(a != b);
    // The camera may go around meanwhile, and a number of pictures may replace the step.
    work.run(&format!(
        "render c -o g.png {look} {report} --time 0:3 --frames 2 --turntable"
    ))
    .exits(0);
    let [a, b] = ["g_0000.png", "g_0001.png"].map(|name| Picture::read(&work, name).pixels);
    assert!(a != b && !work.path("g_0002.png").exists());
    for (times, said) in [
        ("--time 0:3", "needs a step"),
        ("--time 0:3:1 --frames 5", "leave out --frames"),
        ("--time 0:300000:1", "choose a larger step"),
        ("--time 3:0:1", "FROM:TO:STEP"),
        ("--frames 3", "--turntable"),
    ] {
        let run = work
            .run(&format!("render c -o h.png {report} {times}"))
            .exits(2);
        assert!(run.stderr().contains(said), "{times}: {}", run.stderr());
    }
    let beyond = work
        .run(&format!(
            "render c -o h.png {look} {report} --time 99:101:1"
        ))
        .exits(1);
    assert!(
        beyond.stderr().contains("100 ms: choose a time"),
        "{}",
        beyond.stderr()
    );
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn cells_have_colors_as_a_whole() {
    let work = Work::new();
    work.run(CIRCUIT).exits(0);
    let hues = |options: &str| {
        let look = "--light flat --ao 0 --no-legend --size 200x300";
        work.run(&format!("render c -o p.png --force {look} {options}"))
            .exits(0);
        Picture::read(&work, "p.png").hues().len()
    };
    // Mixtures with the background count, too.
    let (one, all) = (
        hues("--nodes 3 --color-by neuron"),
        hues("--color-by neuron"),
    );
    assert!(all > 2 * one, "{one}, {all}");
    let layers = hues("--color-by-attribute layer");
    assert!(layers > one && layers < all, "{one}, {layers}, {all}");
    work.run("synth pyramidal -o cell.swc").exits(0);
    work.file(
        "two.scene.toml",
        "[groups.warm]\ncolor = \"#d02000\"\n[[cells]]\nfile = \"cell.swc\"\ngroup = \"warm\"\n\
         [[cells]]\nfile = \"cell.swc\"\ncolor = \"#0020d0\"\nposition = [300, 0, 0]\n",
    );
    work.run("render two.scene.toml -o s.png --size 120x90")
        .exits(0);
    let picture = Picture::read(&work, "s.png");
    assert!(picture.count(0) > 50 && picture.count(2) > 50);
    let unknown = work
        .run("render c -o q.png --color-by-attribute color")
        .exits(1);
    assert!(unknown.stderr().contains("layer, "), "{}", unknown.stderr());
}

#[neurotess_testing::test]
fn options_of_reports_that_do_not_fit_are_wrong_usage() {
    let work = Work::new();
    work.run(CIRCUIT).exits(0);
    work.run("synth pyramidal -o cell.swc").exits(0);
    for (line, code, said) in [
        (
            "render cell.swc -o p.png --report c/reports/voltage.h5",
            2,
            "needs a circuit",
        ),
        ("render c -o p.png --color-by value", 2, "needs a --report"),
        (
            "render c -o p.png --color-by radius --report c/reports/voltage.h5",
            2,
            "leave out --color-by",
        ),
        ("render c -o p.png --time 3", 2, "--report"),
        (
            "render c -o p.png --report c/reports/voltage.h5 --range 3,2",
            2,
            "the lower first",
        ),
    ] {
        let run = work.run(line).exits(code);
        assert!(run.stderr().contains(said), "{line}: {}", run.stderr());
    }
}

#[neurotess_testing::test]
fn reports_of_other_circuits_are_refused() {
    let work = Work::new();
    work.run(CIRCUIT).exits(0);
    work.run("synth circuit -o other --neurons 20 --morphologies 2 --seed 5")
        .exits(0);
    for (line, said) in [
        (
            "--report c/reports/voltage.h5 --time 400",
            "from 0 to below 100",
        ),
        ("--report c/reports/spikes.h5", "--time"),
        ("--report other/reports/voltage.h5", "8 nodes of population"),
        ("--report c/nodes.h5", "nodes.h5"),
        ("--report nothing.h5", "nothing.h5"),
    ] {
        let run = work.run(&format!("render c -o p.png {line}")).exits(1);
        assert!(run.stderr().contains(said), "{line}: {}", run.stderr());
        assert!(!work.path("p.png").exists(), "{line}");
    }
}
