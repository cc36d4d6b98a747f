//! Where a branch bends back into itself, `--simulation` leaves no handles, and merging cuts nothing off.

use neurotess_testing::shared_data;
use serde_json::Value;

use super::neurotess;

#[neurotess_testing::test(needs(neurotess_testing::full, neurotess_testing::shared))]
fn meshes_of_real_cells_have_no_handles() {
    let allen = "sonata/allen/shared_components/morphologies/Scnn1a_473845048_m.swc";
    // With these options merging makes handles in one of the two Neurons, unless small holes are filled.
    let loops = "--radii traced --max-aspect 1";
    let mut filled = 0;
    for (cell, options) in [
        ("swc/Neuron.swc", loops),
        ("h5/Neuron.h5", loops),
        (allen, "--radii equal-area"),
    ] {
        let folder = tempfile::tempdir().expect("a folder");
        let run = |arguments: &str| -> Value {
            let json = neurotess(folder.path(), arguments).expect("it runs");
            serde_json::from_str::<Value>(&json).expect("JSON")[0].clone()
        };
        let path = shared_data().join(cell).display().to_string();
        let mesh = run(&format!(
            "mesh {path} -o cell.ply --simulation {options} --json"
        ));
        let check = run("check cell.ply --json");
        assert_eq!(
            (&check["genus"], &check["components"]),
            (&0.into(), &1.into())
        );
        assert_eq!(check["self_intersections"], 0);
        let crossings = &mesh["crossings"];
        assert_eq!(crossings["handles_made"], 0);
        let warnings = mesh["warnings"].as_array().expect("a list");
        let told = |code: &str| warnings.iter().find(|warning| warning["code"] == code);
        assert!(told("handles").is_none());
        let holes = crossings["filled"].as_array().expect("a list");
        if options != loops {
            continue;
        }
        filled += holes.len();
        let counted =
            told("holes_filled").map_or(0, |warning| warning["count"].as_u64().expect("a count"));
        assert_eq!(counted, holes.len() as u64, "{path}");
        for hole in holes {
            let number = |key: &str| hole[key].as_f64().expect("a number");
            // Less than the branches there. The largest, 0.4 µm, is beside a soma of 0.06 µm whose neurites are thicker than it
            // is; it was 0.3 µm before somata were drawn out.
            assert!((0.0..0.5).contains(&number("girth")), "{hole}");
            // The same hole, 1.5·10⁻³ µm³, is two millionths of that cell.
            assert!(number("volume").abs() < 2e-3, "{hole}");
        }
    }
    assert!(filled > 0, "no cell needs what is tested here");
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
