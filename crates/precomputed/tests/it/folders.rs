//! What is in a folder, however it came about.

use std::fs;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use neurotess_precomputed::{Event, Export, ExportError};
use neurotess_recipe::Spelling;
use neurotess_testing::full;

use crate::Folders;
use crate::circuits::many;

#[neurotess_testing::test]
fn a_folder_holds_each_cell_and_what_all_share() {
    let folders = Folders::with(2);
    let report = folders.export("out").run(|_| ()).expect("written");
    assert_eq!((report.written, report.kept), (2, 0));
    assert!(report.link.contains("neuroglancer"));
    let names: Vec<String> = folders.files("out").into_keys().collect();
    let expected = [
        "info",
        "mesh/1",
        "mesh/1.index",
        "mesh/2",
        "mesh/2.index",
        "mesh/info",
        "neurotess.json",
        "properties/info",
        "skeletons/1",
        "skeletons/2",
        "skeletons/info",
        "view.json",
    ];
    assert_eq!(names, expected);
}

/// Half of the files are missing, as after a run that was killed, and one was being written.
fn resumed_is_the_same(folders: &Folders, export: &Export) {
    let export = || export.clone().into(folders.path("out"));
    let cells = export().run(|_| ()).expect("written").written;
    let whole = folders.files("out");
    let is_cell = |name: &str| name.contains('/') && !name.ends_with("info");
    let mut removed = 0;
    for name in whole.keys().filter(|name| is_cell(name)).step_by(2) {
        fs::remove_file(folders.path("out").join(name)).expect("removed");
        removed += 1;
    }
    assert!(removed > 1);
    let half = folders.path("out/mesh/.1.neurotess-part");
    fs::write(&half, "half").expect("written");
    let refused = export().run(|_| ());
    assert!(matches!(refused, Err(ExportError::Exists(_))));
    let report = export().resume(true).workers(2).run(|_| ());
    let report = report.expect("resumed");
    assert_eq!(report.written + report.kept, cells);
    assert!(report.written > 0, "{report:?}");
    drop(fs::remove_file(half));
    assert!(folders.files("out") == whole);
}

#[neurotess_testing::test]
fn a_resumed_folder_is_the_same_to_the_byte() {
    let folders = Folders::with(12);
    resumed_is_the_same(&folders, &folders.export("out"));
}

#[neurotess_testing::test]
fn a_resumed_sharded_folder_is_the_same_to_the_byte() {
    let folders = Folders::with(0);
    resumed_is_the_same(&folders, &many(&folders));
}

#[neurotess_testing::test(needs(full))]
fn parts_make_the_whole() {
    let folders = Folders::with(0);
    let export = many(&folders);
    let whole = export.clone().into(folders.path("whole")).run(|_| ());
    assert_eq!(whole.expect("written").written, 520);
    for part in ["2/3", "1/3", "3/3"] {
        let part = part.parse().expect("a part");
        let export = export.clone().into(folders.path("parts")).part(part);
        export.run(|_| ()).expect("written");
    }
    assert!(folders.files("whole") == folders.files("parts"));
}

#[neurotess_testing::test]
fn other_cells_are_not_mixed_in() {
    let folders = Folders::with(2);
    folders.export("out").run(|_| ()).expect("written");
    fs::write(folders.path("in/3.swc"), "1 1 0 0 0 5 -1\n2 2 0 9 0 1 1\n").expect("written");
    let other = folders.export("out").resume(true).run(|_| ());
    assert!(matches!(other, Err(ExportError::Other(_))));
    // Written anew, nothing of the cells before is left.
    fs::remove_file(folders.path("in/1.swc")).expect("removed");
    let report = folders
        .export("out")
        .replace(true)
        .run(|_| ())
        .expect("written");
    assert_eq!(report.written, 2);
    let files = folders.files("out");
    assert!(!files.contains_key("mesh/1") && files.contains_key("mesh/3.index"));
    // Nor where a run was killed while it removed them: by then it has noted that they are of nothing.
    let plan = folders.path("out/neurotess.json");
    fs::write(&plan, "{}\n").expect("written");
    fs::write(folders.path("out/mesh/9"), "old").expect("written");
    let refused = folders.export("out").resume(true).run(|_| ());
    assert!(matches!(refused, Err(ExportError::Other(_))));
    let export = folders.export("out").replace(true);
    assert_eq!(export.run(|_| ()).expect("written").written, 2);
    assert!(!folders.path("out/mesh/9").exists());
    // Files of which nothing says that they were written here stay.
    fs::remove_file(plan).expect("removed");
    for replace in [false, true] {
        let refused = folders.export("out").replace(replace).run(|_| ());
        assert!(matches!(refused, Err(ExportError::Foreign(_))));
    }
    assert!(folders.path("out/mesh/3").exists());
}

#[neurotess_testing::test]
fn a_bad_file_is_named_once_and_the_others_are_written() {
    let folders = Folders::with(3);
    fs::write(folders.path("in/2.swc"), "1 1 0 nine 0 5 -1\n").expect("written");
    let report = folders.export("out").run(|_| ()).expect("written");
    assert_eq!((report.written, report.failures.len()), (2, 1));
    let told = report.failures[0].told(Spelling::Flag);
    assert!(told.contains("2.swc:1:"), "{told}");
    let properties = fs::read_to_string(folders.path("out/properties/info")).expect("read");
    assert!(properties.contains(r#""ids":["1","3"]"#), "{properties}");
}

#[neurotess_testing::test]
fn what_is_stopped_leaves_whole_files_only() {
    let folders = Folders::with(40);
    let stopped = Arc::new(AtomicBool::new(false));
    let export = folders.export("out").stopped_by(Arc::clone(&stopped));
    let told = |event: Event<'_>| {
        if let Event::Written(_) = event {
            stopped.store(true, Ordering::Relaxed);
        }
    };
    let report = export.workers(1).run(told).expect("ended");
    assert!(report.stopped && report.written == 1, "{report:?}");
    let files = folders.files("out");
    assert!(
        !files.keys().any(|name| name.contains("part")),
        "{:?}",
        files.keys()
    );
}
