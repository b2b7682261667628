//! Element tests: one stress point driven by strain, against closed forms.

use super::*;
use crate::random::Random;
use crate::tensor::{dot, trace};

const ELASTIC: LinearElastic = LinearElastic {
    young_modulus: 2e7,
    poisson_ratio: 0.3,
};

fn soil(c: f64, phi: f64, psi: f64, tension_cutoff: Option<f64>) -> MohrCoulomb {
    let parameters = MohrCoulombParameters {
        cohesion: c,
        friction_angle: phi.to_radians(),
        dilation_angle: psi.to_radians(),
        tension_cutoff,
    };
    MohrCoulomb::new(ELASTIC, parameters).unwrap()
}

fn isotropic(p: f64) -> Voigt {
    [p, p, p, 0.0, 0.0, 0.0]
}

fn assert_near(a: &Voigt, b: &Voigt, tolerance: f64) {
    let near = a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance);
    assert!(near, "{a:?} is not {b:?}");
}

/// Triaxial test along z by axial strain, the lateral stress held by iterating on the lateral
/// strain. Returns the last axial stress, and plastic volume per plastic axial strain.
fn triaxial(soil: &MohrCoulomb, cell: f64, axial_strain: f64) -> (f64, f64) {
    let mut stress = isotropic(cell);
    let mut state = MohrCoulombState::default();
    let (mut volume, mut axial) = (0.0, 0.0);
    let steps = 200;
    let axial_increment = axial_strain / steps as f64;
    let mut lateral = -0.3 * axial_increment;
    for n in 0..steps {
        // Secant: the lateral stress rises with the lateral strain.
        let try_with = |lateral: f64| {
            let strain = [lateral, lateral, axial_increment, 0.0, 0.0, 0.0];
            let mut state = state;
            let step = soil.update(&stress, &strain, &mut state);
            (step.stress[0] - cell, step, state)
        };
        let (mut x0, mut x1) = (lateral, lateral + 1e-7);
        let mut y0 = try_with(x0).0;
        for _ in 0..50 {
            let y1 = try_with(x1).0;
            if y1.abs() < 1e-9 * cell.abs() || y1 == y0 {
                break;
            }
            (x0, x1, y0) = (x1, x1 - y1 * (x1 - x0) / (y1 - y0), y1);
        }
        lateral = x1;
        let (error, step, new) = try_with(lateral);
        assert!(error.abs() < 1e-7 * cell.abs(), "step {n}: {error}");
        (stress, state) = (step.stress, new);
        (volume, axial) = (step.plastic_volume(), step.plastic_strain[2]);
    }
    assert_eq!(state.yielding, YieldState::Edge);
    (stress[2], volume / axial)
}

#[test]
fn triaxial_compression_and_extension_reach_the_closed_form() {
    for (c, phi, psi) in [(0.0, 30.0, 0.0), (5e3, 25.0, 10.0), (2e3, 40.0, 40.0)] {
        let soil = soil(c, phi, psi, None);
        let cell = -1e5;
        let (s, s_psi) = (
            libm::sin(f64::to_radians(phi)),
            libm::sin(f64::to_radians(psi)),
        );
        let n = (1.0 + s) / (1.0 - s);
        let flow = (1.0 + s_psi) / (1.0 - s_psi);
        // σ_a = N σ_c − 2c √N; the axial plastic strain is −(1 − sin ψ) for two lateral ones of
        // (1 + sin ψ)/2.
        let (axial, ratio) = triaxial(&soil, cell, -0.05);
        let peak = n * cell - 2.0 * c * n.sqrt();
        assert!((axial / peak - 1.0).abs() < 1e-6, "{axial} {peak}");
        assert!((ratio - (1.0 - flow)).abs() < 1e-6, "{ratio}");
        // σ_c = N σ_a − 2c √N
        let (axial, ratio) = triaxial(&soil, cell, 0.05);
        let peak = (cell + 2.0 * c * n.sqrt()) / n;
        assert!((axial / peak - 1.0).abs() < 1e-6, "{axial} {peak}");
        assert!((ratio - (1.0 - 1.0 / flow)).abs() < 1e-6, "{ratio}");
    }
    // Tresca: 2 c_u in both.
    let clay = soil(1e4, 0.0, 0.0, Some(1e9));
    assert!((triaxial(&clay, -1e5, -0.05).0 + 1.2e5).abs() < 0.1);
    assert!((triaxial(&clay, -1e5, 0.05).0 + 0.8e5).abs() < 0.1);
}

