//! Reports of simulations in memory.

use super::super::report_of;
use super::{BLOCK, Bench, Page};
use crate::report::{ReportError, Wishes};
use crate::run::Session;
use crate::scene;
use serde_json::Value;
use std::path::Path;

fn session() -> Session {
    let scene = scene::parse(Path::new("scene.toml"), BLOCK).unwrap_or_else(|e| panic!("{e:?}"));
    Session::new(scene).unwrap()
}

fn to_the_end(mut session: Session) -> Session {
    while !session.simulation().finished() {
        session.step().unwrap();
    }
    session
}

fn report(session: &Session) -> Page {
    let dir = tempfile::tempdir().unwrap();
    let to = dir.path().join("page.html");
    let work = dir.path().join("work");
    std::fs::create_dir(&work).unwrap();
    Page::of(report_of(session, 1, &work, &to, Wishes::default()).unwrap())
}

/// The page's figures, but those that the clock on the wall tells, and how the scene is called.
fn summary(page: &Page) -> Value {
    let mut summary: Value = serde_json::from_str(page.data("summary")).unwrap();
    for key in ["wall_time", "particle_steps_per_second", "case"] {
        assert!(!summary[key].take().is_null(), "{key}");
    }
    summary
}

/// With its frames, a session's page has what the page of the command's run has.
#[test]
fn a_sessions_report_is_that_of_the_run() {
    let of_run = Bench::run(&[]).report(Wishes::default());
    let frames = tempfile::tempdir().unwrap();
    let mut session = session();
    session.keep_frames(frames.path()).unwrap();
    let session = to_the_end(session);
    let page = report(&session);
    assert_eq!(summary(&page), summary(&of_run));
    assert_eq!(page.data("history"), of_run.data("history"));
    assert_eq!(page.about()["pictures"], of_run.about()["pictures"]);
    let mut blobs = 0;
    while page.html.contains(&format!(" id=\"blob-{blobs}\">")) {
        let id = format!("blob-{blobs}");
        assert_eq!(page.data(&id), of_run.data(&id));
        blobs += 1;
    }
    assert!(blobs > 10 && page.left_out.is_empty());
    for table in ["energies", "stages", "history"] {
        assert_eq!(page.rows(table), of_run.rows(table), "{table}");
    }
    assert!(page.html.contains("The run was completed"));
}

#[test]
fn without_frames_there_is_the_last_state() {
    let page = report(&to_the_end(session()));
    assert_eq!(
        page.about()["pictures"]["frames"].as_array().unwrap().len(),
        1
    );
    let [said] = &page.left_out[..] else {
        panic!("{:?}", page.left_out)
    };
    assert!(said.contains("the last state alone"), "{said}");
    assert!(page.html.contains(said));
}

/// Before the end the page says so, has the state of now behind the frames, and the ledger as it stands.
#[test]
fn a_simulation_that_goes_on_is_said_to() {
    let frames = tempfile::tempdir().unwrap();
    let mut session = session();
    let beginning = report(&session);
    assert!(beginning.html.contains("this is how it stands at t = "));
    assert!(beginning.left_out.is_empty());
    session.keep_frames(frames.path()).unwrap();
    while session.simulation().time() < 0.12 {
        session.step().unwrap();
    }
    let page = report(&session);
    assert!(page.html.contains("The simulation is not over"));
    assert!(page.html.contains("not over yet") && !page.html.contains("stopped"));
    let about = page.about();
    let times: Vec<f64> = about["pictures"]["frames"]
        .as_array()
        .unwrap()
        .iter()
        .map(|frame| frame["time"].as_f64().unwrap())
        .collect();
    assert_eq!(times.len(), 4, "0, 0.05, 0.1 s and now: {times:?}");
    assert_eq!(times[3], session.simulation().time());
    let summary = summary(&page);
    assert_eq!(summary["energy"]["kinetic"], session.energies().kinetic);
    assert_eq!(summary["state_hash"], session.state_hash());
    // And it goes on as if nothing had been.
    assert_eq!(
        report(&to_the_end(session)).about()["pictures"]["frames"]
            .as_array()
            .unwrap()
            .len(),
        7
    );
}

/// What was changed at a frame's time is shown beside it.
#[test]
fn a_change_is_seen() {
    let frames = tempfile::tempdir().unwrap();
    let mut session = session();
    session.keep_frames(frames.path()).unwrap();
    let count = |session: &Session| session.frames(frames.path()).unwrap().len();
    assert_eq!(count(&session), 1);
    session.simulation_mut();
    assert_eq!(count(&session), 2);
    session.record_again();
    assert_eq!(count(&session), 1);
}

#[test]
fn a_frame_that_cannot_be_written_is_said_once() {
    let frames = tempfile::tempdir().unwrap();
    let mut session = session();
    session.keep_frames(frames.path()).unwrap();
    std::fs::remove_dir_all(frames.path().join("frames")).unwrap();
    while !session.has_lost_a_frame() {
        session.step().unwrap();
    }
    let fault = session.lost_frame().unwrap().to_string();
    assert!(fault.contains("00001.vtu"), "{fault}");
    assert!(!session.has_lost_a_frame() && session.lost_frame().is_none());
    assert!(to_the_end(session).has_lost_a_frame());
}

#[test]
fn pages_do_not_replace_what_is_no_page() {
    let dir = tempfile::tempdir().unwrap();
    let to = dir.path().join("notes.txt");
    std::fs::write(&to, "mine").unwrap();
    let refused = |to: &Path| report_of(&session(), 1, dir.path(), to, Wishes::default());
    assert!(matches!(refused(&to), Err(ReportError::Foreign(_))));
    assert!(matches!(refused(dir.path()), Err(ReportError::Folder(_))));
    let nowhere = dir.path().join("nowhere/page.html");
    assert!(matches!(refused(&nowhere), Err(ReportError::File(_))));
    assert_eq!(std::fs::read_to_string(&to).unwrap(), "mine");
}
