//! Peak memory of one picture beyond what was there before it: the recording and the engine's working memory.
//!
//! Measured in a process of its own for each engine and workload, from the kernel's high-water mark of resident memory,
//! which can be set back; Linux alone has that. The target is allocated and touched before.

use std::process::Command;

use crate::engines::Engine;

/// Runs this program again to draw one picture and read its peak, in MiB; `None` where that is not possible.
pub fn in_child(workload: &str, engine: &str, svg_real: Option<&std::path::Path>) -> Option<f64> {
    let mut command = Command::new(std::env::current_exe().ok()?);
    command.args(["--peak-of", workload, "--engine", engine]);
    if let Some(folder) = svg_real {
        command.arg("--svg-real").arg(folder);
    }
    // What is freed goes back to the system at once, so that the picture cannot live in what preparing it left.
    command.env("MALLOC_MMAP_THRESHOLD_", "65536").env("MALLOC_TRIM_THRESHOLD_", "0");
    let output = command.output().ok()?;
    String::from_utf8(output.stdout).ok()?.trim().parse().ok()
}

/// The peak of drawing one picture, in MiB.
pub fn of(engine: &mut dyn Engine) -> Option<f64> {
    std::fs::write("/proc/self/clear_refs", "5").ok()?;
    let before = status("VmRSS:")?;
    engine.draw();
    let peak = status("VmHWM:")?;
    Some((peak - before).max(0.0) / 1024.0)
}

/// A line of the process's status, in KiB.
fn status(key: &str) -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    status.lines().find_map(|line| line.strip_prefix(key)?.trim().strip_suffix("kB")?.trim().parse().ok())
}
