//! Options of saving meshes, pictures and films.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use neurotess::mesh::Format;
use neurotess::plot::Plot;
use neurotess::recipe::{self, FileOptions, Levels, Purpose};
use neurotess::refine::RefineOptions;

use crate::model::settings::Settings;

/// What is said once something is saved.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Written {
    /// What was saved.
    pub(crate) status: String,
    /// What was not saved as asked for, or is in doubt: of what, and why.
    pub(crate) remarks: Vec<(String, String)>,
}

impl From<String> for Written {
    fn from(status: String) -> Self {
        Self {
            status,
            remarks: Vec::new(),
        }
    }
}

/// What is to be saved.
#[derive(Clone, Debug, PartialEq)]
pub enum SaveRequest {
    /// The session.
    Session(PathBuf),
    /// Meshes of neurons.
    Meshes(Box<MeshOptions>),
    /// A picture of the current view.
    Picture(PictureFile),
    /// Pictures along views or through time.
    Film(FilmOptions),
    /// A page of all neurons that show, for a browser.
    Page(PathBuf),
    /// A plot: as SVG, or its numbers as CSV if the file is called so.
    Plot(PathBuf, Arc<Plot>),
}

/// How neurons are meshed and written.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshOptions {
    /// A file for one mesh, a folder for several.
    pub out: PathBuf,
    /// What meshes are made by. The soma is each neuron's own.
    pub recipe: recipe::MeshOptions,
    /// Whether levels are those of the current picture, instead of the recipe's.
    pub as_shown: bool,
    /// Format, unit, walls, materials, parts.
    pub files: FileOptions,
    /// Whether neurons are where the window shows them instead of where they were traced.
    pub placed: bool,
    /// Whether all neurons that are shown are written instead of the selected ones.
    pub all: bool,
    /// Whether files may be replaced.
    pub replace: bool,
}

impl MeshOptions {
    /// Surfaces of level 4 of all neurons that show, as traced.
    pub fn new(out: impl Into<PathBuf>, format: Format) -> Self {
        Self {
            out: out.into(),
            recipe: recipe::MeshOptions::default(),
            as_shown: false,
            files: FileOptions::new(format),
            placed: false,
            all: true,
            replace: false,
        }
    }

    /// Sets what meshes are for, with what follows from that. Courses and ends stay.
    pub(crate) fn set_purpose(&mut self, purpose: Purpose) {
        let refine = self.recipe.refine;
        self.recipe = match purpose {
            Purpose::Surface => recipe::MeshOptions::default(),
            Purpose::Simulation => recipe::MeshOptions::simulation(),
        };
        self.recipe.refine = RefineOptions {
            quads: false,
            ..refine
        };
        self.as_shown = false;
    }

    /// Whether quads can be had: formats hold them, and nothing is merged.
    pub(crate) fn can_have_quads(&self) -> bool {
        self.files.format.has_quads() && !self.recipe.merges()
    }

    /// Whether walls between soma and neurites can be had.
    pub(crate) fn can_have_walls(&self) -> bool {
        let format = self.files.format;
        let coarse = self.recipe.levels == Levels::Coarse && !self.as_shown;
        let has_quads = self.recipe.refine.quads || coarse && format.has_quads();
        (format.has_regions() || self.files.parts) && !(has_quads && self.can_have_quads())
    }

    /// Whether faces can have the materials of their types.
    pub(crate) fn can_have_materials(&self) -> bool {
        matches!(self.files.format, Format::Obj | Format::Glb)
    }

    /// The same without what cannot be had.
    pub(crate) fn fitting(&self) -> Self {
        let mut options = self.clone();
        options.recipe.refine.quads &= self.can_have_quads();
        options.files.walls &= self.can_have_walls();
        options.files.materials &= self.can_have_materials();
        options
    }
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
    /// Whether the file tells how the picture was made.
    pub recipe: bool,
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
            mesh: MeshOptions::new("", Format::Ply),
            picture_out: String::new(),
            picture: PictureFile {
                out: PathBuf::new(),
                size: settings.picture_size,
                samples: 16,
                transparent: false,
                replace: false,
                recipe: true,
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
            at(format!("{name}.{}", self.mesh.files.format.extension())),
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
        form.mesh.files.format = Format::Msh2;
        form.propose(folder, "b");
        assert_eq!(form.mesh_out, "/data/b.msh");
        assert_eq!(form.picture_out, "/data/figure.png");
        assert_eq!(form.film_out, "/data/b_film.png");
    }
    #[test]
    fn what_cannot_be_had_is_left_out() {
        let mut options = MeshOptions::new("a.ply", Format::Ply);
        options.recipe.refine.quads = true;
        options.files.materials = true;
        assert!(options.fitting().recipe.refine.quads && !options.fitting().files.materials);
        options.files.format = Format::Glb;
        assert!(!options.fitting().recipe.refine.quads && options.fitting().files.materials);
        options.files.walls = true;
        assert!(!options.fitting().files.walls);
        options.files.parts = true;
        assert!(options.fitting().files.walls);
        for format in Format::ALL {
            options.files.format = format;
            options.set_purpose(Purpose::Simulation);
            for levels in [options.recipe.levels, Levels::Coarse] {
                options.recipe.levels = levels;
                let fitting = options.fitting();
                assert_eq!(fitting.files.check(&fitting.recipe), Ok(()), "{format}");
            }
        }
    }
}
