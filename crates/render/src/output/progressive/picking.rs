//! What is at which pixel of a picture.

use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::output::ids::Identifier;
use crate::sources::VertexSource;
use crate::sources::pick::PickIds;

use super::step::{selected, shade};
use super::{ProgressiveRenderer, ViewParams};

impl ProgressiveRenderer {
    /// Draws the ids of a picture for picking; [`ProgressiveRenderer::ids`] has them a little
    /// later.
    ///
    /// # Errors
    /// What the device cannot do.
    pub fn identify(
        &mut self,
        gpu: &Gpu,
        source: &mut dyn VertexSource,
        params: &ViewParams,
    ) -> Result<(), DeviceError> {
        let renderer = self.renderer(gpu, source, 1, params)?;
        let renderer = &self.renderers[renderer];
        if self.identifier.as_ref().is_none_or(|i| !i.fits(renderer)) {
            self.identifier = Identifier::new(gpu, renderer, source);
        }
        let Some(identifier) = &mut self.identifier else {
            return Ok(());
        };
        let shade = shade(renderer, params);
        identifier.draw(
            gpu,
            renderer,
            source,
            &selected(params, None),
            shade,
            params.size,
        )?;
        self.clock.start(gpu);
        Ok(())
    }

    /// The size of the picture that was identified last and its ids by row: given out once, and
    /// none before they have arrived.
    ///
    /// # Errors
    /// The device is lost.
    pub fn ids(&mut self) -> Result<Option<PickIds>, DeviceError> {
        self.identifier.as_mut().map_or(Ok(None), Identifier::take)
    }
}
