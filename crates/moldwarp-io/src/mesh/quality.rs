//! A mesh's quality in words.

use crate::text::number;
use moldwarp::Mesh;

/// Above this ratio of longest edge to shortest altitude an element is a sliver.
const SLIVER: f64 = 10.0;

/// Two lines: how large a mesh is, and which elements set the time step and the accuracy. They are
/// named by their tags in the mesh file; without tags they count from 0, as cells do in ParaView.
pub fn describe_quality(mesh: &Mesh, element_tags: &[u64]) -> [String; 2] {
    let q = mesh.quality();
    let element = |e: u32| match element_tags.get(e as usize) {
        Some(tag) => format!("element {tag}"),
        None => format!("element {e}, counted from 0"),
    };
    let sliver = match q.worst_aspect > SLIVER {
        true => ": a sliver, which costs steps and accuracy",
        false => "",
    };
    [
        format!(
            "{} elements, {} nodes, mean edge {} m",
            mesh.tets.len(),
            mesh.nodes.len(),
            number(q.mean_edge)
        ),
        format!(
            "shortest altitude {} m ({}), worst edge over altitude {} ({}){sliver}",
            number(q.smallest_altitude),
            element(q.smallest_altitude_element),
            number(q.worst_aspect),
            element(q.worst_aspect_element),
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use moldwarp::Vec3;
    use moldwarp::mesh::RawMesh;

    #[test]
    fn slivers_are_named_by_their_tags() {
        let mesh = Mesh::new(RawMesh {
            nodes: vec![
                Vec3::ZERO,
                Vec3::X,
                Vec3::Y,
                Vec3::Z,
                Vec3::new(0.3, 0.3, -0.05),
            ],
            tets: vec![[0, 1, 2, 3], [0, 2, 1, 4]],
            ..RawMesh::default()
        })
        .unwrap();
        let [size, quality] = describe_quality(&mesh, &[70, 71]);
        assert!(
            size.starts_with("2 elements, 5 nodes, mean edge "),
            "{size}"
        );
        assert_eq!(
            quality,
            "shortest altitude 0.05 m (element 71), worst edge over altitude 28.28 (element 71): \
             a sliver, which costs steps and accuracy"
        );
        let [_, quality] = describe_quality(&mesh, &[]);
        assert!(quality.contains("(element 1, counted from 0)"), "{quality}");
    }
}
