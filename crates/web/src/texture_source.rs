//! WebGL has no storage buffers: there the packed mesh is a texture.

/// Numbers in a row of the texture. Twin of `WORDS_IN_ROW` in webgl.js.
const IN_ROW_BITS: u32 = 10;
const BUFFER: &str = "@group(0) @binding(0) var<storage, read> packed: array<u32>;";

/// The shader with its packed buffer in a texture: `packed[…]` becomes `packed_at(…)`.
pub(crate) fn packed_in_texture(text: &str) -> String {
    let mask = (1 << IN_ROW_BITS) - 1;
    let texture = format!(
        "@group(0) @binding(0) var packed_texels: texture_2d<u32>;
fn packed_at(at: u32) -> u32 {{
    return textureLoad(packed_texels, vec2<u32>(at & {mask}u, at >> {IN_ROW_BITS}u), 0).x;
}}"
    );
    read_from_texture(&text.replace(BUFFER, &texture))
}

fn read_from_texture(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find("packed[") {
        let (before, from) = rest.split_at(at + "packed".len());
        out.push_str(before);
        let end = end_of_index(from);
        out.push_str("_at(");
        // An index may have others within.
        out.push_str(&read_from_texture(&from[1..end]));
        out.push(')');
        rest = &from[end + 1..];
    }
    out.push_str(rest);
    out
}

/// Where the bracket is that closes the first one.
fn end_of_index(text: &str) -> usize {
    let mut depth = 0;
    for (at, sign) in text.char_indices() {
        match sign {
            '[' => depth += 1,
            ']' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return at;
        }
    }
    text.len() - 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_of_the_buffer_are_reads_of_the_texture() {
        let text =
            format!("{BUFFER}\nlet a = packed[b.c + f[1] + packed[3]];\nlet packed = packed[2];");
        let made = packed_in_texture(&text);
        assert!(!made.contains("packed["), "{made}");
        assert!(
            made.contains("let a = packed_at(b.c + f[1] + packed_at(3));"),
            "{made}"
        );
        assert!(made.contains("let packed = packed_at(2);"), "{made}");
    }
}
