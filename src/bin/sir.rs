//! The command-line program; everything it does is in [`sir_cli`].

fn main() -> std::process::ExitCode {
    sir_cli::main()
}
