//! From words to outlines and trees.
//!
//! ```text
//! file   = { block }
//! block  = '(' { property | "name" } points ')'        an outline: of a soma if it says CellBody
//!        | '(' { property } branch ')'                 a tree
//! branch = { point | marker | spine | property } [ '(' branch { '|' branch } ')' ] [ ending ]
//! point  = '(' x y z [ diameter ] { word } ')'
//! marker = '(' word … points … ')'
//! spine  = '<' { point | property } '>'              its end
//! ```
//! There is no published grammar; this one is of files. All is read without recursion.

use glam::DVec3;
use neurotess_morphology::{Morphology, NeuriteKind};

use super::lexer::{Lexer, Token};
use crate::Fault;
use crate::sample::Sample;
use crate::text::{Located, shown};
use crate::traced::{SPINES_LEFT_OUT, Tracing};
use crate::warning::Warnings;

/// Words after which a branch must not go on.
const ENDINGS: [&str; 7] = [
    "normal",
    "high",
    "low",
    "incomplete",
    "generated",
    "midpoint",
    "origin",
];

/// Words that begin an expression about the file, a contour or a tree. All others are markers if
/// there are points in them, else not known.
const PROPERTIES: [&str; 20] = [
    "class",
    "closed",
    "color",
    "description",
    "filldensity",
    "font",
    "generated",
    "guid",
    "imagecoords",
    "mbfobjecttype",
    "name",
    "resolution",
    "sections",
    "set",
    "setlist",
    "ssm",
    "ssm2",
    "thumbnail",
    "thumbcoords",
    "zsmear",
];

/// Reads a file.
pub(super) fn parse(bytes: &[u8], warnings: &mut Warnings) -> Located<Tracing> {
    let mut parser = Parser {
        lexer: Lexer::new(bytes),
        tracing: Tracing::default(),
        has_commas: memchr::memchr(b',', bytes).is_some(),
        warnings,
    };
    loop {
        match parser.lexer.next() {
            Token::Open => parser.block()?,
            Token::End => return Ok(parser.tracing),
            Token::Close => return Err(parser.unexpected(")", "a block that it closes")),
            Token::Bar => return Err(parser.unexpected("|", "a block")),
            _ => parser.unknown(),
        }
    }
}

/// What a block says of itself before its first point.
#[derive(Clone, Copy, PartialEq)]
enum Says {
    Nothing,
    Soma,
    Neurite(NeuriteKind),
    Name,
}

/// Where a branch stands.
#[derive(Clone, Copy, PartialEq)]
enum Stage {
    Points,
    /// Its children are read.
    Forked,
    /// A word ended it.
    Ended,
}

/// A fork whose children are being read.
struct Fork {
    /// The point that children hang on.
    at: Option<u32>,
    line: u64,
}

struct Parser<'a, 'w> {
    lexer: Lexer<'a>,
    tracing: Tracing,
    /// Whether there is any comma in the file.
    has_commas: bool,
    warnings: &'w mut Warnings,
}

