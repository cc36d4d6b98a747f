//! A generated mesh with its reports as bytes and back, for caches.

use neurotess_mesh::{ByteReader, ByteWriter, BytesError, CoarseMesh};

use crate::warning::CODES;
use crate::{FirstRing, Generated, SomaReport, Warning};

impl Generated {
    /// Appends all but [`soma_seconds`](Self::soma_seconds), which is of one run. False, and nothing is appended, if
    /// there are reports of smoothing or separation, which have no bytes.
    pub fn write_bytes(&self, to: &mut ByteWriter) -> bool {
        let Self {
            mesh,
            somata,
            rings,
            warnings,
            smoothing,
            separation,
            soma_seconds: _,
        } = self;
        if smoothing.is_some() || separation.is_some() {
            return false;
        }
        mesh.write_bytes(to);
        to.number(somata.len() as u64);
        for soma in somata {
            let SomaReport {
                volume,
                area,
                traced_volume,
                traced_area,
            } = *soma;
            let figures = [volume, area, traced_volume, traced_area];
            figures.into_iter().for_each(|x| to.f64(x));
        }
        to.number(rings.len() as u64);
        for ring in rings {
            to.number(ring.neurite.into());
            to.f64(ring.position);
            to.dvec3(ring.center);
            to.dvec3(ring.outwards);
            to.f64(ring.radius);
        }
        to.number(warnings.len() as u64);
        for warning in warnings {
            to.text(warning.code);
            to.number(warning.count as u64);
            to.number(warning.sample.is_some().into());
            to.difference(warning.sample.unwrap_or(0), 0);
            to.text(&warning.message);
        }
        true
    }

    /// Takes what [`write_bytes`](Self::write_bytes) appended; `soma_seconds` is 0.
    ///
    /// # Errors
    /// The bytes end early, or hold what cannot be.
    pub fn read_bytes(from: &mut ByteReader<'_>) -> Result<Self, BytesError> {
        let mesh = CoarseMesh::read_bytes(from)?;
        let somata = (0..from.count(32)?).map(|_| soma(from));
        let somata = somata.collect::<Result<_, _>>()?;
        let rings = (0..from.count(65)?).map(|_| ring(from));
        let rings = rings.collect::<Result<_, _>>()?;
        let warnings = (0..from.count(5)?).map(|_| warning(from));
        let warnings = warnings.collect::<Result<_, _>>()?;
        Ok(Self {
            mesh,
            somata,
            rings,
            warnings,
            ..Self::default()
        })
    }
}

fn soma(from: &mut ByteReader<'_>) -> Result<SomaReport, BytesError> {
    Ok(SomaReport {
        volume: from.f64()?,
        area: from.f64()?,
        traced_volume: from.f64()?,
        traced_area: from.f64()?,
    })
}

fn ring(from: &mut ByteReader<'_>) -> Result<FirstRing, BytesError> {
    let neurite = from.number()?;
    Ok(FirstRing {
        neurite: u32::try_from(neurite).map_err(|_| BytesError::Invalid("a neurite's number"))?,
        position: from.f64()?,
        center: from.dvec3()?,
        outwards: from.dvec3()?,
        radius: from.f64()?,
    })
}

fn warning(from: &mut ByteReader<'_>) -> Result<Warning, BytesError> {
    let code = from.text()?;
    let known = CODES.iter().find(|known| **known == code);
    let code = known.ok_or(BytesError::Invalid("an unknown warning"))?;
    let count = from.number()?;
    let with_sample = from.number()? > 0;
    let sample = from.difference(0)?;
    Ok(Warning {
        code,
        count: usize::try_from(count).map_err(|_| BytesError::Invalid("a count"))?,
        sample: with_sample.then_some(sample),
        message: from.text()?.to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use neurotess_morphology::{Morphology, NeuriteKind, Node};

    use super::*;
    use crate::{GenerateOptions, Smooth, generate};

    /// A soma with two neurites, one of which folds back so that there is something to mend.
    fn cell() -> Morphology {
        let node = |id, kind, position: [f64; 3], radius, parent| Node {
            id,
            kind,
            position: DVec3::from_array(position),
            radius,
            parent,
            section: None,
        };
        let axon = NeuriteKind::AXON;
        let nodes = [
            node(1, NeuriteKind::SOMA, [0.0, 0.0, 0.0], 5.0, None),
            node(2, axon, [0.0, 9.0, 0.0], 1.0, Some(0)),
            node(3, axon, [0.0, 30.0, 0.0], -1.0, Some(1)),
            node(4, axon, [0.5, 12.0, 0.0], 1.0, Some(2)),
            node(5, axon, [0.5, 12.0, 0.0], 1.0, Some(3)),
            node(6, NeuriteKind(7), [0.0, -9.0, 0.0], 0.8, Some(0)),
            node(7, NeuriteKind(7), [0.0, -40.0, 3.0], 0.3, Some(5)),
        ];
        let built = Morphology::from_nodes("cell", Vec::new(), &nodes);
        built.expect("a morphology").morphology
    }

    fn bytes(generated: &Generated) -> Vec<u8> {
        let mut writer = ByteWriter::default();
        assert!(generated.write_bytes(&mut writer));
        writer.into_bytes()
    }

    #[test]
    fn what_was_generated_comes_back_the_same() {
        let generated = generate(&cell(), &GenerateOptions::default()).expect("meshed");
        assert!(!generated.warnings.is_empty() && generated.rings.len() == 2);
        assert!(generated.warnings.iter().any(|w| w.sample.is_some()));
        let written = bytes(&generated);
        let mut reader = ByteReader::new(&written);
        let read = Generated::read_bytes(&mut reader).expect("there");
        assert_eq!(reader.end(), Ok(()));
        assert_eq!(read.mesh, generated.mesh);
        assert_eq!(
            (&read.somata, &read.rings),
            (&generated.somata, &generated.rings)
        );
        assert_eq!(read.warnings, generated.warnings);
        assert_eq!(bytes(&read), written);
    }

    #[test]
    fn bytes_that_end_early_are_an_error() {
        let written = bytes(&generate(&cell(), &GenerateOptions::default()).expect("meshed"));
        for length in (0..written.len())
            .step_by(37)
            .chain(written.len() - 400..written.len())
        {
            let read = Generated::read_bytes(&mut ByteReader::new(&written[..length]));
            assert_eq!(read.map(drop), Err(BytesError::Short), "{length}");
        }
    }

    #[test]
    fn reports_without_bytes_are_not_written() {
        let options = GenerateOptions {
            smooth: Smooth::Auto,
            ..GenerateOptions::default()
        };
        let smoothed = generate(&cell(), &options).expect("meshed");
        let mut writer = ByteWriter::default();
        assert!(!smoothed.write_bytes(&mut writer) && writer.into_bytes().is_empty());
    }
}
