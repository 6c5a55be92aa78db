//! Jobs on threads.

/// Runs `work` on every job, on up to `threads` threads; returns when all are done.
#[cfg(feature = "parallel")]
pub(crate) fn for_each<T: Send>(threads: usize, jobs: Vec<T>, work: impl Fn(T) + Sync) {
    use rayon::prelude::*;

    if threads <= 1 || jobs.len() <= 1 {
        jobs.into_iter().for_each(work);
        return;
    }
    match pool(threads) {
        // One job at a time: a band that is slow must not hold back its neighbours.
        Some(pool) => pool.install(|| jobs.into_par_iter().with_max_len(1).for_each(&work)),
        None => jobs.into_iter().for_each(work),
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
