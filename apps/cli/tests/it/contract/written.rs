//! After each command, the files that it reported exist, are new and whole.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::work::{SMALL, Work};

/// Files that a document names as written.
fn named(document: &Value, files: &mut BTreeSet<String>) {
    let text = |value: &Value| value.as_str().map(str::to_owned);
    match document {
        Value::Object(of) => {
            match (of.get("parts"), of.get("out")) {
                // Instead of the whole, its parts are written.
                (Some(Value::Array(parts)), _) if !parts.is_empty() => {}
                (_, out) => files.extend(out.and_then(text)),
            }
            let list = of.get("files").and_then(Value::as_array);
            files.extend(list.into_iter().flatten().filter_map(text));
            of.values().for_each(|value| named(value, files));
        }
        Value::Array(all) => all.iter().for_each(|value| named(value, files)),
        _ => {}
    }
}

/// Asserts that a file, or each of a folder, can be read to its end.
fn assert_whole(path: &Path) {
    if path.is_dir() {
        let entries: Vec<_> = fs::read_dir(path).expect("there").flatten().collect();
        assert!(!entries.is_empty(), "{}", path.display());
        return entries.iter().for_each(|entry| assert_whole(&entry.path()));
    }
    let bytes = fs::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let text = String::from_utf8_lossy(&bytes);
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    let whole = match &*extension {
        "png" => {
            let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes))
                .read_info()
                .expect("a PNG");
            let mut pixels = vec![0; reader.output_buffer_size().expect("small")];
            reader.next_frame(&mut pixels).is_ok()
        }
        "ply" | "obj" | "stl" | "glb" | "msh" | "vtu" | "off" => {
            neurotess::mesh::read(path).is_ok_and(|mesh| !mesh.faces.triangles.is_empty())
        }
        "swc" | "asc" => neurotess::formats::read(path, &Default::default()).is_ok(),
        "csv" => {
            let rows = text.lines().map(|row| row.split(',').count());
            text.ends_with('\n') && rows.collect::<BTreeSet<_>>().len() == 1
        }
        "json" => serde_json::from_str::<Value>(&text).is_ok(),
        "html" => text.trim_end().ends_with("</html>"),
        "svg" => text.trim_end().ends_with("</svg>"),
        _ => !bytes.is_empty(),
    };
    assert!(whole, "{} is not whole", path.display());
}

/// Runs a command twice, the second time over other content of what the first time has written, and returns how many
/// files it named.
fn written(work: &Work, command: &str, also: &[&str]) -> usize {
    let mut counts = Vec::new();
    for _ in 0..2 {
        let run = work.run(&format!("{command} --force --json")).exits(0);
        let mut files = BTreeSet::new();
        named(&run.json(), &mut files);
        files.extend(also.iter().map(|&file| file.to_owned()));
        assert!(!files.is_empty(), "{command} names no file");
        let paths: Vec<PathBuf> = files.iter().map(|file| work.path(file)).collect();
        for path in &paths {
            assert_whole(path);
        }
        for path in paths.iter().filter(|path| path.is_file()) {
            fs::write(path, "of an earlier run").expect("written");
        }
        counts.push(files.len());
    }
    assert_eq!(counts[0], counts[1], "{command}");
    counts[0]
}

fn work() -> Work {
    let work = Work::new();
    work.file("a.swc", SMALL);
    work.file("b.swc", SMALL);
    let circuit =
        "synth circuit -o c --neurons 6 --morphologies 2 --points 60 --reported 2 --seed 9";
    work.run(circuit).exits(0);
    work
}

