//! Caches that are sound, stale, damaged, locked, out of place.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Barrier;

use neurotess_cache::{Cache, CacheWarning, FileError, MIN_POINTS, Summary};
use neurotess_generate::{GenerateOptions, Generated, SomaMethod, generate};
use neurotess_morphology::Morphology;
use neurotess_output::{Existing, Output};
use neurotess_synth::{Kind, Options, grow};

fn cell(seed: u64) -> Morphology {
    grow(&Options {
        seed,
        points: Some(200),
        ..Options::sample(Kind::Star)
    })
}

/// Opens these cells with a cache in these files.
fn open(
    files: &[PathBuf],
    cells: &[Morphology],
    options: &GenerateOptions,
) -> (Vec<Generated>, Summary) {
    let cache = Cache::at(files.to_vec()).with_least_points(0);
    let mesh = |cell| cache.mesh(cell, options, || generate(cell, options));
    let meshes = cells.iter().map(|cell| mesh(cell).expect("meshed").0);
    let meshes = meshes.collect();
    (meshes, cache.finish())
}

/// A cache of some cells in a folder of its own.
struct Known {
    folder: tempfile::TempDir,
    file: PathBuf,
    cells: Vec<Morphology>,
    meshes: Vec<Generated>,
    options: GenerateOptions,
}

impl Known {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("circuit.ntcache");
        let cells: Vec<Morphology> = (1..4).map(cell).collect();
        let options = GenerateOptions::default();
        let (meshes, summary) = open(std::slice::from_ref(&file), &cells, &options);
        assert_eq!((summary.found, summary.computed), (0, 3));
        assert_eq!(summary.written.as_ref(), Some(&file));
        Self {
            folder,
            file,
            cells,
            meshes,
            options,
        }
    }

    /// Opens the cells again: the meshes are the same, whatever has become of the cache.
    fn again(&self) -> Summary {
        let (meshes, summary) = open(std::slice::from_ref(&self.file), &self.cells, &self.options);
        self.same(&meshes);
        assert_eq!(summary.found + summary.computed, self.cells.len());
        summary
    }

    fn same(&self, meshes: &[Generated]) {
        for (mesh, known) in meshes.iter().zip(&self.meshes) {
            assert_eq!(mesh.mesh, known.mesh);
            assert_eq!(mesh.warnings, known.warnings);
        }
    }

    fn names(&self) -> Vec<String> {
        names(self.folder.path())
    }
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder").flatten();
    let mut names: Vec<String> = entries
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[neurotess_testing::test]
fn what_is_found_equals_what_is_generated() {
    let known = Known::new();
    let before = fs::read(&known.file).expect("there");
    let summary = known.again();
    assert_eq!((summary.found, summary.computed), (3, 0));
    assert!(summary.written.is_none() && summary.warnings.is_empty());
    assert_eq!(fs::read(&known.file).expect("there"), before);
    assert_eq!(known.names(), ["circuit.ntcache"]);
    fs::remove_file(&known.file).expect("removed");
    assert_eq!(known.again().computed, 3);
    // The same cells give the same file.
    assert_eq!(fs::read(&known.file).expect("there"), before);
}

#[cfg(feature = "gpu")]
#[neurotess_testing::test]
fn proxies_are_kept_beside_meshes() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("circuit.ntcache");
    let (cell, options) = (cell(1), GenerateOptions::default());
    let proxy = || {
        let cache = Cache::at(vec![file.clone()]).with_least_points(0);
        let (mesh, key) = cache
            .mesh(&cell, &options, || generate(&cell, &options))
            .expect("meshed");
        let proxy = cache.proxy(&key, &mesh.mesh);
        (proxy, mesh, cache.finish())
    };
    let (first, mesh, _) = proxy();
    let length = fs::metadata(&file).expect("there").len();
    let (second, _, summary) = proxy();
    assert!(summary.written.is_none());
    assert_eq!(fs::metadata(&file).expect("there").len(), length);
    let new = neurotess_render::Proxy::new(&mesh.mesh, &[]);
    for proxy in [first, second] {
        assert_eq!(proxy.spheres(), new.spheres());
        assert_eq!((proxy.bytes(), proxy.sphere()), (new.bytes(), new.sphere()));
    }
}

