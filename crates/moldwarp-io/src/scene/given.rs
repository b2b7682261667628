//! What a program gives to a scene beside its text.

use moldwarp::material::Law;
use moldwarp::mesh::RawMesh;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Things that a text cannot hold. The command gives none.
#[derive(Clone, Debug, Default)]
pub struct Given {
    /// Meshes that stand for files of these names, as `[mesh]` names them.
    pub meshes: BTreeMap<String, RawMesh>,
    /// Laws of the materials whose model is `external`, by the names of the materials.
    pub laws: BTreeMap<String, Arc<dyn Law>>,
}
