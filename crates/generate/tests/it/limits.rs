//! Coordinates that 32 bits do not hold are errors that name the sample; large cells are not.

use crate::branches::add;
use glam::vec3;
use neurotess_formats::{ReadOptions, swc};
use neurotess_generate::{GenerateError, GenerateOptions, Generated, generate};
use neurotess_morphology::{Attachment, Morphology};

/// Two neurites; the second ends at `x` with radius `radius`.
fn mesh(x: &str, radius: &str) -> Result<Generated, GenerateError> {
    let text = format!(
        "1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n3 3 0 20 0 1 2\n4 2 9 0 0 1 1\n5 2 {x} 0 0 {radius} 4\n"
    );
    let read = swc::read_bytes(text.as_bytes(), "cell.swc", &ReadOptions::default());
    let morphology = read.expect("numbers").morphology;
    generate(&morphology, &GenerateOptions::default())
}

fn codes(generated: &Generated) -> Vec<&str> {
    generated.warnings.iter().map(|w| w.code).collect()
}

#[neurotess_testing::test]
fn coordinates_beyond_anything_name_their_sample() {
    for (x, radius) in [
        ("1e21", "1"),
        ("-3e13", "1"),
        ("50", "1e20"),
        ("1e37", "1e36"),
    ] {
        let error = mesh(x, radius).expect_err(x);
        let named = matches!(error, GenerateError::TooLarge { sample: 5, .. });
        assert!(named, "{x}: {error}");
    }
}

#[neurotess_testing::test]
fn radii_lost_in_rounding_name_their_sample() {
    let error = mesh("4e8", "1").expect_err("rounded by 24 µm");
    assert!(
        error
            .to_string()
            .starts_with("sample 5: a radius of 1 µm at 4"),
        "{error}"
    );
    assert!(matches!(error, GenerateError::Unresolved { sample: 5, .. }));
}

/// 10 mm of axon with a radius of 0.1 µm, and a radius that stands for none.
#[neurotess_testing::test]
fn what_real_cells_have_is_meshed() {
    let whole_brain = mesh("10000", "0.1").expect("an axon across a brain");
    assert!(codes(&whole_brain).contains(&"coarse_coordinates"));
    mesh("3000", "0.0001").expect("a radius that is not known");
    let ordinary = mesh("500", "0.5").expect("an ordinary cell");
    assert!(!codes(&ordinary).contains(&"coarse_coordinates"));
}

/// Radii that nobody traced: of the neighbors, or those that are asked for, and it is told which.
#[neurotess_testing::test]
fn radii_that_are_missing_are_told_by_what_is_taken_for_them() {
    let cell = |radii: [f32; 3]| {
        let mut cell = Morphology::default();
        let points = radii.iter().enumerate();
        let points = points.map(|(i, &radius)| (vec3(10.0 * i as f32, 0.0, 0.0), radius));
        add(&mut cell, Attachment::Free, points);
        cell
    };
    let made = |radii, options: GenerateOptions| {
        let made = generate(&cell(radii), &options).expect("meshed");
        let radii: Vec<f32> = made.mesh.tracing.iter().map(|point| point.radius).collect();
        let codes: Vec<&str> = made.warnings.iter().map(|warning| warning.code).collect();
        (radii, codes)
    };
    let usual = GenerateOptions::default;
    assert_eq!(
        made([0.0; 3], usual()),
        (vec![0.5; 3], vec!["radius_unknown"])
    );
    assert_eq!(
        made([1.0, 0.0, 3.0], usual()),
        (vec![1.0, 2.0, 3.0], vec!["radius_mended"])
    );
    let asked = GenerateOptions {
        unknown_radius: Some(0.2),
        ..usual()
    };
    assert_eq!(made([1.0, -1.0, 3.0], asked.clone()).0, [1.0, 0.2, 3.0]);
    let least = GenerateOptions {
        least_radius: 1.5,
        ..asked
    };
    let (radii, codes) = made([1.0, 0.0, 3.0], least);
    assert_eq!(radii, [1.5, 1.5, 3.0]);
    assert!(codes.contains(&"radius_raised"), "{codes:?}");
}
