//! What `docs/tracings.md` shows is what the commands say.

use std::path::Path;

use crate::work::{SMALL, Work};

/// The blocks of the page that begin with a command: the command, and what it says.
fn shown() -> Vec<(String, String)> {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/tracings.md");
    let page = std::fs::read_to_string(page).expect("the page");
    let blocks = page
        .split("```\n")
        .filter_map(|block| block.strip_prefix("$ neurotess "));
    let parts = blocks.filter_map(|block| block.split_once('\n'));
    parts
        .map(|(command, says)| (command.to_owned(), says.to_owned()))
        .collect()
}

#[neurotess_testing::test]
fn what_the_page_shows_is_what_the_commands_say() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let moved = SMALL.replace("3 2 0 -30 2", "3 2 0 -30 2.5");
    work.file("mended.swc", moved.replace("7 3 -9", "7 4 -9"));
    // A piece 2 µm from the axon's end, with a sample without a radius, and one that is far away.
    let piece = "10 2 0 -50 2 0.5 -1\n11 2 0 -32 2 0 10\n";
    let far = "20 3 900 0 0 1 -1\n21 3 910 0 0 1 20\n";
    work.file("pieces.swc", format!("{SMALL}{piece}{far}"));
    let shown = shown();
    assert_eq!(shown.len(), 2);
    for (command, says) in shown {
        let code = i32::from(command.starts_with("diff"));
        assert_eq!(work.run(&command).exits(code).stdout(), says, "{command}");
    }
}
