//! Deterministic mutations of valid files: whatever comes, no panic, and no mesh that is larger
//! than its file allows. A run tries the same files everywhere; `NEUROTESS_FUZZ_SECONDS` tries others for
//! so long, from `NEUROTESS_FUZZ_SEED`, as `cargo xtask soak` does.

use std::time::{Duration, Instant};

use crate::attributes::with_numbers;
use crate::compressed::compressed;
use crate::shapes::{torus, written};
use glam::DVec3;
use neurotess_mesh::{Format, OwnAttribute, check, read_bytes, read_bytes_with_attributes};

/// xorshift64 (G. Marsaglia, Xorshift RNGs, 2003).
struct Dice(u64);

impl Dice {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % limit.max(1) as u64) as usize
    }
}

const WORDS: [&[u8]; 12] = [
    b"-1",
    b"0",
    b"4294967295",
    b"18446744073709551615",
    b"1e999",
    b"nan",
    b"\n",
    b" ",
    b"<",
    b"\"",
    b"\xff\xff\xff\xff",
    b"#",
];

fn mutate(bytes: &mut Vec<u8>, dice: &mut Dice) {
    for _ in 0..=dice.below(4) {
        let at = dice.below(bytes.len());
        // Headers are short: half of the time, they are hit.
        let at = if dice.below(2) == 0 {
            at % 600.min(bytes.len().max(1))
        } else {
            at
        };
        let length = dice.below(20).min(bytes.len() - at);
        match dice.below(6) {
            0 if at < bytes.len() => bytes[at] = dice.below(256) as u8,
            1 => bytes.truncate(at),
            2 => drop(bytes.drain(at..at + length)),
            3 => {
                let copied = bytes[at..at + length].to_vec();
                bytes.splice(at..at, copied);
            }
            4 => drop(bytes.splice(
                at..at + length.min(4),
                WORDS[dice.below(12)].iter().copied(),
            )),
            _ if at < bytes.len() => bytes[at] ^= 1 << dice.below(8),
            _ => {}
        }
    }
}

#[neurotess_testing::test]
fn mutated_files_neither_panic_nor_explode() {
    let number = |name: &str| std::env::var(name).ok().and_then(|s| s.parse::<u64>().ok());
    let seconds = number("NEUROTESS_FUZZ_SECONDS").map(Duration::from_secs);
    let text_ply = b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
        property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
        0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    let text_stl = b"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n\
        vertex 0 1 0\nendloop\nendfacet\nendsolid\n";
    let mut seeds: Vec<(Format, Vec<u8>)> = Format::ALL
        .into_iter()
        .flat_map(|format| {
            let meshes = [
                torus(4, 3, DVec3::ZERO),
                torus(3, 3, DVec3::splat(1e6 + 0.1)),
            ];
            meshes.map(|mesh| (format, written(&mesh, format)))
        })
        .collect();
    seeds.push((Format::Ply, text_ply.to_vec()));
    for format in [Format::Ply, Format::Vtu, Format::Glb] {
        seeds.push((format, with_numbers(format)));
    }
    seeds.push((Format::Stl, text_stl.to_vec()));
    seeds.push((Format::Glb, compressed(&torus(4, 3, DVec3::ZERO))));

    let mut dice = Dice(number("NEUROTESS_FUZZ_SEED").unwrap_or(0x9e37_79b9_7f4a_7c15) | 1);
    let (clock, mut rounds) = (Instant::now(), 0);
    let (mut tried, mut read) = (0, 0);
    while seconds.map_or(rounds < neurotess_testing::cases(1000, 5000), |seconds| {
        clock.elapsed() < seconds
    }) {
        rounds += 1;
        for (format, seed) in &seeds {
            let mut bytes = seed.clone();
            mutate(&mut bytes, &mut dice);
            tried += 1;
            if let Ok(mesh) = read_bytes(&bytes, *format) {
                read += 1;
                assert!(mesh.vertices.len() <= 8 * bytes.len());
                assert!(mesh.faces.triangles.len() <= 8 * bytes.len() + 2);
                check(&mesh);
            }
            if let Ok((mesh, own)) = read_bytes_with_attributes(&bytes, *format) {
                let numbers: usize = own.iter().map(|a| a.values.len()).sum();
                assert!(numbers <= 8 * bytes.len());
                let whole = |a: &OwnAttribute| a.values.len() == a.components * mesh.vertices.len();
                assert!(own.iter().all(whole));
            }
        }
    }
    neurotess_testing::note!("{tried} files tried, {read} of them still read");
    assert!(read > 0 && read < tried);
}
