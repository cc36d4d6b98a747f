//! All shared ASC and H5 files against what MorphIO found.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use neurotess_formats::{ReadOptions, read};
use neurotess_morphology::{Attachment, Measures, Morphology, Point};
use neurotess_testing::{note, shared, shared_data};

use super::table::Table;
use crate::both_formats::{FORMATS, assert_same_neurites, codes};

/// Relative tolerance; the references store `f32`.
const TOLERANCE: f64 = 1e-5;

/// Where we differ on purpose: column and file; why is in the comments.
const DELIBERATE: &[(&str, &str)] = &[
    // An only child of the same type continues its parent's section.
    ("mio_n_sections", "nested_single_children.asc"),
    ("mio_max_branch_order", "nested_single_children.asc"),
    ("mio_area", "nested_single_children.asc"),
    ("mio_volume", "nested_single_children.asc"),
    ("mio_n_sections", "bio_neuron-000.asc"),
    ("mio_n_sections", "bio_neuron-000.h5"),
    // A child that begins elsewhere than its parent ends: the way there is a segment, and a change
    // of type is no fork.
    ("mio_length", "simple-dendritric-spine.h5"),
    ("mio_area", "simple-dendritric-spine.h5"),
    ("mio_volume", "simple-dendritric-spine.h5"),
    ("mio_max_branch_order", "simple-dendritric-spine.h5"),
];

fn frustum(a: Point, b: Point) -> (f64, f64) {
    let length = f64::from(a.position.distance(b.position));
    let (r, s) = (f64::from(a.radius), f64::from(b.radius));
    let slant = length.hypot(r - s);
    (
        PI * (r + s) * slant,
        PI * length * (r * r + r * s + s * s) / 3.0,
    )
}

/// Area and volume with MorphIO's copies of forks: in ASC a copy has the child's next radius, and a
/// child that brings its own copy keeps it without a segment between the two.
fn with_copies(m: &Morphology, asc: bool) -> (f64, f64) {
    let mut sum = (0.0, 0.0);
    let mut add = |a, b| {
        let (area, volume) = frustum(a, b);
        sum = (sum.0 + area, sum.1 + volume);
    };
    for section in &m.sections {
        let own = &m.points[section.range()];
        if let Attachment::Section(parent) = section.attachment {
            let mut fork = m.points[m.sections[parent.index()].end as usize - 1];
            if fork.position != own[0].position {
                if asc {
                    fork.radius = own[0].radius;
                }
                add(fork, own[0]);
            }
        }
        own.windows(2).for_each(|w| add(w[0], w[1]));
    }
    sum
}

#[neurotess_testing::test(needs(shared))]
fn measures_are_those_of_morphio() {
    let data = shared_data();
    let table = Table::read(&data.join("reference.tsv"));
    let (mut files, mut compared, mut wrong) = (0, 0, Vec::new());
    let mut used = vec![false; DELIBERATE.len()];
    let outlined = |file: &str| {
        (file.ends_with(".asc") || file.ends_with(".h5")) && !file.starts_with("malformed/")
    };
    for row in table.rows(outlined) {
        let file = row("file");
        if row("mio_status") != "ok" {
            continue;
        }
        let read = read(data.join(file), &ReadOptions::default()).expect(file);
        let m = Measures::of(&read.morphology);
        let (area, volume) = with_copies(&read.morphology, read.format == "asc");
        let short = file.rsplit('/').next().expect("a name");
        files += 1;
        let ours = BTreeMap::from([
            ("mio_length", m.length),
            ("mio_area", area),
            ("mio_volume", volume),
            ("mio_n_sections", m.n_sections as f64),
            ("mio_n_root_sections", m.n_neurites as f64),
            ("mio_n_bifurcations", m.n_bifurcations as f64),
            ("mio_n_multifurcations", m.n_multifurcations as f64),
            ("mio_max_branch_order", f64::from(m.max_branch_order)),
        ]);
        for (column, ours) in ours {
            let theirs: f64 = row(column).parse().expect("a number");
            compared += 1;
            if (ours - theirs).abs() <= TOLERANCE * theirs.abs() {
                continue;
            }
            match DELIBERATE.iter().position(|d| *d == (column, short)) {
                Some(known) => used[known] = true,
                None => wrong.push(format!("{file}: {column}: {ours} is not {theirs}")),
            }
        }
        let by_type = row("mio_section_types");
        let mut types = BTreeMap::new();
        for section in &read.morphology.sections {
            *types.entry(section.kind.0).or_insert(0) += 1;
        }
        let types: Vec<String> = types.iter().map(|(k, n)| format!("{k}:{n}")).collect();
        compared += 1;
        let merged = DELIBERATE.contains(&("mio_n_sections", short));
        if types.join(";") != by_type && !merged {
            wrong.push(format!("{file}: types {types:?} are not {by_type}"));
        }
    }
    note!("{files} files, {compared} values");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(files > 20, "only {files} files");
    assert!(!used.contains(&false), "listed without need");
}

