//! A plot as SVG: black on white, with axes, ticks and a legend.

use std::fmt::Write;

use crate::scale::Scale;
use crate::{Data, Plot, Series, TICK, panels, thinned};

/// Room (pixels) around the plot: above, right, below, left.
const MARGIN: [f64; 4] = [14.0, 16.0, 46.0, 64.0];
/// Height of a line of text, and width of a letter, of this font.
const LINE: f64 = 17.0;
const LETTER: f64 = 6.6;
/// Widest legend, as a share of the picture.
const LEGEND: f64 = 0.4;
/// Most series that a legend names.
const NAMED: usize = 24;

/// Where numbers are in the picture.
struct Frame {
    /// Left, top, right, bottom (pixels).
    rect: [f64; 4],
    scales: [Scale; 2],
}

impl Frame {
    fn x(&self, x: f64) -> f64 {
        let [left, _, right, _] = self.rect;
        left + self.scales[0].share(x) * (right - left)
    }

    fn y(&self, y: f64) -> f64 {
        let [_, top, _, bottom] = self.rect;
        bottom - self.scales[1].share(y) * (bottom - top)
    }
}

impl Plot {
    /// A picture of this size (pixels). Lines of more points than it can show are drawn by the greatest and least values
    /// of each pixel: [`Plot::csv`] has all of them.
    pub fn svg(&self, size: [u32; 2]) -> String {
        panels(std::slice::from_ref(self), 1, size)
    }

    /// What is within a picture of this size (pixels).
    pub(crate) fn svg_content(&self, [width, height]: [f64; 2]) -> String {
        let mut text = String::new();
        let named = self.named();
        let legend = match named.is_empty() {
            true => 0.0,
            false => {
                let letters = named.iter().map(|s| s.name.chars().count()).max();
                (30.0 + LETTER * letters.unwrap_or(0) as f64).min(LEGEND * width)
            }
        };
        let title = if self.title.is_empty() {
            0.0
        } else {
            LINE + 4.0
        };
        let rect = [
            MARGIN[3],
            MARGIN[0] + title,
            width - MARGIN[1] - legend,
            height - MARGIN[2],
        ];
        let frame = Frame {
            rect,
            scales: self.scales(),
        };
        if title > 0.0 {
            let middle = (rect[0] + rect[2]) / 2.0;
            let (y, title) = (MARGIN[0] + 4.0, escaped(&self.title));
            let _ = writeln!(
                text,
                "<text x=\"{middle:.1}\" y=\"{y:.1}\" text-anchor=\"middle\" font-size=\"14\">{title}</text>"
            );
        }
        self.axes(&frame, &mut text);
        let [_, top, right, _] = rect;
        text.push_str("<g fill=\"none\" stroke-width=\"1.5\" stroke-linejoin=\"round\">\n");
        for series in &self.series {
            drawn(series, &frame, &mut text);
        }
        text.push_str("</g>\n");
        for (i, series) in named.iter().enumerate() {
            let y = top + LINE * (i as f64 + 0.5);
            let (x, [r, g, b]) = (right + 12.0, series.color);
            let letters = ((legend - 30.0) / LETTER).round().max(4.0) as usize;
            let name = escaped(&shortened(&series.name, letters));
            let _ = writeln!(
                text,
                "<rect x=\"{x:.1}\" y=\"{:.1}\" width=\"12\" height=\"4\" fill=\"#{r:02x}{g:02x}{b:02x}\"/>\
                 <text x=\"{:.1}\" y=\"{:.1}\">{name}</text>",
                y - 2.0,
                x + 18.0,
                y + 4.0
            );
        }
        text
    }

    /// Series of the legend: if there are several with names.
    fn named(&self) -> Vec<&Series> {
        let named: Vec<&Series> = self.series.iter().filter(|s| !s.name.is_empty()).collect();
        match named.len() {
            0 => Vec::new(),
            1 if self.title == named[0].name => Vec::new(),
            _ => named.into_iter().take(NAMED).collect(),
        }
    }

