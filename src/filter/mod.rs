//! Effects on whole surfaces.

pub(crate) mod blur;
