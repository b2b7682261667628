//! Stage 1: masses, momenta and internal forces from particles (Jassim et al. Eq. 5–7).

use super::collect::{Share, Shares};
use super::corners::{Corners, NO_CORNERS, Quad, TileNodes, all_corners, load_nodes, set_corner};
use super::shapes::Shapes;
use super::state::are_void;
use super::time_step::{Limits, Steps};
use super::{Active, BLOCK, CellFill, CellForce, CellMedium, CellSums, Cells, Node};
use super::{smoothing, strain, sums};
use crate::lanes::{
    self, LANES, Lane, NUMBERS_AHEAD, RECORDS_AHEAD, Simd, either, for_each_simd, get, lane_of,
    prefetch_number, prefetch_record, set,
};
use crate::measure::Part;
use crate::mesh::{Mesh, NONE};
use crate::parallel::{Smallest, fold};
use crate::plan::{Integration, Smoothing};
use crate::simulation::Simulation;
use crate::tensor::{self, Voigt, add_scaled};
use crate::{Mat3, Vec3};
use std::ops::Range;

/// All four nodes of a filled cell are fuller than this.
const FILLED: f64 = 0.6;
/// What stands for the density at other nodes: so is the sum of a cell that is not filled.
const NOT_FULL: f64 = f64::INFINITY;

pub(super) fn run(sim: &mut Simulation, before: f64) {
    sums::run(sim, before);
    sim.cells.count_guests(&sim.active);
    sum_nodes(sim);
    sim.profile.lap(Part::ToNodes);
    cell_forces(sim, before);
    smoothing::stresses(sim, before);
    sim.profile.lap(Part::Forces);
}

/// Mass, velocity, filling and density of each node.
fn sum_nodes(sim: &mut Simulation) {
    let Simulation {
        plan,
        walls,
        contacts,
        active,
        nodes,
        shared,
        cells,
        ..
    } = sim;
    cells.mass.collect(&cells.portions);
    let (active, portions, mesh) = (&*active, &cells.portions, &plan.mesh);
    let (walls, contacts) = (&*walls, &*contacts);
    let grid_nodes = walls.count(mesh) as u32;
    let numbers = (
        &mut shared.filling[..],
        &mut shared.places[..],
        &mut cells.mass.diagonal[..],
    );
    let items = (0..nodes.len(), &mut nodes[..], numbers);
    type Numbers<'a> = (&'a mut [f64], &'a mut [Quad], &'a mut [f64]);
    fold(items, BLOCK, &|(
        slots,
        nodes,
        (fillings, places, squares),
    ): (
        Range<usize>,
        &mut [Node],
        Numbers,
    )| {
        let (mut first, mut last) = ([Quad::default(); BLOCK], [Quad::default(); BLOCK]);
        (portions.nodes).sums(slots.clone(), &mut [&mut first, &mut last]);
        let numbers = fillings.iter_mut().zip(places).zip(squares);
        let sums = first.iter().zip(&last);
        for (((slot, node), sums), ((filling, place), own)) in
            slots.zip(nodes).zip(sums).zip(numbers)
        {
            node.prefetch(0..1);
            if let Some(&later) = active.nodes.get(slot + NUMBERS_AHEAD) {
                prefetch_number(&mesh.node_volumes, later as usize);
            }
            let (&Quad([x, y, z, mass]), &Quad([volume, all_mass, square, _])) = sums;
            *own = square;
            let momentum = Vec3::new(x, y, z);
            let grid = active.keys[slot] % grid_nodes;
            let mut whole = walls.volume(mesh, grid);
            if contacts.meets(slot) {
                // Elements that other fields fill do not make a field less full.
                let field = (active.keys[slot] / grid_nodes) as usize;
                let around = walls.elements(mesh, grid);
                let foreign = around.filter(|&e| active.is_foreign(e as usize, field));
                whole -= foreign.map(|e| mesh.volumes[e as usize]).sum::<f64>();
            }
            node.mass = mass;
            node.velocity = if mass > 0.0 {
                momentum / mass
            } else {
                Vec3::ZERO
            };
            *filling = volume / whole;
            place.0[3] = either(*filling > FILLED, all_mass / whole, NOT_FULL);
        }
    });
}

/// Whether a cell with these corners counts as filled.
#[inline(always)]
pub(super) fn is_filled(corners: &[u32; 4], filling: &[f64]) -> bool {
    corners.iter().all(|&n| filling[n as usize] > FILLED)
}

