//! A proxy as bytes and back, for caches: the same bits, and every index in range.

use bytemuck::Zeroable;
use neurotess_mesh::{ByteReader, ByteWriter, BytesError};

use super::layout::{CHUNK_ONE_COLOR_KEY, CHUNK_SOMA, Chunk, LEVELS, MAX_SEGMENTS, NO_LOD};
use super::proxy::Proxy;

impl Proxy {
    /// Appends all but the color keys, in this machine's order of bytes.
    pub fn write_bytes(&self, to: &mut ByteWriter) {
        to.dvec3(self.origin);
        to.vec3(self.center);
        to.f32(self.reach);
        to.number(self.points as u64);
        to.number(self.packed.len() as u64);
        to.raw(bytemuck::cast_slice(&self.packed));
        to.number(self.chunks.len() as u64);
        for (chunk, colors) in self.chunks.iter().zip(&self.colors) {
            let colorless = Chunk {
                flags: chunk.flags & !CHUNK_ONE_COLOR_KEY,
                color_keys: 0,
                ..*chunk
            };
            to.raw(bytemuck::bytes_of(&colorless));
            to.number(colors.len() as u64);
            let mut before = 0;
            for &color in colors {
                to.difference(color.into(), before);
                before = color.into();
            }
        }
    }

    /// Takes off bytes what [`write_bytes`](Self::write_bytes) appended, with all color keys 0: it equals
    /// `Proxy::new(mesh, &[])`. `tracing_points`: how many the mesh has.
    ///
    /// # Errors
    /// The bytes end early, or hold what no proxy of such a mesh has.
    pub fn read_bytes(
        from: &mut ByteReader<'_>,
        tracing_points: usize,
    ) -> Result<Self, BytesError> {
        let (origin, center) = (from.dvec3()?, from.vec3()?);
        let reach = from.f32()?;
        let points = usize::try_from(from.number()?).unwrap_or(usize::MAX);
        let count = from.count(size_of::<u32>())?;
        let mut packed = vec![0_u32; count];
        let bytes = from.raw(size_of_val(&*packed))?;
        bytemuck::cast_slice_mut::<u32, u8>(&mut packed).copy_from_slice(bytes);
        let count = from.count(size_of::<Chunk>())?;
        let mut proxy = Self {
            origin,
            packed,
            center,
            reach,
            points,
            ..Self::default()
        };
        proxy.chunks.reserve(count);
        proxy.colors.reserve(count);
        for _ in 0..count {
            let mut chunk = Chunk::zeroed();
            bytemuck::bytes_of_mut(&mut chunk).copy_from_slice(from.raw(size_of::<Chunk>())?);
            let points = check(&chunk, &proxy.packed)?;
            let colors = colors(from, tracing_points)?;
            if colors.len() != points {
                return Err(BytesError::Invalid(
                    "a chunk without a color for each point",
                ));
            }
            proxy.push(chunk, colors);
        }
        proxy.set_color_keys(&[]);
        Ok(proxy)
    }
}

/// The tracing points that color a chunk.
fn colors(from: &mut ByteReader<'_>, tracing_points: usize) -> Result<Vec<u32>, BytesError> {
    let count = from.count(1)?;
    let mut before = 0;
    let color = |_| {
        before = from.difference(before)?;
        let point = u32::try_from(before).ok();
        let point = point.filter(|&point| (point as usize) < tracing_points);
        point.ok_or(BytesError::Invalid("a tracing point that is not there"))
    };
    (0..count).map(color).collect()
}

/// How many color keys a chunk has, if all that it points to is there.
fn check(chunk: &Chunk, packed: &[u32]) -> Result<usize, BytesError> {
    let own = packed.get(chunk.first as usize..);
    let own = own.ok_or(BytesError::Invalid("a chunk beyond the points"))?;
    match chunk.flags & CHUNK_SOMA {
        0 => check_tube(chunk, own),
        _ => check_soma(chunk, own),
    }
}

fn check_tube(chunk: &Chunk, own: &[u32]) -> Result<usize, BytesError> {
    let counts: &[u8] = bytemuck::bytes_of(&chunk.counts);
    let errors: &[u8] = bytemuck::bytes_of(&chunk.errors);
    let segments = usize::from(counts[0]);
    if !(1..=MAX_SEGMENTS).contains(&segments) {
        return Err(BytesError::Invalid("a chunk of too many segments"));
    }
    let lods = (1..LEVELS).filter(|&k| errors[k] != NO_LOD);
    let kept: usize = lods.map(|k| usize::from(counts[k]) + 1).sum();
    let lists = own.get(2 * (segments + 1)..);
    let lists: &[u8] = bytemuck::cast_slice(lists.unwrap_or_default());
    match lists.get(..kept) {
        Some(kept) if kept.iter().all(|&point| usize::from(point) <= segments) => Ok(segments + 1),
        _ => Err(BytesError::Invalid("a polyline beyond its points")),
    }
}

