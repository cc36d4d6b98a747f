//! Mutated files: nothing panics, and what is read is written and read back equal.
//!
//! A run tries the same files everywhere. `NEUROTESS_FUZZ_SECONDS` tries others for so long, from
//! `NEUROTESS_FUZZ_SEED`, as `cargo xtask soak` does.

use std::time::{Duration, Instant};

use neurotess_formats::{ReadOptions, swc};

const SEEDS: [&str; 5] = [
    "# plain\n1 1 0 0 0 5 -1\n2 3 0 6 0 1 1\n3 3 0 9 0 .5 2\n4 3 1 9 0 .5 2\n5 2 0 -6 0 1 1\n",
    "1 1 0 0 0 5 -1\r\n2 1 0 -5 0 5 1\r\n3 1 0 5 0 5 1\r\n4 3 0 0 9 1 3 # x\r\n5 2 1 0 9 1 4\r\n",
    "7 3 5000.25 1e3 -2 1 4\n4 1 5002.5 1.5e3 0 9 2\n2 0 6000 0 0 0.5 -1\n9 1 0 0 0 0 7\n",
    "1,1,0,0,0,0,-1\n2,1,4,0,0,0,1\n3,1,4,2,0,0,2\n4,1,0,2,0,0,3\n5,1,0,1,0,0,4\n6,3,9,9,9,1,5\n",
    "1.0 1 0 0 0 5 -1\n2.0 274 0 6 0 1 1\n30 -3 -0 6.000001 1e-9 1 2\n1000000 2 0 0 0 1 -1\n",
];

/// Knuth's generator of MMIX: enough to pick bytes.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % n.max(1)
    }

    fn of<'a, T: ?Sized>(&mut self, all: &[&'a T]) -> &'a T {
        all[self.below(all.len())]
    }
}

fn mutate(text: &mut Vec<u8>, random: &mut Random) {
    const NUMBERS: [&str; 14] = [
        "0",
        "-1",
        "1",
        "2",
        "1e38",
        "-1e37",
        "4096.0001",
        "nan",
        "1e-45",
        "5000.499999999999",
        "9223372036854775807",
        "0.30000001192092896",
        "16777217.5",
        "+.5e-3",
    ];
    let at = random.below(text.len());
    match random.below(8) {
        0 if !text.is_empty() => text[at] ^= 1 << random.below(8),
        1 if !text.is_empty() => text[at] = b" \t\n\r#,;.-+e019"[random.below(14)],
        2 => text.truncate(at),
        3 => {
            let mut lines: Vec<&[u8]> = text.split(|&b| b == b'\n').collect();
            let (a, b) = (random.below(lines.len()), random.below(lines.len()));
            lines.swap(a, b);
            *text = lines.join(&b'\n');
        }
        4 => {
            let lines: Vec<&[u8]> = text.split(|&b| b == b'\n').collect();
            let copied = [b"\n", lines[random.below(lines.len())], b"\n"].concat();
            text.extend(copied);
        }
        _ => {
            let from = text[..at]
                .iter()
                .rposition(|b| b" \n,".contains(b))
                .map_or(0, |i| i + 1);
            let rest = &text[from..];
            let length = rest
                .iter()
                .position(|b| b" \n,".contains(b))
                .unwrap_or(rest.len());
            text.splice(from..from + length, random.of(&NUMBERS).bytes());
        }
    }
}

fn read_and_write(text: &[u8], options: &ReadOptions) -> bool {
    let Ok(first) = swc::read_bytes(text, "fuzz.swc", options) else {
        return false;
    };
    let mut written = Vec::new();
    swc::write_numbered(&first.morphology, swc::SampleNumbers::Kept, &mut written).expect("memory");
    let again = swc::read_bytes(&written, "fuzz.swc", options);
    let same = again
        .as_ref()
        .is_ok_and(|again| again.morphology == first.morphology);
    let shown = String::from_utf8_lossy;
    assert!(
        same,
        "{again:?}\n{:?}\nread:\n{}\nwritten:\n{}",
        first,
        shown(text),
        shown(&written)
    );
    true
}

#[neurotess_testing::test]
fn mutated_files_never_panic_and_come_back_equal() {
    let number = |name: &str| std::env::var(name).ok().and_then(|s| s.parse().ok());
    let seconds = number("NEUROTESS_FUZZ_SECONDS").map(Duration::from_secs);
    let mut random = Random(number("NEUROTESS_FUZZ_SEED").unwrap_or(2026));
    let (clock, mut rounds) = (Instant::now(), 0);
    let (mut tried, mut taken) = (0_u64, 0_u64);
    while seconds.map_or(rounds < neurotess_testing::cases(200, 600), |seconds| {
        clock.elapsed() < seconds
    }) {
        rounds += 1;
        for _ in 0..1000 {
            let mut text = random.of(&SEEDS).as_bytes().to_vec();
            for _ in 0..=random.below(6) {
                mutate(&mut text, &mut random);
            }
            tried += 1;
            taken += u64::from(read_and_write(&text, &ReadOptions::default()));
        }
    }
    neurotess_testing::note!("{tried} files tried, {taken} taken");
    assert!(
        taken * 20 > tried,
        "mutations are too coarse: {taken} of {tried} are read"
    );
}
