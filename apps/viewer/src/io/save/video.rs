//! Videos of numbered pictures, by ffmpeg.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command as Program, Stdio};
use std::time::Duration;

use neurotess::output::Output;

use super::existing;
use crate::io::task::Progress;
use crate::model::targets::video_file;

/// Whether ffmpeg is installed.
pub(crate) fn has_ffmpeg() -> bool {
    let asked = Program::new("ffmpeg")
        .arg("-version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    asked.is_ok_and(|status| status.success())
}

/// Makes a video of numbered pictures, 30 per second. If it is stopped or fails, it leaves no file.
pub(crate) fn video(first: &Path, replace: bool, progress: &Progress) -> Result<PathBuf, String> {
    let text = first.display().to_string();
    let pattern = text.replace("_0000.png", "_%04d.png");
    let out = video_file(first);
    let kept = |e: String| format!("{e}; the pictures are there");
    let output = Output::create(&out, existing(replace)).map_err(|e| kept(e.to_string()))?;
    let mut ffmpeg = Program::new("ffmpeg")
        .args(["-y", "-loglevel", "error", "-framerate", "30"])
        .args(["-i", &pattern])
        .args(["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2"])
        .args(["-pix_fmt", "yuv420p", "-f", "mp4"])
        .arg(output.part())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|e| kept(format!("ffmpeg cannot be started ({e}): install it")))?;
    wait(&mut ffmpeg, progress).map_err(kept)?;
    output.finish().map_err(|e| kept(e.to_string()))?;
    Ok(out)
}

/// Waits until ffmpeg has finished, or ends it if the task is canceled.
fn wait(ffmpeg: &mut Child, progress: &Progress) -> Result<(), String> {
    loop {
        if progress.is_canceled() {
            drop(ffmpeg.kill());
            drop(ffmpeg.wait());
            return Err("stopped before the video was whole".into());
        }
        match ffmpeg.try_wait() {
            Ok(None) => std::thread::sleep(Duration::from_millis(40)),
            Ok(Some(status)) if status.success() => return Ok(()),
            Ok(Some(_)) => {
                let mut text = String::new();
                if let Some(mut from) = ffmpeg.stderr.take() {
                    drop(from.read_to_string(&mut text));
                }
                let last = text.lines().last().unwrap_or("no word");
                return Err(format!("ffmpeg failed ({last})"));
            }
            Err(e) => return Err(format!("ffmpeg cannot be waited for ({e})")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_video_that_is_stopped_or_refused_leaves_nothing() {
        let folder = tempfile::tempdir().expect("a folder");
        let first = folder.path().join("f_0000.png");
        let progress = Progress::new("", "", 1);
        progress
            .canceled
            .store(true, std::sync::atomic::Ordering::Relaxed);
        // The error says that ffmpeg is missing, or else that it was stopped.
        let error = video(&first, false, &progress).expect_err("stopped");
        assert!(error.contains("the pictures are there"), "{error}");
        let left = std::fs::read_dir(folder.path()).expect("a folder").count();
        assert_eq!(left, 0);
        std::fs::write(folder.path().join("f.mp4"), "mine").expect("written");
        let error = video(&first, false, &progress).expect_err("is there");
        assert!(error.contains("exists"), "{error}");
        let kept = std::fs::read(folder.path().join("f.mp4")).expect("there");
        assert_eq!(kept, b"mine");
    }
}
