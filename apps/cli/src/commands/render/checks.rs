//! Checks options together; names of the pictures.

use std::path::PathBuf;

use super::args::{ColorBy, RenderArgs};
use crate::io::output;
use crate::report::usage;

/// Checks that values are colored by only with a report, and a report is given only for its values.
pub(super) fn check_value(args: &RenderArgs) -> anyhow::Result<()> {
    match (args.color_by, &args.report) {
        (Some(ColorBy::Value), None) => usage("--color-by value needs a --report"),
        (Some(other), Some(_)) if other != ColorBy::Value => {
            usage("a --report gives values: leave out --color-by")
        }
        _ if args.range.is_some() && !args.is_number() => {
            usage("--range is for numbers: use --color-by order, radius or depth, or a --report")
        }
        _ => Ok(()),
    }
}

/// Names of the pictures.
pub(super) fn files(args: &RenderArgs) -> anyhow::Result<Vec<PathBuf>> {
    let out = &args.out;
    let png = out
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("png"));
    if output::is_standard(out) {
        return match args.series()? {
            None => Ok(vec![out.clone()]),
            Some(_) => usage("standard output takes one picture: name a series OUT.png"),
        };
    }
    let Some(stem) = out.file_stem().filter(|_| png) else {
        return usage(format!(
            "{}: pictures are PNG files: name it OUT.png",
            out.display()
        ));
    };
    let Some(frames) = args.series()? else {
        return Ok(vec![out.clone()]);
    };
    let stem = stem.to_string_lossy();
    let name = |frame| out.with_file_name(format!("{stem}_{frame:04}.png"));
    Ok((0..frames).map(name).collect())
}
