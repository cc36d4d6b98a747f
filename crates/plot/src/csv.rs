//! A plot's numbers as comma-separated values.

use std::fmt::Write;

use crate::{Axis, Data, Plot, Series};

impl Plot {
    /// Its numbers as CSV, heading first. Lines have a column each beside one of x, which has all their x, and nothing
    /// where a line has no number; bars have a column each beside their ends; spans and ticks have a row each. If there are
    /// different kinds, their tables follow one another.
    pub fn csv(&self) -> String {
        let mut text = String::new();
        let lines: Vec<(&Series, &[[f64; 2]])> = self.of_kind(|data| match data {
            Data::Line(points) | Data::Dots(points) => Some(points.as_slice()),
            _ => None,
        });
        if !lines.is_empty() {
            self.line_table(&lines, &mut text);
        }
        self.bar_table(&mut text);
        self.span_table(&mut text);
        self.tick_table(&mut text);
        text
    }

    fn of_kind<'a, T>(&'a self, kind: impl Fn(&'a Data) -> Option<T>) -> Vec<(&'a Series, T)> {
        let all = self.series.iter();
        all.filter_map(|series| Some((series, kind(&series.data)?)))
            .collect()
    }

    /// Name of a series as a heading, with the unit of y.
    fn heading(&self, series: &Series) -> String {
        let name = match series.name.is_empty() {
            true => &self.y.label,
            false => &series.name,
        };
        Axis::new(name.as_str(), self.y.unit.as_str()).title()
    }

    fn line_table(&self, lines: &[(&Series, &[[f64; 2]])], text: &mut String) {
        let headings = lines.iter().map(|(series, _)| self.heading(series));
        row(text, [column(&self.x)].into_iter().chain(headings));
        // All lines go forward together, by the least x that is next.
        let mut next = vec![0; lines.len()];
        loop {
            let coming = lines.iter().zip(&next);
            let coming = coming.filter_map(|((_, points), &i)| Some(points.get(i)?[0]));
            let Some(x) = coming.reduce(f64::min) else {
                return;
            };
            let cells = lines.iter().zip(&mut next).map(|((_, points), i)| {
                match points.get(*i).filter(|point| point[0] == x || x.is_nan()) {
                    Some(point) => {
                        *i += 1;
                        number(point[1])
                    }
                    None => String::new(),
                }
            });
            let cells: Vec<String> = [number(x)].into_iter().chain(cells).collect();
            row(text, cells);
        }
    }

    fn bar_table(&self, text: &mut String) {
        let all = self.of_kind(|data| match data {
            Data::Bars(bars) => Some(bars),
            _ => None,
        });
        let Some(most) = all.iter().map(|(_, bars)| bars.len()).max() else {
            return;
        };
        let ends = ["from", "to"].map(|end| self.x_end(end));
        let headings = all.iter().map(|(series, _)| self.heading(series));
        row(text, ends.into_iter().chain(headings));
        for i in 0..most {
            // Series of one histogram have the same bins.
            let Some(bin) = all.iter().find_map(|(_, bars)| bars.get(i)) else {
                return;
            };
            let height = |(_, bars): &(&Series, &Vec<crate::Bar>)| {
                let own = bars.iter().find(|bar| bar.from == bin.from);
                own.map_or_else(String::new, |bar| number(bar.height))
            };
            let ends = [number(bin.from), number(bin.to)];
            row(text, ends.into_iter().chain(all.iter().map(height)));
        }
    }

    fn span_table(&self, text: &mut String) {
        let all = self.of_kind(|data| match data {
            Data::Spans(spans) => Some(spans),
            _ => None,
        });
        if all.is_empty() {
            return;
        }
        let headings = ["series".into(), self.x_end("from"), self.x_end("to")];
        row(text, headings.into_iter().chain([column(&self.y)]));
        for (series, spans) in all {
            for span in spans {
                let numbers = [span.from, span.to, span.y].map(number);
                row(text, [series.name.clone()].into_iter().chain(numbers));
            }
        }
    }

    fn tick_table(&self, text: &mut String) {
        let all = self.of_kind(|data| match data {
            Data::Ticks { x, .. } => Some(x),
            _ => None,
        });
        if all.is_empty() {
            return;
        }
        row(text, ["series".into(), column(&self.x)]);
        for (series, x) in all {
            for &x in x {
                row(text, [series.name.clone(), number(x)]);
            }
        }
    }

    /// The heading of an end on the horizontal axis.
    fn x_end(&self, end: &str) -> String {
        let label = format!("{} {end}", self.x.label);
        column(&Axis::new(label, self.x.unit.as_str()))
    }
}

/// An axis as a heading: `path_distance_um`.
fn column(axis: &Axis) -> String {
    let unit = axis.unit.replace('µ', "u").replace('°', "deg");
    let words = format!("{} {unit}", axis.label);
    let words = words.split(|c: char| !c.is_alphanumeric());
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    words.join("_")
}

/// A number with the digits that tell it apart: as single precision, if it is one, as the values of reports are.
fn number(number: f64) -> String {
    let single = number as f32;
    match number.is_finite() {
        false => String::new(),
        true if f64::from(single) == number => single.to_string(),
        true => number.to_string(),
    }
}

fn row(text: &mut String, cells: impl IntoIterator<Item = String>) {
    for (i, cell) in cells.into_iter().enumerate() {
        if i > 0 {
            text.push(',');
        }
        let quotes = cell.contains([',', '"', '\n', '\r']);
        // Writing to a string does not fail.
        let _ = match quotes {
            true => write!(text, "\"{}\"", cell.replace('"', "\"\"")),
            false => write!(text, "{cell}"),
        };
    }
    text.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Bar;

    fn plot(series: Vec<Series>) -> Plot {
        Plot {
            title: String::new(),
            x: Axis::new("path distance", "µm"),
            y: Axis::new("value", "mV"),
            series,
        }
    }

    #[test]
    fn lines_share_a_column_of_x() {
        let low = f64::from(-79.99_f32);
        let a = Series::new("a, \"b\"", 0, Data::Line(vec![[0.0, low], [1.0, 2.5]]));
        let c = Series::new("c", 1, Data::Line(vec![[1.0, f64::NAN], [3.0, 1e-3]]));
        let expected =
            "path_distance_um,\"a, \"\"b\"\" (mV)\",c (mV)\n0,-79.99,\n1,2.5,\n3,,0.001\n";
        assert_eq!(plot(vec![a, c]).csv(), expected);
        assert_eq!(plot(vec![]).csv(), "");
    }

    #[test]
    fn bars_spans_and_ticks_have_their_ends() {
        let bar = |from: f64, height| Bar {
            from,
            to: from + 5.0,
            height,
        };
        let bars = Data::Bars(vec![bar(0.0, 3.0), bar(5.0, 1.0)]);
        let text = plot(vec![Series::new("", 0, bars)]).csv();
        let expected = "path_distance_from_um,path_distance_to_um,value (mV)\n0,5,3\n5,10,1\n";
        assert_eq!(text, expected);
        let span = crate::Span {
            from: 0.0,
            to: 9.5,
            y: 1.0,
        };
        let text = plot(vec![Series::new("n", 0, Data::Spans(vec![span]))]).csv();
        assert!(
            text.ends_with("distance_to_um,value_mV\nn,0,9.5,1\n"),
            "{text}"
        );
        let ticks = Data::Ticks {
            x: vec![0.1, 7.0],
            y: 1.0,
        };
        let text = plot(vec![Series::new("n", 0, ticks)]).csv();
        assert_eq!(text, "series,path_distance_um\nn,0.1\nn,7\n");
    }
}
