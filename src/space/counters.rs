//! What a draw did, in numbers: the pipeline's queries.

use std::ops::AddAssign;

/// Counts of one draw, or of several added up. None of them changes with threads or SIMD levels but those of tiles,
/// which follow the bands where a triangle crosses several.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Vertices that went through the vertex shader.
    pub vertices: u64,
    /// Primitives assembled.
    pub primitives: u64,
    /// Primitives with an index beyond the vertices, or a vertex that is not a number: dropped.
    pub invalid: u64,
    /// Triangles that crossed a clip plane and were cut.
    pub clipped: u64,
    /// Primitives wholly outside a plane of the view volume or of the drawable area: dropped.
    pub outside: u64,
    /// Triangles without area after snapping: dropped.
    pub zero_area: u64,
    /// Triangles dropped by the side they face.
    pub culled: u64,
    /// Triangles without a sample in their bounding box: dropped before set-up.
    pub no_samples: u64,
    /// Triangles set up.
    pub setups: u64,
    /// Tiles looked at.
    pub tiles: u64,
    /// Tiles that lie wholly inside the triangle.
    pub tiles_accepted: u64,
    /// Tiles skipped since everything in them is nearer.
    pub tiles_hidden: u64,
    /// Tiles written without reading depths, since everything in them is farther.
    pub tiles_in_front: u64,
    /// Samples that passed all tests: the occlusion query.
    pub samples_passed: u64,
    /// Pixels that went through the fragment shader.
    pub fragments: u64,
}

impl AddAssign for Counters {
    fn add_assign(&mut self, other: Self) {
        self.vertices += other.vertices;
        self.primitives += other.primitives;
        self.invalid += other.invalid;
        self.clipped += other.clipped;
        self.outside += other.outside;
        self.zero_area += other.zero_area;
        self.culled += other.culled;
        self.no_samples += other.no_samples;
        self.setups += other.setups;
        self.tiles += other.tiles;
        self.tiles_accepted += other.tiles_accepted;
        self.tiles_hidden += other.tiles_hidden;
        self.tiles_in_front += other.tiles_in_front;
        self.samples_passed += other.samples_passed;
        self.fragments += other.fragments;
    }
}
