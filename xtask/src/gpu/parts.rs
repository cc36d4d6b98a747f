//! The parts of a run: what each does, and how long it may take.

/// A part.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    pub(crate) name: &'static str,
    /// Seconds that it may take: on hardware, and with reduced scenes in software on two cores. Those on hardware are a
    /// share of five minutes; what a part leaves over, the next ones have.
    pub(crate) most: [u64; 2],
    pub(crate) work: Work,
}

/// What a part does.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Work {
    /// `neurotess bench`, with its arguments on hardware, and those of a reduced scene.
    Bench(&'static str, &'static str),
    /// The tests that need an adapter.
    Tests,
    /// Pictures of samples.
    Pictures,
    /// The first picture with an empty cache of shaders, and the second.
    ColdStart,
}

/// Seconds of all parts together on hardware.
pub(crate) const MOST: u64 = 300;

/// All parts, in the order in which they are run: what is wrong comes before what is slow.
pub(crate) const PARTS: &[Part] = &[
    Part {
        name: "adapter",
        most: [20, 60],
        work: Work::Bench("adapter", "adapter"),
    },
    Part {
        name: "tests",
        most: [100, 900],
        work: Work::Tests,
    },
    Part {
        name: "refinement",
        most: [70, 120],
        work: Work::Bench(
            "refinement --memory 16384 --patience 1",
            "refinement --neurons 1,3 --levels 1,2,3 --grow 3,10 --distinct 3 --points 200 --frames 3 --size 300x300",
        ),
    },
    Part {
        name: "large_picture",
        most: [20, 60],
        work: Work::Bench(
            "refinement --neurons 100 --levels 6 --grow 100 --size 1920x1080 --memory 16384 --patience 1",
            "refinement --neurons 3 --levels 3 --grow 3 --distinct 3 --points 200 --frames 1 --size 480x270",
        ),
    },
    Part {
        name: "exploration",
        most: [45, 120],
        work: Work::Bench(
            "exploration --neurons 10000,100000,1000000 --frames 20",
            "exploration --neurons 100,1000 --distinct 3 --points 200 --compare 100 --frames 2 --size 320x240",
        ),
    },
    Part {
        name: "streaming",
        most: [40, 120],
        work: Work::Bench(
            "streaming --neurons 2000",
            "streaming --neurons 40 --points 300 --frames 10 --size 320x240 --budget 10000",
        ),
    },
    Part {
        name: "recording",
        most: [40, 120],
        work: Work::Bench(
            "static",
            "static --neurons 5,20 --distinct 3 --points 100 --frames 3 --drawn 1 --size 320x240 --samples 4",
        ),
    },
    Part {
        name: "pictures",
        most: [30, 120],
        work: Work::Pictures,
    },
    Part {
        name: "cold_start",
        most: [30, 120],
        work: Work::ColdStart,
    },
    Part {
        name: "opening",
        most: [40, 120],
        work: Work::Bench(
            "opening",
            "opening --neurons 100 --morphologies 21 --points 500 --size 320x240",
        ),
    },
];

/// Pictures of samples: a name, and arguments of `neurotess render`. Three, so that all files of a run are eight.
pub(crate) const PICTURES: [(&str, &str); 3] = [
    ("cell", "samples/pyramidal.swc --scale-bar"),
    (
        "soma",
        "samples/pyramidal.swc --eye 60,40,140 --target 0,0,0 --no-legend",
    ),
    ("large", "samples/purkinje.swc --size 3840x2160"),
];

/// What the first picture shows, at the size of benchmarks/pictures.md.
pub(crate) const COLD: &str = "samples/pyramidal.swc --size 960x720";
