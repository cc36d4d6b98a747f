//! Texts without what machines do not read.

/// WGSL without comments, indentation, and spaces around signs that need none.
pub(crate) fn wgsl(text: &str) -> String {
    let lines = text.lines().map(|line| match line.find("//") {
        Some(at) => &line[..at],
        None => line,
    });
    tight(&lines.collect::<Vec<_>>().join("\n"))
}

/// GLSL as naga writes it, whose directives keep their lines.
pub(crate) fn glsl(text: &str) -> String {
    let mut out = String::new();
    let mut code = String::new();
    for line in text.lines() {
        if line.starts_with('#') {
            out.push_str(&tight(&code));
            code.clear();
            out.push_str(line);
            out.push('\n');
        } else {
            code.push_str(line);
            code.push('\n');
        }
    }
    out + &tight(&code)
}

/// Styles, which have no comments, without indentation and most spaces.
pub(crate) fn css(text: &str) -> String {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let text = lines.join("\n");
    [
        (" { ", "{"),
        ("; ", ";"),
        (": ", ":"),
        (", ", ","),
        (" }", "}"),
    ]
    .into_iter()
    .fold(text, |text, (from, to)| text.replace(from, to))
}

/// JavaScript without comments and most spaces. Lines stay, since a statement may end with its line.
pub(crate) fn javascript(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    let mut space = false;
    while let Some(sign) = rest.chars().next() {
        if sign == '\n' {
            trim_end(&mut out);
            if !out.ends_with('\n') && !out.is_empty() {
                out.push('\n');
            }
            (rest, space) = (&rest[1..], false);
            continue;
        }
        if sign.is_whitespace() {
            (rest, space) = (&rest[sign.len_utf8()..], true);
            continue;
        }
        let length = match sign {
            '/' if rest.starts_with("//") => {
                rest = &rest[rest.find('\n').unwrap_or(rest.len())..];
                continue;
            }
            '/' if rest.starts_with("/*") => {
                rest = &rest[rest.find("*/").map_or(rest.len(), |end| end + 2)..];
                space = true;
                continue;
            }
            '/' if begins_pattern(&out) => literal(rest, '/'),
            '\'' | '"' | '`' => literal(rest, sign),
            _ => sign.len_utf8(),
        };
        let is_alone = |sign: char| "{}()[],;:=<>?!&|*".contains(sign);
        if space
            && !out.is_empty()
            && !out.ends_with('\n')
            && !is_alone(sign)
            && !out.ends_with(is_alone)
        {
            out.push(' ');
        }
        space = false;
        out.push_str(&rest[..length]);
        rest = &rest[length..];
    }
    out
}

fn trim_end(out: &mut String) {
    let length = out.trim_end_matches([' ', '\t']).len();
    out.truncate(length);
}

/// Whether a slash after this text begins a pattern, not a division.
fn begins_pattern(before: &str) -> bool {
    let last = before.trim_end().chars().next_back();
    last.is_none_or(|sign| "(,=:[!&|?{};".contains(sign))
}

/// Length of a literal that begins and ends with a sign. Those in backquotes hold no others.
fn literal(text: &str, end: char) -> usize {
    let mut is_escaped = false;
    let mut in_class = false;
    for (at, sign) in text.char_indices().skip(1) {
        match sign {
            _ if is_escaped => is_escaped = false,
            '\\' => is_escaped = true,
            '[' if end == '/' => in_class = true,
            ']' if end == '/' => in_class = false,
            _ if sign == end && !in_class => return at + sign.len_utf8(),
            _ => {}
        }
    }
    text.len()
}

/// One space for several, none beside brackets, commas, colons and semicolons.
fn tight(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut space = false;
    for sign in text.chars() {
        if sign.is_whitespace() {
            space = true;
            continue;
        }
        let is_alone = |sign: char| "{}(),;:".contains(sign);
        if space && !out.is_empty() && !is_alone(sign) && !out.ends_with(is_alone) {
            out.push(' ');
        }
        space = false;
        out.push(sign);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_spaces_go() {
        let text = "// a\nfn f( a : u32 ) -> u32 { // b\n    return a - -1 ;\n}\n";
        assert_eq!(wgsl(text), "fn f(a:u32)-> u32{return a - -1;}");
        assert_eq!(
            glsl("#version 300 es\n\nvoid main() {\n}\n"),
            "#version 300 es\nvoid main(){}"
        );
        let script = "/** a\n * b */\n  x( 'a  b' ) ; // c\n\nconst p = s.replace(/[/ ]+/g, ` ${ a } `) / 2;\n";
        assert_eq!(
            javascript(script),
            "x('a  b');\nconst p=s.replace(/[/ ]+/g,` ${ a } `)/ 2;\n"
        );
    }
}