/// Stress times volume of each cell, the forces that it makes, and the part of its work that belongs to
/// the last drift.
fn cell_forces(sim: &mut Simulation, before: f64) {
    let Simulation {
        plan,
        active,
        shared,
        cells,
        elasticity,
        ledger,
        clock,
        reference,
        gravity,
        simd,
        ..
    } = sim;
    let (mesh, active, shared, simd) = (&plan.mesh, &*active, &*shared, *simd);
    let reference = reference.as_ref().map(|r| r.at(*gravity));
    let mixed = plan.numerics.integration == Integration::Mixed;
    // A viscous stress is C : ε̇ times this over the last step; there is none before the first.
    let viscosity = plan.numerics.viscosity;
    let per_step = if before > 0.0 {
        viscosity / (2.0 * before)
    } else {
        0.0
    };
    debug_assert!(before == 0.0 || (2.0 * before - clock.dt).abs() <= 1e-12 * clock.dt);
    // Else forces are pushed when their stresses have been smoothed.
    let last = plan.numerics.smoothing != Smoothing::Conjugate;
    cells.keep_forces(!last || viscosity > 0.0);
    let Cells {
        sums,
        medium,
        fills,
        forces,
        portions,
        shortest,
        ..
    } = cells;
    let (sums, medium) = (&sums[..], &medium[..]);
    let alike = elasticity.first().map_or([0.0; 2], |e| [e[0], e[1]]);
    let forces = (!forces.is_empty()).then_some(&mut forces[..]);
    let cut = portions.cut();
    let items = (0..sums.len(), &mut fills[..], (forces, portions.shares()));
    type Out<'a> = (Option<&'a mut [CellForce]>, Shares<'a, Quad, 1>);
    let limits = Limits::new(&plan.numerics, elasticity);
    let (work, least): (f64, Smallest) =
        cut.fold_own(items, &|(range, fills, (forces, shares)): (
            Range<usize>,
            &mut [CellFill],
            Out,
        )| {
            let (mut moved, mut pushed, mut share) = (NO_CORNERS, NO_CORNERS, shares.begin());
            let (mut work, mut passing) = (Lane::of(0.0), CellForce::default());
            let (mut shapes, mut steps) = (Shapes::default(), Steps::default());
            let mut densities = Lane::of(0.0);
            let mut forces = forces.map(|forces| forces.iter_mut());
            for (tile, fill) in range.zip(fills) {
                let nodes = active.tile_nodes(tile);
                let own = forces.as_mut().and_then(|forces| forces.next());
                let kept = own.is_some();
                let force = own.unwrap_or(&mut passing);
                shapes.enter_and_sum(simd, &mut densities, nodes, &shared.places);
                let sum = &sums[tile];
                prefetch_record(sums, tile + RECORDS_AHEAD);
                let is_cell = &active.is_cell.as_chunks().0[tile];
                find_filled(simd, &densities, is_cell, mixed, fill);
                if !kept && are_void(sum, fill) {
                    continue;
                }
                let mut empty = false;
                stand_in(simd, &shapes, sum, fill, force, &mut empty);
                steps.add(simd, &limits, &shapes, sum, medium.get(tile), fill);
                if reference.is_some() {
                    force.weighed = medium[tile].shares;
                }
                let looked_at = if empty || reference.is_some() {
                    LANES
                } else {
                    0
                };
                for l in 0..looked_at {
                    if fill.filled[l] == 0.0 || (sum.volume[l] > 0.0 && reference.is_none()) {
                        continue;
                    }
                    let c = tile * LANES + l;
                    let e = active.elements[c] as usize;
                    let around = around(c, active, mesh, sums, medium);
                    let mean = match &reference {
                        Some(reference) => {
                            let shares = get(&medium[tile].shares, l);
                            let weighed = reference.weighed(mesh, e, shares, &around);
                            set(&mut force.weighed, l, weighed);
                            reference.mean_stress(mesh, e, &around)
                        }
                        None => around.mean_stress(),
                    };
                    set(&mut force.stress, l, mean.map(|s| s * mesh.volumes[e]));
                }
                if per_step > 0.0 {
                    load_nodes(simd, &mut moved, nodes, &shared.moved);
                    let moduli = match medium.get(tile) {
                        Some(medium) => medium.moduli,
                        None => alike.map(|m| times(m, &sum.volume)),
                    };
                    let cells = Resisting {
                        shapes: &shapes,
                        sum,
                        fill,
                        moduli: &moduli,
                    };
                    resist(simd, &cells, force, &moved, per_step, &mut work);
                } else if viscosity > 0.0 {
                    force.viscous = [Lane::of(0.0); 6];
                }
                if last {
                    push(simd, &shapes, force, nodes, &mut pushed, &mut share);
                }
            }
            (lanes::sum(&work), steps.shortest(&limits))
        });
    *shortest = least.0;
    ledger.viscous_work(work);
}

fn times(factor: f64, lane: &Lane) -> Lane {
    Lane::from(lane.map(|x| factor * x))
}

for_each_simd! {
    /// Which cells count as filled, and the density of these.
    fn find_filled(
        densities: &Lane,
        is_cell: &[bool; LANES],
        mixed: bool,
        fill: &mut CellFill,
    ) {
        for l in 0..LANES {
            let filled = mixed & is_cell[l] & (densities[l] < NOT_FULL);
            fill.filled[l] = either(filled, 1.0, 0.0);
            fill.density[l] = 0.25 * densities[l];
        }
    }
}

