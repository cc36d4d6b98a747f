//! Films of a recording from a fixed camera: one static picture, colored anew for each time.

use std::time::Instant;

use neurotess_color::Film;
use neurotess_picture::{BoundingSphere, Camera, Image, KeyColors, PictureOptions, Viewpoint};

use crate::colors::PictureColors;
use crate::error::DrawError;
use crate::painter::{Cost, Painter, Recolored};
use crate::shown::Shown;

/// A film, and what its next picture costs besides being colored.
pub(crate) struct FixedFilm {
    film: Film,
    picture: Recolored,
    cost: Cost,
}

/// What a film holds and reads, for `--stats`.
#[derive(Clone, Copy, Debug, serde::Serialize)]
pub struct FilmStats {
    /// Keys that show.
    pub visible_keys: usize,
    /// Compartments that are read for each picture.
    pub compartments_read: usize,
    /// Weights of the matrix that gives pixels their colors.
    pub weights: usize,
    /// Its bytes.
    pub bytes: u64,
}

impl FixedFilm {
    /// Draws the picture; none if the pictures must be drawn one by one. `cameras`: of all pictures.
    pub(crate) fn new(
        painter: &mut Painter,
        shown: &Shown<'_>,
        (cameras, spheres): (&[Camera], &[BoundingSphere]),
        options: &PictureOptions,
    ) -> Result<Option<Self>, DrawError> {
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
    pub(crate) fn picture(
        &mut self,
        colored: &PictureColors,
        number: usize,
    ) -> Result<(Image, Cost), DrawError> {
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

    pub(crate) fn stats(&self) -> FilmStats {
        let (weights, bytes) = self.picture.size();
        FilmStats {
            visible_keys: self.picture.keys().len(),
            compartments_read: self.film.compartments(),
            weights,
            bytes,
        }
    }
}
