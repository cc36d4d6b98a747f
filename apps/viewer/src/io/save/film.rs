//! Films: numbered pictures along key views, and a video of them.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command as Program, Stdio};
use std::time::Duration;

use neurotess::output::Output;

use super::{PictureFile, existing};
use crate::io::tasks::Job;
use crate::model::view::View;

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

/// A picture to be drawn: from where, and at which time (ms) of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Still {
    pub(crate) view: View,
    pub(crate) time: Option<f64>,
}

/// Number of pictures of a film along so many key views.
pub(crate) fn length(keys: usize, frames: u32, over_time: bool) -> usize {
    let frames = frames.max(1) as usize;
    match (keys, over_time) {
        (2.., _) => (keys - 1) * frames + 1,
        (_, true) => frames,
        (_, false) => 0,
    }
}

/// Pictures of a film: `frames` from each key view to the next, and the last. With fewer than two key views
/// one stays where one is (`now`), and only the time goes on.
pub(crate) fn stills(
    keys: &[View],
    now: View,
    frames: u32,
    time: Option<[f64; 2]>,
    at: Option<f64>,
) -> Vec<Still> {
    let count = length(keys.len(), frames, time.is_some());
    let last = (count.max(2) - 1) as f64;
    let still = |i: usize| Still {
        view: view(keys, now, i, frames.max(1) as usize),
        time: match time {
            Some([from, to]) => Some(from + (to - from) * i as f64 / last),
            None => at,
        },
    };
    (0..count).map(still).collect()
}

fn view(keys: &[View], now: View, picture: usize, frames: usize) -> View {
    let (place, t) = (picture / frames, (picture % frames) as f64 / frames as f64);
    match keys.get(place..) {
        Some([from, to, ..]) => from.between(to, t * t * (3.0 - 2.0 * t)),
        _ if keys.len() > 1 => keys[keys.len() - 1],
        _ => now,
    }
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

/// Makes a video of numbered pictures, 30 in a second. Stopped or failed, it leaves none.
pub(crate) fn video(first: &Path, replace: bool, job: &Job) -> Result<PathBuf, String> {
    let text = first.display().to_string();
    let pattern = text.replace("_0000.png", "_%04d.png");
    let out = PathBuf::from(text.replace("_0000.png", ".mp4"));
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
    wait(&mut ffmpeg, job).map_err(kept)?;
    output.finish().map_err(|e| kept(e.to_string()))?;
    Ok(out)
}

/// Waits until it is done, or ends it.
fn wait(ffmpeg: &mut Child, job: &Job) -> Result<(), String> {
    loop {
        if job.is_canceled() {
            drop(ffmpeg.kill());
            drop(ffmpeg.wait());
            return Err("stopped before the video was whole".into());
        }
        match ffmpeg.try_wait() {
            Ok(None) => std::thread::sleep(Duration::from_millis(40)),
            Ok(Some(status)) if status.success() => return Ok(()),
            Ok(Some(_)) => {
                let mut words = String::new();
                if let Some(mut from) = ffmpeg.stderr.take() {
                    drop(from.read_to_string(&mut words));
                }
                let last = words.lines().last().unwrap_or("no word");
                return Err(format!("ffmpeg failed ({last})"));
            }
            Err(e) => return Err(format!("ffmpeg cannot be waited for ({e})")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keys() -> [View; 2] {
        let turned = View::default().orbited(1.0, 0.2, glam::DVec3::Y);
        [View::default(), turned]
    }

    #[test]
    fn films_begin_and_end_at_their_key_views() {
        let keys = keys();
        let stills = stills(&keys, View::default(), 10, None, Some(3.0));
        assert_eq!(stills.len(), 11);
        let eye = |view: &View| view.camera().eye();
        assert!(eye(&stills[0].view).distance(eye(&keys[0])) < 1e-6);
        assert!(eye(&stills[10].view).distance(eye(&keys[1])) < 1e-6);
        assert!(stills.iter().all(|still| still.time == Some(3.0)));
    }

    #[test]
    fn time_goes_on_from_one_view_and_along_several() {
        let [now, other] = keys();
        let one = stills(&[], now, 5, Some([10.0, 30.0]), None);
        let times: Vec<Option<f64>> = one.iter().map(|still| still.time).collect();
        assert_eq!(times, [10.0, 15.0, 20.0, 25.0, 30.0].map(Some));
        assert!(one.iter().all(|still| still.view == now));
        let along = stills(&[now, other], now, 4, Some([0.0, 8.0]), None);
        assert_eq!((along.len(), along[4].time), (5, Some(8.0)));
        assert_eq!(stills(&[now], now, 5, None, None), []);
    }

    #[test]
    fn a_video_that_is_stopped_or_refused_leaves_nothing() {
        let folder = tempfile::tempdir().expect("a folder");
        let first = folder.path().join("f_0000.png");
        let job = Job::new("", "", 1);
        job.canceled
            .store(true, std::sync::atomic::Ordering::Relaxed);
        // Without ffmpeg it says so, with it that it was stopped.
        let error = video(&first, false, &job).expect_err("stopped");
        assert!(error.contains("the pictures are there"), "{error}");
        let left = std::fs::read_dir(folder.path()).expect("a folder").count();
        assert_eq!(left, 0);
        std::fs::write(folder.path().join("f.mp4"), "mine").expect("written");
        let error = video(&first, false, &job).expect_err("is there");
        assert!(error.contains("exists"), "{error}");
        let kept = std::fs::read(folder.path().join("f.mp4")).expect("there");
        assert_eq!(kept, b"mine");
    }
}
