//! The return map on a million random predictors, against its definition: the planes, the flow
//! and Hooke's law are written down here again, for all six and three planes.

use super::*;
use crate::Mat3;
use crate::random::Random;
use crate::tensor::{dot, rotate};

/// Normal and flow direction of a plane n·σ ≤ b in the space of principal stresses.
struct Plane {
    normal: [f64; 3],
    flow: [f64; 3],
    bound: f64,
}

fn inner(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// All planes, in no order of the principal stresses.
fn planes(p: &MohrCoulombParameters) -> Vec<Plane> {
    let mut all = Vec::new();
    let along = |angle: f64, i: usize, j: usize| {
        let mut v = [0.0; 3];
        v[i] = 1.0 + libm::sin(angle);
        v[j] = libm::sin(angle) - 1.0;
        v
    };
    for (i, j) in [(0, 1), (1, 0), (1, 2), (2, 1), (2, 0), (0, 2)] {
        all.push(Plane {
            normal: along(p.friction_angle, i, j),
            flow: along(p.dilation_angle, i, j),
            bound: 2.0 * p.cohesion * libm::cos(p.friction_angle),
        });
    }
    if let Some(cutoff) = p.tension_cutoff {
        for i in 0..3 {
            let mut v = [0.0; 3];
            v[i] = 1.0;
            all.push(Plane {
                normal: v,
                flow: v,
                bound: cutoff,
            });
        }
    }
    all
}

fn excess(planes: &[Plane], s: [f64; 3]) -> f64 {
    planes
        .iter()
        .map(|p| inner(p.normal, s) - p.bound)
        .fold(f64::NEG_INFINITY, f64::max)
}

/// Distance of `e` from the cone of the directions: over all sets of at most three of them, the
/// residual of the combination, or infinity if a factor is negative by more than `tolerance`.
fn distance_from_cone(directions: &[[f64; 3]], e: [f64; 3], tolerance: f64) -> f64 {
    let residual = |parts: &[([f64; 3], f64)]| {
        let rest = parts
            .iter()
            .fold(e, |r, (d, f)| std::array::from_fn(|i| r[i] - d[i] * f));
        rest.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
    };
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    };
    let positive = |f: f64| f >= -tolerance;
    let mut best = f64::INFINITY;
    for (i, &a) in directions.iter().enumerate() {
        let f = inner(a, e) / inner(a, a);
        if positive(f) {
            best = best.min(residual(&[(a, f)]));
        }
        for (j, &b) in directions[..i].iter().enumerate() {
            let (aa, ab, bb) = (inner(a, a), inner(a, b), inner(b, b));
            let determinant = aa * bb - ab * ab;
            if determinant > 1e-9 {
                let f = (inner(a, e) * bb - inner(b, e) * ab) / determinant;
                let g = (inner(b, e) * aa - inner(a, e) * ab) / determinant;
                if positive(f) && positive(g) {
                    best = best.min(residual(&[(a, f), (b, g)]));
                }
            }
            for &c in &directions[..j] {
                let volume = inner(a, cross(b, c));
                if volume.abs() > 1e-9 {
                    let f = inner(e, cross(b, c)) / volume;
                    let g = inner(e, cross(c, a)) / volume;
                    let h = inner(e, cross(a, b)) / volume;
                    if positive(f) && positive(g) && positive(h) {
                        best = best.min(residual(&[(a, f), (b, g), (c, h)]));
                    }
                }
            }
        }
    }
    best
}

fn soils() -> Vec<MohrCoulomb> {
    let mut soils = Vec::new();
    // c, φ, ψ, share of c cot φ (of c for φ = 0), ν
    for (c, phi, psi, share, nu) in [
        (0.0, 30.0, 0.0, None, 0.3),
        (0.0, 35.0, 35.0, None, 0.2),
        (5e3, 25.0, 25.0, None, 0.3),
        (5e3, 25.0, 25.0, Some(0.4), 0.3),
        (5e3, 30.0, 10.0, None, 0.0),
        (5e3, 30.0, 0.0, None, 0.4),
        (5e3, 30.0, 0.0, Some(0.0), 0.3),
        (5e3, 30.0, 30.0, Some(0.0), 0.3),
        (5e3, 40.0, 5.0, Some(0.7), 0.2),
        (5e3, 20.0, 1e-4, None, 0.3),
        (5e3, 30.0, 30.0, Some(1.0 - 1e-7), 0.3),
        (5e3, 70.0, 20.0, Some(0.5), 0.3),
        (1e4, 0.0, 0.0, Some(0.5), 0.49),
        (1e4, 0.0, 0.0, Some(1e3), 0.49),
        (1e4, 0.0, 0.0, Some(0.0), 0.3),
        (1.0, 0.01, 0.01, Some(0.01), 0.45),
    ] as [(f64, f64, f64, Option<f64>, f64); 16]
    {
        let (phi, psi) = (phi.to_radians(), psi.to_radians());
        let unit = if phi > 0.0 { c / libm::tan(phi) } else { c };
        let elastic = LinearElastic {
            young_modulus: 2e7,
            poisson_ratio: nu,
        };
        let parameters = MohrCoulombParameters {
            cohesion: c,
            friction_angle: phi,
            dilation_angle: psi,
            tension_cutoff: share.map(|s| s * unit),
        };
        soils.push(MohrCoulomb::new(elastic, parameters).unwrap());
    }
    soils
}

