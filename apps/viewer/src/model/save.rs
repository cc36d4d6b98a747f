//! Options of saving meshes, pictures and films.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use neurotess::mesh::Format;
use neurotess::plot::Plot;
use neurotess::refine::LodCriterion;

use crate::model::settings::Settings;

/// The level of detail that a mesh is written with.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum MeshLod {
    /// The panel's level of detail, in the current view if it depends on that.
    #[default]
    AsShown,
    /// A criterion that needs no view; none: the coarse quads.
    Fixed(Option<LodCriterion>),
}

/// What is to be saved.
#[derive(Clone, Debug, PartialEq)]
pub enum SaveRequest {
    /// The session.
    Session(PathBuf),
    /// Meshes of neurons.
    Meshes(MeshOptions),
    /// A picture of the current view.
    Picture(PictureFile),
    /// Pictures along views or through time.
    Film(FilmOptions),
    /// A plot: as SVG, or its numbers as CSV if the file is called so.
    Plot(PathBuf, Arc<Plot>),
}

/// How meshes are written.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshOptions {
    /// A file for one mesh, a folder for several.
    pub out: PathBuf,
    /// Format of the files.
    pub format: Format,
    /// The level of detail.
    pub lod: MeshLod,
    /// Whether there are quads instead of triangles.
    pub quads: bool,
    /// Whether the path between points is straight.
    pub linear: bool,
    /// Whether neurites end in disks instead of half spheres.
    pub flat: bool,
    /// Whether neurons are where the window shows them instead of where they were traced.
    pub placed: bool,
    /// Whether all neurons that are shown are written instead of the selected ones.
    pub all: bool,
    /// Whether files may be replaced.
    pub replace: bool,
}

/// A picture.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureFile {
    /// Its file.
    pub out: PathBuf,
    /// Width and height (pixels).
    pub size: [u32; 2],
    /// Samples of a pixel.
    pub samples: u32,
    /// Whether the background is transparent.
    pub transparent: bool,
    /// Whether the file may be replaced.
    pub replace: bool,
}

/// A film: numbered pictures along key views, through a recording's time, or both.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmOptions {
    /// Name of the pictures; a number is added.
    pub picture: PictureFile,
    /// Number of pictures from one key view to the next; or of all, if the view stays the same.
    pub frames: u32,
    /// Times (ms) of a recording at the beginning and the end; none: the current time.
    pub time: Option<[f64; 2]>,
    /// Whether ffmpeg makes a video of them.
    pub video: bool,
}

/// The inputs of the panel.
#[derive(Clone, Debug)]
pub struct SaveForm {
    /// Typed path of meshes.
    pub mesh_out: String,
    /// Options of meshes.
    pub mesh: MeshOptions,
    /// Typed path of a picture.
    pub picture_out: String,
    /// Options of a picture.
    pub picture: PictureFile,
    /// Typed path of a film.
    pub film_out: String,
    /// Number of pictures from one key view to the next.
    pub frames: u32,
    /// Whether a recording's time goes on during the film.
    pub over_time: bool,
    /// First and last time (ms) of the recording.
    pub time: [f64; 2],
    /// Whether ffmpeg makes a video of the film.
    pub video: bool,
    /// Whether ffmpeg is installed, once that is known.
    pub ffmpeg: Option<bool>,
    /// The paths that were proposed last: of meshes, a picture, a film.
    proposed: [String; 3],
}

impl SaveForm {
    pub(crate) fn new(settings: &Settings) -> Self {
        Self {
            mesh_out: String::new(),
            mesh: MeshOptions {
                out: PathBuf::new(),
                format: Format::Ply,
                lod: MeshLod::Fixed(Some(LodCriterion::Homogeneous(4))),
                quads: false,
                linear: false,
                flat: false,
                placed: false,
                all: true,
                replace: false,
            },
            picture_out: String::new(),
            picture: PictureFile {
                out: PathBuf::new(),
                size: settings.picture_size,
                samples: 16,
                transparent: false,
                replace: false,
            },
            film_out: String::new(),
            frames: 60,
            over_time: true,
            time: [0.0; 2],
            video: false,
            ffmpeg: None,
            proposed: Default::default(),
        }
    }

    /// Proposes paths in a folder that are named after what is saved. What was typed stays.
    pub(crate) fn propose(&mut self, folder: &Path, name: &str) {
        let at = |name: String| folder.join(name).display().to_string();
        let proposed = [
            at(format!("{name}.{}", self.mesh.format.extension())),
            at(format!("{name}.png")),
            at(format!("{name}_film.png")),
        ];
        let lines = [
            &mut self.mesh_out,
            &mut self.picture_out,
            &mut self.film_out,
        ];
        for (line, (before, now)) in lines.into_iter().zip(self.proposed.iter().zip(&proposed)) {
            if line == before {
                line.clone_from(now);
            }
        }
        self.proposed = proposed;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_typed_is_not_replaced_by_another_proposal() {
        let mut form = SaveForm::new(&Settings::default());
        let folder = Path::new("/data");
        form.propose(folder, "a");
        assert_eq!(
            [&form.mesh_out, &form.picture_out],
            ["/data/a.ply", "/data/a.png"]
        );
        form.picture_out = "/data/figure.png".into();
        form.mesh.format = Format::Msh2;
        form.propose(folder, "b");
        assert_eq!(form.mesh_out, "/data/b.msh");
        assert_eq!(form.picture_out, "/data/figure.png");
        assert_eq!(form.film_out, "/data/b_film.png");
    }
}
