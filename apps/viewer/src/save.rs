//! Saving: meshes, pictures, films. Plans are made here, the work is done beside the window.

use std::path::{Path, PathBuf};
use std::process::{Command as Program, Stdio};
use std::sync::Arc;
use std::sync::atomic::Ordering;

use glam::DAffine3;
use neurotess::generate::Generated;
use neurotess::mesh::{self, Format, Placed, Surface};
use neurotess::refine::{Caps, CoarseSurface, Levels, Path as Course, RefineOptions, Refinement};
use neurotess::render::{
    Ball, Choice, Gpu, Image, Occlusion, Overlay, OverlayOptions, PictureOptions, Placement,
    PngWriter, Studio,
};

use crate::document::{Criterion, Detail, Look};
use crate::scene::{self, Shown};
use crate::settings::Settings;
use crate::view::View;
use crate::worker::Job;
use crate::write::{part_of, write_whole};

/// How finely a mesh is written.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Fineness {
    /// By the panel's level: at the present view's distance where it depends on that.
    #[default]
    AsShown,
    /// The same level everywhere; 0: the coarse quads.
    Level(u32),
    /// Within a distance (µm).
    MaxError(f32),
}

/// How meshes are written.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshOptions {
    /// A file for one, a folder for several.
    pub out: PathBuf,
    /// What kind of file.
    pub format: Format,
    /// How finely.
    pub fineness: Fineness,
    /// Quads instead of triangles.
    pub quads: bool,
    /// Straight between points.
    pub linear: bool,
    /// Disks at the ends.
    pub flat: bool,
    /// Where neurons stand in the window instead of where they were traced.
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

/// A film: numbered pictures along key views.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmOptions {
    /// Name of the pictures; a number is added.
    pub picture: PictureFile,
    /// Pictures from one key view to the next.
    pub frames: u32,
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
            video: false,
            ffmpeg: None,
        }
    }
}

/// A cell to be written.
#[derive(Clone)]
pub(crate) struct MeshPlan {
    pub(crate) name: String,
    pub(crate) generated: Arc<Generated>,
    pub(crate) placement: Placement,
}

/// Writes meshes.
pub(crate) fn meshes(
    plans: &[MeshPlan],
    options: &MeshOptions,
    view: &View,
    detail: &Detail,
    height: f64,
    job: &Job,
) -> Result<String, String> {
    let files = mesh_files(plans, options)?;
    for file in &files {
        if !options.replace && file.exists() {
            return Err(format!(
                "{} exists: allow it to be replaced",
                file.display()
            ));
        }
    }
    let (mut faces, mut written) = (0, 0);
    for (plan, file) in plans.iter().zip(&files) {
        if job.is_cancelled() {
            return Err(format!("stopped after {written} of {} meshes", files.len()));
        }
        faces += write_mesh(plan, options, view, detail, height, file)?;
        written += 1;
        job.done.fetch_add(1, Ordering::Relaxed);
    }
    let what = match &files[..] {
        [one] => one.display().to_string(),
        many => format!("{} meshes in {}", many.len(), options.out.display()),
    };
    Ok(format!("Saved {what}: {faces} faces"))
}

/// The file of each plan. Equal names get a number.
fn mesh_files(plans: &[MeshPlan], options: &MeshOptions) -> Result<Vec<PathBuf>, String> {
    let extension = options.format.extension();
    if let [_] = plans {
        return Ok(vec![options.out.with_extension(extension)]);
    }
    if plans.is_empty() {
        return Err("nothing is selected: select neurons, or save all that show".into());
    }
    // A file's name for many: its stem names the folder.
    let folder = match Format::from_extension(&options.out) {
        Ok(_) => options.out.with_extension(""),
        Err(_) => options.out.clone(),
    };
    let mut files: Vec<PathBuf> = Vec::new();
    for plan in plans {
        let stem: String = plan
            .name
            .chars()
            .map(|c| {
                if c.is_alphanumeric() || "-_.".contains(c) {
                    c
                } else {
                    '_'
                }
            })
            .collect();
        let name = |n: usize| match n {
            0 => folder.join(format!("{stem}.{extension}")),
            n => folder.join(format!("{stem}_{n}.{extension}")),
        };
        let file = (0..).map(name).find(|file| !files.contains(file));
        files.extend(file);
    }
    Ok(files)
}

fn write_mesh(
    plan: &MeshPlan,
    options: &MeshOptions,
    view: &View,
    detail: &Detail,
    height: f64,
    file: &Path,
) -> Result<usize, String> {
    let coarse = &plan.generated.mesh;
    let refine = RefineOptions {
        path: if options.linear {
            Course::Linear
        } else {
            Course::Hermite
        },
        caps: if options.flat {
            Caps::Flat
        } else {
            Caps::Round
        },
        quads: options.quads && options.format.has_quads(),
    };
    let (refinement, quads);
    let surface: &dyn Surface = match levels(options.fineness, plan, view, detail, height) {
        Some(levels) => {
            refinement = Refinement::new(coarse, &levels, &refine);
            &refinement
        }
        None => {
            quads = CoarseSurface::new(coarse, options.format.has_quads());
            &quads
        }
    };
    let moved = options.placed.then(|| {
        let p = plan.placement;
        let linear =
            DAffine3::from_quat(p.rotation) * DAffine3::from_scale(glam::DVec3::splat(p.scale));
        Placed::new(surface, DAffine3::from_translation(p.translation) * linear)
    });
    let surface: &dyn Surface = moved.as_ref().map_or(surface, |moved| moved);
    write_whole(file, options.replace, |to| {
        mesh::write(surface, options.format, to).map_err(std::io::Error::other)
    })?;
    Ok(surface.triangle_count() + surface.quad_count())
}

