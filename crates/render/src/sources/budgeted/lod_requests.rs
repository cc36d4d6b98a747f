//! The steps of detail that a chunk requests: twin of `offers` in budgeted.wgsl, for tests.
//! Computed in f64 from the same definitions.

use glam::{DQuat, DVec3, Vec3};

use super::ERROR;
use super::layout::{
    BINS, BINS_OF_OCTAVE, CHUNK_FREE_END, CHUNK_FREE_START, CHUNK_SOMA, CHUNK_TWIG, Chunk,
    ERROR_OFFSET, ERROR_STEPS, LEVELS, LOWEST_OCTAVE, TWIG_FADES,
};
use super::proxy::Proxy;
use neurotess_picture::Camera;
use neurotess_picture::Frame;
use neurotess_picture::PixelSize;
use neurotess_picture::Placement;

const DISC_QUADS: u32 = 4;
const DOME_QUADS: u32 = 18;
const HALF_PIXEL: f64 = 0.5;
const LOOKED_AT: u32 = 8;

/// A step in which a chunk is drawn better.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LodRequest {
    /// Worth, as a bin of the histogram, with its fraction.
    pub class: f64,
    /// Quads in addition to those of the steps before.
    pub quads: u32,
}

/// What every chunk of a proxy requests at an instance's placement; nothing if it does not show.
/// `instance`: its index in the list.
pub fn lod_requests(
    proxy: &Proxy,
    placement: &Placement,
    frame: &Frame,
    sub_pixels: u32,
    instance: u32,
) -> Vec<Vec<LodRequest>> {
    let view = View {
        camera: frame.camera,
        frame: *frame,
        pixel: frame.pixel().times(f64::from(sub_pixels)),
    };
    let whole = placed(proxy.center, proxy.reach, proxy, placement);
    let chunks = proxy.chunks.iter();
    chunks
        .map(|chunk| {
            let sphere = placed(
                Vec3::from_array(chunk.center),
                chunk.reach,
                proxy,
                placement,
            );
            if !view.sees(whole) || !view.sees(sphere) {
                return Vec::new();
            }
            let at = |p: Vec3| placed(p, 0.0, proxy, placement).0;
            let seen = view.seen(chunk, sphere, placement.scale, &|lod| {
                points(proxy, chunk, lod, &at)
            });
            seen.map_or(Vec::new(), |seen| {
                view.lod_requests(chunk, seen, placement.scale, chance(instance))
            })
        })
        .collect()
}

fn placed(center: Vec3, reach: f32, proxy: &Proxy, placement: &Placement) -> (DVec3, f64) {
    let rotation: DQuat = placement.rotation;
    let center = proxy.origin + center.as_dvec3();
    let there = placement.translation + rotation * center * placement.scale;
    (there, f64::from(reach) * placement.scale)
}

struct View {
    camera: Camera,
    frame: Frame,
    pixel: PixelSize,
}

impl View {
    fn sees(&self, (center, reach): (DVec3, f64)) -> bool {
        let depth = (self.camera.depth(center) + reach).max(self.frame.near);
        let p = center - self.camera.eye();
        self.frame.frustum().iter().all(|plane| {
            let n = plane.truncate().as_dvec3();
            n.dot(p) + f64::from(plane.w) >= -(reach + self.pixel.at(depth))
        })
    }

