//! The 3D scenes, and the engines that draw them.

pub(crate) mod euc;
pub(crate) mod rastrum;
pub(crate) mod scenes;