#[neurotess_testing::test]
fn files_that_are_reported_are_new_and_whole() {
    let work = work();
    let voltage = "report c --report voltage --time 1:3:1";
    for (command, also, files) in [
        ("mesh a.swc -o m.ply --level 1", &[][..], 1),
        (
            "mesh a.swc b.swc -o all --level 1 --parts --format stl",
            &[],
            6,
        ),
        ("mesh a.swc -o t.msh --level 1 --table t.csv", &["t.csv"], 2),
        ("mesh c -o cells --level 1", &[], 6),
        ("mesh c -o c.glb --level 1", &[], 1),
        ("convert a.swc -o a.asc", &[], 1),
        ("convert a.swc b.swc -o converted", &[], 2),
        ("convert c -o placed", &[], 6),
        ("synth granule -o grown --count 3 --points 60", &[], 3),
        (
            "synth circuit -o c2 --neurons 3 --morphologies 1 --points 60",
            &[],
            1,
        ),
        ("html a.swc b.swc -o page.html", &[], 1),
        ("nodes c --csv nodes.csv", &[], 1),
        (&format!("{voltage} --csv v.csv"), &[], 1),
        (&format!("{voltage} --per node --svg v.svg"), &[], 1),
        ("info a.swc b.swc --table info.csv", &["info.csv"], 1),
    ] {
        assert_eq!(written(&work, command, also), files, "{command}");
    }
}

/// A cell in the colors of a report, whose picture has no empty corner for a legend.
fn crowded(work: &Work) {
    use hdf5_pure::FileBuilder;

    let mut file = FileBuilder::new();
    let mut nodes = file.create_group("nodes");
    let mut population = nodes.create_group("A");
    let ids = [
        ("node_type_id", 100),
        ("node_group_id", 0),
        ("node_group_index", 0),
    ];
    for (name, id) in ids {
        population.create_dataset(name).with_u64_data(&[id]);
    }
    let mut cells = population.create_group("0");
    for axis in ["x", "y", "z"] {
        cells.create_dataset(axis).with_f64_data(&[0.0]);
    }
    population.add_group(cells.finish());
    nodes.add_group(population.finish());
    file.add_group(nodes.finish());
    work.file("d/nodes.h5", file.finish().expect("bytes"));
    let mut file = FileBuilder::new();
    let mut report = file.create_group("report");
    let mut population = report.create_group("A");
    let values: Vec<f32> = (0_u8..8).map(f32::from).collect();
    let data = population.create_dataset("data").with_f32_data(&values);
    data.with_shape(&[2, 4]);
    let mut mapping = population.create_group("mapping");
    mapping
        .create_dataset("element_ids")
        .with_u64_data(&[0, 1, 2, 3]);
    mapping
        .create_dataset("index_pointers")
        .with_u64_data(&[0, 4]);
    mapping.create_dataset("node_ids").with_u64_data(&[0]);
    mapping
        .create_dataset("time")
        .with_f64_data(&[0.0, 2.0, 1.0]);
    population.add_group(mapping.finish());
    report.add_group(population.finish());
    file.add_group(report.finish());
    work.file("d/v.h5", file.finish().expect("bytes"));
    let forks =
        "1 1 0 0 0 5 -1\n2 3 6 0 0 1 1\n3 3 20 0 0 1 2\n4 3 40 20 0 1 3\n5 3 40 -20 0 1 3\n";
    work.file("d/cell.swc", forks);
    work.file("d/types.csv", "node_type_id morphology\n100 cell.swc\n");
    let config = r#"{"components": {"morphologies_dir": "."}, "networks": {"nodes": [
        {"nodes_file": "nodes.h5", "node_types_file": "types.csv"}]}}"#;
    work.file("d/circuit_config.json", config);
}

/// A legend that covers cells makes the camera give way, of each picture.
#[neurotess_testing::test]
fn pictures_that_are_reported_are_new_and_whole() {
    let work = work();
    crowded(&work);
    let film = "--report c/reports/voltage.h5 --time 1:2.5:0.5";
    let all = [
        (
            "render d -o d.png --size 320x240 --report d/v.h5 --time 0:0.3:0.1 --stats d.json",
            4,
        ),
        ("render a.swc -o a.png --size 160x120 --stats d.json", 2),
        (
            "render a.swc -o turn.png --size 160x120 --turntable --frames 3",
            3,
        ),
        (
            &format!("render c -o plain.png --size 160x120 --no-legend {film}"),
            3,
        ),
    ];
    // In the quick lane the first: each is two starts of the command.
    for (command, files) in all.into_iter().take(neurotess_testing::cases(1, 4)) {
        let also: &[&str] = if command.contains("--stats") {
            &["d.json"]
        } else {
            &[]
        };
        assert_eq!(written(&work, command, also), files, "{command}");
    }
}
