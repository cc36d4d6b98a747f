//! What an entry is found by: a hash of everything that its content follows from.

use neurotess_generate::GenerateOptions;
use neurotess_mesh::ByteWriter;
use neurotess_morphology::{Attachment, Morphology, Section, Soma, SomaSample};

/// Version, sources and machine: another program's floating-point numbers may differ in their last bits.
const PROGRAM: &str = concat!(env!("CARGO_PKG_VERSION"), " ", env!("NEUROTESS_SOURCES"));

/// The key of an entry. Another tracing, other options and another version have other keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Key(pub(crate) [u8; 32]);

impl Key {
    /// The key of a tracing's coarse mesh. It follows from the traced points, not from the file: a comment may
    /// change, and points that a report's compartments add make another key.
    pub fn of_mesh(morphology: &Morphology, options: &GenerateOptions) -> Self {
        let mut bytes = ByteWriter::default();
        bytes.text(PROGRAM);
        bytes.text(std::env::consts::ARCH);
        bytes.text(std::env::consts::OS);
        // All fields, in a form that is the same for equal options only.
        bytes.text(&format!("{options:?}"));
        write_morphology(morphology, &mut bytes);
        Self(blake3::hash(&bytes.into_bytes()).into())
    }

    /// The key of what follows from this entry alone.
    pub fn derived(&self, what: &str) -> Self {
        let mut hasher = blake3::Hasher::new();
        hasher.update(&self.0).update(what.as_bytes());
        Self(hasher.finalize().into())
    }
}

/// Everything that a mesh follows from, each part with its length.
fn write_morphology(morphology: &Morphology, to: &mut ByteWriter) {
    let Morphology {
        name: _,
        origin,
        somata,
        points,
        sample_ids,
        sections,
        file_sections: _,
        header: _,
        spines: _,
    } = morphology;
    to.dvec3(*origin);
    to.number(somata.len() as u64);
    somata.iter().for_each(|soma| write_soma(soma, to));
    to.number(points.len() as u64);
    for point in points {
        to.vec3(point.position);
        to.f32(point.radius);
    }
    to.number(sample_ids.len() as u64);
    sample_ids.iter().for_each(|&id| to.difference(id, 0));
    to.number(sections.len() as u64);
    sections
        .iter()
        .for_each(|section| write_section(section, to));
}

fn write_soma(soma: &Soma, to: &mut ByteWriter) {
    let Soma {
        kind,
        samples,
        center,
        radius,
    } = soma;
    to.text(kind.name());
    to.vec3(*center);
    to.f32(*radius);
    to.number(samples.len() as u64);
    for sample in samples {
        let SomaSample {
            id,
            position,
            radius,
            parent,
        } = *sample;
        to.difference(id, 0);
        to.vec3(position);
        to.f32(radius);
        to.number(parent.map_or(0, |parent| u64::from(parent) + 1));
    }
}

fn write_section(section: &Section, to: &mut ByteWriter) {
    let Section {
        kind,
        attachment,
        first,
        end,
    } = *section;
    to.difference(kind.0.into(), 0);
    let [what, a, b] = match attachment {
        Attachment::Free => [0, 0, 0],
        Attachment::Section(id) => [1, id.0, 0],
        Attachment::Soma { soma, sample } => [2, soma, sample],
    };
    let numbers = [what, a, b, first, end];
    numbers
        .into_iter()
        .for_each(|number| to.number(number.into()));
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};
    use neurotess_generate::{
        Crossings, Equal, Polygons, Sides, Smooth, SomaKeep, SomaMethod, SphereKind,
    };
    use neurotess_morphology::NeuriteKind;

    use super::*;

    fn cell() -> Morphology {
        let options = neurotess_synth::Options::sample(neurotess_synth::Kind::Star);
        neurotess_synth::grow(&options)
    }

    #[test]
    fn equal_content_has_one_key_whatever_its_name() {
        let (usual, options) = (cell(), GenerateOptions::default());
        let mut renamed = usual.clone();
        renamed.name = "another".into();
        renamed.header.push("a comment".into());
        let key = Key::of_mesh(&usual, &options);
        assert_eq!(key, Key::of_mesh(&renamed, &options));
        assert_ne!(key, key.derived("proxy"));
        assert_ne!(key.derived("a"), key.derived("b"));
    }

    #[test]
    fn any_change_of_the_tracing_is_another_key() {
        let changes: [fn(&mut Morphology); 14] = [
            |_| {},
            |m| m.origin = DVec3::X,
            |m| m.points[3].position += Vec3::X * 1e-3,
            |m| m.points[3].radius *= 1.001,
            |m| m.sample_ids[2] += 1,
            |m| m.sections[1].kind = NeuriteKind(9),
            |m| m.sections[0].attachment = Attachment::Free,
            |m| m.sections[0].end += 1,
            |m| m.sections.truncate(2),
            |m| m.points.truncate(20),
            |m| m.somata.clear(),
            |m| m.somata[0].radius += 0.1,
            |m| m.somata[0].samples[0].id += 1,
            |m| m.somata[0].samples[0].parent = Some(0),
        ];
        all_differ(&changes.map(|change| {
            let mut changed = cell();
            change(&mut changed);
            Key::of_mesh(&changed, &GenerateOptions::default())
        }));
    }

    #[test]
    fn any_other_option_is_another_key() {
        let changes: [fn(&mut GenerateOptions); 16] = [
            |_| {},
            |o| o.soma = SomaMethod::Sphere,
            |o| o.poisson = 0.31,
            |o| o.soma_keep = SomaKeep::Area,
            |o| {
                let sphere = neurotess_morphology::SomaShape::sphere(DVec3::X, 2.0);
                o.soma_shape = Some(sphere.into());
            },
            |o| o.soma_scale = 1.1,
            |o| o.radius_factor = 2.0,
            |o| {
                o.polygons = Some(Polygons {
                    sides: Sides::Level(2),
                    equal: Equal::Area,
                });
            },
            |o| o.sphere = SphereKind::Octahedron,
            |o| o.sphere_level = Some(4),
            |o| {
                o.rings.insert(0, 0.5);
            },
            |o| {
                o.rings.insert(1, 0.5);
            },
            |o| o.kinds = Some(vec![NeuriteKind::AXON]),
            |o| o.kinds = Some(Vec::new()),
            |o| o.crossings = Crossings::Separate,
            |o| o.smooth = Smooth::Length(2.0),
        ];
        all_differ(&changes.map(|change| {
            let mut options = GenerateOptions::default();
            change(&mut options);
            Key::of_mesh(&cell(), &options)
        }));
    }

    fn all_differ(keys: &[Key]) {
        let distinct: std::collections::BTreeSet<_> = keys.iter().collect();
        assert_eq!(distinct.len(), keys.len());
    }
}
