//! `neurotess neuroglancer`: what the command says, and what becomes of folders that are there. What is in them is tested in
//! `crates/precomputed`, and by other people's programs in `tests/python/test_neuroglancer.py`.

#[cfg(unix)]
use std::{
    collections::BTreeMap,
    path::PathBuf,
    process::{Command, Stdio},
    time::{Duration, Instant},
};

use crate::work::{BROKEN, SMALL, Work};

#[neurotess_testing::test]
fn cells_become_a_folder_and_a_link() {
    let work = Work::new();
    work.file("in/a.swc", SMALL);
    work.file("in/720575940623456789.swc", SMALL);
    let run = work
        .run("neuroglancer in -o out --url gs://bucket/out")
        .exits(0);
    let link = run.stdout();
    assert!(link.starts_with("https://neuroglancer-demo.appspot.com/#!%7B"));
    assert!(link.contains("precomputed%3A%2F%2Fgs%3A%2F%2Fbucket%2Fout%2Fmesh"));
    assert!(run.stderr().contains("2 cells → out: "), "{}", run.stderr());
    // Numbered, since not all names are numbers.
    assert!(work.path("out/mesh/2.index").is_file());
    work.run("neuroglancer in/720575940623456789.swc -o em")
        .exits(0);
    assert!(work.path("em/skeletons/720575940623456789").is_file());
    let view = work.text("em/view.json");
    assert!(view.contains("\"720575940623456789\""));
    assert!(view.contains("precomputed://http://127.0.0.1:9000/mesh"));
}

#[neurotess_testing::test]
fn what_is_there_is_finished_or_replaced_on_request() {
    let work = Work::new();
    work.file("a.swc", SMALL);
    work.run("neuroglancer a.swc -o out").exits(0);
    let told = work.run("neuroglancer a.swc -o out").exits(1).stderr();
    assert!(
        told.contains("--resume") && told.contains("--force"),
        "{told}"
    );
    let run = work
        .run("neuroglancer a.swc -o out --resume --json")
        .exits(0);
    assert_eq!(
        (&run.json()["written"], &run.json()["kept"]),
        (&0.into(), &1.into())
    );
    let other = work
        .run("neuroglancer a.swc -o out --resume --lods 2")
        .exits(1);
    assert!(
        other.stderr().contains("other options"),
        "{}",
        other.stderr()
    );
    work.run("neuroglancer a.swc -o out --force --lods 2")
        .exits(0);
}

#[neurotess_testing::test]
fn a_cell_that_fails_is_told_of_and_the_others_are_written() {
    let work = Work::new();
    work.file("in/a.swc", SMALL);
    work.file("in/b.swc", BROKEN);
    let run = work.run("neuroglancer in -o out --json").exits(1);
    assert_eq!(run.json()["written"], 1);
    assert_eq!(run.json()["failed"].as_array().map(Vec::len), Some(1));
    assert!(run.stderr().contains("b.swc:2:"), "{}", run.stderr());
}

/// Nothing becomes of what is there when there is nothing to put in its place.
#[neurotess_testing::test]
fn folders_are_left_alone_without_a_readable_input() {
    let work = Work::new();
    work.file("in/1.swc", SMALL);
    work.file("bad/b.swc", BROKEN);
    work.run("neuroglancer in -o out").exits(0);
    let before = work.names("out/mesh");
    let told = work.run("neuroglancer bad -o out --force").exits(1);
    assert!(told.stderr().contains("b.swc:2:"), "{}", told.stderr());
    assert_eq!(work.names("out/mesh"), before);
    work.run("neuroglancer in -o out --resume").exits(0);
    work.run("neuroglancer bad -o new").exits(1);
    assert!(!work.path("new").exists());
    // Nor of a folder with other files, or with the inputs.
    work.file("mine/mesh/7", "precious");
    for option in ["", "--force", "--resume"] {
        let run = work.run(&format!("neuroglancer in -o mine {option}"));
        let told = run.exits(1).stderr();
        assert!(told.contains("mine has other files"), "{told}");
    }
    assert_eq!(work.text("mine/mesh/7"), "precious");
    let told = work.run("neuroglancer in -o in --force").exits(1).stderr();
    assert!(
        told.contains("lies in the folder that is written"),
        "{told}"
    );
}

#[neurotess_testing::test]
fn addresses_and_ports_are_looked_at_before_the_work() {
    let work = Work::new();
    work.file("1.swc", SMALL);
    for url in ["bucket/cells", "ftp://host/cells", "https://"] {
        let run = work.run(&format!("neuroglancer 1.swc -o out --url {url}"));
        let told = run.exits(2).stderr();
        assert!(told.contains("it begins with one of https://"), "{told}");
    }
    let taken = std::net::TcpListener::bind("127.0.0.1:0").expect("a port");
    let port = taken.local_addr().expect("its number").port();
    let run = work.run(&format!("neuroglancer 1.swc -o out --serve --port {port}"));
    let told = run.exits(1).stderr();
    assert!(
        told.contains(&format!("port {port} cannot be used")),
        "{told}"
    );
    assert!(!work.path("out").exists());
}