fn check_soma(chunk: &Chunk, own: &[u32]) -> Result<usize, BytesError> {
    let [quads, vertices] = chunk.counts.map(|count| count as usize);
    let corners = own.get(2 * vertices..).unwrap_or_default();
    let corners = corners.get(..2 * quads);
    let within = |&two: &u32| {
        [two & 0xffff, two >> 16]
            .iter()
            .all(|&v| (v as usize) < vertices)
    };
    match corners {
        // One that is too large to be kept as a mesh has no quads.
        Some(corners) if corners.iter().all(within) => Ok(1),
        _ => Err(BytesError::Invalid("a soma beyond its vertices")),
    }
}

#[cfg(test)]
mod tests {
    use neurotess_formats::{ReadOptions, swc};
    use neurotess_generate::{GenerateOptions, generate};
    use neurotess_mesh::CoarseMesh;

    use super::*;

    /// A soma with a fork on one side and a tube of a hundred points on the other.
    fn mesh() -> CoarseMesh {
        let mut text =
            String::from("1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n3 3 5 30 0 1 2\n4 3 9 50 3 .5 3\n");
        text.push_str("5 3 -9 48 -3 .5 3\n6 2 0 -9 0 .8 1\n");
        for i in 7..107 {
            let (x, y) = (f64::from(i % 7), -9.0 - 4.0 * f64::from(i - 6));
            text.push_str(&format!("{i} 2 {x} {y} 0 .6 {}\n", i - 1));
        }
        let read = swc::read_bytes(text.as_bytes(), "cell.swc", &ReadOptions::default());
        let morphology = read.expect("a morphology").morphology;
        let generated = generate(&morphology, &GenerateOptions::default());
        generated.expect("meshed").mesh
    }

    fn bytes(proxy: &Proxy) -> Vec<u8> {
        let mut writer = ByteWriter::default();
        proxy.write_bytes(&mut writer);
        writer.into_bytes()
    }

    /// What is drawn of both is the same.
    fn assert_same(a: &Proxy, b: &Proxy) {
        assert_eq!(a.chunks, b.chunks);
        assert_eq!(a.packed, b.packed);
        assert_eq!(a.color_keys, b.color_keys);
        assert_eq!(a.colors, b.colors);
        assert_eq!(a.points, b.points);
    }

    #[test]
    fn a_proxy_comes_back_and_takes_any_colors() {
        let mesh = mesh();
        let keys: Vec<u32> = (0..mesh.tracing.len() as u32).map(|i| i / 9).collect();
        let colored = Proxy::new(&mesh, &keys);
        assert!(colored.chunks.len() > 4);
        let written = bytes(&colored);
        let mut reader = ByteReader::new(&written);
        let mut read = Proxy::read_bytes(&mut reader, mesh.tracing.len()).expect("a proxy");
        assert_eq!(reader.end(), Ok(()));
        assert_same(&read, &Proxy::new(&mesh, &[]));
        assert_eq!(read.sphere(), colored.sphere());
        read.set_color_keys(&keys);
        assert_same(&read, &colored);
        assert_eq!(bytes(&read), written, "whatever its colors");
    }

    #[test]
    fn bytes_that_end_early_are_an_error() {
        let mesh = mesh();
        let written = bytes(&Proxy::new(&mesh, &[]));
        for length in 0..written.len() {
            let mut reader = ByteReader::new(&written[..length]);
            let read = Proxy::read_bytes(&mut reader, mesh.tracing.len());
            assert_eq!(read.map(drop), Err(BytesError::Short), "{length}");
        }
    }

    #[test]
    fn what_points_beyond_its_content_is_refused() {
        let mesh = mesh();
        let proxy = Proxy::new(&mesh, &[]);
        let tube = proxy.chunks.len() - 1;
        let refused = |change: &dyn Fn(&mut Proxy)| {
            let mut changed = proxy.clone();
            change(&mut changed);
            let written = bytes(&changed);
            let read = Proxy::read_bytes(&mut ByteReader::new(&written), mesh.tracing.len());
            matches!(read, Err(BytesError::Invalid(_)))
        };
        assert!(!refused(&|_| {}));
        assert!(refused(&|p| p.chunks[tube].first = u32::MAX));
        assert!(refused(&|p| p.chunks[tube].counts[0] |= 0xff));
        assert!(refused(&|p| p.chunks[tube].counts[0] += 0x0001));
        assert!(refused(&|p| p.chunks[0].counts[1] = 3));
        assert!(refused(&|p| p.chunks[0].counts[0] = u32::MAX / 4));
        assert!(refused(&|p| p.colors[tube][0] = mesh.tracing.len() as u32));
        assert!(refused(&|p| p.packed.truncate(9)));
    }
}
