//! What colors tell, as the options say.

use std::path::Path;

use neurotess::coloring::{self, Cell, ColorScheme, Coloring, DECAY, Recording, by_attribute};
use neurotess::render::{ColorTable, Legend};

use super::args::{ColorBy, RenderArgs};
use super::cells;
use super::circuit_instances::Shown;
use super::times::{self, said};
use crate::report::Reporter;

/// Colors of all pictures.
pub(crate) struct Colored {
    /// Of the first.
    pub(crate) coloring: Coloring,
    /// Of a series over time: what differs.
    film: Option<Film>,
}

/// A recording, and the time (ms) of each picture.
struct Film {
    replay: Recording,
    times: Vec<f64>,
    range: [f32; 2],
}

impl Colored {
    /// Table and legend of a picture: of a series only the values differ.
    pub(crate) fn picture(&self, number: usize) -> anyhow::Result<(ColorTable, Legend)> {
        let Coloring { table, legend, .. } = &self.coloring;
        let time = |film: &Film| film.times.get(number).copied();
        let Some((film, time)) = self.film.as_ref().and_then(|f| Some((f, time(f)?))) else {
            return Ok((table.clone(), legend.clone()));
        };
        let moment = film.replay.at(time, DECAY, &|_| true).map_err(told)?;
        let table = ColorTable {
            scale: table.scale.clone(),
            categories: table.categories.clone(),
            values: moment.values(film.range),
        };
        Ok((table, legend.clone().noted(&said(&film.times, time))))
    }
}

/// Chooses the colors. `shown`: what a circuit shows; `places`: the cell at each.
///
/// # Errors
/// What is wrong with a report.
pub(crate) fn colored(
    cells: &[&cells::Cell],
    shown: Option<&Shown>,
    places: &[usize],
    args: &RenderArgs,
    reporter: &Reporter,
) -> anyhow::Result<Colored> {
    let background = (!args.transparent).then_some(args.background.0);
    let paint = ColorScheme {
        palette: args.palette,
        background,
        scale: match background.filter(|_| args.trim_colormap) {
            Some(background) => args.colormap.scale_before(background),
            None => args.colormap.scale(),
        },
        range: args.range,
    };
    let names: Vec<String> = cells.iter().map(|cell| stem(&cell.file)).collect();
    let cells: Vec<Cell<'_>> = cells
        .iter()
        .zip(&names)
        .map(|(cell, name)| Cell {
            name,
            morphology: &cell.morphology,
            mesh: &cell.mesh,
        })
        .collect();
    if let (Some(report), Some(shown)) = (&args.report, shown) {
        let stand = shown.stand(places);
        let replay = Recording::open(report, &shown.circuit, &cells, &stand).map_err(told)?;
        return over_time(replay, args, &paint, reporter);
    }
    let coloring = match shown {
        Some(shown) => of_circuit(&cells, shown, args, &paint)?,
        None => None,
    };
    let by = by(args.color_by.unwrap_or(ColorBy::Type));
    let of_cells = || coloring::coloring(&cells, by, &paint);
    Ok(Colored {
        coloring: coloring.unwrap_or_else(of_cells),
        film: None,
    })
}

/// Colors that cells of a circuit have as a whole, if those are wanted.
fn of_circuit(
    cells: &[Cell<'_>],
    shown: &Shown,
    args: &RenderArgs,
    paint: &ColorScheme,
) -> anyhow::Result<Option<Coloring>> {
    let neurons = shown.neurons();
    match (&args.color_by_attribute, args.color_by) {
        (Some(attribute), _) => {
            let named = |e| anyhow::anyhow!("{}: {e}", shown.circuit.file);
            let coloring = by_attribute(cells, &neurons, attribute, paint);
            coloring.map(Some).map_err(named)
        }
        (None, Some(ColorBy::Neuron)) => Ok(Some(coloring::each(cells, &shown.names(), paint))),
        (None, None) => Ok(coloring::given(cells, &neurons)),
        (None, Some(_)) => Ok(None),
    }
}

/// Values of a recording: at one time, or of a series.
fn over_time(
    replay: Recording,
    args: &RenderArgs,
    paint: &ColorScheme,
    reporter: &Reporter,
) -> anyhow::Result<Colored> {
    let without = replay.without();
    if without > 0 {
        let (all, file) = (replay.places(), &replay.file);
        reporter.warning(&format!(
            "{file}: no values for {without} of {all} cells: drawn gray"
        ));
    }
    if args.time.is_none() && replay.is_of_spikes() {
        let file = &replay.file;
        anyhow::bail!("{file}: spikes flash at a time: choose one with --time");
    }
    let times = times::times(args.time, args.frames)?.unwrap_or_else(|| vec![replay.time.start]);
    let range = match args.range {
        Some(range) => range,
        None => {
            let times = times.iter().copied();
            replay.range_at(times, &|_| true).map_err(told)?
        }
    };
    let coloring = replay.coloring(range, paint);
    let film = Some(Film {
        replay,
        times,
        range,
    });
    let mut colored = Colored { coloring, film };
    let (table, legend) = colored.picture(0)?;
    (colored.coloring.table, colored.coloring.legend) = (table, legend);
    Ok(colored)
}

/// The whole message is the error's own: its source would be told twice.
fn told(error: impl std::fmt::Display) -> anyhow::Error {
    anyhow::anyhow!("{error}")
}

fn stem(file: &str) -> String {
    let stem = Path::new(file).file_stem().unwrap_or_default();
    stem.to_string_lossy().into_owned()
}

fn by(what: ColorBy) -> coloring::ColorBy {
    match what {
        // Arguments have been checked: a value comes with a report.
        ColorBy::Type | ColorBy::Value => coloring::ColorBy::Type,
        ColorBy::Neurite => coloring::ColorBy::Neurite,
        ColorBy::Section => coloring::ColorBy::Section,
        ColorBy::BranchOrder => coloring::ColorBy::BranchOrder,
        ColorBy::Radius => coloring::ColorBy::Radius,
        ColorBy::PathDistance => coloring::ColorBy::PathDistance,
        ColorBy::Neuron => coloring::ColorBy::Neuron,
    }
}
