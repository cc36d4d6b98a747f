//! What neurotess does: a cell, twice, as a part of the program's pass.

use std::error::Error;
use std::f64::consts::FRAC_PI_2;
use std::path::Path;

use neurotess::formats::{ReadOptions, read};
use neurotess::generate::{GenerateOptions, generate};
use neurotess::render::bounds::bounds;
use neurotess::render::color::{ColorTable, Palette, category};
use neurotess::render::glam::{DQuat, DVec3};
use neurotess::render::{
    Adaptive, AdaptiveSettings, Composite, Gpu, HostPass, HostView, Instance, Look, Placement,
    Scene, Template, Templates, wgpu,
};

/// The cells.
pub(crate) struct Cells {
    gpu: Gpu,
    source: Adaptive,
    composite: Composite,
    /// Middle (µm) of both cells.
    pub(crate) center: DVec3,
    /// Half the height (µm) of the cell.
    pub(crate) reach: f64,
}

impl Cells {
    /// Two of a cell, for passes of this kind. `gpu`: the program's device.
    pub(crate) fn new(gpu: Gpu, cell: &Path, pass: HostPass) -> Result<Self, Box<dyn Error>> {
        let morphology = read(cell, &ReadOptions::default())?.morphology;
        let mesh = generate(&morphology, &GenerateOptions::default())?.mesh;
        let color_keys: Vec<u32> = mesh
            .tracing
            .iter()
            .map(|point| category(point.kind.0.max(0) as u32))
            .collect();
        let template = Template {
            mesh: &mesh,
            color_keys: &color_keys,
            values: &[],
        };
        let spheres = bounds(&mesh);
        let low = spheres.iter().map(|&(c, r)| c - r);
        let low = low.reduce(DVec3::min).unwrap_or(DVec3::ZERO);
        let high = spheres.iter().map(|&(c, r)| c + r);
        let high = high.reduce(DVec3::max).unwrap_or(DVec3::ONE);
        let (center, reach) = ((low + high) / 2.0, (high.y - low.y) / 2.0);

        // Errors of all this are returned here, and do not come to the program's handler.
        let (source, mut composite) = gpu.scoped(|| {
            let mut templates = Templates::new();
            let id = templates.add(&gpu, &[template])?[0];
            // One stands behind the other, turned by a quarter around its own axis.
            let turn = DQuat::from_rotation_y(FRAC_PI_2);
            let behind = Placement {
                rotation: turn,
                translation: center - turn * center + DVec3::new(0.45, 0.0, -0.55) * reach,
                ..Placement::default()
            };
            let instances = [Placement::default(), behind].map(|placement| Instance {
                placement,
                ..Instance::new(id)
            });
            let scene = Scene::new(templates, instances.into())?;
            let source = Adaptive::new(&gpu, scene, AdaptiveSettings::default(), 1)?;
            Ok::<_, Box<dyn Error>>((source, Composite::new(&gpu, pass)?))
        })?;
        composite.set_colors(ColorTable {
            categories: (0..8).map(|kind| Palette::OkabeIto.of_type(kind)).collect(),
            ..ColorTable::default()
        });
        Ok(Self {
            gpu,
            source,
            composite,
            center,
            reach,
        })
    }

    /// Before the program submits its frame.
    pub(crate) fn prepare(&mut self, view: &HostView) -> Result<(), Box<dyn Error>> {
        let look = Look::default();
        Ok(self
            .composite
            .prepare(&self.gpu, &mut self.source, view, &look)?)
    }

    /// Within the program's pass.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.composite.draw(pass);
    }
}
