//! Saving: meshes, pictures, films. Plans are made here, the work is done beside the window.

mod film;
mod meshes;

use std::path::PathBuf;

use neurotess::mesh::Format;
use neurotess::output::Existing;

use crate::model::settings::Settings;

pub use crate::scene::pictures::PictureFile;
pub(crate) use crate::scene::pictures::{Scenery, pictures};
pub use film::FilmOptions;
pub(crate) use film::{Still, has_ffmpeg, length, stills, video};
pub use meshes::{Fineness, MeshOptions};
pub(crate) use meshes::{MeshPlan, meshes};

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
                fineness: Fineness::Level(4),
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

pub(crate) fn existing(replace: bool) -> Existing {
    match replace {
        true => Existing::Replace,
        false => Existing::Refuse("allow it to be replaced"),
    }
}
