//! Films of a recording from a fixed camera: one static picture, colored anew for each time.

use std::time::Instant;

use neurotess::coloring::Film;
use neurotess::picture::{BoundingSphere, Camera, Image, KeyColors, PictureOptions, Viewpoint};

use super::coloring::PictureColors;
use super::painter::{Cost, Painter, Recolored};
use super::shown::Shown;

/// A film, and what its next picture costs besides being colored.
pub(super) struct FixedFilm {
    film: Film,
    picture: Recolored,
    cost: Cost,
}

/// What a film holds and reads, for `--stats`.
#[derive(Clone, Copy, Debug, serde::Serialize)]
pub(super) struct FilmStats {
    visible_keys: usize,
    compartments_read: usize,
    weights: usize,
    bytes: u64,
}

impl FixedFilm {
    /// Draws the picture; none if the pictures must be drawn one by one. `cameras`: of all pictures.
    pub(super) fn new(
        painter: &mut Painter,
        shown: &Shown<'_>,
        (cameras, spheres): (&[Camera], &[BoundingSphere]),
        options: &PictureOptions,
    ) -> anyhow::Result<Option<Self>> {
        let colored = shown.colored;
        let fixed = cameras.windows(2).all(|pair| pair[0] == pair[1]);
        let Some(camera) = cameras.first().filter(|_| fixed) else {
            return Ok(None);
        };
        if cameras.len() < 2 || !colored.is_series() || !Film::holds(options.size) {
            return Ok(None);
        }
        let clock = Instant::now();
        let view = Viewpoint {
            camera: *camera,
            near: camera.near(spheres),
        };
        let (table, _) = colored.picture(0)?;
        let Some((picture, tiles)) = painter.draw_static(shown, &view, &table, options)? else {
            return Ok(None);
        };
        let Some(film) = colored.film(picture.keys()) else {
            return Ok(None);
        };
        let cost = Cost {
            cpu_ms: clock.elapsed().as_secs_f64() * 1e3,
            tiles,
            ..Cost::default()
        };
        Ok(Some(Self {
            film,
            picture,
            cost,
        }))
    }

    /// The picture of a number.
    pub(super) fn picture(
        &mut self,
        colored: &PictureColors,
        number: usize,
    ) -> anyhow::Result<(Image, Cost)> {
        let clock = Instant::now();
        let values = colored.film_values(&self.film, number)?;
        let image = self.picture.image(&KeyColors {
            table: &colored.coloring.table,
            states: &[],
            values: Some(&values),
        })?;
        let mut cost = self.cost.clone();
        // The first picture took the time to draw it.
        cost.cpu_ms += clock.elapsed().as_secs_f64() * 1e3;
        self.cost.cpu_ms = 0.0;
        Ok((image, cost))
    }

    pub(super) fn stats(&self) -> FilmStats {
        let (weights, bytes) = self.picture.size();
        FilmStats {
            visible_keys: self.picture.keys().len(),
            compartments_read: self.film.compartments(),
            weights,
            bytes,
        }
    }
}
