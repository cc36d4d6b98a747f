use super::*;
use crate::{NeuriteKind, Node};

/// A soma at (0, 0); to the right a dendrite that forks at (10, 0), and whose upper branch
/// forks at (10, 10); to the left an axon; and a free tree.
///
/// ```text
///                    6 ○──○ 7 (20, 10)
///   3 ○─○ 2   ● 1  4 ○─○ 5─○ 8 (22, 0)
/// ```
fn cell() -> Morphology {
    let row = |id: i64, kind: i32, x: f64, y: f64, radius: f64, parent: Option<u32>| Node {
        id,
        kind: NeuriteKind(kind),
        position: DVec3::new(x, y, 0.0),
        radius,
        parent,
        section: None,
    };
    let nodes = [
        row(1, 1, 0.0, 0.0, 3.0, None),
        row(2, 2, -4.0, 0.0, 1.0, Some(0)),
        row(3, 2, -4.0, -6.0, 0.5, Some(1)),
        row(4, 3, 5.0, 0.0, 2.0, Some(0)),
        row(5, 3, 10.0, 0.0, 1.0, Some(3)),
        row(6, 3, 10.0, 10.0, 0.5, Some(4)),
        row(7, 3, 20.0, 10.0, 0.5, Some(5)),
        row(8, 3, 22.0, 0.0, 0.25, Some(4)),
        row(9, 3, 10.0, 15.0, 0.5, Some(5)),
        row(10, 3, 50.0, 0.0, 0.5, None),
        row(11, 3, 53.0, 4.0, 0.5, Some(9)),
    ];
    let built = Morphology::from_nodes("cell", Vec::new(), &nodes);
    built.expect("built").morphology
}

fn sample(cell: &Morphology, id: i64) -> Location {
    Location::of_sample(cell, id).expect("there")
}

fn path(cell: &Morphology, a: i64, b: i64) -> Option<Path> {
    Path::between(cell, sample(cell, a), sample(cell, b))
}

#[test]
fn paths_go_through_the_common_ancestor() {
    let cell = cell();
    let there = path(&cell, 7, 8).expect("one tree");
    assert_eq!((there.length, there.soma_length), (32.0, 0.0));
    assert_eq!(there.straight, 104_f64.sqrt());
    assert_eq!(there.forks.len(), 2);
    assert_eq!(there.tortuosity(), Some(32.0 / 104_f64.sqrt()));
    let back = path(&cell, 8, 7).expect("one tree");
    let mut reversed = back.locations.clone();
    reversed.reverse();
    assert_eq!((back.length, reversed), (there.length, there.locations));
    // Down one branch; the fork at its end is not passed.
    let down = path(&cell, 4, 6).expect("one tree");
    assert_eq!((down.length, down.forks.len()), (15.0, 1));
    assert_eq!(path(&cell, 5, 6).map(|p| p.forks.len()), Some(0));
}

#[test]
fn between_neurites_the_somas_center_counts() {
    let cell = cell();
    let there = path(&cell, 3, 8).expect("one soma");
    assert_eq!(
        (there.length, there.soma_length),
        (6.0 + 4.0 + 5.0 + 17.0, 9.0)
    );
    assert_eq!((there.straight, there.forks.len()), (26_f64.hypot(6.0), 1));
    let soma = path(&cell, 1, 6).expect("one soma");
    assert_eq!((soma.length, soma.soma_length), (20.0, 5.0));
    assert_eq!(path(&cell, 6, 1).map(|p| p.length), Some(20.0));
    assert_eq!(path(&cell, 3, 10), None, "a free tree");
    assert_eq!(path(&cell, 1, 10), None);
    assert_eq!(path(&cell, 10, 11).map(|p| p.length), Some(5.0));
}

#[test]
fn ends_may_be_on_links() {
    let cell = cell();
    let on = |id: i64, fraction: f64| match sample(&cell, id) {
        Location::Neurite { point, .. } => Location::Neurite { point, fraction },
        soma @ Location::Soma(_) => soma,
    };
    let length = |a, b| Path::between(&cell, a, b).map(|p| p.length);
    assert_eq!(length(on(8, 0.25), on(8, 0.75)), Some(6.0));
    // On the link above an end, below it, and beside it.
    assert_eq!(length(on(5, 0.6), on(8, 0.5)), Some(2.0 + 6.0));
    assert_eq!(length(on(8, 0.5), on(5, 0.6)), Some(2.0 + 6.0));
    assert_eq!(length(on(7, 0.5), on(9, 1.0)), Some(5.0 + 5.0));
    assert_eq!(length(on(2, 0.3), on(1, 0.0)), Some(4.0), "a first point");
    // The start of a link is the fork that it leaves.
    let start = Path::between(&cell, on(8, 0.0), on(6, 0.0)).expect("one tree");
    assert_eq!((start.length, start.locations.len()), (0.0, 1));
    assert_eq!((start.tortuosity(), start.forks.len()), (None, 0));
    assert_eq!(on(5, 0.5).radius(&cell), 1.5);
    assert_eq!(on(8, 0.0).radius(&cell), 1.0, "begins with the fork's");
    assert_eq!(on(1, 0.0).radius(&cell), 3.0);
    assert_eq!(on(5, 0.5).position(&cell), DVec3::new(7.5, 0.0, 0.0));
    assert!(!Location::of_point(99).is_on(&cell) && !on(5, f64::NAN).is_on(&cell));
}

#[test]
fn distances_of_all_points_are_those_of_their_paths() {
    let cell = cell();
    let mut starts: Vec<Location> = [1, 2, 3, 5, 7, 8, 11].map(|id| sample(&cell, id)).into();
    let point = cell.points.len() as u32 - 3;
    starts.push(Location::Neurite {
        point,
        fraction: 0.3,
    });
    for start in starts {
        let all = path_distances(&cell, start);
        for (point, distance) in (0..).zip(all) {
            let path = Path::between(&cell, start, Location::of_point(point));
            let near = |(a, b): (f64, f64)| (a - b).abs() < 1e-9;
            let length = path.map(|p| p.length);
            assert_eq!(length.is_some(), distance.is_some(), "{start:?} {point}");
            assert!(length.zip(distance).is_none_or(near), "{start:?} {point}");
        }
    }
}
