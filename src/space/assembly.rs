//! Primitive assembly: which vertices make which triangle, line or point.

/// How vertices (or indices) make primitives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Topology {
    /// Each three make a triangle: the default.
    #[default]
    Triangles,
    /// Each vertex from the third makes a triangle with the two before, every other one turned so that all wind alike.
    TriangleStrip,
    /// Each vertex from the third makes a triangle with the first and the one before.
    TriangleFan,
    /// Each two make a line.
    Lines,
    /// Each vertex from the second makes a line from the one before. Joints are drawn once.
    LineStrip,
    /// A line strip that ends where it starts.
    LineLoop,
    /// Each vertex is a point.
    Points,
}

/// Vertices, and how they are put together.
#[derive(Debug)]
pub struct Primitives<'a, V> {
    /// The vertices.
    pub vertices: &'a [V],
    /// Which vertices are used, in order; `None` for all of them in their order.
    pub indices: Option<&'a [u32]>,
    /// How they make primitives.
    pub topology: Topology,
}

impl<V> Clone for Primitives<'_, V> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<V> Copy for Primitives<'_, V> {}

impl<'a, V> Primitives<'a, V> {
    /// A plain list of triangles: each three vertices make one.
    pub fn triangles(vertices: &'a [V]) -> Self {
        Self { vertices, indices: None, topology: Topology::Triangles }
    }

    /// An indexed list of triangles. One with an index beyond the vertices is dropped and counted.
    pub fn indexed(vertices: &'a [V], indices: &'a [u32]) -> Self {
        Self { vertices, indices: Some(indices), topology: Topology::Triangles }
    }

    /// Vertices in their order.
    pub fn new(vertices: &'a [V], topology: Topology) -> Self {
        Self { vertices, indices: None, topology }
    }

    /// The number of primitives.
    pub fn count(&self) -> usize {
        let n = self.indices.map_or(self.vertices.len(), <[u32]>::len);
        match self.topology {
            Topology::Triangles => n / 3,
            Topology::TriangleStrip | Topology::TriangleFan => n.saturating_sub(2),
            Topology::Lines => n / 2,
            Topology::LineStrip => n.saturating_sub(1),
            Topology::LineLoop if n < 2 => 0,
            Topology::LineLoop | Topology::Points => n,
        }
    }

    /// The vertices of a primitive; those past its last corner repeat it. `None` beyond the last primitive and for an
    /// index beyond the vertices.
    #[inline(always)]
    pub fn corners(&self, primitive: usize) -> Option<[u32; 3]> {
        let i = primitive;
        let at = match self.topology {
            Topology::Triangles => [3 * i, 3 * i + 1, 3 * i + 2],
            Topology::TriangleStrip if i.is_multiple_of(2) => [i, i + 1, i + 2],
            Topology::TriangleStrip => [i, i + 2, i + 1],
            Topology::TriangleFan => [0, i + 1, i + 2],
            Topology::Lines => [2 * i, 2 * i + 1, 2 * i + 1],
            Topology::LineStrip => [i, i + 1, i + 1],
            Topology::LineLoop => {
                let n = self.indices.map_or(self.vertices.len(), <[u32]>::len);
                let next = if i + 1 == n { 0 } else { i + 1 };
                [i, next, next]
            }
            Topology::Points => [i; 3],
        };
        let n = self.vertices.len();
        match self.indices {
            Some(indices) => {
                let corners = match self.topology {
                    // One bounds check for the common case.
                    Topology::Triangles => *indices.get(3 * i..)?.first_chunk::<3>()?,
                    _ => [*indices.get(at[0])?, *indices.get(at[1])?, *indices.get(at[2])?],
                };
                corners.iter().all(|corner| (*corner as usize) < n).then_some(corners)
            }
            None => (at.iter().all(|corner| *corner < n)).then(|| at.map(|corner| corner as u32)),
        }
    }

    /// The corners of every primitive that has sound indices.
    pub fn iter(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        (0..self.count()).filter_map(|i| self.corners(i))
    }
}
