//! The program `lamina`.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    // Before anything that might use an instruction this processor does not have.
    if let Err(sentence) = cli::processor::check() {
        eprintln!("{sentence}");
        return ExitCode::from(2);
    }
    cli::main()
}
