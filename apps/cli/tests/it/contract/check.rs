//! `neurotess check`

use std::path::Path;

use crate::work::{SMALL, Work};

const TETRAHEDRON: &str = "OFF
4 4 0
0 0 0
1 0 0
0 1 0
0 0 1
3 0 2 1
3 0 1 3
3 1 2 3
3 2 0 3
";

#[neurotess_testing::test]
fn has_the_keys_of_the_contract() {
    let work = Work::new();
    work.file("mesh.off", TETRAHEDRON);
    let run = work.run("check mesh.off --json").exits(0);
    insta::assert_json_snapshot!("check_tetrahedron", run.json());
    let text = work.run("check mesh.off").exits(0).stdout();
    insta::assert_snapshot!("check_text", text);
}

#[neurotess_testing::test]
fn open_meshes_are_found_and_broken_files_fail() {
    let work = Work::new();
    work.file(
        "m/a.off",
        TETRAHEDRON
            .replace("4 4 0", "4 3 0")
            .replace("3 2 0 3\n", ""),
    );
    work.file("m/b.off", "OFF\n1 1 0\n0 0 0\n3 0 1 2\n");
    work.file("m/c.off", TETRAHEDRON);
    let run = work.run("check m --json").exits(1);
    let json = run.json();
    assert_eq!(
        (&json[0]["closed"], &json[2]["closed"]),
        (&false.into(), &true.into())
    );
    let file = Path::new("m").join("b.off");
    let errors = run.errors();
    assert_eq!(errors.len(), 1, "{}", run.stderr());
    assert!(
        errors[0].starts_with(&format!("error: {}:", file.display())),
        "{errors:?}"
    );
}

#[neurotess_testing::test]
fn merging_closes_a_stl() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    work.run("mesh cell.swc -o cell.stl --level 1").exits(0);
    let open = work.run("check cell.stl --json").exits(0).json();
    let closed = work.run("check cell.stl --merge --json").exits(0).json();
    assert_eq!(
        (&open[0]["closed"], &closed[0]["closed"]),
        (&false.into(), &true.into())
    );
}