    fn scales(&self) -> [Scale; 2] {
        let [x, y] = self.bounds().unwrap_or([[1.0, 2.0]; 2]);
        [
            Scale::new(x, self.x.logarithmic, None),
            Scale::new(y, self.y.logarithmic, Some(6)),
        ]
    }

    fn axes(&self, frame: &Frame, text: &mut String) {
        let [left, top, right, bottom] = frame.rect;
        let wide = (((right - left) / 70.0) as usize).max(2);
        for (x, label) in frame.scales[0].ticks(wide) {
            let at = frame.x(x);
            let _ = writeln!(
                text,
                "<path d=\"M{at:.1} {top:.1}V{bottom:.1}\" stroke=\"#e4e4e4\"/>\
                 <text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{label}</text>",
                bottom + 16.0
            );
        }
        let high = (((bottom - top) / 40.0) as usize).clamp(2, 8);
        for (y, label) in frame.scales[1].ticks(high) {
            let at = frame.y(y);
            let _ = writeln!(
                text,
                "<path d=\"M{left:.1} {at:.1}H{right:.1}\" stroke=\"#e4e4e4\"/>\
                 <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>",
                left - 6.0,
                at + 4.0
            );
        }
        let (middle, half) = ((left + right) / 2.0, (top + bottom) / 2.0);
        let (x, y) = (escaped(&self.x.title()), escaped(&self.y.title()));
        let _ = writeln!(
            text,
            "<path d=\"M{left:.1} {top:.1}V{bottom:.1}H{right:.1}\" fill=\"none\" stroke=\"black\"/>\n\
             <text x=\"{middle:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{x}</text>\n\
             <text transform=\"translate(16 {half:.1}) rotate(-90)\" text-anchor=\"middle\">{y}</text>",
            bottom + 36.0
        );
    }
}

fn drawn(series: &Series, frame: &Frame, text: &mut String) {
    let [r, g, b] = series.color;
    let color = format!("#{r:02x}{g:02x}{b:02x}");
    match &series.data {
        Data::Line(points) => {
            let pixels = (frame.rect[2] - frame.rect[0]).max(1.0) as usize;
            let points = thinned(points, frame.scales[0].bounds(), 2 * pixels);
            let mut path = String::new();
            let mut goes_on = false;
            for [x, y] in points {
                let (x, y) = (frame.x(x), frame.y(y));
                if !(x.is_finite() && y.is_finite()) {
                    goes_on = false;
                    continue;
                }
                let sign = if goes_on { 'L' } else { 'M' };
                let _ = write!(path, "{sign}{x:.2} {y:.2}");
                goes_on = true;
            }
            let _ = writeln!(text, "<path d=\"{path}\" stroke=\"{color}\"/>");
        }
        Data::Dots(points) => {
            let places = points.iter().map(|&[x, y]| [frame.x(x), frame.y(y)]);
            for [x, y] in places.filter(|at| at.iter().all(|n| n.is_finite())) {
                let _ = writeln!(
                    text,
                    "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"3\" fill=\"{color}\"/>"
                );
            }
        }
        Data::Bars(bars) => {
            let floor = frame.y(0.0);
            for bar in bars.iter().filter(|bar| bar.height > 0.0) {
                let (x, y) = (frame.x(bar.from), frame.y(bar.height));
                let (width, height) = (frame.x(bar.to) - x, floor - y);
                let _ = writeln!(
                    text,
                    "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{width:.2}\" height=\"{height:.2}\" fill=\"{color}\" \
                     fill-opacity=\"0.55\" stroke=\"{color}\" stroke-width=\"1\"/>"
                );
            }
        }
        Data::Spans(spans) => {
            let lines = spans.iter().map(|s| [[s.from, s.y], [s.to, s.y]]);
            separate(lines, &color, frame, text);
        }
        Data::Ticks { x, y } => {
            let lines = x.iter().map(|&x| [[x, y - TICK], [x, y + TICK]]);
            separate(lines, &color, frame, text);
        }
    }
}

