//! The rectangle of a picture in which anything shows.
//!
//! Sources know whether anything shows in a frame. So the sides of the rectangle are searched for, each by
//! halving what may be empty: a dozen questions.

use crate::sources::VertexSource;
use neurotess_picture::{Frame, Tile};

/// First and last sub-pixel, across and down.
pub(crate) type Rectangle = [[i32; 2]; 2];

/// How closely (sub-pixels) it is searched for.
const STEP: i32 = 8;
/// Most parts of a source that is asked: an answer for as many takes a millisecond or two.
const MAX_PARTS: usize = 100_000;

/// The rectangle in a picture and around it in which anything shows, or all of it if the source has very many parts;
/// none if nothing shows. `widened`: how far
/// (sub-pixels) something may be drawn beyond where it is.
pub(crate) fn extent(source: &dyn VertexSource, whole: &Frame, widened: u32) -> Option<Rectangle> {
    // What sources compute with 32 bits may be a little off.
    let spare = widened as i32 + 2;
    let around = whole.around as i32 + spare;
    let all = whole.size.map(|n| [-around, n as i32 + around]);
    let shows = |rectangle: Rectangle| source.shows(&part(whole, rectangle));
    if source.parts() > MAX_PARTS {
        return Some(all);
    }
    shows(all).then(|| {
        let mut found = all;
        for axis in [0, 1] {
            let [start, end] = all[axis];
            let [first, last] = [true, false].map(|first| {
                empty(end - start, |length| {
                    let mut strip = found;
                    strip[axis] = match first {
                        true => [start, start + length],
                        false => [end - length, end],
                    };
                    shows(strip)
                })
            });
            found[axis] = [start + first - spare, end - last + spare];
        }
        found
    })
}

/// How much is empty of what is this long, counted from one end. `shows`: whether anything shows in so much of
/// it.
fn empty(length: i32, shows: impl Fn(i32) -> bool) -> i32 {
    let (mut empty, mut shown) = (0, length);
    while shown - empty > STEP {
        let middle = (empty + shown) / 2;
        match shows(middle) {
            true => shown = middle,
            false => empty = middle,
        }
    }
    empty
}

fn part(whole: &Frame, [x, y]: Rectangle) -> Frame {
    Frame {
        tile: Tile {
            x: x[0],
            y: y[0],
            width: (x[1] - x[0]) as u32,
            height: (y[1] - y[0]) as u32,
        },
        ..*whole
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_empty_is_found_to_a_few_sub_pixels_and_never_too_much() {
        for length in [1, 7, 100, 4321] {
            for from in [0, 1, 5, 99, 4000] {
                let found = empty(length, |n| n > from);
                assert!(found <= from.min(length), "{length} {from}: {found}");
                assert!(found + STEP >= from.min(length), "{length} {from}: {found}");
            }
        }
    }
}
