//! Packed files and containers

use std::io::Write;

use flate2::Compression;
use flate2::write::GzEncoder;

use crate::work::{SMALL, Work, sample};

fn packed(content: &[u8]) -> Vec<u8> {
    let mut packing = GzEncoder::new(Vec::new(), Compression::default());
    packing.write_all(content).expect("memory takes it");
    packing.finish().expect("memory takes it")
}

#[neurotess_testing::test]
fn packed_tracings_are_read_like_others() {
    let work = Work::new();
    work.file("cells/a.swc.gz", packed(SMALL.as_bytes()));
    work.file("a.swc", SMALL);
    work.run("diff a.swc cells/a.swc.gz").exits(0);
    let json = work.run("info cells --json").exits(0).json();
    assert_eq!(
        (&json[0]["format"], &json[0]["n_points"]),
        (&"swc".into(), &6.into())
    );
    work.run("convert cells -o out").exits(0);
    assert_eq!(work.text("out/a.swc"), SMALL);
    work.run("convert a.swc -o b.asc").exits(0);
    work.file("b.asc.gz", packed(work.text("b.asc").as_bytes()));
    work.run("diff b.asc b.asc.gz").exits(0);
    work.run("mesh cells/a.swc.gz -o meshes/ --level 1")
        .exits(0);
    assert!(work.path("meshes/a.ply").exists());
}

#[neurotess_testing::test]
fn broken_packages_are_errors() {
    let work = Work::new();
    let whole = packed(SMALL.as_bytes());
    work.file("cut.swc.gz", &whole[..whole.len() - 9]);
    let run = work.run("convert cut.swc.gz -o out.swc").exits(1);
    assert!(
        run.stderr()
            .starts_with("error: cut.swc.gz: the gzip is broken"),
        "{}",
        run.stderr()
    );
    assert_eq!(work.names("."), ["cut.swc.gz"]);
    work.file("bad.swc.gz", packed(b"1 1 0 0 0 5 -1\n2 2 0 9 0 1\n"));
    let run = work.run("info bad.swc.gz").exits(1);
    assert!(
        run.stderr().starts_with("error: bad.swc.gz:2: 6 columns"),
        "{}",
        run.stderr()
    );
}

#[neurotess_testing::test]
fn h5_is_packed_too() {
    let work = Work::new();
    let cell = sample("granule.swc");
    work.run(&format!("convert {cell} -o cell.h5")).exits(0);
    let content = std::fs::read(work.path("cell.h5")).expect("there");
    work.file("again.h5.gz", packed(&content));
    work.run("diff cell.h5 again.h5.gz").exits(0);
}
