//! What is no file, what is no folder of cells, names that give orders to a terminal.

use crate::work::{Run, SMALL, Work};

#[cfg(unix)]
#[neurotess_testing::test]
fn devices_and_pipes_are_refused_at_once() {
    use std::os::unix::fs::symlink;
    let work = Work::new();
    work.file("cells/a.swc", SMALL);
    symlink("/dev/zero", work.path("cells/zero.swc")).expect("linked");
    let made = std::process::Command::new("mkfifo")
        .arg(work.path("cells/pipe.swc"))
        .status();
    assert!(made.expect("mkfifo runs").success());
    symlink("/dev/zero", work.path("zero.ply")).expect("linked");
    symlink("/dev/zero", work.path("zero.json")).expect("linked");
    for attack in [
        "info /dev/zero",
        "info zero.json",
        "check zero.ply",
        "mesh cells/zero.swc -o x.ply",
        "convert cells/pipe.swc -o x.swc",
    ] {
        let run = work.run(attack).exits(1);
        assert_eq!(run.errors().len(), 1, "{attack}: {}", run.stderr());
        assert!(
            run.stderr().contains("not a regular file"),
            "{}",
            run.stderr()
        );
    }
    let run = work.run("info cells --json").exits(1);
    assert_eq!(run.errors().len(), 2, "{}", run.stderr());
    assert_eq!(run.json()[0]["n_points"], 6);
}

#[cfg(unix)]
#[neurotess_testing::test]
fn force_replaces_files_and_nothing_else() {
    use std::os::unix::fs::symlink;
    let work = Work::new();
    work.file("cell.swc", SMALL);
    work.file("real.ply", "old");
    symlink("real.ply", work.path("link.ply")).expect("linked");
    symlink("/dev/null", work.path("null.ply")).expect("linked");
    work.run("mesh cell.swc -o link.ply --level 1").exits(1);
    work.run("mesh cell.swc -o link.ply --level 1 --force")
        .exits(0);
    assert!(work.path("link.ply").is_symlink());
    let real = std::fs::read(work.path("real.ply")).expect("there");
    assert!(real.starts_with(b"ply\n"));
    let run = work.run("mesh cell.swc -o null.ply --force").exits(1);
    assert!(
        run.stderr().contains("a device or a pipe, not a file"),
        "{}",
        run.stderr()
    );
    assert!(work.path("null.ply").is_symlink());
}

#[neurotess_testing::test]
fn other_hdf5_files_of_a_folder_are_skipped_and_counted() {
    let work = Work::new();
    work.run("synth circuit -o circuit --neurons 5 --morphologies 2")
        .exits(0);
    std::fs::create_dir(work.path("cells")).expect("made");
    for (name, from) in [("nodes", "nodes.h5"), ("edges", "reports/voltage.h5")] {
        let to = work.path("cells").join(format!("{name}.h5"));
        std::fs::copy(work.path("circuit").join(from), to).expect("copied");
    }
    work.file("cells/a.swc", SMALL);
    let run = work.run("info cells --json").exits(0);
    assert_eq!(run.json().as_array().map(Vec::len), Some(1));
    assert!(
        run.stderr().contains("2 HDF5 files without a morphology"),
        "{}",
        run.stderr()
    );
    // Named itself, such a file is a failure.
    work.run("info cells/nodes.h5").exits(1);
}

#[cfg(unix)]
#[neurotess_testing::test]
fn names_give_no_orders_to_a_terminal() {
    let work = Work::new();
    work.file("\x1b[31mred\x1b[0m.swc", SMALL);
    for run in [work.run("info ."), work.run("mesh . -o out --level 1")] {
        let said = run.exits(0);
        assert!(!said.stdout().contains('\x1b') && !said.stderr().contains('\x1b'));
        assert!(said.stdout().contains("[31mred"), "{}", said.stdout());
    }
}

#[neurotess_testing::test]
fn a_missing_input_is_reported_before_its_output() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    work.file("out.ply", "old");
    for command in [
        "mesh missing.swc -o out.ply",
        "convert missing.swc -o cell.swc",
    ] {
        let run = work.run(command).exits(1);
        let error = run.errors().concat();
        assert!(error.contains("missing.swc: cannot be read"), "{error}");
        assert!(!error.contains("--force"), "{error}");
    }
}

