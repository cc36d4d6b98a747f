//! What SWC files are taken in, and what comes out of them.

use glam::{DVec3, Vec3};
use neurotess_formats::{Read, ReadOptions, read, swc};
use neurotess_morphology::{Attachment, Measures, Morphology, NeuriteKind, SectionId, SomaKind};

fn taken(text: impl AsRef<[u8]>) -> Read {
    swc::read_bytes(text.as_ref(), "cell.swc", &ReadOptions::default()).expect("it is taken")
}

fn codes(read: &Read) -> Vec<&'static str> {
    read.warnings.iter().map(|w| w.code).collect()
}

fn written(morphology: &Morphology) -> String {
    let mut text = Vec::new();
    swc::write_numbered(morphology, swc::SampleNumbers::Kept, &mut text).expect("memory");
    String::from_utf8(text).expect("ASCII")
}

const PLAIN: &str = "# head\n1 1 0 0 0 5 -1\n2 3 0 6 0 1 1\n3 3 0 9 0 0.5 2\n";

#[neurotess_testing::test]
fn other_spellings_read_like_the_plain_one() {
    let plain = taken(PLAIN);
    assert!(plain.warnings.is_empty());
    for (what, text) in [
        ("CRLF", PLAIN.replace('\n', "\r\n")),
        ("CR alone", PLAIN.replace('\n', "\r")),
        ("tabs", PLAIN.replace(" 3 ", "\t3\t")),
        ("leading and trailing blanks", PLAIN.replace('\n', "  \n  ")),
        ("no final newline", PLAIN.trim_end().to_owned()),
        ("byte-order mark", format!("\u{feff}{PLAIN}")),
        ("blank lines", PLAIN.replace('\n', "\n\n \n")),
        (
            "inline comments",
            PLAIN.replace(" 1\n", " 1 # on the soma\n"),
        ),
        ("comments between", PLAIN.replace("2 3", "# between\n2 3")),
        ("comment glued on", PLAIN.replace(" 1\n", " 1#x\n")),
        (
            "plus signs and points",
            PLAIN.replace(" 6", " +6.").replace("0.5", ".5"),
        ),
        (
            "exponents",
            PLAIN.replace(" 6", " 60e-1").replace(" 9", " 0.9E+1"),
        ),
        (
            "synapse footer",
            format!("{PLAIN}#start synapse\n# 1 2 3\n#end synapse\n"),
        ),
    ] {
        assert_eq!(taken(&text), plain, "{what}");
    }
}

#[neurotess_testing::test]
fn odd_spellings_are_taken_with_a_warning() {
    for (code, text) in [
        ("separators", PLAIN.replace(' ', ",").replace("#,", "# ")),
        ("separators", PLAIN.replace(' ', "; ").replace("#; ", "# ")),
        (
            "float_ids",
            PLAIN.replace("1 1", "1.000000 1.0").replace("-1", "-1.0"),
        ),
        ("extra_columns", PLAIN.replace(" 1\n", " 1 0.3 abc\n")),
        ("root_parent", PLAIN.replace("-1", "-2")),
    ] {
        let read = taken(&text);
        assert_eq!(codes(&read), [code], "{text}");
        assert_eq!(read.morphology, taken(PLAIN).morphology, "{text}");
    }
}

#[neurotess_testing::test]
fn columns_of_eswc_are_no_oddity() {
    let text = PLAIN.replace(" 2\n", " 2 7 0.1 8\n");
    let read = swc::read_bytes(text.as_bytes(), "a/cell.eswc", &ReadOptions::default());
    assert_eq!(read.expect("it is taken"), taken(PLAIN));
}

#[neurotess_testing::test]
fn latin_1_headers_are_letters() {
    let cell = taken(b"#M\xfcller\n# \xb5m \n1 1 0 0 0 5 -1\n").morphology;
    assert_eq!(cell.header, ["Müller", "µm"]);
    assert_eq!(taken(written(&cell)).morphology, cell);
}

