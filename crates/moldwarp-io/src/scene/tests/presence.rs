//! Bodies that stages add and remove: what is read, and what a user reads when it is wrong.

use super::messages::entry;
use super::{Failure, read, with};
use crate::run::simulation;
use crate::scene::load;

/// The sample with its layer in two, the upper one of which bears the load and is probed, and with
/// other stages.
fn two(stages: &str) -> String {
    let body = |name: &str, low: &str, high: &str| {
        format!(
            "[bodies.{name}]\nregion = {{ min = [0, 0, \"{low}\"], max = [\"0.1 m\", \"0.1 m\", \
             \"{high}\"] }}\nmaterial = \"soil\"\n"
        )
    };
    let bodies = body("lower", "0 m", "0.6 m") + &body("upper", "0.6 m", "1 m");
    with(
        "[bodies.layer]\nvolume = \"box\"\nmaterial = \"soil\"\nparticles_per_element = 4\n",
        &bodies,
    )
    .replace("body = \"layer\"", "name = \"road\"\nbody = \"upper\"")
    .replace(
        "[[stages]]\nname = \"loading\"\nduration = \"2 s\"\n",
        stages,
    )
}

/// A stage of a second with other lines.
fn stage(name: &str, lines: &str) -> String {
    format!("[[stages]]\nname = \"{name}\"\nduration = \"1 s\"\n{lines}\n")
}

/// A first stage and then one with these lines.
fn second(lines: &str) -> String {
    two(&(stage("a", "") + &stage("b", lines)))
}

#[test]
fn bodies_to_add_and_remove_are_read() {
    let stages = stage("fill", "add = \"upper\"\non = \"road\"")
        + &stage("cut", "remove = [\"upper\"]\noff = \"road\"")
        + &stage("again", "add = [\"upper\"]");
    let scene = read(&two(&stages), &[]).unwrap();
    let [fill, cut, again] = &scene.plan.stages[..] else {
        panic!("three stages")
    };
    assert_eq!((&fill.add, &fill.remove), (&vec![1], &vec![]));
    assert_eq!((&cut.add, &cut.remove), (&vec![], &vec![1]));
    assert_eq!((&again.add, &again.remove), (&vec![1], &vec![]));
    assert!(scene.plan.there_at_the_start(0) && !scene.plan.there_at_the_start(1));
    assert_eq!(
        scene.notes,
        ["body `upper` comes later: stage `fill` adds it"]
    );
}

/// A volume may hold one body after the other.
#[test]
fn a_body_may_take_the_volume_of_another() {
    let text = with(
        "[[boundaries]]\nname = \"sides\"",
        "[bodies.lining]\nvolume = \"box\"\nmaterial = \"soil\"\n[[boundaries]]\nname = \"sides\"",
    );
    let text = text.replace(
        "duration = \"2 s\"",
        "duration = \"2 s\"\noff = \"z-max\"\nadd = \"lining\"",
    );
    assert!(read(&text, &[]).is_err(), "both are there");
    let text = text.replace("add = \"lining\"", "add = \"lining\"\nremove = \"layer\"");
    assert!(read(&text, &[]).is_ok());
}

#[test]
fn bodies_that_are_not_there() {
    let k0 = second("add = \"upper\"\non = \"road\"")
        .replace("[numerics]", "[initial_stress]\nkind = \"k0\"\n[numerics]")
        .replace("material = \"soil\"\n", "material = \"soil\"\nk0 = 0.5\n");
    let off = "remove = \"upper\"\noff = \"road\"";
    let lines = [
        entry("adds what there is not", &second("add = \"uper\""), &[]),
        entry("removes what there is not", &second("remove = [\"lower\", \"uper\"]"), &[]),
        entry(
            "adds twice",
            &two(&(stage("a", "add = \"upper\"\non = \"road\"") + &stage("b", "add = \"upper\""))),
            &[],
        ),
        entry(
            "removes twice",
            &two(&(stage("a", off) + &stage("b", "remove = \"upper\""))),
            &[],
        ),
        entry(
            "adds and removes",
            &second("add = \"upper\"\nremove = \"upper\""),
            &[],
        ),
        entry("leaves nothing", &second("remove = [\"lower\", \"upper\"]"), &[]),
        entry("takes the body of a load", &second("remove = \"upper\""), &[]),
        entry("a load before its body", &second("add = \"upper\""), &[]),
        entry(
            "a load switched on without its body",
            &two(&(stage("a", "on = \"road\"") + &stage("b", "add = \"upper\""))),
            &[],
        ),
        entry(
            "a velocity for what is gone",
            &second(&format!("{off}\ninitial_velocity.upper = [0, 0, 1]")),
            &[],
        ),
        entry(
            "a material for what has not come",
            &two(&(stage("a", "material.upper = \"soil\"")
                + &stage("b", "add = \"upper\"\non = \"road\""))),
            &[],
        ),
        entry("K0 of what comes later", &k0, &[]),
        entry(
            "a volume for two",
            &with(
                "[[boundaries]]\nname = \"sides\"",
                "[bodies.more]\nvolume = \"box\"\nmaterial = \"soil\"\n[[boundaries]]\nname = \"sides\"",
            )
            .replace("duration = \"2 s\"", "duration = \"2 s\"\nadd = \"more\""),
            &[],
        ),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

/// What the solver finds when it sets up the scene.
pub(super) fn setup(title: &str, text: &str) -> String {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("scene.toml");
    std::fs::write(&file, text).unwrap();
    let scene = load(&file, &[]).unwrap();
    match simulation(scene.plan, &scene.origin, &scene.text) {
        Ok(_) => panic!("no error: {title}"),
        Err(error) => format!("## {title}\n{}\n", Failure { error, dir }.rendered()),
    }
}

#[test]
fn probes_that_lose_what_they_look_at() {
    let probe = |lines: &str, stage: &str| {
        second(stage).replace(
            "[probes.bottom]\nsurface = \"z-min\"",
            &format!("[probes.it]\n{lines}"),
        )
    };
    let removes = "remove = \"upper\"\noff = \"road\"";
    let adds = "add = \"upper\"\non = \"road\"";
    let lines = [
        setup("a body that goes", &probe("body = \"upper\"", removes)),
        setup("a body that comes", &probe("body = \"upper\"", adds)),
        setup(
            "a point of a body that goes",
            &probe("point = [0, 0, \"0.9 m\"]", removes),
        ),
        setup(
            "a surface of a body that goes",
            &probe("surface = \"z-max\"", removes),
        ),
        setup(
            "a surface of a body that comes",
            &probe("surface = \"z-max\"", adds),
        ),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}