/// A point on or near the surface: the return of a random predictor of size `reach`.
fn on_surface(soil: &MohrCoulomb, random: &mut Random, reach: f64) -> [f64; 3] {
    let t: [f64; 3] = std::array::from_fn(|_| random.within(-reach, reach));
    let s = soil.return_map(&[t[0], t[1], t[2], 0.0, 0.0, 0.0]).stress;
    [s[0], s[1], s[2]]
}

/// Principal predictors: most at random, every tenth within 1e-6 of an edge, corner or apex.
fn predictor(soil: &MohrCoulomb, random: &mut Random, n: u64) -> [f64; 3] {
    let p = soil.parameters();
    let unit = (p.cohesion + soil.tensile_strength().min(10.0 * p.cohesion)).max(100.0);
    let reach = unit * libm::exp2(random.within(-4.0, 12.0));
    let mut t: [f64; 3] = std::array::from_fn(|_| random.within(-reach, reach));
    if n.is_multiple_of(2) {
        // Compressed, as soil mostly is.
        t = t.map(|t| 0.5 * (t - reach));
    }
    if n.is_multiple_of(10) {
        t = match n / 10 % 3 {
            0 => [soil.tensile_strength(); 3],
            1 => {
                // Mostly on edges: predictors with two equal values.
                let [a, b, _] = t;
                let s = soil.return_map(&[a, a, b, 0.0, 0.0, 0.0]).stress;
                [s[0], s[1], s[2]]
            }
            _ => on_surface(soil, random, reach),
        };
        let scale = 1e-6 * t.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
        t = t.map(|t| t + random.within(-scale, scale));
    }
    t
}

#[test]
fn a_million_random_predictors_are_returned_as_the_equations_say() {
    let soils = soils();
    let all_planes: Vec<Vec<Plane>> = soils.iter().map(|s| planes(s.parameters())).collect();
    let mut random = Random::new(20);
    let mut visits = [0u32; 5];
    for n in 0..1_000_000u64 {
        let which = (random.bits() % soils.len() as u64) as usize;
        let (soil, planes) = (&soils[which], &all_planes[which]);
        let elastic = soil.elastic();
        let p = *soil.parameters();
        let principal = predictor(soil, &mut random, n);
        let turn = random.rotation();
        let [a, b, c] = principal;
        let trial = rotate(&[a, b, c, 0.0, 0.0, 0.0], &turn);
        let size = principal.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
        // For φ = 0, which has no apex, the predictor alone.
        let scale = size.max(p.apex().unwrap_or(0.0));

        let step = soil.return_map(&trial);
        visits[step.yielding as usize] += 1;
        let told = || format!("{p:?} {principal:?} {step:?}");

        // Admissible, unchanged by a second return, and turned if the predictor is turned.
        assert!(
            soil.yield_function(&step.stress) <= 1e-8 * scale,
            "{}",
            told()
        );
        let back = rotate(&step.stress, &turn.transpose());
        let s = [back[0], back[1], back[2]];
        assert!(excess(planes, s) <= 1e-8 * scale, "{}", told());
        assert!(
            back[3..].iter().all(|x| x.abs() <= 1e-9 * scale),
            "{}",
            told()
        );
        let near =
            |x: &Voigt, y: &Voigt| x.iter().zip(y).all(|(x, y)| (x - y).abs() <= 1e-9 * scale);
        assert!(
            near(&soil.return_map(&step.stress).stress, &step.stress),
            "{}",
            told()
        );
        let another = random.rotation();
        let turned = soil.return_map(&rotate(&trial, &another));
        assert!(
            near(&turned.stress, &rotate(&step.stress, &another)),
            "{}",
            told()
        );

        // Hooke's law for the elastic part, and work that is never gained.
        let elastic_part = elastic.update(&step.stress, &step.plastic_strain);
        assert!(near(&elastic_part, &trial), "{}", told());
        let strain_scale = scale / elastic.young_modulus;
        let work = dot(&step.stress, &step.plastic_strain);
        assert!(work >= -1e-12 * scale * strain_scale, "{work} {}", told());
        if step.yielding == YieldState::Elastic {
            assert_eq!(step.stress, trial);
            continue;
        }

        // The plastic strain lies in the cone of the active planes' flow directions.
        let nu = elastic.poisson_ratio;
        let d: [f64; 3] = std::array::from_fn(|i| principal[i] - s[i]);
        let sum = d[0] + d[1] + d[2];
        let e = d.map(|d| (1.0 + nu) * d - nu * sum);
        let mut active: Vec<[f64; 3]> = planes
            .iter()
            .filter(|p| inner(p.normal, s) - p.bound >= -1e-9 * scale)
            .map(|p| p.flow)
            .collect();
        if p.dilation_angle < 1e-3 && step.yielding == YieldState::Apex {
            // For ψ = 0 the closure of the cone at the apex.
            active.push([1.0; 3]);
        }
        let distance = distance_from_cone(&active, e, 1e-9 * scale);
        assert!(distance <= 1e-8 * scale, "{distance} {active:?} {}", told());
        let volume: f64 = e.iter().sum();
        assert!(step.opening >= 0.0);
        if p.dilation_angle == 0.0 {
            // Without dilation all volume is opening.
            let opening = step.opening * elastic.young_modulus;
            assert!((volume - opening).abs() <= 1e-9 * scale, "{}", told());
        }

        // For ψ = φ the return is the closest admissible stress in the norm of C⁻¹.
        if p.dilation_angle == p.friction_angle {
            for _ in 0..2 {
                let reach = size * libm::exp2(random.within(-3.0, 1.0));
                let tau = on_surface(soil, &mut random, reach);
                let towards = std::array::from_fn(|i| tau[i] - s[i]);
                let size = scale.max(reach);
                assert!(
                    inner(e, towards) <= 1e-8 * size * size,
                    "{tau:?} {}",
                    told()
                );
            }
        }
    }
    // Every state is met often.
    assert!(visits.iter().all(|&v| v > 20_000), "{visits:?}");
}

