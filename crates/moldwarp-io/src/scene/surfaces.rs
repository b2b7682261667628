//! Surfaces of the mesh by name.

use super::amount::each;
use super::error::Fault;
use super::raw::Texts;
use super::values::find;
use moldwarp::Mesh;
use std::ops::Range;

/// The surfaces' numbers. None may be empty or named twice.
pub(super) fn surfaces(raw: &Texts, mesh: &Mesh) -> Result<Vec<usize>, Fault> {
    let mut found = Vec::new();
    for (span, name) in each(raw) {
        let surface = surface((span.clone(), name), mesh)?;
        if found.contains(&surface) {
            return Err(Fault::new(format!("`{name}` is listed twice")).at(span, "again here"));
        }
        found.push(surface);
    }
    if found.is_empty() {
        return Err(
            Fault::new("`surface` must name at least one surface").at(raw.span(), "an empty list")
        );
    }
    Ok(found)
}

/// The surface's number; one without triangles is an error.
pub(super) fn surface(name: (Range<usize>, &str), mesh: &Mesh) -> Result<usize, Fault> {
    let names = mesh.surfaces.iter().map(|s| s.name.as_str());
    let surface = find(name.clone(), "surface", "surfaces of the mesh", names)?;
    if mesh.surfaces[surface].faces.is_empty() {
        return Err(Fault::new(format!("surface `{}` is empty", name.1))
            .at(name.0, "has no triangles")
            .help("give the group its surfaces in the mesh generator"));
    }
    Ok(surface)
}

/// `bottom`, `x-min+x-max`: what something without a name is called after its surfaces.
pub(super) fn joined(surfaces: &[usize], mesh: &Mesh) -> String {
    let names: Vec<&str> = surfaces
        .iter()
        .map(|&s| mesh.surfaces[s].name.as_str())
        .collect();
    names.join("+")
}

/// Gives `name` a number if it is taken.
pub(super) fn unique<'a>(name: String, taken: impl Iterator<Item = &'a str> + Clone) -> String {
    if !taken.clone().any(|t| t == name) {
        return name;
    }
    let numbered = |n: usize| format!("{name}-{n}");
    let mut n = 2;
    while taken.clone().any(|t| t == numbered(n)) {
        n += 1;
    }
    numbered(n)
}

#[cfg(test)]
mod tests {
    use super::*;
    use moldwarp::Vec3;
    use moldwarp::mesh::RawMesh;

    #[test]
    fn a_surface_without_triangles_is_refused() {
        let mesh = Mesh::new(RawMesh {
            nodes: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z],
            tets: vec![[0, 1, 2, 3]],
            surface_groups: vec![("base".into(), vec![[0, 1, 2]]), ("top".into(), vec![])],
            ..RawMesh::default()
        })
        .unwrap();
        assert_eq!(surface((0..1, "base"), &mesh).unwrap(), 0);
        let fault = surface((0..1, "top"), &mesh).unwrap_err();
        assert_eq!(fault.message, "surface `top` is empty");
    }

    #[test]
    fn a_taken_name_gets_a_number() {
        let taken = ["a", "a-2"];
        assert_eq!(unique("b".to_owned(), taken.into_iter()), "b");
        assert_eq!(unique("a".to_owned(), taken.into_iter()), "a-3");
    }
}
