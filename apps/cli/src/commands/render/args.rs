//! `neurotess render`: its options.

use std::path::PathBuf;

use clap::Args;
use neurotess::drawing::{DrawError, DrawOptions, Host, picture_of_png};
use neurotess::options::GivenPicture;
use neurotess::options::groups::DeviceOptions;

use crate::options::cache::CacheArgs;

/// `neurotess render`
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  neurotess render cell.swc -o cell.png
  neurotess render cell.swc -o cell.png --color-by depth --colormap magma --scale-bar
  neurotess render cell.swc -o close.png --eye 0,20,80 --target 0,20,0 --wireframe --level 3
  neurotess render a.swc b.swc -o both.png --color-by neuron --transparent
  neurotess render cell.swc -o own.png --palette mine.toml --set-color axon=#ff8800
  neurotess render cell.swc -o turn.png --turntable --frames 120
  neurotess render other.swc -o other.png --like cell.png
  neurotess render circuit/ -o circuit.png --node-set Layer5 --view iso
  neurotess render circuit/ -o all.png --lod exploration --budget 1000000
  neurotess render circuit/ -o fires.png --report voltage.h5 --time 14.5 --range=-80,30
  neurotess render circuit/ -o inputs.png --nodes 7 --synapses --marker-color-by conductance
  neurotess render circuit/ -o region.png --mesh region.obj,opacity=0.2,fit
  neurotess render circuit/ -o film.png --report voltage.h5 --time 0:100:0.5")]
pub(crate) struct RenderArgs {
    /// Morphology files, folders (searched recursively) or globs, all in one picture; or one
    /// circuit, or one session of neurotess view, in its own view and look
    #[arg(required = true, value_name = "INPUT")]
    pub(crate) inputs: Vec<PathBuf>,
    /// The picture, - for standard output; of a series NAME_0000.png and so on
    #[arg(short, long, value_name = "OUT.png")]
    pub(crate) out: PathBuf,
    /// Replace files that exist
    #[arg(long)]
    pub(crate) force: bool,
    /// Draw as this picture was drawn, a PNG file of render or of Python: camera, colors, look. Options that are
    /// given go before its own
    #[arg(long, value_name = "PICTURE.png")]
    pub(crate) like: Option<PathBuf>,
    /// Do not tell in the PNG file how it was made
    #[arg(long)]
    pub(crate) no_recipe: bool,
    #[command(flatten)]
    pub(crate) device: DeviceOptions,
    /// Write what the picture cost to this file (JSON)
    #[arg(long, value_name = "FILE")]
    pub(crate) stats: Option<PathBuf>,
    /// Take every warning of the reader as an error
    #[arg(long)]
    pub(crate) strict: bool,
    #[command(flatten)]
    pub(crate) cache: CacheArgs,
    #[command(flatten)]
    pub(crate) given: GivenPicture,
}

impl RenderArgs {
    /// All that is asked for.
    ///
    /// # Errors
    /// The picture that it is to be like does not tell how it was made.
    pub(crate) fn options(&self, host: &dyn Host) -> Result<DrawOptions, DrawError> {
        let GivenPicture { picture, given } = &self.given;
        let picture = match &self.like {
            Some(like) => {
                let recipe = picture_of_png(like)?;
                if let Some(warning) = recipe.warning(like) {
                    host.warning(&warning);
                }
                recipe.picture.with(picture, given)
            }
            None => picture.clone(),
        };
        let mut options = DrawOptions::from(picture);
        options.device = self.device.clone();
        options.no_cache = self.cache.no_cache;
        options.strict = self.strict;
        Ok(options)
    }
}
