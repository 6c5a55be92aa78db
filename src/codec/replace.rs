//! Files that are written beside their target and renamed.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write as _};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// Bytes that go to the system at a time.
const BUFFER: usize = 1 << 16;

/// Writes to `path` what `write` gives, such that the old content stays until the new is complete.
pub(super) fn replace(path: &Path, write: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>) -> io::Result<()> {
    let old = fs::metadata(path);
    let fill = |file: &File| {
        let mut buffered = BufWriter::with_capacity(BUFFER, file);
        write(&mut buffered)?;
        buffered.flush()
    };
    if let Ok(old) = &old {
        if !old.is_file() {
            return fill(&File::create(path)?);
        }
        if old.permissions().readonly() {
            return Err(io::Error::new(io::ErrorKind::PermissionDenied, "the file is read-only"));
        }
    }
    // Through a symbolic link the file is replaced that it points to, not the link.
    let target = if old.is_ok() { fs::canonicalize(path)? } else { path.to_owned() };
    let (beside, file) = create_beside(&target)?;
    let written = fill(&file).and_then(|()| match &old {
        Ok(old) => file.set_permissions(old.permissions()),
        Err(_) => Ok(()),
    });
    drop(file);
    let done = written.and_then(|()| fs::rename(&beside, &target));
    if done.is_err() {
        // The first error is the one worth telling.
        let _ = fs::remove_file(&beside);
    }
    done
}

/// A new file in the folder of `target`, with a hidden name that no other process or thread takes.
fn create_beside(target: &Path) -> io::Result<(PathBuf, File)> {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let name =
        target.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "not the name of a file"))?;
    let mut tries = 0;
    loop {
        let mut hidden = OsString::from(".");
        hidden.push(name);
        hidden.push(format!(".{}-{}.part", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
        let path = target.with_file_name(hidden);
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Ok(file) => return Ok((path, file)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && tries < 100 => tries += 1,
            Err(error) => return Err(error),
        }
    }
}
