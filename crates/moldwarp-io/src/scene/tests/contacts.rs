//! Contacts: what is read, and what a user reads when it is wrong.

use super::messages::entry;
use super::presence::setup;
use super::{read, with};
use moldwarp::plan::{Contact, ContactSurface};

/// The sample with its layer in three, `low`, `middle` and `high`, and with contacts; loaded at
/// the top.
fn three(contacts: &str) -> String {
    let body = |name: &str, low: f64, high: f64| {
        format!(
            "[bodies.{name}]\nregion = {{ min = [0, 0, {low}], max = [0.1, 0.1, {high}] }}\n\
             material = \"soil\"\n"
        )
    };
    let bodies = body("low", 0.0, 0.3) + &body("middle", 0.3, 0.6) + &body("high", 0.6, 1.0);
    with(
        "[bodies.layer]\nvolume = \"box\"\nmaterial = \"soil\"\nparticles_per_element = 4\n",
        &bodies,
    )
    .replace("body = \"layer\"", "body = \"high\"")
    .replace("[numerics]", &format!("{contacts}\n[numerics]"))
}

/// A contact between the bodies with more lines.
fn contact(bodies: &str, lines: &str) -> String {
    format!("[[contacts]]\nbodies = {bodies}\n{lines}\n")
}

#[test]
fn contacts_are_read() {
    let sole = "name = \"sole\"\nfriction = 0.4\nadhesion = \"2 kPa\"\nsurface = \"aligned\"\n\
                gap_check = false";
    let text = three(&(contact("[\"high\", [\"low\", \"middle\"]]", sole)));
    let scene = read(&text, &["contacts.sole.friction=0.5"]).unwrap();
    let expected = Contact {
        name: "sole".into(),
        bodies: [vec![2], vec![0, 1]],
        friction: 0.5,
        adhesion: 2e3,
        surface: ContactSurface::Aligned,
        gap_check: false,
    };
    assert_eq!(scene.plan.contacts, [expected]);
}

#[test]
fn contacts_have_defaults() {
    let text = three(
        &(contact("[\"low\", \"middle\"]", "name = \"middle-high\"")
            + &contact("[\"middle\", \"high\"]", "")),
    );
    let scene = read(&text, &[]).unwrap();
    let expected = Contact {
        name: "middle-high-2".into(),
        bodies: [vec![1], vec![2]],
        friction: 0.0,
        adhesion: 0.0,
        surface: ContactSurface::Free,
        gap_check: true,
    };
    assert_eq!(scene.plan.contacts[1], expected);
    let text = three(&contact("[\"high\", [\"low\", \"middle\"]]", ""));
    assert_eq!(
        read(&text, &[]).unwrap().plan.contacts[0].name,
        "high-low+middle"
    );
}

/// At the start or by a stage.
#[test]
fn the_gap_is_not_checked_where_soil_flows() {
    let text = three(
        &(contact("[\"low\", \"middle\"]", "")
            + &contact("[\"middle\", \"high\"]", "")
            + "[materials.sand]\nmodel = \"mohr-coulomb\"\nyoung_modulus = \"100 kPa\"\n\
               poisson_ratio = 0.0\ncohesion = 0\nfriction_angle = \"30 deg\"\n\
               unit_weight = \"18 kN/m3\"\n"),
    );
    let later = text.replace(
        "duration = \"2 s\"",
        "duration = \"2 s\"\nmaterial.high = \"sand\"",
    );
    let checked = |text: &str, sets: &[&str]| {
        let contacts = read(text, sets).unwrap().plan.contacts;
        contacts.iter().map(|c| c.gap_check).collect::<Vec<_>>()
    };
    assert_eq!(checked(&text, &[]), [true, true]);
    assert_eq!(checked(&text, &["bodies.low.material=sand"]), [false, true]);
    assert_eq!(checked(&later, &[]), [true, false]);
    let given = "contacts.middle-high.gap_check=true";
    assert!(
        read(&later, &[given]).is_err(),
        "by a name that was not given"
    );
    assert_eq!(
        checked(&later, &["contacts.1.gap_check=true"]),
        [true, true]
    );
}

