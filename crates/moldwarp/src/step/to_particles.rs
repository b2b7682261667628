//! Stage 3: velocities of particles, v_p += h Σ N_i a_i (Jassim et al. Eq. 8), and the momenta
//! of the updated particles for the remap.

use super::{BLOCK, CellSums};
use crate::Vec3;
use crate::parallel::{ByCell, fold};
use crate::simulation::Simulation;

pub(super) fn run(sim: &mut Simulation, before: f64, after: f64) {
    let h = before + after;
    let Simulation {
        plan,
        particles,
        active,
        nodes,
        cells,
        ledger,
        ..
    } = sim;
    let (mesh, active, nodes) = (&plan.mesh, &*active, &nodes[..]);
    // Share of the mesh's velocity that particles take on in a kick.
    let blend = -libm::expm1(-plan.numerics.pic_rate * h);
    let (position, mass) = (&particles.position, &particles.mass);
    let block = ByCell::new(&active.offsets, &mut particles.velocity[..]);
    let sums = fold((block, &mut cells.sums[..]), BLOCK, &|(block, sums): (
        ByCell<&mut [Vec3]>,
        &mut [CellSums],
    )| {
        let first = block.first();
        let mut energy = [0.0; 3];
        for (sum, c) in sums.iter_mut().zip(block.cells) {
            let e = active.elements[c] as usize;
            let corners = active.cell_nodes[c].map(|n| &nodes[n as usize]);
            let origin = mesh.nodes[mesh.tets[e][0] as usize];
            sum.momentum = [Vec3::ZERO; 4];
            for p in active.offsets[c] as usize..active.offsets[c + 1] as usize {
                let n = crate::mesh::barycentric(origin, &mesh.gradients[e], position[p]);
                let a: Vec3 = (0..4).map(|i| corners[i].received * n[i]).sum();
                let v = &mut block.particles[p - first];
                let m = mass[p];
                *v += a * h;
                energy[0] += m * a.length_squared();
                if blend > 0.0 {
                    let grid: Vec3 = (0..4)
                        .map(|i| (corners[i].velocity + corners[i].received * h) * n[i])
                        .sum();
                    let own = v.length_squared();
                    *v += (grid - *v) * blend;
                    energy[1] += 0.5 * m * (own - v.length_squared());
                }
                energy[2] += 0.5 * m * v.length_squared();
                for i in 0..4 {
                    sum.momentum[i] += *v * (n[i] * m);
                }
            }
        }
        energy
    });
    ledger.end_kick(sums, before, after);
}
