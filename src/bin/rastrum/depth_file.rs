//! `rastrum mesh --depth-out`: depths as 32-bit floats.

use std::path::Path;

/// The bytes of a file of depths, rows top down, in the format that its name asks for: NumPy (.npy, an array of height × width), PFM
/// (.pfm, whose rows are bottom up), or else the floats alone; little endian.
pub(crate) fn encode(path: &Path, width: u32, height: u32, depths: &[f32]) -> Vec<u8> {
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    let floats = |row: &[f32]| -> Vec<u8> { row.iter().flat_map(|depth| depth.to_le_bytes()).collect() };
    match ending.as_ref().and_then(|ending| ending.to_str()) {
        Some("npy") => {
            let mut text = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({height}, {width}), }}");
            // Ten bytes before it, and a line break after it, are to be a multiple of 64.
            text.push_str(&" ".repeat(63 - (text.len() + 10) % 64));
            text.push('\n');
            let mut out = b"\x93NUMPY\x01\x00".to_vec();
            out.extend((text.len() as u16).to_le_bytes());
            out.extend(text.into_bytes());
            out.extend(floats(depths));
            out
        }
        Some("pfm") => {
            let mut out = format!("Pf\n{width} {height}\n-1.0\n").into_bytes();
            for row in depths.chunks(width.max(1) as usize).rev() {
                out.extend(floats(row));
            }
            out
        }
        _ => floats(depths),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_are_those_of_the_formats() {
        let depths = [0.0, 1.0, 0.5, 0.25, 0.75, 1.0];
        let raw = encode(Path::new("d"), 3, 2, &depths);
        let npy = encode(Path::new("d.NPY"), 3, 2, &depths);
        assert!(npy.starts_with(b"\x93NUMPY\x01\x00") && npy.len() % 64 == 24 && npy.ends_with(&raw));
        assert_eq!(npy[8..10], ((npy.len() - 24 - 10) as u16).to_le_bytes());
        assert_eq!(npy[npy.len() - 25], b'\n');
        let pfm = encode(Path::new("d.pfm"), 3, 2, &depths);
        assert!(pfm.starts_with(b"Pf\n3 2\n-1.0\n"));
        assert_eq!(pfm[12..], [&raw[12..], &raw[..12]].concat());
    }
}
