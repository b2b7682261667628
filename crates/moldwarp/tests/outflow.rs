//! Material that leaves the mesh.

mod collapse;

use collapse::collapse;
use moldwarp::plan::{BoundaryKind, Until};
use moldwarp::{Plan, Simulation, Stop, Vec3};

const G: f64 = 9.81;

/// Sand that falls freely out of the bottom of its box.
fn falling(kind: BoundaryKind) -> Plan {
    let mut plan = collapse(4, 0.0);
    for boundary in &mut plan.boundaries {
        if boundary.name == "z-min" {
            boundary.kind = kind.clone();
        }
    }
    plan.stages[0].until = Until::Duration(0.3);
    plan
}

/// Free fall from rest: what was below ½ g t² has left, all of it is counted, and the ledger closes with the
/// energy of motion that it took along.
#[test]
fn what_falls_out_is_counted_and_booked() {
    let mut sim = Simulation::new(falling(BoundaryKind::Outflow)).unwrap();
    let (count, mass) = (sim.particles().len(), sim.particles().total_mass());
    while !sim.finished() {
        sim.step().unwrap();
        assert_eq!(sim.lost_particles(), 0);
    }
    let left = sim.outflown();
    assert_eq!(count - sim.particles().len(), left.particles as usize);
    let total = sim.particles().total_mass() + left.mass;
    assert!((total / mass - 1.0).abs() < 1e-13);
    let fallen = 0.5 * G * sim.time() * sim.time();
    let layer = 0.25 / 2.0;
    assert!(
        (left.mass / mass - fallen).abs() < layer,
        "{}",
        left.mass / mass
    );
    let e = sim.energies();
    assert!(e.removed > 0.0);
    assert!(e.residual.abs() < 1e-9 * sim.energy_turned_over(), "{e:?}");
}

/// When nothing is left the run says so; where there is no outflow, a particle that leaves stops it.
#[test]
fn an_empty_mesh_and_a_closed_one_stop_the_run() {
    let stop = |kind: BoundaryKind| {
        let mut plan = falling(kind);
        plan.stages[0].until = Until::Duration(2.0);
        let mut sim = Simulation::new(plan).unwrap();
        std::iter::repeat_with(|| sim.step()).find_map(Result::err)
    };
    let empty = stop(BoundaryKind::Outflow);
    assert!(matches!(empty, Some(Stop::Empty { .. })), "{empty:?}");
    let free = BoundaryKind::Fixed {
        directions: [true, false, false],
    };
    let left = stop(free);
    assert!(matches!(left, Some(Stop::LeftTheMesh { .. })), "{left:?}");
}

/// A velocity that is none is found at once. By then the nodes have told its neighbours.
#[test]
fn what_is_no_number_is_named() {
    let mut sim = Simulation::new(collapse(4, 0.0)).unwrap();
    let x = sim.particles().position.at(3);
    let wrong = move |y: Vec3| {
        if y == x {
            Vec3::splat(f64::NAN)
        } else {
            Vec3::ZERO
        }
    };
    let stop = sim.set_velocity(wrong).err();
    let Some(Stop::NotFinite {
        body,
        position,
        others,
        ..
    }) = stop
    else {
        panic!("{stop:?}");
    };
    assert_eq!(body, "block");
    assert!(others > 0 && (position - x).length() < 0.6, "{position}");
}