#[neurotess_testing::test]
fn warnings_count_and_name_the_first_line() {
    let read = taken("1 1 0 0 0 5 -1\n\n2 3 0 6 0 0 1\n3 3 0 9 0 0 2\n");
    let warning = &read.warnings[0];
    assert_eq!(
        (warning.code, warning.line, warning.count),
        ("zero_radius", Some(3), 2)
    );
    assert_eq!(
        warning.to_string(),
        "line 3: points with radius zero, 2 times (zero_radius)"
    );
}

#[neurotess_testing::test]
fn numbers_may_have_gaps_and_any_order() {
    let dense = taken("7 3 0 9 0 1 4\n4 3 0 6 0 1 2\n2 1 0 0 0 5 -1\n");
    assert_eq!(codes(&dense), ["parent_after_child"]);
    assert_eq!(dense.morphology.sample_ids, [4, 7]);
    let sparse = taken("700000000 3 0 9 0 1 40000\n40000 3 0 6 0 1 2\n2 1 0 0 0 5 -1\n");
    assert_eq!(sparse.morphology.points, dense.morphology.points);
}

#[neurotess_testing::test]
fn sections_end_at_forks_and_where_the_type_changes() {
    let cell = taken(
        "1 1 0 0 0 5 -1\n2 3 0 6 0 1 1\n3 3 0 7 0 1 2\n4 3 1 8 0 1 3\n5 3 -1 8 0 1 3\n\
         6 2 -1 9 0 1 5\n",
    )
    .morphology;
    let sections: Vec<_> = cell
        .sections
        .iter()
        .map(|s| (s.kind.0, s.range()))
        .collect();
    assert_eq!(sections, [(3, 0..2), (3, 2..3), (3, 3..4), (2, 4..5)]);
    assert_eq!(
        cell.sections[3].attachment,
        Attachment::Section(SectionId(2))
    );
    assert_eq!(Measures::of(&cell).max_branch_order, 1);
}

#[neurotess_testing::test]
fn any_type_is_kept() {
    let read = taken("1 1 0 0 0 5 -1\n2 0 0 6 0 1 1\n3 274 0 7 0 1 1\n4 -3 0 8 0 1 1\n");
    let kinds: Vec<_> = read.morphology.sections.iter().map(|s| s.kind).collect();
    assert_eq!(kinds, [NeuriteKind(0), NeuriteKind(274), NeuriteKind(-3)]);
    assert!(read.warnings.is_empty());
}

#[neurotess_testing::test]
fn a_tree_is_hung_up_by_its_soma() {
    let read =
        taken("1 3 0 9 0 1 -1\n2 3 0 6 0 1 1\n3 1 0 0 0 5 2\n4 2 0 -6 0 1 3\n5 3 1 9 0 1 2\n");
    assert_eq!(codes(&read), ["soma_not_root"]);
    assert_eq!(read.warnings[0].line, Some(3));
    let cell = &read.morphology;
    assert_eq!(cell.sample_ids, [2, 1, 5, 4]);
    assert_eq!(
        cell.sections[0].attachment,
        Attachment::Soma { soma: 0, sample: 0 }
    );
    assert_eq!(taken(written(cell)).morphology, *cell);
}

#[neurotess_testing::test]
fn the_thickest_of_several_somata_is_the_main_one() {
    let read = taken("1 1 0 0 0 5 -1\n2 3 0 6 0 1 1\n3 1 9 0 0 8 -1\n4 3 9 9 0 1 3\n");
    assert_eq!(codes(&read), ["several_somata"]);
    let cell = &read.morphology;
    assert_eq!(
        cell.somata.iter().map(|s| s.radius).collect::<Vec<_>>(),
        [8.0, 5.0]
    );
    assert_eq!(
        cell.sections[0].attachment,
        Attachment::Soma { soma: 1, sample: 0 }
    );
    assert_eq!(taken(written(cell)).morphology, *cell);
}