for_each_simd! {
    /// The stress of cells of which the particles, and no others, decide; says whether any is filled and has none.
    fn stand_in(
        shapes: &Shapes,
        sum: &CellSums,
        fill: &CellFill,
        force: &mut CellForce,
        empty: &mut bool,
    ) {
        *empty = false;
        for l in 0..LANES {
            *empty |= (fill.filled[l] > 0.0) & (sum.volume[l] <= 0.0);
            let (filled, volume) = (fill.filled[l] > 0.0, sum.volume[l]);
            // Of cells that are filled, but have no particles, neighbours decide.
            let fuller = either(filled, shapes.volume[l] / volume, 1.0);
            for k in 0..6 {
                force.stress[k][l] = sum.stress[k][l] * fuller;
            }
            force.smoothed[l] = 0.0;
        }
    }
}

/// Cells side by side that resist by viscosity.
struct Resisting<'a> {
    shapes: &'a Shapes,
    sum: &'a CellSums,
    fill: &'a CellFill,
    moduli: &'a [Lane; 2],
}

for_each_simd! {
    /// Viscous stresses, and half their work in the last drift; `per_step` is what a strain of it is multiplied by.
    fn resist(
        cells: &Resisting,
        force: &mut CellForce,
        moved: &Corners,
        per_step: f64,
        work: &mut Lane,
    ) {
        let Resisting { shapes, sum, fill, moduli } = cells;
        for l in 0..LANES {
            let full = (fill.filled[l] > 0.0) & (sum.volume[l] > 0.0);
            let fuller = either(full, shapes.volume[l] / sum.volume[l], 1.0);
            let moduli = get(moduli, l).map(|m| m * per_step * fuller);
            let gradient = strain::gradient(&shapes.gradients(l), all_corners(moved, l));
            let viscous = viscous(&gradient, moduli);
            set(&mut force.viscous, l, viscous);
            work[l] += 0.5 * tensor::dot(&viscous, &tensor::strain(&gradient));
        }
    }
}

/// Gives nodes f_i = −S ∇N_i and the mass whose weight pulls at them.
pub(super) fn push(
    simd: Simd,
    shapes: &Shapes,
    force: &CellForce,
    nodes: TileNodes,
    pushed: &mut Corners,
    share: &mut Share<Quad, 1>,
) {
    find_forces(simd, shapes, force, pushed);
    share.give(simd, nodes, pushed, &force.weighed);
}

for_each_simd! {
    fn find_forces(shapes: &Shapes, force: &CellForce, pushed: &mut Corners) {
        for l in 0..LANES {
            for (i, f) in nodal(l, shapes, force).into_iter().enumerate() {
                set_corner(pushed, l, i, f);
            }
        }
    }
}

/// f_i = −S ∇N_i.
#[inline(always)]
fn nodal(l: usize, shapes: &Shapes, force: &CellForce) -> [Vec3; 4] {
    let (cell, viscous) = (get(&force.stress, l), get(&force.viscous, l));
    let stress: Voigt = std::array::from_fn(|k| cell[k] + viscous[k]);
    let [b, c, d] = shapes.gradients(l);
    [-(b + c + d), b, c, d].map(|g| -tensor::times(&stress, g))
}

/// Sums that make the mean of a cell.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Around {
    /// Σ σ_p V_p, J.
    pub stress: Voigt,
    /// Σ V_p, m³.
    pub volume: f64,
    /// As [`CellMedium::reference`].
    pub reference: [f64; 3],
}

impl Around {
    /// σ̄ = Σ σ_p V_p / Σ V_p, Pa.
    pub fn mean_stress(&self) -> Voigt {
        if self.volume > 0.0 {
            self.stress.map(|s| s / self.volume)
        } else {
            self.stress
        }
    }

    fn add(&mut self, l: usize, sum: &CellSums, medium: Option<&CellMedium>) {
        add_scaled(&mut self.stress, &get(&sum.stress, l), 1.0);
        self.volume += sum.volume[l];
        if let Some(medium) = medium {
            for (own, more) in self.reference.iter_mut().zip(get(&medium.reference, l)) {
                *own += more;
            }
        }
    }
}

/// Sums over the particles of a cell; without any, over those of the cells across its faces, walls
/// excepted.
fn around(
    c: usize,
    active: &Active,
    mesh: &Mesh,
    sums: &[CellSums],
    medium: &[CellMedium],
) -> Around {
    let mut around = Around::default();
    let (tile, l) = lane_of(c);
    if sums[tile].volume[l] > 0.0 {
        around.add(l, &sums[tile], medium.get(tile));
        return around;
    }
    for &neighbour in mesh.neighbours[active.elements[c] as usize]
        .iter()
        .filter(|&&n| n != NONE)
    {
        let other = active.cell(neighbour as usize, usize::from(active.fields[c]));
        if let Some(other) = other.filter(|&other| active.share_a_face(c, other)) {
            let (tile, l) = lane_of(other);
            around.add(l, &sums[tile], medium.get(tile));
        }
    }
    around
}

/// Moduli (λ, G) times strain.
#[inline(always)]
fn viscous(gradient: &Mat3, [lame, shear]: [f64; 2]) -> Voigt {
    let strain = tensor::strain(gradient);
    let pressure = lame * tensor::trace(&strain);
    std::array::from_fn(|k| {
        if k < 3 {
            pressure + 2.0 * shear * strain[k]
        } else {
            shear * strain[k]
        }
    })
}
