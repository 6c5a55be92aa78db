//! glTF accessors: numbers in buffers, every place checked.

use std::sync::Arc;

use gltf::accessor::{Accessor, DataType, sparse::IndexType};

use crate::error::{Error, Result};

/// The bytes of one component.
fn size_of(kind: DataType) -> usize {
    match kind {
        DataType::I8 | DataType::U8 => 1,
        DataType::I16 | DataType::U16 => 2,
        DataType::U32 | DataType::F32 => 4,
    }
}

/// One component as a number; normalised integers to −1 ..= 1 or 0 ..= 1.
fn number(kind: DataType, bytes: &[u8], normalized: bool) -> Option<f64> {
    let scaled = |v: f64, most: f64| if normalized { (v / most).max(-1.0) } else { v };
    Some(match kind {
        DataType::I8 => scaled(f64::from(i8::from_le_bytes(*bytes.first_chunk()?)), 127.0),
        DataType::U8 => scaled(f64::from(*bytes.first()?), 255.0),
        DataType::I16 => scaled(f64::from(i16::from_le_bytes(*bytes.first_chunk()?)), 32_767.0),
        DataType::U16 => scaled(f64::from(u16::from_le_bytes(*bytes.first_chunk()?)), 65_535.0),
        DataType::U32 => f64::from(u32::from_le_bytes(*bytes.first_chunk()?)),
        DataType::F32 => f64::from(f32::from_le_bytes(*bytes.first_chunk()?)),
    })
}

/// The bytes of `length` at `offset` of a view.
fn slice<'a>(
    buffers: &'a [Arc<Vec<u8>>],
    view: &gltf::buffer::View<'_>,
    offset: usize,
    length: usize,
) -> Result<&'a [u8]> {
    let fault = || Error::Format(format!("buffer view {} does not hold what refers to it", view.index()));
    let buffer = buffers.get(view.buffer().index()).ok_or_else(fault)?;
    let end = offset.checked_add(length).filter(|end| *end <= view.length()).ok_or_else(fault)?;
    let start = view.offset().checked_add(offset).ok_or_else(fault)?;
    buffer.get(start..view.offset().checked_add(end).ok_or_else(fault)?).ok_or_else(fault)
}

/// An accessor whose values can be had one by one: several primitives may use parts of the same one.
pub(super) struct Values<'a> {
    kind: DataType,
    normalized: bool,
    components: usize,
    count: usize,
    stride: usize,
    /// `None` stands for zeros.
    bytes: Option<&'a [u8]>,
    /// Sparse values in the order of their places.
    replaced: Vec<(usize, &'a [u8])>,
}

impl<'a> Values<'a> {
    /// Checks that all of an accessor lies in its buffers.
    pub(super) fn new(accessor: &Accessor<'_>, buffers: &'a [Arc<Vec<u8>>]) -> Result<Self> {
        let kind = accessor.data_type();
        let (component, components) = (size_of(kind), accessor.dimensions().multiplicity());
        let (count, element) = (accessor.count(), component * components);
        let broken = |what: &str| Error::Format(format!("accessor {}: {what}", accessor.index()));
        let mut stride = element;
        let bytes = match accessor.view() {
            Some(view) => {
                stride = view.stride().unwrap_or(element);
                let length =
                    count.checked_sub(1).map_or(Some(0), |last| last.checked_mul(stride)?.checked_add(element));
                let length = length.ok_or_else(|| broken("its count is beyond the buffer"))?;
                Some(slice(buffers, &view, accessor.offset(), length)?)
            }
            None => {
                // Zeros, as the specification says; no more than the file could have held.
                if count > buffers.iter().map(|buffer| buffer.len()).sum() {
                    return Err(broken("its count is beyond the buffers"));
                }
                None
            }
        };
        let mut replaced = Vec::new();
        if let Some(sparse) = accessor.sparse() {
            let (indices, new) = (sparse.indices(), sparse.values());
            let size = match indices.index_type() {
                IndexType::U8 => 1,
                IndexType::U16 => 2,
                IndexType::U32 => 4,
            };
            let many = sparse.count();
            let too_many = || broken("its sparse part is beyond the buffer");
            let places =
                slice(buffers, &indices.view(), indices.offset(), many.checked_mul(size).ok_or_else(too_many)?)?;
            let data = slice(buffers, &new.view(), new.offset(), many.checked_mul(element).ok_or_else(too_many)?)?;
            for (place, data) in places.chunks_exact(size).zip(data.chunks_exact(element.max(1))) {
                let index = place.iter().rev().fold(0, |index, byte| index << 8 | usize::from(*byte));
                if index >= count {
                    return Err(broken("a sparse index is beyond its count"));
                }
                replaced.push((index, data));
            }
            replaced.sort_by_key(|(index, _)| *index);
        }
        Ok(Self { kind, normalized: accessor.normalized(), components, count, stride, bytes, replaced })
    }

    /// Indices: one whole number each.
    pub(super) fn of_indices(accessor: &Accessor<'_>, buffers: &'a [Arc<Vec<u8>>]) -> Result<Self> {
        let values = Self::new(accessor, buffers)?;
        if values.components != 1 || !matches!(values.kind, DataType::U8 | DataType::U16 | DataType::U32) {
            return Err(Error::Format(format!("accessor {}: indices must be unsigned integers", accessor.index())));
        }
        Ok(values)
    }

    pub(super) fn len(&self) -> usize {
        self.count
    }

    /// A value, `N` components of it; where it has fewer, `fill` stands for the others, more are cut off.
    pub(super) fn get<const N: usize>(&self, index: usize, fill: f64) -> Option<[f64; N]> {
        if index >= self.count {
            return None;
        }
        let own = self.replaced.binary_search_by_key(&index, |(place, _)| *place);
        let bytes = match (own.ok().and_then(|i| self.replaced.get(i)), self.bytes) {
            (Some((_, bytes)), _) => bytes,
            (None, Some(bytes)) => bytes.get(index * self.stride..)?,
            (None, None) => return Some([0.0; N]),
        };
        let mut out = [fill; N];
        for (i, value) in out.iter_mut().enumerate().take(self.components) {
            *value = number(self.kind, bytes.get(i * size_of(self.kind)..)?, self.normalized)?;
        }
        Some(out)
    }
}
