//! What a later run leaves alone, and several at a time.

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::sync::Mutex;
use std::thread;

use neurotess_batch::{Event, OutputState};
use neurotess_recipe::MeshOptions;

use crate::{Folders, stem, tracing};

#[neurotess_testing::test]
fn what_is_up_to_date_is_left_alone() {
    let folders = Folders::with(4);
    let batch = || folders.batch().resume(true);
    assert_eq!(batch().run(|_| {}).expect("run").done().count(), 4);
    let again = batch().run(|_| {}).expect("run");
    assert_eq!((again.kept(), again.outcomes.len()), (4, 4));
    // What changes nothing in the files changes nothing here.
    let again = batch().workers(1).measures(true).run(|_| {}).expect("run");
    assert_eq!(again.kept(), 4);

    // Another input, a file that is gone, and one more.
    folders.write("in/1.swc", &tracing(9));
    fs::remove_file(folders.path("out/2.ply")).expect("removed");
    folders.write("in/4.swc", &tracing(4));
    let states = Mutex::new(Vec::new());
    let third = batch().run(|event| {
        if let Event::Planned(plan) = event {
            let told = plan.jobs().filter_map(|(_, state)| state);
            states.lock().expect("kept").extend(told);
        }
    });
    let third = third.expect("run");
    let expected = [
        OutputState::Right,
        OutputState::OtherInput,
        OutputState::Missing,
        OutputState::Right,
        OutputState::Missing,
    ];
    assert_eq!(*states.lock().expect("kept"), expected);
    assert_eq!((third.done().count(), third.kept()), (3, 2));

    let other = batch().options(MeshOptions::default().with_level(2));
    assert_eq!(other.run(|_| {}).expect("run").done().count(), 5);
}

#[neurotess_testing::test]
fn runs_that_share_a_folder_make_each_cell_once() {
    let folders = Folders::with(8);
    let run = || {
        let batch = folders.batch().resume(true);
        let report = batch.run(|_| {}).expect("run");
        assert!(report.is_complete() && report.outcomes.len() == 8);
        let made = report.done().map(|cell| stem(&cell.file));
        made.collect::<Vec<_>>()
    };
    let made: Vec<String> = thread::scope(|scope| {
        let runs = [(); 3].map(|()| scope.spawn(run));
        runs.into_iter()
            .flat_map(|run| run.join().expect("ended"))
            .collect()
    });
    let mut times: BTreeMap<String, usize> = BTreeMap::new();
    for cell in made {
        *times.entry(cell).or_default() += 1;
    }
    assert!(
        times.len() == 8 && times.values().all(|&n| n == 1),
        "{times:?}"
    );
    // They are what one run makes.
    folders
        .batch()
        .into(folders.path("alone"))
        .run(|_| {})
        .expect("run");
    for n in 0..8 {
        let bytes = |folder: &str| {
            let file: PathBuf = [folder, &format!("{n}.ply")].iter().collect();
            fs::read(folders.0.path().join(file)).expect("there")
        };
        assert!(bytes("out") == bytes("alone"), "{n}");
    }
}

/// A run that was killed may leave a line without a file, and part of a line.
#[neurotess_testing::test]
fn leavings_of_a_killed_run_do_no_harm() {
    let folders = Folders::with(2);
    folders.batch().resume(true).run(|_| {}).expect("run");
    fs::remove_file(folders.path("out/0.ply")).expect("removed");
    fs::write(folders.path("out/.1.ply.neurotess-part"), "half").expect("written");
    let record = folders.path("out/.neurotess-made");
    let text = fs::read_to_string(&record).expect("there");
    fs::write(&record, format!("{text}{{\"out\":\"1.p")).expect("written");
    let report = folders.batch().resume(true).run(|_| {}).expect("run");
    assert_eq!((report.done().count(), report.kept()), (1, 1));
}