#[neurotess_testing::test]
fn odd_options_are_refused_or_warned_of() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let run = work.run("mesh cell.swc -o a.ply --level -1").exits(2);
    assert!(
        run.stderr().contains("-1 is not in 0..=64"),
        "{}",
        run.stderr()
    );
    let run = work
        .run("mesh cell.swc -o a.ply --format glb --level 1")
        .exits(0);
    assert!(
        run.stderr().contains("a.ply will hold glb"),
        "{}",
        run.stderr()
    );
    let run = work.run("--threads 20000 info cell.swc").exits(0);
    assert!(run.stderr().contains("--threads 20000"), "{}", run.stderr());
    // Quiet or not, the answer itself is printed.
    assert!(
        work.run("info cell.swc -q")
            .exits(0)
            .stdout()
            .contains("points")
    );
    assert!(
        work.run("mesh cell.swc -o b.ply -q")
            .exits(0)
            .stdout()
            .is_empty()
    );
}

/// A record and a cache are ours to write, but a link in their place leads elsewhere.
#[cfg(unix)]
#[neurotess_testing::test]
fn files_that_nobody_named_follow_no_links() {
    use std::os::unix::fs::symlink;

    let work = Work::new();
    work.file("cells/a.swc", SMALL);
    for (there, name) in [(true, "precious"), (false, "nothing")] {
        if there {
            work.file(name, "theirs\n");
        }
        let out = format!("out_{name}");
        std::fs::create_dir(work.path(&out)).expect("made");
        symlink(
            work.path(name),
            work.path(&format!("{out}/.neurotess-made")),
        )
        .expect("linked");
        let run = work.run(&format!("mesh cells -o {out} --level 1")).exits(0);
        let told = run.stderr();
        assert!(
            told.contains(".neurotess-made is a link, not a file of neurotess: remove it"),
            "{told}"
        );
        work.run(&format!("mesh cells -o {out} --level 1 --resume"))
            .exits(0);
    }
    assert_eq!(work.text("precious"), "theirs\n");
    assert!(!work.path("nothing").exists());
    // A plain file of somebody else's stays, too.
    work.file("other/.neurotess-made", "notes\n");
    let told = work.run("mesh cells -o other --level 1").exits(0).stderr();
    assert!(told.contains("of another kind"), "{told}");
    assert_eq!(work.text("other/.neurotess-made"), "notes\n");
}

