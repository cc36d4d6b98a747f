//! Circuits: made, read by others, described.

use std::path::{Path, PathBuf};
use std::process::Command;

use glam::{DMat3, DVec3};
use neurotess::circuit::{Circuit, Report, Selection};
use neurotess_testing::python_with;
use serde_json::Value;

use crate::work::Work;

/// The need of tests that compare with libsonata.
fn libsonata() -> Result<(), String> {
    python_with("libsonata").map(drop)
}

/// The need of tests that compare with bluepysnap.
fn bluepysnap() -> Result<(), String> {
    python_with("bluepysnap").map(drop)
}

/// What another reader finds in a circuit.
fn read_with(reader: &str, folder: &Path) -> Value {
    let python = python_with(reader).expect("the test needs the reader");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python/read_circuit.py");
    let output = Command::new(python)
        .arg(script)
        .arg(folder)
        .arg(reader)
        .output();
    let output = output.expect("Python runs");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    serde_json::from_slice(&output.stdout).expect("JSON")
}

fn made() -> (Work, PathBuf) {
    let work = Work::new();
    work.run("synth circuit -o c --neurons 60 --morphologies 4 --points 100 --reported 5 --seed 9")
        .exits(0);
    let folder = work.path("c");
    (work, folder)
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list");
    list.iter().map(|v| v.as_f64().expect("a number")).collect()
}

#[neurotess_testing::test(needs(neurotess_testing::full, libsonata))]
fn libsonata_reads_the_same_circuit() {
    let (_work, folder) = made();
    let theirs = read_with("libsonata", &folder);
    let circuit = Circuit::open(&folder).expect("a circuit");
    assert!(circuit.failures.is_empty() && circuit.warnings.is_empty());
    let nodes = &circuit.populations[0];
    assert_eq!(theirs["n"], nodes.len());
    let axes = ["x", "y", "z"].map(|axis| numbers(&theirs[axis]));
    for (row, position) in nodes.positions.iter().enumerate() {
        let their_position = DVec3::new(axes[0][row], axes[1][row], axes[2][row]);
        // Not equal: reading JSON rounds.
        assert!(position.distance(their_position) < 1e-9);
        let q = numbers(&theirs["quaternion"][row]);
        let own = nodes.rotations[row];
        let near = |a: f64, b: f64| (a - b).abs() < 1e-6;
        assert!(near(own.w, q[0]) && near(own.x, q[1]) && near(own.z, q[3]));
        let word = |name: &str| nodes.attributes[name].text(row);
        assert_eq!(theirs["layer"][row].as_str(), word("layer"));
        assert_eq!(theirs["morphology"][row].as_str(), word("morphology"));
    }
    assert_eq!(theirs["missing"], Value::Array(vec![]));
    let sets = theirs["sets"].as_object().expect("sets");
    assert_eq!(sets.len(), circuit.node_sets.names().count());
    for (name, ids) in sets {
        let selection = Selection {
            node_set: Some(name.clone()),
            ..Selection::default()
        };
        let selected = circuit.select(&selection).expect("a set");
        let own: Vec<f64> = selected.iter().map(|n| f64::from(n.row)).collect();
        assert_eq!(numbers(ids), own, "{name}");
    }

    let report = Report::open(&circuit.reports["voltage"]).expect("a report");
    let values = &report.populations[0];
    let time = values.time;
    assert_eq!(numbers(&theirs["times"]), [time.start, time.end, time.step]);
    assert_eq!(theirs["units"][0].as_str(), Some(values.units.as_str()));
    let frame = time.frame_at(10.0).expect("a frame");
    let all: Vec<u64> = (0..values.compartment_count()).collect();
    let own = values.values(frame, &all).expect("values");
    let frame = numbers(&theirs["frame"]);
    assert_eq!(frame.len(), own.len());
    let near = |(a, b): (&f64, &f32)| (a - f64::from(*b)).abs() < 1e-6;
    assert!(frame.iter().zip(&own).all(near));
    let sections = (0..values.nodes.len()).flat_map(|n| values.compartments(n).expect("some"));
    let sections: Vec<f64> = sections.map(|c| c.section as f64).collect();
    assert_eq!(numbers(&theirs["sections"]), sections);
    assert!(!theirs["spikes"].as_array().expect("spikes").is_empty());
}

#[neurotess_testing::test(needs(neurotess_testing::full, bluepysnap))]
fn bluepysnap_reads_the_same_circuit() {
    let (_work, folder) = made();
    let theirs = read_with("bluepysnap", &folder);
    let circuit = Circuit::open(&folder).expect("a circuit");
    let nodes = &circuit.populations[0];
    assert_eq!(theirs["n"], nodes.len());
    for (row, rotation) in nodes.rotations.iter().enumerate() {
        let rows = [0, 1, 2].map(|r: usize| numbers(&theirs["rotation"][row][r]));
        let [x, y, z] = rows.map(|r| DVec3::new(r[0], r[1], r[2]));
        let expected = DMat3::from_cols(x, y, z).transpose();
        assert!(DMat3::from_quat(*rotation).abs_diff_eq(expected, 1e-6));
    }
    let selection = Selection {
        node_set: Some("Upper pyramidal".into()),
        ..Selection::default()
    };
    let selected = circuit.select(&selection).expect("a set");
    let own: Vec<f64> = selected.iter().map(|n| f64::from(n.row)).collect();
    assert!(!own.is_empty());
    assert_eq!(numbers(&theirs["upper"]), own);
    assert!(theirs["n_spikes"].as_u64().is_some_and(|n| n > 0));
}

