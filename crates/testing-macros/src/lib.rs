//! The attribute `#[neurotess_testing::test]`; see the crate `neurotess-testing`.
//!
//! What it reads is so little (the name of a function, a list of paths) that no parser of Rust is
//! needed.
#![forbid(unsafe_code)]

use proc_macro::{Delimiter, TokenStream, TokenTree};

/// Registers a function without parameters as a test: `#[test]`, or `#[test(needs(path, …))]`, where
/// each path names a function of type `fn() -> Result<(), String>` that says what is missing.
#[proc_macro_attribute]
pub fn test(attribute: TokenStream, function: TokenStream) -> TokenStream {
    match (needs(attribute), name(&function)) {
        (Ok(needs), Ok(name)) => {
            let mut out = function;
            out.extend(registration(&name, &needs));
            out
        }
        (Err(fault), _) | (_, Err(fault)) => {
            let fault = format!("::core::compile_error!({fault:?});");
            let mut out = function;
            out.extend(parsed(&fault));
            out
        }
    }
}

/// The paths in `needs(path, …)`, as text.
fn needs(attribute: TokenStream) -> Result<Vec<String>, &'static str> {
    let tokens: Vec<TokenTree> = attribute.into_iter().collect();
    match &tokens[..] {
        [] => Ok(Vec::new()),
        [TokenTree::Ident(word), TokenTree::Group(paths)]
            if word.to_string() == "needs" && paths.delimiter() == Delimiter::Parenthesis =>
        {
            let text: String = paths.stream().into_iter().map(|t| t.to_string()).collect();
            let paths = text.split(',').filter(|path| !path.is_empty());
            Ok(paths.map(str::to_owned).collect())
        }
        _ => Err("expected #[test] or #[test(needs(path, …))]"),
    }
}

/// The name of a function that takes nothing and returns nothing.
fn name(function: &TokenStream) -> Result<String, &'static str> {
    let mut tokens = function.clone().into_iter();
    let is_fn = |token: &TokenTree| matches!(token, TokenTree::Ident(i) if i.to_string() == "fn");
    if !tokens.by_ref().any(|token| is_fn(&token)) {
        return Err("only a function can be a test");
    }
    let rest: Vec<TokenTree> = tokens.collect();
    match &rest[..] {
        [
            TokenTree::Ident(name),
            TokenTree::Group(parameters),
            TokenTree::Group(body),
        ] if parameters.stream().is_empty() && body.delimiter() == Delimiter::Brace => {
            Ok(name.to_string())
        }
        _ => Err("a test has no parameters and returns nothing"),
    }
}

fn registration(name: &str, needs: &[String]) -> TokenStream {
    let needs = needs.iter().map(|path| {
        let last = path.rsplit("::").next().unwrap_or(path);
        format!("::neurotess_testing::Need::new({last:?}, {path}),")
    });
    let needs: String = needs.collect();
    parsed(&format!(
        "const _: () = crate::END_THIS_FILE_WITH_neurotess_testing_main;
        ::neurotess_testing::registry::submit! {{
            ::neurotess_testing::Test::new(
                ::core::concat!(::core::module_path!(), \"::\", {name:?}), {name}, &[{needs}],
            )
        }}"
    ))
}

fn parsed(text: &str) -> TokenStream {
    text.parse()
        .unwrap_or_else(|error| panic!("the attribute wrote what is not Rust: {error}"))
}
