//! A picture in which each point has a color of our own: here its height.
//!
//! `cargo run --release -p neurotess --example own_colors -- [CELL] [OUT.png]`

use std::fs::File;
use std::io::BufWriter;
use std::path::PathBuf;

use neurotess::formats::{ReadOptions, read};
use neurotess::generate::{GenerateOptions, generate};
use neurotess::mesh::TracingPoint;
use neurotess::refine::{LodCriterion, RefineOptions};
use neurotess::render::bounds::bounds;
use neurotess::render::color::{ColorTable, fraction};
use neurotess::render::{
    Camera, DEFAULT_FOV, Gpu, PictureOptions, PngWriter, Prerefined, PrerefinedSurface, Side,
    Viewpoint, render_still,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let cell = arguments.next().unwrap_or("samples/granule.swc".into());
    let out = arguments.next().unwrap_or("heights.png".into());
    let morphology = read(&cell, &ReadOptions::default())?.morphology;
    let mesh = generate(&morphology, &GenerateOptions::default())?.mesh;

    // A color key for each tracing point: a fraction of the scale, or a category of the table.
    let heights = || mesh.tracing.iter().map(|point| point.center.y);
    let low = heights().fold(f32::MAX, f32::min);
    let high = heights().fold(f32::MIN, f32::max);
    let key = |point: &TracingPoint| fraction((point.center.y - low) / (high - low));
    let color_keys: Vec<u32> = mesh.tracing.iter().map(key).collect();
    let table = ColorTable {
        scale: vec![[40, 60, 140], [240, 240, 230], [190, 60, 40]],
        ..ColorTable::default()
    };

    let gpu = Gpu::open(None)?;
    let surface = PrerefinedSurface {
        mesh: &mesh,
        color_keys: &color_keys,
    };
    let levels = |_| LodCriterion::Homogeneous(4).into();
    let mut source = Prerefined::new(&gpu, &[surface], levels, &RefineOptions::default(), false)?;
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
        &table,
        &options,
        take,
    )?;
    Ok(png.finish()?)
}
