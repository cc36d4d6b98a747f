//! All shared SWC files against what MorphIO, NeuroM and a plain count over the rows found.

use neurotess_formats::{ReadOptions, read};
use neurotess_morphology::Measures;
use neurotess_testing::{note, shared, shared_data};

use super::table::Table;

/// Relative tolerance; the references store `f32`.
const TOLERANCE: f64 = 1e-5;

/// Where we differ on purpose: column and file; why is in the comments.
const DELIBERATE: [(&str, &str); 13] = [
    // MorphIO repeats branch points in each child, with the parent's radius: the annulus of the
    // zero-length frustum is not counted there.
    ("mio_area", "C210401C.swc"),
    ("mio_area", "C270106C_-_Scale_x1.000_y1.050_z1.000.swc"),
    ("mio_area", "vd130423_idC.swc"),
    ("mio_area", "single_cell_detailed.swc"),
    // An outline with radii 0 is a contour and not cylinders without a surface.
    ("mio_soma_surface", "C210401C.swc"),
    ("mio_soma_center", "C210401C.swc"),
    ("mio_neurom_soma_radius", "C210401C.swc"),
    // The three samples' own radius and not the mean distance of (rounded) positions.
    ("mio_neurom_soma_radius", "IF4_140201.CNG.swc"),
    // A soma that forks is measured along its links; in file order a frustum leads from the end of
    // one branch to the start of the next.
    ("mio_soma_surface", "WT-Contralateral-18.CNG.swc"),
    ("mio_neurom_soma_radius", "WT-Contralateral-18.CNG.swc"),
    // MorphIO drops a free tree of one sample.
    ("mio_n_sections", "disconnected_neurite.swc"),
    ("mio_n_root_sections", "disconnected_neurite.swc"),
    // Re-rooted at the soma: the old root is an end.
    ("raw_tips", "skeleton_rerooted_a.swc"),
];

/// Ours by the reference's columns.
fn columns(m: &Measures) -> Vec<(&'static str, f64)> {
    let mut columns = vec![
        ("raw_length", m.length),
        ("raw_area", m.area),
        ("raw_volume", m.volume),
        ("raw_bifurcations", m.n_bifurcations as f64),
        ("raw_multifurcations", m.n_multifurcations as f64),
        ("raw_tips", m.n_ends as f64),
        ("neurite_starts", m.n_neurites as f64),
        ("mio_length", m.length),
        ("mio_area", m.area),
        ("mio_volume", m.volume),
        ("mio_n_sections", m.n_sections as f64),
        ("mio_n_root_sections", m.n_neurites as f64),
        ("mio_n_bifurcations", m.n_bifurcations as f64),
        ("mio_n_multifurcations", m.n_multifurcations as f64),
        ("mio_max_branch_order", f64::from(m.max_branch_order)),
    ];
    if m.soma.kind != "none" {
        columns.push(("mio_soma_surface", m.soma.area));
        // NeuroM's radius of cylinders is that of their sides; ours counts the faces at the ends, too.
        let radius = match m.soma.kind {
            "cylinders" if m.soma.area > 0.0 => (m.soma.area / 4.0 / std::f64::consts::PI).sqrt(),
            _ => m.soma.radius,
        };
        columns.push(("mio_neurom_soma_radius", radius));
    }
    columns
}

/// Like [`columns`], for columns of three coordinates.
fn vectors(m: &Measures) -> Vec<(&'static str, [f64; 3])> {
    let mut vectors = Vec::new();
    if let Some(bounds) = m.bbox {
        vectors.extend([("raw_bbox_min", bounds.min), ("raw_bbox_max", bounds.max)]);
    }
    vectors.extend(m.soma.center.map(|center| ("mio_soma_center", center)));
    vectors
}