    /// Of the visible part of a chunk: least depth, mean depth, and share of the chunk's length.
    fn seen(
        &self,
        chunk: &Chunk,
        (center, reach): (DVec3, f64),
        scale: f64,
        points: &dyn Fn(usize) -> Vec<DVec3>,
    ) -> Option<[f64; 3]> {
        let (depth, near) = (self.camera.depth(center), self.frame.near);
        if chunk.flags & CHUNK_SOMA != 0 {
            return Some([near, depth, 1.0]);
        }
        let planes = self.frame.frustum();
        let planes = planes.map(|p| (p.truncate().as_dvec3(), f64::from(p.w)));
        let off = |p: DVec3| planes.map(|(normal, w)| normal.dot(p - self.camera.eye()) + w);
        let distant = self.camera.is_orthographic() || depth > 4.0 * reach;
        if distant && off(center).iter().all(|&off| off >= reach) {
            return Some([depth - reach, depth, 1.0]);
        }
        let finest = (0..LEVELS).find(|&k| (1..=LOOKED_AT).contains(&lod(chunk, k).0));
        let level = finest.unwrap_or(0);
        let margin = (lod(chunk, level).1 + f64::from(chunk.radius)) * scale;
        let (mut nearest, mut middle, mut share, mut all) = (f64::MAX, 0.0, 0.0, 0.0);
        for pair in points(level).windows(2) {
            let span = pair[0].distance(pair[1]);
            all += span;
            let [a, b] = [pair[0], pair[1]].map(|p| self.camera.depth(p));
            let reach = margin + self.pixel.at(a.max(b).max(near));
            let Some([from, to]) = between(off(pair[0]), off(pair[1]), reach) else {
                continue;
            };
            let there = [from, to].map(|t| a + (b - a) * t);
            let part = (to - from) * span + 1e-6;
            nearest = nearest.min(there[0].min(there[1]) - margin);
            middle += part * 0.5 * (there[0] + there[1]);
            share += part;
        }
        (share > 0.0).then(|| [nearest, middle / share, share / all.max(1e-6)])
    }

    fn lod_requests(
        &self,
        chunk: &Chunk,
        seen: [f64; 3],
        scale: f64,
        chance: f64,
    ) -> Vec<LodRequest> {
        let [nearest, middle, share] = seen;
        let nearest = self.pixel.at(nearest.max(self.frame.near));
        let pixel = self.pixel.at(middle).max(nearest);
        let mut steps = Steps::default();
        if chunk.flags & CHUNK_SOMA != 0 {
            let radius = f64::from(chunk.radius) * scale / pixel;
            let area = std::f64::consts::PI * radius * radius;
            let side = area.sqrt();
            let size = if side > 1.0 { area } else { side };
            let luck = chance
                .max(1e-6)
                .powf(6.0 * (0.25 * (5.0 - side)).clamp(0.0, 1.0));
            let factor = (0.5 * chance - 0.25).exp2();
            steps.add(256.0 * size * factor * luck, 1);
            let own = chunk.counts[0];
            let sphere = if radius > 3.0 { DOME_QUADS } else { DISC_QUADS };
            if radius > 1.0 {
                steps.add(16.0 * area / f64::from(sphere), sphere - 1);
            }
            if radius > 6.0 && own > sphere {
                steps.add(8.0 * area / f64::from(own), own - sphere);
                let off = 2.0 * std::f64::consts::PI * radius / f64::from(own) / f64::from(ERROR);
                let halvings = (0.5 * off.max(1.0).log2()).ceil().clamp(0.0, 3.0) as u32;
                if halvings > 0 {
                    let quads = (own << (2 * halvings)) - own;
                    steps.add(area / f64::from(quads), quads);
                }
            }
            return steps.0;
        }
        let (near_pixel, far_pixel) = (nearest / scale, pixel / scale);
        let tiny = f64::from(chunk.length) <= f64::from(TWIG_FADES[0]) * far_pixel;
        if chunk.flags & CHUNK_TWIG != 0 && tiny {
            return Vec::new();
        }
        let mean = f64::from(chunk.mean()) / far_pixel;
        let width = match mean < HALF_PIXEL {
            true => 1.0 - (1.0 - (mean / HALF_PIXEL).sqrt()).powi(3),
            false => 2.0 * mean,
        };
        let length = f64::from(chunk.length.min(2.0 * chunk.reach)) * share.min(1.0) / far_pixel;
        let area = length.max(0.25) * width;
        let error = f64::from(ERROR) * near_pixel;
        let (coarse, fine) = (within(chunk, 4.0 * error), within(chunk, error));
        let halvings = match fine {
            0 => (0.5 * (lod(chunk, 0).1 / error).max(1.0).log2())
                .ceil()
                .clamp(0.0, 3.0) as u32,
            _ => 0,
        };
        let strips = match f64::from(chunk.radius) / near_pixel {
            r if r < 3.0 => 1,
            r if r < 7.0 => 5,
            r if r < 27.0 => 10,
            _ => 20,
        };
        let ends = (chunk.flags & (CHUNK_FREE_START | CHUNK_FREE_END)).count_ones();
        let caps = if strips > 1 { DOME_QUADS * ends } else { 0 };
        let counts = [
            lod(chunk, coarse).0,
            lod(chunk, fine).0 << halvings,
            (lod(chunk, fine).0 << halvings) * strips + caps,
        ];
        let carried = 2.0 * f64::from(chunk.carried) / far_pixel.powf(1.5);
        let worth = carried * (0.5 * chance - 0.25).exp2();
        steps.add(worth, counts[0]);
        let mut there = counts[0];
        for count in &counts[1..] {
            if *count > there {
                steps.add(0.25 * area / f64::from(count - there), count - there);
                there = *count;
            }
        }
        steps.0
    }
}

