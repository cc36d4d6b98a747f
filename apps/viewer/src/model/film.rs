//! The pictures of a film: along key views, through the time of a recording, or both.

use crate::model::view::View;

/// A picture of a film: its view, and the time (ms) of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FilmFrame {
    pub(crate) view: View,
    pub(crate) time: Option<f64>,
}

/// Number of pictures of a film along this number of key views.
pub(crate) fn length(keys: usize, frames: u32, over_time: bool) -> usize {
    let frames = frames.max(1) as usize;
    match (keys, over_time) {
        (2.., _) => (keys - 1) * frames + 1,
        (_, true) => frames,
        (_, false) => 0,
    }
}

/// The pictures of a film: `frames` from each key view to the next, and the last key view. With
/// fewer than two key views the camera stays at the current view (`now`), and only the time goes
/// on.
pub(crate) fn film_frames(
    keys: &[View],
    now: View,
    frames: u32,
    time: Option<[f64; 2]>,
    at: Option<f64>,
) -> Vec<FilmFrame> {
    let count = length(keys.len(), frames, time.is_some());
    let last = (count.max(2) - 1) as f64;
    let film_frame = |i: usize| FilmFrame {
        view: view(keys, now, i, frames.max(1) as usize),
        time: match time {
            Some([from, to]) => Some(from + (to - from) * i as f64 / last),
            None => at,
        },
    };
    (0..count).map(film_frame).collect()
}

fn view(keys: &[View], now: View, picture: usize, frames: usize) -> View {
    let (place, t) = (picture / frames, (picture % frames) as f64 / frames as f64);
    match keys.get(place..) {
        Some([from, to, ..]) => from.between(to, t * t * (3.0 - 2.0 * t)),
        _ if keys.len() > 1 => keys[keys.len() - 1],
        _ => now,
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
        let film_frames = film_frames(&keys, View::default(), 10, None, Some(3.0));
        assert_eq!(film_frames.len(), 11);
        let eye = |view: &View| view.camera().eye();
        assert!(eye(&film_frames[0].view).distance(eye(&keys[0])) < 1e-6);
        assert!(eye(&film_frames[10].view).distance(eye(&keys[1])) < 1e-6);
        assert!(
            film_frames
                .iter()
                .all(|film_frame| film_frame.time == Some(3.0))
        );
    }

    #[test]
    fn time_goes_on_from_one_view_and_along_several() {
        let [now, other] = keys();
        let one = film_frames(&[], now, 5, Some([10.0, 30.0]), None);
        let times: Vec<Option<f64>> = one.iter().map(|film_frame| film_frame.time).collect();
        assert_eq!(times, [10.0, 15.0, 20.0, 25.0, 30.0].map(Some));
        assert!(one.iter().all(|film_frame| film_frame.view == now));
        let along = film_frames(&[now, other], now, 4, Some([0.0, 8.0]), None);
        assert_eq!((along.len(), along[4].time), (5, Some(8.0)));
        assert_eq!(film_frames(&[now], now, 5, None, None), []);
    }
}
