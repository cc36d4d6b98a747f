//! The cells in the repository's `samples` are what this version grows.

use std::path::Path;

use neurotess_formats::swc;
use neurotess_synth::{Kind, Options, grow};

#[neurotess_testing::test]
fn samples_are_what_is_grown() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples");
    for kind in Kind::ALL {
        let mut grown = Vec::new();
        swc::write(&grow(&Options::sample(kind)), &mut grown).expect("memory");
        let kept = std::fs::read(folder.join(format!("{kind}.swc"))).unwrap_or_default();
        let renew = "cargo run --release -p neurotess-synth --example samples";
        assert!(kept == grown, "samples/{kind}.swc differs; renew: {renew}");
    }
}
