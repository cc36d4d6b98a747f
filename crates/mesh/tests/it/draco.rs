//! Triangles as Draco, there and back.

use std::collections::BTreeMap;

use crate::shapes::torus;
use glam::DVec3;
use neurotess_mesh::draco::{Attribute, AttributeKind, Decoded, Values, decode, encode};

/// A torus of triangles: closed, and of a connectivity that EdgeBreaker must split.
fn ring() -> (Vec<[u32; 3]>, Vec<f32>) {
    let mesh = torus(12, 7, DVec3::ZERO);
    let mut triangles = mesh.faces.triangles;
    for [a, b, c, d] in mesh.faces.quads {
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    let positions = mesh.vertices.iter().flat_map(|v| v.position.to_array());
    (triangles, positions.collect())
}

fn numbers(of: &Decoded, id: u32) -> &[f64] {
    let attribute = of.attributes.iter().find(|a| a.id == id);
    &attribute.expect("it is there").values
}

/// Each triangle, from its smallest corner on.
fn sorted(mut triangles: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
    for triangle in &mut triangles {
        let least = (0..3).min_by_key(|&i| triangle[i]).expect("three");
        triangle.rotate_left(least);
    }
    triangles.sort_unstable();
    triangles
}

#[neurotess_testing::test]
fn integers_and_triangles_come_back() {
    let (triangles, positions) = ring();
    let count = positions.len() / 3;
    let number: Vec<u32> = (0..count as u32).map(|v| v * 51_130_563).collect();
    let id: Vec<u16> = (0..count as u16).map(|v| v * 780).collect();
    let kind: Vec<u8> = (0..count as u8).map(|v| v % 5).collect();
    let signed: Vec<i32> = positions.iter().map(|p| (p * 1e5) as i32).collect();
    let generic = |values| Attribute {
        kind: AttributeKind::Generic,
        components: 1,
        values,
        quantization: None,
    };
    let encoded = encode(
        &triangles,
        &[
            generic(Values::U16(&id)),
            Attribute {
                kind: AttributeKind::Position,
                components: 3,
                ..generic(Values::I32(&signed))
            },
            generic(Values::U8(&kind)),
            generic(Values::U32(&number)),
        ],
    )
    .expect("encoded");
    let found = decode(&encoded.bytes).expect("decoded");
    assert_eq!((encoded.vertices, encoded.faces), (count, triangles.len()));
    assert_eq!(
        (found.vertices, found.triangles.len()),
        (count, triangles.len())
    );
    let [ids, places, kinds, own] = encoded.attribute_ids[..] else {
        panic!("four attributes");
    };
    let old: Vec<usize> = numbers(&found, ids)
        .iter()
        .map(|id| *id as usize / 780)
        .collect();
    for (new, &old) in old.iter().enumerate() {
        assert_eq!(numbers(&found, kinds)[new], f64::from(kind[old]));
        assert_eq!(numbers(&found, own)[new], f64::from(number[old]));
        let place = signed[3 * old..3 * old + 3].iter().map(|&p| f64::from(p));
        assert!(
            place.eq(numbers(&found, places)[3 * new..3 * new + 3]
                .iter()
                .copied())
        );
    }
    let renumbered = found
        .triangles
        .iter()
        .map(|t| t.map(|corner| old[corner as usize] as u32));
    assert_eq!(sorted(renumbered.collect()), sorted(triangles));
}

#[neurotess_testing::test]
fn rounded_floats_are_near_and_the_surface_is_closed() {
    let (triangles, positions) = ring();
    let normals: Vec<f32> = positions.iter().map(|_| 1.0 / 3_f32.sqrt()).collect();
    let float = |kind, values, bits| Attribute {
        kind,
        components: 3,
        values: Values::F32(values),
        quantization: Some(bits),
    };
    let encoded = encode(
        &triangles,
        &[
            float(AttributeKind::Position, &positions, 16),
            float(AttributeKind::Normal, &normals, 10),
        ],
    )
    .expect("encoded");
    let found = decode(&encoded.bytes).expect("decoded");
    let step = 50.0 / 65_535.0;
    for new in numbers(&found, encoded.attribute_ids[0]).as_chunks::<3>().0 {
        let near =
            |old: &[f32; 3]| (0..3).all(|i| (f64::from(old[i]) - new[i]).abs() < 0.51 * step);
        assert!(positions.as_chunks::<3>().0.iter().any(near), "{new:?}");
    }
    let mut edges = BTreeMap::new();
    for [a, b, c] in found.triangles {
        for edge in [(a, b), (b, c), (c, a)] {
            *edges.entry(edge).or_insert(0) += 1;
        }
    }
    let paired =
        |(&(from, to), &count): (&(u32, u32), &i32)| count == 1 && edges.contains_key(&(to, from));
    assert!(edges.iter().all(paired));
}

#[neurotess_testing::test]
fn what_does_not_fit_together_is_refused() {
    let (triangles, positions) = ring();
    let place = Attribute {
        kind: AttributeKind::Position,
        components: 3,
        values: Values::F32(&positions),
        quantization: Some(14),
    };
    let error = |triangles: &[[u32; 3]], attributes: &[Attribute<'_>]| {
        encode(triangles, attributes)
            .expect_err("refused")
            .to_string()
    };
    assert_eq!(error(&[], &[place]), "the mesh has no triangles");
    assert_eq!(
        error(&[[0, 1, 84]], &[place]),
        "triangle 0 has vertex 84, there are 84"
    );
    let short = Attribute {
        kind: AttributeKind::Generic,
        components: 1,
        values: Values::U8(&[1, 2]),
        quantization: None,
    };
    assert_eq!(
        error(&triangles, &[place, short]),
        "attribute 1 has 2 numbers, 84 are needed"
    );
    assert!(error(&triangles, &[]).contains("there is none of positions"));
    let lost = [f32::NAN; 252];
    let lost = Attribute {
        values: Values::F32(&lost),
        ..place
    };
    assert!(error(&triangles, &[lost]).contains("not finite"));
}

#[neurotess_testing::test]
fn streams_that_are_cut_off_are_errors() {
    let (triangles, positions) = ring();
    let place = Attribute {
        kind: AttributeKind::Position,
        components: 3,
        values: Values::F32(&positions),
        quantization: Some(14),
    };
    let bytes = encode(&triangles, &[place]).expect("encoded").bytes;
    for length in (0..bytes.len()).step_by(7) {
        assert!(decode(&bytes[..length]).is_err(), "{length}");
    }
}
