//! Pictures of a cell, for browsers whose graphics cannot draw it. A finished picture is kept as weights of colors: other
//! colors and what is under the pointer are then read from it.

use neurotess_mesh::CoarseMesh;
use neurotess_picture::color::{CATEGORY_BIT, ColorTable, category};
use neurotess_picture::{
    AdaptiveSettings, Camera, Image, Instance, KeyColors, Lens, Look, Occlusion, PictureOptions,
    Projection, Template, TemplateId, Viewpoint, Watch,
};
use neurotess_raster::{PictureError, Scene, StaticPicture, draw, draw_static};
use neurotess_refine::LodCriterion;
use serde::Deserialize;

/// What a picture shows apart from colors: JSON of the host, see `processor.js`.
#[derive(Clone, Debug, Deserialize, PartialEq)]
pub(crate) struct Asked {
    /// Width and height (pixels).
    size: [u32; 2],
    eye: [f64; 3],
    target: [f64; 3],
    up: [f64; 3],
    /// Vertical angle of view (radians).
    fov: f64,
    orthographic: bool,
    /// Depth (µm) of the near plane.
    near: f64,
    /// The level; 0: by the error.
    level: u32,
    /// Error (pixels).
    error: f32,
    samples: u32,
    occlusion: bool,
    /// Widths (pixels) of the wireframe's lines and of the thinnest neurites; 0: none.
    wire: f32,
    least_width: f32,
    background: [u8; 3],
    /// Whether it is drawn at once, and not kept.
    draft: bool,
}

/// Color of each tracing point, and which of them are hidden.
#[derive(Default)]
struct Colors {
    table: ColorTable,
    hidden: Vec<bool>,
}

/// Draws a cell.
pub(crate) struct Drawing {
    /// By tracing point: one category each, as in pages.
    keys: Vec<u32>,
    kept: Option<Kept>,
}

/// A finished picture.
struct Kept {
    asked: Asked,
    hidden: Vec<bool>,
    picture: StaticPicture,
}

impl Drawing {
    pub(crate) fn new(mesh: &CoarseMesh) -> Self {
        let keys = 0..mesh.tracing.len() as u32;
        Self {
            keys: keys.map(category).collect(),
            kept: None,
        }
    }

    /// The picture in these colors: red, green, blue and whether it shows, four bytes a tracing point.
    ///
    /// # Errors
    /// The view is none.
    pub(crate) fn image(
        &mut self,
        mesh: &CoarseMesh,
        asked: &Asked,
        colors: &[u8],
    ) -> Result<Image, String> {
        let colors = Colors::new(colors);
        if asked.draft || asked.wire > 0.0 {
            let mut image = Image::new(asked.size[0], 0);
            self.scene(mesh, asked, &colors, |scene, view, options| {
                let take = |_, band: Image| {
                    image.height += band.height;
                    image.pixels.extend(band.pixels);
                    Ok::<_, std::convert::Infallible>(())
                };
                draw(scene, view, &colors.table, options, &Watch::default(), take).map(drop)
            })?;
            return Ok(image);
        }
        let colored = KeyColors {
            table: &colors.table,
            states: &[],
            values: None,
        };
        Ok(self.kept(mesh, asked, &colors)?.image(&colored))
    }

    /// The tracing point that shows at a pixel, or nearest to it within a few; none if there is none.
    ///
    /// # Errors
    /// The view is none.
    pub(crate) fn point_at(
        &mut self,
        mesh: &CoarseMesh,
        asked: &Asked,
        colors: &[u8],
        [x, y]: [i64; 2],
    ) -> Result<Option<u32>, String> {
        let colors = Colors::new(colors);
        let unlined = Asked {
            wire: 0.0,
            ..asked.clone()
        };
        let picture = self.kept(mesh, &unlined, &colors)?;
        let around = -REACH..=REACH;
        let mut places: Vec<[i64; 2]> = around
            .clone()
            .flat_map(|down| around.clone().map(move |right| [right, down]))
            .collect();
        places.sort_by_key(|[right, down]| right * right + down * down);
        let key = places.iter().find_map(|[right, down]| {
            let at = [x + right, y + down].map(|n| u32::try_from(n).unwrap_or(u32::MAX));
            picture.key_at(at)
        });
        Ok(key.map(|key| key.color_key & !CATEGORY_BIT))
    }

    /// The picture that is kept, made anew if it is another.
    fn kept(
        &mut self,
        mesh: &CoarseMesh,
        asked: &Asked,
        colors: &Colors,
    ) -> Result<&StaticPicture, String> {
        let is_it = |kept: &Kept| kept.asked == *asked && kept.hidden == colors.hidden;
        let kept = match self.kept.take().filter(is_it) {
            Some(kept) => kept,
            None => {
                let picture = self.scene(mesh, asked, colors, |scene, view, options| {
                    let drawn = draw_static(scene, view, &colors.table, options, &Watch::default());
                    drawn.map(|(picture, _)| picture)
                })?;
                Kept {
                    asked: asked.clone(),
                    hidden: colors.hidden.clone(),
                    picture,
                }
            }
        };
        Ok(&self.kept.insert(kept).picture)
    }

    /// What `drawn` makes of the cell.
    fn scene<T>(
        &self,
        mesh: &CoarseMesh,
        asked: &Asked,
        colors: &Colors,
        drawn: impl FnOnce(
            &Scene<'_>,
            &Viewpoint,
            &PictureOptions,
        ) -> Result<T, PictureError<std::convert::Infallible>>,
    ) -> Result<T, String> {
        let template = Template {
            mesh,
            color_keys: &self.keys,
            values: &[],
        };
        let settings = AdaptiveSettings {
            lod: match asked.level {
                0 => LodCriterion::PixelError(asked.error),
                level => LodCriterion::Homogeneous(level),
            },
            ..AdaptiveSettings::default()
        };
        let instances = vec![Instance::new(TemplateId(0))];
        let scene = Scene::new(vec![template], instances, settings);
        let scene = scene.map_err(|e| e.to_string())?.without(&colors.hidden);
        let (view, options) = (asked.viewpoint()?, asked.options());
        drawn(&scene, &view, &options).map_err(|e| e.to_string())
    }
}

/// Pixels around the pointer that are searched. As in webgpu.js.
const REACH: i64 = 3;

impl Asked {
    fn viewpoint(&self) -> Result<Viewpoint, String> {
        let lens = Lens {
            fov: self.fov,
            projection: match self.orthographic {
                true => Projection::Orthographic,
                false => Projection::Perspective,
            },
        };
        let camera = Camera::new(self.eye.into(), self.target.into(), self.up.into(), lens);
        Ok(Viewpoint {
            camera: camera.map_err(|e| e.to_string())?,
            near: self.near,
        })
    }

    fn options(&self) -> PictureOptions {
        PictureOptions {
            size: self.size,
            samples: self.samples,
            background: Some(self.background),
            look: Look {
                wire: self.wire,
                least_width: self.least_width,
                ..Look::default()
            },
            occlusion: match self.occlusion {
                true => Occlusion::Fit,
                false => Occlusion::Off,
            },
            ..PictureOptions::default()
        }
    }
}

impl Colors {
    fn new(bytes: &[u8]) -> Self {
        let mut colors = Self::default();
        for &[r, g, b, shows] in bytes.as_chunks().0 {
            colors.table.categories.push([r, g, b]);
            colors.hidden.push(shows == 0);
        }
        colors
    }
}