#[neurotess_testing::test]
fn the_seed_decides_every_file() {
    let (work, _) = made();
    for (folder, seed) in [("same", 9), ("other", 10)] {
        work.run(&format!(
            "synth circuit -o {folder} --neurons 60 --morphologies 4 --points 100 --reported 5 --seed {seed}"
        ))
        .exits(0);
    }
    let files = |folder| work.files(folder).into_values().collect::<Vec<_>>();
    assert_eq!(files("c"), files("same"));
    assert_ne!(files("c"), files("other"));
    let again = work.run("synth circuit -o c --neurons 60").exits(1);
    assert!(
        again.errors()[0].contains("--force"),
        "{:?}",
        again.errors()
    );
}

#[neurotess_testing::test]
fn info_tells_populations_bounds_and_reports() {
    let (work, _) = made();
    for input in ["c", "c/circuit_config.json", "c/simulation_config.json"] {
        let json = work.run(&format!("info {input} --json")).exits(0).json();
        let info = &json[0];
        assert_eq!(
            (&info["n_neurons"], &info["n_morphologies"]),
            (&60.into(), &4.into())
        );
        assert_eq!(info["populations"][0]["name"], "cortex");
        assert!(info["bbox"]["max"][1].as_f64() <= Some(2000.0));
        let reports = info["reports"].as_array().expect("reports");
        let voltage = &reports
            .iter()
            .find(|r| r["name"] == "voltage")
            .expect("voltage");
        assert_eq!(
            (&voltage["type"], &voltage["n_nodes"]),
            (&"compartment".into(), &5.into())
        );
        assert_eq!(
            numbers(&serde_json::json!([
                voltage["time"]["start"],
                voltage["time"]["end"]
            ])),
            [0.0, 100.0]
        );
        assert!(reports.iter().any(|r| r["type"] == "spikes"));
    }
    let text = work.run("info c").exits(0).stdout();
    assert!(
        text.contains("60, 60 shown, of 4 morphology files"),
        "{text}"
    );
}

#[neurotess_testing::test]
fn morphologies_and_circuits_are_in_one_list() {
    let (work, _) = made();
    let json = work.run("info c/morphologies c --json").exits(0).json();
    assert_eq!(json.as_array().map(Vec::len), Some(5));
    assert_eq!(json[4]["format"], "sonata");
}

#[neurotess_testing::test]
fn cells_are_meshed_at_their_positions() {
    let (work, folder) = made();
    let json = work
        .run("mesh c -o out --sample 3 --level 1 --json --soma sphere")
        .exits(0)
        .json();
    let cells = json.as_array().expect("cells");
    assert_eq!((cells.len(), work.files("out").len()), (3, 3));
    let circuit = Circuit::open(folder).expect("a circuit");
    for cell in cells {
        assert_eq!(cell["closed"], true);
        let id = cell["node_id"].as_u64().expect("an id") as usize;
        let position = circuit.populations[0].positions[id];
        let out = cell["out"].as_str().expect("a file");
        assert!(out.ends_with(&format!("cortex_{id}.ply")), "{out}");
        let mesh = neurotess::mesh::read(&work.path(out)).expect("a mesh");
        // The soma is around the node's position.
        let soma = mesh.vertices.iter().filter(|v| v.section == 0);
        let (sum, count) = soma.fold((DVec3::ZERO, 0.0), |(sum, count), v| {
            (sum + mesh.origin + v.position.as_dvec3(), count + 1.0)
        });
        assert!(
            (sum / count).distance(position) < 3.0,
            "{} {position}",
            sum / count
        );
    }
    let again = "mesh c -o out --sample 3 --level 1 --json --soma sphere --resume";
    let skipped = work.run(again).exits(0).json();
    assert!(
        skipped
            .as_array()
            .expect("cells")
            .iter()
            .all(|c| c["skipped"] == true)
    );
}

