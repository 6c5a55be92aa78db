//! The program: SVG files and 3D models to PNG on the command line. It sees nothing but the library's public surface.

mod args;
mod completions;
mod depth_file;
mod draw;
mod files;
mod fonts;
mod gallery;
mod info;
mod json;
mod man;
mod mesh;
mod notes;
mod plan;
mod query;
mod render;
mod report;
mod reports;
mod simple;
mod size;
mod supervise;
mod wire;
mod worker;

use std::process::ExitCode;

use args::Command;
use report::{Failure, Outcome};

fn main() -> ExitCode {
    match run(args::parse()) {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::SomeFailed) => ExitCode::from(1),
        Err(failure) => {
            report::complain(&failure.to_string());
            ExitCode::from(2)
        }
    }
}

fn run(command: Command) -> Result<Outcome, Failure> {
    match command {
        Command::Render(arguments) => render::run(&arguments),
        Command::Mesh(arguments) => mesh::run(&arguments),
        Command::Gallery(arguments) => gallery::run(&arguments),
        Command::Worker(arguments) => worker::run(&arguments),
        Command::Info(arguments) => info::run(&arguments),
        Command::Completions(arguments) => completions::run(&arguments),
        Command::Man(arguments) => man::run(&arguments),
    }
}
