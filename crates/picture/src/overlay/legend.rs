//! Legends and scale bars, drawn as images to be blended over pictures.

use crate::color::Rgb;
use crate::image::Image;
use crate::overlay::text::Text;

/// What the colors of a picture mean.
#[derive(Clone, Debug, PartialEq)]
pub struct Legend {
    title: String,
    note: String,
    widths: String,
    kind: Kind,
    below: Option<Box<Legend>>,
}

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    /// Colors with names: a disc for each.
    Swatches(Vec<(Rgb, String)>),
    /// A bar with numbers beside it.
    Bar {
        scale: Vec<Rgb>,
        range: [f32; 2],
        /// Whether the upper end also stands for what lies above.
        more: bool,
    },
}

impl Legend {
    /// Colors with names.
    pub fn swatches(title: &str, entries: impl IntoIterator<Item = (Rgb, String)>) -> Self {
        Self {
            title: title.to_owned(),
            note: String::new(),
            widths: String::new(),
            below: None,
            kind: Kind::Swatches(entries.into_iter().collect()),
        }
    }

    /// What its bar tells: its title, the numbers at its ends and its colors; none if it names colors.
    pub fn scale(&self) -> Option<(&str, [f32; 2], &[Rgb])> {
        match &self.kind {
            Kind::Bar { scale, range, .. } => Some((&self.title, *range, scale)),
            Kind::Swatches(_) => self.below.as_ref()?.scale(),
        }
    }

    /// A scale from `range[0]` to `range[1]`; `more`: its upper end stands for all above, too.
    pub fn bar(title: &str, unit: &str, scale: Vec<Rgb>, range: [f32; 2], more: bool) -> Self {
        let title = if unit.is_empty() {
            title.to_owned()
        } else {
            format!("{title} ({unit})")
        };
        Self {
            title,
            note: String::new(),
            widths: String::new(),
            below: None,
            kind: Kind::Bar { scale, range, more },
        }
    }

    /// Colors with names; none if it has a scale.
    pub fn entries(&self) -> &[(Rgb, String)] {
        match &self.kind {
            Kind::Swatches(entries) => entries,
            Kind::Bar { .. } => &[],
        }
    }

    /// Whether it has a scale of numbers.
    pub fn is_bar(&self) -> bool {
        matches!(self.kind, Kind::Bar { .. })
    }

    /// What is above it; may be empty.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// Numbers at the ends of its scale, and whether the upper end also stands for what lies above; none if
    /// it has no scale.
    pub fn range(&self) -> Option<([f32; 2], bool)> {
        match self.kind {
            Kind::Swatches(_) => None,
            Kind::Bar { range, more, .. } => Some((range, more)),
        }
    }

    /// Adds a line below, such as the time of a picture.
    #[must_use]
    pub fn noted(mut self, note: &str) -> Self {
        note.clone_into(&mut self.note);
        self
    }

    /// Says below all else how neurites differ from what was traced: drawn at least so many pixels wide (see
    /// [`Look::least_width`](crate::Look::least_width); 0: not), with radii times a factor (1: not).
    #[must_use]
    pub fn with_widths(mut self, least: f32, radius_factor: f64) -> Self {
        let least = (least > 0.0).then(|| format!("≥ {} px wide", (10.0 * least).round() / 10.0));
        let thicker = (radius_factor != 1.0).then(|| format!("radii × {radius_factor}"));
        self.widths = match (thicker, least) {
            (Some(thicker), Some(least)) => format!("neurites: {thicker}, {least}"),
            (Some(thicker), None) => format!("neurites: {thicker}"),
            (None, Some(least)) => format!("neurites {least}"),
            (None, None) => String::new(),
        };
        self
    }

    /// Has another legend below it, as of markers, and below those that are there already.
    #[must_use]
    pub fn with_below(mut self, below: Self) -> Self {
        self.below = Some(Box::new(match self.below {
            Some(first) => first.with_below(below),
            None => below,
        }));
        self
    }

    /// Draws it on a transparent image, with lines of this height (pixels).
    pub fn draw(&self, line: f32, ink: Rgb) -> Image {
        let own = self.draw_own(line, ink);
        match &self.below {
            Some(below) => own.above(&below.draw(line, ink), (0.5 * line) as u32),
            None => own,
        }
    }

