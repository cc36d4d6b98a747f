//! Figures of the picture, for its panel.

/// What a frame drew, for the panel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Counters {
    /// Triangles drawn, if counted.
    pub triangles: u64,
    /// Patches drawn, and those there are.
    pub patches: [u64; 2],
    /// Bytes on the device: of cells, and of pictures.
    pub bytes: [u64; 2],
    /// Milliseconds of the last frames.
    pub frames_ms: Vec<f32>,
    /// How often the picture's parts were made.
    pub rebuilds: Rebuilds,
    /// How drafts are lowered.
    pub draft: Draft,
    /// How the picture at rest is lowered, if it is.
    pub lowered: Option<Lowered>,
}

/// How the picture at rest is less than what is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lowered {
    /// By exploration: triangles drawn, and those that half a pixel would take, once they are known.
    Triangles(Option<[u64; 2]>),
    /// So many times the error.
    Error(f32),
}

/// How what is drawn while something moves is less than the full picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Draft {
    /// At most so many triangles, for those that show most.
    Budget(u32),
    /// So many times the error.
    Error(f32),
}

impl Default for Draft {
    fn default() -> Self {
        Self::Error(1.0)
    }
}

/// How often the picture's parts were made since the window opened: an idle frame makes none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rebuilds {
    /// Placements of all neurons.
    pub placements: u64,
    /// Bounding spheres of all that shows.
    pub spheres: u64,
    /// Instances on the device.
    pub instances: u64,
    /// Selected, ghosted: states of instances on the device.
    pub states: u64,
    /// Meshes of templates on the device.
    pub templates: u64,
    /// Proxies of templates on the device.
    pub proxies: u64,
    /// Tables of colors.
    pub colors: u64,
}
