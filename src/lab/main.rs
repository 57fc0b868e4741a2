//! The program `lamina`.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    // Before anything that might use an instruction this processor does not have.
    if let Err(sentence) = lamina2d::processor::check() {
        eprintln!("lamina: {sentence}");
        return ExitCode::from(2);
    }
    lamina2d::record::set_stamp(lamina::stamp::STAMP);
    cli::main()
}
