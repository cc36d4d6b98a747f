//! Words, brackets and their lines.

/// What stands next in the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Token<'a> {
    Open,
    Close,
    Bar,
    SpineOpen,
    SpineClose,
    /// In quotes.
    Text(&'a [u8]),
    Number(f64),
    Word(&'a [u8]),
    End,
}

/// A place in the file. Copies look ahead.
#[derive(Clone, Copy)]
pub(super) struct Lexer<'a> {
    rest: &'a [u8],
    line: u64,
    /// The next token, once it was looked at, with what is left after it and its line.
    ahead: Option<(Token<'a>, &'a [u8], u64)>,
}

/// By byte: whether a word ends before it.
const ENDS_WORD: [bool; 256] = {
    let mut ends = [false; 256];
    let bytes = b" \t\n\x0c\r()|<>\";,\x0b\x1a\xa0\xc2";
    let mut i = 0;
    while i < bytes.len() {
        ends[bytes[i] as usize] = true;
        i += 1;
    }
    ends
};

impl<'a> Lexer<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self {
            rest: bytes,
            line: 1,
            ahead: None,
        }
    }

    /// Line of the token read last.
    pub(super) fn line(&self) -> u64 {
        self.line
    }

    /// What is not read yet.
    pub(super) fn rest(&self) -> &'a [u8] {
        self.rest
    }

    /// The next token, read.
    #[inline]
    pub(super) fn next(&mut self) -> Token<'a> {
        if let Some((token, rest, line)) = self.ahead.take() {
            (self.rest, self.line) = (rest, line);
            return token;
        }
        self.read()
    }

    /// The next token, left where it is.
    #[inline]
    pub(super) fn peek(&mut self) -> Token<'a> {
        if let Some((token, ..)) = self.ahead {
            return token;
        }
        let mut beyond = *self;
        let token = beyond.read();
        self.ahead = Some((token, beyond.rest, beyond.line));
        token
    }

    fn read(&mut self) -> Token<'a> {
        self.skip_blanks();
        let Some(&byte) = self.rest.first() else {
            return Token::End;
        };
        let single = match byte {
            b'(' => Token::Open,
            b')' => Token::Close,
            b'|' => Token::Bar,
            b'<' => Token::SpineOpen,
            b'>' => Token::SpineClose,
            b'"' => return self.text(),
            _ => return self.word(),
        };
        self.rest = &self.rest[1..];
        single
    }

    /// White space, commas and comments. What follows a file separator (^Z) is padding.
    fn skip_blanks(&mut self) {
        while let Some((&byte, rest)) = self.rest.split_first() {
            match byte {
                b'\n' => self.line += 1,
                b';' => {
                    let end = memchr::memchr2(b'\n', b'\r', rest).unwrap_or(rest.len());
                    self.rest = &rest[end..];
                    continue;
                }
                // A carriage return alone ends a line, too.
                b'\r' if rest.first() != Some(&b'\n') => self.line += 1,
                0x1a => {
                    self.rest = &[];
                    continue;
                }
                b',' => {}
                // No-break spaces: alone in Latin-1, in UTF-8 after a lead byte that no number or word begins with.
                0xa0 | 0xc2 => {}
                _ if byte.is_ascii_whitespace() || byte == 0x0b => {}
                _ => return,
            }
            self.rest = rest;
        }
    }

    fn text(&mut self) -> Token<'a> {
        let inner = &self.rest[1..];
        let end = memchr::memchr(b'"', inner).unwrap_or(inner.len());
        let (text, rest) = (&inner[..end], &inner[(end + 1).min(inner.len())..]);
        self.line += memchr::memchr_iter(b'\n', text).count() as u64;
        self.rest = rest;
        Token::Text(text)
    }

    fn word(&mut self) -> Token<'a> {
        let end = self
            .rest
            .iter()
            .position(|&byte| ENDS_WORD[usize::from(byte)]);
        let end = end.unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        let digits = word.strip_prefix(b"+").unwrap_or(word);
        match fast_float2::parse::<f64, _>(digits) {
            Ok(number) => Token::Number(number),
            Err(_) => Token::Word(word),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_and_lines() {
        let mut lexer = Lexer::new(b"(a; b)\r\n\"c (\n\" +1,-2e1|<S1>)\r)");
        let mut tokens = Vec::new();
        loop {
            let token = lexer.next();
            if token == Token::End {
                break;
            }
            tokens.push((token, lexer.line()));
        }
        assert_eq!(
            tokens,
            [
                (Token::Open, 1),
                (Token::Word(b"a"), 1),
                (Token::Text(b"c (\n"), 3),
                (Token::Number(1.0), 3),
                (Token::Number(-20.0), 3),
                (Token::Bar, 3),
                (Token::SpineOpen, 3),
                (Token::Word(b"S1"), 3),
                (Token::SpineClose, 3),
                (Token::Close, 3),
                (Token::Close, 4),
            ]
        );
    }
}
