//! glTF accessors: numbers in buffers, every place checked.

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
fn slice<'a>(buffers: &'a [Vec<u8>], view: &gltf::buffer::View<'_>, offset: usize, length: usize) -> Result<&'a [u8]> {
    let fault = || Error::Format(format!("buffer view {} does not hold what refers to it", view.index()));
    let buffer = buffers.get(view.buffer().index()).ok_or_else(fault)?;
    let end = offset.checked_add(length).filter(|end| *end <= view.length()).ok_or_else(fault)?;
    let start = view.offset().checked_add(offset).ok_or_else(fault)?;
    buffer.get(start..view.offset().checked_add(end).ok_or_else(fault)?).ok_or_else(fault)
}

/// All values of an accessor, `N` components each; one with fewer components is padded by `fill`, more are cut off.
pub(super) fn read<const N: usize>(accessor: &Accessor<'_>, buffers: &[Vec<u8>], fill: f64) -> Result<Vec<[f64; N]>> {
    let kind = accessor.data_type();
    let (component, components) = (size_of(kind), accessor.dimensions().multiplicity());
    let (count, element) = (accessor.count(), component * components);
    let broken = |what: &str| Error::Format(format!("accessor {}: {what}", accessor.index()));
    let parse = |bytes: &[u8]| -> Option<[f64; N]> {
        let mut out = [fill; N];
        for (i, value) in out.iter_mut().enumerate().take(components) {
            *value = number(kind, bytes.get(i * component..)?, accessor.normalized())?;
        }
        Some(out)
    };
    let mut values = match accessor.view() {
        Some(view) => {
            let stride = view.stride().unwrap_or(element);
            let length = count.checked_sub(1).map_or(Some(0), |last| last.checked_mul(stride)?.checked_add(element));
            let length = length.ok_or_else(|| broken("its count is beyond the buffer"))?;
            let bytes = slice(buffers, &view, accessor.offset(), length)?;
            let mut values = Vec::with_capacity(count);
            for i in 0..count {
                let value = bytes.get(i * stride..).and_then(parse);
                values.push(value.ok_or_else(|| broken("its count is beyond the buffer"))?);
            }
            values
        }
        None => {
            // Zeros, as the specification says; no more than the file could have held.
            let all: usize = buffers.iter().map(Vec::len).sum();
            if count > all {
                return Err(broken("its count is beyond the buffers"));
            }
            vec![[0.0; N]; count]
        }
    };
    if let Some(sparse) = accessor.sparse() {
        let (indices, new) = (sparse.indices(), sparse.values());
        let size = match indices.index_type() {
            IndexType::U8 => 1,
            IndexType::U16 => 2,
            IndexType::U32 => 4,
        };
        let count = sparse.count();
        let too_many = || broken("its sparse part is beyond the buffer");
        let places = slice(buffers, &indices.view(), indices.offset(), count.checked_mul(size).ok_or_else(too_many)?)?;
        let data = slice(buffers, &new.view(), new.offset(), count.checked_mul(element).ok_or_else(too_many)?)?;
        for (place, data) in places.chunks_exact(size).zip(data.chunks_exact(element.max(1))) {
            let index = place.iter().rev().fold(0, |index, byte| index << 8 | usize::from(*byte));
            *values.get_mut(index).ok_or_else(|| broken("a sparse index is beyond its count"))? =
                parse(data).ok_or_else(too_many)?;
        }
    }
    Ok(values)
}
