//! A cell as bytes, for pickling: between processes of one version, not for files.

use glam::{DVec3, Vec3};
use neurotess::morphology::{
    Attachment, FileSection, FileSections, Morphology, NeuriteKind, Point, Section, SectionId,
    Soma, SomaKind, SomaSample,
};

use super::Told;

/// Changes with what follows.
const VERSION: u64 = 3;

/// What [`from_bytes`] gives back.
pub(super) fn to_bytes(cell: &Morphology, format: &str, warnings: &[Told]) -> Vec<u8> {
    let mut out = Out(Vec::with_capacity(64 + 24 * cell.points.len()));
    out.integer(VERSION as i64);
    out.text(format);
    out.text(&cell.name);
    out.all(&cell.header, |out, line| out.text(line));
    out.all(&cell.origin.to_array(), |out, &number| out.real(number));
    out.all(&cell.somata, |out, soma| {
        out.integer(match soma.kind {
            SomaKind::Point => 0,
            SomaKind::ThreePoint => 1,
            SomaKind::Contour => 2,
            SomaKind::Cylinders => 3,
            SomaKind::Surface => 4,
        });
        out.ball(soma.center, soma.radius);
        out.all(&soma.samples, |out, sample| {
            out.integer(sample.id);
            out.ball(sample.position, sample.radius);
            out.integer(sample.parent.map_or(-1, i64::from));
        });
    });
    out.all(&cell.points, |out, p| out.ball(p.position, p.radius));
    out.all(&cell.sample_ids, |out, &id| out.integer(id));
    out.all(&cell.sections, |out, section| {
        let (kind, a, b) = match section.attachment {
            Attachment::Free => (0, 0, 0),
            Attachment::Section(SectionId(parent)) => (1, parent, 0),
            Attachment::Soma { soma, sample } => (2, soma, sample),
        };
        for number in [kind, a, b, section.first, section.end] {
            out.integer(i64::from(number));
        }
        out.integer(i64::from(section.kind.0));
    });
    let of_file = &cell.file_sections;
    out.integer(i64::from(of_file.told));
    out.all(&of_file.of_points, |out, &index| {
        out.integer(i64::from(index));
    });
    out.all(&of_file.sections, |out, section| {
        out.integer(i64::from(section.kind.0));
        out.integer(section.parent.map_or(-1, i64::from));
        out.integer(i64::from(section.empty));
    });
    out.all(&cell.spines, |out, &spine| out.ball(spine, 0.0));
    out.all(warnings, |out, told| {
        out.text(&told.code);
        out.text(&told.message);
        out.integer(told.line.map_or(-1, |line| line as i64));
        out.integer(told.count as i64);
    });
    out.0
}

/// The cell, if these bytes are one.
pub(super) fn from_bytes(bytes: &[u8]) -> Option<(Morphology, String, Vec<Told>)> {
    let mut from = From(bytes);
    if from.integer()? != VERSION as i64 {
        return None;
    }
    let format = from.text()?;
    let cell = Morphology {
        name: from.text()?,
        header: from.all(From::text)?,
        origin: DVec3::from_slice(from.all(From::real)?.get(..3)?),
        somata: from.all(soma)?,
        points: from.all(|from| {
            let (position, radius) = from.ball()?;
            Some(Point { position, radius })
        })?,
        sample_ids: from.all(From::integer)?,
        sections: from.all(section)?,
        file_sections: file_sections(&mut from)?,
        spines: from.all(|from| Some(from.ball()?.0))?,
    };
    let warnings = from.all(|from| {
        Some(Told {
            code: from.text()?,
            message: from.text()?,
            line: u64::try_from(from.integer()?).ok(),
            count: from.integer()?.try_into().ok()?,
        })
    })?;
    (from.0.is_empty() && holds(&cell)).then_some((cell, format, warnings))
}

fn soma(from: &mut From<'_>) -> Option<Soma> {
    let kind = match from.integer()? {
        0 => SomaKind::Point,
        1 => SomaKind::ThreePoint,
        2 => SomaKind::Contour,
        3 => SomaKind::Cylinders,
        4 => SomaKind::Surface,
        _ => return None,
    };
    let (center, radius) = from.ball()?;
    let samples = from.all(|from| {
        let id = from.integer()?;
        let (position, radius) = from.ball()?;
        Some(SomaSample {
            id,
            position,
            radius,
            parent: u32::try_from(from.integer()?).ok(),
        })
    })?;
    Some(Soma {
        kind,
        samples,
        center,
        radius,
    })
}

