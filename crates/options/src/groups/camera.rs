//! From where one looks, and at which times.

use serde::{Deserialize, Serialize};

use crate::OptionError;
use crate::words::{Fit, MOST_PICTURES, Point, Time, ViewSide, Within};

/// Pictures of a turn around the scene, if nothing says how many.
const USUAL_FRAMES: u32 = 36;
/// Vertical angle of view (degrees), if nothing says it.
const USUAL_FOV: f64 = 20.0;

/// From where one looks, and at which times: one camera, or one for each picture of a series.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[cfg_attr(feature = "clap", command(next_help_heading = "Camera"))]
#[serde(default, deny_unknown_fields)]
pub struct CameraOptions {
    /// Look from this side; the camera fits the scene
    #[cfg_attr(
        feature = "clap",
        arg(long, value_enum, default_value_t, value_name = "SIDE")
    )]
    pub view: ViewSide,
    /// Of a session: look from the view that the window saved under this name
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "NAME", conflicts_with_all = ["view", "eye"])
    )]
    pub saved_view: Option<String>,
    /// Position of the eye (µm)
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "X,Y,Z",
            conflicts_with = "view",
            allow_hyphen_values = true
        )
    )]
    pub eye: Option<Point>,
    /// What the eye looks at (µm)
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)
    )]
    pub target: Option<Point>,
    /// What is upwards in the picture
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "X,Y,Z",
            default_value = "0,1,0",
            allow_hyphen_values = true
        )
    )]
    pub up: Point,
    /// Vertical angle of view (degrees)
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "DEG", default_value_t = USUAL_FOV)
    )]
    pub fov: f64,
    /// Look without perspective: lengths are true at all depths. The picture is this high (µm), or
    /// fits the scene; with --eye, it shows what --fov shows at the target
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "UM", num_args = 0..=1, default_missing_value = "fit")
    )]
    pub orthographic: Option<Fit>,
    /// Go once around the scene, in --frames pictures
    #[cfg_attr(feature = "clap", arg(long))]
    pub turntable: bool,
    /// Number of pictures of --turntable [default: 36] or of --time FROM:TO: OUT_0000.png and so on
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub frames: Option<Within<1, MOST_PICTURES>>,
    /// Time (ms) in the report [default: its first]; FROM:TO:STEP, TO left out, makes a series of
    /// pictures
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "MS",
            allow_hyphen_values = true,
            help_heading = "Colors"
        )
    )]
    pub time: Option<Time>,
    /// Times (ms) of all pictures instead of `time`: of programs that have their own.
    #[cfg_attr(feature = "clap", arg(skip))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub picture_times: Option<Vec<f64>>,
}

impl Default for CameraOptions {
    fn default() -> Self {
        Self {
            view: ViewSide::default(),
            saved_view: None,
            eye: None,
            target: None,
            up: Point(glam::DVec3::Y),
            fov: USUAL_FOV,
            orthographic: None,
            turntable: false,
            frames: None,
            time: None,
            picture_times: None,
        }
    }
}

impl CameraOptions {
    /// Refuses options that do not go together.
    ///
    /// # Errors
    /// An eye without a target, or the other way around; a direction upwards without them.
    pub fn check(&self) -> Result<(), OptionError> {
        let refused = |why: &str| Err(OptionError::together(why));
        match (self.eye, self.target) {
            (Some(_), None) => refused("--eye needs --target, too"),
            (None, Some(_)) => refused("--target needs --eye, too"),
            (Some(_), _) if self.view != ViewSide::default() => {
                refused("--view cannot be used with --eye: leave out one of them")
            }
            (None, None) if self.up != Self::default().up => refused("--up needs --eye, too"),
            _ => Ok(()),
        }
    }

    /// Number of pictures of a series; none: one picture.
    ///
    /// # Errors
    /// `frames` without a series, or a series in time that has no number of pictures or too many.
    pub fn series(&self) -> Result<Option<u32>, OptionError> {
        if let Some(times) = &self.picture_times {
            return match u32::try_from(times.len()) {
                Ok(count) if count <= MOST_PICTURES => Ok(Some(count)),
                _ => Err(OptionError::together(format!(
                    "{} times are more than {MOST_PICTURES}",
                    times.len()
                ))),
            };
        }
        let frames = self.frames.map(|frames| frames.0);
        match self.time {
            Some(time @ Time::Series(..)) => Ok(Some(time.all(frames)?.len() as u32)),
            _ if self.turntable => Ok(Some(frames.unwrap_or(USUAL_FRAMES))),
            _ if frames.is_some() => Err(OptionError::together(
                "--frames is for --turntable, and for --time FROM:TO",
            )),
            _ => Ok(None),
        }
    }

    /// The times (ms) of all pictures; none if no option says one.
    ///
    /// # Errors
    /// A series that has no number of pictures, or too many.
    pub fn all_times(&self) -> Result<Option<Vec<f64>>, OptionError> {
        let frames = self.frames.map(|frames| frames.0);
        match (&self.picture_times, self.time) {
            (Some(times), _) => Ok(Some(times.clone())),
            (None, Some(time)) => time.all(frames).map(Some),
            (None, None) => Ok(None),
        }
    }
}