#[test]
fn simple_shear_yields_at_the_coulomb_line_and_dilates_with_psi() {
    let (c, phi, p) = (5e3, 30f64, 1e5);
    for psi in [0f64, 10.0, 30.0] {
        let soil = soil(c, phi, psi, None);
        let mut stress = isotropic(-p);
        let mut state = MohrCoulombState::default();
        let increment = [0.0, 0.0, 0.0, 1e-4, 0.0, 0.0];
        let (sin, cos) = (libm::sin(phi.to_radians()), libm::cos(phi.to_radians()));
        let sin_psi = libm::sin(psi.to_radians());
        for _ in 0..200 {
            let mean_before = trace(&stress) / 3.0;
            let step = soil.update(&stress, &increment, &mut state);
            stress = step.stress;
            // The circle of σ₁ and σ₃ in the plane touches the line.
            let (centre, radius) = (0.5 * (stress[0] + stress[1]), stress[3]);
            let f = radius + centre * sin - c * cos;
            assert!(f < 1e-6);
            if state.yielding == YieldState::Shear {
                assert!(f.abs() < 1e-6, "{f}");
                let e = step.plastic_strain;
                assert!((e[0] + e[1] - sin_psi * e[3]).abs() < 1e-12);
                assert!(e[2].abs() < 1e-12);
                // Held volume: pressure grows by K times the dilation.
                let bulk = 2e7 / (3.0 * (1.0 - 0.6));
                let mean = trace(&stress) / 3.0;
                assert!((mean - mean_before + bulk * step.plastic_volume()).abs() < 1e-6);
            }
        }
        assert_eq!(state.yielding, YieldState::Shear);
        if psi == 0.0 {
            assert_near(&stress, &[-p, -p, -p, p * sin + c * cos, 0.0, 0.0], 1e-6);
            // All strain but the elastic part τ/G: √(2/3 · ½ γ²) = γ/√3.
            let plastic = 0.02 - stress[3] / ELASTIC.shear_modulus();
            assert!((state.plastic_shear - plastic / 3f64.sqrt()).abs() < 1e-12);
            assert!(state.plastic_volume.abs() < 1e-15);
        }
    }
}

#[test]
fn isotropic_tension_ends_at_the_apex_or_the_cutoff() {
    let apex = 5e3 / libm::tan(30f64.to_radians());
    for (cutoff, strength, name) in [
        (None, apex, YieldState::Apex),
        (Some(2e3), 2e3, YieldState::Tension),
    ] {
        for psi in [0.0, 30.0] {
            let soil = soil(5e3, 30.0, psi, cutoff);
            let mut stress = isotropic(-1e4);
            let mut state = MohrCoulombState::default();
            let mut first = None;
            for _ in 0..100 {
                stress = soil.update(&stress, &isotropic(1e-5), &mut state).stress;
                if state.yielding != YieldState::Elastic {
                    first.get_or_insert(state.yielding);
                }
            }
            assert_eq!(first, Some(name));
            assert_near(&stress, &isotropic(strength), 1e-9);
            let bulk = soil.bulk_modulus;
            assert!((state.opening - (3e-3 - (strength + 1e4) / bulk)).abs() < 1e-15);
            assert!((state.opening - state.plastic_volume).abs() < 1e-15);
        }
    }
}

