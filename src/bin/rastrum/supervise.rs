//! A worker and its limits.
//!
//! Parsers recurse as deeply and work as long as a file asks them to, and a stack that overflows ends the process. So a
//! process of its own parses and draws, and this one looks at the clock and at how much memory it has.

use std::ffi::OsString;
use std::io::{self, Read as _};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

use crate::args::RenderArguments;
use crate::report::Failure;
use crate::reports::Done;
use crate::wire::{self, Task};

/// How often a worker is looked after while it works.
const INTERVAL: Duration = Duration::from_millis(10);

/// Starts workers and asks them for pictures; one at a time, kept as long as it lives.
pub(crate) struct Supervisor<'a> {
    arguments: &'a RenderArguments,
    worker: Option<Worker>,
}

struct Worker {
    child: Child,
    tasks: ChildStdin,
    answers: Receiver<io::Result<Option<Vec<u8>>>>,
}

impl<'a> Supervisor<'a> {
    pub(crate) fn new(arguments: &'a RenderArguments) -> Self {
        Self { arguments, worker: None }
    }

    /// What comes of a task, within the limits. The failure does not name the file.
    pub(crate) fn run(&mut self, task: &Task) -> Result<Done, Failure> {
        let worker = match &mut self.worker {
            Some(worker) => worker,
            none => none.insert(start()?),
        };
        let sent = task.send(&mut worker.tasks);
        let result = match sent {
            Ok(()) => worker.wait(self.arguments.max_time, self.arguments.max_memory),
            // It is dead, and why is told below; or the file's name cannot be sent.
            Err(error) => Err(Some(error.to_string())),
        };
        match result {
            Ok(bytes) => wire::read_answer(&bytes),
            Err(reason) => {
                let end = self.worker.take().map(Worker::end).unwrap_or_default();
                Err(Failure::new(reason.unwrap_or(end)))
            }
        }
    }
}

/// A worker with the same arguments as this process.
fn start() -> Result<Worker, Failure> {
    let fail = |error: io::Error| Failure::new(format!("no process to draw in: {error}"));
    let arguments: Vec<OsString> = std::env::args_os().skip(2).collect();
    let mut child = Command::new(std::env::current_exe().map_err(fail)?)
        .arg("worker")
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(fail)?;
    let (Some(tasks), Some(mut output)) = (child.stdin.take(), child.stdout.take()) else {
        return Err(Failure::new("no way to talk to the process that draws"));
    };
    let (sender, answers) = mpsc::channel();
    thread::Builder::new()
        .spawn(move || {
            loop {
                let answer = wire::receive(&mut output);
                let more = matches!(answer, Ok(Some(_)));
                if sender.send(answer).is_err() || !more {
                    break;
                }
            }
        })
        .map_err(fail)?;
    Ok(Worker { child, tasks, answers })
}

impl Worker {
    /// The next answer; or why there is none, `None` if the worker has ended.
    fn wait(&mut self, time: f64, memory: u64) -> Result<Vec<u8>, Option<String>> {
        // Longer than anyone waits: an endless limit.
        let deadline = Duration::try_from_secs_f64(time).ok().and_then(|time| Instant::now().checked_add(time));
        loop {
            match self.answers.recv_timeout(INTERVAL) {
                Ok(Ok(Some(bytes))) => return Ok(bytes),
                Ok(_) | Err(RecvTimeoutError::Disconnected) => return Err(None),
                Err(RecvTimeoutError::Timeout) => {}
            }
            if deadline.is_some_and(|deadline| Instant::now() > deadline) {
                return Err(Some(format!("took longer than {time} s and was stopped; see --max-time")));
            }
            if resident(self.child.id()).is_some_and(|bytes| bytes > memory) {
                let mebibytes = memory >> 20;
                return Err(Some(format!(
                    "took more than {mebibytes} MiB of memory and was stopped; see --max-memory"
                )));
            }
        }
    }

    /// Ends it, if it has not ended yet, and says how it did.
    fn end(mut self) -> String {
        // Where it has ended already, there is nothing to kill.
        let ended = self.child.try_wait().ok().flatten().is_some();
        let _ = self.child.kill();
        let mut said = String::new();
        if let Some(errors) = self.child.stderr.take() {
            let _ = errors.take(1 << 16).read_to_string(&mut said);
        }
        let status = self.child.wait().map(|status| status.to_string()).unwrap_or_default();
        if said.contains("overflowed its stack") {
            "nests or repeats itself too deeply: the stack ran out".to_owned()
        } else if said.contains("memory allocation of") {
            "memory ran out".to_owned()
        } else if let Some(line) = said.lines().find_map(|line| line.strip_prefix("rastrum: ")) {
            line.to_owned()
        } else if ended {
            format!("the process that drew it ended ({status})")
        } else {
            "the process that drew it does not answer".to_owned()
        }
    }
}

impl Drop for Supervisor<'_> {
    fn drop(&mut self) {
        if let Some(Worker { mut child, tasks, .. }) = self.worker.take() {
            // Without more tasks it ends by itself.
            drop(tasks);
            let _ = child.wait();
        }
    }
}

/// Bytes of memory that a process has, where the system tells.
#[cfg(target_os = "linux")]
fn resident(process: u32) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes << 10)
}

#[cfg(not(target_os = "linux"))]
fn resident(_: u32) -> Option<u64> {
    None
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn this_process_has_some_memory() {
        let bytes = resident(std::process::id()).unwrap();
        assert!((1 << 20..1 << 40).contains(&bytes), "{bytes}");
        assert_eq!(resident(u32::MAX), None);
    }
}
