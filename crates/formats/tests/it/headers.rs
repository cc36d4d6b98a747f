//! What headers say of units and origin, and what heads of blocks say of their kind.

use neurotess_formats::{Read, ReadOptions, asc, swc};

fn read(text: &str, options: &ReadOptions) -> Read {
    swc::read_bytes(text.as_bytes(), "cell", options).expect("a cell")
}

fn codes(read: &Read) -> Vec<&'static str> {
    read.warnings.iter().map(|warning| warning.code).collect()
}

const ROWS: &str =
    "1 1 1000 1000 1000 600 -1\n2 3 1800 1000 1000 100 1\n3 3 3300 1000 1000 100 2\n";

#[neurotess_testing::test]
fn a_unit_is_converted_once() {
    let text = format!("# Meta: {{\"id\": \"1\", \"units\": \"8 nanometer\"}}\n{ROWS}");
    let by_header = read(&text, &ReadOptions::default());
    assert_eq!(by_header.morphology.points[1].position.x, 26.4);
    assert_eq!(codes(&by_header), ["units_in_header"]);
    // Who knows the unit scales the numbers of the file.
    let options = ReadOptions {
        unit_given: true,
        ..ReadOptions::default()
    };
    let given = read(&text, &options);
    assert_eq!(given.morphology.points[1].position.x, 3300.0);
    assert_eq!(codes(&given), ["unit_not_applied"]);
    // A copy is in micrometers, whoever made it so.
    for read in [by_header, given] {
        assert!(read.morphology.header[0].contains("\"1 micrometer\""));
    }
}

#[neurotess_testing::test]
fn pixels_and_offsets_are_told_with_a_remedy() {
    let rows = "1 1 0 0 0 5 -1\n2 3 6 0 0 1.5 1\n3 3 26 0 0 1.25 2\n";
    let snt = "# All positions and radii in pixels\n# Voxel separation (x,y,z): 0.3, 0.3, 1.0\n";
    let pixels = read(&format!("{snt}{rows}"), &ReadOptions::default());
    assert_eq!(codes(&pixels), ["unit_not_applied"]);
    assert!(
        pixels.warnings[0]
            .message
            .contains("--units voxel=0.3,0.3,1 ")
    );
    let offset = read(
        &format!("# OFFSET 1000.5 2000.25 3000\n{rows}"),
        &ReadOptions::default(),
    );
    assert_eq!(codes(&offset), ["offset_not_added"]);
    assert!(
        offset.warnings[0]
            .message
            .contains("--matrix 1,0,0,1000.5,0,1,0,2000.25,0,0,1,3000 ")
    );
    let none = read(&format!("# OFFSET 0 0 0\n{rows}"), &ReadOptions::default());
    assert!(none.warnings.is_empty());
}

#[neurotess_testing::test]
fn cells_in_millimeters_and_nanometers_are_told() {
    let cell = |factor: f64, radius: f64| {
        let points = [
            [0.0, 0.0],
            [6.0, 0.0],
            [26.0, 0.0],
            [46.0, 10.0],
            [-100.0, 14.0],
        ];
        let row = |(i, [x, y]): (usize, &[f64; 2])| {
            let (kind, r) = if i == 0 { (1, 5.0) } else { (3, radius) };
            let parent = if i == 0 { -1 } else { i as i64 };
            format!(
                "{} {kind} {} {} 0 {} {parent}\n",
                i + 1,
                x * factor,
                y * factor,
                r * factor
            )
        };
        points.iter().enumerate().map(row).collect::<String>()
    };
    let told = |text: &str| codes(&read(text, &ReadOptions::default()));
    assert!(told(&cell(1.0, 1.0)).is_empty());
    assert_eq!(told(&cell(1e-3, 1.0)), ["too_small"]);
    assert_eq!(told(&cell(1e-6, 1.0)), ["too_small"]);
    assert_eq!(told(&cell(1e3, 1.0)), ["too_large"]);
    // A skeleton in nanometers without radii.
    let far: String = (0..6)
        .map(|i| {
            format!(
                "{} 0 {} 0 0 -1 {}\n",
                i + 1,
                5000 * i,
                if i == 0 { -1 } else { i }
            )
        })
        .collect();
    assert!(told(&far).contains(&"too_large"));
}

const HEADS: [&str; 6] = [
    "((Dendrite) (Color Blue) (6 0 0 2) (16 0 0 2))",
    "(\"Basal 1\" (Color Blue) (Dendrite) (6 0 0 2) (16 0 0 2))",
    "((Color Blue) \"Basal 1\" (Dendrite) (6 0 0 2) (16 0 0 2))",
    "((Dendrite) \"Basal 1\" (6 0 0 2) (16 0 0 2))",
    "(\"Basal 1\" (Dendrite) \"again\" (6, 0, 0, 2) (16, 0, 0, 2))",
    "((Name \"Basal 1\") (Dendrite) (6,0,0,2) (16,0,0,2))",
];

#[neurotess_testing::test]
fn a_block_is_what_its_head_says_whatever_its_name() {
    for text in HEADS {
        let read = asc::read_bytes(text.as_bytes(), "cell", &ReadOptions::default());
        let cell = read.expect(text).morphology;
        assert_eq!(
            (cell.points.len(), cell.sections[0].kind.0),
            (2, 3),
            "{text}"
        );
        assert_eq!(cell.points[1].position.x, 16.0, "{text}");
    }
    for soma in [
        "(\"Cell Body\" (5 0 0 1) (0 5 0 1) (-5 0 0 1))",
        "(\"S\" (CellBody) (5 0 0 1) (0 5 0 1) (-5 0 0 1))",
    ] {
        let read = asc::read_bytes(soma.as_bytes(), "cell", &ReadOptions::default());
        assert_eq!(read.expect(soma).morphology.somata.len(), 1, "{soma}");
    }
}

#[neurotess_testing::test]
fn decimal_commas_are_no_separators() {
    for point in [
        "6,5 0 0 2",
        "6,5 0,5 0,0 2,0",
        "6,5, 0,5, 0,0, 2,0",
        "6,5 7 2",
    ] {
        let text = format!("((Dendrite) (1 0 0 2) ({point}))");
        let error = asc::read_bytes(text.as_bytes(), "cell", &ReadOptions::default());
        let error = error.expect_err(point).to_string();
        assert!(error.contains("commas seem to be decimal marks"), "{error}");
    }
}
