//! Figures of the picture, for the level-of-detail panel.

/// What draws, and what it took.
#[derive(Clone, Debug, Default)]
pub struct Drawing {
    /// Counters of the level of detail.
    pub counters: Counters,
    /// Name of the adapter, and whether it draws in software.
    pub adapter: (String, bool),
}

/// What a frame drew, and what it took.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Counters {
    /// Triangles drawn, if counted.
    pub triangles: u64,
    /// Patches drawn, and all patches.
    pub patches: [u64; 2],
    /// Bytes on the device: of cells, and of pictures.
    pub bytes: [u64; 2],
    /// Milliseconds of the last frames.
    pub frames_ms: Vec<f32>,
    /// How many times parts of the picture were rebuilt.
    pub rebuilds: Rebuilds,
    /// How the quality of drafts is reduced.
    pub draft: Draft,
    /// Whether the picture at rest, which is reduced, is being drawn in full.
    pub completes: bool,
    /// How the quality of the picture at rest is reduced, if it is.
    pub lowered: Option<Lowered>,
    /// Synapses and points that the picture shows, those in view, and all; none without any.
    pub markers: Option<[usize; 3]>,
    /// Clamped neurons that are drawn finely, and all.
    pub clamped: [usize; 2],
    /// The picture at rest, once it can be colored anew.
    pub static_picture: Option<StaticFigures>,
}

/// What a picture holds that is colored anew without being drawn anew.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StaticFigures {
    /// Number of colors that show: of a tracing point or compartment of a neuron.
    pub colors: usize,
    /// Compartments of the recording that are read for a frame; none without a recording.
    pub compartments: Option<usize>,
    /// Bytes on the device.
    pub bytes: u64,
}

/// How the quality of the picture at rest is reduced, so that the window stays responsive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lowered {
    /// By exploration mode: triangles drawn, and those needed for half a pixel, once they are
    /// known.
    Triangles(Option<[u64; 2]>),
    /// By a greater error: the factor on it.
    Error(f32),
}

/// How the quality of drafts, which are drawn while something moves, is reduced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Draft {
    /// By a budget: the most triangles, which go to what is seen best.
    Budget(u32),
    /// By a greater error: the factor on it.
    Error(f32),
}

impl Default for Draft {
    fn default() -> Self {
        Self::Error(1.0)
    }
}

/// How many times parts of the picture were rebuilt since the window opened: none of them in an
/// idle frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rebuilds {
    /// Placements of all neurons.
    pub placements: u64,
    /// Bounding spheres of the neurons that are shown.
    pub spheres: u64,
    /// Instances on the device.
    pub instances: u64,
    /// States of instances on the device, such as highlighted and ghosted.
    pub states: u64,
    /// Meshes of templates on the device.
    pub templates: u64,
    /// Proxies of templates on the device.
    pub proxies: u64,
    /// Tables of colors.
    pub colors: u64,
}
