//! One soma that is written once for each of its neurites, and neurites that begin within a soma and hang on nothing.

use std::collections::BTreeMap;

use glam::DVec3;

use super::notes::Notes;
use super::somata::Somata;
use super::tree::NONE;
use super::{Node, Oddity};
use crate::{Soma, SomaKind, SomaSample, SomaShape};

/// Two somata whose centers are nearer than this share of the larger radius are one: no two cells share so much.
const ONE_SOMA: f64 = 0.5;
/// Share of its distance from the center by which a root must be within a soma that is no sphere.
const ON_SURFACE: f64 = 1e-3;
/// Trees of type 1 whose length is more than this many of their greatest radii are neurites: somata that were traced
/// along their branches have up to some 10, whole cells hundreds.
const LONG_TREE: f64 = 30.0;
/// Somata that others are compared with: a file with more has others than neurons.
const MAX_SOMATA: usize = 64;

impl Somata {
    /// Somata in the same place become one: the first, that is the thickest.
    pub(super) fn merge_coincident(&mut self, nodes: &[Node], notes: &mut Notes) {
        if self.members.len() < 2 {
            return;
        }
        let thickest = |members: &[u32]| {
            let sample = |&member: &u32| &nodes[member as usize];
            let thicker = |a: &&Node, b: &&Node| a.radius.total_cmp(&b.radius);
            members.iter().map(sample).max_by(thicker)
        };
        let mut kept: Vec<Vec<u32>> = Vec::with_capacity(self.members.len());
        for members in std::mem::take(&mut self.members) {
            let Some(own) = thickest(&members) else {
                continue;
            };
            let is_same = |other: &Vec<u32>| {
                thickest(other).is_some_and(|other| {
                    let reach = ONE_SOMA * own.radius.max(other.radius);
                    own.position.distance(other.position) < reach
                })
            };
            let same = kept.iter().take(MAX_SOMATA).position(is_same);
            match same {
                None => {
                    for &member in &members {
                        self.set_soma(member, kept.len() as u32);
                    }
                    kept.push(members);
                }
                Some(soma) => {
                    notes.add_many(Oddity::CoincidentSomata, members[0], 1);
                    for member in members {
                        let place = nodes[member as usize].position;
                        let nearest = (0_u32..).zip(&kept[soma]).min_by(|(_, a), (_, b)| {
                            let far = |node: &u32| nodes[*node as usize].position.distance(place);
                            far(a).total_cmp(&far(b))
                        });
                        let sample = nearest.map_or(0, |(sample, _)| sample);
                        self.set_soma(member, soma as u32);
                        self.set_sample(member, sample);
                    }
                }
            }
        }
        self.members = kept;
    }
}

/// Trees of type 1 alone that run on as neurites do are neurites: some programs write indices of regions as types.
pub(super) fn neurites_of_type_1(
    somata: &mut Somata,
    nodes: &[Node],
    parents: &[u32],
    notes: &mut Notes,
) {
    let is_neurite = |members: &[u32]| {
        let soma = traced(members, nodes, parents, DVec3::ZERO);
        soma.kind == SomaKind::Cylinders && is_long(&soma) && SomaShape::of(&soma).is_like_neurite()
    };
    let of_neurites = somata.members.iter().filter(|members| is_neurite(members));
    let first = of_neurites.map(|members| (members[0], members.len() as u64));
    let Some((first, count)) = first.reduce(|(a, m), (b, n)| (a.min(b), m + n)) else {
        return;
    };
    notes.add_many(Oddity::AllSoma, first, count);
    somata.retain(|members| !is_neurite(members));
}

fn is_long(soma: &Soma) -> bool {
    let samples = &soma.samples;
    let link = |sample: &SomaSample| {
        Some(
            sample
                .position
                .distance(samples[sample.parent? as usize].position),
        )
    };
    let length: f32 = samples.iter().filter_map(link).sum();
    let thickest = samples
        .iter()
        .map(|sample| sample.radius)
        .fold(0.0, f32::max);
    f64::from(length) > LONG_TREE * f64::from(thickest)
}

