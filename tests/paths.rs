//! Pictures of motions: `--path` of each family. `ARMCTL_BLESS=1 cargo test --test terminal paths::` writes the pictures
//! in `tests/data/path/` again; look at them in a browser. The page runs in Chromium, where it is installed.

use std::path::{Path, PathBuf};
use std::process::Command;

fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/path")
}

/// Runs armctl in the folder of the programs. Returns stdout.
fn armctl(words: &[&str]) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    command.current_dir(data()).env_clear().args(words);
    let output = command.output().expect("armctl starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{words:?}: {errors}");
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// Command lines of the pictures.
const JOB: [&str; 5] = ["yerc", "job", "show", "WELD.JBI", "--path"];
const PULSES: [&str; 6] = ["--sim", "yerc", "job", "show", "TESTJOB", "--path"];
const PROGRAM: [&str; 9] =
    ["toyo", "program", "show", "pick.toyo", "--path", "--points", "points.csv", "--params", "parameters.csv"];
const POINTS: [&str; 6] = ["--sim", "yrcx", "point", "list", "0..29", "--path"];

#[test]
fn pictures_are_current() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, line) in [("path", &JOB[..]), ("pulses", &PULSES), ("pick", &PROGRAM), ("points", &POINTS)] {
        let drawn = folder.path().join(format!("{name}.svg"));
        let file = drawn.to_str().expect("UTF-8");
        armctl(&[line, &["--svg", file]].concat());
        let drawn = std::fs::read_to_string(&drawn).expect("the picture is written");
        // The documentation shows the picture of the job.
        let documentation = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/pictures");
        let kept = if name == "path" { documentation } else { data() }.join(format!("{name}.svg"));
        if std::env::var_os("ARMCTL_BLESS").is_some() {
            std::fs::write(&kept, &drawn).expect("the picture can be written");
        }
        assert!(std::fs::read_to_string(&kept).is_ok_and(|kept| kept == drawn), "{name}.svg is another picture");
    }
}

/// Values of an array in the data of the report.
fn values(report: &str, filter: &str) -> Vec<String> {
    let report: serde_json::Value = serde_json::from_str(report).expect("JSON");
    let text = |value: &serde_json::Value| value.as_str().map_or_else(|| value.to_string(), ToOwned::to_owned);
    let (list, key) = filter.split_once('.').expect("list and key");
    report["data"][list].as_array().expect("a list").iter().map(|one| text(&one[key])).collect()
}

#[test]
fn job_is_drawn_as_far_as_it_is_known() {
    let report = armctl(&[&JOB[..], &["--json"]].concat());
    let kinds = values(&report, "steps.interpolation").join(" ");
    assert_eq!(kinds, "start joints straight straight straight arc arc straight straight joints");
    assert_eq!(values(&report, "not_drawn.line"), ["38", "39"], "the job GRIP does not move");
    let reasons = values(&report, "not_drawn.reason");
    assert!(reasons[0].contains("variable P5") && reasons[1].contains("joint"), "{reasons:?}");
}

#[test]
fn program_is_drawn_without_a_guess() {
    let report = armctl(&[&PROGRAM[..], &["--json"]].concat());
    assert_eq!(values(&report, "not_drawn.reason"), ["the point 7 is not known"]);
    let steps = values(&report, "steps.target");
    let places: Vec<&String> = steps.iter().filter(|step| step.ends_with(",30.0,0.0]")).collect();
    assert!(places.contains(&&"[200.0,50.0,30.0,0.0]".to_owned()), "the pallet begins at point 10: {places:?}");
    let unknown = armctl(&["toyo", "program", "show", "pick.toyo", "--path", "--points", "points.csv", "--json"]);
    let reasons = values(&unknown, "not_drawn.reason");
    assert!(reasons.contains(&"the group 1 is not known".to_owned()), "{reasons:?}");
}

#[test]
fn backup_is_compared() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = std::fs::read_to_string(data().join("WELD.JBI")).expect("the job");
    std::fs::write(folder.path().join("WELD.JBI"), text.replace("850.000,-150.000,420", "850.000,-150.000,460"))
        .unwrap();
    let old = folder.path().to_str().expect("UTF-8");
    let shown = armctl(&[&JOB[..], &["--compare", old]].concat());
    assert!(shown.contains("1 of 10 positions differ (C00001), by 40.000 mm at most."), "{shown}");
    let same = armctl(&["yerc", "job", "show", "WELD", "--path", "--from", old, "--compare", old, "--plane", "xz"]);
    assert!(same.contains("All 10 positions are the same.") && !same.contains("YZ "), "{same}");
}

#[test]
fn page_moves_along_the_path() {
    let Some(browser) = ["chromium", "chromium-browser", "google-chrome"]
        .into_iter()
        .find(|browser| Command::new(browser).arg("--version").output().is_ok_and(|output| output.status.success()))
    else {
        return println!("skipped: there is no chromium here");
    };
    let folder = tempfile::tempdir().expect("a folder");
    let page = folder.path().join("page.html");
    armctl(&[&PROGRAM[..], &["--html", page.to_str().expect("UTF-8")]].concat());
    // Moves the slider to the end, after the script of the page.
    let text = std::fs::read_to_string(&page).expect("the page");
    let moved = "<script>slider.value = 1000; slider.dispatchEvent(new Event('input'));</script></body>";
    std::fs::write(&page, text.replace("</body>", moved)).expect("the page can be written");
    let profile = folder.path().join("profile");
    let mut command = Command::new(browser);
    command.args(["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking"]);
    command.args(["--disable-component-update", "--disable-sync", "--virtual-time-budget=2000", "--dump-dom"]);
    command.arg(format!("--user-data-dir={}", profile.display())).arg(format!("file://{}", page.display()));
    let dom = String::from_utf8(command.output().expect("the browser starts").stdout).expect("UTF-8");
    let of = |id: &str| dom.split(&format!("id=\"{id}\">")).nth(1).and_then(|rest| rest.split('<').next());
    let report = armctl(&[&PROGRAM[..], &["--json"]].concat());
    let end: serde_json::Value = serde_json::from_str(&report).expect("JSON");
    let duration = end["data"]["duration_s"].as_f64().expect("a time");
    assert!(of("now").is_some_and(|now| now.starts_with(&format!("{duration:.2} s"))), "{:?}", of("now"));
    let last = values(&report, "steps.text").pop().expect("steps");
    assert_eq!(of("text"), Some(last.as_str()));
    assert!(!dom.contains("id=\"dot0\" r=\"6.5\" cx=\"-99\""), "the mark is on the path");
}