    fn draw_own(&self, line: f32, ink: Rgb) -> Image {
        let text = Text::new(line);
        let title = if self.title.is_empty() {
            0.0
        } else {
            1.35 * line
        };
        let (width, height) = match &self.kind {
            Kind::Swatches(entries) => {
                let widths = entries.iter().map(|(_, name)| text.width(name));
                (
                    1.4 * line + widths.fold(0.0, f32::max),
                    1.3 * line * entries.len() as f32,
                )
            }
            Kind::Bar { .. } => (
                0.9 * line + text.width(" ≥ 00000.0"),
                BAR_LINES * line + line,
            ),
        };
        let below = [&self.note, &self.widths].map(String::as_str);
        let below: Vec<&str> = below.into_iter().filter(|note| !note.is_empty()).collect();
        let widths = below.iter().map(|note| text.width(note));
        let width = widths.fold(width.max(text.width(&self.title)), f32::max) + 2.0;
        let all = (height + title + 1.35 * line * below.len() as f32).ceil();
        let mut image = Image::new(width.ceil() as u32, all as u32);
        text.draw(&mut image, 0.0, 0.55 * line, &self.title, ink);
        for (note, row) in below.iter().rev().zip(0_u16..) {
            let y = all - (0.6 + 1.35 * f32::from(row)) * line;
            text.draw(&mut image, 0.0, y, note, ink);
        }
        match &self.kind {
            Kind::Swatches(entries) => {
                for ((color, name), row) in entries.iter().zip(0_u16..) {
                    let y = title + 1.3 * line * (f32::from(row) + 0.5);
                    disc(&mut image, [0.5 * line, y], 0.36 * line, *color);
                    text.draw(&mut image, 1.25 * line, y, name, ink);
                }
            }
            Kind::Bar { scale, range, more } => {
                let top = title + 0.5 * line;
                bar(&mut image, &text, scale, *range, *more, top, ink);
            }
        }
        image
    }
}

/// Height of a bar, in lines.
const BAR_LINES: f32 = 9.0;

fn bar(
    image: &mut Image,
    text: &Text,
    scale: &[Rgb],
    range: [f32; 2],
    more: bool,
    top: f32,
    ink: Rgb,
) {
    let line = text.size;
    let (height, width) = (BAR_LINES * line, 0.8 * line);
    for row in 0..height as u32 {
        let fraction = 1.0 - (row as f32 + 0.5) / height;
        let entry = (fraction * scale.len() as f32) as usize;
        let Some(&color) = scale.get(entry) else {
            continue;
        };
        for column in 0..width as u32 {
            let (x, y) = (i64::from(column), i64::from(row) + top as i64);
            image.blend(x, y, color, 1.0);
        }
    }
    for (share, label) in ticks(range, more, line / height) {
        let y = top + height * (1.0 - share);
        for column in 0..(0.25 * line).ceil() as i64 {
            image.blend(width as i64 + column, y as i64, ink, 0.8);
        }
        text.draw(image, width + 0.45 * line, y, &label, ink);
    }
}

/// Round numbers beside a bar, with their position as a share of its height. `more`: the upper end
/// is one of them, round or not, marked as standing for all above. They are at least `line`, a
/// share of the height, apart, so that they do not overlap.
fn ticks([low, high]: [f32; 2], more: bool, line: f32) -> Vec<(f32, String)> {
    let [low, high] = [low, high].map(f64::from);
    let step = nice_step((high - low) / 5.0);
    let mut ticks = Vec::new();
    let mut steps = (low / step).ceil();
    // 0 is added so that none is −0.
    while steps * step <= high + 1e-6 * high.abs() {
        let tick = steps * step + 0.0;
        let share = ((tick - low) / (high - low)) as f32;
        ticks.push((share, number(tick, step)));
        steps += 1.0;
    }
    if more {
        let label = ticks.iter().find(|(share, _)| *share > 0.999);
        let label = label.map_or(number(high, step / 10.0), |(_, label)| label.clone());
        ticks.retain(|(share, _)| 1.0 - share >= line);
        ticks.push((1.0, format!("≥ {label}")));
    }
    ticks
}

/// A scale bar `length` pixels long, with `length_um` written above in a line of this height
/// (pixels).
pub fn scale_bar(length_um: f64, length: f32, line: f32, ink: Rgb) -> Image {
    let text = Text::new(line);
    let name = format!("{} µm", number(length_um, length_um));
    let thick = (0.16 * line).max(1.0).round();
    let width = length.max(text.width(&name)) + 2.0;
    let mut image = Image::new(width.ceil() as u32, (1.35 * line + thick).ceil() as u32);
    let left = (width - length) / 2.0;
    text.draw(
        &mut image,
        (width - text.width(&name)) / 2.0,
        0.55 * line,
        &name,
        ink,
    );
    for x in 0..image.width {
        let covered = (left + length).min(x as f32 + 1.0) - left.max(x as f32);
        for y in 0..thick as u32 {
            let y = i64::from(image.height - 1 - y);
            image.blend(i64::from(x), y, ink, covered);
        }
    }
    image
}

/// The largest of 1, 2 and 5 times a power of ten that is not above `length`.
pub fn nice_length(length: f64) -> f64 {
    let power = 10_f64.powf(length.max(1e-9).log10().floor());
    let factors = [5.0, 2.0, 1.0];
    let fits = factors
        .into_iter()
        .find(|f| f * power <= length * (1.0 + 1e-9));
    fits.unwrap_or(1.0) * power
}

