//! What the ledger of one run comes to.
//!
//! Every run of the package goes through `setup::run_from`, which notes it here: the cases need not
//! know that they are tabulated. A case's runs all are on its own thread, and the tests' cases, which
//! are computed side by side, on threads of their own.

use moldwarp::Simulation;
use moldwarp::material::Material;
use moldwarp::measure::Energies;
use std::cell::RefCell;

thread_local! {
    static NOTED: RefCell<Vec<Entry>> = const { RefCell::new(Vec::new()) };
}

/// Which limit the numerical terms of a run have to keep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Linear elastic bodies without contact.
    Elastic,
    /// A material that yields, or bodies in contact. Judged by the plan and not by how gently it is
    /// run, so that no run chooses its limit.
    ImpactAndFlow,
}

impl Kind {
    fn of(simulation: &Simulation) -> Kind {
        let plan = simulation.plan();
        let yields =
            |m: &moldwarp::plan::NamedMaterial| matches!(m.model, Material::MohrCoulomb(_));
        if plan.contacts.is_empty() && !plan.materials.iter().any(yields) {
            Kind::Elastic
        } else {
            Kind::ImpactAndFlow
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Kind::Elastic => "elastic",
            Kind::ImpactAndFlow => "impact and flow",
        }
    }

    /// Of the sum of the absolute numerical terms over the energy turned over.
    pub fn limit(self) -> f64 {
        match self {
            Kind::Elastic => 0.01,
            Kind::ImpactAndFlow => 0.05,
        }
    }
}

/// Of the greatest |residual| over the energy turned over.
pub const RESIDUAL_LIMIT: f64 = 1e-6;

/// What a run comes to.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The plan's title: what tells the run from the others of its case.
    pub run: String,
    pub kind: Kind,
    /// J, of the part that is computed.
    pub turned_over: f64,
    /// Greatest |residual| of the run over the energy turned over.
    pub residual: f64,
    /// `transfer`, `smoothing`, `integration` and `advection` over the energy turned over, at the
    /// instant at which the sum of their absolute values was greatest.
    pub terms: [f64; 4],
}

impl Entry {
    /// Greatest sum of the absolute numerical terms over the energy turned over.
    pub fn numerical(&self) -> f64 {
        self.terms.iter().map(|t| t.abs()).sum()
    }

    /// Figures that are no numbers hold nothing.
    pub fn holds(&self) -> bool {
        self.residual <= RESIDUAL_LIMIT && self.numerical() <= self.kind.limit()
    }
}

/// Looks on at a run.
#[derive(Default)]
pub struct Watch {
    residual: f64,
    worst: Energies,
}

impl Watch {
    /// After each step.
    pub fn see(&mut self, energies: Energies) {
        self.residual = self.residual.max(energies.residual.abs());
        if energies.numerical() > self.worst.numerical() {
            self.worst = energies;
        }
    }

    /// The run is at its end.
    pub fn end(self, simulation: &Simulation) -> Entry {
        let whole = simulation.energy_turned_over();
        let e = self.worst;
        let terms = [e.transfer, e.smoothing, e.integration, e.advection];
        // No maximum sees a NaN; but energies are sums, and keep it to the end.
        let residual = match simulation.energies().residual {
            last if last.is_finite() => self.residual,
            last => last,
        };
        Entry {
            run: simulation.plan().title.clone(),
            kind: Kind::of(simulation),
            turned_over: whole,
            residual: residual / whole,
            terms: terms.map(|t| t / whole),
        }
    }
}

/// Keeps what a run came to until it is taken.
pub fn note(entry: Entry) {
    NOTED.with_borrow_mut(|noted| noted.push(entry));
}

/// The runs of this thread since the last call, in their order.
pub fn taken() -> Vec<Entry> {
    NOTED.take()
}
