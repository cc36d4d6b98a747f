//! Where a branch bends back into itself, `--simulation` leaves no handles, and merging cuts nothing off.

use neurotess_testing::shared_data;
use serde_json::Value;

use super::neurotess;

#[neurotess_testing::test(needs(neurotess_testing::full, neurotess_testing::shared))]
fn meshes_of_real_cells_have_no_handles() {
    let allen = "sonata/allen/shared_components/morphologies/Scnn1a_473845048_m.swc";
    let loops = "--radii traced --max-aspect 1";
    for (cell, options) in [
        ("swc/Neuron.swc", loops),
        ("h5/Neuron.h5", loops),
        (allen, "--radii equal-area"),
    ] {
        let path = shared_data().join(cell).display().to_string();
        let (mesh, check) = meshed(&path, options);
        assert_eq!(
            (&check["genus"], &check["components"]),
            (&0.into(), &1.into())
        );
        assert_eq!(check["self_intersections"], 0);
        assert_eq!(mesh["crossings"]["handles_made"], 0);
        assert_eq!(warning(&mesh, "handles"), None);
        let holes = mesh["crossings"]["filled"].as_array().expect("a list");
        for hole in holes {
            let number = |key: &str| hole[key].as_f64().expect("a number");
            // Less than the branches there: at most 0.4 µm around when somata of 0.06 µm had holes beside them, and a volume
            // of 1.5·10⁻³ µm³.
            assert!((0.0..0.5).contains(&number("girth")), "{hole}");
            assert!(number("volume").abs() < 2e-3, "{hole}");
        }
    }
}

#[neurotess_testing::test]
fn holes_between_branches_that_cross_again_and_again_are_filled_and_told() {
    // A dendrite along x, and one that waves through it; both are 0.4 µm thick and begin at the soma.
    let straight = (0..33).map(|n| [-4.0 + 0.5 * f64::from(n), 0.0, 0.0]);
    let to_it = [[-7.0, 4.0, 0.11], [-5.0, 3.5, 0.11], [-3.0, 2.5, 0.11]];
    let wave = (0..=60).map(|n| {
        let along = 13.0 * f64::from(n) / 60.0;
        [along - 2.0, (1.5 * along).cos(), 0.11]
    });
    let mut cell = "1 1 -8 0 0 2 -1\n".to_owned();
    let mut number = 1;
    for branch in [
        straight.collect::<Vec<_>>(),
        to_it.into_iter().chain(wave).collect(),
    ] {
        let mut parent = 1;
        for [x, y, z] in branch {
            number += 1;
            cell += &format!("{number} 3 {x} {y} {z} 0.4 {parent}\n");
            parent = number;
        }
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("waves.swc");
    std::fs::write(&path, cell).expect("written");
    let (mesh, check) = meshed(&path.display().to_string(), "--crossings merge");
    assert_eq!(check["self_intersections"], 0);
    let holes = mesh["crossings"]["filled"].as_array().expect("a list");
    assert!(holes.len() >= 4, "{holes:?}");
    assert_eq!(warning(&mesh, "holes_filled"), Some(holes.len() as u64));
    // Both begin at the soma: that loop is no hole.
    assert_eq!(warning(&mesh, "handles"), Some(1));
    for hole in holes {
        let girth = hole["girth"].as_f64().expect("a number");
        // Holes that are filled are at most two circumferences around.
        assert!(
            (0.0..4.0 * std::f64::consts::PI * 0.4).contains(&girth),
            "{hole}"
        );
    }
}

/// What `mesh --simulation` with these options and `check` tell of a cell.
fn meshed(path: &str, options: &str) -> (Value, Value) {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |arguments: &str| -> Value {
        let json = neurotess(folder.path(), arguments).expect("it runs");
        serde_json::from_str::<Value>(&json).expect("JSON")[0].clone()
    };
    let mesh = run(&format!(
        "mesh {path} -o cell.ply --simulation {options} --json"
    ));
    (mesh, run("check cell.ply --json"))
}

/// The count of a warning, if it is there.
fn warning(mesh: &Value, code: &str) -> Option<u64> {
    let warnings = mesh["warnings"].as_array().expect("a list");
    let told = warnings.iter().find(|warning| warning["code"] == code)?;
    told["count"].as_u64()
}

#[neurotess_testing::test(needs(neurotess_testing::shared))]
fn merging_cuts_nothing_off_where_a_neurite_turns_back() {
    // Level, and whether pieces are joined again. Of the second cell some were, until bends had creases; of the first, until
    // its soma held what was traced up to its rings.
    let cases = [
        ("h5/Neuron.h5", 1, false),
        ("swc/172993.swc", 1, false),
        ("swc/172993.swc", 2, false),
    ];
    for (path, level, joins) in cases {
        let path = shared_data().join(path).display().to_string();
        let folder = tempfile::tempdir().expect("a folder");
        let run = |arguments: &str| -> Value {
            let json = neurotess(folder.path(), arguments).expect("it runs");
            serde_json::from_str::<Value>(&json).expect("JSON")[0].clone()
        };
        let options = format!("--crossings merge --level {level} --json");
        let mesh = run(&format!("mesh {path} -o cell.ply {options}"));
        let check = run("check cell.ply --json");
        assert_eq!(check["components"], 1);
        assert_eq!(check["self_intersections"], 0);
        let joined = mesh["crossings"]["joined"].as_array().expect("a list");
        assert_eq!(!joined.is_empty(), joins, "{path} at level {level}");
        let warnings = mesh["warnings"].as_array().expect("a list");
        let told = |code: &str| warnings.iter().find(|warning| warning["code"] == code);
        let count = told("joined").map_or(0, |warning| warning["count"].as_u64().expect("a count"));
        assert_eq!(count, joined.len() as u64);
        assert!(told("parts_cut_off").is_none());
        for piece in joined {
            let number = |key: &str| piece[key].as_f64().expect("a number");
            assert!(number("gap") > 0.0 && number("gap") < 16.0, "{piece}");
            // A thousandth of the cell at most.
            let cell = mesh["volume"].as_f64().expect("a volume");
            assert!((0.0..1e-3 * cell).contains(&number("volume")), "{piece}");
        }
    }
}

#[neurotess_testing::test(needs(neurotess_testing::full, neurotess_testing::shared))]
fn processes_that_would_close_a_loop_become_thinner() {
    let path = shared_data().join("h5/astrocyte.h5").display().to_string();
    let folder = tempfile::tempdir().expect("a folder");
    let run = |arguments: &str| -> Value {
        let json = neurotess(folder.path(), arguments).expect("it runs");
        serde_json::from_str::<Value>(&json).expect("JSON")[0].clone()
    };
    let thinned = |mesh: &Value| {
        let warnings = mesh["warnings"].as_array().expect("a list");
        let found = warnings.iter().find(|warning| warning["code"] == "thinned");
        found.and_then(|warning| warning["count"].as_u64())
    };
    // Which of these leave a loop at first depends on where vertices happen to lie.
    let options = ["--isotropic 2", "--isotropic 0.7", "--max-aspect 4"];
    let counts = options.map(|options| {
        let mesh = run(&format!(
            "mesh {path} -o cell.ply --simulation {options} --force --json"
        ));
        assert_eq!(mesh["crossings"]["handles_made"], 0, "{options}");
        thinned(&mesh)
    });
    assert!(counts.into_iter().max() > Some(Some(0)), "{counts:?}");
    // What is not for simulators stays as thick as traced.
    let mesh = run(&format!(
        "mesh {path} -o cell.ply --crossings merge --force --json"
    ));
    assert_eq!(thinned(&mesh), None);
}
