//! NeuroML files of others.

use neurotess_formats::{ReadOptions, read};
use neurotess_morphology::Measures;
use neurotess_testing::{shared, shared_data};

#[neurotess_testing::test(needs(shared))]
fn files_of_others_are_read() {
    let data = shared_data();
    for (name, length, ends, soma) in [
        ("NML2_SimpleMorphology.nml", 21.0, 2, "cylinders"),
        ("NML2_MultiCompCellNetwork.nml", 40.0, 1, "cylinders"),
        ("pyr_4_sym.cell.nml", 1610.012, 4, "cylinders"),
        ("l22_cylsoma.cell.nml", 35.921, 2, "cylinders"),
    ] {
        let read = read(data.join("nml").join(name), &ReadOptions::default()).expect(name);
        let m = Measures::of(&read.morphology);
        assert!((m.length - length).abs() < 1e-3, "{name}: {}", m.length);
        assert_eq!((m.n_ends, m.soma.kind), (ends, soma), "{name}");
    }
}