/// Lines from a point to another.
fn separate(
    lines: impl Iterator<Item = [[f64; 2]; 2]>,
    color: &str,
    frame: &Frame,
    text: &mut String,
) {
    let mut path = String::new();
    for [[x, y], [u, v]] in lines {
        let _ = write!(
            path,
            "M{:.2} {:.2}L{:.2} {:.2}",
            frame.x(x),
            frame.y(y),
            frame.x(u),
            frame.y(v)
        );
    }
    let _ = writeln!(text, "<path d=\"{path}\" stroke=\"{color}\"/>");
}

/// A text without what has a meaning in XML, and without what XML cannot have at all.
fn escaped(text: &str) -> String {
    let mut safe = String::new();
    for letter in text.chars() {
        match letter {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            letter if letter.is_control() => safe.push(' '),
            letter => safe.push(letter),
        }
    }
    safe
}

fn shortened(text: &str, letters: usize) -> String {
    match text.chars().count() > letters {
        true => text.chars().take(letters - 1).chain(['…']).collect(),
        false => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Axis, Bar};

    #[test]
    fn names_are_escaped_and_gaps_begin_new_lines() {
        let line = |y: f64| Data::Line(vec![[0.0, y], [1.0, y], [2.0, f64::NAN], [3.0, y]]);
        let plot = Plot {
            title: "a < b & \"c\"\u{1}".into(),
            x: Axis::new("time", "ms"),
            y: Axis::new("voltage", "mV"),
            series: vec![
                Series::new("<soma>", 0, line(-65.0)),
                Series::new("dendrite", 1, line(-60.0)),
            ],
        };
        let text = plot.svg([600, 400]);
        for part in [
            "a &lt; b &amp; &quot;c&quot; ",
            "&lt;soma&gt;",
            "time (ms)",
            "voltage (mV)",
            "stroke=\"#0072b2\"",
            ">-65<",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
        let path = text.lines().find(|l| l.contains("stroke=\"#0072b2\""));
        let path = path.expect("a line");
        assert_eq!(path.matches('M').count(), 2, "{path}");
        assert!(!text.contains("NaN") && text.ends_with("</svg>\n"));
    }

    #[test]
    fn legends_have_whole_names_where_there_is_room() {
        let names = (1..40).map(|letters| "n".repeat(letters));
        for name in names {
            let line = || Data::Line(vec![[0.0, 1.0], [1.0, 2.0]]);
            let both = [name.as_str(), "n"].map(|name| Series::new(name, 0, line()));
            let plot = Plot {
                series: both.into(),
                ..Plot::default()
            };
            let text = plot.svg([900, 480]);
            assert!(text.contains(&format!(">{name}<")), "{name}");
        }
    }

    #[test]
    fn a_long_line_is_drawn_by_its_extremes() {
        let points = (0..1_000_000).map(|i| [f64::from(i), f64::from(i % 1000)]);
        let plot = Plot {
            series: vec![Series::new("", 0, Data::Line(points.collect()))],
            ..Plot::default()
        };
        let text = plot.svg([600, 400]);
        assert!(text.len() < 200_000, "{}", text.len());
    }

    #[test]
    fn bars_stand_on_zero_and_nothing_is_a_frame() {
        let bar = Bar {
            from: 1.0,
            to: 2.0,
            height: 4.0,
        };
        let plot = Plot {
            series: vec![Series::new("", 0, Data::Bars(vec![bar]))],
            ..Plot::default()
        };
        let text = plot.svg([300, 200]);
        assert!(text.contains("fill-opacity"), "{text}");
        let nothing = Plot::default().svg([300, 200]);
        assert!(
            nothing.contains("</svg>") && !nothing.contains("NaN"),
            "{nothing}"
        );
    }
}