#[test]
fn a_path_through_an_edge_goes_from_plane_to_edge_to_plane() {
    // Extension of z at fixed x, then of x while z shortens: the largest stress changes from z to x.
    let soil = soil(2e3, 30.0, 10.0, None);
    let mut stress = [-1e5, -3e5, -1.2e5, 0.0, 0.0, 0.0];
    let mut state = MohrCoulombState::default();
    let mut seen = Vec::new();
    for n in 0..400 {
        let (x, z) = if n < 100 { (0.0, 2e-5) } else { (2e-5, -1e-5) };
        let before = stress;
        let step = soil.update(&stress, &[x, -1e-5, z, 0.0, 0.0, 0.0], &mut state);
        stress = step.stress;
        if seen.last() != Some(&state.yielding) {
            seen.push(state.yielding);
        }
        assert!(soil.yield_function(&stress).abs() < 1e-6 || state.yielding == YieldState::Elastic);
        assert!(dot(&stress, &step.plastic_strain) >= 0.0);
        // The stress has no jumps.
        assert!((0..3).all(|k| (stress[k] - before[k]).abs() < 3000.0));
        match state.yielding {
            YieldState::Edge => assert!((stress[0] - stress[2]).abs() < 1e-6),
            YieldState::Shear => assert!((stress[0] - stress[2]).abs() > 1e-6),
            _ => {}
        }
    }
    use YieldState::{Edge, Shear};
    assert!(seen.ends_with(&[Shear, Edge, Shear]), "{seen:?}");
    assert!(stress[0] > stress[2]);
}

#[test]
fn expansion_and_compression_by_the_same_strain_lead_back() {
    for (soil, p) in [
        (soil(0.0, 30.0, 0.0, None), -1e4),
        (soil(0.0, 30.0, 30.0, None), -1e4),
        (soil(5e3, 30.0, 10.0, None), -1e4),
        (soil(5e3, 30.0, 10.0, Some(1e3)), -1e4),
        (soil(5e3, 0.0, 0.0, Some(0.0)), -1e4),
        (soil(0.0, 30.0, 0.0, None), 0.0),
    ] {
        let mut state = MohrCoulombState::default();
        let mut stress = isotropic(p);
        let (mut work, mut plastic_work, mut spent) = (0.0, 0.0, 0.0);
        // 10 % out, 10 % back, in steps of different size.
        let steps = [(1500, 1.0 / 1500.0), (4000, -1.0 / 4000.0)];
        for (count, share) in steps {
            for n in 0..count {
                let strain = isotropic(share * 0.1 / 3.0);
                let step = soil.update(&stress, &strain, &mut state);
                let middle: Voigt = std::array::from_fn(|k| 0.5 * (stress[k] + step.stress[k]));
                work += dot(&middle, &strain);
                plastic_work += dot(&step.stress, &step.plastic_strain);
                assert!(dot(&step.stress, &step.plastic_strain) >= -1e-12);
                stress = step.stress;
                // No pressure while it closes: back at zero stress when 1e4 Pa of elastic
                // expansion are left to be undone.
                if share < 0.0 && n < 3800 {
                    assert!(trace(&stress) >= 0.0);
                }
            }
            if share > 0.0 {
                assert_near(&stress, &isotropic(soil.tensile_strength()), 1e-9);
                assert!(state.opening > 0.098);
                spent = soil.tensile_strength() * state.opening;
                assert_eq!(state.yielding, YieldState::Tension);
            }
        }
        assert_near(&stress, &isotropic(p), 1e-6);
        assert!(state.opening < 1e-12, "{}", state.opening);
        assert!(state.plastic_volume.abs() < 1e-12);
        // What went in is what tension dissipated: T times the opening. The steps with a bend in
        // the stress's path are wrong by up to an eighth of a step's strain times 1e4 Pa each.
        assert!(
            (plastic_work - spent).abs() < 1e-9 * spent + 1e-6,
            "{plastic_work} {spent}"
        );
        assert!((work - spent).abs() < 1e-9 * spent + 0.2, "{work} {spent}");
    }
}

