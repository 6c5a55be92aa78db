//! What a model may take: files can name the same data as often as they like, or name much with few bytes.

use crate::error::{Error, Result};

/// The bytes that a model may take, by the size of its files.
pub(super) struct Budget {
    most: usize,
    files: usize,
    taken: usize,
}

impl Budget {
    /// Bytes for each byte of the files.
    const FACTOR: usize = 64;
    /// What small files may take, too.
    const LEAST: usize = 64 << 20;
    /// What one picture may take while it is decoded: 4096 × 4096 pixels and their copy.
    const PICTURE: usize = 128 << 20;
    /// A vertex as it is kept and as it is drawn.
    const VERTEX: usize = 160;

    /// The budget of a file of so many bytes.
    pub(super) fn new(bytes: usize) -> Self {
        let mut budget = Self { most: 0, files: 0, taken: 0 };
        budget.add_file(bytes);
        budget
    }

    /// Counts another file that belongs to the model; each once.
    pub(super) fn add_file(&mut self, bytes: usize) {
        self.files = self.files.saturating_add(bytes);
        self.most = self.files.saturating_mul(Self::FACTOR).max(Self::LEAST);
    }

    /// The bytes that are left.
    pub(super) fn left(&self) -> usize {
        self.most.saturating_sub(self.taken)
    }

    /// The bytes that a picture may take while it is decoded.
    pub(super) fn for_decoding(&self) -> usize {
        self.left().max(Self::PICTURE)
    }

    /// Takes bytes for what the files name as `what`.
    ///
    /// # Errors
    /// [`Error::Limit`] where so many are not left.
    pub(super) fn take(&mut self, bytes: usize, what: &str) -> Result<()> {
        if bytes > self.left() {
            return Err(Error::Limit(format!("{what} take more than {} times the size of its files", Self::FACTOR)));
        }
        self.taken += bytes;
        Ok(())
    }

    /// Takes what `count` things of `each` bytes take, named as `what`.
    ///
    /// # Errors
    /// As [`take`](Self::take).
    pub(super) fn take_each(&mut self, count: usize, each: usize, what: &str) -> Result<()> {
        self.take(count.saturating_mul(each), what)
    }

    /// Takes what a mesh takes.
    ///
    /// # Errors
    /// As [`take`](Self::take).
    pub(super) fn take_mesh(&mut self, vertices: usize, indices: usize) -> Result<()> {
        let bytes = vertices.saturating_mul(Self::VERTEX).saturating_add(indices.saturating_mul(4));
        self.take(bytes, "its meshes name the same data so often that they")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sixty_four_times_the_files_and_a_least() {
        let mut budget = Budget::new(10);
        assert_eq!(budget.left(), 64 << 20);
        budget.add_file((2 << 20) - 10);
        assert_eq!(budget.left(), 128 << 20);
        budget.take(127 << 20, "they").unwrap();
        let error = budget.take((1 << 20) + 1, "they").unwrap_err();
        assert_eq!(error.to_string(), "they take more than 64 times the size of its files");
        budget.take(1 << 20, "they").unwrap();
        assert_eq!((budget.left(), budget.for_decoding()), (0, 128 << 20));
        assert!(budget.take_each(usize::MAX, 2, "they").is_err() && budget.take_mesh(usize::MAX, 1).is_err());
    }
}
