//! Synapses of circuits and points of tables in pictures.

use hdf5_pure::{AttrValue, FileBuilder};

use crate::needs::gpu;
use crate::work::{SMALL, Work};

const POINTS: &str = "x,y,z,weight\n0,20,0,0.5\n0,-20,0,1.5\n9,12,4,\n";

/// A circuit of cells with synapses.
fn circuit() -> Work {
    let work = Work::new();
    work.run(
        "synth circuit -o c --neurons 12 --morphologies 3 --points 80 --reported 4 --synapses 9",
    )
    .exits(0);
    work
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn synapses_of_the_cells_that_are_drawn_are_shown() {
    let work = circuit();
    let draw = |options: &str| {
        let run = work.run(&format!(
            "render c -o {options} --size 160x120 --samples 1 --no-legend --json"
        ));
        run.exits(0)
    };
    let none = draw("none.png").json();
    assert!(none["markers"].is_null(), "{none}");
    let all = draw("all.png --synapses").json();
    assert_eq!(all["markers"]["all"], 12 * 9, "{all}");
    let some = draw("some.png --synapses --nodes 3,5 --marker-color-by conductance");
    assert_eq!(some.json()["markers"]["all"], 2 * 9);
    assert!(
        some.stderr()
            .contains("18 synapses of the cells that are drawn, 90 of others"),
        "{}",
        some.stderr()
    );
    let named = draw("named.png --synapses=cortex__cortex__chemical").json();
    assert_eq!(named["markers"]["all"], 12 * 9);
    let pictures = ["none", "all", "some"]
        .map(|name| work.files(".")[&work.path(&format!("{name}.png"))].clone());
    assert!(pictures[0] != pictures[1] && pictures[1] != pictures[2]);
}

/// Replaces the edges of [`circuit`] by ones that only say their sections: one onto each cell's soma and one onto its
/// first section; the last section does not exist.
fn write_sections(work: &Work) {
    let targets: Vec<u64> = (0..12).chain(0..12).collect();
    let mut sections: Vec<u64> = (0..24).map(|row| row / 12).collect();
    sections[23] = 100_000;
    let mut file = FileBuilder::new();
    let mut edges = file.create_group("edges");
    let mut population = edges.create_group("cortex__cortex__chemical");
    for end in ["source_node_id", "target_node_id"] {
        population
            .create_dataset(end)
            .with_u64_data(&targets)
            .set_attr("node_population", AttrValue::VarLenString("cortex".into()));
    }
    let mut group = population.create_group("0");
    group
        .create_dataset("afferent_section_id")
        .with_u64_data(&sections);
    group
        .create_dataset("afferent_section_pos")
        .with_f64_data(&[0.5; 24]);
    population.add_group(group.finish());
    edges.add_group(population.finish());
    file.add_group(edges.finish());
    let bytes = file.finish().expect("bytes");
    std::fs::write(work.path("c/edges.h5"), bytes).expect("written");
}

#[neurotess_testing::test]
fn synapses_that_only_name_sections_are_shown_too() {
    let work = circuit();
    write_sections(&work);
    let draw = |options: &str| {
        work.run(&format!(
            "render c -o {options} --size 160x120 --samples 1 --no-legend --json"
        ))
    };
    draw("none.png").exits(0);
    let all = draw("all.png --synapses").exits(0);
    assert_eq!(all.json()["markers"]["all"], 23, "{}", all.stderr());
    let left =
        "1 synapse left out: they name sections that the tracings of their cells do not have";
    assert!(all.stderr().contains(left), "{}", all.stderr());
    let some = draw("some.png --synapses --nodes 3,5").exits(0);
    assert_eq!(some.json()["markers"]["all"], 4);
    let run = draw("x.png --synapses --synapse-side efferent").exits(1);
    assert!(
        run.stderr()
            .contains("or efferent_section_id and efferent_section_pos"),
        "{}",
        run.stderr()
    );
}

#[neurotess_testing::test]
fn shapes_are_points_spheres_and_contacts() {
    let work = circuit();
    let close =
        "--nodes 3 --synapses --marker-size 8 --size 320x240 --samples 1 --no-legend --no-recipe";
    let picture = |shape: &str| {
        work.run(&format!(
            "render c -o {shape}.png --marker-shape {shape} {close} --force"
        ))
        .exits(0);
        work.files(".")[&work.path(&format!("{shape}.png"))].clone()
    };
    let [point, sphere, contact] = ["point", "sphere", "contact"].map(picture);
    assert!(point != sphere && sphere != contact && point != contact);
    work.run(&format!("render c -o usual.png {close}")).exits(0);
    assert!(work.files(".")[&work.path("usual.png")] == sphere);
    work.file("points.csv", POINTS);
    let run = work.run("render c -o x.png --points points.csv --marker-shape contact");
    assert!(run.exits(2).stderr().contains("lie on no membrane"));
}

#[neurotess_testing::test(needs(gpu))]
fn points_of_a_table_are_shown_with_any_input() {
    let work = Work::new();
    work.file("a.swc", SMALL);
    work.file("points.csv", POINTS);
    let options = "--size 160x120 --samples 1 --json";
    for (name, more) in [
        ("plain", ""),
        ("weights", "--marker-color-by weight --marker-size 3"),
        ("explored", "--lod exploration"),
    ] {
        let run = work.run(&format!(
            "render a.swc -o {name}.png --points points.csv {more} {options}"
        ));
        let run = run.exits(0);
        assert_eq!(run.json()["markers"]["drawn"], 3, "{name}");
    }
}

#[neurotess_testing::test]
fn the_window_takes_the_same_options() {
    let work = Work::new();
    let help = work.run("view --help").exits(0).stdout();
    for option in [
        "--synapses",
        "--synapse-side",
        "--points",
        "--marker-color-by",
        "--marker-shape",
        "--marker-size",
    ] {
        assert!(help.contains(option), "{option}: {help}");
    }
    let run = work.run("view --marker-size 2");
    let run = run.exits(2);
    assert!(
        run.stderr().contains("--synapses or --points"),
        "{}",
        run.stderr()
    );
}

#[neurotess_testing::test]
fn what_cannot_be_shown_says_why() {
    let work = circuit();
    work.file("a.swc", SMALL);
    work.file("points.csv", POINTS);
    work.file("broken.csv", "x,y,z\n1,2,3\n1,2,up\n");
    for (options, code, said) in [
        ("a.swc --synapses", 2, "--synapses needs a circuit"),
        ("a.swc --marker-size 2", 2, "--synapses or --points"),
        ("a.swc --points none.csv", 1, "none.csv"),
        ("a.swc --points broken.csv", 1, "broken.csv:3"),
        (
            "a.swc --points points.csv --marker-color-by size",
            1,
            "has no number 'size': it has weight",
        ),
        (
            "c --synapses=gap",
            1,
            "has no edges 'gap': it has cortex__cortex__chemical",
        ),
        (
            "c --synapses --synapse-side efferent",
            1,
            "efferent_surface_x",
        ),
        (
            "c --synapses --marker-color-by size",
            1,
            "it has conductance, delay",
        ),
    ] {
        let run = work.run(&format!("render {options} -o x.png --size 64x48"));
        let run = run.exits(code);
        assert!(run.stderr().contains(said), "{options}: {}", run.stderr());
        assert!(!work.path("x.png").exists(), "{options}");
    }
}
