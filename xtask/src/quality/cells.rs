//! The cells that are measured: real ones of the reference data, each in one form, and the samples.

use std::path::PathBuf;

use anyhow::bail;

use crate::steps::root;

/// Below the reference data.
const REAL: [&str; 17] = [
    "asc/C210401C.asc",
    "asc/C270106A.asc",
    "asc/bio_neuron-000.asc",
    "asc/neuron_Neurolucida_ASC.asc",
    "h5/C220197A-P2.h5",
    "h5/Neuron.h5",
    "h5/astrocyte.h5",
    "swc/172993.swc",
    "swc/2017-6-9_525_ptp-3ok244_day_3_9.swc",
    "swc/485184849_reconstruction.swc",
    "swc/C270106C_-_Scale_x1.000_y1.050_z1.000.swc",
    "swc/Cell_305_MPD_8_FT_100_XYZ_Sorted-swc_N3DFix-swc_pruned.swc",
    "swc/Cha-F-700113.CNG.swc",
    "swc/IF4_140201.CNG.swc",
    "swc/Pvalb_469628681_m.swc",
    "swc/WT-Contralateral-18.CNG.swc",
    "swc/vd130423_idC.swc",
];
const SAMPLES: [&str; 6] = [
    "pyramidal",
    "purkinje",
    "granule",
    "basket",
    "motor",
    "star",
];

/// Their files.
pub(super) fn files() -> anyhow::Result<Vec<PathBuf>> {
    let data = root().join("../shared/data");
    if !data.is_dir() {
        bail!("no reference data in {}: name files", data.display());
    }
    let real = REAL.iter().map(|name| data.join(name));
    let samples = SAMPLES
        .iter()
        .map(|name| root().join("samples").join(name).with_extension("swc"));
    Ok(real.chain(samples).collect())
}
