//! What usvg leaves out while it parses, and says through the `log` crate.
//!
//! A file is parsed on one thread, so that what is logged on a thread belongs to the file that it
//! works on.

use std::cell::RefCell;

thread_local! {
    static NOTES: RefCell<Vec<String>> = const { RefCell::new(Vec::new()) };
}

/// A broken file may be warned of a million times over.
const MOST: usize = 100;

struct Collector;

impl log::Log for Collector {
    fn enabled(&self, metadata: &log::Metadata<'_>) -> bool {
        // fontdb logs every damaged font of the system, whether or not it is used.
        metadata.level() <= log::Level::Warn && metadata.target().starts_with("usvg")
    }

    fn log(&self, record: &log::Record<'_>) {
        if self.enabled(record.metadata()) {
            add(record.args().to_string());
        }
    }

    fn flush(&self) {}
}

/// Begins to collect, for the whole process.
pub(crate) fn collect() {
    static COLLECTOR: Collector = Collector;
    if log::set_logger(&COLLECTOR).is_ok() {
        log::set_max_level(log::LevelFilter::Warn);
    }
}

/// Adds one thing that was left out.
pub(crate) fn add(note: String) {
    NOTES.with_borrow_mut(|notes| {
        if notes.len() < MOST && !notes.contains(&note) {
            notes.push(note);
        }
    });
}

/// What was said on this thread since the last call, each thing once, at most 100.
pub(crate) fn take() -> Vec<String> {
    NOTES.with_borrow_mut(std::mem::take)
}
