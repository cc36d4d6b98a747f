//! Ids and boxes, which select cells of a circuit.

use std::fmt;
use std::str::FromStr;

use glam::DVec3;

use crate::given::by_text;

/// Ids and ranges of ids, both ends included, as in 0,5,10-19.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ids(pub Vec<(u64, u64)>);

/// A box: its least and its greatest corner (µm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region(pub DVec3, pub DVec3);

impl FromStr for Ids {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let range = |part: &str| {
            let (from, to) = part.split_once('-').unwrap_or((part, part));
            let (from, to) = (from.trim().parse().ok()?, to.trim().parse().ok()?);
            (from <= to).then_some((from, to))
        };
        let ranges: Option<Vec<(u64, u64)>> = text.split(',').map(range).collect();
        ranges
            .map(Self)
            .ok_or_else(|| "ids and ranges of them are needed, as in 0,5,10-19".into())
    }
}

impl fmt::Display for Ids {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let range = |&(from, to): &(u64, u64)| match from == to {
            true => from.to_string(),
            false => format!("{from}-{to}"),
        };
        let ranges: Vec<String> = self.0.iter().map(range).collect();
        f.write_str(&ranges.join(","))
    }
}

impl FromStr for Region {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
        match numbers.as_deref() {
            Ok(&[a, b, c, d, e, f]) if [a, b, c, d, e, f].iter().all(|n| n.is_finite()) => {
                let (one, other) = (DVec3::new(a, b, c), DVec3::new(d, e, f));
                Ok(Self(one.min(other), one.max(other)))
            }
            _ => Err("six numbers are needed: X,Y,Z of one corner, X,Y,Z of the other".into()),
        }
    }
}

impl fmt::Display for Region {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(least, greatest) = self;
        let [a, b, c] = least.to_array();
        let [d, e, g] = greatest.to_array();
        write!(f, "{a},{b},{c},{d},{e},{g}")
    }
}

by_text!(Ids, Region);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_and_boxes_are_understood() {
        let ids: Ids = "0, 5,10-19".parse().expect("ids");
        assert_eq!(ids, Ids(vec![(0, 0), (5, 5), (10, 19)]));
        assert_eq!(ids.to_string(), "0,5,10-19");
        for wrong in ["", "a", "5-3", "1,,2", "-1"] {
            assert!(wrong.parse::<Ids>().is_err(), "{wrong}");
        }
        let sorted = Region(DVec3::new(0.0, 2.0, -5.0), DVec3::new(1.0, 10.0, 5.0));
        assert_eq!("0,10,-5, 1,2,5".parse(), Ok(sorted));
        // A list of two corners is the same.
        let corners = serde_json::from_str("[[0, 10, -5], [1, 2, 5]]");
        assert_eq!(corners.ok(), Some(sorted));
        assert!("1,2,3".parse::<Region>().is_err() && "1,2,3,4,5,inf".parse::<Region>().is_err());
    }
}
