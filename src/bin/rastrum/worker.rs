//! The process that parses and draws: what happens to it is told by the one that started it.
//!
//! It takes tasks from standard input and answers on standard output ([`wire`](crate::wire)), one after another. When standard
//! input ends, whatever is going on, it ends: no work goes on that nobody waits for.

use std::any::Any;
use std::io;
use std::panic::{self, AssertUnwindSafe};
use std::sync::mpsc;
use std::thread;

use crate::args::RenderArguments;
use crate::draw;
use crate::fonts::Fonts;
use crate::notes;
use crate::report::{Failure, Outcome};
use crate::wire::{self, Task};

/// Stack of the thread that parses: usvg recurses into nested elements. Untouched pages cost nothing.
const STACK: usize = 64 << 20;

pub(crate) fn run(arguments: &RenderArguments) -> Result<Outcome, Failure> {
    notes::collect();
    // A panic is told as this program tells problems.
    panic::set_hook(Box::new(|_| {}));
    let fonts = Fonts::new(&arguments.fonts)?;
    let (sender, tasks) = mpsc::channel::<Task>();
    thread::scope(|scope| {
        let work = || {
            for task in tasks {
                let answer = guarded(|| draw::draw(&task, arguments, &fonts));
                if wire::send_answer(&answer, &mut io::stdout().lock()).is_err() {
                    std::process::exit(2);
                }
            }
        };
        thread::Builder::new()
            .stack_size(STACK)
            .spawn_scoped(scope, work)
            .map_err(|error| Failure::new(format!("no thread to draw on: {error}")))?;
        while let Ok(Some(bytes)) = wire::receive(&mut io::stdin().lock()) {
            if sender.send(Task::read(&bytes)).is_err() {
                break;
            }
        }
        // Not by returning, which would wait for the drawing.
        std::process::exit(0)
    })
}

/// Runs `work`; a panic in it, which is this program's fault, becomes a failure like any other.
pub(crate) fn guarded<T>(work: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
    panic::catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|payload: Box<dyn Any + Send>| {
        let text = payload.downcast_ref::<&str>().map(ToString::to_string);
        let text = text.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_default();
        Err(Failure::new(format!("an internal error, not the file's fault: {text}; please report it")))
    })
}