#[test]
fn every_corner_is_met_and_the_choice_has_no_gaps() {
    use super::corners::Corner;
    let mut random = Random::new(1);
    let mut corners: Vec<Corner> = Vec::new();
    for soil in soils() {
        for n in 0..20_000 {
            let mut t = predictor(&soil, &mut random, n);
            t.sort_by(|a, b| b.total_cmp(a));
            if soil.corners.yield_function(t[0], t[2]) > 0.0 {
                let found = soil.corners.return_map(&t);
                let size = t.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
                let scale = size.max(soil.parameters().apex().unwrap_or(0.0));
                assert!(found.violation <= 1e-12 * scale, "{soil:?} {t:?} {found:?}");
                if !corners.contains(&found.corner) {
                    corners.push(found.corner);
                }
            }
        }
    }
    assert_eq!(corners.len(), 10, "{corners:?}");
}

#[test]
fn symmetric_predictors_have_exactly_symmetric_results() {
    for soil in soils() {
        for p in [-1e5, -1.0, 0.0, 1.0, 1e5, 1e8] {
            let step = soil.return_map(&[p, p, p, 0.0, 0.0, 0.0]);
            let expected = p.min(soil.tensile_strength());
            assert_eq!(step.stress, [expected, expected, expected, 0.0, 0.0, 0.0]);
        }
        // Equal and unequal values along the axes.
        let step = soil.return_map(&[3e4, -1e5, -1e5, 0.0, 0.0, 0.0]);
        assert!((step.stress[1] - step.stress[2]).abs() < 1e-9);
        assert!(step.stress[3..].iter().all(|&x| x.abs() < 1e-9));
    }
}

#[test]
fn steps_without_strain_or_with_mirrored_frames_change_nothing() {
    let mut random = Random::new(7);
    let mirror = Mat3::from_diagonal(crate::Vec3::new(-1.0, 1.0, 1.0));
    for soil in soils() {
        for n in 0..100 {
            let [a, b, c] = predictor(&soil, &mut random, n);
            let trial = rotate(&[a, b, c, 0.0, 0.0, 0.0], &random.rotation());
            let step = soil.return_map(&trial);
            let scale = 1e-9 * trial.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
            let mut state = MohrCoulombState::default();
            let still = soil.update(&step.stress, &[0.0; 6], &mut state);
            let mirrored = soil.return_map(&rotate(&trial, &mirror));
            let expected = rotate(&step.stress, &mirror);
            for k in 0..6 {
                assert!((still.stress[k] - step.stress[k]).abs() <= scale);
                assert!((mirrored.stress[k] - expected[k]).abs() <= scale);
            }
        }
    }
}
