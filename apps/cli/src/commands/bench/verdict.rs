//! Evaluates the figures: ratios within the run beside those of the paper, and which targets they
//! meet.

use serde::Serialize;

use super::methods::{Method, Row};

/// A ratio of the run.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Ratio {
    pub(crate) what: String,
    pub(crate) measured: f64,
    /// The ratio that García-Cantero et al. (2017) measured, on hardware of their time.
    pub(crate) paper: Option<f64>,
    /// The target, and whether it is met.
    pub(crate) bar: Option<Bar>,
}

/// The target of a ratio.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Bar {
    pub(crate) least: Option<f64>,
    pub(crate) most: Option<f64>,
    pub(crate) held: bool,
}

/// All ratios that can be computed from the rows.
pub(crate) fn ratios(rows: &[Row]) -> Vec<Ratio> {
    let Some(neurons) = rows.iter().map(|row| row.neurons).max() else {
        return Vec::new();
    };
    let largest: Vec<&Row> = rows.iter().filter(|row| row.neurons == neurons).collect();
    let levels = largest.iter().filter_map(|row| row.level);
    let (Some(low), Some(high)) = (levels.clone().min(), levels.max()) else {
        return Vec::new();
    };
    let ms = |method: Method, level: Option<u32>| {
        let row = largest
            .iter()
            .find(|r| r.method == method && r.level == level);
        row.map(|row| row.ms)
    };
    let at = |method, level| ms(method, Some(level));
    let mut ratios = Vec::new();
    let mut add =
        |what: String, ratio: Option<f64>, paper, least: Option<f64>, most: Option<f64>| {
            let Some(measured) = ratio.filter(|r| r.is_finite()) else {
                return;
            };
            let held = least.is_none_or(|l| measured >= l) && most.is_none_or(|m| measured <= m);
            let bar = (least.is_some() || most.is_some()).then_some(Bar { least, most, held });
            ratios.push(Ratio {
                what,
                measured,
                paper,
                bar,
            });
        };
    let over = |a: Option<f64>, b: Option<f64>| Some(a? / b?);
    let of = |of: Method| over(at(of, high), at(of, low));
    let six = high == 6 && low == 1;
    let paper = |figure: f64| six.then_some(figure);
    use Method::{Adaptive, Homogeneous, PixelError, Prerefined, PrerefinedPixelError};
    add(
        format!("homogeneous / adaptive at level {high}, {neurons} neurons"),
        over(at(Homogeneous, high), at(Adaptive, high)),
        paper(2.4),
        None,
        None,
    );
    add(
        format!("pre-refined / adaptive at level {high}, {neurons} neurons"),
        over(at(Prerefined, high), at(Adaptive, high)),
        paper(12.5),
        None,
        None,
    );
    add(
        format!("adaptive: level {high} / level {low}"),
        of(Adaptive),
        paper(1.9),
        None,
        six.then_some(1.9),
    );
    add(
        format!("homogeneous: level {high} / level {low}"),
        of(Homogeneous),
        paper(4.7),
        None,
        None,
    );
    add(
        format!("pre-refined: level {high} / level {low}"),
        of(Prerefined),
        paper(90.0),
        None,
        None,
    );
    add(
        format!("pre-refined at level {high} / adaptive by error in pixels"),
        over(at(Prerefined, high), ms(PixelError, None)),
        None,
        (high == 6).then_some(5.0),
        None,
    );
    add(
        "adaptive by error in pixels / pre-refined with the same levels".into(),
        over(ms(PixelError, None), ms(PrerefinedPixelError, None)),
        None,
        None,
        Some(1.5),
    );
    ratios
}

impl Ratio {
    /// One line of a table.
    pub(crate) fn line(&self) -> String {
        let paper = self.paper.map_or("-".into(), |p| format!("{p}"));
        let bar = match self.bar {
            None => "-".to_owned(),
            Some(bar) => {
                let asked = match (bar.least, bar.most) {
                    (Some(least), _) => format!(">= {least}"),
                    (None, Some(most)) => format!("<= {most}"),
                    (None, None) => String::new(),
                };
                format!("{asked} {}", if bar.held { "held" } else { "missed" })
            }
        };
        format!(
            "{:<62} {:>8.2} {paper:>7} {bar:>14}",
            self.what, self.measured
        )
    }

    /// The head of the table.
    pub(crate) fn head() -> String {
        format!(
            "{:<62} {:>8} {:>7} {:>14}",
            "ratio", "measured", "paper", "bar"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(method: Method, level: Option<u32>, ms: f64) -> Row {
        Row {
            neurons: 100,
            method,
            level,
            ms,
            waited_ms: ms,
            choose_ms: None,
            triangles: 0,
            bytes: 0,
        }
    }

    #[test]
    fn bars_are_judged_from_both_sides() {
        let rows = [
            row(Method::Prerefined, Some(1), 10.0),
            row(Method::Prerefined, Some(6), 100.0),
            row(Method::Adaptive, Some(1), 10.0),
            row(Method::Adaptive, Some(6), 20.0),
            row(Method::PixelError, None, 10.0),
            row(Method::PrerefinedPixelError, None, 8.0),
        ];
        let ratios = ratios(&rows);
        let held: Vec<Option<bool>> = ratios.iter().map(|r| r.bar.map(|b| b.held)).collect();
        // Without homogeneous rows the ratios with them are left out.
        assert_eq!(held, [None, Some(false), None, Some(true), Some(true)]);
        assert_eq!(ratios[0].measured, 5.0);
        assert!(ratios[1].line().contains("missed"));
    }

    #[test]
    fn nothing_measured_says_nothing() {
        assert!(ratios(&[]).is_empty());
    }
}