#[derive(Default)]
struct Steps(Vec<LodRequest>);

impl Steps {
    fn add(&mut self, worth: f64, quads: u32) {
        let class = (worth.log2() - f64::from(LOWEST_OCTAVE)) * f64::from(BINS_OF_OCTAVE);
        let class = class.clamp(1.0, (BINS - 1) as f64);
        let before = self.0.last().map_or(f64::MAX, |step| step.class);
        self.0.push(LodRequest {
            class: class.min(before),
            quads,
        });
    }
}

/// The part of a segment that is inside all planes, or outside by no more than a distance:
/// parameters from 0 to 1. `a` and `b`: distances of the segment's ends from the planes.
fn between(a: [f64; 5], b: [f64; 5], reach: f64) -> Option<[f64; 2]> {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for (a, b) in a.iter().zip(b).map(|(a, b)| (a + reach, b + reach)) {
        match (a < 0.0, b < 0.0) {
            (true, true) => return None,
            (true, false) => from = from.max(a / (a - b)),
            (false, true) => to = to.min(a / (a - b)),
            (false, false) => {}
        }
    }
    (from <= to).then_some([from, to])
}

/// Points of a chunk's polyline, in the world.
fn points(proxy: &Proxy, chunk: &Chunk, level: usize, at: &dyn Fn(Vec3) -> DVec3) -> Vec<DVec3> {
    let all = lod(chunk, 0).0 as usize + 1;
    let u32s = &proxy.packed[chunk.first as usize..];
    let bytes = u32s[2 * all..].iter().flat_map(|four| four.to_le_bytes());
    let bytes: Vec<u8> = bytes.take(2 * all).collect();
    let before = (1..level).map(|k| lod(chunk, k).0).filter(|&n| n > 0);
    let first = before.map(|n| n as usize + 1).sum::<usize>();
    let point = |i: usize| {
        let kept = if level == 0 {
            i
        } else {
            usize::from(bytes[first + i])
        };
        let [low, high] = [u32s[2 * kept], u32s[2 * kept + 1]];
        let steps = [low & 0xffff, low >> 16, high & 0xffff].map(|n| n as f32);
        at(Vec3::from_array(chunk.low) + chunk.step * Vec3::from_array(steps))
    };
    (0..=lod(chunk, level).0 as usize).map(point).collect()
}

/// Number of segments and error (µm) of a chunk's polyline.
fn lod(chunk: &Chunk, level: usize) -> (u32, f64) {
    let byte = |u32s: [u32; 2]| u32s[level / 4].to_le_bytes()[level % 4];
    let error = match byte(chunk.errors) {
        0 => 0.0,
        byte => (f64::from(byte) / f64::from(ERROR_STEPS) - f64::from(ERROR_OFFSET)).exp2(),
    };
    (u32::from(byte(chunk.counts)), error)
}

fn within(chunk: &Chunk, error: f64) -> usize {
    let fits = |&level: &usize| lod(chunk, level).0 > 0 && lod(chunk, level).1 <= error;
    (1..LEVELS).rev().find(fits).unwrap_or(0)
}

fn chance(instance: u32) -> f64 {
    let mut h = instance.wrapping_mul(747_796_405).wrapping_add(277_803_737);
    h = ((h >> ((h >> 28) + 4)) ^ h).wrapping_mul(277_803_737);
    h = (h >> 22) ^ h;
    f64::from(h >> 8) / 16_777_216.0
}