fn section(from: &mut From<'_>) -> Option<Section> {
    let mut number = || u32::try_from(from.integer()?).ok();
    let (kind, a, b) = (number()?, number()?, number()?);
    let (first, end) = (number()?, number()?);
    Some(Section {
        attachment: match kind {
            0 => Attachment::Free,
            1 => Attachment::Section(SectionId(a)),
            2 => Attachment::Soma { soma: a, sample: b },
            _ => return None,
        },
        first,
        end,
        kind: NeuriteKind(from.integer()?.try_into().ok()?),
    })
}

fn file_sections(from: &mut From<'_>) -> Option<FileSections> {
    Some(FileSections {
        told: from.integer()? == 1,
        of_points: from.all(|from| u32::try_from(from.integer()?).ok())?,
        sections: from.all(|from| {
            Some(FileSection {
                kind: NeuriteKind(from.integer()?.try_into().ok()?),
                parent: u32::try_from(from.integer()?).ok(),
                empty: from.integer()? == 1,
            })
        })?,
    })
}

/// Whether all indices are within the arrays, and sections follow one another.
fn holds(cell: &Morphology) -> bool {
    let mut at = 0;
    let attached = |index: usize, attachment: Attachment| match attachment {
        Attachment::Free => true,
        Attachment::Section(parent) => parent.index() < index,
        Attachment::Soma { soma, sample } => cell
            .somata
            .get(soma as usize)
            .is_some_and(|soma| (sample as usize) < soma.samples.len()),
    };
    let sections = cell.sections.iter().enumerate().all(|(index, section)| {
        let follows = section.first == at && section.end > at;
        at = section.end;
        follows && attached(index, section.attachment)
    });
    let samples = |soma: &Soma| {
        let count = soma.samples.len();
        let mut parents = soma.samples.iter().filter_map(|sample| sample.parent);
        parents.all(|parent| (parent as usize) < count)
    };
    let of_file = &cell.file_sections;
    let in_file = |&index: &u32| (index as usize) < of_file.sections.len();
    sections
        && of_file.of_points.len() == cell.points.len()
        && of_file.of_points.iter().all(in_file)
        && at as usize == cell.points.len()
        && cell.sample_ids.len() == cell.points.len()
        && cell.somata.iter().all(samples)
}

struct Out(Vec<u8>);

impl Out {
    fn integer(&mut self, value: i64) {
        self.0.extend(value.to_le_bytes());
    }

    fn real(&mut self, value: f64) {
        self.0.extend(value.to_le_bytes());
    }

    fn ball(&mut self, center: Vec3, radius: f32) {
        for value in [center.x, center.y, center.z, radius] {
            self.0.extend(value.to_le_bytes());
        }
    }

    fn text(&mut self, text: &str) {
        self.integer(text.len() as i64);
        self.0.extend(text.as_bytes());
    }

    fn all<T>(&mut self, items: &[T], one: impl Fn(&mut Self, &T)) {
        self.integer(items.len() as i64);
        items.iter().for_each(|item| one(self, item));
    }
}

struct From<'a>(&'a [u8]);

impl From<'_> {
    fn bytes<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (bytes, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*bytes)
    }

    fn integer(&mut self) -> Option<i64> {
        self.bytes().map(i64::from_le_bytes)
    }

    fn real(&mut self) -> Option<f64> {
        self.bytes().map(f64::from_le_bytes)
    }

    fn ball(&mut self) -> Option<(Vec3, f32)> {
        let mut number = || self.bytes().map(f32::from_le_bytes);
        let center = Vec3::new(number()?, number()?, number()?);
        Some((center, number()?))
    }

    fn text(&mut self) -> Option<String> {
        let length = usize::try_from(self.integer()?).ok()?;
        let (text, rest) = self.0.split_at_checked(length)?;
        self.0 = rest;
        String::from_utf8(text.to_vec()).ok()
    }

    fn all<T>(&mut self, one: impl Fn(&mut Self) -> Option<T>) -> Option<Vec<T>> {
        let count = usize::try_from(self.integer()?).ok()?;
        // Every item has bytes: no more items than bytes.
        (count <= self.0.len()).then_some(())?;
        (0..count).map(|_| one(self)).collect()
    }
}
