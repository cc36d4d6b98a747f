//! The nearest sphere of another piece: a tree of boxes (Bentley, Multidimensional Binary Search Trees Used for
//! Associative Searching, 1975), in which a box knows whether all that it holds is of one piece.

use glam::DVec3;

/// Spheres of a box that is not divided.
const LEAF: usize = 8;
/// The label of a box whose spheres are of several pieces.
const MIXED: u32 = u32::MAX;

/// A sphere (µm), and the node that it stands for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    pub(super) center: DVec3,
    pub(super) radius: f64,
    pub(super) node: usize,
}

pub(super) struct Nearest {
    balls: Vec<Ball>,
    /// The piece of each sphere.
    pieces: Vec<u32>,
    /// A box stands before those that it is divided into.
    boxes: Vec<Region>,
}

/// A box and the spheres in it.
struct Region {
    min: DVec3,
    max: DVec3,
    /// The largest radius of its spheres.
    radius: f64,
    first: usize,
    end: usize,
    /// The two boxes within it, if it is divided.
    inner: Option<[usize; 2]>,
    /// The piece of all its spheres, or [`MIXED`].
    piece: u32,
}

impl Nearest {
    pub(super) fn new(balls: Vec<Ball>) -> Self {
        let mut nearest = Self {
            pieces: vec![MIXED; balls.len()],
            balls,
            boxes: Vec::new(),
        };
        if !nearest.balls.is_empty() {
            nearest.divide(0, nearest.balls.len());
        }
        nearest
    }

    /// Adds the box of some spheres, and those within it; halving makes them few dozen deep at most.
    fn divide(&mut self, first: usize, end: usize) -> usize {
        let balls = &mut self.balls[first..end];
        let centers = balls.iter().map(|ball| ball.center);
        let (min, max) = centers.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), c| {
            (min.min(c), max.max(c))
        });
        let number = self.boxes.len();
        self.boxes.push(Region {
            min,
            max,
            radius: balls.iter().map(|ball| ball.radius).fold(0.0, f64::max),
            first,
            end,
            inner: None,
            piece: MIXED,
        });
        if balls.len() > LEAF {
            let axis = widest(max - min);
            let middle = balls.len() / 2;
            let by_axis = |a: &Ball, b: &Ball| a.center[axis].total_cmp(&b.center[axis]);
            balls.select_nth_unstable_by(middle, by_axis);
            let low = self.divide(first, first + middle);
            let high = self.divide(first + middle, end);
            self.boxes[number].inner = Some([low, high]);
        }
        number
    }

    /// Takes over the piece of each node.
    pub(super) fn label(&mut self, piece_of_node: &[u32]) {
        for (piece, ball) in self.pieces.iter_mut().zip(&self.balls) {
            *piece = piece_of_node[ball.node];
        }
        for number in (0..self.boxes.len()).rev() {
            let here = &self.boxes[number];
            let same = |a: u32, b: u32| if a == b { a } else { MIXED };
            self.boxes[number].piece = match here.inner {
                Some([low, high]) => same(self.boxes[low].piece, self.boxes[high].piece),
                None => {
                    let pieces = &self.pieces[here.first..here.end];
                    pieces.iter().copied().reduce(same).unwrap_or(MIXED)
                }
            };
        }
    }

    /// The node of another piece that is nearest to a place, and its distance (µm): less than `limit`, or as
    /// much if `inclusive`.
    pub(super) fn of_another(
        &self,
        place: DVec3,
        own: u32,
        limit: f64,
        inclusive: bool,
    ) -> Option<(usize, f64)> {
        let mut found = None;
        let mut limit = limit;
        let beyond = |way: f64, limit: f64, found: bool| match inclusive && !found {
            true => way > limit,
            false => way >= limit,
        };
        let mut stack = if self.boxes.is_empty() {
            vec![]
        } else {
            vec![0]
        };
        while let Some(number) = stack.pop() {
            let here = &self.boxes[number];
            let way = here.distance(place);
            if here.piece == own || beyond(way, limit, found.is_some()) {
                continue;
            }
            if let Some([low, high]) = here.inner {
                let [a, b] = [low, high].map(|inner| self.boxes[inner].distance(place));
                // The nearer one comes first.
                stack.extend(if a <= b { [high, low] } else { [low, high] });
                continue;
            }
            for i in here.first..here.end {
                let ball = &self.balls[i];
                let way = (place.distance(ball.center) - ball.radius).max(0.0);
                if self.pieces[i] != own && !beyond(way, limit, found.is_some()) {
                    found = Some(ball.node);
                    limit = way;
                }
            }
        }
        found.map(|node| (node, limit))
    }
}

impl Region {
    /// No sphere of the box is nearer.
    fn distance(&self, place: DVec3) -> f64 {
        let nearest = place.clamp(self.min, self.max);
        (place.distance(nearest) - self.radius).max(0.0)
    }
}

fn widest(size: DVec3) -> usize {
    let [x, y, z] = size.to_array();
    match () {
        () if x >= y && x >= z => 0,
        () if y >= z => 1,
        () => 2,
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn ball() -> impl Strategy<Value = (Ball, u32)> {
        (prop::array::uniform3(-9.0..9.0), 0.0..2.0, 0..4_u32).prop_map(|(c, radius, piece)| {
            let center = DVec3::from_array(c);
            (
                Ball {
                    center,
                    radius,
                    node: 0,
                },
                piece,
            )
        })
    }

    proptest! {
        #[test]
        fn it_is_what_trying_all_finds(
            mut balls in prop::collection::vec(ball(), 1..80),
            place in prop::array::uniform3(-9.0..9.0),
            limit in 0.1..20.0,
        ) {
            for (node, (ball, _)) in balls.iter_mut().enumerate() {
                ball.node = node;
            }
            let (balls, pieces): (Vec<Ball>, Vec<u32>) = balls.into_iter().unzip();
            let place = DVec3::from_array(place);
            let ways = balls.iter().zip(&pieces).filter(|(_, piece)| **piece != 0);
            let ways = ways.map(|(b, _)| (place.distance(b.center) - b.radius).max(0.0));
            let least = ways.fold(f64::INFINITY, f64::min);
            let mut nearest = Nearest::new(balls);
            nearest.label(&pieces);
            let found = nearest.of_another(place, 0, limit, true).map(|(_, way)| way);
            prop_assert_eq!(found, (least <= limit).then_some(least));
        }
    }
}
