//! What edits of a document of many neurons cost: the memory that the history takes, and the time of each.
//!
//! `cargo run --release -p neurotess-viewer --example clicks -- 100000 select` prints both for 200 rounds; the history
//! keeps 200 edits. A round of `select` selects another neuron, of `all` all and then none; that of `move` moves another, and
//! that of `remove` selects and removes one. Memory is read from `/proc`, so it needs Linux.
#![allow(
    clippy::print_stdout,
    clippy::unwrap_used,
    reason = "printing is what this program is for"
)]

use std::time::Instant;

use neurotess_viewer::Command;
use neurotess_viewer::command::Edit;
use neurotess_viewer::document::{Neuron, SourceId};
use neurotess_viewer::settings::Settings;
use neurotess_viewer::state::State;

/// As many edits as the history keeps.
const ROUNDS: usize = 200;

/// Tracings of the circuit.
const TRACINGS: usize = 100;

fn main() {
    let mut args = std::env::args().skip(1);
    let count: usize = args.next().unwrap().parse().unwrap();
    // One kind in each process: memory that another has freed would be taken again, unseen.
    let edit: fn(&mut State, usize) = match args.next().unwrap().as_str() {
        "select" => |state, i| state.run(Edit::Select(vec![i], false)),
        "all" => |state, _| {
            state.run(Edit::SelectAll);
            state.run(Edit::SelectOthers);
        },
        "move" => |state, i| {
            let mut place = state.document.neurons[i].placement;
            place.translation.x += 10.0;
            state.run(Edit::Place(vec![(i, place)]));
            // The next one does not join.
            state.run(Command::EndPlacing);
        },
        "remove" => |state, i| {
            state.run(Edit::Select(vec![i], false));
            state.run(Edit::Remove);
        },
        other => panic!("{other}: neither select, all, move nor remove"),
    };
    measure(count, edit);
}

/// Opens so many neurons, edits them, and prints what that took.
fn measure(count: usize, edit: fn(&mut State, usize)) {
    let empty = resident();
    let mut state = State::new(Settings::default());
    for i in 0..count {
        let source = SourceId((i % TRACINGS) as u32);
        let neuron = Neuron::new(source, format!("Excitatory {i}"));
        state.document.neurons.push(neuron);
    }
    let opened = resident();
    // Not neighbors, as clicks are not.
    let step = (count / ROUNDS).max(1);
    let clock = Instant::now();
    for i in 0..ROUNDS {
        edit(&mut state, i * step % count.saturating_sub(ROUNDS).max(1));
    }
    let ms = clock.elapsed().as_secs_f64() * 1e3 / ROUNDS as f64;
    println!(
        "{count} neurons ({:.1} MB): {:.1} MB more, {ms:.3} ms a round",
        opened - empty,
        resident() - opened
    );
}

/// Resident memory of this process, in MB.
fn resident() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with("VmRSS:"));
    let kb = line.unwrap().split_whitespace().nth(1).unwrap();
    kb.parse::<f64>().unwrap() * 1024.0 / 1e6
}