#[neurotess_testing::test]
fn a_circuit_is_one_file_whose_nodes_share_morphologies() {
    let (work, folder) = made();
    let json = work
        .run("mesh c -o c.glb --nodes 3,10-19 --level 1 --soma sphere --json")
        .exits(0)
        .json();
    let scene = &json[0];
    let morphologies = scene["morphologies"].as_u64().expect("a number");
    assert_eq!(
        (scene["cells"].as_u64(), scene["failed"].as_u64()),
        (Some(11), Some(0))
    );
    assert!(morphologies <= 4, "{morphologies}");
    work.run("mesh c -o apart --nodes 3,10-19 --level 1 --soma sphere")
        .exits(0);
    let mesh = neurotess::mesh::read(&work.path("c.glb")).expect("a mesh");
    let report = neurotess::mesh::check(&mesh);
    assert!(report.closed, "{report:?}");
    let mut vertices = 0;
    let mut sum = DVec3::ZERO;
    for id in [3].into_iter().chain(10..20) {
        let one = work.path(&format!("apart/cortex_{id}.ply"));
        let one = neurotess::mesh::read(&one).expect("a mesh");
        vertices += one.vertices.len();
        sum += one
            .vertices
            .iter()
            .map(|v| one.origin + v.position.as_dvec3())
            .sum::<DVec3>();
    }
    assert_eq!(mesh.vertices.len(), vertices);
    let all = mesh
        .vertices
        .iter()
        .map(|v| mesh.origin + v.position.as_dvec3());
    assert!((all.sum::<DVec3>() - sum).length() / (vertices as f64) < 1e-3);
    assert!(folder.exists());
    for (line, said) in [
        ("mesh c -o c.glb --nodes 3", "exists"),
        ("mesh c -o d.glb --resume", "--resume"),
        ("mesh c -o d.glb --format ply", "GLB"),
    ] {
        let run = work.run(line);
        assert_ne!(run.code(), 0, "{line}");
        assert!(run.stderr().contains(said), "{line}: {}", run.stderr());
    }
}

#[neurotess_testing::test]
fn cells_are_selected() {
    let (work, _) = made();
    let ids = |options: &str, out: &str| {
        let json = work.run(&format!("mesh c -o {out} --level 0 --json {options}"));
        let json = json.exits(0).json();
        let cells = json.as_array().expect("cells").iter();
        cells
            .map(|c| c["node_id"].as_u64().expect("an id"))
            .collect::<Vec<_>>()
    };
    assert_eq!(ids("--nodes 3,10-12", "a"), [3, 10, 11, 12]);
    let layer = ids("--node-set L1", "b");
    let depth = ids("--region -1e6,1850,-1e6,1e6,2000,1e6", "c1");
    assert_eq!(layer, depth, "the layer is a slab");
    let unknown = work.run("mesh c -o d --node-set L9").exits(1);
    assert!(unknown.errors()[0].contains("node set 'L9' is not defined"));
    for wrong in [
        "c c/morphologies",
        "c/morphologies --sample 2",
        "c --region 1,2",
    ] {
        work.run(&format!("mesh {wrong} -o e")).exits(2);
    }
}

#[neurotess_testing::test]
fn a_scene_of_files_is_a_circuit() {
    let work = Work::new();
    work.file("cell.swc", crate::work::SMALL);
    work.file(
        "pair.scene.toml",
        "[[cells]]\nfile = \"cell.swc\"\n\n[[cells]]\nfile = \"cell.swc\"\nid = 5\n\
         position = [10000, 0, 0]\nscale = 2\n",
    );
    let json = work
        .run("mesh pair.scene.toml -o out --level 1 --json --format off")
        .exits(0)
        .json();
    let volume = |i: usize| json[i]["volume"].as_f64().expect("a volume");
    assert!((volume(1) / volume(0) - 8.0).abs() < 1e-6);
    let checked = work.run("check out --json").exits(0).json();
    for (i, mesh) in checked.as_array().expect("two").iter().enumerate() {
        assert_eq!(mesh["closed"], true);
        let found = mesh["volume"].as_f64().expect("a volume");
        assert!(
            (found / volume(i) - 1.0).abs() < 1e-3,
            "{found} {}",
            volume(i)
        );
    }
    work.file(
        "bad.scene.toml",
        "[[cells]]\nfile = \"cell.swc\"\nquaternion = [0, 0, 0, 0]\n",
    );
    let errors = work.run("info bad.scene.toml").exits(1).errors();
    assert!(
        errors[0].contains("bad.scene.toml: 'cells[0].quaternion'"),
        "{errors:?}"
    );
}

/// A cell so far away that numbers do not resolve it is no mesh of volume 0, and where STL's 32 bits do not, that is told.
#[neurotess_testing::test]
fn cells_that_rounding_would_lose_are_told() {
    let work = Work::new();
    work.file("a.swc", crate::work::SMALL);
    let table = |x: &str| format!("file,x,y,z\na.swc,{x},0,0\na.swc,0,0,0\n");
    work.file("far.csv", table("1e30"));
    let run = work.run("mesh far.csv -o far --level 1 --json").exits(1);
    let told = run.stderr();
    assert!(
        told.contains("(far_away)") && told.contains("more than the radius of"),
        "{told}"
    );
    assert_eq!(work.names("far").len(), 1, "the other one");
    work.file("near.csv", table("1e6"));
    let codes = |format: &str| {
        let run = work.run(&format!(
            "mesh near.csv -o {format} --format {format} --level 1 --json"
        ));
        let warnings = run.exits(0).json()[0]["warnings"].clone();
        let codes = warnings.as_array().expect("a list").iter();
        codes
            .map(|w| w["code"].as_str().unwrap_or_default().to_owned())
            .collect::<Vec<_>>()
    };
    assert!(codes("stl").contains(&"coordinates_rounded".to_owned()));
    assert!(!codes("ply").contains(&"coordinates_rounded".to_owned()));
}
