//! Marks that are drawn over the picture: the ring that a slider moves, and, while something moves,
//! the part under the cursor. At rest the picture itself has outlines, exact to the pixel.

use eframe::egui::{Color32, Painter, Pos2, Rect, Stroke, vec2};
use glam::DVec3;
use neurotess::generate::FirstRing;
use neurotess::morphology::{Point, SectionId, shape};
use neurotess::render::{Camera, Placement};

use crate::model::sources::Source;
use crate::model::state::{CellPart, Picked, State};
use crate::scene::stage::OUTLINES;

/// Number of points that a circle is drawn with.
const ROUND: usize = 48;

/// Projects positions (µm) to points of the window.
pub(crate) struct Projection<'a> {
    pub(crate) camera: Camera,
    pub(crate) rect: Rect,
    pub(crate) placement: &'a Placement,
    /// Of the positions.
    pub(crate) origin: DVec3,
}

impl Projection<'_> {
    /// Where a position is in the window, if it is before the eye.
    pub(crate) fn at(&self, point: DVec3) -> Option<Pos2> {
        let place = self.placement.world_from_cell(self.origin + point);
        at(&self.camera, self.rect, place)
    }

    /// Length in points of the window of a length (µm) at a position.
    fn wide(&self, point: DVec3, length: f64) -> f32 {
        let place = self.placement.world_from_cell(self.origin + point);
        wide(
            &self.camera,
            self.rect,
            place,
            self.placement.scale * length,
        )
    }
}

/// Where a place of the scene is in the window.
pub(crate) fn at(camera: &Camera, rect: Rect, place: DVec3) -> Option<Pos2> {
    // In sixteenths of a point, since sizes are whole numbers.
    let size = [rect.width(), rect.height()].map(|n| (16.0 * n) as u32);
    let [x, y] = camera.pixel_of(place, size)?;
    Some(rect.min + vec2(x as f32, y as f32) / 16.0)
}

/// Length in points of the window of a length (µm) at a place of the scene.
pub(crate) fn wide(camera: &Camera, rect: Rect, place: DVec3, length: f64) -> f32 {
    let pixel = camera.pixel_size(f64::from(rect.height()));
    (length / pixel.at(camera.depth(place).max(1e-9))) as f32
}

fn hovered_color() -> Color32 {
    let [r, g, b] = OUTLINES.hovered;
    Color32::from_rgb(r, g, b)
}

/// Draws the rings of the neurite whose slider is touched.
pub(crate) fn rings(state: &State, rect: Rect, painter: &Painter) {
    let Some((id, neurite)) = state.pointing.touched else {
        return;
    };
    let Some(source) = state.sources.get(id) else {
        return;
    };
    let (placements, neurons) = (state.placements(), &state.document.neurons);
    for (index, (neuron, placement)) in neurons.iter().zip(placements.iter()).enumerate() {
        if neuron.source != id || !neurons.shows(index) {
            continue;
        }
        let projection = Projection {
            camera: state.view.camera(),
            rect,
            placement,
            origin: source.generated.mesh.origin,
        };
        let rings = source.generated.rings.iter();
        for ring in rings.filter(|r| r.neurite == neurite) {
            circle(&projection, ring, painter);
        }
    }
}

fn circle(projection: &Projection<'_>, ring: &FirstRing, painter: &Painter) {
    let (across, along) = ring.outwards.any_orthonormal_pair();
    // From far away a ring is drawn as a dot that is large enough to be found.
    let point = f64::from(projection.wide(ring.center, 1.0)).max(1e-9);
    let radius = (1.08 * ring.radius).max(5.0 / point);
    round(
        projection,
        ring.center,
        [across * radius, along * radius],
        painter,
    );
}

/// An ellipse with these half axes.
fn round(projection: &Projection<'_>, center: DVec3, [a, b]: [DVec3; 2], painter: &Painter) {
    let at = |i: usize| {
        let angle = std::f64::consts::TAU * i as f64 / ROUND as f64;
        projection.at(center + a * angle.cos() + b * angle.sin())
    };
    let points: Option<Vec<Pos2>> = (0..=ROUND).map(at).collect();
    if let Some(points) = points {
        let halo = Color32::from_white_alpha(150);
        painter.line(points.clone(), Stroke::new(5.0, halo));
        painter.line(points, Stroke::new(2.5, hovered_color()));
    }
}

/// Lines beside the part under the cursor, for drafts.
pub(crate) fn hovered(state: &State, rect: Rect, painter: &Painter) {
    let Some(Picked { neuron, part }) = state.pointing.hovered else {
        return;
    };
    let shows = state.document.neurons.shows(neuron);
    let (Some(source), Some(placement), true) = (
        state.source_of(neuron),
        state.placements().get(neuron).copied(),
        shows,
    ) else {
        return;
    };
    let projection = Projection {
        camera: state.view.camera(),
        rect,
        placement: &placement,
        origin: source.generated.mesh.origin,
    };
    match part {
        CellPart::Soma => soma(&projection, source, painter),
        CellPart::Section(section) => beside(&projection, source, section as usize, painter),
        CellPart::Neurite(neurite) => {
            let sections = source.sections.iter().enumerate();
            for (section, _) in sections.filter(|(_, facts)| facts.neurite == neurite) {
                beside(&projection, source, section, painter);
            }
        }
    }
}

fn soma(projection: &Projection<'_>, source: &Source, painter: &Painter) {
    if let Some(soma) = source.morphology.soma() {
        let [right, up, _] = projection.camera.axes();
        let back = projection.placement.rotation.inverse();
        let radius = f64::from(soma.radius) * source.soma.scale;
        let axes = [back * right * radius, back * up * radius];
        round(projection, soma.center.as_dvec3(), axes, painter);
    }
}

/// A line on both sides of each of a section's segments.
fn beside(projection: &Projection<'_>, source: &Source, section: usize, painter: &Painter) {
    let stroke = Stroke::new(1.0, hovered_color());
    let within = projection.rect.expand(20.0);
    let end = |p: &Point| {
        let center = p.position.as_dvec3();
        let wide = projection.wide(center, f64::from(p.radius));
        Some((projection.at(center)?, wide.clamp(0.3, 500.0) + 0.8))
    };
    for (a, b) in shape::links(&source.morphology, SectionId(section as u32)) {
        let (Some((a, wide_a)), Some((b, wide_b))) = (end(a), end(b)) else {
            continue;
        };
        if !within.contains(a) && !within.contains(b) {
            continue;
        }
        let across = (b - a).normalized().rot90();
        for side in [-1.0, 1.0] {
            let ends = [a + across * side * wide_a, b + across * side * wide_b];
            painter.line_segment(ends, stroke);
        }
    }
}
