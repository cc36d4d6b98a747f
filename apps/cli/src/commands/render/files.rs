//! Files of pictures: their names, and how they are written.

use std::io::BufWriter;
use std::path::{Path, PathBuf};

use neurotess::drawing::{Cost, DrawError, begin_png};
use neurotess::options::Picture;
use neurotess::picture::Image;

use super::args::RenderArgs;
use crate::io::output::{self, OutputError};
use crate::report::usage;

/// Names of the pictures.
pub(super) fn names(out: &Path, picture: &Picture) -> anyhow::Result<Vec<PathBuf>> {
    let series = picture.camera.series();
    let series = series.map_err(|e| super::told(e.into()))?;
    let png = out
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("png"));
    if output::is_standard(out) {
        return match series {
            None => Ok(vec![out.to_path_buf()]),
            Some(_) => usage("standard output takes one picture: name a series OUT.png"),
        };
    }
    let Some(stem) = out.file_stem().filter(|_| png) else {
        return usage(format!(
            "{}: pictures are PNG files: name it OUT.png",
            out.display()
        ));
    };
    let Some(frames) = series else {
        return Ok(vec![out.to_path_buf()]);
    };
    let stem = stem.to_string_lossy();
    let name = |frame| out.with_file_name(format!("{stem}_{frame:04}.png"));
    Ok((0..frames).map(name).collect())
}

/// Writes a picture band by band. The file appears whole or not at all.
pub(super) fn write(
    path: &Path,
    args: &RenderArgs,
    (picture, recipe): (&Picture, &str),
    paint: impl FnOnce(&mut dyn FnMut(u32, Image) -> Result<(), DrawError>) -> Result<Cost, DrawError>,
) -> Result<Cost, DrawError> {
    let mut output = output::begin(path, args.force)?;
    let file = output
        .file()
        .try_clone()
        .map_err(|e| OutputError::broken(path, e))?;
    let fault = |e: std::io::Error| OutputError::broken(path, e);
    let png = begin_png(
        BufWriter::new(file),
        picture,
        (!args.no_recipe).then_some(recipe),
    );
    let mut png = png.map_err(fault)?;
    let cost = paint(&mut |_, band| Ok(png.write(&band).map_err(fault)?))?;
    png.finish().map_err(fault)?;
    output.finish()?;
    Ok(cost)
}
