//! Files that are not read are called by their names.

use neurotess_formats::{Format, ReadOptions, read_bytes};

fn said(bytes: &[u8], name: &str, format: Option<Format>) -> String {
    let read = read_bytes(bytes.to_vec(), name, format, &ReadOptions::default());
    read.expect_err("it is not read").to_string()
}

#[neurotess_testing::test]
fn formats_that_are_not_read_are_named_with_a_way_out() {
    for (bytes, expected) in [
        (
            &b"load_file(\"stdrun.hoc\")\ncreate soma\nsoma { pt3dclear() }"[..],
            "hoc, a program for NEURON",
        ),
        (
            b"create soma[1], dend[3]\naccess soma\nsoma {pt3dadd(0, 0, 0, 1)}",
            "hoc, a program for NEURON",
        ),
        (b"PK\x03\x04\x14\x00", "a zip archive"),
        (
            b"# AmiraMesh 3D ASCII 2.0\ndefine VERTEX 5",
            "an Amira graph",
        ),
        (b"MATLAB 5.0 MAT-file, Platform: GLNXA64", "MATLAB data"),
        (b"//genesis\n*relative\n*cartesian", "a cell of GENESIS"),
        (b"{\"@type\": \"neuroglancer_skeletons\"}", "neuroglancer"),
    ] {
        let said = said(bytes, "cell.dat", None);
        assert!(said.starts_with("cell.dat: the file is "), "{said}");
        assert!(
            said.contains(expected) && said.contains(", which is not read: "),
            "{said}"
        );
    }
}

#[neurotess_testing::test]
fn other_xml_is_named_whatever_the_file_is_called() {
    for (name, format) in [
        ("a.nml", Some(Format::NeuroMl)),
        ("a.xml", None),
        ("a.dat", None),
    ] {
        let said = said(b"<?xml version=\"1.0\"?><svg></svg>", name, format);
        assert!(
            said.starts_with(&format!("{name}: the XML is <svg>, no tracing: give")),
            "{said}"
        );
    }
    let page = said(b"<!DOCTYPE html><html>", "a.nml", Some(Format::NeuroMl));
    assert!(page.contains("is a web page"), "{page}");
}
