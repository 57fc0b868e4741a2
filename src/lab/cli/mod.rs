//! The commands of `lamina`: arguments in, tables or one JSON document out.
//!
//! Exit codes: 0 done; 1 a run that failed (a state that turned non-finite, a folder that cannot be
//! written); 2 input that was refused.

mod accuracy;
mod bench;
mod determinism;
mod gate;
mod output;
mod recordings;
mod report;
mod run;
mod scenes;
mod stress;
mod tune;
mod wild;

use std::io::Write;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// A data-oriented SIMD 2D rigid-body engine built to be measured.
#[derive(Debug, Parser)]
#[command(name = "lamina", version, about, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// List the scenes and their parameters.
    Scenes(scenes::Args),
    /// Run a scene, by name or from a TOML file, and report time, counts, errors and state hash.
    Run(run::Args),
    /// Say what a recording holds.
    Info(recordings::InfoArgs),
    /// Run what a recording says was run, and compare every step to the bit.
    Verify(recordings::VerifyArgs),
    /// Say where two recordings part, and how they grow apart.
    Diff(recordings::DiffArgs),
    /// Write a recording's bodies, contacts or steps as CSV, Parquet or JSON lines.
    Export(recordings::export::Args),
    /// Time each shape mix × integrator × number of bodies × lanes beside the thesis engine.
    Bench(bench::Args),
    /// Run the thesis's determinism experiment and compare by bits.
    Determinism(determinism::Args),
    /// Measure run time against error: every case, integrator, step, precision and lane width.
    Accuracy(accuracy::Args),
    /// Find the cheapest settings that keep a scene's error under a bound.
    Tune(tune::Args),
    /// Run the cases of stability with every solver, and look for where they break.
    Stress(stress::Args),
    /// Run scenes made from public problem reports and hold each to its right numbers.
    Wild(wild::Args),
    /// Count instructions of kernels and scenes under valgrind and hold them against those blessed.
    Gate(gate::Args),
    /// Run all experiments into a folder with a page, tables and plots.
    Report(report::Args),
}

/// Input that was refused: exit code 2.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub(crate) struct Refused(#[from] anyhow::Error);

/// Marks an error as the input's fault.
pub(crate) fn refuse(error: impl Into<anyhow::Error>) -> anyhow::Error {
    anyhow::Error::new(Refused(error.into()))
}

/// Parses the arguments and runs the command.
///
/// Never inlined: its instructions must not move before the processor check.
#[inline(never)]
pub(crate) fn main() -> ExitCode {
    let cli = Cli::parse();
    let done = match cli.command {
        Command::Scenes(args) => scenes::main(&args),
        Command::Run(args) => run::main(&args),
        Command::Info(args) => recordings::info(&args),
        Command::Verify(args) => recordings::verify_file(&args),
        Command::Diff(args) => recordings::diff(&args),
        Command::Export(args) => recordings::export::main(&args),
        Command::Bench(args) => bench::main(&args),
        Command::Determinism(args) => determinism::main(&args),
        Command::Accuracy(args) => accuracy::main(&args),
        Command::Stress(args) => stress::main(&args),
        Command::Tune(args) => tune::main(&args),
        Command::Wild(args) => wild::main(&args),
        Command::Gate(args) => gate::main(&args),
        Command::Report(args) => report::main(&args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        // A reader that went away (`lamina scenes | head`) is not an error.
        Err(error) if is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            // Not `eprintln!`, which panics where stderr is closed.
            let _ = writeln!(std::io::stderr(), "lamina: {error:#}");
            ExitCode::from(if error.is::<Refused>() { 2 } else { 1 })
        }
    }
}

fn is_broken_pipe(error: &anyhow::Error) -> bool {
    let kind =
        |e: &(dyn std::error::Error + 'static)| e.downcast_ref::<std::io::Error>().map(std::io::Error::kind);
    error.chain().any(|cause| kind(cause) == Some(std::io::ErrorKind::BrokenPipe))
}
