//! `rastrum man`.

use clap::CommandFactory as _;

use crate::args::{Arguments, ManArguments};
use crate::report::{self, Failure, Outcome};

pub(crate) fn run(arguments: &ManArguments) -> Result<Outcome, Failure> {
    let mut command = Arguments::command();
    // Gives the subcommands their full names, such as `rastrum-render`.
    command.build();
    let page = match &arguments.subcommand {
        None => command,
        Some(name) => command
            .find_subcommand(name)
            .ok_or_else(|| Failure::new(format!("man: no subcommand '{name}'; see `rastrum --help`")))?
            .clone(),
    };
    let mut text = Vec::new();
    clap_mangen::Man::new(page).render(&mut text).map_err(|error| Failure::new(format!("man: {error}")))?;
    report::print(&text)?;
    Ok(Outcome::Done)
}
