//! Common parts of the benchmarks: the order of the measurements, and the report.

#![allow(dead_code, reason = "each benchmark uses its part")]

pub mod controllers;
pub mod process;
pub mod table;

use std::time::{Duration, Instant};

use anyhow::Context as _;
use tokio::runtime::Runtime;

use table::Table;

/// Function that measures a comparison with this amount of work.
pub type Compare<E> = fn(&E) -> anyhow::Result<Table>;

/// Runs the comparisons that the command line names. Without a name, runs all comparisons.
pub fn run<E>(comparisons: &[(&str, Compare<E>)], full: &E, quick: &E) -> anyhow::Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    // `cargo bench` passes this argument, `cargo test` does not.
    let is_quick = args.iter().any(|arg| arg == "--quick") || !args.iter().any(|arg| arg == "--bench");
    let effort = if is_quick { quick } else { full };
    let selected: Vec<&String> = args.iter().filter(|arg| !arg.starts_with('-')).collect();
    let is_markdown = args.iter().any(|arg| arg == "--markdown");
    if !is_markdown {
        println!("{}", table::HEADER);
    }
    for (name, compare) in comparisons {
        if selected.is_empty() || selected.iter().any(|chosen| *chosen == name) {
            let table = compare(effort).with_context(|| (*name).to_owned())?;
            if is_markdown { println!("{table:#}") } else { println!("{table}") }
        }
    }
    if is_quick || cfg!(debug_assertions) {
        println!("A short or unoptimized run: it shows that the comparisons work, the figures mean nothing.");
    }
    Ok(())
}

/// Runs on one thread, like `armctl`.
pub fn runtime() -> anyhow::Result<Runtime> {
    Ok(tokio::runtime::Builder::new_current_thread().enable_all().build()?)
}

/// Work of one contender in one round.
pub trait Work: FnMut() -> anyhow::Result<()> {}

impl<F: FnMut() -> anyhow::Result<()>> Work for F {}

/// Returns the seconds of each contender in each round. The first round is not counted.
pub fn run_alternately<const N: usize>(
    rounds: usize,
    mut contenders: [&mut dyn Work; N],
) -> anyhow::Result<[Vec<f64>; N]> {
    let mut times = [const { Vec::new() }; N];
    for round in 0..=rounds {
        for (work, times) in contenders.iter_mut().zip(&mut times) {
            let time = measure_time(*work)?;
            if round > 0 {
                times.push(time.as_secs_f64());
            }
        }
    }
    Ok(times)
}

pub fn measure_time(work: &mut dyn Work) -> anyhow::Result<Duration> {
    let start = Instant::now();
    work()?;
    Ok(start.elapsed())
}

/// Returns the speed relative to `base`: the median over all rounds.
pub fn ratio(base: &[f64], other: &[f64]) -> f64 {
    median(&base.iter().zip(other).map(|(base, other)| base / other).collect::<Vec<_>>())
}

pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}