#[test]
fn flying_sand_feels_nothing_until_it_is_back_at_its_volume() {
    // Random strains of up to 1e-3 a step with shear; the volume is what counts.
    let sand = soil(0.0, 35.0, 5.0, None);
    let mut random = Random::new(5);
    let mut state = MohrCoulombState::default();
    let mut stress = [0.0; 6];
    let mut volume = 0.0;
    for n in 0..10_000 {
        let outward = if n < 1000 { 1e-4 } else { 0.0 };
        let mut strain: Voigt = std::array::from_fn(|_| random.within(-1e-3, 1e-3));
        strain[0] += outward;
        // Never beyond the volume it had.
        if volume + trace(&strain) < 1e-6 && n > 0 {
            continue;
        }
        if n == 0 {
            strain = [2e-2, 0.0, 0.0, 0.0, 0.0, 0.0];
        }
        volume += trace(&strain);
        stress = sand.update(&stress, &strain, &mut state).stress;
        assert_eq!(stress, [0.0; 6]);
        assert!((state.opening - volume).abs() < 1e-12);
    }
    // Landing in one direction, within one step: what is left over acts.
    let beyond = 1e-4;
    let landing = [-(state.opening + beyond), 0.0, 0.0, 0.0, 0.0, 0.0];
    let step = sand.update(&stress, &landing, &mut state);
    let fresh = sand.update(
        &[0.0; 6],
        &[-beyond, 0.0, 0.0, 0.0, 0.0, 0.0],
        &mut MohrCoulombState::default(),
    );
    assert_near(&step.stress, &fresh.stress, 1e-6);
    assert!(trace(&step.stress) < -100.0);
    assert_eq!(state.opening, 0.0);
}

#[test]
fn no_cycle_of_strains_creates_energy() {
    // Closed cycles of random strains through compression, shear, tension and flight give work.
    let mut random = Random::new(11);
    for soil in [
        soil(0.0, 30.0, 0.0, None),
        soil(0.0, 30.0, 30.0, None),
        soil(5e3, 30.0, 10.0, None),
        soil(5e3, 30.0, 0.0, Some(1e3)),
        soil(5e3, 30.0, 30.0, Some(0.0)),
        soil(1e4, 0.0, 0.0, Some(2e3)),
    ] {
        let stored = |s: &Voigt| 0.5 * dot(s, &soil.compliance(s));
        let mut state = MohrCoulombState::default();
        let mut stress = isotropic(-2e3);
        for _ in 0..50_000 {
            let size = libm::exp2(random.within(-18.0, -9.0));
            let strain: Voigt = std::array::from_fn(|_| random.within(-size, size));
            let step = soil.update(&stress, &strain, &mut state);
            // Work of the step, with the stress at its end: more than what is stored (backward
            // Euler), so that the plastic work is never negative.
            let work = dot(&step.stress, &strain);
            let scale = 1e-12 * (stored(&stress) + stored(&step.stress) + 1e4 * size);
            assert!(work >= stored(&step.stress) - stored(&stress) - scale);
            assert!(dot(&step.stress, &step.plastic_strain) >= -scale);
            assert!(state.opening >= 0.0);
            stress = step.stress;
        }
    }
}

#[test]
fn cohesive_soil_below_its_cutoff_is_plainly_elastic_plastic() {
    let soil = soil(5e3, 25.0, 5.0, Some(4e3));
    let mut random = Random::new(2);
    let mut state = MohrCoulombState::default();
    let mut stress = isotropic(-2e4);
    for _ in 0..10_000 {
        let strain: Voigt =
            std::array::from_fn(|k| random.within(-1e-4, 1e-4) - if k < 3 { 1e-6 } else { 0.0 });
        let expected = soil.return_map(&ELASTIC.update(&stress, &strain));
        let step = soil.update(&stress, &strain, &mut state);
        assert_eq!(step, expected);
        stress = step.stress;
        if expected.yielding == YieldState::Tension {
            break;
        }
        assert_eq!(state.opening, 0.0);
    }
}

#[test]
fn states_have_numbers_and_names() {
    for (n, state) in YieldState::ALL.into_iter().enumerate() {
        assert_eq!(state as usize, n);
        assert!(!state.name().is_empty());
    }
}
