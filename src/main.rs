//! The `rigidtap` command. Everything it does is in [`rigidtap::cli`].

fn main() -> std::process::ExitCode {
    rigidtap::cli::run()
}
