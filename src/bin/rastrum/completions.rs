//! `rastrum completions`.

use clap::CommandFactory as _;

use crate::args::{Arguments, CompletionsArguments};
use crate::report::{self, Failure, Outcome};

pub(crate) fn run(arguments: &CompletionsArguments) -> Result<Outcome, Failure> {
    // Into memory first: the generator panics where its writer fails.
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "rastrum", &mut script);
    report::print(&script)?;
    Ok(Outcome::Done)
}
