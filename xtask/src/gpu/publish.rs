//! `cargo xtask gpu-page FILE.json`: the figures of a run become a section of `benchmarks/gpu.md`.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};

use super::page;
use super::results::{Results, replace};
use crate::steps::root;

const USAGE: &str = "cargo xtask gpu-page FILE.json [--to PAGE.md]";

/// What stands above all sections.
const PREFACE: &str = include_str!("preface.md");

/// Runs the command.
pub(crate) fn run(mut arguments: impl Iterator<Item = String>) -> anyhow::Result<()> {
    let (mut file, mut to) = (None, root().join("benchmarks/gpu.md"));
    let mut is_ours = true;
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--to" => {
                to = PathBuf::from(arguments.next().context(USAGE)?);
                is_ours = false;
            }
            _ if file.is_none() => file = Some(PathBuf::from(argument)),
            _ => bail!("{USAGE}"),
        }
    }
    let results = Results::read(&file.context(USAGE)?)?;
    if is_ours && (results.is_software() || results.reduced) {
        bail!(
            "{} is no graphics hardware, whose figures benchmarks/gpu.md has; --to PAGE.md writes another page",
            results.adapter()
        );
    }
    merge(&results, &to)?;
    println!("{} is in {}", page::title(&results), to.display());
    Ok(())
}

/// Writes the section, in the place of one of the same device and day or above all others, and its plots beside the page.
fn merge(results: &Results, to: &Path) -> anyhow::Result<()> {
    let title = page::title(results);
    let stem = to
        .file_stem()
        .context(USAGE)?
        .to_string_lossy()
        .into_owned();
    let plots = format!("{stem}/{}-", slug(&title));
    let folder = to.with_extension("");
    if !results.plots.is_empty() {
        fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    }
    for (name, plot) in &results.plots {
        let file = folder.join(format!("{}-{name}.svg", slug(&title)));
        fs::write(&file, plot).with_context(|| file.display().to_string())?;
    }
    let before = match to.exists() {
        true => fs::read_to_string(to).with_context(|| to.display().to_string())?,
        false => String::new(),
    };
    let section = format!("## {title}\n\n{}", deeper(&page::body(results, &plots)));
    replace(to, &merged(&before, &title, &section))
}

/// The page with this section instead of the one that has its title.
fn merged(page: &str, title: &str, section: &str) -> String {
    let mut sections: Vec<String> = page
        .split("\n## ")
        .skip(1)
        .map(|section| format!("## {}\n", section.trim_end()))
        .filter(|section| section.lines().next() != Some(&format!("## {title}")))
        .collect();
    sections.insert(0, section.trim_end().to_owned() + "\n");
    format!("{PREFACE}\n{}", sections.join("\n"))
}

/// The headings one level deeper.
fn deeper(text: &str) -> String {
    text.replace("\n## ", "\n### ")
}

/// A name for files.
fn slug(title: &str) -> String {
    let letters = title.to_lowercase();
    let words = letters.split(|letter: char| !letter.is_ascii_alphanumeric());
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    words.join("-")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_section_replaces_that_of_its_device_and_day() {
        let first = merged(
            "",
            "A, 2026-01-01",
            "## A, 2026-01-01\n\nfigures 1\n\n### Goals\n",
        );
        let second = merged(&first, "B, 2026-01-02", "## B, 2026-01-02\n\nfigures 2\n");
        let third = merged(&second, "A, 2026-01-01", "## A, 2026-01-01\n\nfigures 3\n");
        assert!(first.starts_with(PREFACE));
        assert!(
            second.find("figures 2") < second.find("figures 1"),
            "{second}"
        );
        assert!(
            !third.contains("figures 1")
                && third.contains("figures 3")
                && third.contains("figures 2")
        );
        assert_eq!(third.matches(PREFACE).count(), 1);
        assert_eq!(
            merged(&third, "A, 2026-01-01", "## A, 2026-01-01\n\nfigures 3\n"),
            third
        );
    }

    /// What stands there instead of sections, as long as there are none.
    const NEVER: &str = "**None of this has run on graphics hardware yet.**\n";

    #[test]
    fn the_page_says_that_nothing_ran_until_something_did() {
        let page = fs::read_to_string(root().join("benchmarks/gpu.md")).expect("the page");
        assert!(
            page == format!("{PREFACE}\n{NEVER}")
                || page.contains("\n## ") && !page.contains(NEVER)
        );
        assert!(page.starts_with(PREFACE));
    }

    #[test]
    fn files_are_named_after_device_and_day() {
        assert_eq!(
            slug("NVIDIA H200, NVIDIA 570, 2026-11-27"),
            "nvidia-h200-nvidia-570-2026-11-27"
        );
    }

    #[test]
    fn figures_of_software_are_refused() {
        let folder = root().join("target/gpu-page");
        fs::create_dir_all(&folder).expect("a folder");
        let file = folder.join("result.json");
        Results::default().write(&folder).expect("written");
        let arguments = [file.display().to_string()];
        let error = run(arguments.into_iter()).expect_err("refused");
        assert!(
            error.to_string().contains("no graphics hardware"),
            "{error}"
        );
    }
}
