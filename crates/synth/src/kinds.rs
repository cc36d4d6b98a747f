//! The numbers of each kind. By eye, after the cells that `benchmarks/synthetic.md` compares with and
//! what textbooks draw; none is fitted.

use glam::DVec3;
use neurotess_morphology::NeuriteKind;

use crate::Kind;
use crate::spec::{Spec, Tree, Tropism, Trunk};

/// Cosine of the greatest angle for "to all sides".
const ALL_SIDES: f64 = -1.0;

pub(crate) fn spec(kind: Kind) -> Spec {
    match kind {
        Kind::Pyramidal => pyramidal(),
        Kind::Purkinje => purkinje(),
        Kind::Granule => granule(),
        Kind::Basket => basket(),
        Kind::Motor => motor(),
        Kind::Star => star(),
    }
}

/// A dendrite to all sides; kinds change what is special about theirs.
fn dendrite() -> Tree {
    Tree {
        kind: NeuriteKind::BASAL_DENDRITE,
        share: 0.5,
        stems: (4, 7),
        aim: (DVec3::Y, ALL_SIDES),
        radius: 1.0,
        thinnest: 0.25,
        taper: 300.0,
        section: 40.0,
        terminal: 100.0,
        split: (0.25, 0.5),
        angle: (0.9, 1.4),
        tropism: Tropism::Away(0.004),
        wobble: 0.36,
        trunk: None,
        flat: false,
    }
}

/// An axon downwards that starts thin and hardly tapers.
fn axon() -> Tree {
    Tree {
        kind: NeuriteKind::AXON,
        stems: (1, 1),
        aim: (DVec3::NEG_Y, 0.95),
        radius: 0.45,
        thinnest: 0.15,
        taper: 200.0,
        section: 60.0,
        terminal: 120.0,
        split: (0.15, 0.5),
        angle: (0.95, 1.4),
        tropism: Tropism::Away(0.001),
        wobble: 0.42,
        ..dendrite()
    }
}

fn pyramidal() -> Spec {
    let apical = Tree {
        kind: NeuriteKind::APICAL_DENDRITE,
        share: 0.28,
        stems: (1, 1),
        aim: (DVec3::Y, 0.99),
        radius: 2.2,
        taper: 500.0,
        section: 55.0,
        terminal: 110.0,
        tropism: Tropism::To(DVec3::Y, 0.004),
        trunk: Some(Trunk {
            sides: 7.0,
            share: 0.45,
            section: 40.0,
            tee: false,
        }),
        ..dendrite()
    };
    let basal = Tree {
        share: 0.27,
        aim: (DVec3::NEG_Y, -0.3),
        radius: 1.2,
        ..dendrite()
    };
    let axon = Tree {
        share: 0.45,
        tropism: Tropism::To(DVec3::NEG_Y, 0.001),
        trunk: Some(Trunk {
            sides: 5.0,
            share: 0.6,
            section: 60.0,
            tee: false,
        }),
        ..axon()
    };
    Spec {
        points: 4000,
        spacing: 3.0,
        soma_radius: (6.5, 9.5),
        three_point: true,
        trees: vec![apical, basal, axon],
    }
}

fn purkinje() -> Spec {
    let fan = Tree {
        share: 0.85,
        stems: (1, 2),
        aim: (DVec3::Y, 0.8),
        radius: 2.8,
        thinnest: 0.4,
        taper: 150.0,
        section: 16.0,
        terminal: 26.0,
        split: (0.15, 0.5),
        tropism: Tropism::Away(0.008),
        wobble: 0.45,
        flat: true,
        ..dendrite()
    };
    let axon = Tree {
        share: 0.15,
        section: 120.0,
        terminal: 200.0,
        ..axon()
    };
    Spec {
        points: 6000,
        spacing: 1.8,
        soma_radius: (9.5, 12.5),
        three_point: false,
        trees: vec![fan, axon],
    }
}

fn granule() -> Spec {
    let claws = Tree {
        share: 0.15,
        stems: (3, 5),
        radius: 0.5,
        section: 14.0,
        terminal: 18.0,
        wobble: 0.45,
        ..dendrite()
    };
    let axon = Tree {
        share: 0.85,
        aim: (DVec3::Y, 0.9),
        radius: 0.25,
        thinnest: 0.1,
        section: 700.0,
        terminal: 1500.0,
        tropism: Tropism::Away(0.0),
        wobble: 0.28,
        trunk: Some(Trunk {
            sides: 0.0,
            share: 0.0,
            section: 300.0,
            tee: true,
        }),
        ..axon()
    };
    Spec {
        points: 800,
        spacing: 2.5,
        soma_radius: (2.6, 3.6),
        three_point: false,
        trees: vec![claws, axon],
    }
}

fn basket() -> Spec {
    let dendrites = Tree {
        share: 0.3,
        ..dendrite()
    };
    let axon = Tree {
        share: 0.7,
        section: 40.0,
        terminal: 80.0,
        wobble: 0.44,
        ..axon()
    };
    Spec {
        points: 3500,
        spacing: 2.5,
        soma_radius: (6.0, 8.5),
        three_point: false,
        trees: vec![dendrites, axon],
    }
}

fn motor() -> Spec {
    let dendrites = Tree {
        share: 0.88,
        stems: (8, 12),
        radius: 3.6,
        thinnest: 0.35,
        taper: 900.0,
        section: 130.0,
        terminal: 330.0,
        angle: (0.9, 1.2),
        tropism: Tropism::Away(0.002),
        wobble: 0.28,
        ..dendrite()
    };
    let axon = Tree {
        share: 0.12,
        radius: 1.6,
        thinnest: 0.8,
        section: 300.0,
        terminal: 600.0,
        trunk: Some(Trunk {
            sides: 3.0,
            share: 0.3,
            section: 150.0,
            tee: false,
        }),
        ..axon()
    };
    Spec {
        points: 8000,
        spacing: 4.5,
        soma_radius: (20.0, 28.0),
        three_point: true,
        trees: vec![dendrites, axon],
    }
}

fn star() -> Spec {
    let dendrites = Tree {
        stems: (5, 8),
        radius: 0.8,
        section: 30.0,
        terminal: 70.0,
        wobble: 0.42,
        ..dendrite()
    };
    let axon = Tree {
        section: 35.0,
        terminal: 70.0,
        wobble: 0.44,
        ..axon()
    };
    Spec {
        points: 2000,
        spacing: 2.0,
        soma_radius: (4.5, 6.5),
        three_point: false,
        trees: vec![dendrites, axon],
    }
}