#[neurotess_testing::test(needs(shared))]
fn files_of_others_come_back() {
    let data = shared_data();
    let mut files = 0;
    for folder in ["asc", "h5"] {
        let entries = std::fs::read_dir(data.join(folder)).expect("the folder");
        for entry in entries.filter_map(Result::ok) {
            let Ok(cell) = read(entry.path(), &ReadOptions::default()) else {
                assert_eq!(entry.file_name(), "merged.h5", "refused as a container");
                continue;
            };
            let cell = cell.morphology;
            for (write, back) in FORMATS {
                let mut bytes = Vec::new();
                let losses = write(&cell, &mut bytes);
                let again = back(&bytes);
                if !codes(&losses).contains(&"types_changed") {
                    assert_same_neurites(&cell, &again);
                }
                assert_eq!(cell.somata.len(), again.somata.len());
                for (a, b) in cell.somata.iter().zip(&again.somata) {
                    let scale = a.radius + a.center.abs().max_element();
                    assert!((a.radius - b.radius).abs() <= 1e-5 * scale);
                    assert!(a.center.distance(b.center) <= 1e-5 * scale);
                }
                files += 1;
            }
        }
    }
    assert!(files > 40, "only {files}");
}

#[neurotess_testing::test(needs(shared))]
fn broken_files_are_refused_with_their_place() {
    let data = shared_data();
    let said = |name: &str| match read(data.join("malformed").join(name), &ReadOptions::default()) {
        Ok(_) => "read".to_owned(),
        Err(e) => e
            .to_string()
            .split_once(name)
            .expect("the name")
            .1
            .to_owned(),
    };
    for (name, expected) in [
        ("broken-spine.asc", ":14: a spine (<) is not closed"),
        (
            "invalid-incomplete.asc",
            ":15: a branch goes on after the word that ends it",
        ),
        ("unbalanced.asc", ":2: a bracket is not closed"),
        (
            "empty.h5",
            ": the file has no datasets 'points' and 'structure'",
        ),
        ("incorrect_point_columns.h5", ": dataset 'points' has shape"),
        ("monodim.h5", ": dataset 'points' has shape"),
        (
            "simple-negative-section-type.h5",
            ": dataset 'structure', row 6: the type",
        ),
        (
            "reversed_NRN_neurite_order.h5",
            ": dataset 'structure', row 3: the first point",
        ),
        ("truncated.h5", ": "),
        ("not_hdf5.h5", ": the file cannot be read as HDF5"),
    ] {
        let said = said(name);
        assert!(said.starts_with(expected), "{name}{said}");
        assert!(said.contains(": "), "what to do: {said}");
    }
    // Read, with a warning.
    for name in ["simple2.asc", "soma_after_dendrite.h5"] {
        assert_eq!(said(name), "read", "{name}");
    }
}
