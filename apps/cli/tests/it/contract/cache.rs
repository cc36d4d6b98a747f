//! The cache of a circuit: pictures are the same, whatever has become of it.

use std::fs;

use neurotess::output::{Existing, Output};
use serde_json::Value;

use crate::needs::gpu;
use crate::work::{Run, Work};

/// The cache, beside the circuit's configuration.
const FILE: &str = "circuit/circuit_config.ntcache";

/// A circuit whose tracings have more points than are meshed without a cache, and its picture.
struct Drawn {
    work: Work,
    picture: Vec<u8>,
}

impl Drawn {
    fn new() -> Self {
        let work = Work::new();
        let synth =
            "synth circuit -o circuit --neurons 200 --morphologies 24 --points 5000 --reported 1";
        work.run(synth).exits(0);
        let mut drawn = Self {
            work,
            picture: Vec::new(),
        };
        let run = drawn.draw("--no-cache").exits(0);
        assert!(run.json()["cache"].is_null());
        drawn.picture = fs::read(drawn.work.path("a.png")).expect("a picture");
        drawn
    }

    fn draw(&self, options: &str) -> Run {
        let draw =
            "render circuit -o a.png --force --json --lod exploration --size 160x120 --samples 1";
        self.run(&format!("{draw} {options}"))
    }

    /// Runs it with a folder for caches of its own.
    fn run(&self, arguments: &str) -> Run {
        let mut command = self.work.command(arguments);
        command.env("XDG_CACHE_HOME", self.work.path("user"));
        Run(command.output().expect("it runs"))
    }

    /// Draws the same picture: numbers of meshes that were found and generated, and what was said.
    fn again(&self) -> ([u64; 2], String) {
        let run = self.draw("").exits(0);
        let picture = fs::read(self.work.path("a.png")).expect("a picture");
        assert!(picture == self.picture, "another picture");
        let cache = &run.json()["cache"];
        let number = |value: &Value| value.as_u64().expect("a number");
        (
            [number(&cache["found"]), number(&cache["generated"])],
            run.stderr(),
        )
    }
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn pictures_are_the_same_with_a_cache_that_is_sound_cut_off_stale_or_locked() {
    let drawn = Drawn::new();
    let file = drawn.work.path(FILE);
    assert!(!file.exists(), "--no-cache writes nothing");

    let ([found, all], _) = drawn.again();
    assert!(found == 0 && all > 20);
    let whole = fs::read(&file).expect("a cache");
    let (counts, said) = drawn.again();
    assert_eq!(counts, [all, 0]);
    assert!(!said.contains("warning: circuit"), "{said}");
    // Refined meshes come from it, too.
    let refined = "render circuit -o b.png --force --size 96x72 --samples 1 --sample 3";
    drawn.run(&format!("{refined} --no-cache")).exits(0);
    let without = fs::read(drawn.work.path("b.png")).expect("a picture");
    drawn.run(refined).exits(0);
    assert!(fs::read(drawn.work.path("b.png")).expect("a picture") == without);
    assert_eq!(fs::read(&file).expect("a cache"), whole);

    // Cut off.
    fs::write(&file, &whole[..whole.len() / 2]).expect("written");
    let (counts, said) = drawn.again();
    assert_eq!(counts, [0, all]);
    assert!(
        said.contains("circuit_config.ntcache: the cache is not used"),
        "{said}"
    );
    assert_eq!(drawn.again().0, [all, 0]);

    // Stale: a tracing is another one now, and its cells are drawn as they are.
    let folder = drawn.work.path("circuit/morphologies");
    let mut names: Vec<_> = fs::read_dir(folder).expect("there").flatten().collect();
    names.sort_by_key(fs::DirEntry::file_name);
    let [first, second] = [0, 1].map(|i| names[i].path());
    let kept = fs::read(&first).expect("a tracing");
    fs::copy(&second, &first).expect("copied");
    let run = drawn.draw("").exits(0);
    let cached = fs::read(drawn.work.path("a.png")).expect("a picture");
    assert!(run.json()["cache"]["found"].as_u64() > Some(0));
    drawn.draw("--no-cache").exits(0);
    assert!(fs::read(drawn.work.path("a.png")).expect("a picture") == cached);
    assert!(cached != drawn.picture);
    fs::write(&first, kept).expect("written");

    // Locked while it would be written: nothing is waited for, and nothing written.
    fs::remove_file(&file).expect("removed");
    let other = Output::create(&file, Existing::Replace).expect("begun");
    assert_eq!(drawn.again().0, [0, all]);
    assert!(!file.exists());
    drop(other);
    assert!(!drawn.work.path("user/neurotess").exists());
}

// Elsewhere the folder follows from no variable.
#[cfg(target_os = "linux")]
#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn of_a_circuit_that_cannot_be_written_to_the_user_has_the_cache() {
    let drawn = Drawn::new();
    // Not even root writes into this: a folder has the name of the temporary file.
    let part = drawn
        .work
        .path("circuit/.circuit_config.ntcache.neurotess-part");
    fs::create_dir(part).expect("a folder");
    let ([_, all], _) = drawn.again();
    assert!(!drawn.work.path(FILE).exists());
    let folder = drawn.work.path("user/neurotess/circuits");
    assert_eq!(fs::read_dir(folder).expect("there").count(), 1);
    assert_eq!(drawn.again().0, [all, 0]);
}

#[neurotess_testing::test]
fn small_circuits_leave_no_file() {
    let work = Work::new();
    work.run("synth circuit -o circuit --neurons 5 --morphologies 2 --points 100 --reported 1")
        .exits(0);
    work.run("render circuit -o a.png --size 32x24 --samples 1")
        .exits(0);
    assert!(!work.path(FILE).exists());
}
