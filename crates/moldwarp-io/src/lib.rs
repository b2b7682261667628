//! Files of moldwarp: scenes and meshes in, results out. The solver itself knows of none.

pub mod check;
pub mod mesh;
pub mod output;
#[cfg(test)]
mod reference;
pub mod report;
pub mod run;
pub mod scene;
pub mod sweep;
pub mod text;