/// The smallest of 1, 2 and 5 times a power of ten that is not below `length`.
fn nice_step(length: f64) -> f64 {
    let below = nice_length(length);
    [1.0, 2.0, 2.5, 5.0]
        .map(|factor| factor * below)
        .into_iter()
        .find(|&step| step >= length * (1.0 - 1e-9) && nice_length(step) > 0.999 * step)
        .unwrap_or(below * 2.0)
}

/// A number with as many digits as steps of this size need.
fn number(value: f64, step: f64) -> String {
    let digits = (-step.log10()).ceil().clamp(0.0, 6.0) as usize;
    format!("{value:.digits$}")
}

fn disc(image: &mut Image, center: [f32; 2], radius: f32, color: Rgb) {
    let reach = radius.ceil() as i64 + 1;
    let [cx, cy] = center.map(|c| c as i64);
    for y in cy - reach..=cy + reach {
        for x in cx - reach..=cx + reach {
            let (dx, dy) = (x as f32 + 0.5 - center[0], y as f32 + 0.5 - center[1]);
            image.blend(x, y, color, (radius + 0.5 - dx.hypot(dy)).clamp(0.0, 1.0));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::ColorMap;

    #[test]
    fn lengths_are_round() {
        assert_eq!(
            [0.3, 1.0, 4.9, 260.0].map(nice_length),
            [0.2, 1.0, 2.0, 200.0]
        );
        assert_eq!(
            [0.3, 1.0, 4.9, 260.0].map(nice_step),
            [0.5, 1.0, 5.0, 500.0]
        );
        assert_eq!(number(0.5, 0.1), "0.5");
        assert_eq!(number(100.0, 50.0), "100");
    }

    #[test]
    fn what_differs_from_the_tracing_is_told() {
        let told = |least, factor| Legend::swatches("", []).with_widths(least, factor).widths;
        assert_eq!(told(0.0, 1.0), "");
        assert_eq!(told(2.0, 1.0), "neurites ≥ 2 px wide");
        assert_eq!(told(0.0, 3.0), "neurites: radii × 3");
        assert_eq!(told(3.375, 0.5), "neurites: radii × 0.5, ≥ 3.4 px wide");
    }

    #[test]
    fn ticks_are_a_line_apart_and_the_end_stands_for_more() {
        let line = 1.0 / BAR_LINES;
        for range in [
            [0.0, 0.51],
            [0.0, 0.5],
            [0.0, 1.0],
            [-80.3, 35.2],
            [3.0, 3.1],
            [0.0, 7e4],
        ] {
            for more in [false, true] {
                let ticks = ticks(range, more, line);
                let near = ticks.windows(2).any(|t| t[1].0 - t[0].0 < line);
                assert!(!near && ticks.len() > 1, "{range:?}: {ticks:?}");
                let end = ticks
                    .last()
                    .is_some_and(|(share, l)| *share == 1.0 && l.starts_with("≥ "));
                assert_eq!(end, more, "{range:?}: {ticks:?}");
            }
        }
        let labels = |range, more| -> Vec<String> {
            let ticks = ticks(range, more, line);
            ticks.into_iter().map(|(_, label)| label).collect()
        };
        assert_eq!(labels([0.0, 0.51], true), ["0.0", "0.2", "0.4", "≥ 0.51"]);
        assert_eq!(
            labels([0.0, 1.0], true),
            ["0.0", "0.2", "0.4", "0.6", "0.8", "≥ 1.0"]
        );
    }

    #[test]
    fn swatches_show_their_colors_and_bars_their_map() {
        let legend = Legend::swatches("", [([200, 10, 20], "axon".into())]);
        let image = legend.draw(20.0, [0; 3]);
        assert_eq!(image.at(10, 13), [200, 10, 20, 255]);
        let inked = image
            .pixels
            .chunks(4)
            .filter(|p| p[..3] == [0; 3] && p[3] > 200);
        assert!(inked.count() > 20, "letters");

        let bar = Legend::bar("depth", "µm", ColorMap::Viridis.scale(), [0.0, 70.0], false);
        let image = bar.draw(20.0, [0; 3]);
        let [r, g, b, _] = image.at(5, image.height - 12);
        assert!(
            r.abs_diff(68) < 4 && g < 8 && b.abs_diff(84) < 5,
            "{r} {g} {b}"
        );
    }

    #[test]
    fn a_scale_bar_is_as_long_as_it_says() {
        let image = scale_bar(50.0, 120.5, 16.0, [0; 3]);
        let row = (0..image.width).map(|x| u32::from(image.at(x, image.height - 1)[3]));
        assert!((row.sum::<u32>() as f32 / 255.0 - 120.5).abs() < 0.1);
    }
}
