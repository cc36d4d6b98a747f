//! Films: numbered pictures along key views, and a video of them.

use std::path::{Path, PathBuf};
use std::process::{Command as Program, Stdio};

use super::PictureFile;
use crate::view::View;

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
