//! What was measured, and which numbers move what.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::{self, File, OpenOptions};
use std::io::Write as _;

use anyhow::Context;
use serde_json::{Value, json};

use super::copy::{FOLDER, Program};
use super::{NOISE, Way};
use crate::steps::root;

/// What the table is written to.
const TABLE: &str = "out/quality/sweep.md";
/// What is no figure of a surface.
const LEFT_OUT: [&str; 4] = ["file", "points", "seconds", "soma_seconds"];

/// Figures by what was changed; they are kept in a file, so that a sweep that ends goes on where it was.
pub(super) struct Results {
    file: File,
    known: BTreeMap<String, Value>,
}

impl Results {
    /// Those of the same numbers.
    pub(super) fn open(program: &Program) -> anyhow::Result<Self> {
        let path = root().join(FOLDER).join("results.jsonl");
        let of = json!(
            program
                .knobs
                .iter()
                .map(|knob| (&knob.name, &knob.value))
                .collect::<Vec<_>>()
        );
        let text = fs::read_to_string(&path).unwrap_or_default();
        let mut rows = text
            .lines()
            .filter_map(|line| serde_json::from_str::<Value>(line).ok());
        let mut known = BTreeMap::new();
        if rows.next().is_some_and(|first| first == of) {
            let rows = rows
                .filter_map(|row| Some((row["key"].as_str()?.to_owned(), row["cells"].clone())));
            known.extend(rows);
        } else {
            fs::write(&path, format!("{of}\n"))?;
        }
        let file = OpenOptions::new().append(true).open(&path)?;
        Ok(Self { file, known })
    }

    /// Measures what is not known yet.
    pub(super) fn get_or(
        &mut self,
        way: Way,
        name: &str,
        factor: f64,
        measure: impl FnOnce() -> anyhow::Result<Value>,
    ) -> anyhow::Result<()> {
        let key = key(way, name, factor);
        if !self.known.contains_key(&key) {
            let cells = measure()?;
            writeln!(self.file, "{}", json!({ "key": key, "cells": cells }))?;
            println!("{key}");
            self.known.insert(key, cells);
        }
        Ok(())
    }

    fn get(&self, way: Way, name: &str, factor: f64) -> anyhow::Result<&Value> {
        let key = key(way, name, factor);
        let known = self.known.get(&key);
        known.with_context(|| format!("{key} was not measured"))
    }

    /// Whether a number changes nothing.
    pub(super) fn is_same(&self, way: Way, name: &str, factor: f64) -> anyhow::Result<bool> {
        let usual = self.get(way, "as it is", 1.0)?;
        Ok(differing(self.get(way, name, factor)?, usual).is_empty())
    }

    /// The table: each number, and what it moves by more than noise.
    pub(super) fn print(
        &self,
        program: &Program,
        names: &[&str],
        factors: &[f64],
    ) -> anyhow::Result<()> {
        let mut text = String::from("| number | value |");
        for factor in factors {
            let _ = write!(text, " × {factor} |");
        }
        text += "\n| --- | ---: |";
        text += &" --- |".repeat(factors.len());
        text.push('\n');
        for knob in (program.knobs.iter()).filter(|knob| names.contains(&knob.name.as_str())) {
            let _ = write!(text, "| {} | {} |", knob.name, knob.value);
            for &factor in factors {
                let _ = write!(text, " {} |", self.moved(&knob.name, factor)?);
            }
            text.push('\n');
        }
        text += "\nNot swept, because it is needed when the code is compiled:";
        for name in &program.excluded {
            let _ = write!(text, " {name},");
        }
        let path = root().join(TABLE);
        fs::create_dir_all(path.parent().context("a folder")?)?;
        fs::write(&path, &text)?;
        println!("\n{text}\n\n{TABLE} has this table");
        Ok(())
    }

    /// Columns that differ by more than noise, with the ratio of their sums.
    fn moved(&self, name: &str, factor: f64) -> anyhow::Result<String> {
        let way = Way::of(name);
        if way == Way::Surfaces && self.is_same(Way::Digests, name, factor)? {
            return Ok("nothing".into());
        }
        let usual = self.get(way, "as it is", 1.0)?;
        let cells = self.get(way, name, factor)?;
        if cells.is_string() {
            return Ok("**fails**".into());
        }
        if differing(cells, usual).is_empty() {
            let others = match way {
                Way::Surfaces => {
                    let usual = self.get(Way::Digests, "as it is", 1.0)?;
                    differing(self.get(Way::Digests, name, factor)?, usual)
                }
                _ => Vec::new(),
            };
            return Ok(match others.is_empty() {
                true => "nothing".into(),
                false => format!("only {}", others.join(", ")),
            });
        }
        let noise: anyhow::Result<Vec<&Value>> = (NOISE.iter())
            .map(|&factor| self.get(way, "all", factor))
            .collect();
        let noise = noise?;
        let mut moved = Vec::new();
        for column in columns(usual) {
            let before = sum(usual, &column);
            let differs = |cells: &Value| (sum(cells, &column) - before).abs();
            let noise = noise.iter().map(|cells| differs(cells));
            let noise = noise.fold(1e-6 * before.abs(), f64::max);
            if differs(cells) > noise {
                let ratio = sum(cells, &column) / before.abs().max(1e-12);
                moved.push(format!("{column} {ratio:.3}"));
            }
        }
        Ok(match moved.is_empty() {
            true => "noise".into(),
            false => moved.join(", "),
        })
    }
}

fn key(way: Way, name: &str, factor: f64) -> String {
    format!("{way:?} {name} × {factor}")
}

/// Files of which any figure differs.
fn differing<'c>(cells: &Value, usual: &'c Value) -> Vec<&'c str> {
    let columns = columns(usual);
    let usual = usual.as_array().into_iter().flatten().enumerate();
    let differs = |&(row, usual): &(usize, &Value)| {
        columns
            .iter()
            .any(|column| cells[row][column] != usual[column])
    };
    let file = |(_, row): (usize, &'c Value)| row["file"].as_str()?.rsplit('/').next();
    usual.filter(differs).filter_map(file).collect()
}

fn columns(cells: &Value) -> Vec<String> {
    let rows = cells.as_array().into_iter().flatten();
    let keys = rows
        .filter_map(Value::as_object)
        .flat_map(|row| row.keys().cloned());
    let mut keys: Vec<String> = keys
        .filter(|key| !LEFT_OUT.contains(&key.as_str()))
        .collect();
    keys.sort();
    keys.dedup();
    keys
}

/// Of signed figures, how far they are from 0 counts; of what holds or does not, how many hold.
fn sum(cells: &Value, column: &str) -> f64 {
    let rows = cells.as_array().into_iter().flatten();
    let values = rows.map(|row| match &row[column] {
        Value::Bool(holds) => f64::from(u8::from(*holds)),
        value => value.as_f64().unwrap_or_default().abs(),
    });
    values.sum()
}
