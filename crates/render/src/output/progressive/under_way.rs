//! How far a picture has come, and what its slices are.

use crate::sources::VertexSource;
use neurotess_picture::Occlusion;

use super::step::{Steps, ViewParams};

/// How far a picture has come.
#[derive(Clone, Copy, Debug)]
pub(super) struct UnderWay {
    pub(super) params: ViewParams,
    pub(super) steps: Steps,
    pub(super) draft: bool,
    pub(super) step: u32,
    pub(super) slice: u32,
    /// Whether slices are bands of rows, each with a selection of its own.
    pub(super) banded: bool,
    /// Whether it is drawn for its depths and occlusion alone, and only in its first step.
    pub(super) hidden: bool,
}

impl UnderWay {
    /// Of a picture that is begun.
    pub(super) fn new(params: ViewParams, steps: Steps) -> Self {
        Self {
            params,
            steps: Steps {
                slices: steps.slices.clamp(1, params.size[1].max(1)),
                steps: steps.steps.max(1),
            },
            draft: false,
            step: 0,
            slice: 0,
            banded: false,
            hidden: false,
        }
    }

    /// Of a draft, which is drawn at once and without occlusion.
    pub(super) fn draft(params: &ViewParams) -> Self {
        let params = ViewParams {
            occlusion: Occlusion::Off,
            ..*params
        };
        let at_once = Steps {
            steps: 1,
            slices: 1,
        };
        Self {
            draft: true,
            ..Self::new(params, at_once)
        }
    }

    /// Decides what the slices are. What is selected in one round is drawn shader by shader, and is
    /// not selected again for every slice; with several `rounds` the picture is drawn in bands of
    /// rows.
    pub(super) fn lay_out(&mut self, rounds: usize, source: &dyn VertexSource) {
        self.banded = rounds > 1 && self.steps.slices > 1;
        if !self.banded {
            self.steps.slices = self.steps.slices.min(source.shaders() as u32);
        } else if self.params.frozen.is_some() {
            // What a band of rows shows is not known to a selection for another camera.
            (self.banded, self.steps.slices) = (false, 1);
        }
    }
}
