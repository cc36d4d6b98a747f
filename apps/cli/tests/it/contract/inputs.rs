//! Files, folders and globs; where results go.

use crate::work::{SMALL, Work};

fn cells() -> Work {
    let work = Work::new();
    for name in [
        "cells/a.swc",
        "cells/b.swc",
        "cells/sub/a.swc",
        "cells/sub/deep/d.SWC",
    ] {
        work.file(name, SMALL);
    }
    work.file("cells/notes.txt", "nothing to read");
    work
}

fn list(work: &Work, arguments: &str) -> Vec<String> {
    let json = work
        .run(&format!("info --json {arguments}"))
        .exits(0)
        .json();
    let entries = json.as_array().expect("a list");
    let name = |entry: &serde_json::Value| entry["file"].as_str().map(|s| s.replace('\\', "/"));
    entries.iter().filter_map(name).collect()
}

#[neurotess_testing::test]
fn folders_are_searched_and_globs_expand() {
    let work = cells();
    let all = [
        "cells/a.swc",
        "cells/b.swc",
        "cells/sub/a.swc",
        "cells/sub/deep/d.SWC",
    ];
    assert_eq!(list(&work, "cells"), all);
    assert_eq!(list(&work, "cells cells/b.swc"), all);
    assert_eq!(list(&work, "cells/*.swc"), all[..2]);
    assert_eq!(list(&work, "cells/**/a.swc"), [all[0], all[2]]);
    assert_eq!(list(&work, "cells/b.swc cells/a.swc"), [all[1], all[0]]);
}

#[neurotess_testing::test]
fn nothing_that_matches_is_an_error() {
    let work = cells();
    std::fs::create_dir(work.path("empty")).expect("made");
    for nothing in ["empty", "cells/*.h5", "missing.swc"] {
        let run = work.run(&format!("info {nothing}")).exits(1);
        assert_eq!(run.errors().len(), 1, "{}", run.stderr());
    }
    work.run("info empty cells/a.swc").exits(1);
}

#[neurotess_testing::test]
fn outputs_repeat_the_structure() {
    let work = cells();
    work.run("mesh cells -o out --level 1 --format off")
        .exits(0);
    let root = work.path("out");
    let names: Vec<_> = work.files("out").into_keys().collect();
    let expected = ["a.off", "b.off", "sub/a.off", "sub/deep/d.off"].map(|name| root.join(name));
    assert_eq!(names, expected);
}

#[neurotess_testing::test]
fn colliding_outputs_are_refused_before_anything_is_done() {
    let work = cells();
    let run = work.run("mesh cells/a.swc cells/sub/a.swc -o out").exits(2);
    assert!(
        run.stderr().contains("would both become"),
        "{}",
        run.stderr()
    );
    assert!(work.files("out").is_empty());
}

#[neurotess_testing::test]
fn one_file_goes_to_a_file_or_into_a_folder() {
    let work = cells();
    work.run("mesh cells/a.swc -o x/y.stl --level 1").exits(0);
    assert_eq!(work.names("x"), ["y.stl"]);
    std::fs::create_dir(work.path("there")).expect("made");
    work.run("mesh cells/a.swc -o there --level 1 --format obj")
        .exits(0);
    assert_eq!(work.names("there"), ["a.obj"]);
}

#[neurotess_testing::test]
fn links_in_circles_end() {
    #[cfg(unix)]
    {
        let work = cells();
        std::os::unix::fs::symlink(work.path("cells"), work.path("cells/sub/loop")).expect("made");
        let run = work.run("info cells --json").exits(1);
        assert_eq!(run.json().as_array().map(Vec::len), Some(4));
    }
}
