//! Files of moldwarp: scenes and meshes in, results out. The solver itself knows of none.

pub mod check;
pub mod mesh;
pub mod output;
pub mod plot;
#[cfg(test)]
mod reference;
pub mod report;
pub mod results;
pub mod run;
pub mod scene;
pub mod sweep;
pub mod text;
