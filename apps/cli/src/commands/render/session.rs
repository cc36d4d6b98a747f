//! Pictures of sessions that the window saved.

use std::path::{Path, PathBuf};

use super::args::RenderArgs;
use super::stats;
use crate::report::{Failure, Reporter, count, usage};

/// A session of the window: its own view and look, at the size and smoothness of the options.
pub(super) fn draw(
    session: &Path,
    files: &[PathBuf],
    args: &RenderArgs,
    reporter: &Reporter,
) -> anyhow::Result<()> {
    let [out] = files else {
        return usage("a session is one picture: leave out --turntable and times");
    };
    let picture = neurotess_viewer::save::PictureFile {
        out: out.clone(),
        size: args.size.0,
        samples: args.samples,
        transparent: args.transparent,
        replace: args.force,
    };
    let drawn = neurotess_viewer::draw_session(session, &picture, args.adapter.as_deref());
    let drawn = drawn.map_err(anyhow::Error::msg)?;
    for (file, why) in &drawn.failures {
        reporter.failure(&Failure(format!("{file}: {why}")));
    }
    reporter.result(&format!(
        "{}: {} of {}",
        out.display(),
        count(drawn.neurons, "neuron"),
        session.display()
    ));
    reporter.document(&stats::Document::new(&[], files, None))
}
