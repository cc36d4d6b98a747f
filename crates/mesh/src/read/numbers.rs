//! Numbers of a file of sections (`$Nodes` to `$EndNodes`), as text or binary, whatever the file says.

use super::lines::{number, whole as whole_number};
use super::{FilePosition, ReadError};

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Encoding {
    Text,
    Little,
    Big,
}

/// Numbers of the file, whatever its encoding.
pub(super) struct Numbers<'a> {
    pub(super) bytes: &'a [u8],
    at: usize,
    /// In text, the number of the line.
    line: usize,
    pub(super) encoding: Encoding,
}

impl<'a> Numbers<'a> {
    /// Begins at the start of a file, as text.
    pub(super) fn of(bytes: &'a [u8]) -> Self {
        Self {
            bytes,
            at: 0,
            line: 1,
            encoding: Encoding::Text,
        }
    }

    pub(super) fn place(&self) -> FilePosition {
        match self.encoding {
            Encoding::Text => FilePosition::Line(self.line),
            _ => FilePosition::Byte(self.at),
        }
    }

    /// Goes behind the next line that begins a section, and returns it.
    pub(super) fn next_section(&mut self) -> Option<&'a [u8]> {
        while self.at < self.bytes.len() {
            let line = self.line_of_text();
            if line.starts_with(b"$") {
                return Some(line.trim_ascii_end());
            }
        }
        None
    }

    /// Goes behind the line that ends a section.
    pub(super) fn leave(&mut self, section: &[u8]) -> Result<(), ReadError> {
        let mut end = b"$End".to_vec();
        end.extend_from_slice(&section[1..]);
        while self.at < self.bytes.len() {
            if self.line_of_text().trim_ascii() == end {
                return Ok(());
            }
        }
        Err(ReadError::Truncated {
            at: self.place(),
            what: "a section: its $End is missing",
        })
    }

    /// What stands before the end of a section, as text.
    pub(super) fn rest_of_section(&self) -> String {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let end = rest.iter().position(|&byte| byte == b'$');
        String::from_utf8_lossy(&rest[..end.unwrap_or(rest.len())]).into_owned()
    }

    /// The rest of the line, without its end; goes to the next one.
    fn line_of_text(&mut self) -> &'a [u8] {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let length = rest.iter().position(|&byte| byte == b'\n');
        self.at += length.map_or(rest.len(), |length| length + 1);
        self.line += 1;
        &rest[..length.unwrap_or(rest.len())]
    }

    pub(super) fn end_of_line(&mut self) {
        self.line_of_text();
    }

    /// The next word of a text.
    pub(super) fn word(&mut self) -> Result<&'a [u8], ReadError> {
        let bytes = self.bytes;
        while bytes.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.line += usize::from(bytes[self.at] == b'\n');
            self.at += 1;
        }
        let rest = bytes.get(self.at..).unwrap_or_default();
        let length = rest.iter().position(u8::is_ascii_whitespace);
        let word = &rest[..length.unwrap_or(rest.len())];
        if word.is_empty() {
            let at = self.place();
            return Err(ReadError::Truncated {
                at,
                what: "the numbers",
            });
        }
        self.at += word.len();
        Ok(word)
    }

    pub(super) fn take(&mut self, count: usize, what: &'static str) -> Result<&'a [u8], ReadError> {
        let at = self.place();
        let end = self.at.saturating_add(count);
        let taken = self.bytes.get(self.at..end);
        self.at = end.min(self.bytes.len());
        taken.ok_or(ReadError::Truncated { at, what })
    }

    fn whole<T: std::str::FromStr>(&mut self) -> Result<T, ReadError> {
        let word = self.word()?;
        whole_number(Some(word), self.place())
    }

    pub(super) fn int(&mut self) -> Result<i32, ReadError> {
        if self.encoding == Encoding::Text {
            return self.whole();
        }
        let bytes = self.array()?;
        Ok(match self.encoding {
            Encoding::Big => i32::from_be_bytes(bytes),
            _ => i32::from_le_bytes(bytes),
        })
    }

    pub(super) fn size(&mut self) -> Result<u64, ReadError> {
        if self.encoding == Encoding::Text {
            return self.whole();
        }
        self.eight_bytes()
    }

    pub(super) fn real(&mut self) -> Result<f64, ReadError> {
        if self.encoding == Encoding::Text {
            let word = self.word()?;
            return number(Some(word), self.place());
        }
        self.eight_bytes().map(f64::from_bits)
    }

    fn eight_bytes(&mut self) -> Result<u64, ReadError> {
        let bytes = self.array()?;
        Ok(match self.encoding {
            Encoding::Big => u64::from_be_bytes(bytes),
            _ => u64::from_le_bytes(bytes),
        })
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], ReadError> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N, "the numbers")?);
        Ok(array)
    }
}
