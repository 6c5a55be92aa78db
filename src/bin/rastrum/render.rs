//! `rastrum render`.

use std::io::{self, IsTerminal as _};
use std::panic;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;

use crate::args::RenderArguments;
use crate::draw;
use crate::fonts::{self, Fonts};
use crate::notes;
use crate::plan::{self, Job};
use crate::report::{self, Failure, Outcome};
use crate::reports::{Done, Reports};
use crate::supervise::Supervisor;
use crate::wire::{Source, Task};
use crate::worker;

/// Draws every input.
pub(crate) fn run(arguments: &RenderArguments) -> Result<Outcome, Failure> {
    let fonts = Fonts::new(&arguments.fonts)?;
    if arguments.fonts.list_fonts {
        report::print(fonts::list(&arguments.fonts).as_bytes())?;
        return Ok(Outcome::Done);
    }
    let mut jobs = plan::plan(&arguments.inputs, arguments.output.as_deref())?;
    if arguments.query_all.is_some() {
        for job in &mut jobs {
            job.output = None;
        }
    } else if jobs.iter().any(|job| job.output.is_none()) && io::stdout().is_terminal() {
        return Err(Failure::new("standard output is a terminal; pass -o FILE, or send it to a file or a program"));
    }

    notes::collect();
    // A panic is told as this program tells problems.
    panic::set_hook(Box::new(|_| {}));

    // Asking costs a tenth of a millisecond.
    let processors = || thread::available_parallelism().map_or(1, usize::from);
    let workers = if jobs.len() == 1 { 1 } else { arguments.jobs.map_or_else(processors, usize::from).min(jobs.len()) };
    let threads = arguments.threads.unwrap_or(if workers > 1 { 1 } else { 0 });
    let mut reports = Reports::new(arguments, &jobs);
    if workers == 1 {
        let mut supervisor = Supervisor::new(arguments);
        for (index, job) in jobs.iter().enumerate() {
            reports.add(index, draw(job, threads, arguments, &fonts, &mut supervisor));
        }
        return reports.finish();
    }
    let next = AtomicUsize::new(0);
    thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel();
        for _ in 0..workers {
            let sender = sender.clone();
            let (jobs, next, fonts) = (&jobs, &next, &fonts);
            let work = move || {
                let mut supervisor = Supervisor::new(arguments);
                while let Some((index, job)) = take(jobs, next) {
                    if sender.send((index, draw(job, threads, arguments, fonts, &mut supervisor))).is_err() {
                        break;
                    }
                }
            };
            thread::Builder::new()
                .spawn_scoped(scope, work)
                .map_err(|error| Failure::new(format!("no thread to draw on: {error}; try -j 1")))?;
        }
        // The channel ends when the last worker drops its sender.
        drop(sender);
        for (index, result) in receiver {
            reports.add(index, result);
        }
        Ok(())
    })?;
    reports.finish()
}

fn take<'j>(jobs: &'j [Job], next: &AtomicUsize) -> Option<(usize, &'j Job)> {
    let index = next.fetch_add(1, Ordering::Relaxed);
    Some((index, jobs.get(index)?))
}

fn draw(
    job: &Job,
    threads: usize,
    arguments: &RenderArguments,
    fonts: &Fonts<'_>,
    supervisor: &mut Supervisor<'_>,
) -> Result<Done, Failure> {
    let fail = |text: &str| Failure::new(format!("{}: {text}", job.name()));
    let source = match &job.input {
        Some(path) => Source::File(path.clone()),
        None => Source::Bytes(draw::read_input().map_err(|error| fail(&error))?),
    };
    let task = Task { source, output: job.output.clone(), threads };
    match worker::guarded(|| Ok(draw::draw_simple(&task, arguments, fonts))) {
        Ok(Some(result)) => return result.map_err(|failure| fail(failure.text())),
        Ok(None) => {}
        Err(failure) => return Err(fail(failure.text())),
    }
    supervisor.run(&task).map_err(|failure| fail(failure.text()))
}
