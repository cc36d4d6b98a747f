//! The way between two points along the tree.
//!
//! The point where two ways part is found by heavy paths (Sleator, Tarjan, A data structure for dynamic
//! trees, 1983): n steps of preparation, log n for each question, whatever the tree.

use crate::tracing::NONE;

/// Where a tree leaves its soma.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Origin {
    pub(super) soma: u32,
    /// Way (µm) from the soma's sphere to the root.
    pub(super) way: f64,
}

/// A place on a segment, which is named by its lower end.
#[derive(Clone, Copy, Debug)]
pub(super) struct OnSegment {
    pub(super) segment: u32,
    /// Way (µm) from the root.
    pub(super) arc: f64,
}

/// The way between two places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Way {
    /// µm.
    pub(super) length: f64,
    /// The fork that it leads over, if it leads down two branches.
    pub(super) fork: Option<u32>,
}

/// Ways along a forest whose parents come before their children.
#[derive(Debug, Default)]
pub(super) struct Paths {
    parent: Vec<u32>,
    /// Way (µm) from the root.
    arc: Vec<f64>,
    /// First point of each point's heavy path.
    head: Vec<u32>,
    /// Where each point's tree leaves its soma.
    origin: Vec<Option<Origin>>,
}

impl Paths {
    /// `length`: that of the segment above each point (µm). `origin`: for roots that hang on a soma.
    pub(super) fn new(
        parent: Vec<u32>,
        length: &[f64],
        origin: impl Fn(u32) -> Option<Origin>,
    ) -> Self {
        let count = parent.len() as u32;
        let heavy = heavy_children(&parent);
        let mut paths = Self {
            parent,
            arc: length.to_vec(),
            head: (0..count).collect(),
            origin: vec![None; count as usize],
        };
        for point in 0..count {
            let (here, above) = (point as usize, paths.parent[point as usize]);
            if above == NONE {
                paths.arc[here] = 0.0;
                paths.origin[here] = origin(point);
                continue;
            }
            paths.arc[here] += paths.arc[above as usize];
            paths.origin[here] = paths.origin[above as usize];
            if heavy[above as usize] == point {
                paths.head[here] = paths.head[above as usize];
            }
        }
        paths
    }

    /// Way (µm) from the root.
    pub(super) fn arc(&self, point: u32) -> f64 {
        self.arc[point as usize]
    }

    /// Where the tree of a point leaves its soma.
    pub(super) fn origin(&self, point: u32) -> Option<Origin> {
        self.origin[point as usize]
    }

    /// The way between two places; over the soma, counted from where each leaves the sphere, for two
    /// neurites of one; none in trees that have nothing in common.
    pub(super) fn way(&self, a: OnSegment, b: OnSegment) -> Option<Way> {
        let Some(parting) = self.parting(a.segment, b.segment) else {
            let (from_a, from_b) = (self.origin(a.segment)?, self.origin(b.segment)?);
            let length = from_a.way + a.arc + from_b.way + b.arc;
            return (from_a.soma == from_b.soma).then_some(Way { length, fork: None });
        };
        if parting == a.segment || parting == b.segment {
            let length = (a.arc - b.arc).abs();
            return Some(Way { length, fork: None });
        }
        Some(Way {
            length: a.arc + b.arc - 2.0 * self.arc(parting),
            fork: Some(parting),
        })
    }

    /// The lowest point that is both or above both; none in different trees.
    fn parting(&self, mut a: u32, mut b: u32) -> Option<u32> {
        loop {
            let (head_a, head_b) = (self.head[a as usize], self.head[b as usize]);
            if head_a == head_b {
                return Some(a.min(b));
            }
            // Parents come before children, so the path that begins later holds no point above the other.
            let left = if head_a > head_b { &mut a } else { &mut b };
            *left = self.parent[head_a.max(head_b) as usize];
            if *left == NONE {
                return None;
            }
        }
    }
}

/// The child of each point that has most points below it; [`NONE`] at ends.
fn heavy_children(parent: &[u32]) -> Vec<u32> {
    let mut size = vec![1_u32; parent.len()];
    let mut heavy = vec![NONE; parent.len()];
    for (point, &above) in parent.iter().enumerate().rev() {
        if above != NONE {
            size[above as usize] += size[point];
            let most = &mut heavy[above as usize];
            if *most == NONE || size[*most as usize] <= size[point] {
                *most = point as u32;
            }
        }
    }
    heavy
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Root first.
    fn ancestors(parent: &[u32], mut point: u32) -> Vec<u32> {
        let mut list = vec![point];
        while parent[point as usize] != NONE {
            point = parent[point as usize];
            list.push(point);
        }
        list.reverse();
        list
    }

    fn forest() -> impl Strategy<Value = Vec<u32>> {
        prop::collection::vec(any::<u32>(), 1..60).prop_map(|draws| {
            let parent = |(i, draw): (usize, u32)| match i as u32 {
                0 => NONE,
                _ if draw % 16 == 0 => NONE,
                i => i - 1 - (draw / 16) % i.min(3),
            };
            draws.into_iter().enumerate().map(parent).collect()
        })
    }

    proptest! {
        #[test]
        fn ways_part_where_lists_of_ancestors_do(parent in forest(), a: u32, b: u32) {
            let count = parent.len() as u32;
            let (a, b) = (a % count, b % count);
            let paths = Paths::new(parent.clone(), &vec![1.0; parent.len()], |_| None);
            let (above_a, above_b) = (ancestors(&parent, a), ancestors(&parent, b));
            let common = above_a.iter().zip(&above_b).take_while(|(a, b)| a == b).last();
            prop_assert_eq!(paths.parting(a, b), common.map(|(at, _)| *at));
            prop_assert_eq!(paths.arc(a), above_a.len() as f64 - 1.0);
        }
    }

    #[test]
    fn neurites_of_one_soma_are_joined_by_it() {
        let origin = |root: u32| {
            (root < 4).then_some(Origin {
                soma: root / 3,
                way: 0.5,
            })
        };
        let paths = Paths::new(
            vec![NONE, 0, NONE, NONE, NONE],
            &[0.0, 2.0, 0.0, 0.0, 0.0],
            origin,
        );
        let at = |segment: u32| OnSegment {
            segment,
            arc: paths.arc(segment),
        };
        let way = Way {
            length: 3.0,
            fork: None,
        };
        assert_eq!(paths.way(at(1), at(2)), Some(way));
        assert_eq!(paths.way(at(1), at(3)), None);
        assert_eq!(paths.way(at(1), at(4)), None);
    }
}
