//! Pictures as files, which tell how they were made.

use std::fs::File;
use std::io::{BufReader, BufWriter, Write};
use std::path::Path;

use neurotess_formats::regular;
use neurotess_options::{OptionError, Picture};
use neurotess_output::{Existing, Output, OutputError};
use neurotess_picture::{Image, PngWriter, png_text};
use serde_json::{Value, json};

use crate::error::DrawError;

/// The keyword of PNG files under which they tell how they were made.
pub const KEYWORD: &str = "neurotess";
/// Raised when files are read otherwise than before.
const FORMAT: u64 = 1;

/// A finished picture.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnImage {
    /// Its pixels.
    pub image: Image,
    /// How it was made.
    pub picture: Picture,
    /// The same as the file tells it.
    pub(crate) recipe: String,
}

impl DrawnImage {
    /// Saves it as PNG, whole or not at all; a file of this name is replaced. The file tells how it was made.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn save(&self, file: impl AsRef<Path>) -> Result<(), DrawError> {
        let path = file.as_ref();
        let broken = |e: std::io::Error| OutputError::broken(path, e);
        let mut output = Output::create(path, Existing::Replace)?;
        let file = output.file().try_clone().map_err(broken)?;
        let mut png =
            begin_png(BufWriter::new(file), &self.picture, Some(&self.recipe)).map_err(broken)?;
        png.write(&self.image).map_err(broken)?;
        png.finish().map_err(broken)?;
        output.finish()?;
        Ok(())
    }
}

/// Begins the file of a picture, which tells how it was made, if it is to.
///
/// # Errors
/// Those of the file.
pub fn begin_png<W: Write + 'static>(
    file: W,
    picture: &Picture,
    recipe: Option<&str>,
) -> std::io::Result<PngWriter<W>> {
    let look = &picture.look;
    let text = recipe.map(|recipe| (KEYWORD, recipe));
    PngWriter::with_text(file, look.size.0, look.transparent, text)
}

/// How a picture is made, as a file tells it. `left_out`: what it shows that the options do not tell.
pub fn recipe_of(picture: &Picture, left_out: &[&str]) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let picture = without_folders(picture);
    let mut told = json!({ "format": FORMAT, "version": version, "picture": picture });
    if !left_out.is_empty() {
        told["left_out"] = json!(left_out);
    }
    told.to_string()
}

/// What a file tells of a picture: names of files without their folders, which are nobody else's business.
fn without_folders(picture: &Picture) -> Value {
    let name = |path: &mut std::path::PathBuf| {
        *path = path.file_name().unwrap_or_default().into();
    };
    let mut picture = picture.clone();
    if picture.colors.palette.is_file() {
        picture.colors = picture.colors.without_file();
    }
    picture.colors.report.iter_mut().for_each(name);
    picture.markers.points.iter_mut().for_each(name);
    let meshes = picture.meshes.mesh.iter_mut();
    meshes.for_each(|mesh| name(&mut mesh.file));
    picture.to_json()
}

/// How a picture was made, as its file tells it.
#[derive(Clone, Debug, PartialEq)]
pub struct Recipe {
    /// The picture, but for which cells it shows.
    pub picture: Picture,
    /// What it showed that options do not tell: `values`, `colormap` and `meshes` in memory, or what only the window has.
    pub left_out: Vec<String>,
}

impl Recipe {
    /// A warning, if something is left out. `file`: the picture's.
    pub fn warning(&self, file: &Path) -> Option<String> {
        let what = self.left_out.join(", ");
        let file = file.display();
        (!what.is_empty()).then(|| {
            format!("{file}: was drawn with {what}, which it does not hold: give that again")
        })
    }
}

/// How the picture in a PNG file was made.
///
/// # Errors
/// The file cannot be read, is no PNG, or does not tell.
pub fn picture_of_png(file: &Path) -> Result<Recipe, DrawError> {
    let fault = |what: String| DrawError::Failed(format!("{}: {what}", file.display()));
    regular(file).map_err(|e| {
        fault(format!(
            "cannot be read ({e}): check the path and its permissions"
        ))
    })?;
    let opened = File::open(file).map_err(|e| {
        fault(format!(
            "cannot be read ({e}): check the path and its permissions"
        ))
    })?;
    let text = png_text(BufReader::new(opened), KEYWORD);
    let text = text.map_err(|e| fault(format!("no PNG file ({e})")))?;
    let text = text.ok_or_else(|| {
        fault(
            "does not tell how it was made: it needs a picture of neurotess that was saved as PNG"
                .into(),
        )
    })?;
    let told: Value = serde_json::from_str(&text)
        .map_err(|e| fault(format!("tells nothing that can be read ({e})")))?;
    if told["format"] != FORMAT {
        return Err(fault(format!(
            "tells it in another form, that of neurotess {}: use this version or a later one",
            told["version"].as_str().unwrap_or("unknown")
        )));
    }
    let picture = Picture::from_json(&told["picture"]);
    let picture = picture.map_err(|e: OptionError| fault(e.to_string()))?;
    let left_out = told["left_out"].as_array().into_iter().flatten();
    Ok(Recipe {
        picture,
        left_out: left_out
            .filter_map(|what| Some(what.as_str()?.to_owned()))
            .collect(),
    })
}
