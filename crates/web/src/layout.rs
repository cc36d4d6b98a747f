//! Where the fields of a shader's struct are, so that the host writes them by their names.

use naga::{Handle, Module, ScalarKind, Type, TypeInner};
use neurotess_refine::wgsl::Shader;
use serde::Serialize;

use crate::error::WebError;

/// Bytes of a struct, and its fields.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Layout {
    size: u32,
    /// Name, offset in bytes, and `f`, `u` or `i`. Fields of inner structs are named `outer.inner`.
    fields: Vec<(String, u32, char)>,
}

/// The layout of a struct of a shader.
pub(crate) fn layout(shader: &Shader, name: &str) -> Result<Layout, WebError> {
    let module = naga::front::wgsl::parse_str(&shader.text);
    let module = module.map_err(|e| WebError::Shader(shader.explain(&e.to_string())))?;
    let mut types = module.types.iter();
    let found = types.find(|(_, ty)| ty.name.as_deref() == Some(name));
    let (handle, _) = found.ok_or_else(|| WebError::Shader(format!("no struct {name}")))?;
    let mut fields = Vec::new();
    let size = add_fields(&module, handle, "", 0, &mut fields);
    Ok(Layout { size, fields })
}

/// Adds the fields of a struct that begins at an offset. Returns its size.
fn add_fields(
    module: &Module,
    ty: Handle<Type>,
    before: &str,
    start: u32,
    fields: &mut Vec<(String, u32, char)>,
) -> u32 {
    let TypeInner::Struct { members, span } = &module.types[ty].inner else {
        return 0;
    };
    for member in members {
        let name = format!("{before}{}", member.name.as_deref().unwrap_or_default());
        let at = start + member.offset;
        match kind_of(module, member.ty) {
            Some(kind) => fields.push((name, at, kind)),
            None => {
                add_fields(module, member.ty, &format!("{name}."), at, fields);
            }
        }
    }
    *span
}

/// What a scalar, vector, matrix or array consists of; none for structs.
fn kind_of(module: &Module, ty: Handle<Type>) -> Option<char> {
    let scalar = match module.types[ty].inner {
        TypeInner::Scalar(scalar)
        | TypeInner::Vector { scalar, .. }
        | TypeInner::Matrix { scalar, .. } => scalar,
        TypeInner::Array { base, .. } => return kind_of(module, base),
        _ => return None,
    };
    Some(match scalar.kind {
        ScalarKind::Sint => 'i',
        ScalarKind::Uint => 'u',
        _ => 'f',
    })
}
