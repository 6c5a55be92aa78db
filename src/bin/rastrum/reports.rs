//! What `rastrum render` says while it works and when it is done.

use std::io::{self, Write as _};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::args::{QueryFormat, RenderArguments};
use crate::json;
use crate::plan::Job;
use crate::report::{self, Failure, Outcome};

/// What is told of a picture that was drawn.
pub(crate) struct Done {
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// Reading, unpacking, parsing, and the fonts if this file was the first to need them.
    pub(crate) parse: Duration,
    pub(crate) draw: Duration,
    /// Encoding and writing.
    pub(crate) encode: Duration,
    pub(crate) warnings: Vec<String>,
    /// What goes to standard output.
    pub(crate) output: Vec<u8>,
}

/// Takes results in any order.
pub(crate) struct Reports<'a> {
    arguments: &'a RenderArguments,
    jobs: &'a [Job],
    bar: ProgressBar,
    /// Lines of `--timings`, in the order of the jobs.
    timings: Vec<Option<String>>,
    /// What goes to standard output, in the order of the jobs.
    outputs: Vec<Vec<u8>>,
    /// The failure of the only job, or how many of several failed.
    failure: Option<Failure>,
    failed: usize,
}

impl<'a> Reports<'a> {
    pub(crate) fn new(arguments: &'a RenderArguments, jobs: &'a [Job]) -> Self {
        let bar = if jobs.len() > 1 && !arguments.quiet {
            // Hidden by itself where standard error is no terminal.
            let bar = ProgressBar::with_draw_target(Some(jobs.len() as u64), ProgressDrawTarget::stderr());
            let style = ProgressStyle::with_template("{bar:32} {pos}/{len} {msg}");
            bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
        } else {
            ProgressBar::hidden()
        };
        Self {
            arguments,
            jobs,
            bar,
            timings: vec![None; jobs.len()],
            outputs: vec![Vec::new(); jobs.len()],
            failure: None,
            failed: 0,
        }
    }

    /// Tells how one job ended.
    pub(crate) fn add(&mut self, index: usize, result: Result<Done, Failure>) {
        let Some(job) = self.jobs.get(index) else { return };
        match result {
            Ok(done) => {
                if !self.arguments.quiet {
                    for warning in &done.warnings {
                        self.say(&Failure::new(format!("{}: warning: {warning}", job.name())));
                    }
                }
                if self.arguments.verbose {
                    self.say(&Failure::new(summary(job, &done)));
                }
                let labelled = self.labelled(job, &done);
                if let Some(output) = self.outputs.get_mut(index) {
                    *output = labelled;
                }
                if self.arguments.timings.is_some()
                    && let Some(line) = self.timings.get_mut(index)
                {
                    *line = Some(timing(job, &done));
                }
            }
            Err(failure) if self.jobs.len() == 1 => self.failure = Some(failure),
            Err(failure) => {
                self.failed += 1;
                self.say(&failure);
            }
        }
        self.bar.inc(1);
    }

    /// Tells what is told at the end.
    pub(crate) fn finish(self) -> Result<Outcome, Failure> {
        self.bar.finish_and_clear();
        for output in self.outputs.iter().filter(|output| !output.is_empty()) {
            report::print(output)?;
        }
        let lines: String = self.timings.iter().flatten().map(String::as_str).collect();
        if !lines.is_empty() {
            if self.jobs.iter().any(|job| job.output.is_none()) {
                let _ = io::stderr().write_all(lines.as_bytes());
            } else {
                report::print(lines.as_bytes())?;
            }
        }
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        if self.failed > 0 {
            report::complain(&format!("{} of {} files failed", self.failed, self.jobs.len()));
            return Ok(Outcome::SomeFailed);
        }
        Ok(Outcome::Done)
    }

    /// What goes to standard output: of one input as it is, of several with their names.
    fn labelled(&self, job: &Job, done: &Done) -> Vec<u8> {
        match self.arguments.query_all {
            Some(format) if self.jobs.len() > 1 => {
                let text = String::from_utf8_lossy(&done.output);
                let name = job.name();
                match format {
                    QueryFormat::Text => text.lines().map(|line| format!("{name}:{line}\n")).collect(),
                    QueryFormat::Json => {
                        format!("{{\"input\":{},\"elements\":{}}}\n", json::string(&name), text.trim_end())
                    }
                }
                .into_bytes()
            }
            _ => done.output.clone(),
        }
    }

    fn say(&self, line: &Failure) {
        self.bar.suspend(|| report::complain(&line.to_string()));
    }
}

fn milliseconds(time: Duration) -> String {
    format!("{:.3}", time.as_secs_f64() * 1000.0)
}

fn output(job: &Job) -> String {
    job.output.as_ref().map_or_else(|| "-".to_owned(), |path| path.display().to_string())
}

fn summary(job: &Job, done: &Done) -> String {
    format!(
        "{} → {}: {} × {} pixels; parsed in {} ms, drawn in {} ms, written in {} ms",
        job.name(),
        output(job),
        done.width,
        done.height,
        milliseconds(done.parse),
        milliseconds(done.draw),
        milliseconds(done.encode)
    )
}

fn timing(job: &Job, done: &Done) -> String {
    let input = job.input.as_ref().map_or_else(|| "-".to_owned(), |path| path.display().to_string());
    format!(
        "{{\"input\":{},\"output\":{},\"width\":{},\"height\":{},\"parse_ms\":{},\"draw_ms\":{},\"encode_ms\":{},\"warnings\":{}}}\n",
        json::string(&input),
        json::string(&output(job)),
        done.width,
        done.height,
        milliseconds(done.parse),
        milliseconds(done.draw),
        milliseconds(done.encode),
        json::strings(done.warnings.iter().map(String::as_str)),
    )
}