#[neurotess_testing::test(needs(shared))]
fn measures_are_those_of_the_references() {
    let data = shared_data();
    let table = Table::read(&data.join("reference.tsv"));
    let (mut files, mut compared, mut wrong) = (0, 0, Vec::new());
    let mut used = [false; DELIBERATE.len()];
    for row in table.rows(|file| file.ends_with(".swc") && !file.starts_with("malformed/")) {
        let file = row("file");
        let read = read(data.join(file), &ReadOptions::default()).expect(file);
        let measures = Measures::of(&read.morphology);
        let short = file.rsplit('/').next().expect("a name");
        files += 1;
        let samples = |column| row(column).parse::<usize>().expect("a count");
        let outside = samples("n_samples") - samples("n_soma_samples");
        assert_eq!(measures.n_points, outside, "{file}");

        let mut compare = |column, ours: f64, theirs: f64, scale: f64| {
            compared += 1;
            if (ours - theirs).abs() <= TOLERANCE * scale.max(theirs.abs()) {
                return;
            }
            match DELIBERATE
                .iter()
                .position(|d| d.1 == short && d.0 == column)
            {
                Some(known) => used[known] = true,
                None => wrong.push(format!("{file}: {column}: {ours} is not {theirs}")),
            }
        };
        for (column, ours) in columns(&measures) {
            if let Ok(theirs) = row(column).parse() {
                compare(column, ours, theirs, 0.0);
            }
        }
        for (column, ours) in vectors(&measures) {
            let theirs = row(column).split(',').filter_map(|x| x.parse::<f64>().ok());
            for (ours, theirs) in ours.into_iter().zip(theirs) {
                compare(column, ours, theirs, 0.1);
            }
        }
    }
    note!("{files} files, {compared} values");
    assert!(files > 30, "only {files} files");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let idle: Vec<_> = DELIBERATE
        .iter()
        .zip(used)
        .filter(|(_, used)| !used)
        .collect();
    assert!(idle.is_empty(), "no longer different: {idle:?}");
}

#[neurotess_testing::test(needs(shared))]
fn every_valid_file_comes_back_equal_after_writing() {
    let data = shared_data();
    let manifest = Table::read(&data.join("MANIFEST.tsv"));
    for row in manifest.rows(|file| file.ends_with(".swc")) {
        let file = row("file");
        if row("valid") != "yes" {
            continue;
        }
        let first = read(data.join(file), &ReadOptions::default())
            .expect(file)
            .morphology;
        let mut text = Vec::new();
        neurotess_formats::swc::write_numbered(
            &first,
            neurotess_formats::swc::SampleNumbers::Kept,
            &mut text,
        )
        .expect("memory");
        let again = neurotess_formats::swc::read_bytes(&text, file, &ReadOptions::default());
        assert!(first == again.expect(file).morphology, "{file} changes");
    }
}

#[neurotess_testing::test(needs(shared))]
fn malformed_files_give_an_error_or_a_warning_that_says_so() {
    let data = shared_data();
    let expected = [
        ("Neuron_missing_ids.swc", "sample 8 has parent 7"),
        ("bifurcating_soma.swc", "soma_branches"),
        ("binary.swc", "binary"),
        ("commas.swc", "separators"),
        ("cycle.swc", "cycle.swc:2: sample 2 is its own ancestor"),
        ("empty.swc", "empty"),
        ("html_error_page.swc", "web page"),
        // Both stand in the same place.
        ("multiple_soma.swc", "coincident_somata"),
        ("nan_coords.swc", "nan_coords.swc:2: x is nan"),
        ("negative_radius.swc", "line 2: negative radius"),
        ("only_header.swc", "no sample"),
        ("repeated_id.swc", "stands in line 5 already"),
        (
            "self_parent.swc",
            "self_parent.swc:2: sample 2 is its own parent",
        ),
        ("six_columns.swc", "six_columns.swc:2: 6 columns"),
        ("soma_with_neurite_parent.swc", "soma_not_root"),
        ("utf16.swc", "UTF-16"),
        // Neurolucida by its content.
        ("simple.unknown", "soma_of_one_point"),
    ];
    let manifest = Table::read(&data.join("MANIFEST.tsv"));
    let listed = manifest.rows(|file| file.starts_with("malformed/") && file.ends_with(".swc"));
    assert_eq!(
        listed.count() + 1,
        expected.len(),
        "a malformed file is not looked at"
    );
    for (file, says) in expected {
        let path = data.join("malformed").join(file);
        let message = match read(&path, &ReadOptions::default()) {
            Ok(read) => read
                .warnings
                .iter()
                .map(ToString::to_string)
                .collect::<Vec<_>>()
                .join("\n"),
            Err(e) => e.to_string(),
        };
        assert!(
            message.contains(says),
            "{file}: {message:?} does not say {says:?}"
        );
        let strict = read(
            &path,
            &ReadOptions {
                strict: true,
                ..ReadOptions::default()
            },
        );
        assert!(strict.is_err(), "{file} passes strictly");
    }
}