#[neurotess_testing::test]
fn a_changed_tracing_and_other_options_are_not_found_and_the_rest_is_kept() {
    let mut known = Known::new();
    known.cells[1] = cell(9);
    known.meshes[1] = generate(&known.cells[1], &known.options).expect("meshed");
    let summary = known.again();
    assert_eq!((summary.found, summary.computed), (2, 1));
    assert!(summary.warnings.is_empty());
    assert_eq!(known.again().found, 3);
    let sphere = GenerateOptions {
        soma: SomaMethod::Sphere,
        ..GenerateOptions::default()
    };
    let files = [known.file.clone()];
    let (meshes, summary) = open(&files, &known.cells, &sphere);
    assert_eq!((summary.found, summary.computed), (0, 3));
    assert_ne!(meshes[0].mesh, known.meshes[0].mesh);
    // Both are there now, whichever is asked for, and so is the tracing that was replaced.
    assert_eq!(known.again().found, 3);
    assert_eq!(open(&files, &known.cells, &sphere).1.found, 3);
    assert_eq!(open(&files, &[cell(2)], &known.options).1.found, 1);
}

#[neurotess_testing::test]
fn a_file_that_was_cut_off_is_ignored_and_written_anew() {
    let known = Known::new();
    let whole = fs::read(&known.file).expect("there");
    let some = [0, 1, 15, 16, 17, 80, whole.len() / 3, whole.len() - 400];
    let end = (whole.len() - 70..whole.len()).step_by(7);
    for length in some.into_iter().chain(end) {
        fs::write(&known.file, &whole[..length]).expect("written");
        let summary = known.again();
        assert_eq!((summary.found, summary.computed), (0, 3), "{length}");
        assert!(summary.written.is_some());
        let [CacheWarning::Unused { path, why }] = &summary.warnings[..] else {
            panic!("{length}: {:?}", summary.warnings);
        };
        assert_eq!(path, &known.file);
        assert!(matches!(why, FileError::Damaged(_)));
        assert_eq!(fs::read(&known.file).expect("there"), whole);
    }
}

#[neurotess_testing::test]
fn a_changed_byte_costs_no_more_than_time() {
    let known = Known::new();
    let whole = fs::read(&known.file).expect("there");
    for at in (0..whole.len())
        .step_by(whole.len() / 23)
        .chain([whole.len() - 1])
    {
        let mut changed = whole.clone();
        changed[at] ^= 0x10;
        fs::write(&known.file, &changed).expect("written");
        let summary = known.again();
        assert_eq!(summary.warnings.len(), 1, "{at}");
        assert!(summary.computed > 0, "{at}");
        match &summary.warnings[0] {
            // The name of all caches was changed: it may be somebody's own file.
            CacheWarning::Unused {
                why: FileError::Foreign,
                ..
            } => {
                assert!(at < 15 && summary.written.is_none());
                assert_eq!(fs::read(&known.file).expect("there"), changed);
                fs::write(&known.file, &whole).expect("written");
            }
            CacheWarning::Damaged { count, .. } => assert_eq!((*count, summary.found), (1, 2)),
            _ => assert_eq!(summary.found, 0),
        }
        let mended = known.again();
        assert_eq!(mended.found, 3, "{at}");
        assert!(mended.warnings.is_empty());
    }
}

#[neurotess_testing::test]
fn a_file_of_somebody_else_is_left_alone() {
    let known = Known::new();
    fs::write(&known.file, "my notes").expect("written");
    let elsewhere = known.folder.path().join("elsewhere.ntcache");
    let files = [known.file.clone(), elsewhere.clone()];
    let (meshes, summary) = open(&files, &known.cells, &known.options);
    known.same(&meshes);
    assert_eq!(summary.written, Some(elsewhere));
    assert_eq!(summary.warnings.len(), 1);
    assert_eq!(fs::read(&known.file).expect("there"), b"my notes");
}

#[neurotess_testing::test]
fn a_cache_that_another_run_writes_is_read_and_not_waited_for() {
    let known = Known::new();
    let other = Output::create(&known.file, Existing::Replace).expect("begun");
    let summary = known.again();
    assert_eq!((summary.found, summary.taken), (3, None));
    let files = [known.file.clone(), known.folder.path().join("b.ntcache")];
    let (_, summary) = open(&files, &[cell(7)], &known.options);
    assert_eq!(
        (summary.computed, summary.taken),
        (1, Some(known.file.clone()))
    );
    assert!(summary.written.is_none() && summary.warnings.is_empty());
    drop(other);
    let (_, summary) = open(&files, &[cell(7)], &known.options);
    assert_eq!(summary.written, Some(known.file.clone()));
    assert_eq!(known.names(), ["circuit.ntcache"]);
}

