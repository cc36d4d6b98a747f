//! Legend, scale bar and axes, and the cameras that leave room for them.

use neurotess_options::words::Fit;
use neurotess_picture::overlay::{Overlay, OverlayOptions};
use neurotess_picture::{BoundingSphere, Camera, PictureOptions};

use crate::cameras;
use crate::colors::PictureColors;
use crate::host::Host;
use crate::options::DrawOptions;

/// Legend and scale bar, and the cameras. If the legend would cover something, the camera is
/// changed to make room for it, if possible.
pub(crate) fn overlay(
    asked: &DrawOptions,
    colored: &PictureColors,
    cameras: Vec<Camera>,
    spheres: &[BoundingSphere],
) -> (Overlay, Vec<Camera>) {
    let picture = &asked.picture;
    let options = OverlayOptions {
        legend: (!picture.look.no_legend).then(|| colored.legend(0)),
        scale_bar: picture.look.scale_bar.map(|bar| match bar {
            Fit::Auto => 0.0,
            Fit::Length(length) => length,
        }),
        axes: picture.look.axes,
        background: picture.background(),
    };
    let refitted = |margins| cameras::refitted(picture, spheres, margins);
    Overlay::with_room(&options, picture.look.size.0, cameras, spheres, refitted)
}

/// Tells of what is not as the options ask.
pub(crate) fn tell_lowered(
    options: &PictureOptions,
    samples: u32,
    overlay: &Overlay,
    host: &dyn Host,
) {
    let taken = options.samples_taken();
    if taken != samples {
        host.warning(&format!("{samples} samples: {taken} are taken"));
    }
    if overlay.legend_left_out {
        host.warning("the legend is left out: it needs a larger --size, or use --no-legend");
    }
    if overlay.bar_left_out {
        host.warning(
            "the scale bar is left out: it is longer than the picture is wide, or shorter than a pixel: choose another \
             length (µm) for --scale-bar, or one that fits",
        );
    }
}
