//! Weights with which the mesh between what moves and what stays is stretched.

use crate::Vec3;
use crate::mesh::Mesh;

/// Solves div q = 0 for the nodes without a given value, by conjugate gradients. `flux` makes V_e q of
/// the gradient of w in an element; V_e times the gradient is Laplace's equation.
pub(super) fn harmonic(
    mesh: &Mesh,
    given: &[Option<f64>],
    flux: impl Fn(usize, Vec3) -> Vec3,
) -> Vec<f64> {
    let mut w: Vec<f64> = given.iter().map(|v| v.unwrap_or(1.0)).collect();
    if !given.contains(&Some(0.0)) {
        return w;
    }
    let free = |n: usize| given[n].is_none();
    let gradients: Vec<[Vec3; 4]> = (0..mesh.tets.len())
        .map(|e| mesh.all_gradients(e))
        .collect();
    // Residual −K w on the free nodes, and the diagonal of K as preconditioner.
    let mut residual: Vec<f64> = stiffness_times(mesh, &gradients, &w, &flux)
        .iter()
        .map(|r| -r)
        .collect();
    let diagonal = stiffness_diagonal(mesh, &gradients, &flux);
    let mask = |v: &mut Vec<f64>| (0..v.len()).filter(|&n| !free(n)).for_each(|n| v[n] = 0.0);
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    mask(&mut residual);
    let mut z: Vec<f64> = residual.iter().zip(&diagonal).map(|(r, d)| r / d).collect();
    let mut direction = z.clone();
    let mut rho = dot(&residual, &z);
    let target = 1e-16 * rho;
    for _ in 0..10 * mesh.nodes.len() {
        if rho <= target {
            break;
        }
        let mut image = stiffness_times(mesh, &gradients, &direction, &flux);
        mask(&mut image);
        let alpha = rho / dot(&direction, &image);
        for n in 0..w.len() {
            w[n] += alpha * direction[n];
            residual[n] -= alpha * image[n];
            z[n] = residual[n] / diagonal[n];
        }
        let next = dot(&residual, &z);
        for n in 0..w.len() {
            direction[n] = z[n] + next / rho * direction[n];
        }
        rho = next;
    }
    w
}

fn stiffness_times(
    mesh: &Mesh,
    gradients: &[[Vec3; 4]],
    w: &[f64],
    flux: impl Fn(usize, Vec3) -> Vec3,
) -> Vec<f64> {
    let mut out = vec![0.0; w.len()];
    for (e, tet) in mesh.tets.iter().enumerate() {
        let gradients = &gradients[e];
        let slope: Vec3 = (0..4)
            .map(|i| gradients[i] * w[tet[i] as usize])
            .sum::<Vec3>();
        let flow = flux(e, slope);
        for i in 0..4 {
            out[tet[i] as usize] += gradients[i].dot(flow);
        }
    }
    out
}

fn stiffness_diagonal(
    mesh: &Mesh,
    gradients: &[[Vec3; 4]],
    flux: impl Fn(usize, Vec3) -> Vec3,
) -> Vec<f64> {
    let mut out = vec![0.0; mesh.nodes.len()];
    for (e, tet) in mesh.tets.iter().enumerate() {
        for (i, g) in gradients[e].iter().enumerate() {
            out[tet[i] as usize] += g.dot(flux(e, *g));
        }
    }
    // Nodes of no element would divide by zero.
    out.iter().map(|&d| if d > 0.0 { d } else { 1.0 }).collect()
}
