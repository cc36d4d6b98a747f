//! The `info` of a folder.

use glam::{DMat3, DVec3};
use serde::Deserialize;

use super::broken;
use super::shards::Shards;
use crate::Fault;

/// What an `info` says of skeletons.
#[derive(Clone, Debug)]
pub(super) struct Info {
    /// From stored positions to nm.
    linear: DMat3,
    translation: DVec3,
    /// What each vertex has besides its position, in the order of the bytes.
    pub(super) attributes: Vec<Attribute>,
    /// How they are divided into files, if a file holds many.
    pub(super) shards: Option<Shards>,
}

/// A number, or several, of each vertex.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Attribute {
    pub(super) id: String,
    pub(super) data_type: DataType,
    pub(super) num_components: u32,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub(super) enum DataType {
    Float32,
    Int8,
    Uint8,
    Int16,
    Uint16,
    Int32,
    Uint32,
}

impl DataType {
    pub(super) fn bytes(self) -> usize {
        match self {
            Self::Float32 | Self::Int32 | Self::Uint32 => 4,
            Self::Int16 | Self::Uint16 => 2,
            Self::Int8 | Self::Uint8 => 1,
        }
    }

    /// A number of so many bytes.
    pub(super) fn number(self, bytes: &[u8]) -> f64 {
        let mut four = [0; 4];
        four[..bytes.len()].copy_from_slice(bytes);
        let whole = u32::from_le_bytes(four);
        match self {
            Self::Float32 => f64::from(f32::from_le_bytes(four)),
            Self::Int8 => f64::from(whole as i8),
            Self::Int16 => f64::from(whole as i16),
            Self::Int32 => f64::from(whole as i32),
            Self::Uint8 | Self::Uint16 | Self::Uint32 => f64::from(whole),
        }
    }
}

#[derive(Deserialize)]
struct File {
    #[serde(rename = "@type", default)]
    kind: String,
    skeletons: Option<String>,
    transform: Option<Vec<f64>>,
    #[serde(default)]
    vertex_attributes: Vec<Attribute>,
    sharding: Option<Shards>,
}

/// The folder, within that of a segmentation, where its skeletons are.
pub(super) fn folder_of_skeletons(text: &str) -> Option<String> {
    let file: File = serde_json::from_str(text).ok()?;
    file.skeletons.filter(|_| file.kind != KIND)
}

const KIND: &str = "neuroglancer_skeletons";

impl Info {
    /// What the text of an `info` says; none if it is of something else.
    pub(super) fn parse(text: &str) -> Result<Option<Self>, Fault> {
        let kind: Kind = match serde_json::from_str(text) {
            Ok(kind) => kind,
            Err(_) => return Ok(None),
        };
        if kind.kind != KIND {
            return Ok(None);
        }
        let file: File = serde_json::from_str(text).map_err(|e| broken(e.to_string()))?;
        let transform = file.transform.unwrap_or_else(|| IDENTITY.into());
        let Ok(rows) = <[f64; 12]>::try_from(transform) else {
            return Err(broken("its transform has no twelve numbers"));
        };
        let of = |column: usize| DVec3::new(rows[column], rows[4 + column], rows[8 + column]);
        if let Some(shards) = &file.sharding {
            shards.check()?;
        }
        Ok(Some(Self {
            linear: DMat3::from_cols(of(0), of(1), of(2)),
            translation: of(3),
            attributes: file.vertex_attributes,
            shards: file.sharding,
        }))
    }

    /// Where a stored position is (nm).
    pub(super) fn place(&self, stored: DVec3) -> DVec3 {
        self.linear * stored + self.translation
    }

    /// Whether stored positions have another unit than nm.
    pub(super) fn scales(&self) -> bool {
        self.linear != DMat3::IDENTITY
    }
}

#[derive(Deserialize)]
struct Kind {
    #[serde(rename = "@type", default)]
    kind: String,
}

const IDENTITY: [f64; 12] = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0.];
