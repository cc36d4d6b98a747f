//! Positions and directions.

use std::fmt;
use std::str::FromStr;

use glam::DVec3;

use crate::given::by_text;

/// Three numbers: a position (µm), or a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point(pub DVec3);

impl FromStr for Point {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
        match numbers.as_deref() {
            Ok(&[x, y, z]) => Ok(Self(DVec3::new(x, y, z))),
            _ => Err("three numbers X,Y,Z are needed, as in 0,20,80".into()),
        }
    }
}

impl fmt::Display for Point {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let DVec3 { x, y, z } = self.0;
        write!(f, "{x},{y},{z}")
    }
}

by_text!(Point);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_are_read_and_written() {
        let point: Point = "1,-2, 3e1".parse().expect("a position");
        assert_eq!(
            (point.0, point.to_string()),
            (DVec3::new(1.0, -2.0, 30.0), "1,-2,30".into())
        );
        assert!("1,2".parse::<Point>().is_err());
    }
}
