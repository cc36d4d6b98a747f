//! Whether colors can be told apart, and whether those that were set are in the picture.

use neurotess_color::{ClosestColors, ColorTarget, ColoredThing, Coloring, closest, kinds};
use neurotess_options::Picture;
use neurotess_picture::color::Palette;

use crate::host::Host;

/// Warns of colors that look alike, and of colors for things that are not in the picture. Returns
/// the closest colors.
pub(super) fn check(
    coloring: &Coloring,
    picture: &Picture,
    host: &dyn Host,
) -> Option<ClosestColors> {
    for set in &picture.colors.set_color {
        if !is_there(&set.name, &coloring.things) {
            host.warning(&absent(&set.name, &coloring.things));
        }
    }
    let closest = closest(coloring.legend.entries());
    if let Some(colors) = closest.as_ref().filter(|colors| colors.alike > 0) {
        let instead = match picture.colors.base_palette() {
            Palette::OkabeIto => "",
            _ => ", or --palette okabe-ito",
        };
        host.warning(&format!("{colors}: choose others by --set-color{instead}"));
    }
    closest
}

fn is_there(name: &str, things: &[ColoredThing]) -> bool {
    let kinds = kinds(name).unwrap_or_default();
    things.iter().any(|thing| match &thing.target {
        ColorTarget::Type(kind) => kinds.contains(kind),
        ColorTarget::Category(category) => category == name,
    })
}

/// Most names that a warning lists.
const MAX_NAMES: usize = 8;

fn absent(name: &str, things: &[ColoredThing]) -> String {
    let names = things.iter().take(MAX_NAMES);
    let mut names: Vec<String> = names.map(|thing| thing.target.to_string()).collect();
    if things.len() > names.len() {
        names.push("…".into());
    }
    let there = match names.is_empty() {
        true => "colors are those of numbers".to_owned(),
        false => format!("there are {}", names.join(", ")),
    };
    format!("--set-color: nothing in the picture is called '{name}': {there}")
}