/// A small file that becomes large is refused before it does, unless that is allowed.
#[neurotess_testing::test]
fn what_becomes_far_larger_than_its_file_needs_a_word() {
    use hdf5_pure::FileBuilder;

    let work = Work::new();
    let rows = 1_200_000_usize;
    let mut file = FileBuilder::new();
    let points = file
        .create_dataset("points")
        .with_f32_data(&vec![0.0; 4 * rows]);
    points
        .with_shape(&[rows as u64, 4])
        .with_chunks(&[10_000, 4])
        .with_deflate(6);
    let structure = file.create_dataset("structure").with_i32_data(&[0, 2, -1]);
    structure.with_shape(&[1, 3]);
    let bytes = file.finish().expect("bytes");
    assert!(bytes.len() < 400_000, "{}", bytes.len());
    work.file("zeros.h5", bytes);
    let told = work.run("info zeros.h5").exits(1).stderr();
    assert!(
        told.contains("zeros.h5: dataset 'points' would become 115200"),
        "{told}"
    );
    assert!(told.contains("--allow-large"), "{told}");
    let allowed = work
        .run("info zeros.h5 --allow-large --json")
        .exits(0)
        .json();
    assert!(
        allowed[0]["n_points"]
            .as_u64()
            .is_some_and(|n| n >= 1_199_999),
        "{allowed}"
    );

    // A circuit of equal numbers, and a report in one chunk.
    let mut file = FileBuilder::new();
    let mut nodes = file.create_group("nodes");
    let mut population = nodes.create_group("p");
    let ids = population
        .create_dataset("node_type_id")
        .with_i8_data(&vec![1; 2_000_000]);
    ids.with_chunks(&[100_000]).with_deflate(6);
    nodes.add_group(population.finish());
    file.add_group(nodes.finish());
    work.file("c/nodes.h5", file.finish().expect("bytes"));
    let config = r#"{"networks": {"nodes": [{"nodes_file": "nodes.h5"}]}}"#;
    work.file("c/circuit_config.json", config);
    let told = work.run("info c").exits(1).stderr();
    assert!(
        told.contains("'nodes/p': would become")
            || told.contains("'nodes/p/node_type_id': would become"),
        "{told}"
    );
    let mut file = FileBuilder::new();
    let frames = 14_000_000_u64;
    let data = file
        .create_dataset("data")
        .with_f64_data(&vec![0.0; frames as usize]);
    data.with_shape(&[frames, 1])
        .with_chunks(&[frames, 1])
        .with_deflate(6);
    let mut mapping = file.create_group("mapping");
    mapping.create_dataset("node_ids").with_u64_data(&[0]);
    mapping
        .create_dataset("index_pointers")
        .with_u64_data(&[0, 1]);
    mapping.create_dataset("element_ids").with_u64_data(&[0]);
    mapping
        .create_dataset("time")
        .with_f64_data(&[0.0, frames as f64, 1.0]);
    file.add_group(mapping.finish());
    work.file("one.h5", file.finish().expect("bytes"));
    work.run("synth circuit -o d --neurons 3 --morphologies 1 --points 60")
        .exits(0);
    let told = work
        .run("report d --report one.h5 --csv a.csv")
        .exits(1)
        .stderr();
    assert!(
        told.contains("'data': would become 112000000 bytes of a file of"),
        "{told}"
    );
}

/// Errors name the file and what to do, and no reason twice.
#[cfg(target_os = "linux")]
#[neurotess_testing::test]
fn full_disks_and_missing_files_are_told_once_with_their_name() {
    let work = Work::new();
    work.file("a.swc", SMALL);
    work.run("synth circuit -o c --neurons 3 --morphologies 1 --points 60")
        .exits(0);
    for (command, reason) in [
        ("info gone.h5", "No such file"),
        ("html c -o c.html --report gone.h5", "no such report"),
    ] {
        let missing = work.run(command).exits(1).stderr();
        assert_eq!(missing.matches(reason).count(), 1, "{missing}");
        assert!(missing.contains("gone.h5"), "{missing}");
    }
    // A limit on the size of files stands for a full disk.
    let mut limited = std::process::Command::new("sh");
    let script = "ulimit -f 8; trap '' XFSZ; exec \"$0\" html a.swc -o page.html";
    limited
        .current_dir(work.path(""))
        .args(["-c", script, env!("CARGO_BIN_EXE_neurotess")]);
    let run = Run(limited.output().expect("a shell")).exits(1);
    let told = run.stderr();
    assert!(
        told.contains("page.html cannot be written") && told.contains("check space"),
        "{told}"
    );
    assert_eq!(told.matches("os error").count(), 1, "{told}");
    assert!(!work.path("page.html").exists());
}

/// Where memory ends, a mesh is an error beforehand, with what it would need.
#[cfg(target_os = "linux")]
#[neurotess_testing::test]
fn too_little_memory_is_an_error_with_an_estimate() {
    let work = Work::new();
    let cell = crate::work::sample("pyramidal.swc");
    let mut limited = std::process::Command::new("sh");
    let script = "ulimit -v 3000000; exec \"$0\" mesh \"$1\" -o a.ply --level 64 --crossings merge --threads 1";
    limited
        .current_dir(work.path(""))
        .args(["-c", script, env!("CARGO_BIN_EXE_neurotess"), &cell]);
    let told = Run(limited.output().expect("a shell")).exits(1).stderr();
    assert!(
        told.contains("GB of memory are needed, and") && told.contains("--level"),
        "{told}"
    );
    assert!(!work.path("a.ply").exists());
}
