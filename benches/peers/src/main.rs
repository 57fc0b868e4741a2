//! The program `lamina-peers`.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
