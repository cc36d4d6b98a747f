//! Reads and meshes one tracing.

use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::time::{Instant, SystemTime};

use neurotess::cache::Cache;
use neurotess::formats::{self, ReadOptions};
use neurotess::generate::generate_watched;
use neurotess::mesh::Watch;
use neurotess::morphology::{Measures, Morphology, shape};
use neurotess::synth::{self, Kind};

use crate::model::document::SomaEdit;
use crate::model::sources::{Remark, SAMPLE, SectionFacts, Source, Stale, spheres, thickest};

/// Reads a file, or grows a sample, and meshes it. `cache`: that of the circuit that it belongs to.
///
/// # Errors
/// A message that says what is wrong and what to do.
pub(crate) fn load(file: &Path, soma: SomaEdit, cache: Option<&Cache>) -> Result<Source, String> {
    let name = file.to_string_lossy();
    if let Some(kind) = name.strip_prefix(SAMPLE) {
        let kind: Kind = kind.parse().map_err(|e| format!("{e}"))?;
        let morphology = synth::grow(&synth::Options::sample(kind));
        let content = (morphology, Vec::new(), None);
        return source(file, kind.to_string(), content, soma, None);
    }
    let written = fs::metadata(file).and_then(|m| m.modified()).ok();
    let read = formats::read(file, &ReadOptions::default()).map_err(|e| reason(&name, &e))?;
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let warnings = read.warnings.iter().map(|w| {
        let line = w
            .line
            .map_or(String::new(), |line| format!("line {line}: "));
        Remark::new(w.code, format!("{line}{}", w.message))
    });
    let warnings = warnings.collect();
    let made = source(
        file,
        stem.into_owned(),
        (read.morphology, warnings, written),
        soma,
        cache,
    )?;
    if made.generated.mesh.patches.is_empty() {
        return Err("nothing in it to mesh: check the file".into());
    }
    Ok(made)
}

/// The reason without the file's name, which the window shows beside it.
fn reason(file: &str, error: &formats::ReadError) -> String {
    let text = error.to_string();
    let rest = text.strip_prefix(file).unwrap_or(&text);
    rest.trim_start_matches([':', ' ']).to_owned()
}

/// The source of a tracing, still without the spines that `soma` asks for.
fn source(
    file: &Path,
    name: String,
    (morphology, mut warnings, written): (Morphology, Vec<Remark>, Option<SystemTime>),
    soma: SomaEdit,
    cache: Option<&Cache>,
) -> Result<Source, String> {
    let clock = Instant::now();
    let seconds = || clock.elapsed().as_secs_f64();
    let options = soma.options();
    let watch = Watch::default().with_clock(&seconds);
    let generate = || generate_watched(&morphology, &options, &watch);
    let (generated, proxy) = match cache {
        Some(cache) => {
            let meshed = cache.mesh(&morphology, &options, generate);
            let (generated, key) = meshed.map_err(|e| e.to_string())?;
            let proxy = cache.proxy(&key, &generated.mesh);
            (generated, Some(Arc::new(proxy)))
        }
        None => (generate().map_err(|e| e.to_string())?, None),
    };
    let made = generated.warnings.iter();
    warnings.extend(made.map(|w| Remark::new(w.code, w.to_string())));
    let (all, few_spheres) = spheres(&generated.mesh);
    let morphology = Arc::new(morphology);
    Ok(Source {
        file: file.to_path_buf(),
        name,
        measures: Arc::new(Measures::of(&morphology)),
        sections: Arc::new(section_facts(&morphology)),
        spheres: all,
        few_spheres,
        thickest: thickest(&generated.mesh),
        morphology: Arc::clone(&morphology),
        traced: morphology,
        spines: None,
        generated: Arc::new(generated),
        proxy,
        soma,
        warnings,
        written,
        stale: None,
    })
}

pub(crate) fn section_facts(morphology: &Morphology) -> Vec<SectionFacts> {
    let lengths = shape::section_lengths(morphology);
    let orders = shape::branch_orders(morphology);
    let paths = shape::path_lengths(morphology);
    let neurites = shape::neurites(morphology);
    let facts = |i: usize| SectionFacts {
        length: lengths[i],
        order: orders[i],
        path: paths[i],
        neurite: neurites[i],
    };
    (0..neurites.len()).map(facts).collect()
}

/// Whether a source's file was changed or removed since it was read.
pub(crate) fn stale(file: &Path, written: Option<SystemTime>) -> Option<Stale> {
    let written = written?;
    match fs::metadata(file).and_then(|m| m.modified()) {
        Ok(now) if now == written => None,
        Ok(_) => Some(Stale::Changed),
        Err(_) => Some(Stale::Gone),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::sources::sample;

    #[test]
    fn samples_are_grown_and_missing_files_have_a_reason() {
        let star = load(&sample(Kind::Star), SomaEdit::default(), None).expect("grown");
        assert!(star.measures.n_sections > 10 && !star.spheres.is_empty());
        assert_eq!(star.sections.len(), star.measures.n_sections);
        let error =
            load(Path::new("not/there.swc"), SomaEdit::default(), None).expect_err("missing");
        assert!(!error.contains("there.swc") && error.len() > 5, "{error}");
        assert!(load(Path::new("sample:nothing"), SomaEdit::default(), None).is_err());
    }

    #[test]
    fn a_changed_file_is_noticed() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("a.swc");
        fs::write(&file, "1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n3 3 0 30 0 1 2\n").expect("written");
        let source = load(&file, SomaEdit::default(), None).expect("read");
        assert_eq!(stale(&file, source.written), None);
        let later = SystemTime::now() + std::time::Duration::from_secs(5);
        fs::File::options()
            .write(true)
            .open(&file)
            .and_then(|f| f.set_modified(later))
            .expect("touched");
        assert_eq!(stale(&file, source.written), Some(Stale::Changed));
        fs::remove_file(&file).expect("removed");
        assert_eq!(stale(&file, source.written), Some(Stale::Gone));
    }
}
