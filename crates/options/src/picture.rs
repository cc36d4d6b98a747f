//! A picture as a value: what it shows and how, but for the cells themselves.

use neurotess_color::ColorScheme;
use neurotess_picture::color::Rgb;
use neurotess_picture::{Look, PictureOptions};
use serde::{Deserialize, Serialize};

use crate::OptionError;
use crate::groups::{
    CameraOptions, CellSelection, ColorOptions, LookOptions, MarkerOptions, RefinementOptions,
    ShapeOptions,
};
use crate::words::{ColorWhat, Lod, MeshBeside};

/// Width (pixels) of the lines of a wireframe.
const WIRE: f32 = 1.0;

/// Meshes beside the cells of a picture.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[cfg_attr(feature = "clap", command(next_help_heading = "Meshes"))]
#[serde(default, deny_unknown_fields)]
pub struct MeshesBeside {
    /// Show another mesh in the scene, such as a brain region, a segment of electron microscopy or a pipette:
    /// PLY, OBJ, STL, GLB or another format of neurotess check, in the coordinates of the scene (µm). Behind
    /// the file, in any order: color=COLOR; opacity=SHARE, 0 to 1; edges, to draw only the edges of its faces;
    /// scale=UM, the µm of a unit of the file (0.001: nm); fit, so that the camera fits it even if one can see
    /// through it. Repeatable
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE[,OPTION…]"))]
    pub mesh: Vec<MeshBeside>,
}

/// What a picture, or a series of them, shows, and how. Flags of `neurotess render`, keywords of Python's `render` and files
/// (JSON) have the same names and values.
///
/// ```
/// use neurotess_options::Picture;
/// use serde_json::json;
///
/// let mut picture = Picture::default();
/// picture.set("color_by", &json!("depth"))?;
/// picture.set("size", &json!([640, 480]))?;
/// assert_eq!(picture.to_json()["colors"]["color_by"], "depth");
/// assert_eq!(Picture::from_json(&picture.to_json())?, picture);
/// let error = picture.set("colour_by", &json!("type")).unwrap_err();
/// assert_eq!(error.to_string(), "there is no option 'colour_by': did you mean 'color_by'?");
/// # Ok::<(), neurotess_options::OptionError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct Picture {
    /// Size, legend, light.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub look: LookOptions,
    /// What colors tell, and which they are.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub colors: ColorOptions,
    /// From where one looks, and at which times.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub camera: CameraOptions,
    /// How finely surfaces are drawn.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub refinement: RefinementOptions,
    /// What of the cells is shown, and how their meshes are made.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub shape: ShapeOptions,
    /// Synapses and points.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub markers: MarkerOptions,
    /// Other meshes.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub meshes: MeshesBeside,
    /// Which cells of a circuit.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub cells: CellSelection,
}

impl Picture {
    /// Refuses options that do not go together.
    ///
    /// # Errors
    /// The first fault.
    pub fn check(&self) -> Result<(), OptionError> {
        self.refinement.mode()?;
        self.camera.check()?;
        self.camera.series()?;
        if self.colors.color_by.is_some() && self.colors.color_by_attribute.is_some() {
            return Err(OptionError::together(
                "--color-by cannot be used with --color-by-attribute: leave out one of them",
            ));
        }
        self.markers.check()
    }

    /// Refuses values without a report, and a report that is not colored by: of cells that have no numbers of their own.
    ///
    /// # Errors
    /// The first fault.
    pub fn check_values(&self) -> Result<(), OptionError> {
        let colors = &self.colors;
        match (colors.color_by, &colors.report) {
            (_, None) if self.camera.time.is_some() => {
                Err(OptionError::together("--time needs a --report, too"))
            }
            (Some(ColorWhat::Value), None) => {
                Err(OptionError::together("--color-by value needs a --report"))
            }
            (Some(other), Some(_)) if other != ColorWhat::Value => Err(OptionError::together(
                "a --report gives values: leave out --color-by",
            )),
            _ if colors.range.is_some() && !colors.is_number() => Err(OptionError::together(
                "--range is for numbers: use --color-by order, radius or depth, or a --report",
            )),
            _ => Ok(()),
        }
    }

    /// Greatest error (pixels) of surfaces.
    pub fn error(&self) -> f64 {
        self.refinement.error(self.look.wireframe)
    }

    /// Whether exploration draws it, as windows do while the camera moves.
    pub fn explores(&self) -> bool {
        self.refinement.lod == Some(Lod::Exploration)
    }

    /// The background: that of the options, that of the palette, or white; none if it is left out.
    pub fn background(&self) -> Option<Rgb> {
        let color = self.colors.behind().unwrap_or([255; 3]);
        (!self.look.transparent).then_some(color)
    }

    /// The colors that are asked for; `scale`: of numbers, instead of the color map's.
    pub fn scheme(&self, scale: Option<&[Rgb]>) -> ColorScheme {
        let background = self.background();
        let map = self.colors.colormap;
        let scale = match (scale, background.filter(|_| self.look.trim_colormap)) {
            (Some(own), _) => own.to_vec(),
            (None, Some(background)) => map.scale_before(background),
            (None, None) => map.scale(),
        };
        ColorScheme {
            palette: self.colors.base_palette(),
            own_colors: self.colors.own_colors(),
            background,
            scale,
            range: self.colors.range,
        }
    }

    /// What renderers take. `least_width`: of neurites (pixels).
    pub fn drawn(&self, least_width: f32) -> PictureOptions {
        PictureOptions {
            size: self.look.size.0,
            samples: self.look.samples.0,
            background: self.background(),
            look: Look {
                light: self.look.light.0,
                wire: if self.look.wireframe { WIRE } else { 0.0 },
                contrast: self.background(),
                least_width,
                ..Look::default()
            },
            occlusion: self.look.occlusion(),
            ..PictureOptions::default()
        }
    }
}
