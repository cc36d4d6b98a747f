//! The cells that are measured: real ones of the reference data, each in one form, and the samples.
//!
//! A third of each kind is **held out**: no number is chosen by these cells and no sweep uses them, so that they say what a
//! change is worth on cells that it was not made for.

use std::path::{Path, PathBuf};

use anyhow::bail;

use crate::steps::root;

/// A kind of cells: those that numbers are chosen by, and those that are held out.
struct Kind {
    tuning: &'static [&'static str],
    held_out: &'static [&'static str],
}

/// Below the reference data, or samples.
const KINDS: [Kind; 6] = [
    // Neurolucida's cells with an outline of the soma.
    Kind {
        tuning: &[
            "asc/C210401C.asc",
            "asc/bio_neuron-000.asc",
            "asc/neuron_Neurolucida_ASC.asc",
        ],
        held_out: &["asc/C270106A.asc"],
    },
    // Cells whose soma is a ball or a stack of cylinders.
    Kind {
        tuning: &[
            "swc/C270106C_-_Scale_x1.000_y1.050_z1.000.swc",
            "swc/Cell_305_MPD_8_FT_100_XYZ_Sorted-swc_N3DFix-swc_pruned.swc",
            "swc/IF4_140201.CNG.swc",
            "h5/Neuron.h5",
        ],
        held_out: &["swc/vd130423_idC.swc", "h5/C220197A-P2.h5"],
    },
    // The Allen Institute's.
    Kind {
        tuning: &[
            "swc/485184849_reconstruction.swc",
            "swc/Pvalb_469628681_m.swc",
        ],
        held_out: &["sonata/allen/shared_components/morphologies/Pvalb_470522102_m.swc"],
    },
    // Glia.
    Kind {
        tuning: &["h5/astrocyte.h5"],
        held_out: &["swc/WT-Contralateral-18.CNG.swc"],
    },
    // Axons and processes without a soma.
    Kind {
        tuning: &["swc/172993.swc", "swc/2017-6-9_525_ptp-3ok244_day_3_9.swc"],
        held_out: &["swc/Cha-F-700113.CNG.swc"],
    },
    // Synthetic ones.
    Kind {
        tuning: &["pyramidal", "granule", "basket", "star"],
        held_out: &["purkinje", "motor"],
    },
];

/// Tuning cells that a sweep measures: some of each kind that together take a few seconds.
const SWEPT: [&str; 6] = [
    "h5/Neuron.h5",
    "asc/neuron_Neurolucida_ASC.asc",
    "swc/Cell_305_MPD_8_FT_100_XYZ_Sorted-swc_N3DFix-swc_pruned.swc",
    "swc/Pvalb_469628681_m.swc",
    "swc/2017-6-9_525_ptp-3ok244_day_3_9.swc",
    "granule",
];

/// All files: those that numbers are chosen by, then those that are held out.
pub(super) fn files() -> anyhow::Result<Vec<PathBuf>> {
    let held_out = KINDS.iter().flat_map(|kind| kind.held_out);
    let held_out: anyhow::Result<Vec<PathBuf>> = held_out.map(|name| file(name)).collect();
    Ok([tuning()?, held_out?].concat())
}

/// Those that numbers are chosen by.
pub(super) fn tuning() -> anyhow::Result<Vec<PathBuf>> {
    let tuning = KINDS.iter().flat_map(|kind| kind.tuning);
    tuning.map(|name| file(name)).collect()
}

/// Whether the file of this name is held out.
pub(super) fn is_held_out(file: &str) -> bool {
    let stem = Path::new(file).file_stem();
    let mut held_out = KINDS.iter().flat_map(|kind| kind.held_out);
    held_out.any(|name| Path::new(name).file_stem() == stem)
}

/// Those that a sweep measures.
pub(super) fn swept() -> anyhow::Result<Vec<PathBuf>> {
    SWEPT.iter().map(|name| file(name)).collect()
}

fn file(name: &str) -> anyhow::Result<PathBuf> {
    if !name.contains('/') {
        return Ok(root().join("samples").join(name).with_extension("swc"));
    }
    let data = root().join("../shared/data");
    if !data.is_dir() {
        bail!("no reference data in {}: name files", data.display());
    }
    Ok(data.join(name))
}
