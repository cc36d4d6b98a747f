//! What becomes of the cells of a run: done, failed, stopped.

use std::fs;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

use neurotess_batch::{Batch, BatchError, CellError, CellFault, Event, Outcome, Shard, Tables};
use neurotess_mesh::Format;
use neurotess_recipe::{FileOptions, MeshOptions, Stage};

use crate::{Folders, stem};

#[neurotess_testing::test]
fn one_bad_file_among_ten_is_named_and_the_others_are_made() {
    let folders = Folders::with(10);
    folders.write("in/4.swc", "1 1 0 0 0 5 -1\n2 2 0 nine 0 1 1\n");
    let report = folders.batch().run(|_| {}).expect("run");
    assert_eq!((report.done().count(), report.kept()), (9, 0));
    assert!(!report.is_complete());
    let failed: Vec<_> = report.failed().collect();
    assert_eq!(failed.len(), 1);
    assert!(matches!(failed[0].fault(), CellFault::Input(_)));
    let told = failed[0].to_string();
    assert!(told.contains("4.swc:2: "), "{told}");
    // In the order of the inputs, and nothing half-written.
    assert!(matches!(report.outcomes[4], Outcome::Failed(_)));
    let made = folders.made();
    assert_eq!(made.len(), 10, "{made:?}");
    assert!(!made.iter().any(|name| name.contains("4.ply")), "{made:?}");
    assert!(!made.iter().any(|name| name.contains("part")), "{made:?}");
}

#[neurotess_testing::test]
fn a_batch_that_is_stopped_leaves_whole_files_only() {
    let folders = Folders::with(6);
    let stopped = Arc::new(AtomicBool::new(false));
    let written = Mutex::new(Vec::new());
    let batch = folders.batch().workers(1).stopped_by(Arc::clone(&stopped));
    let report = batch.run(|event| match event {
        Event::Written(cell) => written.lock().expect("kept").push(stem(&cell.file)),
        // In the middle of the third: the longest come first.
        Event::Progress(job, progress)
            if stem(&job.input) == "3" && progress.stage == Stage::Mesh =>
        {
            stopped.store(true, Ordering::Relaxed);
        }
        _ => {}
    });
    let report = report.expect("run");
    assert_eq!(*written.lock().expect("kept"), ["5", "4"]);
    assert_eq!(report.done().count(), 2);
    assert!(report.failed().count() == 4 && report.failed().all(CellError::is_stopped));
    assert_eq!(folders.made(), [".neurotess-made", "4.ply", "5.ply"]);
}

#[neurotess_testing::test]
fn shards_part_the_inputs() {
    let folders = Folders::with(7);
    let mut made = 0;
    for number in 1..=3 {
        let shard = Shard::new(number, 3).expect("a part");
        let report = folders.batch().shard(shard).run(|_| {}).expect("run");
        assert!(report.is_complete());
        made += report.done().count();
    }
    assert_eq!((made, folders.made().len()), (7, 8));
    assert!(Shard::new(4, 3).is_err() && Shard::new(0, 3).is_err());
}

#[neurotess_testing::test]
fn all_that_happens_is_told() {
    let folders = Folders::with(3);
    let told = Mutex::new(Vec::new());
    let report = folders.batch().measures(true).run(|event| {
        let mut told = told.lock().expect("kept");
        match event {
            Event::Planned(plan) => told.push(format!("planned {}", plan.to_do())),
            Event::Written(_) => told.push("written".into()),
            Event::Ended(Outcome::Done(_)) => told.push("ended".into()),
            Event::Progress(_, progress) => {
                // How far it is, is known.
                assert!(
                    progress.all > 0 && progress.done <= progress.all,
                    "{progress:?}"
                );
            }
            _ => {}
        }
    });
    let report = report.expect("run");
    let told = told.into_inner().expect("kept");
    let number = |word: &str| told.iter().filter(|text| **text == word).count();
    assert_eq!(told[0], "planned 3");
    assert_eq!((number("written"), number("ended")), (3, 3));
    assert!(
        report
            .done()
            .all(|cell| cell.closed && cell.volume > Some(0.0))
    );
}

#[neurotess_testing::test]
fn wrong_batches_are_refused_before_anything_is_done() {
    let folders = Folders::with(2);
    let nowhere = Batch::new([folders.path("in")]).run(|_| {});
    assert!(matches!(nowhere, Err(BatchError::NoFolder)));
    let quads = MeshOptions::default().with_quads(true);
    let files = FileOptions::new(Format::Stl);
    let quads = folders.batch().options(quads).files(files).run(|_| {});
    assert!(matches!(quads, Err(BatchError::Options(_))));
    fs::create_dir(folders.path("in/sub")).expect("made");
    folders.write("in/0.eswc", "");
    let collide = folders.batch().run(|_| {});
    assert!(matches!(collide, Err(BatchError::Target(_))));
    assert!(folders.made().is_empty());
    // Files that are there are in the way, unless they may be replaced.
    fs::remove_file(folders.path("in/0.eswc")).expect("removed");
    assert!(folders.batch().run(|_| {}).expect("run").is_complete());
    let again = folders.batch().run(|_| {}).expect("run");
    assert!(
        again
            .failed()
            .all(|e| matches!(e.fault(), CellFault::Output(_)))
    );
    assert_eq!(again.failed().count(), 2);
    let existing = neurotess_output::Existing::Replace;
    let replaced = folders.batch().existing(existing).run(|_| {}).expect("run");
    assert!(replaced.is_complete());
}

#[neurotess_testing::test]
fn a_file_that_is_not_found_is_told_of() {
    let folders = Folders::with(1);
    let batch = Batch::new([folders.path("in"), folders.path("none/*.swc")]);
    let report = batch.into(folders.path("out")).run(|_| {}).expect("run");
    assert!(report.done().count() == 1 && report.not_found.len() == 1);
    assert!(!report.is_complete());
}

#[neurotess_testing::test]
fn one_cell_has_tables_beside_it() {
    let folders = Folders::with(1);
    let tables = Tables {
        triangles: Some(folders.path("triangles.csv")),
        sections: Some(folders.path("sections.csv")),
    };
    let batch = Batch::new([folders.path("in/0.swc")]).tables(tables);
    let batch = batch.into_file_or_folder(folders.path("cell.ply"));
    let report = batch.run(|_| {}).expect("run");
    assert!(folders.path("cell.ply").is_file());
    let rows = |name: &str| {
        let text = fs::read_to_string(folders.path(name)).expect("there");
        text.lines().count() - 1
    };
    let triangles = report.done().map(|cell| cell.triangles).sum::<usize>();
    assert_eq!(
        (rows("triangles.csv"), rows("sections.csv")),
        (triangles, 2)
    );
}