#[neurotess_testing::test]
fn warnings_are_counted_or_told() {
    let work = Work::new();
    work.file("1.swc", SMALL.replace("40 3 0.7 5", "40 3 -1 5"));
    let run = work.run("neuroglancer 1.swc -o out --json").exits(0);
    assert_eq!(
        run.json()["warnings"].as_object().map(serde_json::Map::len),
        Some(1)
    );
    assert!(
        run.stderr().contains("cells concerned: "),
        "{}",
        run.stderr()
    );
    let told = work.run("neuroglancer 1.swc -o out --force -v").exits(0);
    assert!(told.stderr().contains("1.swc:"), "{}", told.stderr());
}

#[neurotess_testing::test]
fn a_circuit_is_sharded_and_has_its_synapses() {
    let work = Work::new();
    work.run("synth circuit -o c --neurons 12 --morphologies 2 --points 60 --synapses 2")
        .exits(0);
    let run = work
        .run("neuroglancer c -o out --sharded --max-error 0.5 --lods 2 --synapses all --json")
        .exits(0);
    let told = run.json();
    assert_eq!(
        (&told["written"], &told["synapses"]),
        (&12.into(), &24.into())
    );
    assert_eq!(work.names("out/mesh"), ["0.shard", "info"]);
    let wrong = work
        .run("neuroglancer c -o no --synapses gap")
        .exits(2)
        .stderr();
    assert!(wrong.contains("cortex__cortex__chemical"), "{wrong}");
    let wrong = work.run("neuroglancer c -o no --color-by foo").exits(2);
    let told = wrong.stderr();
    assert!(
        told.contains("no node has the attribute foo: there are"),
        "{told}"
    );
}

/// Killed in the middle, and finished: the same bytes.
#[cfg(unix)]
#[neurotess_testing::test]
fn a_killed_run_is_finished() {
    let work = Work::new();
    for n in 0..40 {
        work.file(&format!("in/{n}.swc"), SMALL);
    }
    work.run("neuroglancer in -o whole").exits(0);
    let mut child = work
        .command("neuroglancer in -o out --threads 1")
        .spawn()
        .expect("it starts");
    while !work.path("out/skeletons/4").is_file() {
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().expect("killed");
    child.wait().expect("it ended");
    work.run("neuroglancer in -o out --resume").exits(0);
    assert_same(&work, "out");
}

/// The same at ten moments at random, of the time that a whole run takes; every second run is killed twice.
#[cfg(unix)]
#[neurotess_testing::test(needs(neurotess_testing::full))]
fn runs_killed_at_any_moment_are_finished() {
    // Four shards are of 1,100 cells.
    for (cells, more) in [(300, ""), (1100, "--sharded")] {
        let work = Work::new();
        let circuit = format!("synth circuit -o c --neurons {cells} --points 60 --synapses 2");
        work.run(&format!("{circuit} --morphologies 3")).exits(0);
        let to = |out: &str| {
            format!("neuroglancer c -o {out} --max-error 1 --lods 1 --synapses all {more}")
        };
        let begun = Instant::now();
        work.run(&to("whole")).exits(0);
        let takes = begun.elapsed();
        let mut seed = 1;
        for moment in 0..10 {
            let out = format!("out{moment}");
            let resumed = format!("{} --resume", to(&out));
            kill_after(work.command(&to(&out)), takes.mul_f64(random(&mut seed)));
            if moment % 2 == 1 {
                kill_after(work.command(&resumed), takes.mul_f64(random(&mut seed)));
            }
            work.run(&resumed).exits(0);
            assert_same(&work, &out);
        }
    }
}

#[cfg(unix)]
fn kill_after(mut command: Command, time: Duration) {
    let silent = command.stdout(Stdio::null()).stderr(Stdio::null());
    let mut child = silent.spawn().expect("it starts");
    std::thread::sleep(time);
    child.kill().expect("killed, or at its end");
    child.wait().expect("it ended");
}

/// A number from 0 to 1, by Knuth's generator.
#[cfg(unix)]
fn random(seed: &mut u64) -> f64 {
    *seed = seed
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 32) as f64 / f64::from(u32::MAX)
}

/// Asserts that a folder has the files of `whole`, to the byte.
#[cfg(unix)]
fn assert_same(work: &Work, out: &str) {
    let below = |folder: &str| -> BTreeMap<PathBuf, Vec<u8>> {
        let root = work.path(folder);
        let files = work.files(folder).into_iter();
        let below = |path: PathBuf| path.strip_prefix(&root).expect("below").to_path_buf();
        files.map(|(path, bytes)| (below(path), bytes)).collect()
    };
    let (whole, out) = (below("whole"), below(out));
    assert!(whole.keys().eq(out.keys()), "{:?}", out.keys());
    for (name, bytes) in &whole {
        assert!(out[name] == *bytes, "{}", name.display());
    }
}
