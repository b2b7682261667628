//! Stage 6: stresses and volumes of particles.

use super::{BLOCK, CellStrain, smoothing};
use crate::Mat3;
use crate::lanes::{self, LANES, Lane, VoigtLanes, Window, for_each_simd, get, set, whole};
use crate::material::{Material, State, Strained};
use crate::parallel::{ByCell, fold};
use crate::plan::Smoothing;
use crate::simulation::Simulation;
use crate::tensor::{self, Voigt};

/// Stresses, state variables and volumes of some particles.
type Arrays<'a> = (&'a mut [Voigt], &'a mut [State], &'a mut [f64]);

/// Cells side by side.
struct Cells {
    /// ∇Δu in the middle of the step, by columns.
    midpoint: [Lane; 9],
    /// Volumetric strain, own and smoothed.
    own: Lane,
    smoothed: Lane,
    strain: VoigtLanes,
    /// Rotation of the step, by columns.
    turn: [Lane; 9],
}

/// Particles side by side.
struct Points {
    increment: Strained,
    volume: Lane,
    /// 1 where the material is separated and keeps its cell's own volumetric strain.
    separated: Lane,
    material: [u16; LANES],
}

/// Works on particles side by side: [elastic, left out by smoothing, plastic], J.
type Works = [Lane; 3];

pub(super) fn run(sim: &mut Simulation) {
    let Simulation {
        plan,
        particles,
        active,
        nodes,
        cells,
        ledger,
        simd,
        ..
    } = sim;
    let (active, nodes, strains, simd) = (&*active, &nodes[..], &cells.strains[..], *simd);
    let body = &particles.body;
    let (materials, bodies) = (&plan.materials, &plan.bodies);
    let smooth = plan.numerics.smoothing != Smoothing::Off;
    let arrays = (
        &mut particles.stress[..],
        &mut particles.state[..],
        &mut particles.volume[..],
    );
    let block = ByCell::new(&active.offsets, arrays);
    let work = fold(block, BLOCK, &|block: ByCell<Arrays>| {
        let first = block.first();
        let (stresses, states, volumes) = block.particles;
        let mut cells = Cells::default();
        let mut points = Points::default();
        let mut works: Works = [[0.0; LANES]; 3];
        for window in Window::of(block.cells, &active.offsets) {
            for (l, &c) in window.cells().iter().enumerate() {
                let strain = &strains[c as usize];
                cells.load(l, strain);
                if smooth {
                    cells.smoothed[l] = smoothing::cell(&active.cell_nodes[c as usize], nodes);
                }
            }
            deform(simd, &mut cells, window.cells().len());
            window.slots(|slot| {
                for (l, &p) in slot.iter().enumerate() {
                    let own = p as usize - first;
                    let material = bodies[body[p as usize] as usize].material;
                    points.material[l] = material as u16;
                    points.volume[l] = volumes[own];
                    set(&mut points.increment.before, l, stresses[own]);
                    set(&mut points.increment.state, l, states[own]);
                    let separated =
                        (materials[material].model).is_separated(&stresses[own], &states[own]);
                    points.separated[l] = f64::from(u8::from(separated));
                }
                points.volume[slot.len()..lanes::whole(slot.len())].fill(0.0);
                strain(simd, &cells, &mut points, slot.len());
                points.update(simd, |m| &materials[m].model, slot.len());
                book(simd, &cells, &mut points, &mut works, slot.len());
                for (l, &p) in slot.iter().enumerate() {
                    let own = p as usize - first;
                    volumes[own] = points.volume[l];
                    stresses[own] = get(&points.increment.stress, l);
                    states[own] = get(&points.increment.state, l);
                }
            });
        }
        works.each_ref().map(lanes::sum)
    });
    ledger.particle_stress_work(work);
}

impl Default for Cells {
    fn default() -> Cells {
        Cells {
            midpoint: [[0.0; LANES]; 9],
            own: [0.0; LANES],
            smoothed: [0.0; LANES],
            strain: [[0.0; LANES]; 6],
            turn: [[0.0; LANES]; 9],
        }
    }
}

impl Cells {
    #[inline]
    fn load(&mut self, l: usize, strain: &CellStrain) {
        set(&mut self.midpoint, l, strain.midpoint.to_cols_array());
        self.own[l] = strain.volumetric;
        self.smoothed[l] = strain.volumetric;
    }
}

impl Default for Points {
    fn default() -> Points {
        Points {
            increment: Strained::default(),
            volume: [0.0; LANES],
            separated: [0.0; LANES],
            material: [0; LANES],
        }
    }
}

