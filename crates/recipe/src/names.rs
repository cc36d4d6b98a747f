//! What options are called: by flags of the command, keywords of Python and files, fields of values.

/// An option of a cell's mesh or of its files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the names say it")]
pub enum MeshOption {
    Level,
    MaxError,
    LevelAlong,
    Isotropic,
    MaxEdge,
    MinEdge,
    MaxAspect,
    Path,
    Caps,
    Crossings,
    Simulation,
    Soma,
    Poisson,
    SomaKeep,
    SomaMesh,
    SomaScale,
    Radii,
    RadiusFactor,
    Radius,
    MinRadius,
    SomaSphere,
    SomaLevel,
    Ring,
    Smooth,
    Types,
    Quads,
    Format,
    Unit,
    Walls,
    Materials,
    ColorBy,
    Compress,
    Parts,
}

/// How whoever set an option wrote it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Spelling {
    /// A field of [`MeshOptions`](crate::MeshOptions) or [`FileOptions`](crate::FileOptions): `refine.quads`.
    #[default]
    Field,
    /// A keyword of Python, or a name in a file: `max_error`.
    Keyword,
    /// A flag of the command line: `--max-error`.
    Flag,
    /// What a window calls it: `max error`.
    Label,
}

impl MeshOption {
    /// The options of a mesh, without those of its files.
    pub(crate) const OF_MESH: [Self; 26] = [
        Self::Level,
        Self::MaxError,
        Self::LevelAlong,
        Self::Isotropic,
        Self::MaxEdge,
        Self::MinEdge,
        Self::MaxAspect,
        Self::Path,
        Self::Caps,
        Self::Crossings,
        Self::Simulation,
        Self::Soma,
        Self::Poisson,
        Self::SomaKeep,
        Self::SomaMesh,
        Self::SomaScale,
        Self::Radii,
        Self::RadiusFactor,
        Self::Radius,
        Self::MinRadius,
        Self::SomaSphere,
        Self::SomaLevel,
        Self::Ring,
        Self::Smooth,
        Self::Types,
        Self::Quads,
    ];

    /// The option of a mesh with this keyword.
    pub fn of_keyword(keyword: &str) -> Option<Self> {
        let mut all = Self::OF_MESH.into_iter();
        all.find(|option| option.keyword() == keyword)
    }

    /// Its keyword.
    pub fn keyword(self) -> &'static str {
        match self {
            Self::Level => "level",
            Self::MaxError => "max_error",
            Self::LevelAlong => "level_along",
            Self::Isotropic => "isotropic",
            Self::MaxEdge => "max_edge",
            Self::MinEdge => "min_edge",
            Self::MaxAspect => "max_aspect",
            Self::Path => "path",
            Self::Caps => "caps",
            Self::Crossings => "crossings",
            Self::Simulation => "simulation",
            Self::Soma => "soma",
            Self::Poisson => "poisson",
            Self::SomaKeep => "soma_keep",
            Self::SomaMesh => "soma_mesh",
            Self::SomaScale => "soma_scale",
            Self::Radii => "radii",
            Self::RadiusFactor => "radius_factor",
            Self::Radius => "radius",
            Self::MinRadius => "min_radius",
            Self::SomaSphere => "soma_sphere",
            Self::SomaLevel => "soma_level",
            Self::Ring => "ring",
            Self::Smooth => "smooth",
            Self::Types => "types",
            Self::Quads => "quads",
            Self::Format => "format",
            Self::Unit => "unit",
            Self::Walls => "walls",
            Self::Materials => "materials",
            Self::ColorBy => "color_by",
            Self::Compress => "compress",
            Self::Parts => "parts",
        }
    }

    /// The field that holds it.
    fn field(self) -> &'static str {
        match self {
            Self::Level
            | Self::MaxError
            | Self::LevelAlong
            | Self::Isotropic
            | Self::MaxEdge
            | Self::MinEdge
            | Self::MaxAspect => "levels",
            Self::Path => "refine.path",
            Self::Caps => "refine.caps",
            Self::Quads => "refine.quads",
            Self::Simulation => "purpose",
            Self::Soma => "generate.soma",
            Self::Poisson => "generate.poisson",
            Self::SomaKeep => "generate.soma_keep",
            Self::SomaScale => "generate.soma_scale",
            Self::Radii => "generate.polygons",
            Self::RadiusFactor => "generate.radius_factor",
            Self::Radius => "generate.unknown_radius",
            Self::MinRadius => "generate.least_radius",
            Self::SomaSphere => "generate.sphere",
            Self::SomaLevel => "generate.sphere_level",
            Self::Ring => "generate.rings",
            Self::Smooth => "generate.smooth",
            Self::Types => "generate.kinds",
            Self::SomaMesh
            | Self::Crossings
            | Self::Format
            | Self::Unit
            | Self::Walls
            | Self::Materials
            | Self::ColorBy
            | Self::Compress
            | Self::Parts => self.keyword(),
        }
    }

    /// Its name in this spelling.
    pub fn spelled(self, spelling: Spelling) -> String {
        match spelling {
            Spelling::Field => self.field().to_owned(),
            Spelling::Keyword => self.keyword().to_owned(),
            Spelling::Flag => format!("--{}", self.keyword().replace('_', "-")),
            Spelling::Label => self.keyword().replace('_', " "),
        }
    }

    /// How it is given this word, in this spelling.
    pub(crate) fn set_to(self, word: &str, spelling: Spelling) -> String {
        let name = self.spelled(spelling);
        match spelling {
            Spelling::Keyword => format!("{name}=\"{word}\""),
            Spelling::Field | Spelling::Flag | Spelling::Label => format!("{name} {word}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_option_has_three_names() {
        let names = |option: MeshOption| {
            let spellings = [Spelling::Field, Spelling::Keyword, Spelling::Flag];
            spellings.map(|spelling| option.spelled(spelling))
        };
        assert_eq!(
            names(MeshOption::MinRadius),
            ["generate.least_radius", "min_radius", "--min-radius"]
        );
        for option in MeshOption::OF_MESH {
            assert_eq!(MeshOption::of_keyword(option.keyword()), Some(option));
        }
        assert_eq!(MeshOption::of_keyword("levle"), None);
    }
}
