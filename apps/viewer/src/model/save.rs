//! What is to be saved, and how: meshes, pictures, films.

use std::path::PathBuf;

use neurotess::mesh::Format;
use neurotess::refine::LodCriterion;

use crate::model::settings::Settings;

/// How finely a mesh is written.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum MeshLod {
    /// By the panel's level of detail, from the present view where it depends on that.
    #[default]
    AsShown,
    /// By a criterion that needs no view; none: the coarse quads.
    Fixed(Option<LodCriterion>),
}

/// What is to be written.
#[derive(Clone, Debug, PartialEq)]
pub enum SaveRequest {
    /// The session.
    Session(PathBuf),
    /// Meshes of neurons.
    Meshes(MeshOptions),
    /// A picture of the present view.
    Picture(PictureFile),
    /// Pictures along views or through time.
    Film(FilmOptions),
}

/// How meshes are written.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshOptions {
    /// A file for one, a folder for several.
    pub out: PathBuf,
    /// What kind of file.
    pub format: Format,
    /// How finely.
    pub lod: MeshLod,
    /// Quads instead of triangles.
    pub quads: bool,
    /// Straight between points.
    pub linear: bool,
    /// Disks at the ends.
    pub flat: bool,
    /// Where neurons are in the window instead of where they were traced.
    pub placed: bool,
    /// All that is shown instead of what is selected.
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
    /// Without a background.
    pub transparent: bool,
    /// Whether the file may be replaced.
    pub replace: bool,
}

/// A film: numbered pictures along key views, through a recording's time, or both.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmOptions {
    /// Name of the pictures; a number is added.
    pub picture: PictureFile,
    /// Pictures from one key view to the next; of a film from one view, all.
    pub frames: u32,
    /// Times (ms) of a recording at the beginning and the end; none: as it is now.
    pub time: Option<[f64; 2]>,
    /// Also a video, by ffmpeg.
    pub video: bool,
}

/// What the panel holds.
#[derive(Clone, Debug)]
pub struct SaveForm {
    /// As typed.
    pub mesh_out: String,
    /// As chosen.
    pub mesh: MeshOptions,
    /// As typed.
    pub picture_out: String,
    /// As chosen.
    pub picture: PictureFile,
    /// As typed.
    pub film_out: String,
    /// Pictures from one key view to the next.
    pub frames: u32,
    /// Whether a recording's time goes on meanwhile.
    pub over_time: bool,
    /// From and to (ms).
    pub time: [f64; 2],
    /// Also a video.
    pub video: bool,
    /// Whether ffmpeg is there; asked once.
    pub ffmpeg: Option<bool>,
}

impl SaveForm {
    pub(crate) fn new(settings: &Settings) -> Self {
        let at = |name: &str| settings.folder.join(name).display().to_string();
        Self {
            mesh_out: at("mesh.ply"),
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
            picture_out: at("picture.png"),
            picture: PictureFile {
                out: PathBuf::new(),
                size: settings.picture_size,
                samples: 16,
                transparent: false,
                replace: false,
            },
            film_out: at("film.png"),
            frames: 60,
            over_time: true,
            time: [0.0; 2],
            video: false,
            ffmpeg: None,
        }
    }
}
