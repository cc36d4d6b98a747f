//! Pictures of the window's sessions.

use std::path::{Path, PathBuf};

use neurotess::drawing::DrawOptions;

use super::args::RenderArgs;
#[cfg(feature = "view")]
use neurotess::drawing::{open, wanted};

#[cfg(feature = "view")]
use super::stats::Document;
#[cfg(feature = "view")]
use crate::report::{Failure, count};
use crate::report::{Reporter, usage};

/// Draws a session of the window in its own or a saved view and in its look, with the size and samples of the
/// options.
#[cfg(feature = "view")]
pub(super) fn draw(
    session: &Path,
    files: &[PathBuf],
    (args, options): (&RenderArgs, &DrawOptions),
    reporter: &Reporter,
) -> anyhow::Result<()> {
    const TAKEN: [&str; 4] = ["size", "samples", "transparent", "saved_view"];
    let mut given = args.given.given.iter();
    if let Some(other) = given.find(|name| !TAKEN.contains(&name.as_str())) {
        return usage(format!(
            "a session is drawn in its own view and look: leave out --{}",
            other.replace('_', "-")
        ));
    }
    if args.like.is_some() {
        return usage("a session is drawn in its own view and look: leave out --like");
    }
    let [out] = files else {
        return usage("a session is one picture: leave out --turntable and times");
    };
    let picture = neurotess_viewer::save::PictureFile {
        out: out.clone(),
        size: options.picture.look.size.0,
        samples: options.picture.look.samples.0,
        transparent: options.picture.look.transparent,
        replace: args.force,
        recipe: !args.no_recipe,
    };
    let wanted = wanted(options).map_err(super::told)?;
    let drawn = neurotess_viewer::draw_session(
        session,
        &picture,
        options.picture.camera.saved_view.as_deref(),
        &|patches| wanted.device(patches, &open),
        args.cache.no_cache,
    );
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
    reporter.document(&Document::new(Vec::new(), files, None))
}

/// Reports that this build cannot draw sessions.
#[cfg(not(feature = "view"))]
pub(super) fn draw(
    session: &Path,
    _files: &[PathBuf],
    _asked: (&RenderArgs, &DrawOptions),
    _reporter: &Reporter,
) -> anyhow::Result<()> {
    usage(format!(
        "{}: this build has no window, whose session this is: build it with the feature 'view'",
        session.display()
    ))
}

/// Whether a file is a session of the window.
#[cfg(feature = "view")]
pub(super) use neurotess_viewer::session::is_session;

/// Whether a file is named as sessions of the window are.
#[cfg(not(feature = "view"))]
pub(super) fn is_session(path: &Path) -> bool {
    path.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("neurotess"))
}