/// The soma of some nodes, relative to an origin.
fn traced(members: &[u32], nodes: &[Node], parents: &[u32], origin: DVec3) -> Soma {
    let place: BTreeMap<u32, u32> = members.iter().copied().zip(0..).collect();
    let sample = |&member: &u32| {
        let node = &nodes[member as usize];
        SomaSample {
            id: node.id,
            position: (node.position - origin).as_vec3(),
            radius: node.radius as f32,
            parent: place.get(&parents[member as usize]).copied(),
        }
    };
    Soma::from_samples(members.iter().map(sample).collect())
}

/// Roots of neurites that lie within a soma, each with the sample that it hangs on.
#[derive(Default)]
pub(super) struct RootsInSomata(Vec<(u32, u32)>);

impl RootsInSomata {
    /// Those of nodes whose links are those of trees that hang up by their somata.
    pub(super) fn find(
        nodes: &[Node],
        parents: &[u32],
        somata: &Somata,
        notes: &mut Notes,
    ) -> Self {
        let is_root = |&(index, &parent): &(u32, &u32)| parent == NONE && somata.of(index) == NONE;
        let mut roots = (0_u32..).zip(parents).filter(is_root).peekable();
        let mut found = Vec::new();
        if roots.peek().is_none() {
            return Self(found);
        }
        let balls = balls(nodes, somata);
        let bodies = bodies(nodes, parents, somata);
        for (index, _) in roots {
            let place = nodes[index as usize].position;
            let in_ball = |&&member: &&u32| {
                let ball = &nodes[member as usize];
                place.distance(ball.position) <= ball.radius
            };
            let ball = balls.iter().find(in_ball).copied();
            let member = ball.or_else(|| {
                let body = bodies.iter().find(|body| body.holds(place))?;
                let far = |&member: &u32| nodes[member as usize].position.distance(place);
                let nearest = body.members.iter();
                nearest.copied().min_by(|a, b| far(a).total_cmp(&far(b)))
            });
            if let Some(member) = member {
                notes.add(Oddity::RootInSoma, index);
                found.push((index, member));
            }
        }
        Self(found)
    }

    /// The soma's node that a root hangs on.
    pub(super) fn member(&self, root: u32) -> Option<u32> {
        let place = self.0.binary_search_by_key(&root, |&(root, _)| root);
        place.ok().map(|place| self.0[place].1)
    }
}

/// Samples whose balls are parts of somata: of three points the first, which is the sphere.
fn balls(nodes: &[Node], somata: &Somata) -> Vec<u32> {
    let spheres = |members: &'_ Vec<u32>| match members.len() {
        3 => members[..1].to_vec(),
        _ => members.clone(),
    };
    let members = somata.members.iter().take(MAX_SOMATA).flat_map(spheres);
    let members = members.filter(|&member| nodes[member as usize].radius > 0.0);
    members.take(MAX_SOMATA).collect()
}

/// A soma that is no sphere.
struct Body<'a> {
    center: DVec3,
    shape: SomaShape,
    members: &'a [u32],
}

impl Body<'_> {
    /// Whether a place is within, and not but on the surface: files are rounded.
    fn holds(&self, place: DVec3) -> bool {
        let off = place - self.center;
        let surface = self.shape.distance(off.try_normalize().unwrap_or(DVec3::Y));
        off.length() < (1.0 - ON_SURFACE) * surface
    }
}

fn bodies<'a>(nodes: &[Node], parents: &[u32], somata: &'a Somata) -> Vec<Body<'a>> {
    let body = |members: &'a Vec<u32>| {
        let origin = nodes[*members.first()? as usize].position;
        let shape = SomaShape::of(&traced(members, nodes, parents, origin));
        (!shape.is_sphere()).then(|| Body {
            center: origin + shape.center(),
            shape,
            members,
        })
    };
    somata
        .members
        .iter()
        .take(MAX_SOMATA)
        .filter_map(body)
        .collect()
}