#[neurotess_testing::test]
fn of_two_writers_at_once_one_writes_and_both_have_their_meshes() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("circuit.ntcache");
    let (cells, options) = ([cell(1), cell(2)], GenerateOptions::default());
    let expected = generate(&cells[0], &options).expect("meshed");
    let begun = Barrier::new(2);
    let run = || {
        let cache = Cache::at(vec![file.clone()]).with_least_points(0);
        let mesh = |cell| cache.mesh(cell, &options, || generate(cell, &options));
        let meshes = cells.each_ref().map(|cell| mesh(cell).expect("meshed").0);
        // Both have begun to write, or have found that the other has.
        begun.wait();
        assert_eq!(meshes[0].mesh, expected.mesh);
        cache.finish()
    };
    let summaries = std::thread::scope(|scope| {
        let both = [scope.spawn(run), scope.spawn(run)];
        both.map(|thread| thread.join().expect("no panic"))
    });
    let written = summaries.iter().filter(|s| s.written.is_some()).count();
    let taken = summaries.iter().filter(|s| s.taken.is_some()).count();
    assert_eq!((written, taken), (1, 1));
    let (_, summary) = open(&[file], &cells, &options);
    assert_eq!(summary.found, 2);
    assert_eq!(names(folder.path()), ["circuit.ntcache"]);
}

#[neurotess_testing::test]
fn many_threads_share_a_cache() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("circuit.ntcache");
    let cells: Vec<Morphology> = (0..12).map(cell).collect();
    let options = GenerateOptions::default();
    for found in [0, 12] {
        let cache = Cache::at(vec![file.clone()]).with_least_points(0);
        std::thread::scope(|scope| {
            for cells in cells.chunks(3) {
                let (cache, options) = (&cache, &options);
                scope.spawn(move || {
                    for cell in cells {
                        let mesh = cache.mesh(cell, options, || generate(cell, options));
                        let expected = generate(cell, options).expect("meshed");
                        assert_eq!(mesh.expect("meshed").0.mesh, expected.mesh);
                    }
                });
            }
        });
        assert_eq!(cache.finish().found, found);
    }
}

#[neurotess_testing::test]
fn where_the_folder_cannot_be_written_the_next_place_is() {
    let folder = tempfile::tempdir().expect("a folder");
    // A file where the folder should be: nobody can write there, not even root.
    let beside = folder.path().join("file/circuit.ntcache");
    fs::write(folder.path().join("file"), "").expect("written");
    let user = folder.path().join("user/circuits/a.ntcache");
    let (cells, options) = ([cell(1)], GenerateOptions::default());
    let files = [beside.clone(), user.clone()];
    let (_, first) = open(&files, &cells, &options);
    assert_eq!(first.written, Some(user));
    let (_, second) = open(&files, &cells, &options);
    assert_eq!(second.found, 1);
    // With nowhere to write, one is told, and has the meshes all the same.
    let (meshes, summary) = open(&[beside], &cells, &options);
    assert_eq!((meshes.len(), summary.written), (1, None));
    let mut told = summary.warnings.iter();
    assert!(told.any(|w| matches!(w, CacheWarning::NotWritten { .. })));
}

#[neurotess_testing::test]
fn of_a_few_points_no_cache_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("circuit.ntcache");
    let (cell, options) = (cell(1), GenerateOptions::default());
    assert!(cell.points.len() < MIN_POINTS);
    let cache = Cache::at(vec![file.clone()]);
    let mesh = cache.mesh(&cell, &options, || generate(&cell, &options));
    assert!(mesh.is_ok());
    let summary = cache.finish();
    assert_eq!((summary.computed, summary.written), (1, None));
    assert!(names(folder.path()).is_empty());
}

#[neurotess_testing::test]
fn an_opening_that_ends_early_leaves_no_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("circuit.ntcache");
    let (cell, options) = (cell(1), GenerateOptions::default());
    let cache = Cache::at(vec![file]).with_least_points(0);
    let mesh = cache.mesh(&cell, &options, || generate(&cell, &options));
    assert!(mesh.is_ok());
    drop(cache);
    assert!(names(folder.path()).is_empty());
}