impl Points {
    /// New stresses, where materials meet one material after the other.
    fn update<'m>(
        &mut self,
        simd: lanes::Simd,
        model: impl Fn(usize) -> &'m Material,
        lanes: usize,
    ) {
        let materials = &self.material[..lanes];
        let first = materials[0];
        if materials.iter().all(|&m| m == first) {
            return model(first.into()).update_lanes(simd, &mut self.increment, lanes);
        }
        let before = self.increment.clone();
        let mut done = [false; LANES];
        self.increment.plastic = true;
        while let Some(next) = (0..lanes).find(|&l| !done[l]) {
            let mut all = before.clone();
            model(materials[next].into()).update_lanes(simd, &mut all, lanes);
            for l in (0..lanes).filter(|&l| materials[l] == materials[next]) {
                set(&mut self.increment.stress, l, get(&all.stress, l));
                set(&mut self.increment.state, l, get(&all.state, l));
                let plastic_strain = match all.plastic {
                    true => get(&all.plastic_strain, l),
                    false => [0.0; 6],
                };
                set(&mut self.increment.plastic_strain, l, plastic_strain);
                done[l] = true;
            }
        }
    }
}

/// Volume after a strain over that before, exact for a homogeneous compression.
#[inline(always)]
fn growth(volumetric: f64) -> f64 {
    (1.0 + 0.5 * volumetric) / (1.0 - 0.5 * volumetric)
}

for_each_simd! {
    /// Strain and rotation of cells.
    fn deform(cells: &mut Cells, lanes: usize) {
        for l in 0..whole(lanes) {
            let midpoint = Mat3::from_cols_array(&get(&cells.midpoint, l));
            let mut strain = tensor::strain(&midpoint);
            let change = (cells.smoothed[l] - cells.own[l]) / 3.0;
            (0..3).for_each(|k| strain[k] += change);
            set(&mut cells.strain, l, strain);
            set(&mut cells.turn, l, tensor::spin_rotation(&midpoint).to_cols_array());
        }
    }
}

for_each_simd! {
    /// Turns stresses and gives each particle its strain.
    fn strain(cells: &Cells, points: &mut Points, lanes: usize) {
        for l in 0..whole(lanes) {
            let turn = Mat3::from_cols_array(&get(&cells.turn, l));
            let turned = tensor::rotate(&get(&points.increment.before, l), &turn);
            set(&mut points.increment.before, l, turned);
            let mut strain = get(&cells.strain, l);
            let left_out = (cells.own[l] - cells.smoothed[l]) * (1.0 / 3.0) * points.separated[l];
            (0..3).for_each(|k| strain[k] += left_out);
            set(&mut points.increment.strain, l, strain);
        }
    }
}

for_each_simd! {
    /// Changes volumes and books the work.
    fn book(cells: &Cells, points: &mut Points, works: &mut Works, lanes: usize) {
        let increment = &points.increment;
        for l in 0..whole(lanes) {
            let left_out = (cells.own[l] - cells.smoothed[l]) * (1.0 - points.separated[l]);
            let growth = growth(cells.own[l] - left_out);
            let (turned, stress) = (get(&increment.before, l), get(&increment.stress, l));
            let middle: Voigt = std::array::from_fn(|k| 0.5 * (turned[k] + stress[k]));
            let middle_volume = 0.5 * points.volume[l] * (1.0 + growth);
            points.volume[l] *= growth;
            let work = tensor::dot(&middle, &get(&increment.strain, l)) * middle_volume;
            works[0][l] += work;
            works[1][l] += tensor::trace(&middle) / 3.0 * left_out * middle_volume;
        }
        if increment.plastic {
            for l in 0..whole(lanes) {
                let (turned, stress) = (get(&increment.before, l), get(&increment.stress, l));
                let middle: Voigt = std::array::from_fn(|k| 0.5 * (turned[k] + stress[k]));
                let volumetric = cells.own[l]
                    - (cells.own[l] - cells.smoothed[l]) * (1.0 - points.separated[l]);
                // The volume is the new one by now.
                let middle_volume = 0.5 * points.volume[l] * (1.0 + 1.0 / growth(volumetric));
                let plastic_strain = get(&increment.plastic_strain, l);
                let plastic = tensor::dot(&middle, &plastic_strain) * middle_volume;
                works[0][l] -= plastic;
                works[2][l] += plastic;
            }
        }
    }
}
