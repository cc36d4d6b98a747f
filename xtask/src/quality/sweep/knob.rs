//! Numbers that a sweep changes while the program runs. `cargo xtask sweep` adds this file to its copy of a crate.

use std::collections::HashMap;
use std::sync::LazyLock;

/// Factors by number, from `NUMBER:FACTOR,…`; `all:FACTOR` is of all.
static ASKED: LazyLock<(Option<f64>, HashMap<usize, f64>)> = LazyLock::new(|| {
    let asked = std::env::var("NEUROTESS_KNOB").unwrap_or_default();
    let pairs = asked.split(',').filter_map(|pair| pair.split_once(':'));
    let pairs = pairs.filter_map(|(number, factor)| Some((number, factor.parse::<f64>().ok()?)));
    let all = pairs.clone().find(|(number, _)| *number == "all");
    let each = pairs.filter_map(|(number, factor)| Some((number.parse().ok()?, factor)));
    (all.map(|(_, factor)| factor), each.collect())
});

pub(crate) fn knob<T: Knob>(number: usize, value: T) -> T {
    let (all, each) = &*ASKED;
    match each.is_empty() {
        true => all.map_or(value, |factor| value.times(factor)),
        false => each.get(&number).map_or(value, |&factor| value.times(factor)),
    }
}

pub(crate) trait Knob: Copy {
    fn times(self, factor: f64) -> Self;
}

macro_rules! floats { ($($t:ty)*) => { $(impl Knob for $t {
    fn times(self, factor: f64) -> Self { (f64::from(self) * factor) as $t }
})* } }
macro_rules! integers { ($($t:ty)*) => { $(impl Knob for $t {
    // At least one more or less; as it is where the factor is next to 1.
    fn times(self, factor: f64) -> Self {
        let scaled = (self as f64 * factor).round() as $t;
        match factor {
            0.0..0.99 => scaled.min(self.saturating_sub(1)),
            0.99..1.01 => self,
            _ => scaled.max(self.saturating_add(1)),
        }
    }
})* } }
floats! { f32 f64 }
integers! { u8 u32 u64 usize i32 i64 }
