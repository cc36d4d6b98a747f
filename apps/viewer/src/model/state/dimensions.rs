//! Dimensions of the document, and the tool that makes them.

use std::sync::Arc;

use neurotess::morphology::paths::{Location, Path};

use super::{Effect, State, dimension_table};
use crate::model::command::{Command, Edit};
use crate::model::document::{Anchor, Dimension};
use crate::model::measuring::{self, Figure, Measuring, Placed};

impl State {
    /// The figures of all dimensions, in their order; none for those whose neuron or location is
    /// not there.
    pub fn figures(&self) -> Arc<Vec<Option<Figure>>> {
        let key = (
            self.document.dimensions.revision(),
            self.placements_key(),
            self.sources.geometry(),
        );
        let dimensions = self.document.dimensions.iter();
        let derive = || dimensions.map(|dimension| self.figure(dimension)).collect();
        self.derived.figures.get(key, derive)
    }

    /// What a dimension measures and how it is drawn.
    pub(crate) fn figure(&self, dimension: &Dimension) -> Option<Figure> {
        let placements = self.placements();
        measuring::figure(dimension, |anchor| {
            let neuron = self.document.neurons.get(anchor.neuron)?;
            let morphology = &*self.sources.get(neuron.source)?.morphology;
            anchor.is_on(morphology).then_some(Placed {
                morphology,
                traced: neuron.placement,
                drawn: *placements.get(anchor.neuron)?,
            })
        })
    }

    /// Figures of the dimensions whose neurons are shown, with their indices.
    pub(crate) fn shown_figures(&self) -> Vec<(usize, Figure)> {
        let figures = self.figures();
        let all = self.document.dimensions.iter().zip(figures.iter());
        let shown = all
            .enumerate()
            .filter(|(_, (dimension, _))| self.shows(dimension));
        shown
            .filter_map(|(i, (_, figure))| Some((i, figure.clone()?)))
            .collect()
    }

    /// Whether all neurons of a dimension are shown.
    pub(crate) fn shows(&self, dimension: &Dimension) -> bool {
        let neurons = &self.document.neurons;
        dimension
            .anchors()
            .all(|anchor| neurons.shows(anchor.neuron))
    }

    /// The file's number of the sample that the link of an anchor leads to; of a soma, of its first
    /// one.
    pub(crate) fn sample_of(&self, anchor: Anchor) -> Option<i64> {
        let morphology = &self.source_of(anchor.neuron)?.morphology;
        match anchor.location {
            Location::Soma(soma) => Some(morphology.somata.get(soma as usize)?.samples.first()?.id),
            Location::Neurite { point, .. } => morphology.sample_ids.get(point as usize).copied(),
        }
    }

    /// Length of the path from the neurite's first point, as *Inspect* has it; none if there is no
    /// soma.
    pub(crate) fn path_from_soma(&self, anchor: Anchor) -> Option<f64> {
        let neuron = self.document.neurons.get(anchor.neuron)?;
        let morphology = &self.sources.get(neuron.source)?.morphology;
        if morphology.somata.is_empty() || !anchor.is_on(morphology) {
            return None;
        }
        let path = Path::between(morphology, Location::Soma(0), anchor.location)?;
        Some((path.length - path.soma_length) * neuron.placement.scale)
    }

    /// Ends measuring, or only forgets the first end of a distance.
    pub(super) fn leave_measuring(&mut self) {
        self.tools.measuring = match self.tools.measuring {
            Some(Measuring { first: Some(_), .. }) => Some(Measuring::default()),
            _ => None,
        };
    }

    /// Forgets places of the tool that are not there any more.
    pub(super) fn forget_lost_ends(&mut self) {
        let Some(tool) = self.tools.measuring else {
            return;
        };
        let is_there = |anchor: &Anchor| {
            let source = self.source_of(anchor.neuron);
            source.is_some_and(|source| anchor.is_on(&source.morphology))
        };
        self.tools.measuring = Some(Measuring {
            first: tool.first.filter(is_there),
            under: tool.under.filter(|pointed| is_there(&pointed.at)),
        });
    }

    /// After a dimension was added: the next click begins another one. Says what was kept.
    pub(super) fn end_measure(&mut self) {
        if let Some(tool) = &mut self.tools.measuring {
            tool.first = None;
        }
        if let Some(Some(figure)) = self.figures().last() {
            self.messages.status = format!("Kept: {}", figure.label.join(", "));
        }
    }

    /// Copies the numbers of a dimension, or of all.
    pub(super) fn copy_dimensions(&mut self, which: Option<usize>) {
        let text = match which {
            None if self.document.dimensions.is_empty() => None,
            None => Some(dimension_table::table(self)),
            Some(which) => match self.figures().get(which) {
                Some(Some(figure)) => Some(dimension_table::numbers(figure)),
                _ => None,
            },
        };
        self.messages.status = match &text {
            Some(_) => "Copied".into(),
            None => "There is nothing to copy: keep a dimension first (M)".into(),
        };
        self.effects.extend(text.map(Effect::Copy));
    }

    /// Keeps a dimension, as a click does.
    pub(crate) fn request_dimension(&mut self, dimension: Dimension) {
        self.requests
            .push(Command::Edit(Edit::AddDimension(dimension)));
    }
}