#[test]
fn what_a_contact_records_can_be_compared() {
    let text = three(
        &(contact("[\"low\", \"middle\"]", "name = \"sole\"")
            + "[[compare]]\ncolumn = \"contact.sole.normal.z\"\nfile = \"scene.toml\""),
    );
    assert!(read(&text, &[]).is_ok());
}

#[test]
fn messages() {
    let case =
        |title: &str, bodies: &str, lines: &str| entry(title, &three(&contact(bodies, lines)), &[]);
    let both = |title: &str, contacts: &[(&str, &str)]| {
        let all: String = contacts.iter().map(|c| contact(c.0, c.1)).collect();
        entry(title, &three(&all), &[])
    };
    let pair = "[\"low\", \"middle\"]";
    let sole = "name = \"sole\"";
    let compare = "[[compare]]\ncolumn = \"contact.sole.norml.z\"\nfile = \"a.csv\"";
    let lines = [
        case("misspelt body", "[\"low\", \"midle\"]", ""),
        case(
            "misspelt body in a list",
            "[\"low\", [\"middle\", \"hihg\"]]",
            "",
        ),
        case("no bodies", pair, "bodis = 1"),
        case("with itself", "[\"low\", \"low\"]", ""),
        case(
            "with itself in lists",
            "[[\"low\", \"middle\"], [\"high\", \"middle\"]]",
            "",
        ),
        case("twice in a side", "[\"low\", [\"middle\", \"middle\"]]", ""),
        case("one side", "[\"low\"]", ""),
        case("three sides", "[\"low\", \"middle\", \"high\"]", ""),
        case("an empty side", "[\"low\", []]", ""),
        case("negative friction", pair, "friction = -0.1"),
        case("negative adhesion", pair, "adhesion = \"-1 kPa\""),
        case("misspelt surface", pair, "surface = \"alined\""),
        case("a name for no column", pair, "name = \"the.sole\""),
        both(
            "one name for two",
            &[(pair, sole), ("[\"middle\", \"high\"]", sole)],
        ),
        both(
            "two contacts of a pair",
            &[(pair, sole), ("[\"middle\", \"low\"]", "")],
        ),
        both(
            "two contacts of a pair through a list",
            &[
                ("[\"high\", [\"low\", \"middle\"]]", sole),
                ("[\"middle\", \"high\"]", ""),
            ],
        ),
        both(
            "bodies that hang together elsewhere",
            &[("[\"high\", [\"low\", \"middle\"]]", sole), (pair, "")],
        ),
        case("misspelt column", pair, &format!("{sole}\n{compare}")),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn bodies_of_contacts_stay() {
    let text = three(&contact("[\"low\", \"middle\"]", "name = \"sole\""));
    let stage = |lines: &str| {
        let text = text.replace(
            "duration = \"2 s\"",
            &format!("duration = \"2 s\"\n{lines}"),
        );
        text.replace("name = \"sole\"", "name = \"sole\"\nsurface = \"aligned\"")
    };
    let lines = [
        entry("a body that goes", &stage("remove = \"middle\""), &[]),
        entry(
            "aligned with what comes later",
            &stage("add = \"low\""),
            &[],
        ),
    ];
    insta::assert_snapshot!(lines.join("\n"));
    assert!(read(&stage("add = \"middle\""), &[]).is_ok());
}

#[test]
fn what_the_solver_finds() {
    let text = three(&contact(
        "[\"middle\", \"low\"]",
        "name = \"sole\"\nsurface = \"aligned\"",
    ));
    let inside = text
        .replace("0.1, 0.3]", "0.1, 0.33]")
        .replace("[0, 0, 0.3]", "[0, 0, 0.33]");
    let overlap = text.replace("[0, 0, 0.3]", "[0, 0, 0.2]");
    let lines = [setup("not on faces", &inside), setup("overlap", &overlap)];
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn a_rigid_body_hangs_together_with_nothing() {
    let steel = "[materials.steel]\nmodel = \"rigid\"\ndensity = 7850";
    let text = three(&contact("[\"high\", [\"low\", \"middle\"]]", steel));
    let sets = ["bodies.middle.material=steel"];
    insta::assert_snapshot!(entry("rigid with others", &text, &sets));
    let sets = ["bodies.high.material=steel"];
    assert!(read(&text, &sets).is_ok());
}
