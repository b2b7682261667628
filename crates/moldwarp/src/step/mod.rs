//! One time step: the eight stages of the method, one file each.
//!
//! Velocities live at mid-steps and positions and stresses at full steps (leapfrog). A step is a
//! *drift*, which carries positions and stresses over Δt with the velocities of the mid-step, and
//! a *kick*, which carries velocities from the middle of this step to the middle of the next with
//! the forces in between, over h = (Δt + Δt_next)/2:
//!
//! | | stage | file |
//! |---|---|---|
//! | drift | 4 remap: v_i = Σ m_p v_p N_i / m_i, Δu_i = Δt v_i | `remap` |
//! | | 5 strain: ∇Δu per element, volumetric part smoothed | `strain` |
//! | | 6 stress: rotation and material model | `stress` |
//! | | 7 move: x_p += Σ N_i Δu_i | `motion` |
//! | | 8 mesh: follows, particles located | `advance` |
//! | kick | 1 particles to nodes: masses, momenta, forces | `to_nodes` |
//! | | 2 nodes: a_i = F_i / m_i, damping, boundaries | `nodes`, `correction` |
//! | | 3 nodes to particles: v_p += h Σ N_i a_i | `to_particles` |
//!
//! What particles receive in stage 3, stages 6 and 7 and, in a mesh that stays, the sums of stage 1 are one pass over
//! particles in the drift, `points`; the kick goes through nodes and cells only.
//!
//! Jassim et al. Eq. 5–9 are the same cycle cut before stage 1; with equal steps the numbers are
//! theirs but for the first kick, which is half as long: a load that acts from t = 0 then acts
//! neither half a step too long nor too short. A stage of the run begins and ends with a half
//! kick, so that at its ends positions and velocities belong to the same instant.

mod active;
mod advance;
mod collect;
mod contact;
mod corners;
mod correction;
mod guard;
mod guests;
mod leavers;
mod mass;
mod motion;
mod nodes;
mod points;
mod reference;
mod remap;
mod rigid;
mod shapes;
mod smoothing;
mod state;
mod strain;
mod stress;
mod sums;
mod time_step;
mod to_nodes;
mod to_particles;

pub use active::{Active, Grid};
#[cfg(target_arch = "x86_64")]
pub(crate) use corners::{Avx2, Avx512};
pub(crate) use corners::{Instructions, Plain};
pub(crate) use guests::{Guests, Known, homes};
pub(crate) use mass::ConsistentMass;
pub(crate) use nodes::unheld;
pub(crate) use reference::Reference;
pub(crate) use state::{
    CellFill, CellForce, CellMedium, CellSums, Cells, Node, Remembered, Shared,
};
pub(crate) use stress::Answers;
pub use time_step::TimeStepError;
pub(crate) use time_step::critical;
pub(crate) use to_particles::Pending;

use crate::measure::Part;
use crate::simulation::Simulation;
use crate::stop::Stop;

/// Cells or nodes that one thread works on at a time.
const BLOCK: usize = 256;
/// Tiles of cells that one thread works on at a time.
const TILES: usize = 32;

impl Simulation {
    /// Advances positions, stresses and the mesh by `dt` seconds.
    pub(crate) fn drift(&mut self, dt: f64) -> Result<(), Stop> {
        self.profile.lap(Part::Between);
        self.guests_arrive();
        self.profile.lap(Part::Order);
        remap::run(self, dt);
        self.profile.lap(Part::Remap);
        strain::run(self);
        self.profile.lap(Part::Strain);
        if self.guests_are_many() {
            // Now is the time: nothing more is asked of sums that are there, and the pass makes those of the new order.
            strain::begin_work(self);
            self.reorder();
            self.profile.lap(Part::Order);
        }
        if let Err(stop) = stress::ask(self) {
            self.guests_leave();
            return Err(stop);
        }
        advance::run(self)
    }

    /// Advances velocities from `before` seconds before now to half the coming step after now.
    /// Returns that coming step: the stable one, at most `limit` (0 at the end of a stage).
    pub(crate) fn kick(&mut self, before: f64, limit: f64) -> Result<f64, Stop> {
        self.profile.lap(Part::Between);
        match self.kick_all(before, limit) {
            Err(stop) => {
                self.settle();
                Err(stop)
            }
            Ok((_, kinetic)) if !kinetic.is_finite() => {
                self.settle();
                Err(self.not_finite())
            }
            Ok((dt, _)) => Ok(dt),
        }
    }

