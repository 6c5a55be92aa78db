//! Seeded numbers: the same geometry on every machine and in every run.

/// SplitMix64 (Steele, Lea, Flood: Fast Splittable Pseudorandom Number Generators, 2014).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In `low .. high`, uniform.
    pub fn within(&mut self, low: f32, high: f32) -> f32 {
        low + (self.bits() >> 40) as f32 / 16_777_216.0 * (high - low)
    }

    /// A colour with the given alpha.
    pub fn color(&mut self, alpha: u8) -> [u8; 4] {
        let [r, g, b, ..] = self.bits().to_le_bytes();
        [r, g, b, alpha]
    }
}
