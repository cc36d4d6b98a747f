//! What SWC files are refused, with the line and the message.

use neurotess_formats::{ReadOptions, read, swc};

/// The message without the name that all of them start with.
fn refused(text: impl AsRef<[u8]>) -> String {
    let read = swc::read_bytes(text.as_ref(), "f.swc", &ReadOptions::default());
    let message = read.expect_err("it is refused").to_string();
    message
        .strip_prefix("f.swc:")
        .expect("the file's name")
        .to_owned()
}

#[neurotess_testing::test]
fn messages_are_line_what_and_what_to_do() {
    assert_eq!(
        refused("# x\n1 1 0 0 0 5 -1\n2 3 0 6 0 1 9\n"),
        "3: sample 2 has parent 9, which is not in the file: add it, or use -1"
    );
}

#[neurotess_testing::test]
fn faults_of_a_row_name_its_line() {
    for (row, says) in [
        ("2 3 0 6 0 1", "6 columns instead of 7"),
        ("2 3 0 6 # 0 1 1", "4 columns instead of 7"),
        ("2 3 0 six 0 1 1", "y is not a number but \"six\""),
        (
            "2 3 0 6 0 1 1x",
            "the parent's number is not a number but \"1x\"",
        ),
        ("2 3 nan 6 0 1 1", "x is nan"),
        ("2 3 0 inf 0 1 1", "y is inf"),
        ("2 3 0 0 -1e39 1 1", "z is -1e39"),
        ("2 3 0 6 0 1e308 1", "the radius is 1e308"),
        (
            "2.5 3 0 6 0 1 1",
            "the sample's number is not a whole number",
        ),
        (
            "-2 3 0 6 0 1 1",
            "the sample's number is not a whole number",
        ),
        (
            "2 99999999999 0 6 0 1 1",
            "the type is not a whole number in range",
        ),
        ("2,3,,6,0,1,1", "x is not a number but \"\""),
        ("2 3 0,0 6,5 0,0 1,0 1", "commas seem to be decimal marks"),
        ("2;3;0,0;6,5;0,0;1,0;1", "commas seem to be decimal marks"),
        ("2 3 0 6 0 1 2", "sample 2 is its own parent"),
        ("2 3 0 6 0 1 7", "sample 2 has parent 7"),
        ("1 3 0 6 0 1 1", "sample 1 stands in line 1 already"),
    ] {
        let message = refused(format!("1 1 0 0 0 5 -1\n{row}\n"));
        assert!(message.starts_with("2: "), "{row}: {message}");
        assert!(message.contains(says), "{row}: {message}");
        assert!(
            message[3..].contains(": "),
            "{row}: {message} does not say what to do"
        );
    }
}

#[neurotess_testing::test]
fn a_repeated_number_is_found_whatever_the_numbers_are() {
    let counted = refused("1 1 0 0 0 5 -1\n2 3 0 6 0 1 1\n2 3 0 7 0 1 1\n");
    assert!(
        counted.starts_with("3: sample 2 stands in line 2"),
        "{counted}"
    );
    let sparse = refused("1 1 0 0 0 5 -1\n900000 3 0 6 0 1 1\n900000 3 0 7 0 1 1\n");
    assert!(
        sparse.starts_with("3: sample 900000 stands in line 2"),
        "{sparse}"
    );
}

#[neurotess_testing::test]
fn a_cycle_is_named_by_its_first_row() {
    let message =
        refused("1 1 0 0 0 5 -1\n5 3 0 0 0 1 4\n2 3 0 6 0 1 4\n3 3 0 7 0 1 2\n4 3 0 8 0 1 3\n");
    assert!(
        message.starts_with("3: sample 2 is its own ancestor"),
        "{message}"
    );
}

#[neurotess_testing::test]
fn files_without_samples_are_refused() {
    assert!(refused("").starts_with("1: the file is empty"));
    assert!(refused("# a\n# b\n").starts_with("1: no sample"));
    assert!(refused(" \r\n\t\n").starts_with("1: no sample"));
    assert!(refused("# header and rows on one line 1 1 0 0 0 5 -1").starts_with("1: no sample"));
}

#[neurotess_testing::test]
fn other_files_are_refused_by_name() {
    let utf16 = |text: &str| {
        text.encode_utf16()
            .flat_map(u16::to_le_bytes)
            .collect::<Vec<_>>()
    };
    assert!(refused(utf16("\u{feff}1 1 0 0 0 5 -1")).contains("UTF-16"));
    assert!(refused(utf16("1 1 0 0 0 5 -1\n")).contains("UTF-16"));
    assert!(refused(b"1 1 0 0 0 5 -1\n2 3 \0\x01").starts_with("2: the file is binary"));
    assert!(refused("\n<html>").starts_with("2: the file is a web page"));
}

#[neurotess_testing::test]
fn bad_radii_are_zero_for_whoever_mends_them() {
    let text = b"1 1 0 0 0 5 -1\n2 3 9 0 0 nan 1\n3 3 19 0 0 inf 2\n4 3 29 0 0 1 3\n";
    let options = ReadOptions {
        zero_for_bad_radii: true,
        ..ReadOptions::default()
    };
    let read = swc::read_bytes(text, "f.swc", &options).expect("read");
    let radii: Vec<f32> = read.morphology.points.iter().map(|p| p.radius).collect();
    assert_eq!(radii, [0.0, 0.0, 1.0]);
    let warning = read.warnings.iter().find(|w| w.code == "radius_not_finite");
    let warning = warning.expect("a warning");
    assert_eq!((warning.line, warning.count), (Some(2), 2));
    let bad_place = b"1 1 0 0 nan 5 -1\n";
    assert!(swc::read_bytes(bad_place, "f.swc", &options).is_err());
}

#[neurotess_testing::test]
fn strict_reading_takes_the_first_warning_as_an_error() {
    let text = b"1 1 0 0 0 5 -1\n2 3 0 6 0 -1 1\n";
    let e = swc::read_bytes(
        text,
        "f.swc",
        &ReadOptions {
            strict: true,
            ..ReadOptions::default()
        },
    )
    .expect_err("strict");
    let says = "f.swc:2: negative radius: kept, measured as zero (negative_radius): \
                mend the file, or read without --strict";
    assert_eq!(e.to_string(), says);
}

#[neurotess_testing::test]
fn a_file_that_is_not_there_is_named() {
    let e = read("no/such.swc", &ReadOptions::default())
        .expect_err("no file")
        .to_string();
    assert!(e.starts_with("no/such.swc: cannot be read"), "{e}");
}
