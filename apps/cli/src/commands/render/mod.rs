//! `neurotess render`: pictures of cells and circuits, without a window.
//!
//! ```text
//! arguments ─read, mesh─▶ a scene ─▶ a drawing ─draw─▶ bands ─▶ PNG, stats
//! ```

mod args;
mod files;
mod host;
mod session;
mod stats;

use std::io;

use neurotess::batch::{Inputs, MORPHOLOGIES};
use neurotess::drawing::{
    DrawError, DrawOptions, Drawing, OwnData, Scene, open, read_circuit, read_files,
};
use neurotess::output::write_into;

use crate::io::circuits::partition;
use crate::io::inputs;
use crate::io::output;
use crate::report::{Progress, Reporter, Usage, count, usage};
pub(crate) use args::RenderArgs;
use stats::{Document, InputEntry, Stage, Stages, Stats};

/// Runs the command.
pub(crate) fn run(args: &RenderArgs, reporter: &Reporter) -> anyhow::Result<()> {
    output::reserve_standard(&args.out, reporter)?;
    let options = args.options(reporter).map_err(told)?;
    let picture = options.picture.clone();
    let files = files::names(&args.out, &picture)?;
    picture.check().map_err(|e| told(e.into()))?;
    for file in files.iter().chain(&args.stats) {
        output::check(file, args.force)?;
    }
    if let [path] = &args.inputs[..]
        && session::is_session(path)
    {
        return session::draw(path, &files, (args, &options), reporter);
    }
    if picture.camera.saved_view.is_some() {
        return usage("--saved-view is of a session: give the session's file");
    }
    picture.check_values().map_err(|e| told(e.into()))?;
    let mut stages = Stages::begin();
    let mut scene = read_scene(&args.inputs, &options, reporter)?;
    stages.end(Stage::Read);
    let inputs: Vec<InputEntry> = scene.entries.iter().map(Into::into).collect();
    if scene.placements.is_empty() {
        return reporter.document(&Document::new(inputs, &[], None));
    }
    let cache = scene.cache.take();
    let drawing = Drawing::of_scene(scene, options, OwnData::default(), &open, reporter);
    let mut drawing = drawing.map_err(told)?;
    stages.of_drawing(drawing.seconds());
    let ([name, _], software) = drawing.painter();
    if software && drawing.by_adapter() {
        reporter.note(&format!("drawn by the processor: {name}"));
    }
    let mut stats = Stats::new(&drawing);
    let progress = Progress::new(reporter, files.len(), "pictures");
    for (number, file) in files.iter().enumerate() {
        let recipe = drawing.recipe(number);
        let of = (&picture, &recipe[..]);
        let cost = files::write(file, args, of, |take| drawing.paint(number, take));
        let cost = cost.map_err(told)?;
        stats.film = drawing.film();
        // Every picture of a film shows the same surface.
        let same = stats.film.is_some() && number > 0;
        let counted = (!same).then(|| drawing.counted(number)).transpose();
        stats.add(&cost, counted.map_err(told)?);
        let left_out = [stats.lowered(), stats.coarsened(), stats.thinned()];
        for left_out in left_out.iter().flatten() {
            reporter.warning(left_out);
        }
        progress.done();
    }
    drop(progress);
    reporter.note(&count(files.len(), "picture"));
    stages.end(Stage::Draw);
    stats.took(stages);
    stats.cache = cache.map(Into::into);
    stats.colors = drawing.closest_colors().map(Into::into);
    if let Some(path) = &args.stats {
        let output = output::begin(path, args.force)?;
        write_into(output, path, |to| {
            serde_json::to_writer_pretty(to, &stats).map_err(io::Error::from)
        })?;
    }
    for file in &files {
        reporter.result(&format!("{}: {}", file.display(), stats.line()));
    }
    reporter.document(&Document::new(inputs, &files, Some(&stats)))
}

/// Reads and meshes all inputs: tracings, or one circuit.
///
/// # Errors
/// Wrong usage: a circuit beside other inputs, or a selection of cells without a circuit.
pub(crate) fn read_scene(
    inputs: &[std::path::PathBuf],
    options: &DrawOptions,
    reporter: &Reporter,
) -> anyhow::Result<Scene> {
    let (circuits, others) = partition(inputs);
    let read = match &circuits[..] {
        [path] if others.is_empty() => read_circuit(path, options, reporter),
        [] => {
            let found = Inputs::find(inputs, &MORPHOLOGIES);
            inputs::tell(&found, reporter);
            let files = found.files.into_iter().map(|input| input.path);
            read_files(&files.collect::<Vec<_>>(), options, reporter)
        }
        _ => return usage("a circuit is drawn alone: leave out the other inputs"),
    };
    read.map_err(told)
}

/// Options that are wrong are wrong usage.
pub(crate) fn told(error: DrawError) -> anyhow::Error {
    match error {
        DrawError::Option(wrong) => Usage(wrong.to_string()).into(),
        DrawError::Output(fault) => fault.into(),
        other => anyhow::anyhow!("{other}"),
    }
}