fn levels(
    fineness: Fineness,
    plan: &MeshPlan,
    view: &View,
    detail: &Detail,
    height: f64,
) -> Option<Levels<'static>> {
    match fineness {
        Fineness::Level(0) => None,
        Fineness::Level(level) => Some(Levels::Homogeneous(level.min(64))),
        Fineness::MaxError(error) => Some(Levels::MaxError(error.max(1e-4))),
        Fineness::AsShown => {
            let camera = view.camera();
            let place = &plan.placement;
            let sight = neurotess::render::Sight::new(&camera, 1, height.max(1.0) as u32, 1e-3);
            let view = sight.local_view(place, plan.generated.mesh.origin);
            let choice = Choice::scaled(detail.choice(), place.scale);
            Some(match detail.criterion {
                Criterion::Homogeneous => Levels::Homogeneous(detail.level.clamp(1, 64)),
                _ => choice.levels(view, &[]),
            })
        }
    }
}

/// All that pictures need to know, free of the window.
pub(crate) struct Scenery {
    pub(crate) gpu: Arc<Gpu>,
    pub(crate) shown: Shown,
    pub(crate) look: Look,
    pub(crate) states: Vec<u32>,
    pub(crate) balls: Vec<Ball>,
}

/// Writes pictures of views: one, or a numbered series.
pub(crate) fn pictures(
    scenery: &Scenery,
    views: &[View],
    options: &PictureFile,
    job: &Job,
) -> Result<Vec<PathBuf>, String> {
    let stem = options
        .out
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let file = |i: usize| match views.len() {
        1 => options.out.with_extension("png"),
        _ => options.out.with_file_name(format!("{stem}_{i:04}.png")),
    };
    let files: Vec<PathBuf> = (0..views.len()).map(file).collect();
    for file in &files {
        if !options.replace && file.exists() {
            return Err(format!(
                "{} exists: allow it to be replaced",
                file.display()
            ));
        }
    }
    let gpu = &*scenery.gpu;
    let picture = picture_options(scenery, options);
    let mut maker =
        scene::maker(gpu, &scenery.shown, picture.sub_pixels(gpu)).map_err(|e| e.to_string())?;
    maker.set_refining(neurotess::render::Refining {
        choice: Choice::PixelError(0.25),
        wires: picture.look.wire > 0.0,
        ..Default::default()
    });
    let mut studio = Studio::new();
    studio.set_states(&scenery.states);
    for (view, file) in views.iter().zip(&files) {
        if job.is_cancelled() {
            return Err("stopped".into());
        }
        let camera = view.camera();
        let mut picture = picture;
        picture.look.clip = scene::clip(&scenery.look, &scenery.balls);
        let overlay = OverlayOptions {
            legend: scenery
                .look
                .legend
                .then(|| scenery.shown.colouring.legend.clone()),
            scale_bar: scenery.look.scale_bar.then_some(0.0),
            background: picture.background,
        };
        let overlay = Overlay::new(&overlay, options.size, &[camera], &scenery.balls);
        let near = camera.near(&scenery.balls);
        let part = part_of(file)?;
        let broken = |e: std::io::Error| {
            format!(
                "{} cannot be written ({e}): check space and permissions",
                file.display()
            )
        };
        if let Some(folder) = file.parent().filter(|f| !f.as_os_str().is_empty()) {
            std::fs::create_dir_all(folder).map_err(broken)?;
        }
        let to = std::io::BufWriter::new(std::fs::File::create(&part).map_err(broken)?);
        let mut png = PngWriter::new(to, options.size, options.transparent).map_err(broken)?;
        let table = &scenery.shown.colouring.table;
        let painted = studio.paint(
            gpu,
            &mut maker,
            &camera,
            near,
            table,
            &picture,
            |top, mut band: Image| {
                overlay.lay_on(top, &mut band);
                png.write(&band)
            },
        );
        let painted = painted.map_err(|e| e.to_string());
        let done = painted.and_then(|_| png.finish().map_err(broken));
        let done = done.and_then(|()| std::fs::rename(&part, file).map_err(broken));
        if let Err(e) = done {
            drop(std::fs::remove_file(&part));
            return Err(e);
        }
        job.done.fetch_add(1, Ordering::Relaxed);
    }
    Ok(files)
}

/// Tiles are small: the window draws between them.
const TILE: u32 = 640;