#[neurotess_testing::test]
fn soma_samples_inside_a_neurite_stay_points() {
    let read = taken("1 1 0 0 0 5 -1\n2 3 0 6 0 1 1\n3 1 0 7 0 9 2\n4 3 0 8 0 1 3\n");
    assert_eq!(codes(&read), ["soma_inside_neurite"]);
    assert_eq!(read.morphology.somata.len(), 1);
    let kinds: Vec<_> = read.morphology.sections.iter().map(|s| s.kind.0).collect();
    assert_eq!(kinds, [3, 1, 3]);
    assert_eq!(taken(written(&read.morphology)).morphology, read.morphology);
}

#[neurotess_testing::test]
fn neurites_may_hang_on_any_sample_of_the_soma_or_on_nothing() {
    let read =
        taken("1 1 0 0 0 5 -1\n2 1 0 4 0 4 1\n3 3 0 9 0 1 2\n4 2 0 -9 0 1 1\n5 2 9 9 9 1 -1\n");
    assert_eq!(codes(&read), ["disconnected"]);
    let on: Vec<_> = read
        .morphology
        .sections
        .iter()
        .map(|s| s.attachment)
        .collect();
    let soma = |sample| Attachment::Soma { soma: 0, sample };
    assert_eq!(on, [soma(1), soma(0), Attachment::Free]);
    assert_eq!(read.morphology.somata[0].kind, SomaKind::Cylinders);
}

#[neurotess_testing::test]
fn a_cell_without_soma_is_read_and_told_of() {
    let read = taken("1 2 0 0 0 1 -1\n2 2 0 5 0 1 1\n");
    assert_eq!(codes(&read), ["no_soma"]);
    assert_eq!(read.morphology.sections[0].attachment, Attachment::Free);
}

#[neurotess_testing::test]
fn a_soma_without_radius_keeps_it() {
    let read = taken("1 1 0 0 0 0 -1\n2 2 0 5 0 1 1\n");
    assert_eq!(codes(&read), ["soma_zero_radius"]);
    assert_eq!(read.morphology.somata[0].radius, 0.0);
}

#[neurotess_testing::test]
fn far_away_cells_keep_their_precision() {
    let text = "1 1 52686.5 -0.25 8.125 5 -1\n2 3 52690.123 0.0001 -9.7 1 1\n";
    let cell = taken(text).morphology;
    assert_eq!(cell.origin, DVec3::new(52687.0, 0.0, 8.0));
    assert_eq!(cell.somata[0].center, Vec3::new(-0.5, -0.25, 0.125));
    assert_eq!(written(&cell), text);
    assert_eq!(taken(written(&cell)).morphology, cell);
}

#[neurotess_testing::test]
fn written_rows_are_the_rows_read() {
    assert_eq!(written(&taken(PLAIN).morphology), PLAIN);
}

#[neurotess_testing::test]
fn repeated_numbers_are_numbered_anew() {
    let mut cell = taken(PLAIN).morphology;
    cell.sample_ids = vec![1, 1];
    assert_eq!(written(&cell), PLAIN);
}

#[neurotess_testing::test]
fn the_name_is_the_stem_with_all_its_dots() {
    let options = ReadOptions::default();
    let name = |file| {
        swc::read_bytes(PLAIN.as_bytes(), file, &options)
            .expect(file)
            .morphology
            .name
    };
    assert_eq!(name("a/b/x1.000_y.CNG.SWC"), "x1.000_y.CNG");
    assert_eq!(name("v1.2"), "v1.2");
}

#[neurotess_testing::test]
fn without_a_known_extension_the_content_decides() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("cell.txt");
    std::fs::write(&file, PLAIN).expect("room");
    assert_eq!(
        read(&file, &ReadOptions::default()).expect("an SWC").format,
        "swc"
    );
    std::fs::write(&file, "hello").expect("room");
    let e = read(&file, &ReadOptions::default())
        .expect_err("no morphology")
        .to_string();
    assert!(e.contains("cell.txt: not a format known"), "{e}");
}
