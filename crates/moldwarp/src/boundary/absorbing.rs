//! Absorbing boundaries: a dashpot, and a spring that limits its creep.
//!
//! Jassim et al. Eq. 17–20, on a node with the area vectors of its faces (a third of each):
//! C = Σ ρ A [α_n V_p n nᵀ + α_s V_s (I − n nᵀ)], K = Σ A [E_c/δ_n n nᵀ + G/δ_s (I − n nᵀ)].
//! Both are implicit at the node, a lagged dashpot with α = 2.5 is unstable: the dashpot takes the
//! mean of the velocities before and after the kick, the spring the mean of the displacements
//! (a⁻ + 2a + a⁺)/4. Taken at the end of the kick instead, C would act like an additional mass
//! ½ Δt C on the node, half an element's worth for α = 2.5.

use super::Constraints;
use crate::mesh::{Face, Mesh, NONE};
use crate::plan::{Boundary, BoundaryKind, NamedMaterial};
use crate::{Mat3, Vec3};

/// A node on absorbing faces.
#[derive(Clone, Debug)]
pub struct AbsorbingNode {
    /// Mesh node.
    pub node: u32,
    /// C, N s/m.
    pub dashpot: Mat3,
    /// K, N/m.
    pub spring: Mat3,
    /// Displacement a since the boundary is there, m.
    pub displacement: Vec3,
    /// R₀, the reaction that held the node when the boundary was switched on, N.
    pub rest: Vec3,
}

/// All nodes on absorbing faces.
#[derive(Clone, Debug, Default)]
pub struct Absorbing {
    pub nodes: Vec<AbsorbingNode>,
    of_node: Vec<u32>,
}

crate::saved!(Absorbing { nodes, of_node });

impl Absorbing {
    /// `material` gives the material next to a face, if there is any.
    pub fn new<'a>(
        mesh: &Mesh,
        boundaries: &[&Boundary],
        material: impl Fn(Face) -> Option<&'a NamedMaterial>,
    ) -> Absorbing {
        let mut absorbing = Absorbing {
            nodes: Vec::new(),
            of_node: vec![NONE; mesh.nodes.len()],
        };
        for boundary in boundaries {
            let BoundaryKind::Absorbing {
                alpha,
                virtual_thickness,
            } = boundary.kind
            else {
                continue;
            };
            for &face in boundary
                .surfaces
                .iter()
                .flat_map(|&s| &mesh.surfaces[s].faces)
            {
                let Some(material) = material(face) else {
                    continue;
                };
                let area = mesh.face_area(face);
                let (dashpot, spring) = face_matrices(area, alpha, virtual_thickness, material);
                for node in mesh.face_nodes(face) {
                    let entry = absorbing.entry(node);
                    entry.dashpot += dashpot * (1.0 / 3.0);
                    entry.spring += spring * (1.0 / 3.0);
                }
            }
        }
        absorbing
    }

    /// The absorbing node at a mesh node.
    #[inline]
    pub fn of(&self, node: u32) -> Option<&AbsorbingNode> {
        self.nodes.get(*self.of_node.get(node as usize)? as usize)
    }

    /// Takes over what nodes have been through that were absorbing before; the others begin with
    /// the reaction that `rest` gives, N.
    pub fn go_on_from(&mut self, before: &Absorbing, rest: impl Fn(u32) -> Vec3) {
        for node in &mut self.nodes {
            match before.of(node.node) {
                Some(old) => (node.displacement, node.rest) = (old.displacement, old.rest),
                None => node.rest = rest(node.node),
            }
        }
    }

    fn entry(&mut self, node: u32) -> &mut AbsorbingNode {
        let index = &mut self.of_node[node as usize];
        if *index == NONE {
            *index = self.nodes.len() as u32;
            let (dashpot, spring) = (Mat3::ZERO, Mat3::ZERO);
            self.nodes.push(AbsorbingNode {
                node,
                dashpot,
                spring,
                displacement: Vec3::ZERO,
                rest: Vec3::ZERO,
            });
        }
        &mut self.nodes[*index as usize]
    }
}

fn face_matrices(
    area: Vec3,
    alpha: [f64; 2],
    thickness: Option<[f64; 2]>,
    material: &NamedMaterial,
) -> (Mat3, Mat3) {
    let elastic = material.model.elasticity();
    let (e_c, g, rho) = (
        elastic.constrained_modulus(),
        elastic.shear_modulus(),
        material.density,
    );
    let size = area.length();
    let n = area / size;
    let normal = Mat3::from_cols(n * n.x, n * n.y, n * n.z) * size;
    let shear = Mat3::IDENTITY * size - normal;
    let dashpot = normal * (alpha[0] * (rho * e_c).sqrt()) + shear * (alpha[1] * (rho * g).sqrt());
    let spring = match thickness {
        Some(delta) => normal * (e_c / delta[0]) + shear * (g / delta[1]),
        None => Mat3::ZERO,
    };
    (dashpot, spring)
}

impl AbsorbingNode {
    /// Velocity at the end of a kick of length `h` (s) of a node of mass `m` (kg), with mapped
    /// velocity `v` and force `f` without the boundary's:
    /// (m + ½hC + ¼h²K) v⁺ = (m − ½hC + ¼h²K) v + h (f + R₀ − K a), in the subspace that `constraints`
    /// leave.
    pub fn solve(&self, m: f64, v: Vec3, f: Vec3, h: f64, constraints: &Constraints) -> Vec3 {
        let inertia = Mat3::IDENTITY * m + self.spring * (0.25 * h * h);
        let half = self.dashpot * (0.5 * h);
        let matrix = inertia + half;
        let right = (inertia - half) * v + (f + self.support()) * h;
        match constraints.of(self.node) {
            None => matrix.inverse() * right,
            Some(held) => {
                let free = held.free;
                let blocked = Mat3::IDENTITY - free;
                (free * matrix * free + blocked * m).inverse() * (free * right)
            }
        }
    }

    /// What the boundary holds the node with when it does not move, R₀ − K a, N.
    pub fn support(&self) -> Vec3 {
        self.rest - self.spring * self.displacement
    }

    /// Force of the boundary on the node in a kick of length `h` that leads from `before` to
    /// `after`, N.
    pub fn force(&self, before: Vec3, after: Vec3, h: f64) -> Vec3 {
        self.rest
            - self.dashpot * (0.5 * (before + after))
            - self.spring * (self.displacement + (after - before) * (0.25 * h))
    }
}
