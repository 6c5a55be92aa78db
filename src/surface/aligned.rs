//! Bytes that begin where a cache line does.

use std::ops::{Deref, DerefMut};

use crate::error::{Error, Result};

/// Zero bytes, or an error where the system has no memory for them.
pub(crate) fn allocate(length: usize) -> Result<Vec<u8>> {
    let mut data = Vec::new();
    data.try_reserve_exact(length).map_err(|_| Error::Limit(format!("no memory for {length} bytes of pixels")))?;
    data.resize(length, 0);
    Ok(data)
}

/// Bytes whose first lies at a multiple of 64, so that no vector of 64 straddles two cache lines; those that came as a `Vec` stay
/// where they are.
///
/// A `Vec` of larger items would be simpler, but could not become a `Vec<u8>`.
#[derive(Debug)]
pub(crate) struct AlignedBytes {
    data: Vec<u8>,
    /// What lies before it belongs to nobody.
    start: usize,
}

impl AlignedBytes {
    /// A cache line's bytes.
    const LINE: usize = 64;

    /// `length` zeros.
    pub(crate) fn zeros(length: usize) -> Result<Self> {
        let mut data = allocate(length.saturating_add(Self::LINE - 1))?;
        // Where it cannot be told, it is not aligned, and nothing else is different.
        let start = data.as_ptr().align_offset(Self::LINE).min(Self::LINE - 1);
        data.truncate(start + length);
        Ok(Self { data, start })
    }

    /// The bytes as a vector: moved to its front.
    pub(crate) fn into_vec(mut self) -> Vec<u8> {
        self.data.drain(..self.start);
        self.data
    }
}

impl From<Vec<u8>> for AlignedBytes {
    fn from(data: Vec<u8>) -> Self {
        Self { data, start: 0 }
    }
}

impl Deref for AlignedBytes {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        self.data.get(self.start..).unwrap_or(&[])
    }
}

impl DerefMut for AlignedBytes {
    fn deref_mut(&mut self) -> &mut [u8] {
        self.data.get_mut(self.start..).unwrap_or(&mut [])
    }
}

impl Clone for AlignedBytes {
    fn clone(&self) -> Self {
        match Self::zeros(self.len()) {
            Ok(mut copy) => {
                copy.copy_from_slice(self);
                copy
            }
            // As any clone does without memory.
            Err(_) => Self::from(self.to_vec()),
        }
    }
}

impl PartialEq for AlignedBytes {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl Eq for AlignedBytes {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_begin_at_a_cache_line_and_come_back_as_they_were() {
        for length in [0, 1, 63, 64, 4000, 100_000] {
            let mut bytes = AlignedBytes::zeros(length).unwrap();
            assert_eq!((bytes.len(), bytes.iter().all(|b| *b == 0)), (length, true));
            for (index, byte) in bytes.iter_mut().enumerate() {
                *byte = (index * 7) as u8;
            }
            let copy = bytes.clone();
            assert!(copy == bytes && AlignedBytes::from(bytes.to_vec()) == bytes, "{length}");
            for bytes in [&bytes, &copy] {
                assert_eq!(bytes.as_ptr() as usize % 64, 0, "{length}");
            }
            let expected: Vec<u8> = (0..length).map(|index| (index * 7) as u8).collect();
            assert_eq!(bytes.into_vec(), expected);
        }
    }

    #[test]
    fn what_there_is_no_memory_for_is_an_error() {
        assert!(matches!(AlignedBytes::zeros(usize::MAX), Err(Error::Limit(_))));
        assert!(matches!(AlignedBytes::zeros(isize::MAX as usize), Err(Error::Limit(_))));
    }
}
