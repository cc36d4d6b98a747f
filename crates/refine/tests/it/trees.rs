//! Random trees. Those of the renderer's tests are the same.

use glam::{Vec3, vec3};
use neurotess_morphology::{
    Attachment, Morphology, NeuriteKind, Point, Section, SectionId, Soma, SomaKind, SomaSample,
};

/// A recipe for a section: parent (an index into what exists, or a root), points, wildness.
#[derive(Clone, Debug)]
pub(crate) struct Twig {
    pub(crate) parent: usize,
    pub(crate) seed: u64,
    pub(crate) points: usize,
    /// Length of a step against the radius: from buried in itself to far apart.
    pub(crate) step: f32,
    pub(crate) wild: f32,
    pub(crate) radius: f32,
}

/// Splitmix64, in [-1, 1].
fn random(state: &mut u64) -> f32 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 40) as f32 / (1 << 23) as f32 - 1.0
}

fn direction(state: &mut u64) -> Vec3 {
    vec3(random(state), random(state), random(state)).normalize_or(Vec3::X)
}

/// Grows a tree from recipes; `soma`: its radius, or none.
pub(crate) fn grow(twigs: &[Twig], soma: Option<f32>) -> Morphology {
    let mut m = Morphology {
        name: "random".into(),
        ..Morphology::default()
    };
    if let Some(radius) = soma {
        let sample = SomaSample {
            id: 1,
            position: Vec3::ZERO,
            radius,
            parent: None,
        };
        let samples = vec![sample];
        m.somata.push(Soma {
            kind: SomaKind::Point,
            samples,
            center: Vec3::ZERO,
            radius,
        });
    }
    // Sections must stand depth first: gather children first.
    let parent = |i: usize| {
        (i > 0)
            .then(|| twigs[i].parent % (i + 1))
            .filter(|&p| p < i)
    };
    let mut stack: Vec<(usize, Attachment, Vec3)> = Vec::new();
    for i in (0..twigs.len()).rev().filter(|&i| parent(i).is_none()) {
        let mut state = twigs[i].seed;
        let start = direction(&mut state) * soma.unwrap_or(1.0) * (0.5 + twigs[i].wild);
        let root = if soma.is_some() {
            Attachment::Soma { soma: 0, sample: 0 }
        } else {
            Attachment::Free
        };
        stack.push((i, root, start));
    }
    while let Some((i, attachment, start)) = stack.pop() {
        let twig = &twigs[i];
        let mut state = twig.seed ^ 0xabcd;
        let mut heading = direction(&mut state);
        let mut at = start;
        let first = m.points.len() as u32;
        for _ in 0..twig.points.max(1) {
            heading = (heading + direction(&mut state) * twig.wild).normalize_or(Vec3::X);
            at += heading * twig.step * twig.radius;
            let radius = twig.radius * (1.0 + 0.5 * random(&mut state));
            m.sample_ids.push(m.points.len() as i64 + 2);
            m.points.push(Point {
                position: at,
                radius,
            });
        }
        let id = SectionId(m.sections.len() as u32);
        let end = m.points.len() as u32;
        m.sections.push(Section {
            kind: NeuriteKind(3),
            attachment,
            first,
            end,
        });
        for child in (i + 1..twigs.len()).rev().filter(|&c| parent(c) == Some(i)) {
            stack.push((child, Attachment::Section(id), at));
        }
    }
    m
}