impl<'a> Parser<'a, '_> {
    /// What stands in a bracket of the outermost level, which is open.
    fn block(&mut self) -> Located<()> {
        let line = self.lexer.line();
        let mut says = Says::Nothing;
        loop {
            match self.lexer.peek() {
                Token::Text(name) => {
                    self.lexer.next();
                    // A name says least: what the block is by its properties stays, before and after.
                    if is_cell_body(name) {
                        says = Says::Soma;
                    } else if says == Says::Nothing {
                        says = Says::Name;
                    }
                }
                Token::Open => {
                    let mut ahead = self.lexer;
                    ahead.next();
                    match ahead.peek() {
                        Token::Word(word) if !is_ending(word) => {
                            self.lexer = ahead;
                            self.property(word, &mut says)?;
                        }
                        _ => break,
                    }
                }
                Token::Word(word) if matches!(says, Says::Nothing) => {
                    return self.expression(word, line);
                }
                Token::Close => {
                    self.lexer.next();
                    return Ok(());
                }
                Token::End => return Err((line, Fault::Unclosed { what: "bracket" })),
                _ => break,
            }
        }
        match says {
            Says::Soma => self.outline(line),
            Says::Neurite(kind) => self.tree(kind, line),
            Says::Nothing if self.is_annotation() => {
                self.skip(line)?;
                self.warnings
                    .add(line, "annotations_left_out", "text at a point: left out");
                Ok(())
            }
            Says::Nothing => {
                self.warnings.add(
                    line,
                    "untyped_tree",
                    "a tree of no type: taken as undefined",
                );
                self.tree(NeuriteKind::UNDEFINED, line)
            }
            Says::Name => {
                self.skip(line)?;
                self.warnings.add(
                    line,
                    "contours_left_out",
                    "a contour that is not of a soma: left out",
                );
                Ok(())
            }
        }
    }

    /// Whether a point comes next, and a text after it.
    fn is_annotation(&self) -> bool {
        let mut ahead = self.lexer;
        while matches!(ahead.next(), Token::Open | Token::Number(_)) {}
        matches!(ahead.next(), Token::Text(_))
    }

    /// An expression about the block around it; its bracket is open, its word comes next.
    fn property(&mut self, word: &[u8], says: &mut Says) -> Located<()> {
        let line = self.lexer.line();
        if is_cell_body(word) {
            *says = Says::Soma;
            return self.skip(line).map(drop);
        }
        let kind = match word.to_ascii_lowercase().as_slice() {
            b"axon" => NeuriteKind::AXON,
            b"dendrite" | b"basal" => NeuriteKind::BASAL_DENDRITE,
            b"apical" => NeuriteKind::APICAL_DENDRITE,
            _ => {
                self.lexer.next();
                return self.expression(word, line);
            }
        };
        if matches!(says, Says::Nothing | Says::Name) {
            *says = Says::Neurite(kind);
        }
        self.skip(line).map(drop)
    }

    /// Anything in brackets that is neither outline nor tree; `word` is its first.
    fn expression(&mut self, word: &[u8], line: u64) -> Located<()> {
        let has_points = self.skip(line)?;
        let word = word.to_ascii_lowercase();
        let known = PROPERTIES.iter().any(|p| p.as_bytes() == word);
        if !known && has_points {
            self.warnings
                .add(line, "markers_left_out", "markers: left out");
        } else if !known {
            self.unknown();
        }
        Ok(())
    }

    fn unknown(&mut self) {
        let line = self.lexer.line();
        self.warnings.add(
            line,
            "unknown_expression",
            "an expression that is not known: left out",
        );
    }

    /// Skips to the end of the bracket that is open; whether there was a point in it.
    fn skip(&mut self, line: u64) -> Located<bool> {
        let mut depth = 1_u64;
        let mut has_points = false;
        while depth > 0 {
            match self.lexer.next() {
                Token::Open => {
                    depth += 1;
                    has_points |= matches!(self.lexer.peek(), Token::Number(_));
                }
                Token::Close => depth -= 1,
                Token::End => return Err((line, Fault::Unclosed { what: "bracket" })),
                _ => {}
            }
        }
        Ok(has_points)
    }

    /// A spine, whose bracket is open: its last point is where it ends.
    fn spine(&mut self) -> Located<()> {
        let line = self.lexer.line();
        let mut depth = 1_u64;
        let mut tip = None;
        while depth > 0 {
            match self.lexer.next() {
                Token::SpineOpen => depth += 1,
                Token::SpineClose => depth -= 1,
                Token::Open => tip = self.place().or(tip),
                Token::End => return Err((line, Fault::Unclosed { what: "spine (<)" })),
                _ => {}
            }
        }
        self.tracing.spines.extend(tip);
        self.warnings
            .add(line, SPINES_LEFT_OUT.0, SPINES_LEFT_OUT.1);
        Ok(())
    }

    /// A place, if three numbers come next.
    fn place(&mut self) -> Option<DVec3> {
        let mut place = DVec3::ZERO;
        for axis in 0..3 {
            let Token::Number(number) = self.lexer.peek() else {
                return None;
            };
            self.lexer.next();
            place[axis] = in_range(number, axis).ok()?;
        }
        Some(place)
    }

    /// Points up to the bracket's end.
    fn outline(&mut self, line: u64) -> Located<()> {
        let mut outline = Vec::new();
        loop {
            match self.lexer.next() {
                Token::Open => match self.lexer.peek() {
                    Token::Number(_) => outline.push(self.point(0.0)?),
                    Token::Word(word) => {
                        self.lexer.next();
                        let line = self.lexer.line();
                        self.expression(word, line)?;
                    }
                    _ => {
                        let line = self.lexer.line();
                        self.skip(line)?;
                        self.unknown();
                    }
                },
                Token::Close => break,
                Token::End => return Err((line, Fault::Unclosed { what: "contour" })),
                _ => self.unknown(),
            }
        }
        match outline.len() {
            0 => {}
            1 => {
                self.warnings.add(
                    line,
                    "soma_of_one_point",
                    "the soma's contour is one point: taken as a sphere",
                );
                self.tracing.outlines.push(outline);
            }
            _ => self.tracing.outlines.push(outline),
        }
        Ok(())
    }

    /// Branches up to the block's end.
    fn tree(&mut self, kind: NeuriteKind, line: u64) -> Located<()> {
        let mut forks: Vec<Fork> = Vec::new();
        let mut at: Option<u32> = None;
        let mut stage = Stage::Points;
        let mut starts = true;
        loop {
            match self.lexer.next() {
                Token::Open => match self.lexer.peek() {
                    Token::Number(_) => {
                        self.still_open(stage)?;
                        let sample = self.point(f64::NAN)?;
                        at = Some(self.tracing.push(sample, kind, at, starts));
                        starts = false;
                    }
                    Token::Word(word) if !is_ending(word) => {
                        self.lexer.next();
                        let line = self.lexer.line();
                        self.expression(word, line)?;
                    }
                    Token::Text(_) => {
                        let line = self.lexer.line();
                        self.skip(line)?;
                        self.unknown();
                    }
                    _ => {
                        self.still_open(stage)?;
                        let line = self.lexer.line();
                        forks.push(Fork { at, line });
                        starts = true;
                    }
                },
                Token::Bar => {
                    let Some(fork) = forks.last() else {
                        return Err(self.unexpected("|", "a fork of which it parts the children"));
                    };
                    at = fork.at;
                    stage = Stage::Points;
                    starts = true;
                }
                Token::Close => {
                    if forks.pop().is_none() {
                        return Ok(());
                    }
                    stage = Stage::Forked;
                }
                Token::SpineOpen => self.spine()?,
                Token::Word(word) if is_ending(word) => stage = Stage::Ended,
                Token::End => {
                    let line = forks.last().map_or(line, |fork| fork.line);
                    return Err((line, Fault::Unclosed { what: "branch" }));
                }
                _ => self.unknown(),
            }
        }
    }

    fn still_open(&self, stage: Stage) -> Located<()> {
        let after = match stage {
            Stage::Points => return Ok(()),
            Stage::Forked => "its children",
            Stage::Ended => "the word that ends it",
        };
        Err((self.lexer.line(), Fault::BranchGoesOn { after }))
    }

    /// Numbers up to the bracket's end. `diameter`: what is taken where there are only three;
    /// NaN if there must be four.
    fn point(&mut self, diameter: f64) -> Located<Sample> {
        let line = self.lexer.line();
        if self.has_commas {
            self.check_commas(line)?;
        }
        let mut numbers = [0.0, 0.0, 0.0, diameter];
        let mut found = 0;
        while let Token::Number(number) = self.lexer.peek() {
            self.lexer.next();
            if found < 4 {
                numbers[found] = in_range(number, found).map_err(|fault| (line, fault))?;
            }
            found += 1;
        }
        if found < 3 || numbers[3].is_nan() {
            return Err((line, Fault::PointNumbers { found }));
        }
        self.skip(line)?;
        Ok(Sample {
            position: DVec3::new(numbers[0], numbers[1], numbers[2]),
            radius: numbers[3] / 2.0,
            line,
        })
    }

    /// Commas may stand between a point's numbers, but not be their decimal marks: as in a row of SWC, some but not all
    /// numbers are parted by a comma alone, or there are more numbers than a point has.
    fn check_commas(&mut self, line: u64) -> Located<()> {
        let text = self.lexer.rest();
        let end = text.iter().position(|b| b"();|\"".contains(b));
        let text = &text[..end.unwrap_or(text.len())];
        if !text.contains(&b',') {
            return Ok(());
        }
        let parts = text.split(u8::is_ascii_whitespace);
        let words = parts.filter(|part| part.iter().any(|b| *b != b','));
        let (mut count, mut by_comma, mut by_blank) = (0, false, false);
        for word in words {
            let numbers = word
                .split(|&b| b == b',')
                .filter(|part| !part.is_empty())
                .count();
            by_comma |= numbers > 1;
            by_blank |= count > 0;
            count += numbers;
        }
        if count > 4 || (by_comma && by_blank) {
            return Err((line, Fault::DecimalComma));
        }
        self.warnings
            .add(line, "separators", "commas between the numbers of a point");
        Ok(())
    }

    fn unexpected(&self, found: &str, expected: &'static str) -> (u64, Fault) {
        let found = shown(found.as_bytes());
        (self.lexer.line(), Fault::Unexpected { found, expected })
    }
}

fn in_range(number: f64, column: usize) -> Result<f64, Fault> {
    // Of a diameter the half is kept.
    let kept = if column == 3 { number / 2.0 } else { number };
    if kept.abs() <= Morphology::MAX_COORDINATE {
        return Ok(number);
    }
    Err(Fault::OutOfRange {
        column: ["x", "y", "z", "the diameter"][column],
        text: number.to_string(),
    })
}

fn is_ending(word: &[u8]) -> bool {
    ENDINGS
        .iter()
        .any(|e| word.eq_ignore_ascii_case(e.as_bytes()))
}

fn is_cell_body(word: &[u8]) -> bool {
    let letters = word.iter().filter(|b| !b" _-".contains(b));
    letters.map(u8::to_ascii_lowercase).eq(*b"cellbody") || word.eq_ignore_ascii_case(b"soma")
}
