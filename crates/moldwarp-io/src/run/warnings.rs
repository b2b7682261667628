//! What to doubt in a run that has ended.

use super::whole;
use moldwarp::Simulation;
use moldwarp::measure::Energies;

/// A residual above this part of the energy turned over is no round-off.
pub(crate) const RESIDUAL: f64 = 1e-6;
/// Numerical terms above this part of it: the run is too coarse, or unstable.
pub(crate) const NUMERICAL: f64 = 0.05;

/// One sentence each; none if there is nothing to say.
pub(super) fn warnings(sim: &Simulation) -> Vec<String> {
    let mut all = of_ledger(&whole::energies(sim), whole::energy_turned_over(sim));
    let lost = sim.lost_particles();
    if lost > 0 {
        all.push(format!(
            "{lost} particles are missing: do not use the results, and please report it"
        ));
    }
    let foreign = sim.foreign_particles();
    if foreign > 0 {
        all.push(format!(
            "{foreign} particles are in elements of another body of an aligned contact at the end"
        ));
    }
    all
}

fn of_ledger(energies: &Energies, turned_over: f64) -> Vec<String> {
    let mut all = Vec::new();
    let percent = |part: f64| format!("{:.2e} %", 100.0 * part / turned_over);
    // What is no number must warn, too.
    let within = |part: f64, most: f64| part <= most * turned_over;
    if !within(energies.residual.abs(), RESIDUAL) {
        all.push(format!(
            "the energy ledger does not close: {} of the energy turned over is missing; do not use the \
             results, and please report it",
            percent(energies.residual.abs())
        ));
    }
    if !within(energies.numerical(), NUMERICAL) {
        all.push(format!(
            "numerical terms are {} of the energy turned over, more than {} %: refine the mesh, or take more \
             particles or some viscosity, and compare",
            percent(energies.numerical()),
            100.0 * NUMERICAL
        ));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ledger_that_does_not_close_is_doubted() {
        let mut e = Energies {
            transfer: -0.03,
            smoothing: 0.015,
            residual: 1e-7,
            ..Energies::default()
        };
        assert_eq!(of_ledger(&e, 1.0), Vec::<String>::new());
        assert_eq!(of_ledger(&Energies::default(), 0.0), Vec::<String>::new());
        e.integration = -0.01;
        let said = of_ledger(&e, 1.0);
        assert!(
            said.len() == 1 && said[0].starts_with("numerical terms are 5.50e0 %"),
            "{said:?}"
        );
        e.residual = -2e-6;
        assert!(of_ledger(&e, 1.0)[0].starts_with("the energy ledger does not close: 2.00e-4 %"));
        e.residual = f64::NAN;
        assert_eq!(of_ledger(&e, 1.0).len(), 2);
    }
}
