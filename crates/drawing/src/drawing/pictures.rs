//! The pictures of a drawing, from its own cameras and from anywhere.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use neurotess_options::words::Size;
use neurotess_picture::{Camera, Image, PictureOptions, Viewpoint, Watch};
use neurotess_recipe::memory;

use super::{Drawing, shown};
use crate::error::DrawError;
use crate::film::FixedFilm;
use crate::meshed::MeshedCell;
use crate::overlay::overlay;
use crate::painter::{Cost, Take};

impl Drawing {
    /// Draws one of the pictures, with legend and scale bar. Ends soon after another thread sets `stopped`.
    ///
    /// # Errors
    /// The device or a report fails, or the picture was stopped.
    pub fn draw(&mut self, picture: usize, stopped: &Arc<AtomicBool>) -> Result<Image, DrawError> {
        self.stoppable(stopped, |drawing| {
            let mut whole = Whole::new(drawing.asked.picture.look.size.0)?;
            drawing.paint(picture, &mut |_, band| whole.take(&band))?;
            Ok(whole.image)
        })
    }

    /// Draws one of the pictures, with legend and scale bar; `take` gets its bands from the top.
    ///
    /// # Errors
    /// The device or a report fails, or `take` does.
    pub fn paint(&mut self, picture: usize, take: Take<'_>) -> Result<Cost, DrawError> {
        let Some(camera) = self.camera(picture) else {
            return Err(DrawError::Failed("there is no such picture".into()));
        };
        let options = self.asked.picture.drawn(self.colored.least_width());
        if self.film.is_none() {
            let cells: Vec<&MeshedCell> = self.cells.iter().collect();
            let shown = shown(&self.asked, &cells, &self.placements, &self.colored);
            let cameras = (&self.cameras[..], &self.around[..]);
            self.film = FixedFilm::new(&mut self.painter, &shown, cameras, &options)?;
        }
        let Some(film) = &mut self.film else {
            return self.paint_from(picture, camera, &options, take);
        };
        let (mut image, cost) = film.picture(&self.colored, picture)?;
        let legend = self.colored.legend(picture);
        let legend = (!self.asked.picture.look.no_legend).then_some(&legend);
        self.overlay.again(legend, &camera).lay_on(0, &mut image);
        take(0, image)?;
        Ok(cost)
    }

    /// Draws from anywhere, at another size and number of samples, with the colors of one of the pictures. Ends
    /// soon after another thread sets `stopped`.
    ///
    /// # Errors
    /// The device or a report fails, or the picture was stopped.
    pub fn draw_from(
        &mut self,
        picture: usize,
        camera: Camera,
        (size, samples): ([u32; 2], u32),
        stopped: &Arc<AtomicBool>,
    ) -> Result<Image, DrawError> {
        if self.asked.picture.look.size.0 != size {
            self.asked.picture.look.size = Size(size);
            self.film = None;
            self.colored.set_widths(&self.asked);
            let first = vec![camera];
            (self.overlay, _) = overlay(&self.asked, &self.colored, first, &self.spheres);
        }
        let options = PictureOptions {
            samples,
            ..self.asked.picture.drawn(self.colored.least_width())
        };
        self.stoppable(stopped, |drawing| {
            let mut whole = Whole::new(size)?;
            drawing.paint_from(picture, camera, &options, &mut |_, band| whole.take(&band))?;
            Ok(whole.image)
        })
    }

    /// Draws with a renderer that another thread can stop.
    fn stoppable(
        &mut self,
        stopped: &Arc<AtomicBool>,
        draw: impl FnOnce(&mut Self) -> Result<Image, DrawError>,
    ) -> Result<Image, DrawError> {
        self.painter.set_watch(Watch {
            stopped: Arc::clone(stopped),
            ..Watch::default()
        });
        let drawn = draw(self);
        if drawn.is_err() {
            // What was stopped in the middle of a tile has its buffers in use still.
            self.painter.recover();
        }
        drawn
    }

    fn paint_from(
        &mut self,
        picture: usize,
        camera: Camera,
        options: &PictureOptions,
        take: Take<'_>,
    ) -> Result<Cost, DrawError> {
        let (table, legend) = self.colored.picture(picture)?;
        let legend = (!self.asked.picture.look.no_legend).then_some(&legend);
        let overlay = self.overlay.again(legend, &camera);
        let mut lay = |top: u32, mut band: Image| {
            overlay.lay_on(top, &mut band);
            take(top, band)
        };
        let near = camera.near(&self.around);
        let view = Viewpoint { camera, near };
        let cells: Vec<&MeshedCell> = self.cells.iter().collect();
        let shown = shown(&self.asked, &cells, &self.placements, &self.colored);
        self.painter.draw(&shown, &view, &table, options, &mut lay)
    }
}

/// A picture that grows band by band.
struct Whole {
    image: Image,
}

impl Whole {
    fn new([width, height]: [u32; 2]) -> Result<Self, DrawError> {
        let pixels = memory::reserved(4 * width as usize * height as usize);
        let pixels =
            pixels.map_err(|e| DrawError::Memory(format!("{e}: choose a smaller size=")))?;
        Ok(Self {
            image: Image {
                width,
                height,
                pixels,
            },
        })
    }

    fn take(&mut self, band: &Image) -> Result<(), DrawError> {
        self.image.pixels.extend_from_slice(&band.pixels);
        Ok(())
    }
}
