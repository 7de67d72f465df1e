//! Command-line program; see [`sir_cli`].

fn main() -> std::process::ExitCode {
    sir_cli::main()
}
