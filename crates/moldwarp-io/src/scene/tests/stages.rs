//! Stages and initial stress: what is read, and what a user reads when it is wrong.

use super::messages::entry;
use super::{read, with};
use moldwarp::Plan;
use moldwarp::plan::{Equilibrium, Item, Level, LoadKind, Ramp, Until};

const END: &str = "name = \"loading\"\nduration = \"2 s\"";

fn plan(text: &str) -> Plan {
    read(text, &[]).unwrap().plan
}

/// The sample with other lines in place of its stage's.
fn stages(lines: &str) -> String {
    with(END, lines)
}

fn case(title: &str, lines: &str) -> String {
    entry(title, &stages(lines), &[])
}

/// The sample with an initial stress and lines for its body.
fn initial_stress(table: &str, body: &str) -> String {
    let text = with("particles_per_element = 4", body);
    text.replace("[numerics]", &format!("{table}\n[numerics]"))
}

#[test]
fn what_stages_change_is_read() {
    let text = stages(
        r#"name = "rest"
until = "equilibrium"
duration = "9 s"
equilibrium = { kinetic = 1e-6, hold = "2 s" }
scale = { gravity = { from = 0, to = 1, over = "1 s" }, z-max = 0.5 }
[[stages]]
name = "loading"
duration = "2 s"
off = "sides"
on = ["z-max"]
reset = "displacement""#,
    );
    let plan = plan(&text);
    let [rest, loading] = &plan.stages[..] else {
        panic!("two stages")
    };
    let judged = Equilibrium {
        unbalanced: 0.01,
        kinetic: 1e-6,
        hold: Some(2.0),
    };
    assert_eq!(rest.until, Until::Equilibrium { limit: 9.0, judged });
    let ramp = |from, to, over| Ramp { from, to, over };
    let levels = [
        (Level::Gravity, ramp(Some(0.0), 1.0, 1.0)),
        (Level::Load(0), ramp(None, 0.5, 0.0)),
    ];
    assert_eq!(rest.levels, levels);
    assert_eq!(loading.off, [Item::Boundary(0)]);
    assert_eq!(loading.on, [Item::Load(0)]);
    assert!(loading.reset_displacement && !rest.reset_displacement);
    assert!(plan.on_at_the_start(Item::Boundary(0)));
    assert!(!plan.on_at_the_start(Item::Load(0)));
}

#[test]
fn initial_stress_and_pressure_with_depth_are_read() {
    let table = "[initial_stress]\nkind = \"k0\"\nsurcharge = \"2 kPa\"";
    let plan_of = plan(&initial_stress(table, "k0 = 0.5"));
    let read = plan_of.initial_stress.unwrap();
    assert_eq!((read.k0, read.surcharge), (vec![Some(0.5)], 2e3));
    let pressure = r#"pressure = { value = "1 kPa", gradient = "10 kN/m3", level = "3 m" }"#;
    let text = with(r#"traction = ["0 kPa", "0 kPa", "-1 kPa"]"#, pressure);
    let linear = LoadKind::LinearPressure {
        value: 1e3,
        gradient: 1e4,
        level: 3.0,
    };
    assert_eq!(plan(&text).loads[0].kind, linear);
}

#[test]
fn stages_and_initial_stress() {
    let lines = [
        case(
            "equilibrium without limit",
            "name = \"a\"\nuntil = \"equilibrium\"",
        ),
        case(
            "equilibrium limited in steps",
            "name = \"a\"\nuntil = \"equilibrium\"\nsteps = 10",
        ),
        case(
            "another end",
            "name = \"a\"\nuntil = \"rest\"\nduration = \"1 s\"",
        ),
        case(
            "judged though it does not end so",
            "name = \"a\"\nduration = \"1 s\"\nequilibrium = { kinetic = 0.1 }",
        ),
        case(
            "released what was never fixed",
            "name = \"a\"\nduration = \"1 s\"\noff = \"side\"",
        ),
        case(
            "released twice",
            "name = \"a\"\nduration = \"1 s\"\noff = \"sides\"\n[[stages]]\nname = \"b\"\n\
             duration = \"1 s\"\noff = \"sides\"",
        ),
        case(
            "factor of nothing",
            "name = \"a\"\nduration = \"1 s\"\nscale = { zmax = 2 }",
        ),
        case(
            "ramp without length",
            "name = \"a\"\nduration = \"1 s\"\nscale = { gravity = { to = 1 } }",
        ),
        case(
            "another material for nothing",
            "name = \"a\"\nduration = \"1 s\"\nmaterial.layers = \"soil\"",
        ),
        entry(
            "a material of another density",
            &stages("name = \"a\"\nduration = \"1 s\"\nmaterial.layer = \"mud\"").replace(
                "[bodies.layer]",
                "[materials.mud]\nmodel = \"linear-elastic\"\nyoung_modulus = \"1 MPa\"\n\
                 poisson_ratio = 0\ndensity = 1500\n\n[bodies.layer]",
            ),
            &[],
        ),
        case(
            "reset of the time",
            "name = \"a\"\nduration = \"1 s\"\nreset = [\"time\"]",
        ),
        entry(
            "boundary and load of one name",
            &with("name = \"sides\"", "name = \"z-max\"")
                .replace(END, "name = \"a\"\nduration = \"1 s\"\noff = \"z-max\""),
            &[],
        ),
        entry("K0 of nothing", &initial_stress("", "k0 = 0.5"), &[]),
        entry(
            "no K0",
            &initial_stress("[initial_stress]\nkind = \"k0\"", ""),
            &[],
        ),
        entry(
            "negative K0",
            &initial_stress("[initial_stress]\nkind = \"k0\"", "k0 = -0.5"),
            &[],
        ),
        entry(
            "another initial stress",
            &initial_stress("[initial_stress]\nkind = \"gravity\"", "k0 = 0.5"),
            &[],
        ),
        entry(
            "load without size",
            &with(
                r#"traction = ["0 kPa", "0 kPa", "-1 kPa"]"#,
                "initial_stress = false",
            ),
            &[],
        ),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}
