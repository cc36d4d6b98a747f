//! `--unit`

use neurotess::mesh::{Format, check, merge_identical, read};

use super::neurotess;
use crate::work::sample;

#[neurotess_testing::test]
fn meters_are_millionths_in_every_format() {
    let folder = tempfile::tempdir().expect("a folder");
    let star = sample("granule.swc");
    for format in Format::ALL {
        let volumes = ["um", "m"].map(|unit| {
            let out = format!("{unit}.{format}");
            let command = format!("mesh {star} -o {out} --unit {unit} --level 1 -q");
            neurotess(folder.path(), &command).expect("meshed");
            let mut mesh = read(&folder.path().join(out)).expect("our file");
            merge_identical(&mut mesh);
            let report = check(&mesh);
            assert!(report.closed && report.oriented, "{format} in {unit}");
            report.volume
        });
        let ratio = volumes[1] / volumes[0];
        assert!((ratio / 1e-18 - 1.0).abs() < 1e-4, "{format}: {ratio}");
    }
}

#[neurotess_testing::test]
fn another_unit_is_another_output_for_resume() {
    let folder = tempfile::tempdir().expect("a folder");
    let cell = sample("granule.swc");
    let command =
        |unit: &str| format!("mesh {cell} -o out.ply --level 1 --resume --unit {unit} --json");
    let run = |unit: &str| neurotess(folder.path(), &command(unit)).expect("meshed");
    assert!(!run("um").contains("\"skipped\""));
    assert!(run("um").contains("\"skipped\""));
    assert!(!run("m").contains("\"skipped\""));
}
