//! Jobs on threads.

use std::sync::OnceLock;
#[cfg(feature = "parallel")]
use std::sync::atomic::{AtomicUsize, Ordering};

/// How often helpers were called: those that linger see that they are wanted.
#[cfg(feature = "parallel")]
static CALLS: AtomicUsize = AtomicUsize::new(0);

/// The threads that a setting stands for: 0 for one per core, never more than 1024.
pub(crate) fn threads(wanted: usize) -> usize {
    match wanted {
        0 => cores(),
        wanted => wanted.min(1024),
    }
}

/// How many threads can run at once: asked once, as files are read to answer it, for 50 µs on Linux.
fn cores() -> usize {
    static CORES: OnceLock<usize> = OnceLock::new();
    *CORES.get_or_init(|| std::thread::available_parallelism().map_or(1, usize::from))
}

/// Runs `work` on every job, on up to `threads` threads, of which the caller's is one; returns when all are done.
#[cfg(feature = "parallel")]
pub(crate) fn for_each<T: Send>(threads: usize, jobs: Vec<T>, work: impl Fn(T) + Sync) {
    use std::sync::Mutex;

    let helpers = threads.min(jobs.len()).saturating_sub(1);
    let pool = if helpers > 0 { pool(threads - 1) } else { None };
    let Some(pool) = pool else { return jobs.into_iter().for_each(work) };
    // One job at a time: a band that is slow must not hold back its neighbours. The caller starts at once, and is not
    // kept waiting by helpers that are still asleep.
    let queue = Mutex::new(jobs.into_iter());
    // From both ends, so that from frame to frame most jobs fall to the core whose caches hold what they work on.
    let next = |worker: usize| {
        let mut queue = queue.lock().ok()?;
        if worker.is_multiple_of(2) { queue.next() } else { queue.next_back() }
    };
    let run = |worker: usize| {
        while let Some(job) = next(worker) {
            work(job);
        }
    };
    let call = CALLS.fetch_add(1, Ordering::Relaxed) + 1;
    let done = AtomicUsize::new(0);
    let (run, done) = (&run, &done);
    pool.in_place_scope(|scope| {
        for worker in 1..=helpers {
            scope.spawn(move |_| {
                run(worker);
                done.fetch_add(1, Ordering::Release);
                // A frame calls twice in a row.
                rayon::spawn(move || linger(|| CALLS.load(Ordering::Relaxed) != call));
            });
        }
        run(0);
        linger(|| done.load(Ordering::Acquire) == helpers);
    });
}

/// Offers a job to a helper, if `threads` has room for one, and returns at once. It may come late or never to it: jobs are such
/// as the caller does where nobody has, and say whether they were in time.
#[cfg(feature = "parallel")]
pub(crate) fn offer(threads: usize, job: impl FnOnce() -> bool + Send + 'static) {
    if threads > 1
        && let Some(pool) = pool(threads - 1)
    {
        let call = CALLS.fetch_add(1, Ordering::Relaxed) + 1;
        pool.spawn(move || {
            // Another will follow, or the frame's end.
            if job() {
                linger(|| CALLS.load(Ordering::Relaxed) != call);
            }
        });
    }
}

/// There are no helpers.
#[cfg(not(feature = "parallel"))]
pub(crate) fn offer(_threads: usize, _job: impl FnOnce() -> bool) {}

/// Waits awake until `ready` says so, for as long as it would take to fall asleep and be woken: 50 µs. A picture of a
/// millisecond has three such moments.
#[cfg(feature = "parallel")]
fn linger(ready: impl Fn() -> bool) {
    use std::time::{Duration, Instant};

    const LONGEST: Duration = Duration::from_micros(50);
    let start = Instant::now();
    while !ready() && start.elapsed() < LONGEST {
        std::hint::spin_loop();
    }
}

/// Runs `work` on every job.
#[cfg(not(feature = "parallel"))]
pub(crate) fn for_each<T>(_threads: usize, jobs: Vec<T>, work: impl Fn(T)) {
    jobs.into_iter().for_each(work);
}

/// The pool of the given size. Pools are made once and kept: starting threads costs more than a small frame.
#[cfg(feature = "parallel")]
fn pool(threads: usize) -> Option<std::sync::Arc<rayon::ThreadPool>> {
    use std::sync::{Arc, Mutex};
    static POOLS: Mutex<Vec<(usize, Arc<rayon::ThreadPool>)>> = Mutex::new(Vec::new());

    let mut pools = POOLS.lock().ok()?;
    if let Some((_, pool)) = pools.iter().find(|(size, _)| *size == threads) {
        return Some(Arc::clone(pool));
    }
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .thread_name(|index| format!("rastrum {index}"))
        .build()
        .ok()?;
    let pool = Arc::new(pool);
    pools.push((threads, Arc::clone(&pool)));
    Some(pool)
}

#[cfg(all(test, feature = "parallel"))]
mod tests {
    use std::sync::mpsc::{RecvTimeoutError, channel};
    use std::time::Duration;

    use super::*;

    #[test]
    fn offers_are_taken_up_by_helpers_alone() {
        let (done, all) = channel();
        let caller = std::thread::current().id();
        let (first, second) = (done.clone(), done);
        offer(2, move || first.send((1, std::thread::current().id())).is_ok());
        // One thread has no helper: the job is dropped.
        offer(1, move || second.send((2, std::thread::current().id())).is_ok());
        let (number, thread) = all.recv_timeout(Duration::from_secs(60)).unwrap();
        assert!(number == 1 && thread != caller);
        assert_eq!(all.recv_timeout(Duration::from_secs(60)), Err(RecvTimeoutError::Disconnected));
    }
}
