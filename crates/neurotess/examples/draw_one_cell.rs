//! From a tracing to a picture, colored by type.
//!
//! `cargo run --release -p neurotess --example draw_one_cell -- [CELL] [OUT.png]`

use std::fs::File;
use std::io::BufWriter;
use std::path::PathBuf;

use neurotess::coloring::{Cell, ColorBy, ColorScheme, OwnColors, coloring};
use neurotess::formats::{ReadOptions, read};
use neurotess::generate::{GenerateOptions, generate};
use neurotess::refine::{LodCriterion, RefineOptions};
use neurotess::render::bounds::bounds;
use neurotess::render::color::{ColorMap, Palette};
use neurotess::render::{
    Camera, DEFAULT_FOV, Gpu, PictureOptions, PngWriter, Prerefined, PrerefinedSurface, Side,
    Viewpoint, render_still,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let cell = arguments.next().unwrap_or("samples/granule.swc".into());
    let out = arguments.next().unwrap_or("granule.png".into());
    let morphology = read(&cell, &ReadOptions::default())?.morphology;
    let mesh = generate(&morphology, &GenerateOptions::default())?.mesh;

    let scheme = ColorScheme {
        palette: Palette::NeuroM,
        own_colors: OwnColors::default(),
        background: Some([255; 3]),
        scale: ColorMap::default().scale(),
        range: None,
    };
    let cells = [Cell {
        name: "cell",
        morphology: &morphology,
        mesh: &mesh,
        radius_factor: 1.0,
    }];
    let colors = coloring(&cells, ColorBy::Type, &scheme);

    let gpu = Gpu::open(None)?;
    let surface = PrerefinedSurface {
        mesh: &mesh,
        color_keys: &colors.color_keys[0],
    };
    let levels = |_| LodCriterion::Homogeneous(4).into();
    let mut source = Prerefined::new(&gpu, &[surface], levels, &RefineOptions::default(), false)?;

    // The camera sees all of the cell from the front.
    let options = PictureOptions::default();
    let [width, height] = options.size;
    let (spheres, aspect) = (bounds(&mesh), f64::from(width) / f64::from(height));
    let camera = Camera::fit(Side::Front, DEFAULT_FOV, aspect, 0.05, &spheres)?;
    let near = camera.near(&spheres);
    let mut png = PngWriter::new(BufWriter::new(File::create(out)?), options.size, false)?;
    let take = |_first_row, band| png.write(&band);
    render_still(
        &gpu,
        &mut source,
        &Viewpoint { camera, near },
        &colors.table,
        &options,
        take,
    )?;
    Ok(png.finish()?)
}