    /// Returns the coming step and the energy of motion.
    fn kick_all(&mut self, before: f64, limit: f64) -> Result<(f64, f64), Stop> {
        self.gravity = self.plan.gravity * self.switches.gravity(self.clock.time);
        to_nodes::run(self, before);
        let stable = time_step::choose(self).map_err(|error| self.no_time_step(error))?;
        self.profile.lap(Part::TimeStep);
        // A step that would leave a sliver of the stage is stretched to its end.
        let dt = if limit <= stable * (1.0 + 1e-6) {
            limit
        } else {
            stable
        };
        let after = 0.5 * dt;
        self.constraints.set_time(
            self.clock.time + after,
            before == 0.0 && self.clock.new_constraints,
        );
        nodes::run(self, before, after);
        self.profile.lap(Part::Nodes);
        correction::receive(self, before + after);
        self.profile.lap(Part::Receive);
        let kinetic = to_particles::run(self, before, after);
        self.profile.lap(Part::ToParticles);
        Ok((dt, kinetic))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{LinearElastic, Material, MohrCoulomb, MohrCoulombParameters};
    use crate::mesh::box_mesh;
    use crate::plan::*;
    use crate::tensor::{equivalent, to_matrix, trace};
    use crate::{Mat3, Vec3};

    /// A unit cube of soil in a mesh three times as wide; its particles are not symmetric.
    fn cube(cells: usize) -> Simulation {
        let mesh = box_mesh(Vec3::splat(3.0), [3 * cells; 3]).unwrap();
        let (min, max) = (Vec3::splat(1.0), Vec3::splat(2.0));
        let elastic = LinearElastic {
            young_modulus: 1e5,
            poisson_ratio: 0.3,
        };
        let model = Material::LinearElastic(elastic);
        let plan = Plan {
            title: String::new(),
            gravity: Vec3::ZERO,
            mesh,
            symmetry: None,
            materials: vec![NamedMaterial {
                name: "soil".into(),
                density: 1800.0,
                model,
            }],
            bodies: vec![Body {
                name: "cube".into(),
                place: Place::Region(Region::Box { min, max }),
                material: 0,
                seeding: Seeding::Four,
            }],
            boundaries: vec![],
            loads: vec![],
            contacts: vec![],
            probes: vec![],
            initial_stress: None,
            inherited: Default::default(),
            mesh_motion: None,
            numerics: Numerics::default(),
            stages: vec![Stage::new("run", Until::Steps(1000))],
        };
        Simulation::new(plan).unwrap()
    }

    fn move_nodes(sim: &mut Simulation, motion: impl Fn(Vec3) -> Vec3) {
        for (node, &n) in sim.nodes.iter_mut().zip(&sim.active.nodes) {
            node.moved = motion(sim.plan.mesh.nodes[n as usize]);
        }
        sim.shared.renew(&sim.nodes);
    }

    /// Mean, von Mises' stress and determinant.
    fn invariants(stress: &[f64; 6]) -> [f64; 3] {
        [
            trace(stress),
            equivalent(stress),
            to_matrix(stress).determinant(),
        ]
    }

    /// All nodes turn rigidly about an axis, exactly: stresses must turn with them. Invariants
    /// may change by round-off only over a whole turn, and the turned stress must be the first.
    #[test]
    fn a_prescribed_turn_leaves_stress_invariants() {
        let mut sim = cube(2);
        let centre = Vec3::splat(1.5);
        let first = [-3e3, 1e3, -2e3, 4e2, -7e2, 9e2];
        sim.particles.stress.fill(first);
        let steps = 720;
        let angle = std::f64::consts::TAU / f64::from(steps);
        let turn = Mat3::from_axis_angle(Vec3::new(1.0, 2.0, 2.0) / 3.0, angle);
        for _ in 0..steps {
            sim.guests_arrive();
            move_nodes(&mut sim, |x| turn * (x - centre) - (x - centre));
            strain::run(&mut sim);
            advance::run(&mut sim).unwrap();
        }
        sim.guests_leave();
        let expected = invariants(&first);
        for (stress, u) in sim
            .particles
            .stress
            .iter()
            .zip(sim.particles.displacements())
        {
            for (now, before) in invariants(&stress).iter().zip(expected) {
                assert!((now / before - 1.0).abs() < 1e-10, "{now} {before}");
            }
            // The rotation of a step, (I − W/2)⁻¹ (I + W/2), is exact for the midpoint gradient.
            assert!(stress.iter().zip(first).all(|(a, b)| (a - b).abs() < 1e-7));
            assert!(u.length() < 1e-11);
        }
        for (now, before) in sim
            .particles
            .volume
            .iter()
            .zip(&sim.particles.initial_volume)
        {
            assert!((now / before - 1.0).abs() < 1e-10);
        }
    }

    /// Soil that is sheared and compressed homogeneously: every particle follows the stress point's
    /// path, and the works in the ledger are its works.
    #[test]
    fn plastic_work_is_booked() {
        let mut sim = cube(2);
        let elastic = LinearElastic {
            young_modulus: 1e7,
            poisson_ratio: 0.3,
        };
        let parameters = MohrCoulombParameters {
            cohesion: 5e3,
            friction_angle: 0.5,
            dilation_angle: 0.1,
            tension_cutoff: None,
        };
        let soil = MohrCoulomb::new(elastic, parameters).unwrap();
        sim.plan.materials[0].model = Material::MohrCoulomb(soil);
        let rate = Mat3::from_diagonal(Vec3::new(2e-5, -1e-5, -6e-5));
        let (mut stress, mut state) = ([0.0; 6], crate::material::State::default());
        for _ in 0..200 {
            move_nodes(&mut sim, |x| rate * x);
            strain::run(&mut sim);
            advance::run(&mut sim).unwrap();
            let midpoint = rate * (Mat3::IDENTITY + rate * 0.5).inverse();
            let increment = crate::tensor::strain(&midpoint);
            let model = &sim.plan.materials[0].model;
            stress = model.update(&stress, &increment, &mut state).stress;
        }
        assert!(state[0] > 1e-3, "the soil yields");
        for (own, values) in sim.particles.stress.iter().zip(sim.particles.state.iter()) {
            assert!(own.iter().zip(stress).all(|(a, b)| (a - b).abs() < 1e-6));
            assert!((values[0] - state[0]).abs() < 1e-12);
        }
        let energies = sim.energies();
        assert!(energies.plastic > 0.0 && energies.elastic > 0.0);
        // σ : Δε^p V of the last step, from the stress point, bounds the mean of the ledger's.
        let volume: f64 = sim.particles.volume.iter().sum();
        let bound = -stress[2] * 200.0 * 6e-5 * volume;
        assert!(energies.plastic + energies.elastic < bound);
    }

    /// Smoothing that is conjugate loses energy only as weights and gradients change within a step,
    /// in proportion to the strain.
    #[test]
    fn conjugate_smoothing_loses_no_energy() {
        let lost = |smoothing: Smoothing| {
            let mut sim = cube(2);
            sim.plan.numerics.smoothing = smoothing;
            sim.plan.stages[0].until = Until::Steps(100);
            sim.set_velocity(|x| 0.01 * (x - Vec3::splat(1.5)) * x.y)
                .unwrap();
            while !sim.finished() {
                sim.step().unwrap();
            }
            assert!(sim.energies().residual.abs() < 1e-10 * sim.energy_turned_over());
            sim.energies().smoothing.abs() / sim.energy_turned_over()
        };
        assert!(lost(Smoothing::Conjugate) < 2e-4);
        assert!(lost(Smoothing::Strain) > 4e-3);
        assert_eq!(lost(Smoothing::Off), 0.0);
    }

    /// A thrown, spinning and quivering body: its mass on the nodes is its particles' to 1e-14,
    /// its momentum drifts less than 1e-12 in 1,000 steps.
    #[test]
    fn mass_and_momentum_of_a_free_body_are_conserved() {
        let mut sim = cube(2);
        let centre = Vec3::splat(1.5);
        let velocity = |x: Vec3| {
            let arm = x - centre;
            Vec3::new(0.02, -0.03, 0.01) + Vec3::new(0.1, 0.2, 0.3).cross(arm) + 0.2 * arm * arm.x
        };
        sim.set_velocity(velocity).unwrap();
        let (mass, momentum) = (sim.particles.total_mass(), sim.particles.momentum());
        while !sim.finished() {
            sim.step().unwrap();
            assert!((sim.nodal_mass() / mass - 1.0).abs() < 1e-14);
        }
        let drift = (sim.particles.momentum() - momentum).length() / momentum.length();
        assert!(drift < 1e-12, "{drift}");
        assert!(sim.energies().residual.abs() < 1e-6 * sim.energy_turned_over());
    }

    /// A particle that leaves the mesh stops the run with its name; so does a forced step that
    /// has become too long.
    #[test]
    fn what_goes_wrong_stops_the_run() {
        let mut sim = cube(1);
        sim.set_velocity(|_| Vec3::new(10.0, 0.0, 0.0)).unwrap();
        let stop = std::iter::repeat_with(|| sim.step())
            .find_map(Result::err)
            .unwrap();
        assert!(
            matches!(&stop, Stop::LeftTheMesh { body, .. } if body == "cube"),
            "{stop}"
        );
        let mut sim = cube(1);
        sim.plan.numerics.time_step = Some(10.0);
        assert!(matches!(sim.step(), Err(Stop::TimeStep { .. })));
        let mut sim = cube(1);
        let stop = sim.set_velocity(|_| Vec3::new(f64::NAN, 0.0, 0.0));
        assert!(matches!(stop, Err(Stop::NotFinite { .. })));
        // As if the mesh had been ten thousand times as coarse.
        let mut sim = cube(1);
        sim.step().unwrap();
        sim.clock.longest *= 2e4;
        let stop = sim.step();
        assert!(
            matches!(&stop, Err(Stop::TimeStep { error: TimeStepError::Collapsed { place, .. }, .. })
                if place.cmpge(Vec3::splat(1.0)).all() && place.cmple(Vec3::splat(2.0)).all()),
            "{stop:?}"
        );
        // Two metres a step into an element of one: it is turned inside out.
        let mut sim = cube(1);
        sim.set_velocity(|x| Vec3::new(-5e2 * (x.x - 1.5), 0.0, 0.0))
            .unwrap();
        let stop = std::iter::repeat_with(|| sim.step()).find_map(Result::err);
        assert!(matches!(stop, Some(Stop::Crushed { .. })), "{stop:?}");
    }
}
