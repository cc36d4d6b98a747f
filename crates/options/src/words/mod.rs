//! Values of options, each with its form as text: what flags have, and files and keywords too.

mod beside;
mod bytes;
mod color;
mod edits;
mod fit;
mod ids;
mod light;
mod names;
mod number;
mod palette;
mod point;
mod ring;
mod size;
mod spines;
mod time;
mod types;

pub use beside::MeshBeside;
pub use bytes::Bytes;
pub use color::{Color, SetColor};
pub use edits::{
    Affine, AxisName, Distance, EditedTypes, OutlierFactor, Renamed, Rotation, Smoothing,
    SourceUnit,
};
pub use fit::Fit;
pub use ids::{Ids, Region};
pub use light::LightFrom;
pub use names::{ColorWhat, DrawnAs, Lod, SideOfSynapse, Soma, ViewSide};
pub use number::{NotNegative, Positive, RadiusFactor, Within};
pub use palette::{PaletteName, palette};
pub use point::Point;
pub use ring::Ring;
pub use size::Size;
pub use spines::{Places, SpinePlacing};
pub use time::{MOST_PICTURES, Time};
pub use types::Types;
