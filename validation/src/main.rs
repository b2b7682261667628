//! `moldwarp-validation coarse|fine [CASE]`: computes the cases and writes their tables and plots.
//! `exact` writes the exact histories of the examples, `pictures [--out DIR] [NAME]…` makes the pictures of
//! README, examples and book, `speed` measures the step, `ledgers [coarse|fine] [NAME]…` tabulates the ledgers of cases and examples, `soak`
//! runs an example over and over.

use moldwarp_validation::{Fidelity, cases, example, ledgers, made, pictures, soak, speed};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let fidelity = match arguments.first().map(String::as_str) {
        Some("coarse") => Fidelity::Coarse,
        Some("fine") => Fidelity::Fine,
        Some("exact") => return written(example::write_exact().map_err(Into::into)),
        Some("speed") => return finished(speed::measure(&arguments[1..])),
        Some("soak") => return finished(soak::soak(&arguments[1..])),
        Some("ledgers") => return tabulated(ledgers::tabulate(&arguments[1..])),
        Some("pictures") => return tabulated(pictures::make(&arguments[1..])),
        _ => return usage(),
    };
    let chosen: Vec<_> = match arguments.get(1) {
        None => cases::ALL.iter().collect(),
        Some(name) => match cases::find(name) {
            Some(case) => vec![case],
            None => return usage(),
        },
    };
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("results")
        .join(fidelity.name());
    let (commit, mut all_passed) = (made::commit(), true);
    for case in chosen {
        let start = Instant::now();
        println!("{}: {}", case.name, case.title);
        let report = (case.run)(fidelity);
        print!("{}", report.summary());
        println!("  {:.1} s\n", start.elapsed().as_secs_f64());
        all_passed &= report.passed();
        let written = report.write(&folder, case.name);
        let written = written.and_then(|()| made::note(&folder, case.name, &commit));
        if let Err(error) = written {
            eprintln!("cannot write to {}: {error}", folder.display());
            return ExitCode::from(4);
        }
    }
    println!("tables and plots are in {}", folder.display());
    if all_passed {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

fn written(files: Result<Vec<PathBuf>, Box<dyn std::error::Error>>) -> ExitCode {
    match files {
        Ok(files) => {
            files.iter().for_each(|f| println!("{}", f.display()));
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn finished(result: Result<(), Box<dyn std::error::Error>>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// Code 1 if a ledger is over a limit, or a picture could not be made.
fn tabulated(result: Result<bool, Box<dyn std::error::Error>>) -> ExitCode {
    match result {
        Ok(false) => ExitCode::FAILURE,
        result => finished(result.map(|_| ())),
    }
}

fn usage() -> ExitCode {
    eprintln!(
        "usage: moldwarp-validation coarse|fine [CASE] | ledgers [coarse|fine] [NAME]… | exact | \
         pictures [--out DIR] [NAME]… | speed [BENCH]… | soak [RUNS [EXAMPLE]]\ncases:"
    );
    for case in &cases::ALL {
        eprintln!("  {:18} {}", case.name, case.title);
    }
    ExitCode::from(2)
}