fn picture_options(scenery: &Scenery, options: &PictureFile) -> PictureOptions {
    let look = &scenery.look;
    PictureOptions {
        size: options.size,
        samples: options.samples,
        background: (!options.transparent).then_some(look.background),
        look: scene::surface_look(look),
        occlusion: if look.occlusion {
            Occlusion::Fit
        } else {
            Occlusion::Off
        },
        tile: if scenery.gpu.adapter.software {
            TILE
        } else {
            4 * TILE
        },
    }
}

/// Views of a film: `frames` from each key view to the next, and the last.
pub(crate) fn film_views(keys: &[View], frames: u32) -> Vec<View> {
    let frames = frames.max(1);
    let mut views: Vec<View> = keys
        .windows(2)
        .flat_map(|pair| {
            (0..frames).map(|i| {
                let t = f64::from(i) / f64::from(frames);
                pair[0].between(&pair[1], t * t * (3.0 - 2.0 * t))
            })
        })
        .collect();
    views.extend(keys.last());
    views
}

/// Whether ffmpeg is installed.
pub(crate) fn has_ffmpeg() -> bool {
    let asked = Program::new("ffmpeg")
        .arg("-version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    asked.is_ok_and(|status| status.success())
}

/// Makes a video of numbered pictures, 30 in a second.
pub(crate) fn video(first: &Path) -> Result<PathBuf, String> {
    let text = first.display().to_string();
    let pattern = text.replace("_0000.png", "_%04d.png");
    let out = PathBuf::from(text.replace("_0000.png", ".mp4"));
    let done = Program::new("ffmpeg")
        .args([
            "-y",
            "-loglevel",
            "error",
            "-framerate",
            "30",
            "-i",
            &pattern,
        ])
        .args([
            "-vf",
            "pad=ceil(iw/2)*2:ceil(ih/2)*2",
            "-pix_fmt",
            "yuv420p",
        ])
        .arg(&out)
        .stdin(Stdio::null())
        .output()
        .map_err(|e| {
            format!("ffmpeg cannot be started ({e}): install it; the pictures are there")
        })?;
    if done.status.success() {
        return Ok(out);
    }
    let words = String::from_utf8_lossy(&done.stderr);
    let words = words.lines().last().unwrap_or("no word").to_owned();
    Err(format!("ffmpeg failed ({words}): the pictures are there"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::SomaEdit;
    use crate::sources;

    fn plan(name: &str) -> MeshPlan {
        let star = sources::sample(neurotess::synth::Kind::Star);
        let source = sources::load(&star, SomaEdit::default()).expect("grown");
        MeshPlan {
            name: name.into(),
            generated: source.generated,
            placement: Placement {
                translation: glam::DVec3::X * 1000.0,
                ..Placement::default()
            },
        }
    }

    fn options(out: PathBuf) -> MeshOptions {
        MeshOptions {
            out,
            format: Format::Ply,
            fineness: Fineness::Level(1),
            quads: false,
            linear: false,
            flat: false,
            placed: true,
            all: true,
            replace: false,
        }
    }

    #[test]
    fn meshes_are_closed_stand_where_told_and_replace_nothing_unasked() {
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path().join("a.ply");
        let view = View::default();
        let write = |fineness, replace| {
            let options = MeshOptions {
                fineness,
                replace,
                ..options(out.clone())
            };
            meshes(
                &[plan("a")],
                &options,
                &view,
                &Detail::default(),
                600.0,
                &Job::new("", 1),
            )
        };
        for fineness in [
            Fineness::Level(1),
            Fineness::Level(0),
            Fineness::AsShown,
            Fineness::MaxError(0.1),
        ] {
            write(fineness, true).expect("written");
            let bytes = std::fs::read(&out).expect("there");
            let mesh = mesh::read_bytes(&bytes, Format::Ply).expect("a mesh");
            assert!(mesh::check(&mesh).closed, "{fineness:?}");
            let x = mesh.origin.x + f64::from(mesh.vertices[0].position.x);
            assert!(x > 300.0, "{x}");
        }
        assert!(
            write(Fineness::Level(1), false)
                .expect_err("is there")
                .contains("exists")
        );
    }

    #[test]
    fn many_meshes_go_to_a_folder_with_names_of_their_own() {
        let plans = [plan("a"), plan("a"), plan("b/c")];
        let files = mesh_files(&plans, &options(PathBuf::from("out/all.ply"))).expect("named");
        let names: Vec<String> = files
            .iter()
            .map(|f| f.display().to_string().replace('\\', "/"))
            .collect();
        assert_eq!(
            names,
            ["out/all/a.ply", "out/all/a_1.ply", "out/all/b_c.ply"]
        );
        assert!(mesh_files(&[], &options(PathBuf::new())).is_err());
    }

    #[test]
    fn films_begin_and_end_at_their_key_views() {
        let keys = [
            View::default(),
            View::default().orbited(1.0, 0.2, glam::DVec3::Y),
        ];
        let views = film_views(&keys, 10);
        assert_eq!(views.len(), 11);
        let eye = |view: &View| view.camera().eye();
        assert!(eye(&views[0]).distance(eye(&keys[0])) < 1e-6);
        assert!(eye(&views[10]).distance(eye(&keys[1])) < 1e-6);
    }
}
