//! What all readers of text ask first: is this text at all, and what is the cell called?

use std::path::Path;

use crate::Fault;
use crate::packed::unpacked_name;

/// A fault and its line, before it is known which file this is.
pub(crate) type Located<T> = Result<T, (u64, Fault)>;

/// Byte-order mark of UTF-8.
pub(crate) const BOM: &[u8] = b"\xef\xbb\xbf";

/// The content without a mark and blanks before it.
pub(crate) fn begin(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(BOM).unwrap_or(bytes).trim_ascii_start()
}

/// What is no text in one byte a letter, or a page of the web.
pub(crate) fn refuse_foreign(bytes: &[u8]) -> Located<()> {
    refuse_other_text(bytes)?;
    let text = bytes.strip_prefix(BOM).unwrap_or(bytes).trim_ascii_start();
    if text.first() == Some(&b'<') {
        let line = 1 + memchr::memchr_iter(b'\n', &bytes[..bytes.len() - text.len()]).count();
        return Err((line as u64, Fault::Html));
    }
    Ok(())
}

/// What is no text in one byte a letter.
pub(crate) fn refuse_other_text(bytes: &[u8]) -> Located<()> {
    if bytes.is_empty() {
        return Err((1, Fault::Empty));
    }
    let utf16_mark = bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]);
    if utf16_mark {
        return Err((1, Fault::Utf16));
    }
    if let Some(nul) = memchr::memchr(0, bytes) {
        // Without the mark: every other byte of ASCII text is NUL.
        let start = &bytes[..bytes.len().min(64)];
        let alternate = |odd: usize| start.iter().skip(odd).step_by(2).all(|&b| b == 0);
        let utf16 = start.len() > 2 && alternate(0) != alternate(1);
        let line = 1 + memchr::memchr_iter(b'\n', &bytes[..nul]).count() as u64;
        return Err(if utf16 {
            (1, Fault::Utf16)
        } else {
            (line, Fault::Binary)
        });
    }
    Ok(())
}

/// The file's name without folder, `.gz` and one of the extensions; other dots belong to the name.
pub(crate) fn stem<'a>(name: &'a str, extensions: &[&str]) -> &'a str {
    let file = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let file = unpacked_name(Path::new(file)).to_str().unwrap_or(file);
    match file.rsplit_once('.') {
        Some((stem, ext)) if extensions.contains(&ext.to_ascii_lowercase().as_str()) => stem,
        _ => file,
    }
}

/// A piece of a file as an error shows it: not longer than a line of a terminal.
#[cfg(feature = "asc")]
pub(crate) fn shown(text: &[u8]) -> String {
    let text = String::from_utf8_lossy(&text[..text.len().min(40)]);
    text.chars().filter(|c| !c.is_control()).collect()
}
